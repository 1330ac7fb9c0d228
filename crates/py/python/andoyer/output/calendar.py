"""Calendar times of CCSDS messages as exact seconds, and back.

A calendar time is a number of seconds since 2000-01-01T12:00:00 in its own time scale, as an exact fraction. UTC is counted in
SI seconds with the leap seconds of astropy. The conversion of TDB to other scales also uses astropy; other conversions do not need it.
"""

import re
from bisect import bisect_right
from collections.abc import Sequence
from datetime import date as Day
from datetime import datetime, timedelta
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from andoyer._extra import extra
from andoyer._quaternions import Array

J2000 = datetime(2000, 1, 1, 12)

TIME_SYSTEMS = ["TDB", "TT", "TAI", "GPS", "UTC"]
"""Scales that are written; UTC needs astropy for its leap seconds."""

READABLE = [*TIME_SYSTEMS, "TCB", "TCG"]
"""Scales that are read: those of uniform seconds, and UTC."""

EPOCH_DIGITS = 12
"""Decimals of the second in an epoch that is written."""

CALENDAR_DIGITS = 10
"""Decimals of the second in a time of astropy: its part of a day in a double is good to 2.4e-12 s, and the conversion to another scale adds a few times this."""

DAY = 86400
JULIAN_J2000 = 2451545
GPS_BEHIND_TAI = 19
"""Seconds: GPS = TAI − 19 s."""
TT_LESS_TAI = Fraction(32184, 1000)
"""Seconds: TT = TAI + 32.184 s."""

EPOCH = re.compile(r"(\d{4})-(?:(\d{2})-(\d{2})|(\d{3}))T(\d{2}):(\d{2}):(\d{2})(?:\.(\d*))?(Z?)", re.ASCII)


def parse(text: str, system: str) -> Fraction:
    """Seconds since 2000-01-01T12:00:00 of the scale `system` at a calendar time, YYYY-MM-DDThh:mm:ss[.d][Z] or YYYY-DDDThh:mm:ss[.d][Z].

    Raises
    ------
    ValueError
        Another form; a day, hour, minute or second that the calendar does not have; Z, which means UTC, in another scale.
    """
    match = EPOCH.fullmatch(text)
    if match is None:
        raise ValueError(f"an epoch must be like 2000-01-31T12:00:00.5 or 2000-031T12:00:00.5: got {text!r}")
    year, month, day, of_year, hour, minute, second = (int(part) if part else 0 for part in match.groups()[:7])
    try:
        date = Day(year, month, day) if month else Day(year, 1, 1) + timedelta(days=of_year - 1)
    except (ValueError, OverflowError):
        date = None
    if date is None or date.year != year or hour > 23 or minute > 59 or second > 60:
        raise ValueError(f"an epoch must be a time of the calendar: got {text!r}")
    if match[9] and system != "UTC":
        raise ValueError(f"Z is UTC, but the time system is {system}: got {text!r}")
    if second == 60 and not (system == "UTC" and (hour, minute) == (23, 59) and _leap_seconds(date + timedelta(days=1)) > _leap_seconds(date)):
        raise ValueError(f"only a leap second of UTC is number 60 of its minute: got {text!r}")
    whole = (date - J2000.date()).days * DAY - DAY // 2 + hour * 3600 + minute * 60 + second
    if system == "UTC":
        whole += _leap_seconds(date) - _leap_seconds(J2000.date())
    decimals = match[8] or ""
    return whole + Fraction(int(decimals or "0"), 10 ** len(decimals))


def count(date: datetime, system: str) -> Fraction:
    """Seconds since 2000-01-01T12:00:00 of the scale at a date without a zone."""
    return parse(f"{date.replace(microsecond=0).isoformat()}.{date.microsecond:06d}", system)


def counts(times: Any, system: str) -> list[Fraction]:
    """Seconds since 2000-01-01T12:00:00 of the scale at the times of an astropy Time, rounded to `CALENDAR_DIGITS` decimals."""
    offset = {"GPS": -GPS_BEHIND_TAI, "UTC": -_leap_seconds(J2000.date())}.get(system, 0)
    moments = getattr(times, "tai" if offset else system.lower())
    exact = [
        (Fraction(float(first)) - JULIAN_J2000 + Fraction(float(second))) * DAY + offset
        for first, second in zip(np.atleast_1d(moments.jd1), np.atleast_1d(moments.jd2))
    ]
    return [round(moment, CALENDAR_DIGITS) for moment in exact]


def written(seconds: Fraction, system: str) -> str:
    """The calendar time for a number of seconds since 2000-01-01T12:00:00 of the scale, to `EPOCH_DIGITS` decimals.

    Raises
    ------
    ValueError
        A year outside 1 to 9999; UTC before 1972.
    """
    whole, parts = divmod(round(seconds * 10**EPOCH_DIGITS), 10**EPOCH_DIGITS)
    leap = 0
    if system == "UTC":
        whole, leap = _utc(whole)
    try:
        then = J2000 + timedelta(seconds=whole)
    except OverflowError:
        raise ValueError(f"years from 1 to 9999, and {float(seconds)!r} s after {J2000.isoformat()} is outside") from None
    return f"{then:%Y-%m-%dT%H:%M:}{then.second + leap:02d}.{parts:0{EPOCH_DIGITS}d}".rjust(20 + EPOCH_DIGITS, "0")


def seconds_of_tdb(date: datetime, system: str) -> float:
    """Seconds of TDB since J2000, 2000-01-01T12:00:00 TDB, at a date."""
    return float(tdb([count(date, system)], system)[0])


def tdb(moments: Sequence[Fraction], system: str, epoch: Fraction = Fraction(0)) -> Array:
    """TDB seconds since J2000, less `epoch`, at times given in seconds since 2000-01-01T12:00:00 of the scale.

    For TCB and TCG the difference is formed after rounding to doubles.

    Raises
    ------
    ImportError
        A scale other than TDB without astropy.
    """
    if system == "TDB":
        return np.array([float(moment - epoch) for moment in moments])
    erfa = _erfa(f"converting {system} to TDB")
    # GPS and UTC are counted in SI seconds; 2000-01-01T12:00:00 UTC was 32 s of TAI later.
    behind = {"GPS": GPS_BEHIND_TAI, "UTC": _leap_seconds(J2000.date()) if system == "UTC" else 0}.get(system, 0)
    offset = behind + TT_LESS_TAI if system in ("TAI", "GPS", "UTC") else 0
    given = [divmod(moment + offset, DAY) for moment in moments]
    julian = np.array([[float(JULIAN_J2000 + days), float(rest / DAY)] for days, rest in given]).T
    if system == "TCB":
        return _since_j2000(*erfa.tcbtdb(*julian)) - float(epoch)
    if system == "TCG":
        julian = np.array(erfa.tcgtt(*julian))
    less_tt = erfa.dtdb(*julian, 0.0, 0.0, 0.0, 0.0)
    if system == "TCG":
        together: Array = _since_j2000(*julian) + less_tt - float(epoch)
        return together
    return np.array([float(moment + offset + Fraction(float(less)) - epoch) for moment, less in zip(moments, less_tt)])


def _since_j2000(first: Array, second: Array) -> Array:
    seconds: Array = ((first - JULIAN_J2000) + second) * DAY
    return seconds


def _leap_seconds(day: Day) -> int:
    """TAI − UTC [s] on a day."""
    days, offsets = _table()
    place = bisect_right(days, day)
    if not place:
        raise ValueError(f"UTC has whole leap seconds from {days[0].isoformat()} on: got {day.isoformat()}")
    return offsets[place - 1]


def _utc(whole: int) -> tuple[int, int]:
    """The calendar seconds of UTC since 2000-01-01T12:00:00 for a number of SI seconds, and 1 within a leap second, otherwise 0."""
    first = _leap_seconds(J2000.date())
    days, offsets = _table()
    starts = [(day - J2000.date()).days * DAY - DAY // 2 + offset - first for day, offset in zip(days, offsets)]
    place = bisect_right(starts, whole)
    if not place:
        raise ValueError(f"UTC has whole leap seconds from {days[0].isoformat()} on: {whole} s after {J2000.isoformat()} is before")
    label = whole - (offsets[place - 1] - first)
    # The second before the next step is 23:59:60 of the day that it ends.
    leap = place < len(starts) and whole >= starts[place] - (offsets[place] - offsets[place - 1])
    return (label - 1, 1) if leap else (label, 0)


@cache
def _table() -> tuple[list[Day], list[int]]:
    """Days on which TAI − UTC changed, and its values from then on."""
    erfa = _erfa("UTC, for its leap seconds,")
    rows = [(Day(int(row["year"]), int(row["month"]), 1), float(row["tai_utc"])) for row in erfa.leap_seconds.get()]
    whole = [(day, round(offset)) for day, offset in rows if offset == int(offset)]
    return [day for day, _ in whole], [offset for _, offset in whole]


def _erfa(purpose: str) -> Any:
    """The library of astropy for time scales. Importing astropy updates its leap seconds."""
    extra("astropy.time", purpose)
    return extra("erfa", purpose)
