"""Samples of one motion as rows of numbers, and back."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Motion, Samples
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.interop import _attitudes
from andoyer.interop._foreign import plain

COLUMNS = "t,qx,qy,qz,qw,wx,wy,wz"
CONVENTION = (
    "t in the scene's unit of time; attitude [qx, qy, qz, qw]: unit quaternion, Hamilton product, scalar last, "
    "body components to inertial ones; angular velocity [wx, wy, wz]: body components, rad per unit of time"
)


def rows(samples: Samples) -> Array:
    """The samples as an array of shape (n, 8) with the columns of `COLUMNS`, for either order of the quaternions.

    Calendar times are in TDB seconds since J2000.

    Raises
    ------
    InputError
        Samples of an ensemble.
    """
    samples = given_samples(samples)
    times = plain("times", samples.times)
    if samples.times.ndim > 1 or samples.attitude.ndim > samples.times.ndim + 1:
        raise refusal("samples", repr(samples), "one motion", f"must be of one motion: got {samples!r}; a file holds one member of an ensemble")
    quaternions, known = _attitudes.quaternions("samples.attitude", samples.attitude)
    attitude = np.atleast_2d(quaternions)
    if samples.scalar_first and not known:
        attitude = np.roll(attitude, -1, axis=1)
    return np.column_stack([np.atleast_1d(times), attitude, np.atleast_2d(samples.angular_velocity)])


def given_samples(value: Any) -> Samples:
    """The samples that a writer was given: `Samples`, or what has them, as a `Table` does.

    Raises
    ------
    TypeError
        Anything else, a `Motion` for example.
    """
    samples: Samples = getattr(value, "samples", value)
    if not all(hasattr(samples, name) for name in ("times", "attitude", "angular_velocity")) or isinstance(samples, Motion):
        raise TypeError(f"samples must be Samples, such as motion.at(times): got {value!r}")
    return samples


def calendar_times(samples: Samples) -> Any:
    """The times of the samples if they are an astropy Time, or None."""
    samples = given_samples(samples)
    return samples.times if hasattr(samples.times, "tdb") else None


def samples_of(times: ArrayLike, attitude: ArrayLike, angular_velocity: ArrayLike, calendar: Any = None) -> Samples:
    """Samples with their own arrays of shapes (n,), (n, 4) scalar last, (n, 3); `calendar` has the times as an astropy Time."""
    arrays = [np.array(value, dtype=np.float64) for value in (times, attitude, angular_velocity)]
    restored: Samples = Samples._restored(*arrays, False, calendar)  # type: ignore[attr-defined]
    return restored
