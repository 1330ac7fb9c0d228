"""
An ensemble: how long can we predict the attitude?
==================================================

The moments of Apophis are known to a few percent. This example draws a thousand bodies with moments near the published ones and gives them the same initial state. The spread of their
attitudes shows for how long the orientation is known. `Ensemble` evaluates all bodies in one call.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# A/C and B/C have a standard deviation of one percent. Draws that violate the triangle inequality of the moments are left out.

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
# The attitudes are evaluated at two hundred times over thirty days. The picture shows the angle between each attitude and the attitude of the body with the published moments.

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
# The number of bodies in each mode.

modes, counts = np.unique([plan.mode for plan in ensemble.plans], return_counts=True)
print(dict(zip(modes.tolist(), counts.tolist())))
