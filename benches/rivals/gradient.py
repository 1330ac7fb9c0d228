"""Compare andoyer's averaged theory of the gravity gradient with heyoka's integration of the full equations.

    python benches/rivals/gradient.py [--repeats 7] [--output docs/data/rivals-gradient.csv]

The motions have a thousand rotations under the gravity gradient of a body on a Keplerian orbit, with attitude and rates twice a rotation (2,000 samples) or twice an orbit (2 to 40 samples). heyoka integrates
Euler's equations with the torque, the quaternion and Kepler's equation (its `kepE`) at a tolerance of 1e-12, with continuous output or on the grid of times, whichever is faster. andoyer
solves a `Scene` with an `Orbit` and evaluates it; the ratio counts the first evaluation, which solves the averaged equations on each quarter of the orbit. The time of a sample is that of later evaluations. The reference of both is heyoka at 1e-17 for the same equations with another stepper setting. The script prints the agreement of this reference with SciPy's DOP853
(tests/reference/gravity_gradient.py) over ten rotations.

The two errors are of different kinds: the integration solves the full equations to its tolerance, and the error of the theory is of second order in the torque. The table has
both errors. The engines take turns. Times are CPU seconds of the process. A ratio, heyoka / andoyer, is the median of the ratios of the rounds of one run, for set-up and samples together.
heyoka compiles the equations of each body and orbit when an integrator is made (measured with constants that are not in its cache). One ratio excludes this time and one includes it.
"""

import argparse
import math
import os
import random
import sys
import time
from itertools import product
from pathlib import Path
from statistics import median

os.environ["RAYON_NUM_THREADS"] = "1"

import heyoka
import numpy as np

import andoyer

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "reference"))

from gravity_gradient import GravityGradient, _plane
from written import write

ROTATIONS = 1000
TOLERANCE, FINEST = 1e-12, 1e-17
CHECK_ROTATIONS = 10
LEAST_SECONDS = 0.02
COLUMNS = "scene times samples setup_us first_us heyoka_us compilation_ms sample_ns heyoka_sample_ns ratio ratio_with_compilation error heyoka_error heyoka_against_dop853 better"
# Moments, mean motion over the spin rate (1), eccentricity, inclination.
SCENES = {
    "triaxial, n = 2e-3": ((1.0, 1.02, 1.05), 2e-3, 0.1, 0.4),
    "triaxial, n = 2e-2": ((1.0, 1.02, 1.05), 2e-2, 0.1, 0.4),
    "needle, n = 1e-3": ((0.22942676869378442, 0.9637535239629482, 1.0), 1e-3, 0.2228, 0.3),
    "C/A = 1.1, n = 1e-3": ((0.91, 0.95, 1.0), 1e-3, 0.05, 0.2),
}
ATTITUDE = (0.1, -0.2, 0.3, math.sqrt(0.86))
RATES = (0.02, 0.03, 1.0)


def equations(moments, orbit):
    """The full equations in heyoka's variables: quaternion, rates."""
    x, y, z, w, p, q, r = heyoka.make_vars(*"xyzwpqr")
    a, b, c = moments
    e = orbit.eccentricity
    anomaly = heyoka.kepE(e, orbit.mean_motion * (heyoka.time - orbit.time_of_pericentre)) if e else orbit.mean_motion * heyoka.time
    near = 1.0 / (1.0 - e * heyoka.cos(anomaly))
    along, across = (heyoka.cos(anomaly) - e) * near, math.sqrt(1 - e * e) * heyoka.sin(anomaly) * near
    axes = _plane(orbit.inclination, orbit.node, orbit.argument_of_pericentre)
    i, j, k = (along * float(f) + across * float(g) for f, g in zip(*axes))
    # The unit vector in the body's axes: the rows of the transposed rotation matrix.
    u = (1 - 2 * (y * y + z * z)) * i + 2 * (x * y + z * w) * j + 2 * (x * z - y * w) * k
    v = 2 * (x * y - z * w) * i + (1 - 2 * (x * x + z * z)) * j + 2 * (y * z + x * w) * k
    s = 2 * (x * z + y * w) * i + 2 * (y * z - x * w) * j + (1 - 2 * (x * x + y * y)) * k
    force = 3 * orbit.mean_motion**2 * orbit.mass_fraction * near * near * near
    return [
        (x, 0.5 * (w * p + y * r - z * q)),
        (y, 0.5 * (w * q + z * p - x * r)),
        (z, 0.5 * (w * r + x * q - y * p)),
        (w, -0.5 * (x * p + y * q + z * r)),
        (p, (c - b) / a * (force * v * s - q * r)),
        (q, (a - c) / b * (force * s * u - r * p)),
        (r, (b - a) / c * (force * u * v - p * q)),
    ]


class Integration:
    """heyoka at a tolerance. A new integrator is compiled."""

    def __init__(self, moments, orbit, tolerance, **options):
        self.start = [*ATTITUDE, *RATES]
        self.integrator = heyoka.taylor_adaptive(equations(moments, orbit), self.start, tol=tolerance, **options)

    def prepare(self, end):
        self.integrator.time = 0.0
        self.integrator.state[:] = self.start
        return self.integrator.propagate_until(end, c_output=True)[4]

    def grid(self, times):
        self.integrator.time = 0.0
        self.integrator.state[:] = self.start
        return self.integrator.propagate_grid([0.0, *times])[-1][1:]


def cpu(run):
    """Median CPU seconds of a run, which is repeated until the time can be measured, and its answer."""
    seconds = []
    while sum(seconds) < LEAST_SECONDS or len(seconds) < 3:
        start = time.process_time()
        answer = run()
        seconds.append(time.process_time() - start)
    return median(seconds), answer


def angle(p, q):
    """The largest angle [rad] between attitudes."""
    p, q = (row / np.linalg.norm(row, axis=1, keepdims=True) for row in (p, q))
    sign = np.sign(np.sum(p * q, axis=1, keepdims=True))
    return float(2 * np.linalg.norm(sign * p - q, axis=1).max())


def compile_seconds(moments, orbit):
    """Least of three CPU times [s] of making an integrator, including the compilation."""
    seconds = []
    for _ in range(3):
        # heyoka keeps compiled code, also on disk. A randomly changed moment makes the code new.
        changed = [moments[0] * (1 + 1e-6 * random.random()), *moments[1:]]
        start = time.process_time()
        Integration(changed, orbit, TOLERANCE)
        seconds.append(time.process_time() - start)
    return min(seconds)


def compare(name, sampling, repeats):
    """A row of the table."""
    moments, motion, eccentricity, inclination = SCENES[name]
    orbit = andoyer.Orbit(motion, eccentricity, inclination=inclination)
    end = 2 * math.pi * ROTATIONS
    step = math.pi if sampling == "twice a rotation" else math.pi / motion
    times = step * np.arange(1, round(end / step) + 1)
    end = times[-1]
    truth = Integration(moments, orbit, FINEST).prepare(end)(times)[:, :4].copy()
    short = np.linspace(0, 2 * math.pi * CHECK_ROTATIONS, 7)
    check = angle(GravityGradient(moments, ATTITUDE, RATES, orbit).states(short)[0], Integration(moments, orbit, FINEST).prepare(short[-1])(short)[:, :4])
    integration = Integration(moments, orbit, TOLERANCE)
    make = lambda: andoyer.Scene(andoyer.Body(moments), ATTITUDE, RATES, orbit=orbit, tolerance=1e-10, span=(0, end), method="closed").solve()  # noqa: E731
    rounds = []
    for _ in range(repeats):
        own_set_up, solved = cpu(make)
        own, samples = cpu(lambda solved=solved: solved.at(times))
        whole, _ = cpu(lambda: make().at(times))
        rival_set_up, output = cpu(lambda: integration.prepare(end))
        rival, rows = cpu(lambda output=output: output(times))
        gridded, _ = cpu(lambda: integration.grid(times))
        rounds.append((own_set_up, own, rival_set_up, rival, gridded, whole))
    compiled = compile_seconds(moments, orbit)
    columns = [median(column) for column in zip(*rounds)]
    ratios = [median((extra + min(c + d, grid)) / whole for _, _, c, d, grid, whole in rounds) for extra in (0.0, compiled)]
    per = 1e9 / len(times)
    own_error, rival_error = angle(samples.attitude, truth), angle(np.array(rows)[:, :4], truth)
    wins = "; ".join(
        w
        for w, wins in (("heyoka: error", rival_error < own_error), ("heyoka: a sample", columns[3] < columns[1]), ("heyoka: the whole", ratios[0] < 1))
        if wins
    )
    return [
        name,
        sampling,
        f"{len(times)}",
        f"{1e6 * columns[0]:.3g}",
        f"{1e6 * columns[5]:.3g}",
        f"{1e6 * min(columns[2], columns[4]):.3g}",
        f"{1e3 * compiled:.3g}",
        f"{per * columns[1]:.3g}",
        f"{per * columns[3]:.3g}",
        f"{ratios[0]:.3g}",
        f"{ratios[1]:.3g}",
        f"{own_error:.1e}",
        f"{rival_error:.1e}",
        f"{check:.1e}",
        wins,
    ]


def main():
    parser = argparse.ArgumentParser(description="Gravity gradient: averaged theory against integration.")
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--output", type=Path)
    arguments = parser.parse_args()
    heads = [
        "scene",
        "times",
        "samples",
        "set-up [µs]",
        "with the first evaluation [µs]",
        "heyoka: integration [µs]",
        "compilation [ms]",
        "a sample [ns]",
        "heyoka",
        "ratio of the whole",
        "with compilation",
    ]
    heads += ["error [rad]", "heyoka", "heyoka against DOP853", "better"]
    rows, lines = [], ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for name, sampling in product(SCENES, ("twice a rotation", "twice an orbit")):
        rows.append(compare(name, sampling, arguments.repeats))
        lines.append("| " + " | ".join(rows[-1]) + " |")
        print(lines[-1], file=sys.stderr, flush=True)
    print("\n".join(lines))
    write(arguments.output, COLUMNS.split(), rows)


if __name__ == "__main__":
    main()
