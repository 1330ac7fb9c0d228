"""
From published periods to motions
=================================

Observers publish periods, a mode, and axis ratios or moments. `Scene.from_periods` finds the state that has these periods. This example compares three published solutions of Apophis and
computes the motion of Toutatis. For 2008 TC3 the authors found no published moments; there the periods give a condition on the moments.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

HOUR, DAY = 3600.0, 86400.0

# %%
# Light-curve papers of short-axis tumblers give the periods of the short axis. Each entry has the moments in units of the largest, P_φ and P_ψ in hours, and where it was
# read the direction of the angular momentum, as ecliptic longitude and latitude in degrees. Without a direction the angular momentum is along inertial axis 3.

solutions = {
    "Pravec et al. 2014": ([0.61, 0.965, 1.0], 27.38, 263.0, None),
    "Brozović et al. 2018": ([0.729, 0.947, 1.0], 27.45, 265.7, (246.8, -59.3)),
    "Lee et al. 2022": ([0.64, 0.97, 1.0], 27.38547, 264.178, (275, -85)),
}
motions = {}
for paper, (moments, precession, rotation, pole) in solutions.items():
    direction = (0, 0, 1) if pole is None else np.radians(pole)
    scene = andoyer.Scene.from_periods(andoyer.Body(moments), precession * HOUR, rotation * HOUR, momentum_direction=direction)
    motions[paper] = scene.solve()
    long_axis = motions[paper].periods["long-axis"].precession / HOUR
    print(
        f"{paper:21} E/E0 {motions[paper].energy_ratio:.5f}   k² {motions[paper].elliptic_parameter:.3f}   "
        f"σ/σ_sep {motions[paper].plan.separatrix_ratio:.3f}   long axis {long_axis:.2f} h"
    )
assert abs(motions["Pravec et al. 2014"].energy_ratio - 1.02364) < 5e-6  # published: 1.024 ± 0.013

# %%
# The three solutions agree in the precession of the long axis, which determines the light curve. They differ in the nutation of the short axis.

times = np.linspace(0, 263 * HOUR, 2000)
figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
for (paper, motion), color in zip(motions.items(), ["#0072B2", "#D55E00", "#009E73"]):
    _, _, _, _, total, axial = motion.andoyer(times).T
    axes.plot(times / HOUR, np.degrees(np.arccos(axial / total)), color=color, label=paper)
axes.set(xlabel="time [h]", ylabel="short axis from the angular momentum [°]")
axes.legend(frameon=False)
plt.show()

# %%
# Toutatis is in a long-axis mode. Radar papers give the periods of its long axis, 7.40 and 5.38 days (Zhao et al. 2015), and the ratio of its moments, 1 : 3.0836 : 3.235 (Takahashi et al. 2013).

toutatis = andoyer.Scene.from_periods(
    andoyer.Body([1.0, 3.0836, 3.235]), 7.40 * DAY, 5.38 * DAY, mode="long-axis", momentum_direction=np.radians([180.2, -54.75])
)
motion = toutatis.solve()
times = np.linspace(0, 5.38 * DAY, 2001)
momentum = motion.angular_velocity(times) * toutatis.body.moments
tilt = np.degrees(np.arccos(momentum[:, 0] / np.linalg.norm(momentum, axis=1)))
print(f"Toutatis: k² {motion.elliptic_parameter:.3f}, the long axis stays {tilt.min():.1f}° to {tilt.max():.1f}° from the angular momentum")
assert round(motion.elliptic_parameter, 3) == 0.032

# %%
# A body cannot have every pair of periods: P_ψ/P_φ has a smallest value, for rotation about the axis of the mode. Here the two periods are exchanged, and the error states the possible interval.

try:
    andoyer.Scene.from_periods(andoyer.Body([0.61, 0.965, 1.0]), 263 * HOUR, 27.38 * HOUR)
except andoyer.InputError as problem:
    print(problem)

# %%
# 2008 TC3 turned about its long axis in 99.20 s, and this axis precessed in 97.00 s (Scheirich et al. 2010, abstract). In a long-axis mode P_ψ/P_φ ≥ 1/g − 1 with
# g² = (1 − A/C)(1 − A/B). Therefore g ≥ 0.4944, which excludes the bodies in the dark region.

ratio = 99.20 / 97.00
least = 1 / (1 + ratio)
print(f"2008 TC3: P_ψ/P_φ = {ratio:.4f}, √((1 − A/C)(1 − A/B)) ≥ {least:.4f}")
first = np.linspace(0.02, 0.98, 97)
reach = np.full((len(first), len(first)), np.nan)
for row, b in enumerate(first):
    for column, a in enumerate(first):
        if a < b and a + b > 1:
            low, _ = andoyer.Body([a, b, 1.0]).period_ratios("long-axis")
            reach[row, column] = low <= ratio
            assert (low <= ratio) == (np.sqrt((1 - a) * (1 - a / b)) >= least)
figure, axes = plt.subplots(figsize=(6, 5), layout="constrained")
axes.pcolormesh(first, first, reach, cmap="cividis", vmin=-0.5, vmax=1.2)
axes.set(xlabel="A/C", ylabel="B/C", title="bodies that can have the periods of 2008 TC3 (light)")
plt.show()
