"""`Samples.from_arrays`: attitudes at times, of any origin."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from andoyer._core import Samples
from andoyer._quaternions import Array, angle_between
from andoyer._refusal import refusal
from andoyer.interop._attitudes import quaternions
from andoyer.interop._foreign import epochs, joined, later, parts, plain
from andoyer.output.rows import samples_of

NORM_SLACK = 1e-6
"""Largest difference from 1 of the norm of a quaternion."""


def from_arrays(times: Any, attitudes: Any, angular_velocity: Any, epoch: Any, scalar_first: bool) -> Samples:
    """The samples of arrays, as `Samples.from_arrays` describes them."""
    seconds, dates = _times(times, epoch)
    count = len(seconds)
    values, known = quaternions("attitudes", attitudes)
    attitude = _numbers("attitudes", values, (count, 4))
    if scalar_first and not known:
        attitude = np.roll(attitude, -1, axis=1)
    norms = np.linalg.norm(attitude, axis=1)
    far = np.flatnonzero(~(np.abs(norms - 1) <= NORM_SLACK))
    if far.size:
        raise refusal(f"attitudes[{far[0]}]", float(norms[far[0]]), 1.0, f"has the norm {norms[far[0]]:.9g}: it must be within {NORM_SLACK:g} of 1")
    rates = np.full((count, 3), np.nan)
    if angular_velocity is not None:
        rates = _numbers("angular_velocity", plain("angular_velocity", angular_velocity), (count, 3), unknown=True)
        _doubt(seconds, attitude, rates)
    # A norm that normalization leaves stays, so that samples of a motion keep their bits.
    norms[np.abs(norms - 1) <= 2 * np.finfo(float).eps] = 1.0
    return samples_of(seconds, attitude / norms[:, None], rates, dates)


def _doubt(times: Array, attitudes: Array, rates: Array) -> None:
    """Warns of rates in another unit: over the steps in which the attitudes turn by 1e-3 to 1 rad, the rates turn by less than a fifth of that or more than five times that, in the median."""
    turned = angle_between(attitudes[1:], attitudes[:-1])
    sizes = np.linalg.norm(rates, axis=1)
    stated = 0.5 * (sizes[1:] + sizes[:-1]) * np.diff(times)
    clear = (turned > 1e-3) & (turned < 1) & (stated > 0)
    factors = stated[clear] / turned[clear]
    if clear.sum() < 3 or 0.2 < np.median(factors) < 5:
        return
    factor = float(np.median(factors))
    said = f"{factor:.3g} times as fast as" if factor > 1 else f"{1 / factor:.3g} times slower than"
    warnings.warn(f"angular_velocity turns {said} attitudes do between times: are rates in rad per unit of the times, and not in degrees?", stacklevel=4)


def _times(times: Any, epoch: Any) -> tuple[Array, Any]:
    """The times in seconds or any unit, and their dates if they have some."""
    times = joined("times", times)
    of_calendar = hasattr(times, "tdb")
    if epoch is not None and not hasattr(epoch, "tdb"):
        raise TypeError(f"epoch must be an astropy Time, or None: got {epoch!r}")
    if epoch is not None and np.ndim(epoch.jd1):
        raise refusal("epoch", epoch, "one time", f"must be one time: got {epoch!r}")
    if epoch is not None and of_calendar:
        raise refusal("epoch", epoch, None, "must be left out: the times are dates already")
    seconds = _numbers("times", plain("times", times), (np.size(times),))
    if not seconds.size:
        raise refusal("times", 0, 1, "must hold one time or more: got 0")
    back = np.flatnonzero(~(np.diff(seconds) > 0))
    if back.size:
        row = back[0] + 1
        raise refusal(
            f"times[{row}]",
            float(seconds[row]),
            float(seconds[back[0]]),
            f"= {float(seconds[row])!r} must be after {float(seconds[back[0]])!r}, the one before it",
        )
    if epoch is None:
        return seconds, times if of_calendar else None
    dates = later(parts(epoch)[0], seconds)
    return epochs("times", dates)[0], dates


def _numbers(argument: str, value: Any, shape: tuple[int, ...], unknown: bool = False) -> Array:
    """An array of float64 with a shape and finite numbers; with `unknown` a row may be NaN.

    Raises
    ------
    TypeError
        No real numbers.
    InputError
        Another shape, or a number that is not finite.
    """
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise refusal(argument, repr(value), shape, f"must have the shape {shape}: {error}") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{argument} must hold real numbers, not {array.dtype}")
    array = array.astype(np.float64)
    if array.shape != shape:
        raise refusal(argument, array.shape, shape, f"must have the shape {shape}, one row for each time: got {array.shape}")
    lost = ~np.isfinite(array)
    if unknown:
        lost &= ~np.isnan(array).all(axis=1, keepdims=True)
    if lost.any():
        place = tuple(int(index) for index in np.argwhere(lost)[0])
        raise refusal(f"{argument}{list(place)}", float(array[place]), "finite", f"= {float(array[place])!r}: it must be finite")
    return array
