"""The output of `andoyer propagate`: the options of each format, and the writer for the ending of the file."""

import argparse
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any

import andoyer
from andoyer import output
from andoyer.cli._arguments import InputError, date, interpolation, step, whole, word, words
from andoyer.cli._terminal import ProgressBar
from andoyer.output import Heading, Kernel
from andoyer.output.attitude_types import FROM_SAMPLES
from andoyer.output.calendar import TIME_SYSTEMS
from andoyer.output.files import is_stream

ENDINGS = ".csv, .npz, .parquet, .aem, .bc or .bpc"
KERNELS = {".bc": ".tsc", ".bpc": ".tf"}
"""Endings of SPICE kernels, each with that of its text kernel."""

OF_MESSAGE = {"date", "time_system", "frame", "body_frame", "name", "object_id", "originator", "center", "attitude_type", "interpolation", "version"}
OF_KERNEL = {"date", "time_system", "frame", "body_frame", "instrument", "segment_name", "clock", "clock_id", "center", "interpolation_error"}
OF_PCK = OF_KERNEL - {"clock", "clock_id", "segment_name"}
OF = {".aem": OF_MESSAGE, ".bc": OF_KERNEL, ".bpc": OF_PCK}
OPTIONS = {"version": "aem-version", "name": "object-name"}
"""Options with other names than the fields that they set."""


def add_options(command: argparse.ArgumentParser) -> None:
    """Add the options of the formats with a heading: AEM, CK and PCK."""
    command.add_argument("--force", action="store_true", help="replace a file that is there already")
    both = command.add_argument_group("headings of a .aem (CCSDS attitude ephemeris message), a .bc (SPICE C-kernel) and a .bpc (binary PCK), times in seconds")
    default = Heading()
    both.add_argument("--date", type=date, metavar="DATE", help=f"calendar date of time 0 (default: {default.date.isoformat()}); Z at its end is UTC")
    both.add_argument("--time-system", choices=TIME_SYSTEMS, metavar="SYSTEM", help=f"of that date: {', '.join(TIME_SYSTEMS)} (default: {default.time_system})")
    add_frames(both)
    message = command.add_argument_group("a .aem")
    message.add_argument("--object-name", dest="name", type=words, metavar="NAME", help="name of the object (default: that of the scene)")
    message.add_argument("--object-id", type=words, metavar="ID", help=f"identifier of the object, such as 2000-052A (default: {default.object_id})")
    message.add_argument("--originator", type=words, metavar="NAME", help=f"who writes the message (default: {default.originator})")
    message.add_argument(
        "--attitude-type", type=str.upper, choices=FROM_SAMPLES, metavar="TYPE", help=f"{', '.join(FROM_SAMPLES)} (default: QUATERNION/ANGVEL)"
    )
    message.add_argument("--interpolation", type=interpolation, metavar="METHOD:DEGREE", help="recommended interpolation, such as HERMITE:3 (default: none)")
    message.add_argument("--aem-version", dest="version", type=int, choices=[1, 2], metavar="N", help="version of the message, 1 or 2 (default: 2)")
    kernel = add_codes(command)
    kernel.add_argument("--interpolation-error", type=step, metavar="ANGLE", help="largest error of SPICE's interpolation [rad] (default: 1e-8; .bpc: 1e-9)")


def add_frames(group: argparse._ArgumentGroup) -> None:
    """Add the options of the frames."""
    default = Heading()
    group.add_argument(
        "--frame", type=word, metavar="NAME", help=f"name of the inertial frame (default: {default.frame} in a .aem, {Kernel.frame} in a kernel)"
    )
    group.add_argument("--body-frame", type=word, metavar="NAME", help=f"name of the body's axes (default: {default.body_frame}, {Kernel.body_frame})")
    group.add_argument("--center", type=words, metavar="NAME", help="body that the object orbits (default: none is named); of a kernel its NAIF code")


def add_codes(command: argparse.ArgumentParser) -> argparse._ArgumentGroup:
    """Add the options of the codes of a kernel."""
    kernel = command.add_argument_group("a .bc or .bpc, which chooses its times itself; beside it a .tsc or .tf is written")
    kernel.add_argument("--instrument", type=whole, metavar="CODE", help="code of the body's axes (default: computed from --body-frame)")
    kernel.add_argument("--segment-name", dest="segment_name", type=words, metavar="NAME", help=f"name of the segments of a .bc (default: {Kernel.segment})")
    kernel.add_argument("--clock", metavar="FILE", help="clock kernel of a .bc, needs SpiceyPy (default: a clock of ephemeris seconds is written)")
    kernel.add_argument("--clock-id", type=whole, metavar="CODE", help="code of the clock of a .bc (default: -999; with --clock from that of the body's axes)")
    return kernel


def check(arguments: argparse.Namespace) -> dict[str, Any]:
    """The given heading options, checked: they belong to the format of the file, and no existing file would be replaced."""
    path = Path(arguments.output)
    ending = path.suffix.lower()
    to_stdout = arguments.output == "-"
    if not (to_stdout or ending in (".csv", ".npz", ".parquet", *OF)):
        raise InputError(f"argument -o/--output: {arguments.output}: the name must end in {ENDINGS}, or be - for CSV on stdout")
    allowed = OF.get(ending, set())
    given = {key: getattr(arguments, key) for key in sorted(OF_MESSAGE | OF_KERNEL) if getattr(arguments, key) is not None}
    for key in given:
        if key not in allowed:
            goes = " or ".join(name for name, keys in OF.items() if key in keys)
            raise InputError(f"argument --{option(key)}: goes with a {goes} alone, not with {arguments.output}")
    if ending in KERNELS:
        for key in ("samples", "step"):
            if getattr(arguments, key) is not None:
                raise InputError(f"argument --{key}: a {ending} chooses its times itself, by --interpolation-error")
    if not (to_stdout or arguments.force):
        refuse_existing(path)
        if ending in KERNELS:
            refuse_existing(path.with_suffix(KERNELS[ending]))
    return zoned(given)


def option(field: str) -> str:
    """The command-line option of a field."""
    return OPTIONS.get(field, field).replace("_", "-")


def zoned(given: dict[str, Any]) -> dict[str, Any]:
    """The options with the date without its zone; Z selects UTC."""
    when = given.get("date")
    if when is None or when.tzinfo is None:
        return given
    if given.get("time_system", "UTC") != "UTC":
        raise InputError(f"argument --date: Z is UTC, but --time-system is {given['time_system']}")
    return given | {"date": when.replace(tzinfo=None), "time_system": "UTC"}


def refuse_existing(path: Path) -> None:
    """Refuse an existing file, as an error of the argument."""
    if path.exists() and not is_stream(path) and not path.is_dir():
        raise InputError(f"argument -o/--output: {path}: File exists; --force replaces it")


def add_orbital(command: argparse.ArgumentParser, title: str, whose: str) -> None:
    """Add the options of the orbital frame, under a title, with a help text of whose orbit it is."""
    group = command.add_argument_group(title)
    group.add_argument(
        "--orbital",
        type=str.lower,
        choices=["rtn", "lvlh"],
        metavar="FRAME",
        help="rtn (radial, transverse, normal) or lvlh (forward, against the normal, to the primary)",
    )
    group.add_argument(
        "--elements-of",
        choices=["rotating", "disturbing"],
        metavar="BODY",
        help=f"whose orbit the scene has: rotating (a satellite's own) or disturbing (the Sun's); {whose}",
    )
    group.add_argument("--sequence", metavar="AXES", help="sequence of the three angles (default: ZYX)")
    group.add_argument("--of", type=whole, metavar="N", help="which of several disturbing bodies, from 0 (default: 0)")


def of_orbital(arguments: argparse.Namespace, elements_of: str | None = None, *, alone: tuple[str, ...] = ()) -> dict[str, Any] | None:
    """The arguments of `Motion.orbital`, if they are asked for; `elements_of` where the command line does not say it. The options `alone` go without --orbital, too."""
    keys = ("elements_of", "sequence", "of")
    given = {key: getattr(arguments, key) for key in keys if getattr(arguments, key) is not None}
    if arguments.orbital is None:
        for key in given:
            if key not in alone:
                raise InputError(f"argument --{key.replace('_', '-')}: goes with --orbital alone")
        return None
    if elements_of is not None:
        given.setdefault("elements_of", elements_of)
    if "elements_of" not in given:
        raise InputError("argument --elements-of: must be given with --orbital, as rotating or disturbing: whose orbit the scene has")
    return given | {"frame": arguments.orbital}


def orbital_samples(arguments: argparse.Namespace, motion: andoyer.Motion, times: Any) -> andoyer.Orbital | None:
    """The samples against the orbital frame, if they are asked for."""
    given = of_orbital(arguments)
    if given is None:
        return None
    if arguments.output != "-" and Path(arguments.output).suffix.lower() not in (".csv", ".npz", ".parquet"):
        raise InputError("argument --orbital: goes with a .csv, .npz or .parquet alone")
    try:
        return motion.orbital(times, **given)
    except andoyer.Error as error:
        raise InputError(str(error)) from error


def write_samples(
    path: Path, motion: andoyer.Motion, samples: andoyer.Samples, given: dict[str, Any], force: bool, against: andoyer.Orbital | None = None
) -> None:
    """Write samples in the format of the ending."""
    progress = ProgressBar("writing, lines")
    ending = path.suffix.lower()
    remark = motion.plan.missed_tolerance
    try:
        with written_to(path):
            if ending == ".aem":
                heading = Heading(**({"name": _name(motion), "comments": _comments(motion)} | given))
                output.write_aem(path, samples, heading, body=motion.scene.body, force=force)
                note(heading, given)
            elif ending == ".csv":
                output.write_csv(path, samples, progress, orbital=against, force=force)
            elif ending == ".npz":
                output.write_npz(path, samples, scene=motion.scene, remark=remark, orbital=against, force=force)
            else:
                output.write_parquet(path, samples, scene=motion.scene, remark=remark, orbital=against, force=force)
    finally:
        progress.close()


def write_kernel(path: Path, motion: andoyer.Motion, interval: tuple[float, float], given: dict[str, Any], force: bool) -> None:
    """Write a C-kernel or a binary PCK."""
    kernel = kernel_of(given)
    progress = ProgressBar("writing, windows")
    error = {key: value for key, value in given.items() if key == "interpolation_error"}
    try:
        with written_to(path):
            if path.suffix.lower() == ".bc":
                output.write_ck(path, motion, interval, kernel, progress=progress, force=force, **error)
            else:
                names = {key: getattr(kernel, key) for key in ("frame", "body_frame", "center", "date", "time_system")}
                output.write_pck(path, motion, interval, body=kernel.instrument, progress=progress, force=force, **names, **error)
    finally:
        progress.close()
    note(kernel, given)


def kernel_of(given: dict[str, Any]) -> Kernel:
    """The kernel that the options name."""
    names = {field.name for field in fields(Kernel)}
    chosen = {key: value for key, value in given.items() if key in names}
    if "segment_name" in given:
        chosen["segment"] = given["segment_name"]
    if "center" in given:
        try:
            chosen["center"] = int(given["center"])
        except ValueError:
            raise InputError(f"argument --center: must be a NAIF code, a whole number, for a kernel: got {given['center']!r}") from None
    return Kernel(**chosen)


def _comments(motion: andoyer.Motion) -> tuple[str, ...]:
    """A comment if the tolerance is not met."""
    missed = motion.plan.missed_tolerance
    return () if missed is None else (missed,)


def _name(motion: andoyer.Motion) -> str:
    return motion.scene.name or motion.scene.body.name or Heading.name


def note(heading: Heading | Kernel, given: dict[str, Any]) -> None:
    """Print the default values of a heading on stderr."""
    if "date" not in given or "frame" not in given:
        said = f"time 0 is {heading.date.isoformat()} {heading.time_system}, the inertial frame {heading.frame}"
        print(f"andoyer: note: {said}; --date and --frame name others", file=sys.stderr)


@contextmanager
def written_to(path: Path) -> Iterator[None]:
    """Turn an error of the system or of a writer at `path` into an error of the argument, with the same message."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        said = os.strerror(error.errno) if error.errno else str(error)
        raise InputError(f"argument -o/--output: {path}: {said}") from error
    except ValueError as error:
        raise InputError(f"argument -o/--output: {path}: {error}") from error
