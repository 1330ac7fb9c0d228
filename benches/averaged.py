"""Hold the averaged theory for precessing orbits and for several disturbing bodies against the integrated method.

    python benches/averaged.py [--scenes 30] [--seed 1] [--output out]

Random scenes of each regime: one precessing orbit, two bodies, two bodies on precessing orbits, three bodies. The mean motions are 5e-5 to 0.06 of the rate of rotation, the rates of nodes and pericentres up to
0.2 of the mean motion, eccentricities up to 0.6, spans 2 to 30 orbits. The reference is the integration with a tolerance of 1e-12. The table has the number of scenes that theory serves, the number of errors above
the sum of both error bounds, the largest and the median ratio of error to this sum, the largest error, and the median ratio of the effect of the torque to the error.
"""

import argparse
import csv
import math
import sys
import warnings
from pathlib import Path
from statistics import median

import numpy as np

import andoyer

SAMPLES = 300
REGIMES = ["precessing", "two bodies", "two precessing", "three bodies"]


def apart(one, other):
    """Angles between attitudes."""
    x, y, z, w = np.moveaxis(one, -1, 0)
    a, b, c, d = np.moveaxis(other, -1, 0)
    vector = np.stack([w * a - d * x - (y * c - z * b), w * b - d * y - (z * a - x * c), w * c - d * z - (x * b - y * a)])
    return 2 * np.arctan2(np.linalg.norm(vector, axis=0), np.abs(w * d + x * a + y * b + z * c))


def drawn_orbit(random, n, rates):
    """A random orbit with mean motion n."""
    secular = {}
    if rates:
        scale = n * 10 ** random.uniform(-3, -0.7)
        secular = {"node_rate": random.uniform(-1, 1) * scale, "pericentre_rate": random.uniform(-1, 1) * scale}
    return andoyer.Orbit(
        n,
        random.choice([0.0, random.uniform(0, 0.2), random.uniform(0, 0.6)]),
        time_of_pericentre=random.uniform(-10, 10) / n,
        inclination=random.uniform(0, math.pi),
        node=random.uniform(0, 6),
        argument_of_pericentre=random.uniform(0, 6),
        attraction=n * n * 10 ** random.uniform(-1, 0),
        **secular,
    )


def drawn(regime, random):
    """A random scene that rotates with about one radian in a unit of time."""
    largest, middle = 1.0, random.uniform(0.55, 0.99)
    least = random.uniform(max(1 - middle + 0.01, 0.2), middle)
    attitude = random.normal(size=4)
    attitude /= np.linalg.norm(attitude)
    tilt = random.choice([0.0, 0.1, 0.5])
    direction = np.array([random.normal() * tilt, random.normal() * tilt, random.choice([-1.0, 1.0])])
    if random.uniform() < 0.25:
        direction = direction[::-1]
    direction /= np.linalg.norm(direction)
    first = 10 ** random.uniform(-3.3, -1.5)
    count = {"precessing": 1, "three bodies": 3}.get(regime, 2)
    motions = [first, *(first * 10 ** random.uniform(-1, 0.3) for _ in range(count - 1))]
    orbits = [drawn_orbit(random, n, "precessing" in regime) for n in motions]
    span = 2 * math.pi / first * random.uniform(2, 30)
    span = min(span, 3e4)
    start = -span * random.uniform(0, 1)
    body = andoyer.Body([least, middle, largest])
    return body, attitude, direction, orbits[0] if count == 1 else orbits, (start, start + span)


def judged(regime, random):
    """A row of the table, or the reason why theory does not serve the scene."""
    body, attitude, rates, orbits, span = drawn(regime, random)
    scene = {"orbit": orbits, "span": span, "tolerance": 1e-12}
    try:
        theory = andoyer.Scene(body, attitude, rates, method="closed", **scene).solve()
    except andoyer.TheoryError as error:
        return str(error)
    exact = andoyer.Scene(body, attitude, rates, method="integrated", **scene).solve()
    free = andoyer.Scene(body, attitude, rates, span=span, tolerance=1e-12).solve()
    times = np.linspace(*span, SAMPLES)
    truth = exact.attitude(times)
    error = apart(theory.attitude(times), truth).max()
    effect = apart(free.attitude(times), truth).max()
    return error, theory.plan.error_bound, exact.plan.error_bound, effect


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    rows, beyond = [], 0
    print("regime           served  refused  above   most  median    largest error  effect/error")
    for number, regime in enumerate(REGIMES):
        random, served, refused = np.random.default_rng([options.seed, number]), [], 0
        while len(served) < options.scenes:
            row = judged(regime, random)
            if isinstance(row, str):
                refused += 1
            else:
                served.append(row)
                rows.append((regime, *row))
        shares = [error / (bound + rest) for error, bound, rest, _ in served]
        above = sum(share > 1 for share in shares)
        beyond += above
        gains = [effect / error for error, _, _, effect in served]
        largest = max(row[0] for row in served)
        print(
            f"{regime:16s} {len(served):6d} {refused:8d} {above:6d} {max(shares):6.3f} {median(shares):7.4f} {largest:16.1e} {median(gains):13.1e}", flush=True
        )
    if options.output:
        with options.output.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["regime", "error", "bound", "integration_bound", "effect"])
            writer.writerows([(regime, *(f"{x:.6e}" for x in row)) for regime, *row in rows])
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
