"""Conversion of values of astropy, pint and unyt to plain numbers. Quantities become SI units; times become TDB seconds since J2000 (2000-01-01T12:00:00 TDB).

Times of a motion are differences from its epoch, formed in the two doubles of astropy, because seconds since J2000 in one double are accurate only to 1e-7 s.
A duration from a calendar epoch is added to it by astropy: in the scale of the duration, or without one in the scale of the epoch (UTC: in TAI).

A package is imported only when one of its values is given.
"""

from __future__ import annotations

import re
import sys
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from andoyer._refusal import refusal

UNITS = {
    "times": "s",
    "time": "s",
    "periods": "s",
    "precession": "s",
    "rotation": "s",
    "phases": "cycle",
    "phases of librations": "rad",
    "amplitudes": "rad",
    "epoch": "s",
    "epochs": "s",
    "span": "s",
    "interval": "s",
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
    "velocities": "m / s",
    "moments": "kg m2",
    "tensor": "kg m2",
    "torque": "kg m2 / s2",
    "damping": "kg m2 / s",
    "momentum": "kg m2 / s",
    "reference_distances": "m",
    "tolerance": "rad",
    "inclination": "rad",
    "node": "rad",
    "argument_of_pericentre": "rad",
    "angles": "rad",
}
"""Unit of each argument that has one. That of longitude and latitude is in `unit_of`."""

RADIANS = {"attraction", "torque", "damping", "momentum"}
"""Arguments with powers of a rate, whose radians are left out: kg m² rad/s for an angular momentum."""

DURATIONS = {"periods", "precession", "rotation"}
"""Times that have no calendar date."""

SCALES = ["tdb", "tt", "tai", "utc", "tcb", "tcg", "ut1"]
"""Scales of a calendar epoch."""

Epoch: TypeAlias = tuple[list[float], int, list[float] | None]
"""A Julian date in two doubles, the index of its scale in `SCALES`, its geocentric location [m]."""

J2000 = 2451545.0
DAY = 86400.0


def plain(argument: str, value: Any) -> Any:
    """The numbers in a quantity or a time. Any other value is returned unchanged.

    Raises
    ------
    TypeError
        A quantity with a wrong unit, for example metres for times; an array with a mask.
    """
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
        angles = units.dimensionless_angles() if argument in RADIANS else []
        try:
            return value.to_value(unit, equivalencies=angles)
        except units.UnitConversionError:
            # astropy does not convert 1 Hz to rad/s, since a frequency may count turns or radians.
            advice = "; multiply by u.rad, or by u.cycle if it counts turns" if unit == "rad / s" and value.unit.is_equivalent("Hz") else ""
            raise TypeError(f"{argument} must be in {unit or 'no unit'}, or what converts to it: got {value.unit}{advice}") from None
    return converted(argument, value) if has_units(value) else value


def converted(argument: str, value: Any) -> Any:
    """The numbers in a quantity of pint or unyt.

    Raises
    ------
    TypeError
        A quantity with a wrong unit, and a value of any other package that carries a unit.
    """
    package = type(value).__module__.partition(".")[0]
    # astropy's "kg m2" is "kg*m**2" for pint and unyt.
    unit = re.sub(r"([a-z])(\d)", r"\1**\2", UNITS.get(argument, "")).replace(" / ", "/").replace(" ", "*")
    units = getattr(value, "units", None)
    try:
        if package == "pint":
            # pint has no dimension for an angle, and 1 Hz would become 1 rad/s.
            if unit == "rad/s" and "radian" not in str(value.to_root_units().units):
                raise ValueError("; multiply by radian, or by turn if it counts turns")
            if argument == "phases" and value.unitless:
                # A number of turns, as for astropy. For pint a bare number counts radians.
                return value.magnitude
            return value.to(unit.replace("cycle", "turn")).magnitude
        if package == "unyt":
            if argument in RADIANS:
                unyt = sys.modules["unyt"]
                radians = float(value.units.dimensions.as_powers_dict()[unyt.dimensions.angle])
                value = value / unyt.unyt_quantity(1.0, "rad") ** radians
            # unyt has no cycle.
            if argument == "phases" and value.units.is_dimensionless:
                return value.to_value("dimensionless")
            return value.to_value("degree") / 360 if unit == "cycle" else value.to_value(unit or "dimensionless")
    except Exception as error:
        advice = str(error) if isinstance(error, ValueError) and str(error).startswith(";") else ""
        raise TypeError(f"{argument} must be in {unit or 'no unit'}, or what converts to it: got {units}{advice}") from None
    kind = type(value).__name__
    if package == "pandas":
        raise TypeError(f"{argument} is a {kind} of pandas: give seconds, or astropy's Time(value) where the epoch is a Time")
    raise TypeError(f"{argument} is a {kind} of {package} and carries a unit, which is not converted: give its numbers in {unit or 'no unit'}")


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
    first = special(value)
    if first is None:
        return value
    unit = getattr(first, "unit", None)
    kind = type(first)
    if hasattr(first, "units") or (unit is not None and type(first).__module__.partition(".")[0] != "astropy"):
        return each(argument, value, kind)
    try:
        if unit is not None:
            return sys.modules["astropy.units"].Quantity(value)
        if not isinstance(first, sys.modules["astropy.time"].TimeDelta):
            return kind(value)
        # Durations do not join by themselves.
        scales = sorted({str(part.scale) for part in value})
        if len(scales) > 1:
            raise ValueError(f"one has the scale {scales[0]}, another {scales[1]}")
        return kind([part.jd1 for part in value], [part.jd2 for part in value], format="jd", scale=first.scale)
    except Exception as error:
        raise TypeError(f"{argument} must hold values of one kind, here {kind.__name__}: {str(error).splitlines()[0]}") from error


def special(values: Any) -> Any:
    """The first entry of a list that is no plain number, through any number of nested lists, or None."""
    for value in values:
        found = special(value) if isinstance(value, (list, tuple)) else value
        if found is not None and not isinstance(found, (float, int)):
            return found
    return None


def each(argument: str, values: Any, kind: type) -> Any:
    """The quantities in a nested list as numbers, if every entry is a quantity."""
    if isinstance(values, (list, tuple)):
        return [each(argument, value, kind) for value in values]
    if not has_units(values):
        raise TypeError(f"{argument} must hold values of one kind, here {kind.__name__}: got {values!r} too")
    return plain(argument, values)


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


def since(argument: str, value: Any, epochs: list[Epoch]) -> tuple[Any, Any, tuple[int, ...]]:
    """Seconds from epochs to times. Returns the seconds, the times as one object, and their shape.

    `epochs` is empty if the epoch is a number; otherwise it has one epoch, or one for each member. With one for each member the first axis of the seconds is that of the members.

    Raises
    ------
    InputError
        A calendar time if the epoch is a number.
    TypeError
        A duration in a scale that the epochs do not have.
    """
    value = joined(argument, value)
    unmasked(argument, value)
    if not epochs:
        if isinstance(value, sys.modules["astropy.time"].TimeDelta):
            return np.asarray(value.jd1 * DAY + value.jd2 * DAY, dtype=float), value, value.shape
        message = "is a calendar time, and the epoch of the state is a number: give the epoch as a Time too, or a TimeDelta from the epoch"
        raise refusal(argument, value, "numbers or a TimeDelta", message)
    given, epoch = value, calendar(epochs)
    if len(epochs) == 1:
        epoch = epoch[0]
    elif value.ndim < 2:
        # A row for each member.
        given, epoch = value.reshape(1, -1), epoch.reshape(-1, 1)
    else:
        epoch = epoch.reshape(-1, 1)
    moment, epoch = dated(argument, given, epoch)
    delta = moment.tdb - epoch.tdb
    return np.asarray(delta.jd1 * DAY + delta.jd2 * DAY, dtype=float), value, value.shape


def instants(argument: str, value: Any, epochs: list[Epoch]) -> Any:
    """Calendar times, and durations from the one epoch, as TDB seconds since J2000."""
    value = joined(argument, value)
    unmasked(argument, value)
    return seconds(dated(argument, value, calendar(epochs)[0])[0].tdb)


def dated(argument: str, value: Any, epoch: Any) -> tuple[Any, Any]:
    """Calendar times with the epoch; for durations the dates that astropy finds by adding them to the epoch, and the epoch plus a duration of 0.

    astropy adds a duration with a scale in this scale, and one without in the scale of the epoch, or in TAI if this scale is UTC.
    """
    if not isinstance(value, sys.modules["astropy.time"].TimeDelta):
        return value, epoch
    try:
        # The sum with 0 has the rounding of the other sum, so that the difference is 0 for a duration of 0.
        return epoch + value, epoch + 0 * value
    except TypeError:
        raise TypeError(f"{argument} is a TimeDelta in the scale {value.scale}, which cannot be added to an epoch in the scale {epoch.scale}") from None


def scene_times(argument: str, value: Any, epoch: Any) -> Any:
    """Times of a scene as numbers: in the unit of the scene, or TDB seconds since J2000 if its epoch is a Time.

    Raises
    ------
    InputError
        A calendar time if the epoch is a number; a Quantity if the epoch is a Time.
    """
    of_calendar = hasattr(epoch, "jd1")
    first = special(value) if isinstance(value, (list, tuple)) else value
    if of_calendar and not hasattr(first, "jd1") and has_units(first):
        raise refusal(
            argument, "a Quantity", "a Time or a TimeDelta", "is a Quantity, and the epoch a calendar time: give a Time, or a TimeDelta from the epoch"
        )
    value = as_one(argument, value)
    if not hasattr(value, "jd1"):
        return plain(argument, value)
    if of_calendar:
        return instants(argument, value, parts(epoch))
    return epoch + since(argument, value, [])[0]


def has_units(value: Any) -> bool:
    """Whether a value carries units of another package."""
    return hasattr(value, "unit") or hasattr(value, "units")


def as_one(argument: str, value: Any) -> Any:
    """A list of times or quantities as one object. Any other value is returned unchanged."""
    first = value[0] if isinstance(value, (list, tuple)) and len(value) else value
    return joined(argument, value) if has_units(first) or hasattr(first, "jd1") else value


def epoch_of(scene: Any) -> Any:
    """The epoch of a scene as given: a number or a Time."""
    _, options = scene.__getnewargs_ex__()
    return options.get("epoch", 0.0)


def epochs(argument: str, value: Any) -> tuple[Any, list[Epoch]]:
    """Calendar times as TDB seconds since J2000, and their parts; durations as seconds."""
    value = joined(argument, value)
    unmasked(argument, value)
    if isinstance(value, sys.modules["astropy.time"].TimeDelta):
        return plain(argument, value), []
    return seconds(value.tdb), parts(value)


def parts(moment: Any) -> list[Epoch]:
    """The parts of each epoch: its Julian date in two doubles, the index of its scale, and its location."""
    julian = np.stack([np.ravel(moment.jd1), np.ravel(moment.jd2)], axis=-1).tolist()
    if moment.location is None:
        return [(date, SCALES.index(moment.scale), None) for date in julian]
    places = np.stack([np.broadcast_to(axis.to_value("m"), moment.shape).ravel() for axis in moment.location.geocentric], axis=-1).tolist()
    return [(date, SCALES.index(moment.scale), place) for date, place in zip(julian, places)]


def calendar(epochs: list[Epoch]) -> Any:
    """The Time objects of epochs in one scale, shape (n,)."""
    import astropy.coordinates  # type: ignore[import-untyped, import-not-found, unused-ignore]
    import astropy.time  # type: ignore[import-untyped, import-not-found, unused-ignore]

    julian, scales, places = zip(*epochs)
    first, second = np.array(julian).T
    location = None if places[0] is None else astropy.coordinates.EarthLocation.from_geocentric(*np.array(places).T, unit="m")
    return astropy.time.Time(first, second, format="jd", scale=SCALES[scales[0]], location=location)


def later(epoch: Epoch | None, seconds: float | NDArray[Any]) -> Any:
    """The Time in TDB that is some TDB seconds after an epoch, or after J2000."""
    import astropy.time

    start = calendar([epoch or ([J2000, 0.0], SCALES.index("tdb"), None)])[0]
    return start.tdb + astropy.time.TimeDelta(seconds, format="sec", scale="tdb")


def numbers(times: Any) -> NDArray[Any]:
    """Times of samples as an array: times of astropy as datetime64 in their own time scale, durations in seconds."""
    if isinstance(times, np.ndarray):
        return times
    if isinstance(times, sys.modules["astropy.time"].TimeDelta):
        return np.asarray(times.jd1 * DAY + times.jd2 * DAY)
    return np.asarray(times.to_value("datetime64"))
