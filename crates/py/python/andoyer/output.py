"""Samples of a motion as files: CSV, NPZ, Parquet, and the attitude ephemeris message of the CCSDS.

The message is AEM version 2 in keyword = value notation (CCSDS 504.0-B-2, January 2024, section 4): QUATERNION/ANGVEL, each line an epoch, Q1 Q2 Q3 QC
and the angular velocity in deg/s. Its quaternion from frame A to frame B turns the axes of A into those of B (annex F2), so with A the inertial frame and B the
body's axes it is the attitude as it stands, scalar last. Version 2 has no ATTITUDE_DIR and no QUATERNION_TYPE: it removed both.
"""

import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from fractions import Fraction
from pathlib import Path
from typing import TextIO, TypeAlias

import numpy as np

from andoyer._core import Samples
from andoyer._extra import extra

COLUMNS = "t,qx,qy,qz,qw,wx,wy,wz"
CONVENTION = (
    "t in the scene's unit of time; attitude [qx, qy, qz, qw]: unit quaternion, Hamilton product, scalar last, "
    "body components to inertial ones; angular velocity [wx, wy, wz]: body components, rad per unit of time"
)

TIME_SYSTEMS = ["TDB", "TT", "TAI", "GPS"]
"""Uniform scales: UTC has leap seconds, which a count of seconds does not know."""

EPOCH_DIGITS = 12
"""Decimals of the second in an epoch."""

REAL = "%.15e"
"""Sixteen digits, the most that section 6.8 of the standard lets a number have."""

LONGEST_LINE = 254

ROWS_AT_ONCE = 2**20
"""Rows of a group of Parquet, which takes some 0.1 s."""

LINES_AT_ONCE = 10_000
"""Lines between two words on how far the writing is."""

Progress: TypeAlias = Callable[[int, int], None]
"""Called with how much is done, and of how much."""


def silent(_done: int, _of: int) -> None:
    """A progress that nobody sees."""


@dataclass(frozen=True)
class Heading:
    """What an AEM says beside the samples."""

    name: str = "UNKNOWN"
    frame: str = "INERTIAL"
    date: datetime = datetime(2000, 1, 1, 12)
    """Calendar date of time 0 in `time_system`."""
    time_system: str = "TDB"
    remark: str = ""
    """What is to be said of the samples, as a comment."""


def write_csv(path: Path, samples: Samples, progress: Progress = silent) -> None:
    """Samples as a CSV file."""
    with path.open("w", encoding="utf-8", newline="\n") as file:
        write_table(file, samples, progress)


def write_table(file: TextIO, samples: Samples, progress: Progress = silent) -> None:
    """Samples as CSV: the names of the columns, one line a time with all 17 digits; `progress` hears of the lines that are written."""
    table = np.column_stack([samples.times, samples.attitude, samples.angular_velocity])
    file.write(f"{COLUMNS}\n")
    for start in range(0, len(table), LINES_AT_ONCE):
        np.savetxt(file, table[start : start + LINES_AT_ONCE], fmt="%.17g", delimiter=",")
        progress(min(start + LINES_AT_ONCE, len(table)), len(table))


def write_npz(path: Path, samples: Samples, remark: str = "") -> None:
    """Samples as NPZ: arrays times, attitude, angular_velocity, and the convention; a remark, if there is one."""
    with path.open("wb") as file:
        np.savez(
            file,
            times=samples.times,
            attitude=samples.attitude,
            angular_velocity=samples.angular_velocity,
            convention=np.array(CONVENTION),
            **({"remark": np.array(remark)} if remark else {}),
        )


def write_parquet(path: Path, samples: Samples, remark: str = "") -> None:
    """Samples as Parquet: the columns of the CSV as float64, the convention and a remark, if there is one, in the metadata of the schema.

    Raises
    ------
    ImportError
        pyarrow is not installed: the extra ``andoyer[parquet]`` brings it.
    """
    arrow, parquet = (extra(module, "writing Parquet") for module in ("pyarrow", "pyarrow.parquet"))
    metadata = {"convention": CONVENTION} | ({"remark": remark} if remark else {})
    schema = arrow.schema([(name, arrow.float64()) for name in COLUMNS.split(",")], metadata=metadata)
    with parquet.ParquetWriter(path, schema) as writer:
        # One group of rows after the other: Python looks for Ctrl-C between them. A table of no rows has a group too.
        for start in range(0, max(len(samples), 1), ROWS_AT_ONCE):
            rows = slice(start, start + ROWS_AT_ONCE)
            columns = np.column_stack([samples.times[rows], samples.attitude[rows], samples.angular_velocity[rows]]).T
            writer.write_table(arrow.table(list(np.ascontiguousarray(columns)), schema=schema))


def write_aem(path: Path, samples: Samples, heading: Heading) -> None:
    """Samples as an AEM, version 2, times in seconds.

    Raises
    ------
    ValueError
        Times that do not ascend by 1e-12 s at least, or years outside 1 to 9999.
    """
    epochs = [epoch(heading.date, float(time)) for time in samples.times]
    if any(first >= second for first, second in zip(epochs, epochs[1:])):
        raise ValueError("an AEM must have ascending times, 1e-12 s apart at least")
    # The standard has no -0.
    table = np.column_stack([samples.attitude, np.degrees(samples.angular_velocity)]) + 0.0
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.writelines(f"{line}\n" for line in heading_lines(heading, epochs))
        file.write("DATA_START\n")
        for start, row in zip(epochs, table):
            file.write(" ".join([start, *(REAL % number for number in row)]) + "\n")
        file.write("DATA_STOP\n")


def heading_lines(heading: Heading, epochs: list[str]) -> Iterator[str]:
    """The header and the metadata of an AEM."""
    yield "CCSDS_AEM_VERS = 2.0"
    yield f"CREATION_DATE = {datetime.now(timezone.utc):%Y-%m-%dT%H:%M:%S}"
    yield "ORIGINATOR = ANDOYER"
    yield "META_START"
    yield f"COMMENT Time 0 of the scene is {heading.date.isoformat()}; its unit of time is taken as the second."
    yield "COMMENT REF_FRAME_A is the inertial frame of the scene, REF_FRAME_B the principal axes of the body."
    remark = heading.remark.encode("ascii", "replace").decode()
    yield from textwrap.wrap(remark, LONGEST_LINE, initial_indent="COMMENT ", subsequent_indent="COMMENT ")
    name = " ".join(heading.name.encode("ascii", "replace").decode().upper().split())  # text is of one case
    yield f"OBJECT_NAME = {name or 'UNKNOWN'}"[:LONGEST_LINE]
    yield "OBJECT_ID = UNKNOWN"
    yield f"REF_FRAME_A = {heading.frame}"
    yield "REF_FRAME_B = SC_BODY_1"
    yield f"TIME_SYSTEM = {heading.time_system}"
    yield f"START_TIME = {epochs[0]}"
    yield f"STOP_TIME = {epochs[-1]}"
    yield "ATTITUDE_TYPE = QUATERNION/ANGVEL"
    yield "ANGVEL_FRAME = SC_BODY_1"
    yield "META_STOP"


def epoch(date: datetime, seconds: float) -> str:
    """The calendar date so many seconds after `date`, to EPOCH_DIGITS decimals."""
    since = Fraction(date.microsecond, 10**6) + Fraction(seconds)
    whole, parts = divmod(round(since * 10**EPOCH_DIGITS), 10**EPOCH_DIGITS)
    try:
        then = date.replace(microsecond=0) + timedelta(seconds=whole)
    except OverflowError:
        raise ValueError(f"an AEM must have years from 1 to 9999: {seconds!r} s after {date.isoformat()} is outside") from None
    return f"{then.isoformat()}.{parts:0{EPOCH_DIGITS}d}"
