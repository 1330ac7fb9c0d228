"""The scenes of the propagation benchmarks, their times, and the error of an answer relative to tests/reference/torque_free.py.

A scene is one of tests/data/torque_free.json, from t = 0 to 200π, a hundred rotations of a body that rotates once in 2π.
"""

import json
import math
import sys
from collections import namedtuple
from pathlib import Path

import numpy as np

TESTS = Path(__file__).resolve().parents[2] / "tests"
sys.path.insert(0, str(TESTS / "reference"))

import torque_free  # noqa: E402

NAMES = ("earth", "ceres", "eros", "triaxial", "apophis", "near-separatrix-1e-2", "near-separatrix-1e-6", "long-axis")
GRIDS = ("uneven", "uniform")
STOP = 200 * math.pi
SAMPLES = 100_000
CHECKED = 200  # samples that are compared with the reference
DIGITS = 25
WORST = 1e-2  # rad; a larger error means another motion

Scene = namedtuple("Scene", "name moments attitude rates")
Truth = namedtuple("Truth", "indices attitudes rates")


class WrongAnswer(Exception):
    """The answer of an engine is wrong, and its time does not count."""


def scenes(names):
    with open(TESTS / "data" / "torque_free.json", encoding="utf-8") as file:
        cases = {case["name"]: case for case in json.load(file)}
    for name in names:
        case = cases[name]
        attitude = np.array(case["attitude0_xyzw"])
        yield Scene(name, case["moments"], attitude / math.sqrt(attitude @ attitude), case["angular_velocity0"])


def times(grid):
    """Times from 0 to STOP, in order: a uniform grid, or random ones between the first and the last."""
    if grid == "uniform":
        return np.linspace(0, STOP, SAMPLES)
    inner = np.random.default_rng(20170401).uniform(0, STOP, SAMPLES - 2)
    return np.concatenate([[0.0], np.sort(inner), [STOP]])


def truth(scene, times):
    """The reference at some of the times, including the first and the last."""
    motion = torque_free.TorqueFree(scene.moments, scene.attitude, scene.rates, digits=DIGITS)
    indices = np.unique(np.linspace(0, len(times) - 1, CHECKED).round().astype(int))
    states = [motion.state(times[index]) for index in indices]
    return Truth(indices, [attitude for attitude, _ in states], [rates for _, rates in states])


def errors(engine, rows, truth):
    """Largest error of the attitude [rad], and of the rates relative to the largest; rows are [x, y, z, w, ω1, ω2, ω3] at the checked indices.

    The grid of a rival may end one step early, so one row may be missing.
    """
    if len(rows) < len(truth.indices) - 1:
        raise WrongAnswer(f"{engine}: {len(rows)} of {len(truth.indices)} rows")
    largest = max(abs(float(x)) for row in truth.rates for x in row)
    pairs = list(zip(rows, truth.attitudes, truth.rates))
    attitude = max(float(torque_free.attitude_error(row[:4], true, DIGITS)) for row, true, _ in pairs)
    rates = max(abs(float(x - float(y))) for row, _, true in pairs for x, y in zip(true, row[4:])) / largest
    if not max(attitude, rates) < WORST:
        raise WrongAnswer(f"{engine}: off by {attitude:.1e} rad, rates by {rates:.1e}")
    return attitude, rates
