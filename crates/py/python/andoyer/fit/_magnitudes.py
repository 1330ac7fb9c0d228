"""Photometry as observers have it: magnitudes, zero points of curves, light time."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.fit._given import moderate, shaped
from andoyer.interop._foreign import as_one, has_units

POGSON = 2.5 / np.log(10)
"""Magnitudes per unit of ln brightness."""
LIGHT_TIME = 149_597_870_700 / 299_792_458
"""Seconds per au (IAU 2012 B2)."""
FAINTEST = 60.0
"""Largest size of a magnitude."""


class ZeroPoints(NamedTuple):
    """Zero points of light curves: the magnitude of a body whose brightness is 1, as of `fit.brightness`."""

    curves: Array
    """Labels of the curves, shape (c,)."""
    magnitudes: Array
    """Zero points [mag], shape (c,). For curves in intensities −2.5 lg of their factors."""
    sigma: Array
    """Standard deviations [mag], with those of the state, shape (c,)."""


class Photometry(NamedTuple):
    """Brightnesses as they are fitted, with what leads back to the data as given."""

    brightness: Array
    """Intensities, or of magnitudes the logarithms of intensities near 1."""
    sigma: Array
    zero: Array | None
    """Of each point the magnitude of intensity 1; None where intensities were given."""

    @property
    def given(self) -> Array:
        """The data as they were given."""
        given: Array = self.brightness if self.zero is None else self.zero - POGSON * self.brightness
        return given

    def as_given(self, intensities: Array) -> Array:
        """Intensities in the unit of the data."""
        if self.zero is None:
            return intensities
        magnitudes: Array = self.zero - POGSON * np.log(intensities)
        return magnitudes


def photometry(brightness: Any, magnitudes: Any, sigma: Any, labels: Array) -> Photometry:
    """Intensities as given, or the logarithms of those of magnitudes: errors of magnitudes are symmetric there, and a zero point is a mean."""
    count = len(labels)
    if (brightness is None) == (magnitudes is None):
        raise refusal("magnitudes", repr(magnitudes), "one of the two", "and brightness: give one of the two")
    if magnitudes is None:
        values = shaped("brightness", brightness, (count,))
        if not np.all(values > 0):
            worst = float(values.min())
            raise refusal("brightness", worst, "above 0", f"= {worst}: an intensity is above 0; magnitudes go to magnitudes=")
        values = moderate("brightness", values, (count,))
        return Photometry(values, np.broadcast_to(moderate("sigma", sigma, (), (count,)), (count,)), None)
    given = shaped("magnitudes", magnitudes, (count,))
    far = np.flatnonzero(np.abs(given) > FAINTEST)
    if far.size:
        worst = float(given[far[0]])
        raise refusal(f"magnitudes[{far[0]}]", worst, FAINTEST, f"= {worst}: a magnitude is between -{FAINTEST:g} and {FAINTEST:g}")
    deviations = np.broadcast_to(moderate("sigma", sigma, (), (count,)), (count,))
    zero = np.zeros(count)
    for label in np.unique(labels):
        zero[labels == label] = np.median(given[labels == label])
    return Photometry((zero - given) / POGSON, deviations / POGSON, zero)


def emitted(argument: str, times: Any, at: Array, epoch: Any, distances: ArrayLike) -> tuple[Array, Any, Array]:
    """Times since the first one, and the first one, at the body instead of the observer, and the light times [s].

    Raises
    ------
    InputError
        Times without a unit, of which a light time in seconds cannot be taken; distances that are not above 0.
    """
    value = as_one("distances", distances)
    if has_units(value):
        units = extra("astropy.units", "distances with a unit")
        quantity = units.Quantity(value)
        if not quantity.unit.is_equivalent("au"):
            raise TypeError(f"distances must be in au, or what converts to it: got {quantity.unit}")
        value = quantity.to_value("au")
    light = LIGHT_TIME * np.broadcast_to(moderate("distances", value, (), (len(at),)), at.shape)
    of_calendar = hasattr(epoch, "jd1")
    if not of_calendar and not has_units(as_one(argument, times)):
        raise refusal("distances", "with plain times", "times with a unit", "give light times in seconds: give the times as a Time or a Quantity of astropy")
    if of_calendar:
        first = epoch - extra("astropy.time", "light times").TimeDelta(light[0], format="sec", scale="tai" if epoch.scale == "utc" else None)
    else:
        first = None if epoch is None else epoch - light[0]
    return at - (light - light[0]), first, light
