"""
A dead satellite with a dipole, a damper and a wheel
====================================================

A satellite without control tumbles under the gravity gradient of the Earth. It has a residual magnetic dipole, eddy currents damp it, and one wheel still turns. Each of the three is a
torque of its own, and the motion is integrated with an error bound.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# Units are kg, m and s. The orbit is circular, 700 km above the Earth, and nearly polar. The dipole of 2 A m² lies along body axis 1. The field of a dipole along
# the Earth's axis is B₀ (3 (e·r̂) r̂ − e) (a/r)³ for e antiparallel to the axis: a polynomial in the unit vectors to the Earth, ``r``, and along the field's axis, ``e``.

n = math.sqrt(3.986004415e14 / 7.078e6**3)
earth = andoyer.Orbit(n, inclination=math.radians(98))
moment, field = 2.0, 3.12e-5 * (6.378e6 / 7.078e6) ** 3
along = [f"(3*(e1*r1 + e2*r2 + e3*r3)*r{axis} - e{axis})" for axis in (1, 2, 3)]
torque = ["0", f"{-moment * field}*{along[2]}", f"{moment * field}*{along[1]}"]
dipole = andoyer.Torque.polynomial(torque, sources={"r": earth, "e": [0, 0, -1]})
damper = andoyer.Torque.damping(4e-3)
wheel = andoyer.Torque.rotor([0.0, 0.6, 0.0])

# %%
# Half a day, with the wheel and without it. The plan counts the torques.

body = andoyer.Body([120.0, 150.0, 180.0])
span = (0.0, 43200.0)
start = ([0, 0, 0, 1], [0.004, 0.006, 0.02])
scenes = {
    "gravity gradient alone": [],
    "with dipole and damper": [dipole, damper],
    "with dipole, damper and wheel": [dipole, damper, wheel],
}
motions = {
    name: andoyer.Scene(body, *start, orbit=earth, torques=torques, span=span, tolerance=1e-6, method="integrated").solve() for name, torques in scenes.items()
}
print(motions["with dipole, damper and wheel"].plan)

# %%
# The damper slows the rotation. With the wheel axis 2 ends within 45 degrees of the angular momentum; without it the two stay nearly perpendicular.

times = np.linspace(*span, 600)
figure, (rates, angles) = plt.subplots(2, 1, sharex=True, figsize=(7, 6), layout="constrained")
for name, motion in motions.items():
    rates.plot(times / 3600, 1e3 * np.linalg.norm(motion.angular_velocity(times), axis=1), label=name)
    momentum = motion.angular_momentum(times)
    axis = motion.rotation(times).apply([0.0, 1.0, 0.0])
    cosine = np.sum(momentum * axis, axis=1) / np.linalg.norm(momentum, axis=1)
    angles.plot(times / 3600, np.degrees(np.arccos(np.clip(cosine, -1, 1))))
rates.set_ylabel("rate [mrad/s]")
rates.legend(loc="upper right", fontsize="small")
angles.set_ylabel("axis 2 to momentum [deg]")
angles.set_xlabel("time [h]")
plt.show()
