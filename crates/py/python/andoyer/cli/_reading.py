"""The input of `andoyer plot`: a scene, or a file of attitudes with an optional scene."""

import argparse
import tomllib
from pathlib import Path
from typing import Any

import andoyer
from andoyer import output
from andoyer.cli._arguments import InputError, date
from andoyer.cli._writing import zoned
from andoyer.output.table import ENDINGS

ATTITUDE_FILES = [".aem", ".xml", *ENDINGS]


def add_options(command: argparse.ArgumentParser) -> None:
    """Add the options of a file of attitudes."""
    group = command.add_argument_group(f"a file of attitudes ({', '.join(ATTITUDE_FILES)}) in the place of SCENE")
    group.add_argument("--against", metavar="SCENE", help="scene file whose motion it is compared with: the angle between them over time")
    group.add_argument("--segment", type=int, metavar="N", help="segment of an AEM, from 0; needed where it has several")
    group.add_argument(
        "--date", type=date, metavar="DATE", help="calendar date of time 0 of the scene, in the time system of an AEM (default: 2000-01-01T12:00:00 TDB)"
    )


def is_attitude_file(path: str) -> bool:
    """True if the name has an ending of attitude files."""
    return Path(path).suffix.lower() in ATTITUDE_FILES


def elements_of(path: str) -> Any:
    """The `elements_of` of the state of a scene file; None if it has none, or if its frame is that of a body after the first."""
    file = Path(path)
    # A pipe can be read only once, and an unreadable file is refused where it is solved.
    try:
        text = file.read_text(encoding="utf-8") if file.is_file() else ""
        state = tomllib.loads(text).get("state") if "elements_of" in text else None
    except (OSError, ValueError):
        return None
    return state.get("elements_of") if isinstance(state, dict) and not state.get("of") else None


def refuse_options(arguments: argparse.Namespace) -> None:
    """Refuse the options of a file of attitudes for a scene."""
    for key in ("against", "segment", "date"):
        if getattr(arguments, key) is not None:
            raise InputError(f"argument --{key}: goes with a file of attitudes alone ({', '.join(ATTITUDE_FILES)}), not with {arguments.scene}")


def refuse_orbital(arguments: argparse.Namespace) -> None:
    """Refuse the options of the orbital frame for a file of attitudes, which has no orbit."""
    for key in ("orbital", "elements_of", "sequence", "of"):
        if getattr(arguments, key) is not None:
            raise InputError(f"argument --{key.replace('_', '-')}: goes with a scene alone, not with {arguments.scene}")


def read(arguments: argparse.Namespace) -> andoyer.Samples:
    """Read the samples of the file."""
    path = Path(arguments.scene)
    given = zoned({"date": arguments.date} if arguments.date else {})
    try:
        if path.suffix.lower() in ENDINGS:
            for key in ("segment", "date"):
                if getattr(arguments, key) is not None:
                    raise InputError(f"argument --{key}: goes with an AEM alone, not with {path}")
            return output.read_table(path).samples
        return output.read_aem(path, arguments.segment, date=given.get("date"))
    except ValueError as error:
        raise InputError(str(error)) from error
