"""Conversion of samples to pandas tables and xarray data sets. Only this module imports these packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from andoyer._extra import extra
from andoyer.interop._foreign import numbers

if TYPE_CHECKING:
    from andoyer import Samples

RATES = ["wx", "wy", "wz"]


def pandas(samples: Samples) -> Any:
    """A table with a row for each time, or for each member and time."""
    pd = extra("pandas", "Samples.to_pandas")
    columns = [*_quaternion(samples, "q"), *RATES]
    rows = np.concatenate([samples.attitude, samples.angular_velocity], axis=-1).reshape(-1, 7)
    times = np.atleast_1d(numbers(samples.times))
    if not _ensemble(samples):
        return pd.DataFrame(rows, index=pd.Index(times, name="t"), columns=columns)
    members = np.arange(samples.attitude.shape[0])
    each = np.broadcast_to(times, (members.size, times.shape[-1]))
    index = pd.MultiIndex.from_arrays([np.repeat(members, each.shape[1]), each.ravel()], names=["member", "t"])
    return pd.DataFrame(rows, index=index, columns=columns)


def xarray(samples: Samples) -> Any:
    """A data set with the dimensions member (of an ensemble), time (unless it is a scalar), quaternion, axis."""
    xr = extra("xarray", "Samples.to_xarray")
    times = numbers(samples.times)
    before = ["member"] * _ensemble(samples) + ["time"] * (times.ndim > 0)
    own = times.ndim == 2
    return xr.Dataset(
        {
            "attitude": ([*before, "quaternion"], samples.attitude),
            "angular_velocity": ([*before, "axis"], samples.angular_velocity),
        },
        coords={
            "t" if own else "time": (before if own else before[-1:] if times.ndim else [], times),
            "quaternion": _quaternion(samples, ""),
            "axis": [1, 2, 3],
        },
    )


def _quaternion(samples: Samples, prefix: str) -> list[str]:
    return [prefix + name for name in ("wxyz" if samples.scalar_first else "xyzw")]


def _ensemble(samples: Samples) -> bool:
    return bool(samples.times.ndim == 2 or samples.attitude.ndim > samples.times.ndim + 1)
