"""Runs every scene of examples/scenes: one table on the terminal and in out/table.md, one picture a scene in out/.

    python examples/demo.py          from the root of the repository, with andoyer, numpy, mpmath and matplotlib installed

Every scene is solved in closed form (the choice of "auto") and by the series if they serve the scene. The table has the plan (mode, σ/σ_sep, order, harmonics), the largest
attitude error at 25 epochs over the span, the error bound of the plan, and the time of one sample in calls with 100,000 uniform times. The reference is
tests/reference/torque_free.py, Jacobi's closed form in 40 digits, which shares no formula with the two methods. For a scene with an orbit it is a numerical
integration, tests/reference/gravity_gradient.py. Exit status 1 if a scene fails or its error exceeds its bound.

With --record the figures are also written to docs/data/scenes.csv, and those of a measured `Ensemble` to docs/data/ensemble.csv. The pages of the documentation and
the tables of the README (`make report`) use these files.
"""

import csv
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

import andoyer
from andoyer import plot

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "reference"))

from gravity_gradient import GravityGradient  # noqa: E402
from torque_free import TorqueFree, attitude_error  # noqa: E402

EPOCHS = 25
USUAL_TOLERANCE = 1e-12
TIMED_SAMPLES = 100_000
TIMED_CALLS = 7
PLOTTED_SAMPLES = 6000
PLOTTED_PERIODS = 3
ENSEMBLE = (100_000, 10)

METHODS: tuple[Literal["closed", "series"], ...] = ("closed", "series")

HEADER = ("scene", "mode", "method", "σ/σ_sep", "order", "harmonics", "error [rad]", "bound [rad]", "ns/sample")
ROW = "{:<62} {:<14} {:<7} {:>8} {:>6} {:>10} {:>12} {:>12} {:>10}"


def span_of(scene: andoyer.Scene) -> tuple[float, float]:
    """The span of a scene; every scene of examples/scenes has one."""
    if scene.span is None:
        raise ValueError(f"{scene.name} has no span")
    return scene.span


def largest_error(motion: andoyer.Motion, reference: Any) -> float:
    """Largest attitude error [rad] of `motion` at EPOCHS times over its span, relative to the torque-free `reference` or, with an orbit, to an integration."""
    scene = motion.scene
    times = np.linspace(*span_of(scene), EPOCHS)
    if scene.orbit is None:
        expected = [reference.state(t)[0] for t in times]
    else:
        integrated = GravityGradient(scene.body.moments, scene.attitude, scene.angular_velocity, scene.orbit, scene.epoch)
        expected, _ = integrated.states(times)
    return max(float(attitude_error(q, r)) for q, r in zip(motion.attitude(times), expected))


def nanoseconds_per_sample(motion: andoyer.Motion, span: tuple[float, float]) -> float:
    """Median over TIMED_CALLS calls of the time of one sample of `motion.at`."""
    times = np.linspace(span[0], span[1], TIMED_SAMPLES)
    durations = []
    for _ in range(TIMED_CALLS):
        start = time.perf_counter()
        motion.at(times)
        durations.append(time.perf_counter() - start)
    return statistics.median(durations) / TIMED_SAMPLES * 1e9


def picture_times(reference: Any, span: tuple[float, float]) -> NDArray[np.float64]:
    """PLOTTED_SAMPLES times over whole turns of the momentum about its body axis: PLOTTED_PERIODS turns, or as many as fit; the whole span if it is shorter than a turn."""
    start, end = span
    if not reference.steady:
        period = 2 * np.pi / abs(float(reference.mean_rates()[1]))
        turns = min(PLOTTED_PERIODS, (end - start) // period)
        end = start + turns * period if turns else end
    return np.linspace(start, end, PLOTTED_SAMPLES)


def label(scene: andoyer.Scene) -> str:
    """The name of a scene, with its tolerance if it is not USUAL_TOLERANCE."""
    if scene.tolerance == USUAL_TOLERANCE:
        return scene.name or ""
    return f"{scene.name} (tolerance {scene.tolerance:.0e})".replace("e-0", "e-")


def markdown(table: Sequence[Sequence[str]]) -> str:
    """The table as Markdown."""
    head, *lines = (f"| {' | '.join(line)} |\n" for line in [HEADER, *table])
    return "".join([head, "|" + "---|" * len(HEADER) + "\n", *lines])


def with_method(scene: andoyer.Scene, method: Literal["closed", "series"]) -> andoyer.Scene:
    """The scene, with this method."""
    return andoyer.Scene(
        scene.body,
        scene.attitude,
        scene.angular_velocity,
        epoch=scene.epoch,
        tolerance=scene.tolerance,
        method=method,
        order=scene.order if method == "series" else None,
        orbit=scene.orbit,
        averaging=scene.averaging,
        level=scene.level,
        span=scene.span,
        name=scene.name,
    )


def row(motion: andoyer.Motion, reference: Any) -> tuple[list[str], bool]:
    """The row of the table for one motion, and True if its error is within its bound."""
    scene, plan = motion.scene, motion.plan
    error = largest_error(motion, reference)
    speed = nanoseconds_per_sample(motion, span_of(scene))
    ratio, order = f"{plan.separatrix_ratio:.3g}", str(plan.order) if plan.method == "series" else "–"
    numbers = [ratio, order, str(plan.harmonics), f"{error:.1e}", f"{plan.error_bound:.1e}", f"{speed:.1f}"]
    return [label(scene), plan.mode, plan.method, *numbers], error <= plan.error_bound


def rows(path: Path, out: Path) -> Iterator[tuple[list[str], bool]]:
    """Draw one scene into `out`. For each method that serves it, yield the row of the table, and True if the error is within its bound."""
    scene = andoyer.Scene.from_toml(str(path))
    reference = TorqueFree(scene.body.moments, scene.attitude, scene.angular_velocity, epoch=scene.epoch)
    motion = scene.solve()
    times = picture_times(reference, span_of(scene))
    plot.summary(motion, times, time_unit="s").savefig(out / f"{path.stem}.png", dpi=130)
    for method in METHODS:
        if scene.orbit is not None and method == "series":
            continue  # a scene with an orbit has no series
        try:
            motion = with_method(scene, method).solve()
        except andoyer.TheoryError:
            continue  # near the separatrix the series do not meet this tolerance
        if motion.plan.method == method:
            yield row(motion, reference)


def ensemble_seconds(threads: int) -> float:
    """The least of three times [s] of solving and evaluating ENSEMBLE bodies at their epochs."""
    bodies, epochs = ENSEMBLE
    generator = np.random.default_rng(1)
    axes = np.sort(generator.uniform(0.4, 1, (bodies, 3)), axis=1) ** 2
    moments = np.column_stack([axes[:, 0] + axes[:, 1], axes[:, 0] + axes[:, 2], axes[:, 1] + axes[:, 2]])
    ensemble = andoyer.Ensemble(moments, [0, 0, 0, 1], generator.standard_normal((bodies, 3)), threads=threads)
    times = np.linspace(0, 100, epochs)
    durations = []
    for _ in range(3):
        start = time.perf_counter()
        ensemble.at(times)
        durations.append(time.perf_counter() - start)
    return min(durations)


def record(table: Sequence[Sequence[str]], root: Path = ROOT) -> None:
    """Write the figures of the README and of the pages of accuracy and speed."""
    data = root / "docs" / "data"
    with (data / "scenes.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["scene", "mode", "method", "separatrix_ratio", "order", "harmonics", "error", "bound", "sample_ns"])
        writer.writerows(table)
    with (data / "ensemble.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["bodies", "epochs", "threads", "seconds"])
        writer.writerows([*ENSEMBLE, threads, f"{ensemble_seconds(threads):.2f}"] for threads in (1, 2))


def main() -> None:
    out = ROOT / "out"
    out.mkdir(exist_ok=True)
    print(ROW.format(*HEADER))
    table: list[list[str]] = []
    failed: list[str] = []
    for path in sorted((ROOT / "examples" / "scenes").glob("*.toml")):
        try:
            for line, within in rows(path, out):
                print(ROW.format(*line), flush=True)
                table.append(line)
                if not within:
                    failed.append(f"{path.stem}: error above its bound")
        except andoyer.Error as error:
            failed.append(f"{path.stem}: {error}")
    (out / "table.md").write_text(markdown(table), encoding="utf-8")
    print(f"\nerror: largest attitude error at {EPOCHS} epochs over the span, against the closed form in 40 digits (with an orbit, a numerical integration)")
    print(
        f"ns/sample: attitude and rates, median of {TIMED_CALLS} calls with {TIMED_SAMPLES:,} even times    pictures: {out.name}/*.png    table: {out.name}/table.md"
    )
    if "--record" in sys.argv[1:]:
        record(table)
    if failed:
        sys.exit("\n".join(failed))


if __name__ == "__main__":
    main()
