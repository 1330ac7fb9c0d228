"""
A thousand CubeSats: how many are captured?
===========================================

A long satellite that is released pointing to the Earth, with a small rate that nobody chose, either librates about the direction to the Earth or tumbles. How large may the rates be? A thousand members answer, two
hundred for each of five spreads.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# A 3U CubeSat, its long axis along body axis 3, on a low orbit of 95 minutes. All are released pointing to the Earth (axis 3 of LVLH), with normal errors of the rates about each axis.

DEGREE = np.pi / 180
body = andoyer.Body([0.030, 0.033, 0.010])
orbit = andoyer.Orbit(1.107e-3, 0.001)
spreads = [0.01, 0.03, 0.06, 0.1, 0.3]  # of the rates [degrees/s]; the orbit turns by 0.063
members = 200
random = np.random.default_rng(22)
rates = np.concatenate([spread * DEGREE * random.normal(size=(members, 3)) for spread in spreads])
day = 86400.0
released = andoyer.Ensemble.from_orbital(body, [0, 0, 0], rates, orbit=orbit, elements_of="rotating", frame="lvlh", span=(0, day), tolerance=1e-4, errors="nan")

# %%
# The angle between the long axis and the direction to the Earth, over a day. Members at the border tumble chaotically: their error bounds exceed the tolerance, and the warning counts
# them. From the time on at which the bound of a member is half a turn its rows are NaN, ``plans[i].known`` has the time, and it does not count as captured. A member is captured if it never turns its other end to the Earth.

times = np.linspace(0, day, 400)
seen = released.orbital(times, elements_of="rotating", frame="lvlh")
x, y, *_ = np.moveaxis(seen.attitude, -1, 0)
angle = np.degrees(np.arccos(np.clip(1 - 2 * (x**2 + y**2), -1, 1)))
groups = angle.reshape(len(spreads), members, -1)
turned = np.nanmax(groups, axis=2) > 90
lost = np.isnan(groups[:, :, -1])
captured = (~turned & ~lost).mean(axis=1)
for spread, share in zip(spreads, captured, strict=True):
    print(f"{spread:5.2f} °/s: {share:6.1%} captured")
print(f"{lost.sum()} of {lost.size} are unknown at the end of the day")

# %%
# The answer: rates well below that of the orbit are held, rates above it are not.

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
left.semilogx(spreads, 100 * captured, "o-", color="#0072B2")
left.axvline(np.degrees(orbit.mean_motion), color="#999999", linestyle="--", label="rate of the orbit")
left.set(xlabel="spread of the rates at release [°/s]", ylabel="captured for a day [%]", ylim=(0, 105))
left.legend(frameon=False)
for spread, group, colour in zip(spreads[:3], groups[:3], ["#0072B2", "#009E73", "#D55E00"], strict=True):
    low, middle, high = np.nanquantile(group, [0.05, 0.5, 0.95], axis=0)
    right.fill_between(times / 3600, low, high, color=colour, alpha=0.15)
    right.plot(times / 3600, middle, color=colour, label=f"{spread} °/s")
right.set(xlabel="hours after release", ylabel="long axis from the direction to the Earth [°]", xlim=(0, 12))
right.legend(frameon=False, title="median, 5 to 95 %")
plt.show()
