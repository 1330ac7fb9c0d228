"""The command line: `andoyer propagate`, `plot`, `code`, `plan`, `evolve`, `bodies`, `series`.

The exit status is 0, or 2 with one line on stderr for bad input: a missing file, a bad scene, a bad number, a motion without a theory,
no command. A tolerance that is not met prints one line on stderr, and the exit status is 3 with `--strict`. After Ctrl-C it is 130, and no incomplete file is left.
"""

import argparse
import math
import shutil
import sys
import textwrap
from pathlib import Path
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

import andoyer
from andoyer import output
from andoyer._extra import extra
from andoyer.cli import _converting as converting
from andoyer.cli import _evolving as evolving
from andoyer.cli import _printing as printing
from andoyer.cli import _reading as reading
from andoyer.cli import _series as normal_form
from andoyer.cli import _writing as writing
from andoyer.cli._arguments import MOST_SAMPLES, InputError, sample_count, step, time
from andoyer.cli._solving import ROTATIONS, interval, solved, status, strictly
from andoyer.cli._terminal import ProgressBar, discard_stdout, flush_or_discard_stdout, replace_closed_streams
from andoyer.cli._writing import ENDINGS
from andoyer.output import COLUMNS, CONVENTION
from andoyer.output.files import whole_file
from andoyer.output.page import page

SAMPLES = 1000
"""Samples if the command line gives neither their number nor a step."""

PICTURES = [".png", ".svg", ".pdf", ".html"]
COMMANDS = ["propagate", "convert", "plot", "code", "plan", "librations", "evolve", "bodies", "series"]
Code = Literal["c", "rust", "python", "javascript"]
CODES: dict[str, Code] = {".c": "c", ".rs": "rust", ".py": "python", ".js": "javascript"}
"""Languages of the code of a motion, each by the ending of its files."""
EXAMPLES = {
    "propagate": """\
andoyer propagate eros.toml -o eros.csv
andoyer propagate eros.toml -o eros.npz --start 0 --stop 86400 --step 60
andoyer propagate eros.toml -o eros.aem --date 2026-01-01T00:00:00 --frame ICRF
andoyer propagate eros.toml -o eros.bc --stop 86400 --interpolation-error 1e-6 --frame ECLIPJ2000
andoyer propagate eros.toml -o eros.bpc --stop 86400 --body-frame EROS_FREE""",
    "convert": "andoyer convert eros.aem -o eros.bc --body-frame EROS_MEASURED --instrument 2000433 --longest-step 3600",
    "librations": """\
andoyer librations moon.toml --terms 20
andoyer librations moon.toml --forced --unit arcsec""",
    "plan": """\
andoyer plan eros.toml
andoyer plan eros.toml --verify --stop 86400""",
    "plot": """\
andoyer plot eros.toml -o eros.png
andoyer plot eros.toml -o eros.html
andoyer plot satellite.toml -o angles.png --orbital lvlh --elements-of rotating
andoyer plot eros.aem -o difference.png --against eros.toml --date 2026-01-01T00:00:00""",
    "code": """\
andoyer code apophis.toml -o apophis.c
andoyer code apophis.toml --language rust > apophis.rs""",
    "evolve": """\
andoyer evolve satellite.toml -o years.csv --stop 3e8
andoyer evolve satellite.toml -o years.png --stop 3e8""",
    "bodies": "andoyer bodies",
    "series": """\
andoyer series --order 10
andoyer series --order 20 --to json > normal-form.json
andoyer series --order 10 --to c --beta 0.3 > rotation.c""",
}


class Parser(argparse.ArgumentParser):
    """A parser that reports an error in one line."""

    def error(self, message: str) -> NoReturn:
        raise InputError(message)


def main(argv: list[str] | None = None) -> int:
    """Run the command line `argv`, by default that of the process; return the exit status."""
    replace_closed_streams()
    for stream in (sys.stdout, sys.stderr):
        # A name that the terminal cannot show is shown escaped.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        top = parser()
        try:
            arguments = top.parse_args(argv)
        finally:
            # --help and --version end the process here.
            sys.stdout.flush()
        if arguments.run is None:
            raise InputError(f"a command is missing: {', '.join(COMMANDS)} (--help says more)")
        status: int = arguments.run(arguments)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader of a pipe has seen enough.
        discard_stdout()
        return 0
    except (InputError, andoyer.Error, ImportError, OSError, MemoryError) as error:
        print("andoyer: error:", " ".join(str(error).split()) or type(error).__name__, file=sys.stderr)
        flush_or_discard_stdout()
        return 2
    except KeyboardInterrupt:
        print("andoyer: interrupted", file=sys.stderr)
        return 130
    return status


def examples(said: str, *lines: str) -> dict[str, Any]:
    """The end of a help text: a filled paragraph, then examples with their own line breaks."""
    width = max(40, min(shutil.get_terminal_size().columns, 100) - 2)
    paragraphs = [textwrap.fill(said, width)] if said else []
    paragraphs.append("examples:\n" + textwrap.indent("\n".join(lines), "  "))
    return {"epilog": "\n\n".join(paragraphs), "formatter_class": argparse.RawDescriptionHelpFormatter}


def parser() -> Parser:
    """The parser of the command line."""
    top = Parser(
        prog="andoyer",
        description="Attitude of rigid bodies, free and under gravity gradient, in closed form; exact perturbation series.",
        **examples("", *EXAMPLES.values()),
    )
    top.add_argument("--version", action="version", version=f"andoyer {andoyer.__version__}")
    commands = top.add_subparsers(title="commands", metavar="COMMAND")
    top.set_defaults(run=None)

    writes = "write attitude and angular velocity at equal steps of time"
    told = examples(f"Columns {COLUMNS}: {CONVENTION}.", EXAMPLES["propagate"])
    add_propagate(commands.add_parser("propagate", help=writes, description=f"{writes.capitalize()}.", **told))

    writes = "a file of attitudes as a SPICE C-kernel, with the times of the file; of an AEM with its frame too"
    command = commands.add_parser("convert", help=f"write {writes}", description=f"Write {writes}.", **examples("", EXAMPLES["convert"]))
    converting.add_arguments(command)

    pictures = "draw the polhode, the phase portrait, angles and rates over whole periods; under a gravity gradient the path of the pole; of a libration its angles and terms; of a satellite roll, pitch and yaw against its orbit"
    add_plot(commands.add_parser("plot", help=pictures, description=f"{pictures.capitalize()}. Needs matplotlib.", **examples("", EXAMPLES["plot"])))

    writes = "write a function in C, Rust, Python or JavaScript that evaluates a motion and needs only its language"
    add_code(commands.add_parser("code", help=writes, description=f"{writes.capitalize()}.", **examples("", EXAMPLES["code"])))

    prints = "print the plan of a scene: method, order, error bound, periods"
    printing.add_plan(commands.add_parser("plan", help=prints, **examples("", EXAMPLES["plan"])))

    prints = "print the proper modes and the terms of a body locked to its orbit"
    printing.add_librations(commands.add_parser("librations", help=prints, **examples("", EXAMPLES["librations"])))

    writes = "write angular momentum, spin period, obliquity and excess of energy over years, averaged over the rotation"
    columns = f"{writes.capitalize()}. Columns {evolving.COLUMNS}."
    evolving.add_command(commands.add_parser("evolve", help=writes, description=columns, **examples("", EXAMPLES["evolve"])))

    command = commands.add_parser("bodies", help="print the catalogue of bodies, each with its source", **examples("", EXAMPLES["bodies"]))
    command.set_defaults(run=printing.bodies)

    prints = "print the triaxiality polynomials P_0 ... P_N, or the normal form as JSON, LaTeX or source code"
    normal_form.add_arguments(commands.add_parser("series", help=prints, **examples("", EXAMPLES["series"])))
    return top


def add_propagate(command: argparse.ArgumentParser) -> None:
    """Add the arguments of `andoyer propagate`."""
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("-o", "--output", metavar="FILE", required=True, help=f"file to write; its ending chooses the format: {ENDINGS}; - is CSV on stdout")
    command.add_argument("--start", type=time, metavar="T", help="first time (default: start of the scene's span, or its epoch)")
    command.add_argument("--stop", type=time, metavar="T", help=f"last time (default: end of the scene's span, or {ROTATIONS} rotations after the first time)")
    spacing = command.add_mutually_exclusive_group()
    spacing.add_argument("--samples", type=sample_count, metavar="N", help=f"number of times, the last one included (default: {SAMPLES})")
    spacing.add_argument("--step", type=step, metavar="DT", help="time between samples")
    writing.add_orbital(command, "columns against the orbital frame, beside the inertial ones (.csv, .npz, .parquet)", "needed")
    writing.add_options(command)
    strictly(command)
    command.set_defaults(run=propagate)


def add_plot(command: argparse.ArgumentParser) -> None:
    """Add the arguments of `andoyer plot`."""
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML), or a file of attitudes")
    command.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="file to write; its ending chooses the format: .png, .svg, .pdf, or .html for an animated page"
    )
    command.add_argument("--force", action="store_true", help="replace an existing file")
    drawn = "angles against the orbital frame, and the rate against it, instead of the polhode (of a .html: it turns with the orbit)"
    writing.add_orbital(command, drawn, "alone it draws the summary of a satellite (default: as the scene file says beside its frame)")
    reading.add_options(command)
    strictly(command)
    command.set_defaults(run=plot)


def add_code(command: argparse.ArgumentParser) -> None:
    """Add the arguments of `andoyer code`."""
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument(
        "-o", "--output", metavar="FILE", default="-", help=f"file to write; its ending chooses the language: {', '.join(CODES)} (default: -, stdout)"
    )
    command.add_argument(
        "--language", choices=list(CODES.values()), metavar="LANGUAGE", help=f"{', '.join(CODES.values())} (default: by the ending of FILE, or c)"
    )
    command.add_argument("--force", action="store_true", help="replace an existing file")
    strictly(command)
    command.set_defaults(run=code)


def propagate(arguments: argparse.Namespace) -> int:
    """Write a motion at equal steps of time, or as a kernel of SPICE."""
    path = Path(arguments.output)
    given = writing.check(arguments)
    motion = solved(arguments.scene)
    if arguments.output != "-" and path.suffix.lower() in writing.KERNELS:
        writing.orbital_samples(arguments, motion, [])
        writing.write_kernel(path, motion, interval(motion, arguments.start, arguments.stop), given, arguments.force)
        return status(arguments, motion)
    samples = motion.at(requested_times(arguments, motion))
    against = writing.orbital_samples(arguments, motion, samples.times)
    if arguments.output == "-":
        progress = ProgressBar("writing, lines")
        try:
            output.write_table(sys.stdout, samples, progress, against)
        finally:
            progress.close()
    else:
        writing.write_samples(path, motion, samples, given, arguments.force, against)
    note_sparse(motion, samples.times)
    return status(arguments, motion)


def plot(arguments: argparse.Namespace) -> int:
    """Draw the pictures of a motion, or those of a file of attitudes."""
    path = Path(arguments.output)
    if path.suffix.lower() not in PICTURES:
        raise InputError(f"argument -o/--output: {arguments.output}: the name must end in {', '.join(PICTURES)}")
    if not arguments.force:
        writing.refuse_existing(path)
    if path.suffix.lower() == ".html":
        return turning(arguments, path)
    of_file = reading.is_attitude_file(arguments.scene)
    if of_file:
        reading.refuse_orbital(arguments)
    said = None if of_file else reading.elements_of(arguments.scene)
    against = writing.of_orbital(arguments, said, alone=("elements_of",))
    extra("matplotlib", "drawing").use("Agg")
    from andoyer import plot as pictures
    from andoyer.plot._time import turns_with_orbit

    if of_file:
        samples = reading.read(arguments)
        motion = solved(arguments.against) if arguments.against else None
        figure = pictures.samples_summary(samples, motion, name=Path(arguments.scene).name)
    else:
        reading.refuse_options(arguments)
        motion = solved(arguments.scene)
        try:
            if against is not None:
                figure = pictures.orbital(motion, **against)
            elif motion.libration is not None and arguments.elements_of is None:
                figure = pictures.libration_summary(motion)
            else:
                said = said if turns_with_orbit(motion) else None
                figure = pictures.summary(motion, elements_of=arguments.elements_of or said)
        except andoyer.Error as error:
            raise InputError(str(error)) from error
    with writing.written_to(path), whole_file(path, arguments.force) as temporary:
        figure.savefig(temporary, dpi=130, format=path.suffix.lower()[1:])
    return 0 if motion is None else status(arguments, motion)


def turning(arguments: argparse.Namespace, path: Path) -> int:
    """Write the animated page of a scene."""
    reading.refuse_options(arguments)
    if reading.is_attitude_file(arguments.scene):
        raise InputError(f"argument -o/--output: {arguments.output}: a page is of a scene, not of a file of attitudes")
    for key in ("sequence", "of"):
        if getattr(arguments, key) is not None:
            raise InputError(f"argument --{key}: does not go with a .html")
    against = writing.of_orbital(arguments, reading.elements_of(arguments.scene), alone=("elements_of",))
    whose = against["elements_of"] if against else arguments.elements_of
    motion = solved(arguments.scene)
    if whose is not None:
        try:
            motion.orbital(motion.scene.epoch, elements_of=whose)
        except andoyer.Error as error:
            raise InputError(str(error)) from error
    with writing.written_to(path):
        page(motion, path, elements_of=whose, force=arguments.force)
    return status(arguments, motion)


def code(arguments: argparse.Namespace) -> int:
    """Write a motion as source code."""
    path = Path(arguments.output)
    of_ending = CODES.get(path.suffix.lower())
    language: Code | None = arguments.language or of_ending or ("c" if arguments.output == "-" else None)
    if language is None:
        raise InputError(f"argument -o/--output: {path}: the name must end in {', '.join(CODES)}, or --language must be given")
    if of_ending not in (None, language):
        raise InputError(f"argument --language: {language} does not go with the name {path}, which says {of_ending}")
    if arguments.output != "-" and not arguments.force:
        writing.refuse_existing(path)
    motion = solved(arguments.scene)
    try:
        text = motion.to_code(language)
    except andoyer.Error as error:
        raise InputError(f"{arguments.scene}: {error}") from error
    if arguments.output == "-":
        sys.stdout.write(text)
    else:
        with writing.written_to(path), whole_file(path, arguments.force) as temporary:
            temporary.write_text(text, encoding="ascii", newline="\n")
    return status(arguments, motion)


def requested_times(arguments: argparse.Namespace, motion: andoyer.Motion) -> NDArray[np.float64]:
    """The requested times: from the first to the last, or by steps from the first up to the last."""
    start, stop = interval(motion, arguments.start, arguments.stop)
    with np.errstate(over="ignore", invalid="ignore"):
        if arguments.step is None:
            return np.linspace(start, stop, SAMPLES if arguments.samples is None else arguments.samples)
        # Rounding of the quotient must not lose the last time.
        steps = (stop - start) / arguments.step * (1 + 4 * sys.float_info.epsilon)
        if steps >= MOST_SAMPLES:
            raise InputError(f"argument --step: must give at most {MOST_SAMPLES} samples from {start!r} to {stop!r}: got {arguments.step!r}")
        times: NDArray[np.float64] = np.minimum(start + arguments.step * np.arange(math.floor(steps) + 1), stop)
        return times


def note_sparse(motion: andoyer.Motion, times: NDArray[np.float64]) -> None:
    """Print on stderr that samples are too far apart to show the rotation."""
    rotation = motion.periods["long-axis"].precession
    apart = (times[1] - times[0]) / rotation if len(times) > 1 else 0.0
    if apart > 0.5:
        advice = f"--step {rotation / 100:.3g} gives a hundred a rotation"
        print(f"andoyer: note: samples are {apart:.3g} rotations apart; {advice}", file=sys.stderr)
