"""
Years of a dead satellite
=========================

Sunlight turns a dead satellite over years: it spins it up or down, tilts its axis and makes it tumble. The torque comes from its panels, averaged over the rotation.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# An invented satellite: a box, a canted solar array on one side and a trim plate on a boom on the other, in kg and m. The two sides of a plate differ: cells in front, paint behind. Each
# side is a panel of its own.

size, centre = np.array([2.3, 2.0, 1.9]), np.array([0.1, 0.0, 0.0])
walls = np.vstack([np.eye(3), -np.eye(3)])
wall_areas = np.tile([size[1] * size[2], size[0] * size[2], size[0] * size[1]], 2)
array, trim = np.array([0, 0.3, 1]), np.array([0.1, -0.4, 1])
sun = andoyer.Orbit(2 * np.pi / 3.156e7, inclination=np.radians(23.44))
light = andoyer.Torque.panels(
    normals=[*walls, array, -array, trim, -trim],
    areas=[*wall_areas, 11, 11, 1.2, 1.2],
    centroids=[*(walls * size / 2 + centre), [4.2, 0.1, 0.2], [4.2, 0.1, 0.2], [-14, 0, 0.3], [-14, 0, 0.3]],
    specular=[0.25] * 6 + [0.15, 0.05, 0.6, 0.2],
    diffuse=[0.15] * 6 + [0.05, 0.5, 0.1, 0.3],
    pressure=4.56e-6,
    source=sun,
)
print(f"degree {light.degree} leaves out {light.truncation:.1%} of the torque")

# %%
# It rotates about an axis near that of its least moment, once in five minutes, and tumbles. `drift` has the rates now; `evolve` follows the Sun through the years.

moments, year = np.array([980.0, 3430.0, 3570.0]), 3.156e7
pole = np.array([0.1, -0.3, 0.95]) / np.linalg.norm([0.1, -0.3, 0.95])
attitude = np.append(np.cross([1, 0, 0], pole), 1 + pole[0])  # the shortest turn of axis 1 to the pole
momentum = 3570 * 2 * np.pi / 300
rates = momentum * np.array([0.84, 0.0, np.sqrt(1 - 0.84**2)]) / moments
scene = andoyer.Scene(andoyer.Body(moments), attitude / np.linalg.norm(attitude), rates, torques=[light], span=(0, 10 * year))
drift = scene.drift()
print(f"spin period: {86400 * drift.spin_period:+.3f} s a day; a small wobble {'grows' if drift.wobble_rate > 0 else 'decays'}")
evolution = scene.evolve()
print(f"{evolution.end.reason} after {evolution.end.time / year:.1f} of 10 years")

# %%
# The rotation becomes slower and faster as its axis wanders through the seasons of sunlight. The excess of energy, ξ over its value at the separatrix, says how it tumbles: 0 is uniform
# rotation. At 1 the body changes its mode. Which way depends on phases that nobody knows by then, so the evolution ends there; ``evolution.through(16)`` goes on with the probabilities of each. The warning is about the
# direction of the angular momentum, which precesses many times: what the polynomials leave out is counted over its whole way. Period and obliquity hold better.

times = np.linspace(0, evolution.end.time, 2000)
states = evolution.at(times)
figure, axes = plt.subplots(3, 1, sharex=True, figsize=(7, 7), layout="constrained")
axes[0].plot(times / year, states.spin_period)
axes[0].set_ylabel("spin period [s]")
assert states.obliquity is not None, "the scene has an orbit"
axes[1].plot(times / year, np.degrees(states.obliquity))
axes[1].set_ylabel("obliquity [°]")
axes[2].plot(times / year, states.excess / (1 - moments[0] / moments[1]))
axes[2].set(ylabel="ξ / ξ_sep", ylim=(0, 1.05), xlabel="time [years]")
plt.show()
