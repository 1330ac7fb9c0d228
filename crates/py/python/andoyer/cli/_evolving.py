"""The command `andoyer evolve`: angular momentum, spin period, obliquity and excess of energy over years, as a table or a picture."""

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

import andoyer
from andoyer.cli import _writing as writing
from andoyer.cli._arguments import InputError, sample_count, time
from andoyer.cli._solving import read_scene
from andoyer.output.files import whole_file

COLUMNS = "t,Gx,Gy,Gz,spin_period,obliquity,excess"
"""Columns of the table: the angular momentum is inertial, the obliquity [rad] is empty without an orbit."""

SAMPLES = 1000
"""Rows, if the command line does not give their number."""

PICTURES = (".png", ".svg", ".pdf")


def add_command(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("-o", "--output", metavar="FILE", required=True, help=f"file to write: .csv, {', '.join(PICTURES)}; - is CSV on stdout")
    command.add_argument("--start", type=time, metavar="T", help="first time (default: start of the scene's span, or its epoch)")
    command.add_argument("--stop", type=time, metavar="T", help="last time (default: end of the scene's span)")
    command.add_argument("--samples", type=sample_count, metavar="N", default=SAMPLES, help=f"number of rows (default: {SAMPLES})")
    command.add_argument("--average", choices=["auto", "orbit", "spin"], default="auto", help="over the orbits of the sources too, or not (default: auto)")
    command.add_argument("--force", action="store_true", help="replace an existing file")
    command.set_defaults(run=evolve)


def evolve(arguments: argparse.Namespace) -> int:
    """Write the evolution of a scene. The reason for an end before the last time, and a large error, are printed on stderr."""
    scene, path = read_scene(arguments.scene), Path(arguments.output)
    ending = path.suffix.lower()
    if arguments.output != "-" and ending not in (".csv", *PICTURES):
        raise InputError(f"argument -o/--output: {path}: the name must end in .csv, {', '.join(PICTURES)}")
    if arguments.output != "-" and not arguments.force:
        writing.refuse_existing(path)
    if arguments.stop is None and scene.span is None:
        raise InputError(f"argument --stop: {arguments.scene} has no span, so the last time is needed")
    first, last = scene.span or (scene.epoch, arguments.stop)
    start = first if arguments.start is None else arguments.start
    stop = last if arguments.stop is None else arguments.stop
    try:
        with warnings.catch_warnings():
            # `doubt` says it in one line.
            warnings.simplefilter("ignore", andoyer.ToleranceWarning)
            evolution = scene.evolve((start, stop), average=arguments.average)
    except andoyer.Error as error:
        raise InputError(f"{arguments.scene}: {error}") from error
    if ending in PICTURES:
        from andoyer import plot

        with writing.written_to(path), whole_file(path, arguments.force) as temporary:
            plot.evolution(evolution).savefig(temporary)
    elif arguments.output == "-":
        sys.stdout.write(table(evolution, arguments.samples))
    else:
        with writing.written_to(path), whole_file(path, arguments.force) as temporary:
            temporary.write_text(table(evolution, arguments.samples), encoding="ascii", newline="\n")
    if evolution.end.reason != "span":
        print(f"andoyer: note: the evolution ends at {evolution.end.time!r}: {evolution.end.reason}", file=sys.stderr)
    doubtful = doubt(evolution)
    if doubtful is not None:
        print(f"andoyer: warning: {doubtful}", file=sys.stderr)
    return 0


def doubt(evolution: andoyer.Evolution) -> str | None:
    """What is to be said of its error: that it is large, or why it is unknown."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", andoyer.ToleranceWarning)
        try:
            return evolution.plan.large_error
        except andoyer.Error as error:
            return f"the error of the evolution is unknown: {error}"


def table(evolution: andoyer.Evolution, samples: int) -> str:
    """The rows as CSV."""
    states = evolution.at(np.linspace(*evolution.reached, samples))
    obliquity = [""] * samples if states.obliquity is None else [repr(value) for value in states.obliquity.tolist()]
    columns = (states.times.tolist(), states.momentum.tolist(), states.spin_period.tolist(), obliquity, states.excess.tolist())
    rows = (f"{t!r},{x!r},{y!r},{z!r},{period!r},{angle},{excess!r}" for t, (x, y, z), period, angle, excess in zip(*columns, strict=True))
    return "\n".join([COLUMNS, *rows, ""])
