"""Mean frequencies and periods of a motion, as named tuples."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Frequencies(NamedTuple):
    """Mean frequencies of a motion, in rad per unit of time; 0 if the frequency does not exist (theory §7)."""

    anomaly: float
    """dℓ′/dt: the polhode, in the body."""

    longitude: float
    """dy′/dt: the rotation, y = μ + ν; y = μ − ν for N < 0."""


class Periods(NamedTuple):
    """A pair of mean periods, in units of time; infinite if the period does not exist."""

    precession: float
    """P_φ, of the precession of the axis about the angular momentum."""

    rotation: float
    """P_ψ, of the rotation or oscillation about the axis."""


class PeriodsOfMembers(NamedTuple):
    """Mean periods of the members of an ensemble, arrays of shape (m,), in units of time; infinite where there is none."""

    precession: NDArray[np.float64]
    """P_φ, of the precession of the axis about the angular momentum."""

    rotation: NDArray[np.float64]
    """P_ψ, of the rotation or oscillation about the axis."""
