"""
A box satellite under gravity gradient
======================================

The satellite is a homogeneous box of 1 × 1.2 × 0.6 m. It rotates once a minute about its shortest side, on a circular orbit of 96 minutes. The gravity gradient of the Earth makes
its angular momentum precess about the normal of the orbit. The averaged theory gives this precession in formulas.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import andoyer
from andoyer import plot

# %%
# The moments are those of a box divided by its mass. The orbit is inclined by 30 degrees to the plane of rotation.

a, b, c = 1.0, 1.2, 0.6
box = andoyer.Body([(b * b + c * c) / 12, (a * a + c * c) / 12, (a * a + b * b) / 12], name="box")
orbit = andoyer.Orbit(2 * math.pi / 5760.0, inclination=math.radians(30))
spin = 2 * math.pi / 60
rates = [0.01 * spin, 0, spin]
scene = andoyer.Scene(box, [0, 0, 0, 1], rates, orbit=orbit, tolerance=1e-3, span=(0, 20 * 5760.0))
motion = scene.solve()
print(motion.plan)

# %%
# The angular momentum precesses about the normal of the orbit at the rate (3/2) n²/ω (C − (A+B)/2)/C cos I, with a small oscillation twice an orbit.

axes = plot.pole_path(motion, np.linspace(0, 5 * 5760.0, 2000))
plt.show()

# %%
# The rate of the node over twenty orbits agrees with this formula.

normal = np.array([0.0, -math.sin(math.radians(30)), math.cos(math.radians(30))])
start, end = motion.angular_momentum([0.0, 20 * 5760.0])
across = [vector - normal * (vector @ normal) for vector in (start, end)]
turned = math.atan2(normal @ np.cross(*across), across[0] @ across[1])
least, middle, greatest = np.sort(box.moments)
share = (greatest - (least + middle) / 2) / greatest
rate = -1.5 * orbit.mean_motion**2 / spin * share * math.cos(math.radians(30))
expected = rate * 20 * 5760
print(f"turned by {math.degrees(turned):.3f} degrees; the formula gives {math.degrees(expected):.3f}")
assert abs(turned / expected - 1) < 0.02

# %%
# `plot.summary` shows the whole motion in one figure.

plot.summary(motion, time_unit="s")
plt.show()
