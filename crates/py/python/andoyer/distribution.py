"""How the members of an ensemble tumble at one time.

>>> import andoyer
>>> bodies, level = [[1, 1.5, 2]] * 3, [0, 0, 0, 1]
>>> braked = andoyer.Ensemble(bodies, level, [[0.1, 0.2, 1], [0.5, 0.9, 0.2], [1, 0.2, 0.1]], torques=andoyer.Torque.damping(0.02), span=(0, 40), tolerance=1e-9)
>>> later = braked.after(40.0)
>>> later.share()
{'short-axis': 0.6666666666666666, 'long-axis': 0.3333333333333333}
>>> bool(later.quantiles(0.5)["momentum"] < 1.5)
True
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._extra import extra
from andoyer.mean import PeriodsOfMembers

if TYPE_CHECKING:
    from andoyer._core import Error

__all__ = ["Distribution"]

Convention = Literal["long-axis", "short-axis", "extremal-axis"]


@dataclass(frozen=True, eq=False)
class Distribution:
    """The free motions from the states of all members at one time, of `Ensemble.after`.

    Attributes
    ----------
    time : float or astropy.time.Time
        As given.
    mode : ndarray of str, shape (m,)
        Modes, as `Plan.mode`; "" for a member that has no motion at the time, whose numbers are NaN.
    changed : ndarray of bool, shape (m,)
        Whether the mode is another one than that of the state at the epoch.
    periods : dict
        Named tuples (precession, rotation) of arrays, shape (m,), by convention, as `Ensemble.periods`.
    energy_ratio : ndarray, shape (m,)
        E/E0, as `Ensemble.energy_ratio`.
    angular_momentum : ndarray, shape (m, 3)
        In inertial components, in the unit of moment × rate.
    errors : dict of Error
        Why members have no motion at the time, by index; with ``errors="nan"`` of the ensemble only.
    """

    time: Any
    mode: NDArray[np.str_]
    changed: NDArray[np.bool_]
    periods: Mapping[Convention, PeriodsOfMembers]
    energy_ratio: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]
    errors: Mapping[int, Error]

    @property
    def momentum(self) -> NDArray[np.float64]:
        """The magnitudes of the angular momenta, shape (m,)."""
        return np.asarray(np.linalg.norm(self.angular_momentum, axis=1))

    @property
    def direction(self) -> NDArray[np.float64]:
        """The directions of the angular momenta, inertial unit vectors, shape (m, 3); NaN for a body at rest."""
        with np.errstate(invalid="ignore"):
            return self.angular_momentum / self.momentum[:, None]

    def share(self) -> dict[str, float]:
        """The share of the members in each mode, the largest first. Members without a motion are not counted."""
        modes, counts = np.unique(self.mode[self.mode != ""], return_counts=True)
        order = np.argsort(-counts, kind="stable")
        return {str(modes[k]): float(counts[k] / counts.sum()) for k in order}

    def quantiles(self, q: ArrayLike) -> dict[str, NDArray[np.float64]]:
        """The quantiles of the magnitudes of the angular momenta, of E/E0 and of the periods (precession, rotation) in the extremal-axis convention.

        Parameters
        ----------
        q : float or array_like
            From 0 to 1.

        Returns
        -------
        dict of ndarray, of the shape of q
            "momentum", "energy_ratio", "precession", "rotation". Members without a motion are not counted; NaN if there are no others. Infinite periods are the largest.
        """
        periods = self.periods["extremal-axis"]
        columns: dict[str, NDArray[np.float64]] = {
            "momentum": self.momentum,
            "energy_ratio": self.energy_ratio,
            "precession": periods.precession,
            "rotation": periods.rotation,
        }
        solved = self.mode != ""
        if not solved.any():
            return {name: np.full(np.shape(q), np.nan) for name in columns}
        # The method takes members, and so never subtracts two infinite periods.
        parts = np.asarray(q, dtype=float)
        return {name: np.asarray(np.quantile(column[solved], parts, method="inverted_cdf")) for name, column in columns.items()}

    def to_pandas(self) -> Any:
        """A pandas DataFrame with a row for each member. This method imports pandas.

        Raises
        ------
        ImportError
            pandas is not installed; ``pip install pandas`` installs it.
        """
        return extra("pandas", "Distribution.to_pandas").DataFrame(self._columns())

    def _columns(self) -> dict[str, Any]:
        columns: dict[str, Any] = {"mode": self.mode, "changed": self.changed, "energy_ratio": self.energy_ratio, "momentum": self.momentum}
        columns |= {f"direction_{axis}": self.direction[:, axis - 1] for axis in (1, 2, 3)}
        for convention, pair in self.periods.items():
            name = convention.replace("-axis", "_axis")
            columns |= {f"precession_{name}": pair.precession, f"rotation_{name}": pair.rotation}
        return columns

    def __len__(self) -> int:
        return len(self.mode)

    def __repr__(self) -> str:
        said = [f"{mode} {100 * part:.1f} %" for mode, part in self.share().items()]
        unknown = int(np.sum(self.mode == ""))
        said += [f"{unknown} without a motion"] * (unknown > 0)
        return f"<Distribution of {len(self)} members at {self.time}: {', '.join(said)}; {int(self.changed.sum())} changed their mode>"
