"""Measure run time against error for each engine, and write docs/data/work-precision.csv.

    python benches/work_precision.py          takes two minutes; `make bench` runs it after criterion

The scenes are six of tests/data/torque_free.json, from t = 0 to 200π (a hundred rotations), with 20,000 uneven times. The engines are andoyer's series by order, its closed form by
tolerance, and the engines of benches/rivals that need only SciPy: Jacobi's closed form with SciPy's special functions, and DOP853 with dense output by tolerance. `make rivals` has more engines.
Times are CPU seconds of one process, with calls from Python, as medians of seven rounds in which the engines take turns. Errors are relative to tests/reference/enclosures.py at 60 of the times.
"""

import csv
import os
import sys
import warnings
from pathlib import Path
from statistics import median

os.environ["RAYON_NUM_THREADS"] = "1"

sys.path.insert(0, str(Path(__file__).resolve().parent / "rivals"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "reference"))

import enclosures
import motions
import numpy as np
import propagators
from figures import ROOT

import andoyer

warnings.simplefilter("ignore", andoyer.ToleranceWarning)  # the errors of low orders are measured here

SCENES = ("earth", "ceres", "eros", "triaxial", "apophis", "near-separatrix-1e-2")
ORDERS = (0, 1, 2, 4, 6, 8, 12, 16, 20, 30, 40, 60)
TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12, 1e-15)
STEPS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13)
SAMPLES, CHECKED, ROUNDS, LONG_ROUNDS, LONG_SECONDS = 20_000, 60, 7, 3, 0.2
OUTPUT = ROOT / "docs" / "data" / "work-precision.csv"


class Fixed(propagators.Own):
    """The series of andoyer at one order, or its closed form at one tolerance."""

    def __init__(self, scene, times, method, order=None, tolerance=1e-15):
        self.asked = {"method": method, "order": order, "tolerance": tolerance, "span": (float(times[0]), float(times[-1]))}
        super().__init__(scene, times, method)

    def prepare(self):
        scene = self.scene
        return andoyer.Scene(andoyer.Body(scene.moments), scene.attitude, scene.rates, **self.asked).solve()


class Dop853(propagators.ScipyDop853):
    """SciPy's DOP853 with dense output, at one tolerance."""

    def __init__(self, scene, times, tolerance):
        super().__init__(scene, times)
        self.tolerance = tolerance


def engines(scene, times):
    """(engine, setting, maker) of all engines. A maker raises `Unfit` if its engine does not serve the scene."""
    yield from (("series", order, lambda order=order: Fixed(scene, times, "series", order)) for order in ORDERS)
    yield from (("closed form", x, lambda x=x: Fixed(scene, times, "closed", None, x)) for x in TOLERANCES)
    yield "SciPy closed form", "–", lambda: propagators.ScipyClosed(scene, times)
    yield from (("SciPy DOP853", x, lambda x=x: Dop853(scene, times, x)) for x in STEPS)


def truth(scene, times, indices):
    """The true attitudes at some of the times, as sums of two doubles."""
    attitudes, _ = enclosures.solve(scene.moments, scene.attitude, scene.rates, times[indices])
    parts = np.array([[enclosures.split(x) for x in row] for row in attitudes])
    return parts[..., 0], parts[..., 1]


def largest_error(rows, high, low):
    """The largest angle [rad] from the truth."""
    rows = rows[:, :4] / np.linalg.norm(rows[:, :4], axis=1, keepdims=True)
    sign = np.sign(np.sum(rows * high, axis=1, keepdims=True))
    return float((2 * np.linalg.norm((sign * rows - high) - low, axis=1)).max())


def measured(scene):
    """The rows of one scene."""
    inner = np.random.default_rng(2017).uniform(0, motions.STOP, SAMPLES - 2)
    times = np.concatenate([[0.0], np.sort(inner), [motions.STOP]])
    indices = np.unique(np.linspace(0, SAMPLES - 1, CHECKED).round().astype(int))
    high, low = truth(scene, times, indices)
    fit, seconds = {}, {}
    for engine, setting, make in engines(scene, times):
        try:
            fit[engine, setting] = make()
        except propagators.Unfit:
            continue
    for turn in range(ROUNDS):
        for key, engine in fit.items():
            if turn < LONG_ROUNDS or seconds[key][0][0] + seconds[key][0][1] < LONG_SECONDS:
                seconds.setdefault(key, []).append(engine.measure()[:2])
    for (engine, setting), runs in seconds.items():
        set_up, samples = (median(run[k] for run in runs) for k in (0, 1))
        error = largest_error(np.asarray(fit[engine, setting].rows(indices)), high, low)
        yield {
            "scene": scene.name,
            "engine": engine,
            "setting": setting,
            "error": f"{error:.3g}",
            "setup_us": f"{1e6 * set_up:.4g}",
            "sample_ns": f"{1e9 * samples / SAMPLES:.4g}",
            "whole_ms": f"{1e3 * (set_up + samples):.4g}",
        }


def main():
    rows = []
    for scene in motions.scenes(SCENES):
        rows += measured(scene)
        print(f"{scene.name}: {sum(row['scene'] == scene.name for row in rows)} settings", file=sys.stderr, flush=True)
    with open(OUTPUT, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"{len(rows)} settings: {OUTPUT.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
