"""Fit simulated light curves with known answers from 100,000 random starts: measure the time, and test if the answer is found.

    python benches/light_curves.py [--starts 100000] [--curves 8]      prints a table, writes docs/data/light-curves.csv

Each curve is of an ellipsoid 1 : 0.7 : 0.5 in a random state, in the short-axis and the long-axis mode alternately, at 100 random times over about six precession periods, with a noise of 2 %. The starts
have precession periods in a range of more than three to one. "found" means that the state with the least χ² agrees with the true state within 0.15 rad at three times, except for half turns of the body. Elapsed time and
processor time are measured. On a loaded machine the processor time divided by the number of cores estimates the time of an idle machine.
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np

from andoyer import Body, Scene, fit
from andoyer._quaternions import angle_between, product
from andoyer.fit._light_curve import HALF_TURNS
from andoyer.fit._search import random_states

DATA = Path(__file__).resolve().parents[1] / "docs/data/light-curves.csv"
AXES, POINTS, SPAN, NOISE, NEAR = np.array([1.0, 0.7, 0.5]), 100, 6.0, 0.02, 0.15


def simulated(seed):
    """A scene, times, directions, brightnesses and their standard deviation."""
    generator = np.random.default_rng(seed)
    both = random_states(AXES, (0.8, 1.6), 2, generator)
    state = both.part(slice(seed % 2, seed % 2 + 1))
    scene = Scene(Body.ellipsoid(*AXES), state.attitudes[0], state.rates[0])
    times = np.sort(generator.uniform(0, SPAN, POINTS))
    sun, observer = (np.stack([np.cos(angle), np.sin(angle), height + 0 * angle], axis=1) for angle, height in ((0.7 + 0.14 * times, 0.0), (-0.1 * times, 0.1)))
    exact = fit.brightness(AXES, scene.solve().attitude(times), sun, observer)
    sigma = NOISE * exact.mean()
    return scene, times, sun, observer, exact + sigma * generator.standard_normal(POINTS), sigma


def run(seed, starts):
    """One row of the table."""
    scene, times, sun, observer, measured, sigma = simulated(seed)
    wall, processor = time.perf_counter(), time.process_time()
    found = fit.light_curve(AXES, times, measured, sun=sun, observer=observer, sigma=sigma, periods=(0.6, 2.0), starts=starts, rng=seed)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    at = times[[0, POINTS // 2, -1]]
    motion, truth = found.scene.solve(), scene.solve()
    apart = min(angle_between(motion.attitude(at), product(truth.attitude(at), turn[None])).max() for turn in HALF_TURNS)
    wrong = min((optimum.chi_square for optimum in found.optima if optimum.mode != found.optima[0].mode), default=np.nan)
    return {
        "mode": truth.plan.mode, "starts": starts, "points": POINTS, "wall [s]": f"{wall:.1f}", "processor [s]": f"{processor:.1f}", "found": "yes" if apart < NEAR else "no",
        "apart [rad]": f"{apart:.3f}", "chi square": f"{found.chi_square:.1f}", "second": f"{found.optima[1].chi_square:.1f}" if len(found.optima) > 1 else "", "other mode": f"{wrong:.0f}",
    }  # fmt: skip


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--starts", type=int, default=100_000)
    parser.add_argument("--curves", type=int, default=8)
    arguments = parser.parse_args()
    rows = []
    for seed in range(arguments.curves):
        rows.append(run(seed, arguments.starts))
        print("  ".join(f"{name} {value}" for name, value in rows[-1].items()), flush=True)
    with DATA.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
