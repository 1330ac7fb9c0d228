"""Writer of the attitude ephemeris message of the CCSDS in keyword = value notation: version 2 (504.0-B-2, January 2024) or version 1.

The quaternion of the standard from frame A to frame B turns the axes of A into those of B (annex F2). With A the inertial frame and B the body axes, it is the
attitude, scalar last. Version 2 has neither ATTITUDE_DIR nor QUATERNION_TYPE. Version 1 has both, here with A2B and LAST. Its rates are
those of the quaternion, because version 1 does not state the frame of RATE.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from andoyer._core import Body, Samples
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.output.attitude_types import FROM_SAMPLES, VERSION_1, columns_of
from andoyer.output.calendar import J2000, TIME_SYSTEMS, count, counts, written
from andoyer.output.files import whole_file
from andoyer.output.record import ShortRecord
from andoyer.output.rows import calendar_times, rows

REAL = "%.15e"
"""Sixteen digits, the most that section 6.8 of the standard lets a number have."""

LONGEST_LINE = 254

METHODS = ["LINEAR", "HERMITE", "LAGRANGE"]


@dataclass(frozen=True, repr=False)
class Heading(ShortRecord):
    """The header and metadata of an AEM. Texts are in ASCII; the standard uses names in capitals."""

    name: str = "UNKNOWN"
    """OBJECT_NAME."""
    frame: str = "INERTIAL"
    """REF_FRAME_A, the inertial frame of the scene."""
    date: datetime = J2000
    """Calendar date of time 0 in `time_system`, for samples whose times are numbers."""
    time_system: str = "TDB"
    """TDB, TT, TAI, GPS or UTC; UTC uses the leap seconds of astropy."""
    object_id: str = "UNKNOWN"
    """OBJECT_ID, by custom year, number and part of the launch: 2000-052A."""
    originator: str = "ANDOYER"
    """ORIGINATOR."""
    center: str | None = None
    """CENTER_NAME, the body that the object orbits."""
    body_frame: str = "SC_BODY_1"
    """REF_FRAME_B, the body's axes."""
    attitude_type: str | None = None
    """One of `FROM_SAMPLES`; by default QUATERNION/ANGVEL, in version 1 QUATERNION/DERIVATIVE."""
    interpolation: tuple[str, int] | None = None
    """INTERPOLATION_METHOD (LINEAR, HERMITE or LAGRANGE) and INTERPOLATION_DEGREE."""
    version: int = 2
    """Version of the message, 1 or 2."""
    comments: tuple[str, ...] = ()
    """Lines for the comments of the metadata."""

    @property
    def type(self) -> str:
        """The attitude type: the given one, or the default of the version."""
        return self.attitude_type or ("QUATERNION/ANGVEL" if self.version == 2 else "QUATERNION/DERIVATIVE")


def write_aem(path: str | os.PathLike[str], samples: Samples, heading: Heading = Heading(), *, body: Body | None = None, force: bool = True) -> None:
    """Write samples as an attitude ephemeris message (AEM) with one segment. Times are in seconds.

    Parameters
    ----------
    path : path-like
        File to write.
    samples : Samples
        Samples of one motion, at ascending times.
    heading : Heading, optional
        Names, frames, date of time 0, type, version.
    body : Body, optional
        The body, for the types with nutation. It must have equal moments about body axes 1 and 2.
    force : bool, optional
        If True, an existing file is replaced.

    Raises
    ------
    FileExistsError
        The file exists, and ``force=False``.
    ImportError
        UTC without astropy.
    InputError
        Samples of an ensemble; times that do not ascend by at least 1e-12 s (times of astropy: 1e-10 s); years outside 1 to 9999; UTC before 1972; a type, version, time
        system or interpolation that the standard does not have, or that is not possible for this motion.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> output.write_aem("wobble.aem", motion.at([0.0, 1.0]), output.Heading(name="WOBBLE", frame="ICRF"))
    >>> output.read_aem("wobble.aem").times
    array([0., 1.])
    """
    _check(heading, samples)
    table = rows(samples)
    numbers = columns_of(heading.type, table[:, 1:5], table[:, 5:], body)
    if not np.isfinite(numbers).all():
        raise refusal(
            "samples", "not finite", "finite", f"must be finite for attitude_type {heading.type}: without angular velocities QUATERNION can be written"
        )
    calendar = calendar_times(samples)
    epochs = _epochs(table[:, 0], calendar, heading)
    with whole_file(path, force) as temporary, temporary.open("w", encoding="ascii", newline="\n") as file:
        file.writelines(f"{line}\n" for line in heading_lines(heading, epochs, calendar is not None))
        file.write("DATA_START\n")
        # The standard has no -0.
        for start, row in zip(epochs, numbers + 0.0):
            file.write(" ".join([start, *(REAL % number for number in row)]) + "\n")
        file.write("DATA_STOP\n")


def _epochs(times: Array, calendar: Any, heading: Heading) -> list[str]:
    """The calendar times of the samples as texts."""
    if not len(times):
        raise refusal("samples", 0, 1, "must have one time at least: got none")
    try:
        epochs = [written(moment, heading.time_system) for moment in _moments(times, calendar, heading)]
    except ValueError as error:
        raise refusal("samples", [float(times[0]), float(times[-1])], "times of the calendar", f"must have times that can be written: {error}") from error
    apart = "1e-12 s" if calendar is None else "1e-10 s"
    for first, second in pairwise(epochs):
        if first >= second:
            raise refusal("samples", second, f"{apart} after {first}", f"must have ascending times, {apart} apart at least: got {second} after {first}")
    return epochs


def _moments(times: Array, calendar: Any, heading: Heading) -> list[Fraction]:
    """Calendar times in seconds: numbers count from the date of time 0."""
    if calendar is not None:
        return counts(calendar, heading.time_system)
    zero = count(heading.date, heading.time_system)
    return [zero + Fraction(float(time)) for time in times]


def _check(heading: Heading, samples: Samples) -> None:
    if heading.version not in (1, 2):
        raise refusal("version", heading.version, "1 or 2", f"must be 1 or 2: got {heading.version!r}")
    if heading.time_system not in TIME_SYSTEMS:
        allowed = ", ".join(TIME_SYSTEMS)
        raise refusal("time_system", heading.time_system, allowed, f"must be one of {allowed}: got {heading.time_system!r}")
    types = [name for name in FROM_SAMPLES if heading.version == 2 or name in VERSION_1]
    if heading.type not in types:
        allowed = ", ".join(types)
        raise refusal("attitude_type", heading.type, allowed, f"must be one of {allowed} in version {heading.version}: got {heading.type!r}")
    if heading.interpolation is not None:
        method, degree = heading.interpolation
        most = len(np.atleast_2d(samples.attitude)) - 1
        if method not in METHODS or not 1 <= degree <= most:
            allowed = f"{', '.join(METHODS)} of degree 1 to {most}"
            raise refusal("interpolation", heading.interpolation, allowed, f"must be {allowed}, which these samples allow: got {heading.interpolation!r}")


def heading_lines(heading: Heading, epochs: list[str], calendar: bool) -> Iterator[str]:
    """The header and the metadata of an AEM; `calendar` says that the samples have calendar times."""
    old = heading.version == 1
    yield f"CCSDS_AEM_VERS = {heading.version}.0"
    yield f"CREATION_DATE = {datetime.now(UTC):%Y-%m-%dT%H:%M:%S}"
    yield f"ORIGINATOR = {_text(heading.originator)}"
    yield "META_START"
    if calendar:
        yield f"COMMENT The times are the calendar times of the samples. Time 0 of the scene is {J2000.isoformat()} TDB."
    else:
        yield f"COMMENT Time 0 of the scene is {heading.date.isoformat()} {heading.time_system}; its unit of time is taken as the second."
    yield "COMMENT REF_FRAME_A is the inertial frame of the scene, REF_FRAME_B the axes of the body."
    yield from (_ascii(f"COMMENT {line}") for line in heading.comments)
    yield f"OBJECT_NAME = {_text(heading.name)}"[:LONGEST_LINE]
    yield f"OBJECT_ID = {_text(heading.object_id)}"[:LONGEST_LINE]
    if heading.center is not None:
        yield f"CENTER_NAME = {_text(heading.center)}"[:LONGEST_LINE]
    yield f"REF_FRAME_A = {_text(heading.frame)}"
    yield f"REF_FRAME_B = {_text(heading.body_frame)}"
    if old:
        yield "ATTITUDE_DIR = A2B"
    yield f"TIME_SYSTEM = {heading.time_system}"
    yield f"START_TIME = {epochs[0]}"
    yield f"STOP_TIME = {epochs[-1]}"
    yield f"ATTITUDE_TYPE = {heading.type}"
    if old and heading.type.startswith("QUATERNION"):
        yield "QUATERNION_TYPE = LAST"
    if heading.type == "QUATERNION/ANGVEL":
        yield f"ANGVEL_FRAME = {_text(heading.body_frame)}"
    if heading.interpolation is not None:
        yield f"INTERPOLATION_METHOD = {heading.interpolation[0]}"
        yield f"INTERPOLATION_DEGREE = {heading.interpolation[1]}"
    yield "META_STOP"


def _ascii(line: str) -> str:
    """A line in printable ASCII of at most the length of the standard."""
    text = line.encode("ascii", "replace").decode()
    return "".join(letter if letter.isprintable() else " " for letter in text)[:LONGEST_LINE]


def _text(value: str) -> str:
    """A text in the form of the standard: one case, ASCII, single blanks."""
    return " ".join(_ascii(value).upper().split()) or "UNKNOWN"
