"""
The Earth's free wobble
=======================

The example is a rigid Earth whose rotation axis is 0.2 arcseconds from its axis of figure. The rotation axis moves around the axis of figure with Euler's period of 304 days. (The
period of the real Earth is longer, because the Earth is not rigid.)
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import andoyer
from andoyer import plot

# %%
# The catalogue gives the moments of the Earth in units of the greatest moment. In the initial state the axis of figure (body axis 3) points along inertial z, and the rotation axis is
# 0.2 arcseconds away from it. Time is in seconds.

ARCSECOND = math.pi / 648000
STELLAR_DAY = 86400 / 1.00273781191135448  # Earth rotation angle of IAU 2000
earth = andoyer.Body.named("earth")
spin = 2 * math.pi / STELLAR_DAY
rates = [0.2 * ARCSECOND * spin, 0, spin]
scene = andoyer.Scene(earth, attitude=[0, 0, 0, 1], angular_velocity=rates, name="Earth, free wobble")
motion = scene.solve()
print(motion.plan)

# %%
# The period of the wobble is P_ψ. After ten periods the angular velocity in the body is the initial one.

wobble = motion.periods["short-axis"].rotation
print(f"{wobble / 86400:.1f} days")
assert 303 < wobble / 86400 < 305
start, end = motion.angular_velocity([0.0, 10 * wobble])
assert np.allclose(start, end, rtol=0, atol=1e-12 * spin)

# %%
# The path of the angular momentum in the body is an ellipse that is almost a circle, because A and B differ by two parts in 100,000 only.

axes = plot.polhode_near_pole(motion)
plt.show()

# %%
# The motion is a formula, so an evaluation after a billion rotations takes the same time as one after a single rotation.

print(motion.attitude(1e9 * STELLAR_DAY), motion.plan.error_bound)
