"""
The Moon, Mercury, Phobos: libration
====================================

The rotations of these three bodies are in resonance with their orbits. The averaged theory does not hold there, and the full equations are integrated. The forced librations in longitude are compared with the
linear formulas and with observations.
"""

import math

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import andoyer

Array = NDArray[np.float64]

# %%
# A body rotates about its axis of greatest inertia in the plane of its orbit. Time is in radians of the mean anomaly. The libration is the rotation angle minus the mean
# rotation. A fit separates the part with the period of the orbit from the free libration.


def libration(
    moments: list[float], eccentricity: float, spin: float, free: float, start: float, turns: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """(times, libration [rad], amplitude of the part with the period of the orbit [rad])."""
    orbit = andoyer.Orbit(1.0, eccentricity)
    end = 2 * math.pi * turns
    scene = andoyer.Scene(andoyer.Body(moments), [0, 0, 0, 1], [0, 0, spin + start], orbit=orbit, span=(0, end), tolerance=1e-8)
    motion = scene.solve()
    assert motion.plan.method == "integrated" and motion.plan.meets_tolerance
    times = np.linspace(0, end, 200 * turns)
    attitude = motion.attitude(times)
    angle = np.unwrap(2 * np.arctan2(attitude[:, 2], attitude[:, 3]), period=4 * np.pi) - spin * times
    columns = [np.sin(times), np.cos(times), np.sin(2 * times), np.cos(2 * times), np.sin(free * times), np.cos(free * times), np.ones_like(times)]
    return times, angle, float(np.linalg.lstsq(np.stack(columns, axis=1), angle, rcond=None)[0][0])


# %%
# **Phobos** (moments of Willner et al. 2010, e = 0.0151): with w² = 3 (B − A)/C the amplitude is 2e w²/(w² − 1). The IAU gives −1.143°.

A, B, C = 0.3615, 0.4265, 0.5024
e, square = 0.0151, 3 * (B - A) / C
formula = 2 * e * square / (square - 1)
times, angle, found = libration([A, B, C], e, 1.0, math.sqrt(square), formula, 50)
print(f"Phobos   {math.degrees(found):.3f}°; formula {math.degrees(formula):.3f}°, IAU -1.143°")
assert abs(found / formula - 1) < 4e-3

# %%
# **The Moon** (moments of its catalogue entry, e = 0.0549): only the libration due to the Keplerian ellipse, without the Sun.

A, B, C = andoyer.Body.named("moon").moments
e, square = 0.0549, 3 * (B - A) / C
formula = 2 * e * square / (square - 1)
*_, found = libration([A, B, C], e, 1.0, math.sqrt(square), formula, 150)
print(f"Moon     {math.degrees(found) * 3600:.2f}″; formula {math.degrees(formula) * 3600:.2f}″")
assert abs(found / formula - 1) < 0.02

# %%
# **Mercury**, with three rotations in two orbits; the model is the mantle alone. (B − A)/Cm follows from the observed 38.5″ (Margot et al. 2012) by the series of Peale's formula in e.

e, observed = 0.20563593, math.radians(38.5 / 3600)
ratio = observed / (1.5 * (1 - 11 * e**2 + 959 / 48 * e**4 - 3641 / 288 * e**6))
free = math.sqrt(3 * ratio * (3.5 * e - 123 / 16 * e**3))
times, angle, found = libration([1 - 2 * ratio, 1 - ratio, 1.0], e, 1.5, free, observed, 200)
print(f"Mercury  {math.degrees(found) * 3600:.2f}″; observed 38.5″; at most {math.degrees(np.abs(angle).max()) * 3600:.0f}″ from the resonance in 200 orbits")
assert abs(found / observed - 1) < 0.01 and np.abs(angle).max() < 0.01

figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
shown = times < 8 * math.pi
axes.plot(times[shown] / (2 * math.pi), np.degrees(angle[shown]) * 3600, color="#0072B2")
axes.set(xlabel="orbits of Mercury", ylabel="libration [″]")
plt.show()
