"""Arguments of the fits: arrays of the right shapes, or an `InputError` that names the argument, its value and the bound."""

import reprlib
import sys
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Scene
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.interop import _attitudes
from andoyer.interop._foreign import as_one, epoch_of, parts, plain, since

LARGEST = 1e40
"""Bound of semi-axes, brightnesses and standard deviations: χ² and its derivatives have products of up to six of them."""
NEAR_UNIT = 1e-6
"""Deviation of the norm of a quaternion from 1 that is rounding."""


def finite(argument: str, value: ArrayLike) -> Array:
    """Finite float64 numbers."""
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise refusal(argument, repr(value), "numbers", f"= {reprlib.repr(value)}: it must be numbers") from None
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        place = "".join(f"[{index}]" for index in bad[0])
        raise refusal(argument, float(array[tuple(bad[0])]), "finite", f"{place} = {array[tuple(bad[0])]}: it must be finite".lstrip())
    return array


def from_first(argument: str, times: Any, scene: Any = None) -> tuple[Array, Any]:
    """Times since the first one, shape (n,), and the first one.

    The unit is that of plain numbers; it is the second for times, durations and quantities of astropy. The first one is a Time for times of astropy, None for durations, which count from the
    epoch of `scene`, otherwise a number.
    """
    astropy = sys.modules.get("astropy.time")
    value = as_one(argument, times)
    duration = astropy is not None and isinstance(value, astropy.TimeDelta)
    calendar = astropy is not None and isinstance(value, astropy.Time) and not duration
    shape = value.shape if calendar else np.shape(value)
    if len(shape) != 1 or not shape[0]:
        raise refusal(argument, shape, "(n,)", f"has shape {shape}: it must be (n,) with n above 0")
    if calendar:
        epoch = value[0]
        seconds, _, _ = since(argument, value, parts(epoch))
        return finite(argument, seconds), epoch
    if duration and isinstance(scene, Scene):
        at = from_epoch(argument, value, epoch_of(scene), 0.0)
    else:
        at = finite(argument, _numbers_of(argument, value))
    if duration and at[0] != 0:
        raise refusal(
            argument, float(at[0]), 0.0, f"[0] = {at[0]} s: durations count from the epoch of the scene, which is the first time, so the first must be 0"
        )
    return at - at[0], None if duration else float(at[0])


def from_epoch(argument: str, times: Any, epoch: Any, number: float) -> Array:
    """Times from an epoch, which is a Time or a number; `number` is the epoch as a number."""
    value = as_one(argument, times)
    astropy = sys.modules.get("astropy.time")
    if astropy is None or not isinstance(value, (astropy.Time, astropy.TimeDelta)):
        return np.asarray(_numbers_of(argument, value), dtype=np.float64) - number
    seconds, _, _ = since(argument, value, parts(epoch) if hasattr(epoch, "jd1") else [])
    return np.asarray(seconds, dtype=np.float64)


def span(argument: str, value: Any) -> Array:
    """Two numbers above 0, seconds for durations and quantities of astropy."""
    return positive(argument, _numbers_of(argument, as_one(argument, value)), (2,))


def _numbers_of(argument: str, value: Any) -> Any:
    return value if isinstance(value, (list, tuple)) else plain(argument, value)


def moderate(argument: str, value: ArrayLike, *shapes: tuple[int, ...]) -> Array:
    """Numbers above 0 whose squares and their products are doubles."""
    array = positive(argument, value, *shapes)
    for worst in (float(array.min()), float(array.max())):
        if not 1 / LARGEST <= worst <= LARGEST:
            bound = f"from {1 / LARGEST:g} to {LARGEST:g}"
            raise refusal(argument, worst, (1 / LARGEST, LARGEST), f"= {worst}: it must be {bound}; choose another unit")
    return array


def shaped(argument: str, value: ArrayLike, *shapes: tuple[int, ...]) -> Array:
    """Finite numbers of one of these shapes."""
    array = finite(argument, value)
    if array.shape not in shapes:
        allowed = " or ".join(map(str, shapes))
        raise refusal(argument, array.shape, allowed, f"has shape {array.shape}: it must be {allowed}")
    return array


def positive(argument: str, value: ArrayLike, *shapes: tuple[int, ...]) -> Array:
    """Numbers above 0."""
    array = shaped(argument, value, *shapes)
    if not np.all(array > 0):
        worst = float(array.min())
        raise refusal(argument, worst, "above 0", f"= {worst}: it must be above 0")
    return array


def unit_quaternions(argument: str, value: Any, count: int) -> Array:
    """Unit quaternions [x, y, z, w], shape (count, 4), from numbers, rotations of SciPy or quaternions of another package."""
    array = shaped(argument, _attitudes.quaternions(argument, value)[0], (count, 4))
    norms = np.linalg.norm(array, axis=1)
    worst = int(np.argmax(np.abs(norms - 1))) if count else 0
    if count and abs(norms[worst] - 1) > NEAR_UNIT:
        raise refusal(
            argument, float(norms[worst]), f"1 ± {NEAR_UNIT}", f"[{worst}] has norm {norms[worst]:.9g}: a unit quaternion has norm 1 within {NEAR_UNIT}"
        )
    unit: Array = array / norms[:, None]
    return unit


def whitening(sigma: ArrayLike, count: int) -> Array:
    """Matrices W of shape (count, 3, 3) with WᵀW the inverse covariance of each measurement, from sigma: a number, one for each or 3 × 3 covariances."""
    if np.ndim(sigma) < 3:
        each = np.broadcast_to(positive("sigma", sigma, (), (count,)), (count,))
        scaled: Array = np.eye(3) / each[:, None, None]
        return scaled
    inverse: Array = np.linalg.inv(np.linalg.cholesky(covariances("sigma", sigma, (count, 3, 3))))
    return inverse


def covariances(argument: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """A covariance matrix, or several: symmetric to 1e-9 and positive definite."""
    array = shaped(argument, value, shape)
    for index in np.ndindex(shape[:-2]):
        matrix, place = array[index], f"[{index[0]}] " if index else ""
        if not np.allclose(matrix, matrix.T, rtol=1e-9, atol=0.0):
            raise refusal(argument, index[0] if index else None, "symmetric", f"{place}is not symmetric: it must be a covariance matrix")
        deviations = np.sqrt(np.maximum(np.diag(matrix), 0.0))
        # Units of standard deviations, so that those of the quantities do not matter.
        scaled = matrix / np.outer(deviations, deviations) if np.all(deviations > 0) else matrix
        least = float(np.linalg.eigvalsh(scaled)[0]) if len(scaled) else 1.0
        if not least > len(scaled) * np.finfo(float).eps:
            raise refusal(argument, least, "above 0", f"{place}has the eigenvalue {least:.3g}: a covariance matrix has eigenvalues above 0")
    return array


def freed(free: Any, known: tuple[str, ...]) -> tuple[str, ...]:
    """The names of what is fitted, in canonical order."""
    try:
        names = (free,) if isinstance(free, str) else tuple(free)
    except TypeError:
        raise refusal("free", repr(free), ", ".join(known), f"= {free!r}: it must name some of {', '.join(known)}") from None
    for name in names:
        if name not in known:
            raise refusal("free", name, ", ".join(known), f"has {name!r}: it must be of {', '.join(known)}")
    if not names:
        raise refusal("free", "()", ", ".join(known), f"is empty: it must name some of {', '.join(known)}")
    return tuple(name for name in known if name in names)


def enough(data: int, parameters: int, argument: str, advice: str) -> None:
    """Refuses fewer data than parameters."""
    if data < parameters:
        raise refusal(argument, data, parameters, f"are {data} numbers for {parameters} parameters: {advice}")


MOST = 10_000_000
"""More draws or starts do not fit the memory."""


def whole_number(argument: str, value: Any, least: int) -> int:
    """A whole number from the least to `MOST`."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
        raise refusal(argument, value, least, f"= {value!r}: it must be a whole number, {least} or more")
    if value > MOST:
        raise refusal(argument, value, MOST, f"= {value!r}: it must be at most {MOST}")
    return int(value)


def generator_of(rng: Any) -> np.random.Generator:
    """A generator of random numbers from a seed or a generator."""
    try:
        return np.random.default_rng(rng)
    except (TypeError, ValueError):
        raise refusal("rng", repr(rng), "a seed or a Generator", f"= {rng!r}: it must be a whole number, 0 or more, or a numpy.random.Generator") from None


def scene_of(value: Any) -> Scene:
    """A scene."""
    if not isinstance(value, Scene):
        raise refusal("scene", type(value).__name__, "Scene", f"= {value!r}: it must be an andoyer.Scene")
    return value
