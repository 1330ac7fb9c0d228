"""Conversion of values of astropy and SciPy to plain numbers. Quantities become SI units; times become TDB seconds since J2000 (2000-01-01T12:00:00 TDB).

Times of a motion are differences from its epoch, formed in the two doubles of astropy, because seconds since J2000 in one double are accurate only to 1e-7 s.

A package is imported only when one of its values is given.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from andoyer._core import InputError

UNITS = {
    "times": "s",
    "time": "s",
    "periods": "s",
    "precession": "s",
    "rotation": "s",
    "phases": "cycle",
    "epoch": "s",
    "epochs": "s",
    "span": "s",
    "time_of_pericentre": "s",
    "angular_velocity": "rad / s",
    "angular_velocities": "rad / s",
    "mean_motion": "rad / s",
    "node_rate": "rad / s",
    "pericentre_rate": "rad / s",
    "spin_rate": "rad / s",
    "attraction": "1 / s2",
    "gm": "m3 / s2",
    "semi_major_axis": "m",
    "radius": "m",
    "positions": "m",
    "position": "m",
    "velocity": "m / s",
    "moments": "kg m2",
    "tensor": "kg m2",
    "tolerance": "rad",
    "inclination": "rad",
    "node": "rad",
    "argument_of_pericentre": "rad",
}
"""Unit of each argument that has one. That of longitude and latitude is in `unit_of`."""

DURATIONS = {"periods", "precession", "rotation"}
"""Times that have no calendar date."""

J2000 = 2451545.0
DAY = 86400.0


def plain(argument: str, value: Any) -> Any:
    """The numbers in a quantity, a time or a rotation. Any other value is returned unchanged.

    Raises
    ------
    TypeError
        A quantity with a wrong unit, for example metres for times; an array with a mask.
    """
    if hasattr(value, "as_quat"):
        return value.as_quat()
    value = joined(argument, value)
    unmasked(argument, value)
    units, time = sys.modules.get("astropy.units"), sys.modules.get("astropy.time")
    if time is not None and isinstance(value, time.Time):
        if UNITS.get(argument) != "s" or argument in DURATIONS:
            raise TypeError(f"{argument} must be no astropy Time: got {value!r}")
        return seconds(value.tdb)
    if time is not None and isinstance(value, time.TimeDelta):
        if UNITS.get(argument) != "s":
            raise TypeError(f"{argument} must be no astropy TimeDelta: got {value!r}")
        return value.jd1 * DAY + value.jd2 * DAY
    if units is not None and isinstance(value, units.Quantity):
        unit = unit_of(argument, value)
        # The square of a mean motion in rad/s is in rad²/s².
        angles = units.dimensionless_angles() if argument == "attraction" else []
        try:
            return value.to_value(unit, equivalencies=angles)
        except units.UnitConversionError:
            # astropy does not convert 1 Hz to rad/s, since a frequency may count turns or radians.
            advice = "; multiply by u.rad, or by u.cycle if it counts turns" if unit == "rad / s" and value.unit.is_equivalent("Hz") else ""
            raise TypeError(f"{argument} must be in {unit or 'no unit'}, or what converts to it: got {value.unit}{advice}") from None
    return value


def unit_of(argument: str, quantity: Any) -> str:
    """The unit to which a quantity is converted. A quantity without a unit is taken as it is for a direction and for phases, which are numbers of turns."""
    bare = quantity.unit.is_equivalent("")
    if argument == "momentum_direction":
        return "rad" if quantity.shape == (2,) and not bare else ""
    return "" if argument == "phases" and bare else UNITS.get(argument, "")


def seconds(moment: Any) -> Any:
    """A TDB time in seconds since J2000."""
    return ((moment.jd1 - J2000) + moment.jd2) * DAY


def joined(argument: str, value: Any) -> Any:
    """A list of times or quantities as one object. Any other value is returned unchanged.

    Raises
    ------
    TypeError
        A list with both times and quantities, or with plain numbers among them.
    """
    if not isinstance(value, (list, tuple)):
        return value
    first = value[0]
    while isinstance(first, (list, tuple)):
        first = first[0]
    unit = getattr(first, "unit", None)
    kind = type(first)
    try:
        if unit is not None:
            return sys.modules["astropy.units"].Quantity(value)
        if not isinstance(first, sys.modules["astropy.time"].TimeDelta):
            return kind(value)
        # Durations do not join by themselves.
        return kind([part.jd1 for part in value], [part.jd2 for part in value], format="jd", scale=first.scale)
    except Exception as error:
        raise TypeError(f"{argument} must hold values of one kind, here {kind.__name__}: {str(error).splitlines()[0]}") from error


def unmasked(argument: str, value: Any) -> None:
    """Refuse an array that has a mask, and a time or quantity with a masked entry.

    Raises
    ------
    TypeError
        The value has a mask or a masked entry.
    """
    masked = bool(value.masked) if hasattr(value, "jd1") else isinstance(value, np.ma.MaskedArray) or hasattr(value, "unmasked")
    if masked:
        raise TypeError(f"{argument} is a masked array: give the entries that count, such as values[~mask]")


def since(argument: str, value: Any, first: list[float], second: list[float]) -> tuple[Any, Any, tuple[int, ...]]:
    """Seconds from epochs to times. Returns the seconds, the times as one object, and their shape.

    `first` and `second` are the TDB Julian dates of the epochs in two doubles: empty if the epoch is a number, otherwise one date, or one for each member. With one
    for each member the first axis of the seconds is that of the members.

    Raises
    ------
    InputError
        A calendar time if the epoch is a number.
    """
    value = joined(argument, value)
    unmasked(argument, value)
    if isinstance(value, sys.modules["astropy.time"].TimeDelta):
        return np.asarray(value.jd1 * DAY + value.jd2 * DAY, dtype=float), value, value.shape
    if not first:
        error = InputError(
            f"{argument} is a calendar time, and the epoch of the state is a number: give the epoch as a Time too, or a TimeDelta from the epoch"
        )
        error.argument, error.value, error.bound = argument, value, "numbers or a TimeDelta"
        raise error
    moment, epoch = value.tdb, calendar(first, second)
    if len(first) == 1:
        epoch = epoch[0]
    elif value.ndim < 2:
        # A row for each member.
        moment, epoch = moment.reshape(1, -1), epoch.reshape(-1, 1)
    else:
        epoch = epoch.reshape(-1, 1)
    delta = moment - epoch
    return np.asarray(delta.jd1 * DAY + delta.jd2 * DAY, dtype=float), value, value.shape


def epochs(argument: str, value: Any) -> tuple[Any, list[tuple[float, float]]]:
    """Calendar times as TDB seconds since J2000, and as the two doubles of their TDB Julian dates; durations as seconds."""
    value = joined(argument, value)
    unmasked(argument, value)
    if isinstance(value, sys.modules["astropy.time"].TimeDelta):
        return plain(argument, value), []
    moment = value.tdb
    return seconds(moment), list(zip(np.ravel(moment.jd1).tolist(), np.ravel(moment.jd2).tolist()))


def calendar(first: list[float], second: list[float]) -> Any:
    """The Time objects of TDB Julian dates in two doubles."""
    import astropy.time  # type: ignore[import-untyped, import-not-found, unused-ignore]

    return astropy.time.Time(np.array(first), np.array(second), format="jd", scale="tdb")


def later(epoch: list[float] | None, seconds: float) -> Any:
    """The Time that is some TDB seconds after an epoch, given as a TDB Julian date in two doubles, or after J2000."""
    import astropy.time

    first, second = epoch or (J2000, 0.0)
    return calendar([first], [second])[0] + astropy.time.TimeDelta(seconds, format="sec", scale="tdb")


def numbers(times: Any) -> NDArray[Any]:
    """Times of samples as an array: times of astropy as datetime64 in their own time scale, durations in seconds."""
    if isinstance(times, np.ndarray):
        return times
    if isinstance(times, sys.modules["astropy.time"].TimeDelta):
        return np.asarray(times.jd1 * DAY + times.jd2 * DAY)
    return np.asarray(times.to_value("datetime64"))
