"""Compare andoyer with other programs for torque-free propagation: attitude and rates at 100,000 times within a hundred rotations.

    python benches/rivals/propagation.py [--scenes earth eros] [--repeats 7] [--output out] [--data FILE] [--ode-solvers PROGRAM] [--orekit FOLDER]

The engines take turns in every round. Times are CPU seconds of all threads with RAYON_NUM_THREADS = 1, including the call from Python, as medians over the rounds. A
ratio is the median of the ratios of the rounds. Each answer is compared with tests/reference/torque_free.py. The table is printed, and written to the output folder as
Markdown; the rows to --data as CSV. Exit status 1 for a wrong answer.
"""

import argparse
import datetime
import os
import platform
import sys
from collections import namedtuple
from importlib.metadata import version
from pathlib import Path
from statistics import median

os.environ["RAYON_NUM_THREADS"] = "1"

import motions
import propagators
from written import write

OWN = "andoyer closed"
RATES, RATES_STORE = "andoyer rates alone", "store of 3"
TOLERANCES = (1e-12, 1e-13, 1e-14, 1e-15)
LONG_SECONDS = 0.5  # an engine that takes longer is measured in fewer rounds
LONG_ROUNDS = 3
FIELDS = "scene times engine set_up_us samples_ns whole_ns attitude_error rates_error samples_ratio whole_ratio wins"
Row = namedtuple("Row", FIELDS)


def engines(scene, grid, truth, options):
    """Name and maker of each engine, those of andoyer first. A maker may raise `Unfit`."""
    times = motions.times(grid)
    yield OWN, lambda: propagators.Own(scene, times)
    yield "andoyer series", lambda: propagators.Own(scene, times, "series")
    yield RATES, lambda: propagators.OwnRates(scene, times)
    yield "store of 7", lambda: propagators.Store(scene, times)
    yield "store of 7, new array", lambda: propagators.Store(scene, times, new=True)
    yield RATES_STORE, lambda: propagators.Store(scene, times, columns=3)
    for tolerance in TOLERANCES:
        yield f"heyoka {tolerance:.0e}", lambda tolerance=tolerance: propagators.Heyoka(scene, times, tolerance)
    yield "heyoka grid 1e-12", lambda: propagators.HeyokaGrid(scene, times, TOLERANCES[0])
    yield "SciPy closed form", lambda: propagators.ScipyClosed(scene, times)
    yield "SciPy DOP853", lambda: propagators.ScipyDop853(scene, times)
    if options.ode_solvers:
        yield "ode_solvers DOP853", lambda: propagators.OdeSolvers(scene, times, truth.indices, options.ode_solvers, grid)
    if options.orekit:
        command = ["java", "-cp", str(options.orekit / "*"), str(Path(__file__).parent / "orekit" / "TorqueFreeRival.java")]
        yield "Orekit TorqueFree", lambda: propagators.Orekit(scene, times, truth.indices, command)


def fitting(scene, grid, truth, options):
    """The engines that serve this scene and these times, by name."""
    fit = {}
    for name, make in engines(scene, grid, truth, options):
        try:
            fit[name] = make()
        except propagators.Unfit as reason:
            print(f"{scene.name}, {grid}: no {name}: {reason}", file=sys.stderr)
    return fit


def compare(scene, grid, options):
    """The rows of one scene and one kind of times."""
    truth = motions.truth(scene, motions.times(grid))
    fit = fitting(scene, grid, truth, options)
    measured = {name: [] for name in fit}
    for index in range(options.repeats + 1):
        for name, engine in fit.items():
            if index > LONG_ROUNDS and measured[name][0][2] > LONG_SECONDS:
                continue
            measured[name].append(engine.measure())
    errors = {}
    for name, engine in fit.items():
        if not (isinstance(engine, propagators.Store) or name == RATES):
            errors[name] = motions.errors(name, engine.rows(truth.indices), truth)
        engine.close()
    # The first round warms.
    return rows(scene.name, grid, {name: rounds[1:] for name, rounds in measured.items()}, errors)


def rows(scene, grid, measured, errors):
    for name, rounds in measured.items():
        base = measured[RATES_STORE if name == RATES else OWN]
        middle = [None if None in part else median(part) for part in zip(*rounds)]
        ratios = [ratio(part, rounds, base) for part in (1, 2)]
        attitude, rates = errors.get(name, (None, None))
        numbers = [scaled(x, unit) for x, unit in zip(middle, (1e6, 1e9 / motions.SAMPLES, 1e9 / motions.SAMPLES))]
        wins = victories(name, ratios, attitude, errors[OWN][0])
        yield Row(scene, grid, name, *numbers, attitude, rates, *ratios, wins)


def scaled(x, factor):
    return None if x is None else factor * x


def ratio(part, rounds, base):
    """Median of the ratios of the rounds for this part of the time; None if an engine does not have this part."""
    if rounds[0][part] is None:
        return None
    return median(theirs[part] / ours[part] for theirs, ours in zip(rounds, base))


def victories(name, ratios, error, own_error):
    """The quantities in which a rival is better than andoyer's closed form."""
    if name.startswith(("andoyer", "store")):
        return ""
    wins = [what for what, won in [("speed", min(x for x in ratios if x is not None) < 1), ("error", error < own_error)] if won]
    return " and ".join(wins)


def markdown(rows):
    yield "| scene | times | engine | set-up [µs] | samples [ns each] | with set-up [ns each] | error [rad] | ratio of samples | ratio with set-up | rival wins |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        numbers = [row.set_up_us, row.samples_ns, row.whole_ns, row.attitude_error, row.samples_ratio, row.whole_ratio]
        cells = ["" if x is None else f"{x:.1e}" if x == row.attitude_error else f"{x:.3g}" for x in numbers]
        yield "| " + " | ".join([row.scene, row.times, row.engine, *cells, row.wins]) + " |"


def findings(rows):
    """The requested ratios over all scenes, and the rows in which rivals win."""
    for grid in motions.GRIDS:
        of = [row for row in rows if row.times == grid]
        scenes = dict.fromkeys(row.scene for row in of)
        for what, field in [("samples alone", "samples_ratio"), ("with integration and set-up", "whole_ratio")]:
            # For each scene the fastest setting of heyoka.
            best = {}
            for row in of:
                if row.engine.startswith("heyoka") and getattr(row, field) is not None:
                    best[row.scene] = min(getattr(row, field), best.get(row.scene, float("inf")))
            listed = ", ".join(f"{scene} {best[scene]:.3g}" for scene in scenes)
            yield f"{grid} times, fastest heyoka / andoyer, {what}: {listed}."
        rates = ", ".join(f"{row.scene} {row.samples_ratio:.3g}" for row in of if row.engine == RATES)
        yield f"{grid} times, rates alone / store-only loop: {rates}."
    won = {}
    for row in rows:
        if row.wins:
            won.setdefault(f"{row.wins} on {row.scene}", {})[row.engine] = None
    listed = "; ".join(f"{what}: {', '.join(names)}" for what, names in won.items())
    yield f"Where a rival wins: {listed}." if won else "No rival is faster or more accurate in any row."


def preamble(options):
    packages = ["andoyer", "heyoka", "scipy", "numpy"]
    names = ", ".join(f"{package} {version(package)}" for package in packages)
    yield f"{datetime.date.today()}, Python {platform.python_version()}, {platform.machine()}, one thread: {names}."
    yield f"{motions.SAMPLES} samples from t = 0 to 200π; {options.repeats} rounds. Ratios are rival / andoyer closed; for rates alone they are to the store-only loop."
    if not options.ode_solvers:
        yield "ode_solvers was not measured: no program was given."
    if not options.orekit:
        yield "Orekit was not measured: no folder of its libraries was given."


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=motions.NAMES, default=list(motions.NAMES), metavar="SCENE", help=", ".join(motions.NAMES))
    parser.add_argument("--repeats", type=int, default=7, help="rounds; three at most for what takes over half a second (default: 7)")
    parser.add_argument("--output", type=Path, default=Path("out"), help="folder of propagation.md (default: out)")
    parser.add_argument("--data", type=Path, help="file of the rows")
    parser.add_argument("--ode-solvers", type=Path, help="the program that benches/rivals/ode_solvers builds")
    parser.add_argument("--orekit", type=Path, help="folder with the libraries that benches/rivals/orekit/pom.xml names")
    options = parser.parse_args()
    if options.repeats < 1:
        parser.error(f"--repeats {options.repeats}: at least 1")
    if options.orekit and not any(options.orekit.glob("orekit-*.jar")):
        options.orekit = None
    return options


def main():
    options = arguments()
    table = []
    for scene in motions.scenes(options.scenes):
        for grid in motions.GRIDS:
            table += compare(scene, grid, options)
            print(f"{scene.name}, {grid} times: done", file=sys.stderr)
    lines = [*preamble(options), "", *markdown(table), "", *(f"- {line}" for line in findings(table))]
    print("\n".join(lines))
    options.output.mkdir(parents=True, exist_ok=True)
    (options.output / "propagation.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    write(options.data, Row._fields, table)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except motions.WrongAnswer as problem:
        sys.exit(f"{problem}")
