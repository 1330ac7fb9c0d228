"""
Moons and satellites that keep a face
=====================================

A moon, a satellite with a boom, Mercury: their rotation is locked to the orbit. ``method="libration"`` gives the motion as a sum of terms, with the proper periods and the forced librations that papers print.
The model is a rigid body of degree 2 on a fixed ellipse.
"""

import math
import warnings

import matplotlib.pyplot as plt
import numpy as np

import andoyer
from andoyer import plot

warnings.simplefilter("ignore", andoyer.ToleranceWarning)  # the plan has the estimate; the pictures need less

TURN, ARCSECOND = 2 * math.pi, math.pi / 648000


def locked(
    moments: list[float],
    eccentricity: float,
    spin: float = 1.0,
    angles: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    mean_motion: float = 1.0,
    mass_fraction: float = 1.0,
    orbits: int = 1000,
    tolerance: float = 1e-9,
    name: str | None = None,
) -> andoyer.Motion:
    """The libration of a body at its pericentre, turned by Rz(ψ) Ry(θ) Rx(φ) from the resonance; `spin` is in rotations an orbit."""
    (a, b), (c, d), (e, f) = ((math.sin(x / 2), math.cos(x / 2)) for x in angles)
    attitude = [b * d * e - a * c * f, b * c * f + a * d * e, a * d * f - b * c * e, b * d * f + a * c * e]
    orbit = andoyer.Orbit(mean_motion, eccentricity, mass_fraction=mass_fraction)
    span = (0, orbits * TURN / mean_motion)
    scene = andoyer.Scene(
        andoyer.Body(moments), attitude, [0, 0, spin * mean_motion], orbit=orbit, span=span, tolerance=tolerance, method="libration", name=name
    )
    return scene.solve()


def of(motion: andoyer.Motion) -> andoyer.Libration:
    """The libration of a motion by this method."""
    assert motion.libration is not None
    return motion.libration


# %%
# **The Moon**, with the ratios of moments of DE421. Time is in days. Laser ranging has proper periods of 1056.16 d, 8806.9 d and 27,263 d (Yang et al. 2017); degree 3, the Sun and the node of the orbit are absent here.
# The mode of 8806.9 d is relative to the node. In the frame of the orbit it has 27.3 d, because this frame turns once a month.

beta, gamma = 6.3100220e-4, 2.2773053e-4  # (C − A)/B and (B − A)/C
middle = (1 + gamma) / (1 + beta)
month, node = 27.321661, 6798.38
moon = locked(
    [middle - gamma, middle, 1.0],
    0.0549,
    1 - 7.84e-5,
    (1e-5, 1e-5, 4e-5),
    mean_motion=TURN / month,
    mass_fraction=1 - 0.0121506,
    tolerance=1e-4,
    name="The Moon",
)
longitude, pole, wobble = of(moon).periods
inertial = 1 / (1 / pole - 1 / month)
print(f"Moon      {longitude:.1f} d, {pole:.4f} d (from the node {1 / (1 / node - 1 / inertial):.0f} d), {wobble:.0f} d")
assert abs(longitude / 1056.16 - 1) < 0.002 and abs(wobble / 27263 - 1) < 0.03

plot.libration_summary(moon)

# %%
# The largest forced terms in longitude. The first has the period of the orbit, and in first order its amplitude is 2e ω²/(n² − ω²), with the proper frequency ω.

still = locked([middle - gamma, middle, 1.0], 0.0549, 1 - 7.84e-5, mean_motion=TURN / month, mass_fraction=1 - 0.0121506, tolerance=1e-8)
for term in of(still).forced()[:3]:
    print(f"          period {term.period:8.4f} d, amplitude {term.amplitude / ARCSECOND:8.3f}″, phase {math.degrees(term.phase):6.1f}°")

# %%
# **Mercury** turns three times in two orbits. The mantle alone librates: (B − A)/C_m = 2.18e-4 gives the 38.5 ± 1.6″ of Margot et al. (2012). If the whole planet librated, with a proper period of
# 15.85 years (Rambaux and Bois 2004), it would be 21″.

day = TURN / 87.9691
for name, ratio in ("mantle", 2.18e-4), ("whole", 1.175e-4):
    mercury = locked([0.9997, 0.9997 + ratio, 1.0], 0.20563, 1.5, mean_motion=day, tolerance=1e-8)
    largest = of(mercury).forced()[0]
    years = of(mercury).periods[0] / 365.25
    print(f"Mercury   {name}: {largest.amplitude / ARCSECOND:.1f}″ in {largest.period:.2f} d, proper period {years:.2f} years")

# %%
# **Phobos** (moments of Willner et al. 2010, e = 0.0151) is elongated: its proper period is 1.6 orbits, and the forced libration is large. Willner et al. (2014) have 1.14°.

phobos = locked([0.3615, 0.4265, 0.5024], 0.0151, orbits=100, tolerance=1e-4)
print(f"Phobos    {math.degrees(of(phobos).forced()[0].amplitude):.3f}°, proper period {of(phobos).periods[0] / TURN:.4f} orbits")

# %%
# **A satellite with a boom** on a circle, released 1° from the vertical: A is small, B ≈ C, and the swing has the frequency √3 n. There is nothing forced. One solution serves 100,000 orbits.

boom = locked([0.001, 0.9995, 1.0], 0.0, angles=(math.radians(1), 0.0, math.radians(0.5)), orbits=100_000, tolerance=1e-8)
print(
    f"Satellite {of(boom).frequencies[0]:.4f} n, √3 = {math.sqrt(3):.4f}; order {boom.plan.order}, {boom.plan.harmonics} harmonics, error bound {boom.plan.error_bound:.0e} rad"
)
late = 100_000 * TURN - np.linspace(4 * TURN, 0, 600)
figure, axes = plt.subplots(2, 1, figsize=(9, 6), layout="constrained")
plot.librations(boom, late, axes[0])
plot.pole_librations(boom, late, axes[1])
plt.show()
