"""
A light curve: from brightnesses to a predicted attitude
========================================================

A simulated tumbler is observed at a hundred random times over six precession periods, with a noise of 2 %. `andoyer.fit.light_curve` finds its state from random starts, lists
the other minima with their χ², and predicts its attitude with a spread.
"""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import andoyer
from andoyer import fit

generator = np.random.default_rng(1)
axes = [1.0, 0.7, 0.5]
truth = andoyer.Scene(andoyer.Body.ellipsoid(*axes), [0.1, -0.5, 0.3, np.sqrt(0.65)], [5.5, 0.9, 0.6])
times = np.sort(generator.uniform(0, 6, 100))


def direction(longitude: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    return np.stack([np.cos(longitude), np.sin(longitude), height + 0 * longitude], axis=-1)


def sun(t: NDArray[np.float64]) -> NDArray[np.float64]:
    return direction(0.7 + 0.14 * t, 0.0)


def observer(t: NDArray[np.float64]) -> NDArray[np.float64]:
    return direction(-0.1 * t, 0.1)


exact = fit.brightness(axes, truth.solve().attitude(times), sun(times), observer(times))
sigma = 0.02 * exact.mean()
measured = exact + sigma * generator.standard_normal(len(times))

# %%
# The search has ten thousand starts, half of them in each mode. The range of periods is a guess within a factor of about two. Every start is evaluated, and the best are improved with the derivatives
# of the motion.

found = fit.light_curve(axes, times, measured, sun=sun(times), observer=observer(times), sigma=sigma, periods=(0.6, 2.0), starts=10_000)
print(f"reduced χ² {found.reduced_chi_square:.2f}. {found.message}")
for optimum in found.optima[:6]:
    periods = optimum.scene.solve().periods["extremal-axis"]
    print(f"{optimum.mode:10}  χ² {optimum.chi_square:7.1f}   P_φ {periods.precession:.4f}   P_ψ {periods.rotation:.4f}")
wrong = next(optimum for optimum in found.optima if optimum.mode != found.optima[0].mode)
print(f"the best of the other mode: χ² {wrong.chi_square:.0f}")
assert found.optima[0].mode == truth.solve().plan.mode and wrong.chi_square > 10 * found.chi_square

# %%
# The picture shows data and model. The factor between them is a part of the fit.

fine = np.linspace(0, 6, 1500)
model = fit.brightness(axes, found.scene.solve().attitude(fine), sun(fine), observer(fine))
at_times = fit.brightness(axes, found.scene.solve().attitude(times), sun(times), observer(times))
figure, panels = plt.subplots(2, figsize=(9, 5), layout="constrained", height_ratios=[2, 1], sharex=True)
panels[0].plot(fine, model * np.mean(measured / at_times), color="#0072B2", linewidth=1)
panels[0].errorbar(times, measured, sigma, fmt="o", color="#D55E00", markersize=3)
panels[0].set(ylabel="brightness")
found.residual_picture(panels[1])
plt.show()

# %%
# The prediction uses two thousand states drawn from the covariance, and the angle of each from the best state. The angle grows with time after the last point. The true state, which the fit does not use, is within the
# spread. Half turns of the body do not change the brightness, so the true state is compared in all four positions.

later = np.linspace(0, 60, 300)
states = found.ensemble(2000, rng=1)
best, drawn, true = found.scene.solve().rotation(later), states.rotation(later), truth.solve().rotation(later)
apart = np.degrees((best.inv() * drawn).magnitude())
turns = type(best).from_quat([[0, 0, 0, 1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])
truly = np.min([np.degrees((best.inv() * true * turn).magnitude()) for turn in turns], axis=0)
figure, panel = plt.subplots(figsize=(9, 4), layout="constrained")
for part, color in ((50, "#0072B2"), (95, "#D55E00")):
    panel.plot(later, np.percentile(apart, part, axis=0), color=color, label=f"{part} % of the states")
panel.plot(later, truly, "--", color="#222222", label="the truth")
panel.axvspan(0, 6, color="0.92")
panel.set(xlabel="time (data in the grey part)", ylabel="from the best state [°]", ylim=(0, None))
panel.legend(frameon=False)
plt.show()
assert np.mean(truly < np.percentile(apart, 99, axis=0)) > 0.9

# %%
# The corner picture shows the ellipses of one and two standard deviations.

found.corner()
plt.show()
