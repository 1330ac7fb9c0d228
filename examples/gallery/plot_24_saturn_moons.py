"""
Moons of Saturn: Epimetheus, Janus, and the horizon of Hyperion
===============================================================

Two moons keep a face to Saturn and swing about it; a third one cannot, and its attitude is lost after some months. The bodies are rigid, of degree 2, on a fixed ellipse.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import andoyer

TURN = 2 * math.pi

# %%
# **Epimetheus and Janus.** Noyelles (2010, Icarus 207, 887, abstract) has proper periods in longitude of 0.747 and 1.267 d, for the shapes that Cassini saw. Without the other terms such a period is that of
# the orbit divided by √(3(B − A)/C), which gives (B − A)/C. The eccentricities, 0.0097 and 0.0068, are those of
# Jacobson et al. (2008), at second hand; the orbit takes 0.6945 d.
# `Scene.locked` finds the relaxed state, whose forced libration is what images show.

PERIOD = 0.6945
moons = {"Epimetheus": (0.747, 0.0097), "Janus": (1.267, 0.0068)}


def relaxed(ratio: float, eccentricity: float) -> andoyer.Libration:
    """The relaxed libration of a moon with this (B − A)/C; B, on which the longitude hardly depends, is 0.95 C."""
    orbit = andoyer.Orbit(TURN / PERIOD, eccentricity)
    libration = andoyer.Scene.locked(andoyer.Body([0.95 - ratio, 0.95, 1.0]), orbit, span=(0, 365.25), tolerance=1e-3, method="libration").solve().libration
    assert libration is not None
    return libration


def amplitude(libration: andoyer.Libration) -> float:
    """The largest forced term of the longitude [°]."""
    return math.degrees(max(term.amplitude for term in libration.forced() if term.angle == "longitude"))


found = {}
for name, (proper, eccentricity) in moons.items():
    ratio = (PERIOD / proper) ** 2 / 3
    libration = relaxed(ratio, eccentricity)
    found[name] = ratio, amplitude(libration)
    print(f"{name:10}  (B − A)/C {ratio:.3f}: forced {found[name][1]:.2f}°, proper period in longitude {libration.periods[0]:.3f} d")
assert abs(found["Epimetheus"][1] - 5.9) < 1.2 and found["Janus"][1] < 0.5

# %%
# Tiscareno, Thomas and Burns (2009, Icarus 204, 254) measured 5.9 ± 1.2° for Epimetheus. Its proper period is next to that of the orbit: a small change of the shape moves the amplitude far. The curves are
# those of the normal form, the dashed ones 2e ω²/(n² − ω²), its first order.

figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
ratios = np.linspace(0.05, 0.295, 40)
for (name, (_, eccentricity)), color in zip(moons.items(), ("#0072B2", "#D55E00"), strict=True):
    axes.plot(ratios, [amplitude(relaxed(ratio, eccentricity)) for ratio in ratios], color=color, label=name)
    axes.plot(ratios, np.degrees(2 * eccentricity * 3 * ratios / (1 - 3 * ratios)), "--", color=color, linewidth=1)
    axes.plot(*found[name], "o", color=color)
axes.axhspan(5.9 - 1.2, 5.9 + 1.2, color="0.9", label="measured, Epimetheus")
axes.set(xlabel="(B − A)/C", ylabel="forced libration [°]", yscale="log")
axes.legend(frameon=False)
plt.show()

# %%
# **Hyperion** cannot be synchronous: in the plane of its orbit that state is stable, but a small angle out of the plane grows (Wisdom, Peale and Mignard 1984, Icarus 58, 137).

hyperion, orbit = andoyer.Body.named("hyperion"), andoyer.Orbit(TURN / 21.28, 0.1230)
try:
    andoyer.Scene.locked(hyperion, orbit)
except andoyer.TheoryError as error:
    print(error)

# %%
# So its attitude has a horizon. From a start 6° from this state an integration in doubles knows nothing after some 600 d: the error says until when the tolerance holds, and until when anything is known.

attitude, rates = [math.sin(0.05), 0.0, 0.0, math.cos(0.05)], [0.0, 0.0, TURN / 21.28]
try:
    andoyer.Scene(hyperion, attitude, rates, orbit=orbit, span=(0, 4000), tolerance=1e-6).solve()
except andoyer.TheoryError as error:
    print(error)

# %%
# Forty bodies whose attitudes differ by some 0.01° at the epoch point anywhere after 250 d.

generator = np.random.default_rng(1)
attitudes = np.array(attitude) + np.radians(0.01) / 2 * generator.standard_normal((40, 4))
attitudes /= np.linalg.norm(attitudes, axis=1)[:, None]
times = np.linspace(0, 450, 226)
clones = andoyer.Ensemble(None, attitudes, rates, bodies=[hyperion] * 40, orbit=orbit, span=(0, 450), tolerance=1e-6)
first, others = clones[0].rotation(times), [clone.rotation(times) for clone in clones[1:]]
apart = np.degrees([(first.inv() * other).magnitude() for other in others])
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
for part, color in ((50, "#0072B2"), (90, "#D55E00")):
    axes.semilogy(times, np.percentile(apart, part, axis=0), color=color, label=f"{part} % of the bodies are nearer")
axes.set(xlabel="time [d]", ylabel="apart [°]")
axes.legend(frameon=False)
plt.show()
assert np.median(apart[:, 0]) < 0.03 and np.median(apart[:, -1]) > 20
