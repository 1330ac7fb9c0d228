"""Reader of orbit ephemeris messages (OEM) of the CCSDS, 502.0-B: versions 1 to 3, in keyword = value notation and in XML.

An OEM has positions [km] and velocities [km/s] of an object relative to a center. Times are exact fractions until the epoch is subtracted.
"""

from __future__ import annotations

import operator
import os
import warnings
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from andoyer._core import TabulatedOrbit
from andoyer._quaternions import Array
from andoyer._refusal import refusal, unreadable
from andoyer.interop._foreign import has_units, plain
from andoyer.output.calendar import READABLE, counts, parse, tdb
from andoyer.output.message import ascending, choice, messages, row, spelled
from andoyer.output.raw import OEM, RawSegment

GM = {
    "SUN": 1.3271244004127942e11,
    "MERCURY": 2.2031868551400003e4,
    "MERCURY BARYCENTER": 2.2031868551400003e4,
    "VENUS": 3.2485859200000000e5,
    "VENUS BARYCENTER": 3.2485859200000000e5,
    "EARTH": 3.9860043550702266e5,
    "EARTH BARYCENTER": 4.0350323562548019e5,
    "EARTH-MOON BARYCENTER": 4.0350323562548019e5,
    "MOON": 4.9028001184575496e3,
    "MARS": 4.282837362069909e4,
    "MARS BARYCENTER": 4.2828375815756102e4,
    "JUPITER": 1.266865319003704e8,
    "JUPITER BARYCENTER": 1.2671276409999998e8,
    "SATURN": 3.793120623436167e7,
    "SATURN BARYCENTER": 3.7940584841799997e7,
    "URANUS": 5.793950610340896e6,
    "URANUS BARYCENTER": 5.7945563999999985e6,
    "NEPTUNE": 6.835103145462294e6,
    "NEPTUNE BARYCENTER": 6.8365271005803989e6,
    "PLUTO": 8.693261226311508e2,
    "PLUTO BARYCENTER": 9.7550000000000000e2,
}
"""Gravitational parameters [km³/s²] from gm_Horizons.pck of JPL (29 January 2025). Sun, Mercury, Venus, Earth, Moon and barycenters: its table of DE440 (Park and others 2021,
Astron. J. 161, 105). The other planets: the solutions for their satellites."""

INERTIAL = ["ICRF", "ICRF1", "ICRF2", "ICRF3", "GCRF", "GCRF1", "GCRF2", "GCRF3", "EME2000", "J2000", "MCI"]
"""Frames with axes that do not turn."""

OF_DATE = ["TEME", "TEMEOFDATE", "TOD", "TOD EARTH", "MOD", "MOD EARTH"]
"""Frames of the equator and equinox of date. With REF_FRAME_EPOCH they are those of that date, and do not turn."""

STATE = ["X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"]
ACCELERATION = ["X_DDOT", "Y_DDOT", "Z_DDOT"]

SHARED = ["OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "REF_FRAME_EPOCH", "TIME_SYSTEM"]
"""Keywords that joined segments must have in common."""

SAME = {"EME2000", "J2000"}
"""Two names of one frame."""


@dataclass(frozen=True)
class Read:
    """What a message has: times (n,) [s], positions (n, 3) [km] and velocities (n, 3) [km/s] of the object from the center, metadata of the first segment, what was left out."""

    times: Array
    positions: Array
    velocities: Array
    metadata: dict[str, str]
    warnings: list[str]


def read_oem(
    path: str | os.PathLike[str],
    *,
    gm: float | Any | None = None,
    rotating: str = "object",
    segments: str | int = "all",
    epoch: float | Any | None = None,
) -> TabulatedOrbit:
    """Read an orbit ephemeris message (OEM) of the CCSDS, version 1, 2 or 3, KVN or XML, as an orbit in km and s.

    An OEM states where its object is relative to its center. The orbit states where the disturbing body is relative to the rotating one.

    Parameters
    ----------
    path : path-like
        File to read.
    gm : float, optional
        Gravitational parameter of the disturbing body [km³/s²], or a quantity. By default that of `CENTER_NAME` (with ``rotating="center"``, of `OBJECT_NAME`) if it
        is the Sun, a planet, the Moon or a barycenter: values of DE440.
    rotating : {"object", "center"}, optional
        The body that rotates. "object": a satellite under the attraction of its center; positions and velocities are reversed. "center": a planet under
        the attraction of the object; they are kept.
    segments : "all" or int, optional
        "all" joins the segments: each must begin at the last time of the one before. Their common time then stands twice in the table, with both states, as
        at a manoeuvre. A number, from 0, chooses one segment.
    epoch : float or astropy Time, optional
        Time 0 of the orbit, in TDB seconds since J2000; by default 0, as a scene with a Time as its epoch needs it. An epoch near the message keeps more digits: seconds since J2000 in a double are good
        to 1e-7 s.

    Returns
    -------
    TabulatedOrbit
        Positions and velocities in the frame of the message, at TDB seconds since J2000 less `epoch`.

    Raises
    ------
    ImportError
        A time system other than TDB without astropy.
    FileError
        Text that the standard does not allow, with the number of the line; a frame that turns; a time system that does not count seconds; segments of several
        objects, centers, frames or time systems; segments with a gap between them, or that overlap.
    InputError
        A segment that does not exist; no `gm` for a body without a known one; another value of `rotating`.

    Warns
    -----
    UserWarning
        Covariances and accelerations, which are not read; data that end before STOP_TIME; a frame of date, whose axes turn by 50″ a year.

    Examples
    --------
    >>> message = '''CCSDS_OEM_VERS = 2.0
    ... CREATION_DATE = 2026-01-01T00:00:00
    ... ORIGINATOR = SOMEBODY
    ... META_START
    ... OBJECT_NAME = SATELLITE
    ... OBJECT_ID = 2026-001A
    ... CENTER_NAME = EARTH
    ... REF_FRAME = GCRF
    ... TIME_SYSTEM = TDB
    ... START_TIME = 2000-01-01T12:00:00
    ... STOP_TIME = 2000-01-01T12:04:00
    ... META_STOP
    ... 2000-01-01T12:00:00 7000 0 0 0 7.5 0
    ... 2000-01-01T12:04:00 6767.1 1780 0 -1.93 7.25 0
    ... '''
    >>> with open("orbit.oem", "w") as file:
    ...     _ = file.write(message)
    >>> orbit = interop.read_oem("orbit.oem")
    >>> orbit.gm
    398600.43550702266
    """
    if rotating not in ("object", "center"):
        raise refusal("rotating", rotating, ("object", "center"), f'must be "object" or "center": got {rotating!r}')
    found = _read(path, segments, _seconds(epoch))
    sign = -1.0 if rotating == "object" else 1.0
    attraction = _gm(gm, found.metadata, "CENTER_NAME" if rotating == "object" else "OBJECT_NAME")
    for text in found.warnings:
        warnings.warn(f"{path}: {text}", UserWarning, stacklevel=2)
    return TabulatedOrbit(found.times, sign * found.positions, attraction, velocities=sign * found.velocities)


def _read(path: str | os.PathLike[str], segments: str | int = "all", epoch: Fraction = Fraction(0)) -> Read:
    """The states of the object relative to the center, as the message has them, at TDB seconds since J2000 less `epoch`."""
    data = Path(path).read_bytes()
    try:
        found = _merged([segment for message in messages(data, OEM) for segment in message.segments])
        if not found:
            raise ValueError("line 1: the message has no segment")
    except ValueError as error:
        raise unreadable(path, error) from error
    chosen = _chosen(path, found, segments)
    try:
        parts = [_segment(raw, epoch) for raw in chosen]
        for (first, before), (second, after) in pairwise(zip(chosen, parts)):
            _joins(first, before, second, after)
    except ValueError as error:
        raise unreadable(path, error) from error
    times, positions, velocities = (np.concatenate([getattr(part, name) for part in parts]) for name in ("times", "positions", "velocities"))
    # A text that two segments have is said once, with the line of the first.
    said = {text.partition(": ")[2]: text for part in reversed(parts) for text in reversed(part.warnings)}
    return Read(times, positions, velocities, parts[0].metadata, list(reversed(said.values())))


def _merged(segments: list[RawSegment]) -> list[RawSegment]:
    """The segments, without repetitions of the metadata. Some programs repeat them, with the span of the whole, in the midst of the data."""
    merged: list[RawSegment] = []
    for raw in segments:
        if merged and _continues(merged[-1], raw):
            merged[-1].records += raw.records
            merged[-1].covariances += raw.covariances
        else:
            merged.append(raw)
    return merged


def _continues(first: RawSegment, second: RawSegment) -> bool:
    """Whether a segment has the metadata of the one before, and later times."""
    if first.metadata != second.metadata or not (first.records and second.records):
        return False
    try:
        system = choice(first, "TIME_SYSTEM", READABLE)
        return parse(first.records[-1].epoch, system) < parse(second.records[0].epoch, system)
    except ValueError:
        return False


def _seconds(epoch: Any) -> Fraction:
    """TDB seconds since J2000 of an epoch."""
    if hasattr(epoch, "tdb"):
        if np.ndim(epoch.jd1):
            raise refusal("epoch", epoch, "one time", f"must be one time: got {epoch!r}")
        return counts(epoch, "TDB")[0]
    try:
        return Fraction(0 if epoch is None else float(plain("epoch", epoch)))
    except (OverflowError, ValueError):
        raise refusal("epoch", epoch, "finite", f"must be a finite number of seconds, or an astropy Time: got {epoch!r}") from None


def _gm(gm: Any, metadata: dict[str, str], key: str) -> float | Any:
    if gm is not None:
        return plain("gm", gm) * 1e-9 if has_units(gm) else gm
    name = spelled(metadata[key]).replace("CENTRE", "CENTER").replace("EARTH MOON", "EARTH-MOON")
    if name not in GM:
        raise refusal("gm", gm, list(GM), f"must be given [km³/s²]: it is not known for {key} = {metadata[key]}")
    return GM[name]


def _chosen(path: str | os.PathLike[str], found: list[RawSegment], segments: Any) -> list[RawSegment]:
    if isinstance(segments, str) and segments == "all":
        return found
    try:
        place = operator.index(segments)
    except TypeError:
        raise TypeError(f'segments must be "all" or the number of a segment: got {segments!r}') from None
    if isinstance(segments, bool) or not 0 <= place < len(found):
        raise refusal("segments", segments, (0, len(found) - 1), f'must be "all", or from 0 to {len(found) - 1}: got {segments} ({path})')
    return [found[place]]


def _segment(raw: RawSegment, epoch: Fraction) -> Read:
    system = choice(raw, "TIME_SYSTEM", READABLE)
    left = _frame(raw)
    if not raw.records:
        raise ValueError(f"{raw.where}: a segment must have data")
    accelerated = len(raw.records[0].values) > len(STATE)
    table = np.array([row(record, STATE + ACCELERATION * accelerated) for record in raw.records])
    if len(raw.records) < 2:
        raise ValueError(f"{raw.records[0].where}: a segment must have two states or more: got 1")
    zero = np.flatnonzero(~table[:, :3].any(axis=1))
    if zero.size:
        raise ValueError(f"{raw.records[zero[0]].where}: a position must not be 0, that of the center itself")
    moments = ascending(raw, system)
    left += _within(raw, system, moments)
    if accelerated:
        left.append(f"{raw.records[0].where}: accelerations are not read")
    if raw.covariances:
        left.append(f"{raw.covariances[0]}: covariances are not read")
    return Read(tdb(moments, system, epoch), table[:, :3], table[:, 3:6], raw.metadata, left)


def _frame(raw: RawSegment) -> list[str]:
    """What is to be said about the frame.

    Raises
    ------
    ValueError
        A frame that turns, or whose axes are not known.
    """
    given, epoch = raw.metadata["REF_FRAME"], raw.metadata.get("REF_FRAME_EPOCH")
    if spelled(given) in OF_DATE:
        return [] if epoch else [f"{raw.where}: the axes of REF_FRAME = {given} are those of each date, and turn by 50″ a year; they are taken as fixed"]
    if spelled(given) not in INERTIAL:
        raise ValueError(f"{raw.where}: REF_FRAME must be inertial, one of {', '.join(INERTIAL + OF_DATE)}: got {given!r}")
    return []


def _within(raw: RawSegment, system: str, moments: list[Fraction]) -> list[str]:
    """What is to be said if data end more than a step before STOP_TIME.

    Rows may be a second outside: some programs round START_TIME and STOP_TIME.

    Raises
    ------
    ValueError
        A row before START_TIME or after STOP_TIME; a time that cannot be read.
    """
    limits = {}
    for key in ("START_TIME", "USEABLE_START_TIME", "USEABLE_STOP_TIME", "STOP_TIME"):
        if key in raw.metadata:
            try:
                limits[key] = parse(raw.metadata[key], system)
            except ValueError as error:
                raise ValueError(f"{raw.where}: {key}: {error}") from error
    first, last = raw.records[0], raw.records[-1]
    start, stop = limits["START_TIME"], limits["STOP_TIME"]
    if moments[0] < start - 1:
        raise ValueError(f"{first.where}: the data must begin at START_TIME = {raw.metadata['START_TIME']}: got {first.epoch}")
    if moments[-1] > stop + 1:
        raise ValueError(f"{last.where}: the data must end at STOP_TIME = {raw.metadata['STOP_TIME']}: got {last.epoch}")
    step = max((second - first for first, second in pairwise(moments)), default=Fraction(0))
    if stop - moments[-1] > step + 1:
        return [f"{last.where}: the data end at {last.epoch}, before STOP_TIME = {raw.metadata['STOP_TIME']}: the message may be cut off"]
    return []


def _joins(first: RawSegment, before: Read, second: RawSegment, after: Read) -> None:
    """Check that a segment begins where the one before it ends.

    Raises
    ------
    ValueError
        Another object, center, frame or time system; a gap; an overlap.
    """
    for key in SHARED:
        given = [raw.metadata.get(key) for raw in (first, second)]
        names = {spelled(name or "") for name in given}
        if len(names) > 1 and names != SAME:
            raise ValueError(
                f"{second.where}: {key} must be that of the segment before, of {first.where}, {given[0]}: got {given[1]}; segments=i reads one segment"
            )
    last, next = first.records[-1], second.records[0]
    if after.times[0] < before.times[-1]:
        raise ValueError(f"{next.where}: segments must not overlap: {next.epoch} is before {last.epoch} of {last.where}; segments=i reads one segment")
    if after.times[0] > before.times[-1]:
        raise ValueError(f"{next.where}: there is a gap between segments, from {last.epoch} ({last.where}) to {next.epoch}; segments=i reads one segment")
