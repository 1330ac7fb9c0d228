"""
Toutatis: a state from radar attitudes
======================================

In December 1992 radar measured the attitude of Toutatis on seventeen days (Takahashi, Busch and Scheeres 2013). `andoyer.fit.attitudes` finds the free rotation that fits these attitudes, and its uncertainty.
"""

import csv
import sys
from datetime import datetime
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial.transform import Rotation

import andoyer
from andoyer import fit

DATA = Path(sys.argv[0]).resolve().parents[2] / "tests/data/toutatis_attitudes.csv"
rows = list(csv.DictReader(line for line in DATA.read_text().splitlines() if not line.startswith("#")))
dates = [datetime.fromisoformat(row["utc"]) for row in rows]
days = np.array([(date - dates[0]).total_seconds() / 86400 for date in dates])
angles = [[float(row[name]) for name in ("alpha", "beta", "gamma")] for row in rows]
measured = Rotation.from_euler("ZXZ", angles, degrees=True)

# %%
# The search begins with the attitude and the rates of the first row, and with round numbers for the moments. Body axis 3 is the long axis. The standard deviation of 5° about each axis is a guess. The fit
# confirms it, since the reduced χ² is near 1.

rates = np.radians([float(rows[0][name]) for name in ("w1", "w2", "w3")])
guess = andoyer.Scene(andoyer.Body([3.0, 3.2, 1.0]), measured[0], rates)
found = fit.attitudes(guess, days, measured, sigma=np.radians(5))
apart = np.degrees(np.linalg.norm(found.residuals, axis=1))
rms = np.sqrt(np.mean(apart**2))
print(f"rms {rms:.2f}°, median {np.median(apart):.2f}°, reduced χ² {found.reduced_chi_square:.2f}")
print(found.message)
assert 7 < rms < 8

# %%
# The spread of the periods comes from a thousand states drawn from the covariance, which are solved in one call. Published periods are 5.41 d and 7.35 d (Hudson and Ostro 1995, abstract), and 5.38 d and
# 7.40 d (Zhao et al. 2015).

states = found.ensemble(1000, rng=1)
best, spread = found.scene.solve().periods["long-axis"], states.periods["long-axis"]
for name, value, values in zip(("P_φ", "P_ψ"), best, spread):
    print(f"{name} of the long axis {value:.3f} ± {values.std():.3f} d")
ratios = states.moments[:, :2] / states.moments[:, 2:]
print("moments over that of the long axis", (found.scene.body.moments[:2] / found.scene.body.moments[2]).round(2), "±", ratios.std(axis=0).round(2))
assert 5.37 < best.rotation < 5.38 and 7.39 < best.precession < 7.45

# %%
# The first picture shows the residuals, the second the correlations. The moments are correlated with each other and with the rates.

found.residual_picture()
plt.show()
found.corner()
plt.show()

# %%
# The angle between the best state and the drawn states grows with time, because their periods differ.

later = np.linspace(0, 400, 200)
best_at, drawn_at = found.scene.solve().rotation(later), states.rotation(later)
angle = np.degrees((best_at.inv() * drawn_at).magnitude())
figure, axes = plt.subplots(figsize=(8, 3.5), layout="constrained")
for part, color in ((50, "#0072B2"), (95, "#D55E00")):
    axes.plot(later, np.percentile(angle, part, axis=0), color=color, label=f"{part} % of the states")
axes.set(xlabel="days after 2 December 1992", ylabel="from the best state [°]", ylim=(0, 180))
axes.legend(frameon=False)
plt.show()

# %%
# Why this does not predict 2008
# ------------------------------
#
# A free rotation from 1992 does not predict the attitude that radar measured in November 2008, for two reasons. First, the spread above exceeds 90° long before. Second, the rotation is not free.
# Toutatis passes the Earth every four years, and the torques of the Earth and the Sun change its angular momentum at each passage. Takahashi et al. fit the moments with these
# torques. The averaged theory of this package needs a periodic orbit and does not hold for such passages.
