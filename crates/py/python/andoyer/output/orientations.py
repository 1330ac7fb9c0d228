"""Attitudes from SPICE's binary planetary constants kernels (PCK), read without SpiceyPy."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Samples, _read_pck
from andoyer._refusal import refusal
from andoyer.interop._foreign import epochs

FRAMES = {"MOON_PA_DE403": 31002, "MOON_PA_DE418": 31004, "MOON_PA_DE421": 31006, "MOON_PA_DE440": 31008, "ITRF93": 3000}
"""Class IDs of frames by their names, as in NAIF's frame kernels of the Moon and the Earth."""


def read_pck(path: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], body: int | str, times: ArrayLike | Any) -> Samples:
    """Read the attitude of a body from binary PCK files, type 2.

    Parameters
    ----------
    path : path-like or sequence of path-like
        Files; where several cover a time, the last counts.
    body : int or str
        Class ID of the body frame, or its name: MOON_PA_DE440, MOON_PA_DE421, MOON_PA_DE418, MOON_PA_DE403, ITRF93.
    times : array_like, shape (n,), or Time
        Seconds of TDB past J2000.

    Returns
    -------
    Samples
        Attitudes that rotate body components into those of J2000, and angular velocities in body components [rad/s].

    Raises
    ------
    FileError
        A file that is missing, damaged or no binary PCK, or a segment of a type or frame that is not read.
    InputError
        An unknown name; a time that the files do not cover, with the covered intervals next to it.
    """
    code = FRAMES.get(body.upper()) if isinstance(body, str) else body
    if code is None:
        names = ", ".join(FRAMES)
        raise refusal("body", body, names, f"= {body!r}: it must be the class ID of a frame, or one of {names}")
    seconds = epochs("times", times)[0] if hasattr(times, "tdb") else times
    attitudes, rates = _read_pck(path, int(code), np.atleast_1d(np.asarray(seconds, dtype=float)))
    return Samples.from_arrays(times, attitudes, rates)
