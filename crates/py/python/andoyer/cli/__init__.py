"""The command line: `andoyer propagate`, `plot`, `code`, `plan`, `bodies`, `series`.

The exit status is 0, or 2 with one line on stderr for bad input: a missing file, a bad scene, a bad number, a motion without a theory,
no command. A tolerance that is not met prints one line on stderr, and the exit status is 3 with `--strict`. After Ctrl-C it is 130, and no incomplete file is left.
"""

import argparse
import math
import shutil
import sys
import textwrap
import warnings
from pathlib import Path
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

import andoyer
from andoyer import output
from andoyer._extra import extra
from andoyer.cli import _converting as converting
from andoyer.cli import _reading as reading
from andoyer.cli import _writing as writing
from andoyer.cli._arguments import MOST_SAMPLES, InputError, count, number, step, time, whole
from andoyer.cli._series import LANGUAGES, PARTS, series
from andoyer.cli._terminal import Progress, discard_stdout, flush_or_discard_stdout, named, replace_closed_streams
from andoyer.cli._writing import ENDINGS
from andoyer.output import COLUMNS, CONVENTION
from andoyer.output.files import whole_file
from andoyer.output.page import page

ROTATIONS = 10
"""Rotations from the epoch that are propagated if neither the scene nor the command line has a span."""

SAMPLES = 1000
"""Samples if the command line gives neither their number nor a step."""

MISSED = 3
"""Exit status of a tolerance that is not met, under --strict."""

PICTURES = [".png", ".svg", ".pdf", ".html"]
COMMANDS = ["propagate", "convert", "plot", "code", "plan", "librations", "bodies", "series"]
Code = Literal["c", "rust", "python", "javascript"]
CODES: dict[str, Code] = {".c": "c", ".rs": "rust", ".py": "python", ".js": "javascript"}
"""Languages of the code of a motion, each by the ending of its files."""
ANGLES = {"rad": 1.0, "deg": math.pi / 180, "arcsec": math.pi / 648000}
"""Units of the amplitudes of a libration, in rad."""
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
andoyer plot eros.aem -o difference.png --against eros.toml --date 2026-01-01T00:00:00""",
    "code": """\
andoyer code apophis.toml -o apophis.c
andoyer code apophis.toml --language rust > apophis.rs""",
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
    command = commands.add_parser(
        "propagate", help=writes, description=f"{writes.capitalize()}.", **examples(f"Columns {COLUMNS}: {CONVENTION}.", EXAMPLES["propagate"])
    )
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("-o", "--output", metavar="FILE", required=True, help=f"file to write; its ending chooses the format: {ENDINGS}; - is CSV on stdout")
    command.add_argument("--start", type=time, metavar="T", help="first time (default: start of the scene's span, or its epoch)")
    command.add_argument("--stop", type=time, metavar="T", help=f"last time (default: end of the scene's span, or {ROTATIONS} rotations after the first time)")
    spacing = command.add_mutually_exclusive_group()
    spacing.add_argument("--samples", type=count, metavar="N", help=f"number of times, the last one included (default: {SAMPLES})")
    spacing.add_argument("--step", type=step, metavar="DT", help="time between samples")
    writing.add_orbital(command)
    writing.add_options(command)
    strictly(command)
    command.set_defaults(run=propagate)

    writes = "a file of attitudes as a SPICE C-kernel, with the times of the file; of an AEM with its frame too"
    command = commands.add_parser("convert", help=f"write {writes}", description=f"Write {writes}.", **examples("", EXAMPLES["convert"]))
    converting.add_command(command)

    pictures = "draw the polhode, the phase portrait, angles and rates over whole periods; under a gravity gradient the path of the pole; of a libration its angles and terms"
    command = commands.add_parser("plot", help=pictures, description=f"{pictures.capitalize()}. Needs matplotlib.", **examples("", EXAMPLES["plot"]))
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML), or a file of attitudes")
    command.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="file to write; its ending chooses the format: .png, .svg, .pdf, or .html for an animated page"
    )
    command.add_argument("--force", action="store_true", help="replace an existing file")
    reading.add_options(command)
    strictly(command)
    command.set_defaults(run=plot)

    writes = "write a function in C, Rust, Python or JavaScript that evaluates a motion and needs only its language"
    command = commands.add_parser("code", help=writes, description=f"{writes.capitalize()}.", **examples("", EXAMPLES["code"]))
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

    command = commands.add_parser("plan", help="print the plan of a scene: method, order, error bound, periods", **examples("", EXAMPLES["plan"]))
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("--verify", action="store_true", help="integrate the full equations, and print the largest error of the attitude")
    command.add_argument("--start", type=time, metavar="T", help="first time of --verify (default: start of the scene's span, or its epoch)")
    command.add_argument("--stop", type=time, metavar="T", help="last time of --verify (default: end of the scene's span)")
    strictly(command)
    command.set_defaults(run=plan)

    command = commands.add_parser(
        "librations", help="print the proper modes and the terms of a body locked to its orbit", **examples("", EXAMPLES["librations"])
    )
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("--forced", action="store_true", help="only the terms that the orbit forces")
    command.add_argument("--terms", type=count, default=20, metavar="N", help="number of terms (default: 20)")
    command.add_argument("--unit", choices=list(ANGLES), default="rad", metavar="UNIT", help=f"unit of amplitudes: {', '.join(ANGLES)} (default: rad)")
    strictly(command)
    command.set_defaults(run=librations)

    command = commands.add_parser("bodies", help="print the catalogue of bodies, each with its source", **examples("", EXAMPLES["bodies"]))
    command.set_defaults(run=bodies)

    command = commands.add_parser(
        "series", help="print the triaxiality polynomials P_0 ... P_N, or the normal form as JSON, LaTeX or source code", **examples("", EXAMPLES["series"])
    )
    command.add_argument("--order", type=whole, required=True, metavar="N", help="order of the normal form")
    forms = ["text", "json", "latex", *LANGUAGES]
    command.add_argument("--to", choices=forms, default="text", metavar="FORM", help=f"output format: {', '.join(forms)} (default: text)")
    command.add_argument("--part", choices=PARTS, metavar="PART", help=f"part of the normal form for latex: {', '.join(PARTS)} (default: the first)")
    command.add_argument("--beta", type=number, metavar="BETA", help="triaxiality in source code (default: an argument of the function)")
    command.set_defaults(run=series)
    return top


def strictly(command: argparse.ArgumentParser) -> None:
    """Add the option that makes a missed tolerance a failure."""
    command.add_argument("--strict", action="store_true", help=f"exit with status {MISSED} if the tolerance is not met")


def propagate(arguments: argparse.Namespace) -> int:
    """Write a motion at equal steps of time, or as a kernel of SPICE."""
    path = Path(arguments.output)
    given = writing.check(arguments)
    motion = solved(arguments.scene)
    if arguments.output != "-" and path.suffix.lower() in writing.KERNELS:
        writing.orbital(arguments, motion, [])
        writing.write_kernel(path, motion, interval(motion, arguments.start, arguments.stop), given, arguments.force)
        return status(arguments, motion)
    samples = motion.at(instants(arguments, motion))
    against = writing.orbital(arguments, motion, samples.times)
    if arguments.output == "-":
        progress = Progress("writing, lines")
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
    extra("matplotlib", "drawing").use("Agg")
    from andoyer import plot as pictures

    if reading.is_attitude_file(arguments.scene):
        samples = reading.read(arguments)
        motion = solved(arguments.against) if arguments.against else None
        figure = pictures.samples_summary(samples, motion, name=Path(arguments.scene).name)
    else:
        reading.refuse_options(arguments)
        motion = solved(arguments.scene)
        figure = pictures.summary(motion) if motion.libration is None else pictures.libration_summary(motion)
    with writing.written_to(path), whole_file(path, arguments.force) as temporary:
        figure.savefig(temporary, dpi=130, format=path.suffix.lower()[1:])
    return 0 if motion is None else status(arguments, motion)


def turning(arguments: argparse.Namespace, path: Path) -> int:
    """Write the animated page of a scene."""
    reading.refuse_options(arguments)
    if reading.is_attitude_file(arguments.scene):
        raise InputError(f"argument -o/--output: {arguments.output}: a page is of a scene, not of a file of attitudes")
    motion = solved(arguments.scene)
    with writing.written_to(path):
        page(motion, path, force=arguments.force)
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


def read(path: str) -> andoyer.Scene:
    """Read the scene of a file, and print its warnings on stderr."""
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        scene = andoyer.Scene.from_toml(path)
    for doubt in doubts:
        print(f"andoyer: warning: {path}: {doubt.message}", file=sys.stderr)
    return scene


def solved(path: str, *, librates: bool = False) -> andoyer.Motion:
    """Solve the scene of a file, as a libration if asked. A scene without a motion is an error of the file."""
    scene = read(path)
    if librates and scene.method != "libration":
        state = (scene.body, scene.attitude, scene.angular_velocity)
        scene = andoyer.Scene(*state, epoch=scene.epoch, orbit=scene.orbit, tolerance=scene.tolerance, span=scene.span, method="libration")
    with warnings.catch_warnings():
        # `status` says it in one line.
        warnings.simplefilter("ignore", andoyer.ToleranceWarning)
        try:
            return scene.solve()
        except andoyer.Error as error:
            raise InputError(f"{path}: {error}") from error


def status(arguments: argparse.Namespace, motion: andoyer.Motion) -> int:
    """The exit status of a command for this motion. A tolerance that is not met is printed on stderr."""
    missed = motion.plan.missed_tolerance
    if missed is None:
        return 0
    print(f"andoyer: warning: {missed}", file=sys.stderr)
    return MISSED if arguments.strict else 0


def instants(arguments: argparse.Namespace, motion: andoyer.Motion) -> NDArray[np.float64]:
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


def interval(motion: andoyer.Motion, start: float | None, stop: float | None) -> tuple[float, float]:
    """First and last time: the requested ones, or the span of the scene, or ten rotations from the epoch."""
    scene = motion.scene
    if scene.span is not None:
        start, stop = scene.span[0] if start is None else start, scene.span[1] if stop is None else stop
    start = scene.epoch if start is None else start
    if stop is None:
        rotation = motion.periods["long-axis"].precession
        if math.isinf(rotation):
            raise InputError("argument --stop: the body is at rest and has no rotation to count, so a last time must be given")
        stop = start + ROTATIONS * rotation
    if not start <= stop:
        raise InputError(f"argument --stop: {stop!r} is before the first time, {start!r}")
    return start, stop


def plan(arguments: argparse.Namespace) -> int:
    """Print the plan of a scene, the periods of its motion and, on request, its measured error."""
    for option in ("start", "stop"):
        if getattr(arguments, option) is not None and not arguments.verify:
            raise InputError(f"argument --{option}: goes with --verify alone")
    motion = solved(arguments.scene)
    scene = motion.scene
    print(named("scene"), scene.name or arguments.scene)
    print(named("body"), repr(scene.body))
    for line in str(motion.plan).splitlines():
        print(named(line[:13].rstrip()), line[14:])
    print(named("energy"), f"E/E0 {motion.energy_ratio:.8g}, k^2 {motion.elliptic_parameter:.8g}")
    for convention, (precession, rotation) in motion.periods.items():
        print(named("periods"), f"{convention}: P_phi {precession:.10g}, P_psi {rotation:.10g}")
    return max(status(arguments, motion), verified(arguments, motion))


def librations(arguments: argparse.Namespace) -> int:
    """Print the proper modes of a body locked to its orbit, and the largest terms of its three angles."""
    motion = solved(arguments.scene, librates=True)
    libration = motion.libration
    assert libration is not None, "the method is libration"
    unit, size = arguments.unit, ANGLES[arguments.unit]
    print(named("resonance"), f"{motion.plan.resonance} rotations an orbit, order {motion.plan.order}, error bound {motion.plan.error_bound:.1e} rad")
    print(named("periods"), "in the unit of time of the scene, in the frame that turns with the resonance")
    modes = zip(("longitude", "pole, first", "pole, second"), libration.periods, libration.amplitudes, libration.phases, strict=True)
    for name, period, amplitude, phase in modes:
        print(named(name), f"period {period:.10g}, amplitude {amplitude / size:.6e} {unit}, phase {phase:.6f} rad")
    heading = f"amplitude [{unit}]"
    print(f"{'angle':10} {'modes and M':>14} {'period':>17} {heading:>18} {'phase [rad]':>12}")
    for term in (libration.forced() if arguments.forced else libration.terms())[: arguments.terms]:
        multiples = " ".join(f"{k:2d}" for k in term.multiples)
        print(f"{term.angle:10} {multiples:>14} {term.period:17.10g} {term.amplitude / size:18.8e} {term.phase:12.6f}")
    return status(arguments, motion)


def verified(arguments: argparse.Namespace, motion: andoyer.Motion) -> int:
    """Print the measured error, if it is asked for; return the exit status."""
    asked = arguments.start is not None or arguments.stop is not None
    if not arguments.verify:
        return 0
    verification = motion.verify(interval(motion, arguments.start, arguments.stop) if asked else None)
    print(named("verified"), verification)
    return MISSED if arguments.strict and verification.refuted else 0


def bodies(_arguments: argparse.Namespace) -> int:
    """Print the catalogue."""
    print(f"{'name':10} {'A/C':>10} {'B/C':>10} {'beta':>10}  source")
    for name in andoyer.Body.catalogue():
        body = andoyer.Body.named(name)
        a, b, c = np.sort(body.moments)
        print(f"{name:10} {a / c:10.8f} {b / c:10.8f} {body.beta:10.8f}  {andoyer.Body.source(name)}")
    return 0
