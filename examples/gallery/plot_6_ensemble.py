"""
An ensemble: how well do we know where it points?
=================================================

Apophis' moments are known to some percent. A thousand bodies with moments drawn about the published ones, the same state: after how long does nobody know the
orientation any more? `Ensemble` evaluates them all in one call.
"""

import andoyer
import matplotlib.pyplot as plt
import numpy as np

# %%
# The draw: A/C and B/C with a standard deviation of one percent; bodies that cannot be are left out.

generator = np.random.default_rng(1)
middle = andoyer.Body.named("apophis").moments
moments = np.column_stack([middle[:2] * (1 + 0.01 * generator.standard_normal((1200, 2))), np.ones(1200)])
possible = (moments.max(axis=1) <= moments.sum(axis=1) / 2) & (moments[:, 1] < 1)
moments = moments[possible][:1000]

attitude = [0.9936142273587073, 0.039164900723114, -0.09451299087115574, 0.047583319538432894]
rates = [1.7762925277359764e-05, 0.0, 5.530125462483281e-05]
ensemble = andoyer.Ensemble(moments, attitude, rates, tolerance=1e-8)
print(ensemble)

# %%
# Attitudes at two hundred times over thirty days, and the angle between each and that of the published moments.

times = np.linspace(0, 30 * 86400.0, 200)
attitudes = ensemble.attitude(times)
nominal = andoyer.Scene(andoyer.Body.named("apophis"), attitude, rates).solve().attitude(times)
cosine = np.abs(np.einsum("mtk,tk->mt", attitudes, nominal))
apart = np.degrees(2 * np.arccos(np.minimum(cosine, 1)))

figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
days = times / 86400
low, high = np.percentile(apart, [5, 95], axis=0)
axes.fill_between(days, low, high, color="#0072B2", alpha=0.2, label="5 to 95 percent")
axes.plot(days, np.median(apart, axis=0), color="#0072B2", label="median")
axes.set(xlabel="time [d]", ylabel="angle from the published body [deg]", xlim=(0, 30), ylim=(0, 180))
axes.set_title("Apophis with moments known to one percent")
axes.legend(frameon=False, loc="upper left")
plt.show()

# %%
# Which of them tumble in which mode.

modes, counts = np.unique([plan.mode for plan in ensemble.plans], return_counts=True)
print(dict(zip(modes.tolist(), counts.tolist())))
