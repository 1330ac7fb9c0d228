"""
The Earth's free wobble
=======================

A rigid Earth whose angular momentum is 0.2 arcseconds from its axis of figure: the axis goes round in Euler's 304 days. (The real Earth is
not rigid, and takes longer.)
"""

import math

import andoyer
import matplotlib.pyplot as plt
import numpy as np
from andoyer import plot

# %%
# A body of the catalogue, in the units of its greatest moment. The state: the axis of figure 3 stands at the inertial z, and the rotation axis is
# 0.2 arcseconds away. Time in seconds.

ARCSECOND = math.pi / 648000
STELLAR_DAY = 86400 / 1.00273781191135448  # Earth rotation angle of IAU 2000
earth = andoyer.Body.named("earth")
spin = 2 * math.pi / STELLAR_DAY
rates = [0.2 * ARCSECOND * spin, 0, spin]
scene = andoyer.Scene(earth, attitude=[0, 0, 0, 1], angular_velocity=rates, name="Earth, free wobble")
motion = scene.solve()
print(motion.plan)

# %%
# The period of the wobble is P_ψ; the sample after a whole number of them has the axis where it was.

wobble = motion.periods["short-axis"].rotation
print(f"{wobble / 86400:.1f} days")
assert 303 < wobble / 86400 < 305
start, end = motion.angular_velocity([0.0, 10 * wobble])
assert np.allclose(start, end, rtol=0, atol=1e-12 * spin)

# %%
# The path of the angular momentum in the body is an ellipse that is almost a circle: A and B differ by two parts in 100,000.

axes = plot.polhode_near_pole(motion)
plt.show()

# %%
# A billion rotations are no further than one: attitude and rates are computed, not integrated.

print(motion.attitude(1e9 * STELLAR_DAY), motion.plan.error_bound)
