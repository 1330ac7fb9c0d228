"""Measure averaged motions over years beside integrations of the full equations over a shorter span.

    make evolution-times                          docs/data/evolution-times.csv
    python benches/evolution_times.py --print     the table alone

Ten years of the satellite of examples/gallery/plot_21_satellite_years.py, and a million years of an asteroid of 1 km with 360 facets. A time is the median of three runs by the clock of the processor, without the torque's polynomials, which a row has beside it.
`integration_ms` is that of `rotations` rotations by `Scene.solve` with a tolerance of 1e-6, from the same state. `ratio` is that time, by rotation, over the time of the averages, by rotation.
`evaluation_us` is that of one evaluation of the averaged equations: `Evolution.at` makes one step of 17 evaluations for each time. `plan_ms` is that of `Evolution.plan`, which integrates the full equations over windows of thirty rotations.
"""

import argparse
import csv
import statistics
import sys
import time
import warnings

import numpy as np
from figures import DATA

import andoyer

FILE = DATA / "evolution-times.csv"
RUNS = 3
TIMES, EVALUATIONS, ROTATIONS = 2000, 17, 200
TOLERANCE = 1e-6
COLUMNS = ("scene", "years", "all_rotations", "degree", "torque_ms", "averages_ms", "evaluation_us", "plan_ms", "rotations", "integration_ms", "ratio")
YEAR = 365.25 * 86400.0


def satellite():
    """The scene, without a span, and how long its torque takes."""
    size, centre = np.array([2.3, 2.0, 1.9]), np.array([0.1, 0.0, 0.0])
    walls = np.vstack([np.eye(3), -np.eye(3)])
    array, trim = np.array([0, 0.3, 1]), np.array([0.1, -0.4, 1])
    areas = [*np.tile([size[1] * size[2], size[0] * size[2], size[0] * size[1]], 2), 11, 11, 1.2, 1.2]
    places = [*(walls * size / 2 + centre), [4.2, 0.1, 0.2], [4.2, 0.1, 0.2], [-14, 0, 0.3], [-14, 0, 0.3]]
    finish = {"specular": [0.25] * 6 + [0.15, 0.05, 0.6, 0.2], "diffuse": [0.15] * 6 + [0.05, 0.5, 0.1, 0.3]}
    sun = andoyer.Orbit(2 * np.pi / YEAR, inclination=np.radians(23.44))
    torque, cost = timed(lambda: andoyer.Torque.panels([*walls, array, -array, trim, -trim], areas, places, **finish, pressure=4.56e-6, source=sun))
    moments = np.array([980.0, 3430.0, 3570.0])
    pole = np.array([0.1, -0.3, 0.95]) / np.linalg.norm([0.1, -0.3, 0.95])
    attitude = np.append(np.cross([1, 0, 0], pole), 1 + pole[0])
    rates = 3570 * 2 * np.pi / 300 * np.array([0.84, 0.0, np.sqrt(1 - 0.84**2)]) / moments
    return (andoyer.Body(moments), attitude / np.linalg.norm(attitude), rates), torque, cost


def asteroid():
    """An ellipsoid of 1 km with six bumps and hollows, homogeneous but for them, which turns once in ten hours."""
    rows, columns = 10, 20
    colatitudes, longitudes = np.meshgrid(np.pi * np.arange(1, rows) / rows, 2 * np.pi * np.arange(columns) / columns, indexing="ij")
    ring = np.stack([np.sin(colatitudes) * np.cos(longitudes), np.sin(colatitudes) * np.sin(longitudes), np.cos(colatitudes)], axis=-1)
    u = np.vstack([[0, 0, 1], ring.reshape(-1, 3), [0, 0, -1]])
    triangles = []
    for j, k in zip(range(columns), np.roll(range(columns), -1), strict=True):
        triangles += [[0, 1 + j, 1 + k], [len(u) - 1, len(u) - 1 - columns + k, len(u) - 1 - columns + j]]
        for first in range(1, 1 + (rows - 2) * columns, columns):
            triangles += [[first + j, first + columns + j, first + k], [first + k, first + columns + j, first + columns + k]]
    random = np.random.default_rng(13)
    centres = random.normal(size=(6, 3))
    bumps = np.exp(3 * (u @ (centres / np.linalg.norm(centres, axis=1, keepdims=True)).T - 1))
    vertices = 500 * (1 + bumps @ random.uniform(-0.12, 0.18, 6))[:, None] * u * [1.15, 1.0, 0.85]
    sun = andoyer.Orbit(2 * np.pi / YEAR, 0.1, semi_major_axis=1.496e11)
    torque, cost = timed(lambda: andoyer.Torque.from_facets(vertices, triangles, diffuse=0.1, pressure=4.56e-6, at=1.496e11, source=sun))
    body = andoyer.Body.ellipsoid(575.0, 500.0, 425.0, mass=2000 * 4 / 3 * np.pi * 575 * 500 * 425)
    rates = 2 * np.pi / 36000 * body.moments[2] * np.array([0, np.sin(0.07), np.cos(0.07)]) / body.moments
    return (body, [0.5, 0, 0, np.sqrt(0.75)], rates), torque, cost


def timed(call):
    """What a call returns, and the median of its times [ms]."""
    times = []
    for _ in range(RUNS):
        start = time.process_time()
        found = call()
        times.append(1e3 * (time.process_time() - start))
    return found, statistics.median(times)


def measured(name, made, years, rotations):
    """A row of the table."""
    state, torque, cost = made
    scene = andoyer.Scene(*state, torques=[torque])
    evolution, averaged = timed(lambda: scene.evolve((0, years * YEAR)))
    first, last = evolution.reached
    times = np.random.default_rng(1).uniform(first, last, TIMES)
    _, states = timed(lambda: evolution.at(times))
    _, plan = timed(lambda: evolution.plan)
    period = float(evolution.at(first).spin_period)
    full = andoyer.Scene(*state, torques=[torque], span=(0, rotations * period), tolerance=TOLERANCE)
    _, whole = timed(full.solve)
    all_rotations = (last - first) / period
    ratio = (whole / rotations) / (averaged / all_rotations)
    figures = (
        f"{(last - first) / YEAR:.4g}",
        f"{all_rotations:.2e}",
        torque.degree,
        f"{cost:.3g}",
        f"{averaged:.3g}",
        f"{1e3 * states / TIMES / EVALUATIONS:.2g}",
        f"{plan:.3g}",
        rotations,
        f"{whole:.3g}",
        f"{ratio:.1e}",
    )
    return dict(zip(COLUMNS, (name, *figures), strict=True))


def main():
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--print", action="store_true", help="write no file")
    options = parser.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    rows = [measured("a dead satellite", satellite(), 10, ROTATIONS), measured("an asteroid of 1 km", asteroid(), 1e6, ROTATIONS)]
    for row in rows:
        print(row)
    if not options.print:
        with FILE.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
