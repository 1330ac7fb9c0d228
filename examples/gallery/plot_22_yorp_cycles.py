"""
YORP cycles of an asteroid
==========================

Sunlight that an irregular asteroid scatters and radiates turns its axis and spins it down and up. Where the rotation is slow the asteroid begins to tumble, and a cycle later it passes the separatrix between its modes.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# An invented shape: an ellipsoid of 1 km with six bumps and hollows, as vertices and triangles, in m.

rows, columns = 10, 20
colatitudes, longitudes = np.meshgrid(np.pi * np.arange(1, rows) / rows, 2 * np.pi * np.arange(columns) / columns, indexing="ij")
ring = np.stack([np.sin(colatitudes) * np.cos(longitudes), np.sin(colatitudes) * np.sin(longitudes), np.cos(colatitudes)], axis=-1)
u = np.vstack([[0, 0, 1], ring.reshape(-1, 3), [0, 0, -1]])
triangles = []
for j, k in zip(range(columns), np.roll(range(columns), -1)):
    triangles += [[0, 1 + j, 1 + k], [len(u) - 1, len(u) - 1 - columns + k, len(u) - 1 - columns + j]]
    for first in range(1, 1 + (rows - 2) * columns, columns):
        triangles += [[first + j, first + columns + j, first + k], [first + k, first + columns + j, first + columns + k]]
triangles = np.array(triangles)
random = np.random.default_rng(13)
centres = random.normal(size=(6, 3))
bumps = np.exp(3 * (u @ (centres / np.linalg.norm(centres, axis=1, keepdims=True)).T - 1))
vertices = 500 * (1 + bumps @ random.uniform(-0.12, 0.18, 6))[:, None] * u * [1.15, 1.0, 0.85]

# %%
# The inertia of the solid is a sum over tetrahedra with a corner at the centre. Facets and body are brought to the principal axes of the centre of mass.


def solid(vertices, triangles, density):
    """The centre of mass, and the tensor of ∫ x xᵀ dm about the origin."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    masses = density / 6 * np.sum(a * np.cross(b, c), axis=1)
    squares = sum(np.einsum("i,ij,ik->jk", masses / 20, x, x) for x in (a, b, c, a + b + c))
    return masses @ (a + b + c) / 4 / masses.sum(), squares


vertices -= solid(vertices, triangles, 2000.0)[0]
_, squares = solid(vertices, triangles, 2000.0)
axes = np.linalg.eigh(np.trace(squares) * np.eye(3) - squares)[1]
axes[:, 0] *= np.linalg.det(axes)
vertices = vertices @ axes
along = np.diag(axes.T @ squares @ axes)
body = andoyer.Body(along.sum() - along)
print("moments over the largest:", np.round(body.moments / body.moments[2], 3))

# %%
# It rotates once in ten hours with a wobble of a few degrees, 1 au from the Sun. The triangles absorb nine tenths of the light and radiate it at once.

year = 365.25 * 86400.0
sun = andoyer.Orbit(2 * np.pi / year, semi_major_axis=1.496e11)
light = andoyer.Torque.from_facets(vertices, triangles, diffuse=0.1, pressure=4.56e-6, at=1.496e11, source=sun)
print(f"degree {light.degree} leaves out {light.truncation:.1%} of the torque")
tilt, wobble = np.radians(60), np.radians(4)
rates = 2 * np.pi / 36000 * body.moments[2] * np.array([0, np.sin(wobble), np.cos(wobble)]) / body.moments
scene = andoyer.Scene(body, [np.sin(tilt / 2), 0, 0, np.cos(tilt / 2)], rates, torques=[light])
evolution = scene.evolve((0, 3e7 * year))
print(f"{evolution.end.reason} after {evolution.end.time / 1e6 / year:.1f} million years")

# %%
# The torque brakes the rotation, while its axis turns towards the normal of the orbit. Where the rotation is slowest, tumbling grows at once: ξ over its value on the separatrix goes from near 0 to most of the way. Then the body spins up again
# and keeps tumbling, until the next slow phase brings it to the separatrix. The polynomials leave out a part of the torque in each of these years, so the dates are those of one possible motion. Which mode follows depends on phases that nobody knows: the evolution ends.

times = np.linspace(0, evolution.end.time, 3000)
states = evolution.at(times)
figure, panels = plt.subplots(3, 1, sharex=True, figsize=(7, 7), layout="constrained")
panels[0].plot(times / 1e6 / year, states.spin_period / 3600)
panels[0].set_ylabel("spin period [h]")
panels[1].plot(times / 1e6 / year, np.degrees(states.obliquity))
panels[1].set_ylabel("obliquity [°]")
panels[2].plot(times / 1e6 / year, states.excess / (body.moments[2] / body.moments[1] - 1))
panels[2].set(ylabel="ξ / ξ_sep", ylim=(0, 1.05), xlabel="time [million years]")
plt.show()
