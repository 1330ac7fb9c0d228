"""Values of astropy and SciPy as plain numbers. Quantities are taken in SI units, times in TDB seconds since J2000, 2000-01-01T12:00:00 TDB.

Neither package is imported before a value of it is given.
"""

from __future__ import annotations

import sys
from typing import Any

UNITS = {
    "times": "s",
    "epoch": "s",
    "span": "s",
    "time_of_pericentre": "s",
    "angular_velocity": "rad / s",
    "angular_velocities": "rad / s",
    "mean_motion": "rad / s",
    "moments": "kg m2",
    "tolerance": "rad",
    "inclination": "rad",
    "node": "rad",
    "argument_of_pericentre": "rad",
}
"""Unit of each argument; of the others none."""

J2000 = 2451545.0


def plain(argument: str, value: Any) -> Any:
    """The numbers in a quantity, a time or a rotation; anything else as it is.

    Raises
    ------
    TypeError
        A quantity of another kind: metres for times.
    """
    if hasattr(value, "as_quat"):
        return value.as_quat()
    units, time = sys.modules.get("astropy.units"), sys.modules.get("astropy.time")
    if time is not None and isinstance(value, time.Time):
        if UNITS.get(argument) != "s":
            raise TypeError(f"{argument} must be no astropy Time: got {value!r}")
        moment = value.tdb
        return ((moment.jd1 - J2000) + moment.jd2) * 86400.0
    if units is not None and isinstance(value, units.Quantity):
        unit = UNITS.get(argument, "")
        try:
            return value.to_value(unit)
        except units.UnitConversionError:
            # 1 Hz is no rad/s in astropy, since a frequency may count turns or radians.
            advice = "; rates in turns per second have the unit u.cycle / u.s" if unit == "rad / s" and value.unit.is_equivalent("Hz") else ""
            raise TypeError(f"{argument} must be in {unit or 'no unit'}, or what converts to it: got {value.unit}{advice}") from None
    return value
