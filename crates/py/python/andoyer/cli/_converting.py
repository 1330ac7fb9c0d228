"""The command `andoyer convert`: a file of attitudes as a C-kernel."""

import argparse
from pathlib import Path

from andoyer import output
from andoyer.cli import _reading as reading
from andoyer.cli import _writing as writing
from andoyer.cli._arguments import InputError, date, step
from andoyer.output.calendar import TIME_SYSTEMS

SAME_AXES = {"EME2000": "J2000", "GCRF": "ICRF", "ICRF": "ICRF"}
"""Names of the CCSDS for inertial frames whose axes SPICE knows by another name."""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    command.add_argument("scene", metavar="FILE", help=f"file of attitudes: {', '.join(reading.ATTITUDE_FILES)}")
    command.add_argument("-o", "--output", metavar="FILE.bc", required=True, help="C-kernel to write; beside it a .tsc is written")
    command.add_argument("--force", action="store_true", help="replace a file that is there already")
    command.add_argument("--segment", type=int, metavar="N", help="segment of an AEM, from 0; needed where it has several")
    command.add_argument("--date", type=date, metavar="DATE", help="calendar date of time 0 of a table (default: 2000-01-01T12:00:00); Z at its end is UTC")
    command.add_argument("--time-system", choices=TIME_SYSTEMS, metavar="SYSTEM", help=f"of that date: {', '.join(TIME_SYSTEMS)} (default: TDB)")
    command.add_argument("--longest-step", type=step, metavar="DT", help="samples farther apart [s] have a gap between them (default: none have)")
    writing.add_frames(command.add_argument_group("frames"))
    writing.add_codes(command)
    command.set_defaults(run=convert)


def convert(arguments: argparse.Namespace) -> int:
    """Write the samples of a file as a C-kernel."""
    source, path = Path(arguments.scene), Path(arguments.output)
    if not reading.is_attitude_file(arguments.scene):
        raise InputError(f"argument FILE: {source}: the name must end in {', '.join(reading.ATTITUDE_FILES)}")
    if path.suffix.lower() != ".bc":
        raise InputError(f"argument -o/--output: {path}: the name must end in .bc")
    if not arguments.force:
        writing.refuse_existing(path)
        writing.refuse_existing(path.with_suffix(".tsc"))
    keys = writing.OF_KERNEL - {"interpolation_error"}
    given = {key: getattr(arguments, key) for key in sorted(keys) if getattr(arguments, key) is not None}
    message = source.suffix.lower() in (".aem", ".xml")
    if message and (arguments.date or arguments.time_system):
        raise InputError(f"argument --date: goes with a table alone; {source} has its dates")
    arguments.date = None
    samples = reading.read(arguments)
    if message and "frame" not in given:
        name = output.read_aem_segments(source)[arguments.segment or 0].heading.frame
        given["frame"] = SAME_AXES.get(name, name)
    kernel = writing.kernel_of(writing.zoned(given))
    with writing.written_to(path):
        longest = {} if arguments.longest_step is None else {"longest_step": arguments.longest_step}
        written = output.write_ck(path, samples, kernel=kernel, force=arguments.force, **longest)
    if not message:
        writing.note(kernel, given)
    print(f"{written.records} records of frame {kernel.body_frame} ({kernel.instrument}) against {kernel.frame}; estimated error {written.error:.2g} rad")
    return 0
