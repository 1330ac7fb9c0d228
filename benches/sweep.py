"""Measure the series and the closed form: error, set-up and time of a sample as functions of order, σ/σ_sep and β.

    make sweep      writes docs/data/sweep.csv, docs/work-precision.png and the table in docs/series-or-closed.md

For every β and σ/σ_sep there is one motion over 100 rotations, found by bisection on the angle J at the epoch. The series are solved at every order from 1 to 40, with
the harmonics above an eighth of the error of this order, and at the order that a tolerance needs. The
closed form is solved at the same tolerances. Errors are the largest at 24 uneven epochs, relative to tests/reference/torque_free.py. Times are processor times of one
thread: the median of 5 calls of `Motion.at` with 20,000 uneven times, and of 5 calls of `Scene.solve` for a body that was solved before.
"""

import os

os.environ["RAYON_NUM_THREADS"] = "1"  # before the library starts any

import csv
import statistics
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple, dataclass, fields
from itertools import product
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "reference"))

import numpy as np
import sweep_picture
from comparison import Reference
from figures import ROOT
from numpy.typing import NDArray

import andoyer

warnings.simplefilter("ignore", andoyer.ToleranceWarning)  # the errors of low orders are measured here

ORDERS = range(1, 41)
RATIOS = (0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)
BETAS = (0.05, 0.5, 0.9)
TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12, 1e-15)
ALPHA = 0.5  # only scales the time (theory §2)
NU, MU = 0.3, 0.7
ROTATIONS = 100
EPOCHS = 24
TIMED_SAMPLES, TIMED_CALLS = 20_000, 5
FINEST = 1e-15  # requests the best accuracy
GOLDEN = 0.618033988749895


@dataclass(frozen=True)
class Row:
    """A line of the table."""

    beta: float
    separatrix_ratio: float
    method: str
    fixed: str  # the fixed quantity: "order" or "tolerance"
    tolerance: float
    order: int
    harmonics: int
    error: float
    bound: float
    setup_us: float
    sample_ns: float


def moments(beta: float) -> list[float]:
    """Moments A < B < C = 1 of a body with this β and α = ALPHA (theory §1)."""
    return [1 / (1 + ALPHA * (1 + beta)), 1 / (1 + ALPHA * (1 - beta)), 1.0]


def state(beta: float, tilt: float) -> tuple[list[float], NDArray[np.float64]]:
    """Attitude and body rates with J = `tilt`, M = 1, ν = NU, μ = MU, I = 0."""
    g = [np.sin(tilt) * np.sin(NU), np.sin(tilt) * np.cos(NU), np.cos(tilt)]
    s, c = np.sin(tilt / 2), np.cos(tilt / 2)
    half, difference = (MU + NU) / 2, (MU - NU) / 2
    attitude = [s * np.cos(difference), s * np.sin(difference), c * np.sin(half), c * np.cos(half)]
    return attitude, np.divide(g, moments(beta))


def scene(beta: float, ratio: float) -> tuple[andoyer.Body, list[float], NDArray[np.float64], tuple[float, float]]:
    """Body, attitude, rates and span of the motion at σ/σ_sep = `ratio`."""
    body = andoyer.Body(moments(beta))
    # Short-axis mode ends where sin²J (1 − β cos 2ν) = 1 − β (theory §5).
    low, high = 0.0, np.arcsin(np.sqrt((1 - beta) / (1 - beta * np.cos(2 * NU))))
    for _ in range(60):
        tilt = (low + high) / 2
        plan = andoyer.Scene(body, *state(beta, tilt)).solve().plan
        low, high = (tilt, high) if plan.separatrix_ratio < ratio else (low, tilt)
    attitude, rates = state(beta, low)
    period = 2 * np.pi / andoyer.Scene(body, attitude, rates).solve().frequencies.longitude
    return body, attitude, rates, (0.0, ROTATIONS * period)


def uneven(span: tuple[float, float], count: int) -> NDArray[np.float64]:
    """`count` ascending times over the span. Except for the end, no time is a rational part of the span."""
    times: NDArray[np.float64] = span[1] * np.sort([*(GOLDEN * k % 1.0 for k in range(1, count)), 1.0])
    return times


def reference(case: tuple[float, float]) -> Reference:
    """The true attitudes of one motion."""
    body, attitude, rates, span = scene(*case)
    return Reference(body.moments, attitude, rates, uneven(span, EPOCHS))


def processor_time(call: Callable[[], object]) -> float:
    """Median of the processor time [s] of a call. Short calls are repeated until the time can be measured."""
    repeats = 1
    durations: list[float] = []
    while len(durations) < TIMED_CALLS:
        start = time.process_time_ns()
        for _ in range(repeats):
            call()
        elapsed = time.process_time_ns() - start
        if elapsed < 200_000:
            repeats *= 2
            durations.clear()
        else:
            durations.append(elapsed / repeats * 1e-9)
    return statistics.median(durations)


def measured(case: tuple[float, float], motion: andoyer.Motion, truth: Reference, fixed: str) -> Row:
    """The row of one motion."""
    times = uneven(motion.scene.span or (0.0, 1.0), TIMED_SAMPLES)
    plan, tolerance = motion.plan, motion.scene.tolerance
    setup = round(1e6 * processor_time(motion.scene.solve), 2)
    sample = round(1e9 / TIMED_SAMPLES * processor_time(lambda: motion.at(times)), 2)
    numbers = [float(f"{x:.3g}") for x in (tolerance, truth.largest_error(motion), plan.error_bound)]
    return Row(*case, plan.method, fixed, numbers[0], plan.order, plan.harmonics, numbers[1], numbers[2], setup, sample)


def rows(case: tuple[float, float], truth: Reference) -> Iterator[Row]:
    """All rows of one β and σ/σ_sep."""
    body, attitude, rates, span = scene(*case)

    def solved(**keywords: Any) -> andoyer.Motion:
        return andoyer.Scene(body, attitude, rates, span=span, **keywords).solve()

    for order in ORDERS:
        error = truth.largest_error(solved(method="series", order=order, tolerance=FINEST))
        motion = solved(method="series", order=order, tolerance=max(error, FINEST))
        yield measured(case, motion, truth, "order")
    for method, tolerance in product(("series", "closed"), TOLERANCES):
        try:
            yield measured(case, solved(method=method, tolerance=tolerance), truth, "tolerance")
        except andoyer.TheoryError:
            pass  # the series do not meet this tolerance


def main() -> None:
    cases = list(product(BETAS, RATIOS))
    with ProcessPoolExecutor(2) as pool:
        truths = list(pool.map(reference, cases))
    table: list[Row] = []
    for case, truth in zip(cases, truths, strict=True):
        table += rows(case, truth)
        print(f"β = {case[0]:<5} σ/σ_sep = {case[1]:<5} {len(table):>5} rows", file=sys.stderr, flush=True)
    path = ROOT / "docs" / "data" / "sweep.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(field.name for field in fields(Row))
        writer.writerows(astuple(row) for row in table)
    sweep_picture.write_table(table, ROOT / "docs" / "series-or-closed.md")
    sweep_picture.draw(table, ROOT / "docs" / "work-precision.png")


if __name__ == "__main__":
    main()
