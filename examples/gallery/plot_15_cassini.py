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
