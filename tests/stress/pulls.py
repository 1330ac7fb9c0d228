"""Pulls of fitted light curves: a true value less the fitted one, over its standard deviation, for each parameter.

    python tests/stress/pulls.py [--fits 200] [--out docs/data/pulls.csv]

Each fit has an ellipsoid whose axis ratios are fitted too, in a random state of the short-axis or the long-axis mode, six nights of 40 magnitudes with a noise of 0.02 mag and an unknown zero point each, and
begins next to the true state. Sets whose covariance is none of a normal distribution are left out by a rule that does not use the truth: an angle or a relative change of more than 0.1 as its standard
deviation. Of right errors the mean of the pulls is 0 and their standard deviation 1, to 0.07 and 0.05 for 200 fits. Exit status 1 if a mean is beyond 0.2 or a width outside 0.9 to 1.1; with --out, which records what is so, 0.
"""

import argparse
import csv
import sys

import numpy as np

from andoyer import Body, Scene, fit
from andoyer.fit._search import random_states

AXES, NIGHTS, POINTS, NOISE, LOOSE = np.array([1.0, 0.7, 0.5]), 6, 40, 0.02, 0.1
DEGREE = np.pi / 180
NAMES = ("P_φ", "P_ψ")


def simulated(seed):
    """The true scene, and the arguments of the fit; times in h."""
    generator = np.random.default_rng([73, seed])
    axes = AXES * np.exp(0.1 * generator.standard_normal(3) * [0, 1, 1])
    axes = np.sort(axes)[::-1]
    state = random_states(axes, (5.0, 15.0), 2, generator).part(slice(seed % 2, seed % 2 + 1))
    scene = Scene(Body.ellipsoid(*axes), state.attitudes[0], state.rates[0])
    times = np.concatenate([24.0 * night + np.sort(generator.uniform(0, 7, POINTS)) for night in range(NIGHTS)])
    times -= times[0]
    days = times / 24
    sun = np.stack([np.cos(DEGREE * days), np.sin(DEGREE * days), 0 * days], axis=1)
    observer = np.stack([np.cos(0.5 + 2.5 * DEGREE * days), np.sin(0.5 + 2.5 * DEGREE * days), 0.1 + 0.01 * days], axis=1)
    nights = np.repeat(np.arange(NIGHTS), POINTS)
    zero = 15 + 0.3 * generator.standard_normal(NIGHTS)
    exact = zero[nights] - 2.5 * np.log10(fit.brightness(axes, scene.solve().attitude(times), sun, observer))
    seen = {"sun": sun, "observer": observer, "curves": nights, "sigma": NOISE, "magnitudes": exact + NOISE * generator.standard_normal(len(times))}
    return axes, scene, zero, times, seen


def pulls(seed):
    """The pull of each parameter, both periods and all zero points; None for a set that is left out."""
    axes, scene, zero, times, seen = simulated(seed)
    found = fit.light_curve(axes, times, scene=scene, shape=True, **seen)
    deviations = np.sqrt(np.diag(found.covariance))
    sizes = np.concatenate([np.ones(3), np.full(3, np.linalg.norm(found.scene.angular_velocity)), np.ones(2)])
    if len(found.undetermined) or np.max(deviations / sizes) > LOOSE:
        return None
    turn = (scene.solve().rotation(scene.epoch).inv() * found.scene.solve().rotation(found.scene.epoch)).as_rotvec()
    off = np.concatenate([turn, found.scene.angular_velocity - np.array(scene.angular_velocity), (found.semi_axes / found.semi_axes[0] - axes / axes[0])[1:]])
    row = dict(zip(found.parameters, -off / deviations))
    quantities = {quantity.name: quantity for quantity in _described(found)}
    for name, true in zip(NAMES, scene.solve().periods["extremal-axis"]):
        row[name] = (true - quantities[name].value) / quantities[name].deviation
    points = found.zero_points
    # Brightnesses are in the square of the unit of the axes, as the true zero points are.
    row |= {f"zero point {night + 1}": pull for night, pull in enumerate((zero - points.magnitudes) / points.sigma)}
    return row


def _described(found):
    from andoyer.fit._summary import described

    return described(found._steps, found.covariance, found.undetermined)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--fits", type=int, default=200)
    parser.add_argument("--out", default="")
    arguments = parser.parse_args()
    rows, seed = [], 0
    while len(rows) < arguments.fits:
        row = pulls(seed)
        seed += 1
        if row is not None:
            rows.append(row)
            if len(rows) % 20 == 0:
                print(f"{len(rows)} fits of {seed} sets", flush=True)
    lines = []
    for name in rows[0]:
        values = np.array([row[name] for row in rows])
        inside = [np.mean(np.abs(values) < bound) for bound in (1, 2)]
        line = {"parameter": name, "fits": len(rows), "sets": seed, "mean": f"{values.mean():.2f}", "width": f"{values.std():.2f}"}
        lines.append(line | {"within 1": f"{inside[0]:.3f}", "within 2": f"{inside[1]:.3f}"})
        print("  ".join(f"{key} {value}" for key, value in lines[-1].items()))
    if arguments.out:
        with open(arguments.out, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, lines[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(lines)
        return 0
    return int(any(abs(float(line["mean"])) > 0.2 or not 0.9 <= float(line["width"]) <= 1.1 for line in lines))


if __name__ == "__main__":
    sys.exit(main())
