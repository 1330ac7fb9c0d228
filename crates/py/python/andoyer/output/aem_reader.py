"""Reader of attitude ephemeris messages (AEM) of the CCSDS: versions 1 and 2, in keyword = value notation and in XML.

For every type and direction of a message, the resulting attitudes rotate body components into components of the other frame, as everywhere in this package.
The angular velocity of the body is in body components.
"""

import os
import re
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from pathlib import Path

import numpy as np

from andoyer._core import Samples
from andoyer._quaternions import Array, conjugate, rotate
from andoyer._refusal import refusal, unreadable
from andoyer.output.aem import METHODS, Heading
from andoyer.output.attitude_types import FIELDS, VERSION_1, VERSION_2, attitudes_of
from andoyer.output.calendar import J2000, READABLE, count, tdb
from andoyer.output.message import ascending, choice, messages, row, spelled
from andoyer.output.raw import AEM, RawMessage, RawSegment
from andoyer.output.rows import samples_of

ON_BODY = re.compile(r"(SC BODY|INSTRUMENT|ACC|ACTUATOR|AST|CSS|DSS|ESA|GYRO FRAME|IMU FRAME|MTA|PX|RW|SA|SENSOR|STARR?TT?RACKER|TAM)( \w+)?")
"""Frames of a spacecraft, as the registry of the CCSDS names them; every other frame is one that it turns against."""

WITHOUT_RATES = ["QUATERNION", "QUATERNION/RATE", "EULER_ANGLE", "EULER_ANGLE/RATE"]
"""Types without an angular velocity, or with one of which the standard does not say in which frame it is."""

AXES = str.maketrans("123", "XYZ")


@dataclass(frozen=True)
class Segment:
    """A segment of an AEM: its heading and its samples.

    Angular velocities are NaN if the message has none.
    """

    heading: Heading
    samples: Samples


def read_aem(path: str | os.PathLike[str], segment: int | None = None, *, date: datetime | None = None) -> Samples:
    """Read the samples of a segment of an AEM, version 1 or 2, KVN or XML.

    Parameters
    ----------
    path : path-like
        File to read.
    segment : int, optional
        Number of the segment, from 0. It is needed if the message has several segments.
    date : datetime, optional
        Time 0 of the samples, in the time system of the message. Times are then exact seconds of that system. By default times are TDB
        seconds since J2000, as everywhere in this package; time systems other than TDB then need astropy.

    Returns
    -------
    Samples
        Attitudes from body components to components of the reference frame, and angular velocities in body components [rad/s]. Angular velocities are NaN
        if the message has none (type QUATERNION or EULER_ANGLE) or does not state their frame (the types RATE of version 1).

    Raises
    ------
    ImportError
        UTC, or the conversion to TDB, without astropy.
    FileError
        Text that the standard does not allow, with the number of the line; a time system that does not count seconds.
    InputError
        A segment that does not exist, or none for a message with several.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> output.write_aem("motion.aem", motion.at([0.0, 1.0, 2.0]))
    >>> samples = output.read_aem("motion.aem")
    >>> bool(abs(samples.attitude - motion.attitude(samples.times)).max() < 1e-15)
    True
    """
    found = read_aem_segments(path, date=date)
    if segment is None and len(found) > 1:
        raise refusal("segment", segment, (0, len(found) - 1), f"must be given, from 0 to {len(found) - 1}: the message has {len(found)} ({path})")
    if not 0 <= (segment or 0) < len(found):
        raise refusal("segment", segment, (0, len(found) - 1), f"must be from 0 to {len(found) - 1}: got {segment} ({path})")
    return found[segment or 0].samples


def read_aem_segments(path: str | os.PathLike[str], *, date: datetime | None = None) -> list[Segment]:
    """Read all segments of an AEM with their headings.

    Parameters
    ----------
    path : path-like
        File to read.
    date : datetime, optional
        As in `read_aem`.

    Returns
    -------
    list of Segment

    Raises
    ------
    ImportError, FileError
        As in `read_aem`.
    """
    data = Path(path).read_bytes()
    try:
        return [_segment(message, segment, date) for message in messages(data, AEM) for segment in message.segments]
    except ValueError as error:
        raise unreadable(path, error) from error


def _segment(message: RawMessage, raw: RawSegment, date: datetime | None) -> Segment:
    metadata = raw.metadata
    name = choice(raw, "ATTITUDE_TYPE", VERSION_1 if message.version == "1.0" else VERSION_2)
    system = choice(raw, "TIME_SYSTEM", READABLE)
    if not raw.records:
        raise ValueError(f"{raw.where}: a segment must have data")
    fields = FIELDS[name]
    if message.version == "1.0" and name.startswith("QUATERNION") and choice(raw, "QUATERNION_TYPE", ["FIRST", "LAST"]) == "FIRST":
        fields = _scalar_first(fields)
    table = np.array([row(record, fields) for record in raw.records])[:, [fields.index(field) for field in FIELDS[name]]]
    sequence = _sequence(raw, name)
    times = _times(raw, system, date)
    backwards = message.version == "1.0" and choice(raw, "ATTITUDE_DIR", ["A2B", "B2A"]) == "B2A"
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            attitude, rates = attitudes_of(name, table, sequence)
            if name.endswith("/ANGVEL"):
                rates = _of_second(raw, attitude, rates)
            samples, swapped = _of_body(raw, backwards, times, attitude, rates)
    except ValueError as error:
        raise ValueError(f"{raw.where}: {error}") from error
    if name not in WITHOUT_RATES and not np.isfinite(samples.angular_velocity).all():
        raise ValueError(f"{raw.where}: angular velocities must be finite: the numbers are too large")
    frames = [metadata["REF_FRAME_A"], metadata["REF_FRAME_B"]]
    heading = Heading(
        name=metadata["OBJECT_NAME"],
        frame=frames[swapped],
        date=J2000 if date is None else date,
        time_system="TDB" if date is None else system,
        object_id=metadata["OBJECT_ID"],
        originator=message.header["ORIGINATOR"],
        center=metadata.get("CENTER_NAME"),
        body_frame=frames[not swapped],
        attitude_type=name,
        interpolation=_interpolation(raw),
        version=int(message.version[0]),
        comments=tuple(raw.comments),
    )
    return Segment(heading, samples)


def _scalar_first(fields: list[str]) -> list[str]:
    """The order of QUATERNION_TYPE = FIRST: QC before the others, its derivative before theirs."""
    moved = ["QC", *fields[:3], *fields[4:]]
    return [*moved[:4], "QC_DOT", *moved[4:7]] if "QC_DOT" in fields else moved


def _sequence(raw: RawSegment, name: str) -> str:
    if not name.startswith("EULER"):
        return ""
    sequence = raw.metadata.get("EULER_ROT_SEQ", "").upper().translate(AXES)
    if len(sequence) != 3 or set(sequence) - set("XYZ") or any(first == second for first, second in pairwise(sequence)):
        raise ValueError(f"{raw.where}: EULER_ROT_SEQ must be three axes such as ZXZ or 321, no two alike in a row: got {raw.metadata.get('EULER_ROT_SEQ')!r}")
    return sequence


def _times(raw: RawSegment, system: str, date: datetime | None) -> Array:
    moments = ascending(raw, system)
    if date is None:
        return tdb(moments, system)
    zero = count(date, system)
    return np.array([float(moment - zero) for moment in moments])


def _of_second(raw: RawSegment, attitude: Array, rates: Array) -> Array:
    """An angular velocity in components of frame B."""
    frame = spelled(raw.metadata.get("ANGVEL_FRAME", ""))
    # Figure G-13 of the standard has the keyword in the place of the name.
    if frame in (spelled(raw.metadata["REF_FRAME_B"]), "REF FRAME B"):
        return rates
    if frame in (spelled(raw.metadata["REF_FRAME_A"]), "REF FRAME A"):
        return rotate(conjugate(attitude), rates)
    raise ValueError(f"ANGVEL_FRAME must be REF_FRAME_A or REF_FRAME_B: got {raw.metadata.get('ANGVEL_FRAME')!r}")


def _given(raw: RawSegment, key: str) -> str:
    if key not in raw.metadata:
        raise ValueError(f"{raw.where}: {key} must be given with this ATTITUDE_TYPE")
    return raw.metadata[key]


def _of_body(raw: RawSegment, backwards: bool, times: Array, attitude: Array, rates: Array) -> tuple[Samples, bool]:
    """Samples of the body against the other frame, and whether the body is frame A.

    `attitude` takes components of the second frame to those of the first; in the direction B2A of version 1 the second frame is A.
    """
    first, second = (bool(ON_BODY.fullmatch(spelled(raw.metadata[key]))) for key in ("REF_FRAME_A", "REF_FRAME_B"))
    body_is_a = first and not second
    if body_is_a != backwards:
        return samples_of(times, conjugate(attitude), -rotate(attitude, rates)), body_is_a
    return samples_of(times, attitude, rates), body_is_a


def _interpolation(raw: RawSegment) -> tuple[str, int] | None:
    if "INTERPOLATION_METHOD" not in raw.metadata:
        return None
    method, degree = choice(raw, "INTERPOLATION_METHOD", METHODS), _given(raw, "INTERPOLATION_DEGREE")
    if not re.fullmatch(r"\+?\d{1,9}", degree, re.ASCII):
        raise ValueError(f"{raw.where}: INTERPOLATION_DEGREE must be a whole number: got {degree!r}")
    return method, int(degree)
