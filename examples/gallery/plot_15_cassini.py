"""
Cassini states
==============

The orbit of a body precesses: its normal N goes about a fixed axis. The pole of the body precesses about N. In the frame that turns with the node of the orbit the pole moves along closed curves
about the Cassini states (Colombo 1966).
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# An oblate body rotates fifty times as fast as its orbit. Its pole precesses with α = (3/2) (G m/a³) (C − A)/(C ω), the node with three tenths of that.

body, spin, inclination = andoyer.Body([0.9, 0.9, 1.0]), 1.0, 0.3
n = 0.02
alpha = 1.5 * n**2 * 0.1
node_rate = -0.3 * alpha
orbit = andoyer.Orbit(n, inclination=inclination, node_rate=node_rate)
states = andoyer.cassini_states(body, orbit, spin)
for state in states:
    print(state)
assert sum(state.stable for state in states) == 3

# %%
# The pole, by longitude from the plane of both axes and by its distance θ from the normal: curves of constant h = −(α/2) (k·N)² − g (k·ẑ).

longitude, theta = np.meshgrid(np.linspace(-180, 180, 361), np.linspace(0, 180, 181))
along, down = np.radians(longitude), np.radians(theta)
height = np.cos(inclination) * np.cos(down) - np.sin(inclination) * np.sin(down) * np.cos(along)
h = -0.5 * alpha * np.cos(down) ** 2 - node_rate * height
figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
axes.contour(longitude, theta, h, levels=40, colors="#999999", linewidths=0.6)
for state in states:
    place = (0.0 if state.obliquity >= 0 else 180.0, abs(np.degrees(state.obliquity)))
    axes.plot(*place, "o" if state.stable else "X", color="#0072B2" if state.stable else "#D55E00", markersize=9, clip_on=False)
axes.set(xlabel="longitude from the plane of ẑ and N [°]", ylabel="θ [°]", ylim=(180, 0))
plt.show()

# %%
# An integration of the full equations, not averaged at all, from a stable state: the pole follows the node. The wiggles that remain have the size α/n, the torque's effect in one orbit.

state = next(state for state in states if state.stable and state.obliquity < 0)
tilt = inclination + state.obliquity
attitude = [np.sin(tilt / 2), 0.0, 0.0, np.cos(tilt / 2)]
period = 2 * np.pi / state.rate
motion = andoyer.Scene(body, attitude, [0, 0, spin], orbit=orbit, span=(0, period / 2), tolerance=1e-6, method="integrated").solve()
times = np.linspace(0, period / 2, 500)
pole = motion.rotation(times).as_matrix()[:, :, 2]
node = node_rate * times
normal = np.array([np.sin(inclination) * np.sin(node), -np.sin(inclination) * np.cos(node), np.full_like(times, np.cos(inclination))]).T
angle = np.arccos(np.sum(pole * normal, axis=1))
print(f"in half a libration of {period / 2 * spin / (2 * np.pi):.0f} rotations the obliquity stays within {np.abs(angle - abs(state.obliquity)).max():.1e} rad")
assert np.abs(angle - abs(state.obliquity)).max() < 2 * alpha / n

# %%
# A body in a spin–orbit resonance has Cassini states too; the torque on its long axis then has a mean. **The Moon** is in the second state, beyond the normal of the ecliptic. Its orbit is the ellipse
# with the draconic and anomalistic months, the attraction that of the Earth alone at 384,399 km. Times are in days.

anomalistic, draconic, sidereal = (2 * np.pi / period for period in (27.554550, 27.212221, 27.321662))
inclination, node_rate = np.radians(5.145396), -2 * np.pi / 6798.38
attraction = 398600.435 / 384399.014**3 * 86400**2
orbit = andoyer.Orbit(anomalistic, 0.0549, inclination=inclination, node_rate=node_rate, pericentre_rate=draconic - anomalistic, attraction=attraction)
moon = andoyer.Body.named("moon")
state = next(state for state in andoyer.cassini_states(moon, orbit, sidereal) if state.stable and abs(state.obliquity) < 0.5)
tilt = inclination + state.obliquity
print(state)
print(f"inclination of the lunar equator to the ecliptic {abs(np.degrees(tilt)):.4f}°; observed 1.54°")
years = 2 * np.pi / state.rate / 365.25
print(f"period of free precession relative to the node {years:.1f} years; 24 years from laser ranging")
assert state.resonance == 1 and abs(np.degrees(tilt) + 1.54) < 0.01 and abs(years - 24) < 0.5

# %%
# An integration of the full equations over four revolutions of the node starts in this state. The mean pole of the Moon, in the frame of the node, is the predicted one within a thousandth of a degree; around it the
# inclination varies by some minutes of arc, mostly within the month.

span = (0.0, 4 * 6798.38)
rates = [0.0, node_rate * np.sin(tilt), draconic + node_rate * np.cos(tilt)]
motion = andoyer.Scene(moon, [np.sin(tilt / 2), 0.0, 0.0, np.cos(tilt / 2)], rates, orbit=orbit, span=span, tolerance=1e-8).solve()
assert motion.plan.method == "integrated"
times = np.arange(*span, 1.7)
pole = motion.rotation(times).as_matrix()[:, :, 2]
turning = (pole[:, 0] + 1j * pole[:, 1]) * np.exp(-1j * node_rate * times)
mean = np.degrees(np.arcsin(abs(np.average(turning, weights=np.hanning(times.size)))))
inclined = np.degrees(np.arccos(pole[:, 2]))
print(f"mean inclination in 74 years {mean:.4f}°, between {inclined.min():.3f}° and {inclined.max():.3f}°")
assert abs(mean - abs(np.degrees(tilt))) < 1e-3

# %%
# **Mercury** makes three rotations in two orbits. With C/M R² = 0.346 (Margot et al. 2012) the state is at the observed obliquity of 2.04′ ± 0.08′, from which that value was derived.

polar, oblateness, triaxiality = 0.346, 5.03e-5, 4 * 0.81e-5
a = 1 - (oblateness + triaxiality / 2) / polar
mercury = andoyer.Body([a, a + triaxiality / polar, 1.0])
orbit = andoyer.Orbit(2 * np.pi / 87.9693496, 0.20563, inclination=np.radians(8.53), node_rate=-2 * np.pi / (325513 * 365.25))
for state in andoyer.cassini_states(mercury, orbit, np.radians(6.13851804)):
    print(f"{state}, {60 * np.degrees(state.obliquity):.3f}′")
    if state.stable and abs(state.obliquity) < 0.5:
        assert state.resonance == 1.5 and abs(60 * np.degrees(state.obliquity) - 2.04) < 0.08
