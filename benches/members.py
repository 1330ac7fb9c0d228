"""What large ensembles take: seconds, milliseconds a member and memory, by kind.

    make members                          docs/data/members.csv; some minutes
    python benches/members.py --print     the table alone
    python benches/members.py --kind "second order" --threads 1

Each measurement is a process of its own, so that its largest memory is that of one kind. Seconds are by the clock on the wall, without the import, medians of three processes in turn with those of other threads. "Dask" has one thread in each of its workers.
"""

import argparse
import csv
import json
import resource
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import andoyer

FILE = Path(__file__).resolve().parents[1] / "docs" / "data" / "members.csv"
COLUMNS = ("kind", "members", "epochs", "threads", "seconds", "ms_a_member", "memory_mb")
CHUNK = 1000
ORBITS = [andoyer.Orbit(1e-2, e, inclination=i, node=0.5, argument_of_pericentre=1.0) for e, i in ((0.05, 0.3), (0.3, 1.0), (0.6, 2.0))]

Array = NDArray[np.float64]


def directions(random: np.random.Generator, shape: tuple[int, int]) -> Array:
    drawn = random.normal(size=shape)
    return drawn / np.linalg.norm(drawn, axis=1)[:, None]


def any_shape(first: int, count: int, threads: int) -> andoyer.Ensemble:
    """Bodies of any shape, at rates that are not fast beside the orbit: they are integrated over some ten rotations."""
    random = np.random.default_rng([5, first])
    middle = random.uniform(0.55, 0.99, count)
    least = random.uniform(np.maximum(1 - middle + 0.01, 0.1), middle)
    moments = np.stack([least, middle, np.ones(count)], axis=1)
    rates = directions(random, (count, 3)) * random.uniform(0.05, 0.3, (count, 1))
    orbits = [ORBITS[k % 3] for k in range(count)]
    return andoyer.Ensemble(
        moments, directions(random, (count, 4)), rates, orbits=orbits, span=(0, 300), tolerance=1e-9, method="integrated", threads=threads, errors="nan"
    )


def chunk(first: int) -> Array:
    """The attitudes of a chunk, as a worker computes them."""
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    return any_shape(first, CHUNK, 1).attitude(np.linspace(0, 300, 10))


def by_dask(members: int, workers: int, stack: ExitStack) -> Callable[[], Array]:
    from distributed import Client, LocalCluster

    client = stack.enter_context(Client(stack.enter_context(LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None))))
    client.gather(client.map(chunk, range(members, members + 4 * workers * CHUNK, CHUNK), pure=False))  # imports, and the first pages
    return lambda: np.concatenate(client.gather(client.map(chunk, range(0, members, CHUNK), pure=False)))


def second_order(members: int, threads: int, _: ExitStack) -> Callable[[], Array]:
    """Nearly spherical bodies under one orbit, by the theory of second order."""
    random = np.random.default_rng(7)
    moments = np.sort(1 - random.uniform(0, 0.05, (members, 3)), axis=1)
    rates = random.normal(size=(members, 3)) * [0.1, 0.1, 0] + [0, 0, 1]
    orbit = andoyer.Orbit(2e-3, 0.1, inclination=0.4)
    ensemble = andoyer.Ensemble(moments, [0, 0, 0, 1], rates, orbit=orbit, level="second-order", span=(0, 1e4), tolerance=1e-6, threads=threads, errors="nan")
    return lambda: ensemble.attitude(np.linspace(0, 1e4, 100))


def flyby(members: int, threads: int, _: ExitStack) -> Callable[[], Array]:
    """Clones of Apophis from ten days before its passage of 2029 to ten days after it, as in the gallery."""
    gm, q, e = 398600.4418 * 3600.0**2, 38011.48649, 4.253901873
    angles = {"inclination": np.radians(162.8562), "node": np.radians(152.0019), "argument_of_pericentre": np.radians(32.5676)}
    earth = andoyer.Orbit(np.sqrt(gm / (q / (e - 1)) ** 3), e, semi_major_axis=q / (e - 1), **angles)
    random = np.random.default_rng(2029)
    ensemble = andoyer.Ensemble.from_periods(
        andoyer.Body([0.729, 0.947, 1.0]),
        27.45 + 0.07 * random.normal(size=members),
        265.7 + 6 * random.normal(size=members),
        "short-axis",
        np.radians([246.8, -59.3] + [14, 7] * random.normal(size=(members, 2))),
        phases=random.uniform(size=(members, 2)),
        epoch=-240.0,
        orbit=earth,
        span=(-240.0, 240.0),
        tolerance=1e-8,
        threads=threads,
        errors="nan",
    )
    return lambda: ensemble.attitude(np.linspace(-240.0, 240.0, 10))


def integrated(members: int, threads: int, _: ExitStack) -> Callable[[], Array]:
    ensemble = any_shape(0, members, threads)
    return lambda: ensemble.attitude(np.linspace(0, 300, 10))


KINDS: dict[str, tuple[Callable[[int, int, ExitStack], Callable[[], Array]], int, int]] = {
    "second order": (second_order, 10_000, 100),
    "flyby of Apophis": (flyby, 10_000, 10),
    "integrated, any shape": (integrated, 10_000, 10),
    "integrated, by Dask": (by_dask, 100_000, 10),
}


def measured(kind: str, threads: int) -> dict[str, str]:
    """One measurement, in this process."""
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    make, members, epochs = KINDS[kind]
    with ExitStack() as stack:
        run = make(members, threads, stack)
        clock = time.perf_counter()
        found = run()
        seconds = time.perf_counter() - clock
    if found.shape[:2] != (members, epochs) or np.isnan(found).all(axis=(1, 2)).mean() > 0.02:
        raise SystemExit(f"members: {kind} has the shape {found.shape}, and {np.isnan(found).all(axis=(1, 2)).sum()} members without a motion")
    memory = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)) / 1024
    values = (kind, members, epochs, threads, f"{seconds:.3g}", f"{1e3 * seconds / members:.3g}", f"{memory:.0f}")
    return dict(zip(COLUMNS, map(str, values), strict=True))


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--print", action="store_true", help="write no file")
    parser.add_argument("--kind", choices=KINDS, help="this measurement alone, as JSON")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    if options.kind:
        print(json.dumps(measured(options.kind, options.threads)))
        return
    rows = []
    print(*COLUMNS, sep="  ")
    for kind in KINDS:
        found: dict[int, list[dict[str, str]]] = {1: [], 2: []}
        for _ in range(3):
            for threads, runs in found.items():
                command = [sys.executable, __file__, "--kind", kind, "--threads", str(threads)]
                runs.append(json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1]))
        for runs in found.values():
            rows.append(sorted(runs, key=lambda run: float(run["seconds"]))[1])
            print(*rows[-1].values(), sep="  ", flush=True)
    if not options.print:
        with FILE.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
