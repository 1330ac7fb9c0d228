"""
Which method is taken
=====================

`method="auto"` takes the averaged theory where its error bound meets the tolerance, and otherwise integrates the full equations over the span. This page maps the choice for one body over the
rate and the eccentricity of its orbit.
"""

import time
import warnings

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# A triaxial body wobbles by some degrees and turns once in 2π. The tolerance is 1e-4 rad over five orbits. A chaotic motion may miss it: its error bound grows with the distance of nearby
# states, and a `ToleranceWarning` says so.

body = andoyer.Body([0.6, 0.85, 1.0])
state = ([0.1, 0.2, 0.3, 0.86**0.5], [0.12, 0.02, 1.0])
rates = np.geomspace(1e-3, 1.0, 19)
eccentricities = np.linspace(0, 0.9, 7)
integrated = np.zeros((len(eccentricities), len(rates)))
cost, bound = np.zeros_like(integrated), np.zeros_like(integrated)
warnings.simplefilter("ignore", andoyer.ToleranceWarning)  # they are counted
for row, eccentricity in enumerate(eccentricities):
    for column, rate in enumerate(rates):
        orbit = andoyer.Orbit(rate, eccentricity, inclination=0.5, argument_of_pericentre=0.3)
        scene = andoyer.Scene(body, *state, orbit=orbit, span=(0, 10 * np.pi / rate), tolerance=1e-4)
        start = time.perf_counter()
        plan = scene.solve().plan
        cost[row, column] = 1e3 * (time.perf_counter() - start)
        integrated[row, column] = plan.method == "integrated"
        bound[row, column] = plan.error_bound
print(f"{np.count_nonzero(integrated)} of {integrated.size} scenes are integrated")
print(f"set-up, median: theory {np.median(cost[integrated == 0]):.2f} ms, integration {np.median(cost[integrated == 1]):.2f} ms")
print(f"{np.count_nonzero(bound > 1e-4)} miss the tolerance; the largest error bound is {bound.max():.1e} rad")
assert integrated[0, 0] == 0 and integrated[0, -1] == 1

figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for value, colour, label in ((0, "#0072B2", "averaged theory"), (1, "#D55E00", "integration")):
    rows, columns = np.nonzero(integrated == value)
    axes.scatter(rates[columns], eccentricities[rows], c=colour, marker="s", s=60, label=label)
axes.set(xscale="log", xlabel="mean motion / rate of rotation", ylabel="eccentricity")
axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.12), ncols=2, frameon=False)
plt.show()

# %%
# The plan gives the reason. Next to a resonance with the orbit no average exists:

orbit = andoyer.Orbit(rates[-1], inclination=0.5)
print(andoyer.Scene(body, *state, orbit=orbit, span=(0, 30), tolerance=1e-4).solve().plan)
