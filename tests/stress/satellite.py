"""Compare `Scene.evolve` with an integration of the true torque of plates over the whole span of a dead satellite: max(0, cos) of each plate, where `Torque.panels` has polynomials (docs/evolution.md).

    python tests/stress/satellite.py                    a year in rotations of a minute, 526,000 of them; some minutes of one core
    python tests/stress/satellite.py --years 0.05 --each

The integration is facets.c beside this file, compiled with cc. Its steps are a 60th of a rotation; a second run with half of them over the first tenth of the span says what they leave out. The mean of a state is found by `evolve` over no time.
Exit status 1 if momentum or excess differ by more than 0.01 of the momentum, or of ξ of the separatrix.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import andoyer

Array = NDArray[np.float64]
SOURCE = Path(__file__).with_name("facets.c")
YEAR, PRESSURE, INCLINATION = 365.25 * 86400.0, 4.56e-6, np.radians(23.44)
MOMENTS = np.array([980.0, 3430.0, 3570.0])
PERIOD, STEPS, LIMIT = 60.0, 60, 0.01


def plates() -> dict[str, Array]:
    """A box with an array and a trim panel, whose two sides differ."""
    size, centre = np.array([2.3, 2.0, 1.9]), np.array([0.1, 0.0, 0.0])
    walls = np.vstack([np.eye(3), -np.eye(3)])
    array, trim = np.array([0, 0.3, 1]), np.array([0.1, -0.4, 1])
    normals = np.array([*walls, array, -array, trim, -trim])
    return {
        "normals": normals / np.linalg.norm(normals, axis=1)[:, None],
        "areas": np.array([*np.tile([size[1] * size[2], size[0] * size[2], size[0] * size[1]], 2), 11, 11, 1.2, 1.2]),
        "centroids": np.array([*(walls * size / 2 + centre), [4.2, 0.1, 0.2], [4.2, 0.1, 0.2], [-14, 0, 0.3], [-14, 0, 0.3]]),
        "specular": np.array([0.25] * 6 + [0.15, 0.05, 0.6, 0.2]),
        "diffuse": np.array([0.15] * 6 + [0.05, 0.5, 0.1, 0.3]),
    }


def integrated(program: Path, state: tuple[Array, Array], parts: dict[str, Array], steps: tuple[float, int, int]) -> Array:
    """Rows of time, attitude and angular momentum in body axes, by the true torque."""
    attitude, rates = state
    specular = parts["specular"]
    # Emission is 1: what is absorbed is radiated at once.
    lambert = 2 / 3 * (1 - specular)
    rows = np.column_stack([parts["normals"], PRESSURE * parts["areas"], parts["centroids"], specular, lambert])
    length, count, every = steps
    head = [*MOMENTS, *attitude, *(MOMENTS * rates), 2 * np.pi / YEAR, INCLINATION, length]
    text = " ".join(repr(float(x)) for x in head) + f" {count} {every} {len(rows)} " + " ".join(repr(float(x)) for x in rows.ravel())
    found = subprocess.run([program], input=text, capture_output=True, text=True, check=True).stdout
    return np.array([[float(x) for x in row.split()] for row in found.splitlines()])


def means(scene: andoyer.Scene, rows: Array) -> tuple[Array, Array]:
    """Angular momentum and excess of the averaged states of some rows."""
    momenta, excesses = [], []
    for at, *row in rows:
        body = andoyer.Scene(scene.body, row[:4], np.array(row[4:]) / MOMENTS, epoch=at, torques=scene.torques)
        state = body.evolve((at, at)).at(at)
        momenta.append(state.momentum)
        excesses.append(state.excess)
    return np.array(momenta), np.array(excesses)


def main() -> None:
    """Integrate, average, compare."""
    parser = argparse.ArgumentParser(description="Averages against the true torque of a satellite over the whole span.")
    parser.add_argument("--years", type=float, default=1.0, help="span (1)")
    parser.add_argument("--each", action="store_true", help="a line for each of 20 times")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    parts = plates()
    sun = andoyer.Orbit(2 * np.pi / YEAR, inclination=INCLINATION)
    torque = andoyer.Torque.panels(**parts, pressure=PRESSURE, source=sun)
    pole = np.array([0.1, -0.3, 0.95])
    pole /= np.linalg.norm(pole)
    attitude = np.append(np.cross([1, 0, 0], pole), 1 + pole[0])
    attitude /= np.linalg.norm(attitude)
    # 2π M/2E is the period.
    momentum = np.array([0.84, 0.0, np.sqrt(1 - 0.84**2)])
    momentum *= 2 * np.pi / PERIOD / (momentum**2 / MOMENTS).sum()
    rates = momentum / MOMENTS
    scene = andoyer.Scene(andoyer.Body(MOMENTS), attitude, rates, torques=[torque])
    rotations = int(arguments.years * YEAR / PERIOD)
    length, blocks = PERIOD / STEPS, 20
    every = rotations * STEPS // blocks
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "facets"
        subprocess.run(["cc", "-O2", "-o", program, SOURCE, "-lm"], check=True)
        rows = integrated(program, (attitude, rates), parts, (length, every * blocks, every))
        taken = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        finer = integrated(program, (attitude, rates), parts, (length / 2, 2 * every * (blocks // 10), 2 * every))
    start = time.process_time()
    evolution = scene.evolve((0, float(rows[-1, 0])), average="spin")
    averaged = time.process_time() - start
    last = evolution.end.time
    rows = rows[rows[:, 0] <= last]
    states = evolution.at(rows[:, 0])
    momenta, excesses = means(scene, rows)
    size = np.linalg.norm(states.momentum, axis=1)
    separatrix = 1 - MOMENTS[0] / MOMENTS[1]
    errors = np.linalg.norm(momenta - states.momentum, axis=1) / size
    of_excess = np.abs(excesses - states.excess) / separatrix
    fine, _ = means(scene, finer)
    steps = np.abs(fine - momenta[: len(fine)]).max() / size[0]
    if arguments.each:
        for at, length, one, other, share in zip(rows[:, 0], size, errors, of_excess, states.excess / separatrix, strict=True):
            print(f"{at / YEAR:.3f} years: M {length:.4g}, ξ/ξ_sep {share:.4f}; momentum {one:.1e}, excess {other:.1e}")
    change = np.linalg.norm(states.momentum - states.momentum[0], axis=1).max() / size[0]
    print(f"{rotations} rotations, {evolution.end.reason}; the momentum changes by {change:.2f} of its size, what the steps leave out {steps:.1e}")
    print(f"at the end: momentum {errors[-1]:.1e}, excess over that of the separatrix {of_excess[-1]:.1e}; largest {errors.max():.1e}, {of_excess.max():.1e}")
    print(f"truncation {torque.truncation:.3f}; integration {taken:.0f} s, averages {1e3 * averaged:.0f} ms")
    sys.exit(bool(max(errors.max(), of_excess.max()) > LIMIT or evolution.end.reason != "span" or 10 * steps > LIMIT))


if __name__ == "__main__":
    main()
