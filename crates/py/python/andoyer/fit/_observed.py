"""The data of a light-curve fit, and the model of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._core import Scene
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.fit._curve import Curve, States
from andoyer.fit._facets import FacetAreas, Facets, one_thread
from andoyer.fit._given import from_epoch, from_first, shaped
from andoyer.fit._magnitudes import POGSON, Photometry, emitted
from andoyer.fit._magnitudes import photometry as photometry_of
from andoyer.fit._rotations import right_jacobian
from andoyer.fit._scattering import unit_vectors


@dataclass(frozen=True, eq=False)
class Data:
    """The data of a fit, and what leads back to them as they were given."""

    curve: Curve
    photometry: Photometry
    epoch: Any
    """A number, a Time for times of astropy, or None for durations, which count from the epoch of the scene."""
    times: Any
    labels: Array
    light: Array | None
    """Light times [s]."""


def data_of(
    dates: tuple[Any, Scene | None],
    measured: tuple[Any, Any, ArrayLike],
    seen: tuple[ArrayLike, ArrayLike],
    curves: ArrayLike | None,
    distances: ArrayLike | None,
) -> Data:
    at, epoch = from_first("times", *dates)
    count, light = len(at), None
    labels = np.zeros(count) if curves is None else shaped("curves", curves, (count,))
    photometry = photometry_of(*measured, labels)
    for argument, vectors in zip(("sun", "observer"), seen):
        shaped(argument, vectors, (3,), (count, 3))
    sun, observer = (np.atleast_2d(vectors).T for vectors in unit_vectors(*seen))
    if distances is not None:
        at, epoch, light = emitted("times", dates[0], at, epoch, distances)
    members = (labels[:, None] == np.unique(labels)).astype(float)
    curve = Curve(at, photometry.brightness, photometry.sigma**-2.0, sun, observer, members, "lommel-seeliger", False, photometry.zero is not None)
    return Data(curve, photometry, epoch, dates[0], labels, light)


@dataclass(frozen=True, eq=False)
class Seen:
    """The data with the model, as functions of steps from one state."""

    curve: Curve
    state: States

    @property
    def duration(self) -> float:
        """From the first to the last time."""
        return float(np.ptp(self.curve.times))

    def _moved(self, steps: Array) -> States:
        return self.curve.moved(States(*(np.repeat(array, len(steps), axis=0) for array in self.state)), steps)

    def chi_squares(self, steps: Array) -> Array:
        """χ² of steps in rows."""
        with one_thread(self.curve):
            return self.curve.chi_squares(self._moved(steps))

    def derivatives(self, steps: Array) -> tuple[Array, Array]:
        """Residuals (measured minus model) over σ of steps in rows, and their derivatives with respect to the steps."""
        there = self._moved(steps)
        with one_thread(self.curve):
            parts = self.curve.in_chunks(there, self.curve.residuals)
        residuals, slopes = (np.concatenate(arrays) for arrays in zip(*parts))
        jacobian = -np.swapaxes(slopes, 1, 2)
        jacobian[..., :3] = jacobian[..., :3] @ right_jacobian(steps[:, :3])
        jacobian[..., 3 : len(self.curve.columns) - 2 * self.curve.shape] *= (np.linalg.norm(self.state.rates) / np.linalg.norm(there.rates, axis=1))[
            :, None, None
        ]
        return residuals, jacobian


LONG = 10
"""A step of more than so many median steps is a gap between nights."""
SHORTEST = 6 * 3600.0
"""And more than so many seconds, where the times have units."""
PER_TURN, FEWEST, MOST = 32, 200, 4000
"""Times of the model for each turn of the body, and the fewest and most of a night; a night with more turns has the model at its points alone."""


class Night(NamedTuple):
    """The points of a night and the model, as given, in order of time."""

    label: float
    """Of the curve."""
    first: int
    """The place of the first point among the data."""
    since: Array
    """Times since the first point, in the unit of the data."""
    measured: Array
    sigma: Array
    residuals: Array
    fine: Array
    """Times of the model since the first point."""
    model: Array


@dataclass(frozen=True, eq=False)
class Light:
    """The model of the brightness at any times."""

    data: Data
    seen: Seen

    def at(self, times: Any, sun: ArrayLike | None, observer: ArrayLike | None, label: Any) -> Array:
        """Magnitudes or intensities as of the data, at their times (None) or at others."""
        curve, state = self.data.curve, self.seen.state
        self._place(label)
        if times is None:
            value, factors, _, _ = curve.model(state)
            return self.data.photometry.as_given((factors @ curve.members.T) * value)
        at = np.atleast_1d(from_epoch("times", times, self.data.epoch, 0.0 if hasattr(self.data.epoch, "jd1") else float(self.data.epoch)))
        if at.ndim != 1 or not at.size:
            raise refusal("times", at.shape, "(n,)", f"has shape {at.shape}: it must be (n,) with n above 0")
        if not np.isfinite(at).all():
            place = int(np.flatnonzero(~np.isfinite(at))[0])
            raise refusal(f"times[{place}]", float(at[place]), "finite", f"= {at[place]}: it must be finite")
        return self._since(at, sun, observer, label)

    @property
    def facets(self) -> FacetAreas | None:
        """The facets of the state, where they are fitted."""
        curve = self.data.curve
        with one_thread(curve):
            return curve.facets(self.seen.state) if isinstance(curve, Facets) else None

    def nights(self, count: int, units: bool) -> tuple[list[Night], int]:
        """The first nights, at most so many, and the number of all. `units`: the times are in seconds."""
        curve, photometry = self.data.curve, self.data.photometry
        measured, model = photometry.given, self.at(None, None, None, None)
        sigma = photometry.sigma if photometry.zero is None else POGSON * photometry.sigma
        parts = []
        for label in np.unique(self.data.labels):
            points = np.flatnonzero(self.data.labels == label)
            points = points[np.argsort(curve.times[points], kind="stable")]
            parts += [(label, part) for part in np.split(points, 1 + np.flatnonzero(gaps(curve.times[points], SHORTEST if units else 0.0)))]
        parts.sort(key=lambda part: float(curve.times[part[1][0]]))
        found = []
        for label, part in parts[:count]:
            at = curve.times[part]
            wanted = PER_TURN * np.ptp(at) * float(np.linalg.norm(self.seen.state.rates)) / (2 * np.pi)
            fine = at if wanted > MOST or len(at) == 1 else np.linspace(at[0], at[-1], max(FEWEST, int(wanted)))
            found.append(
                Night(
                    label=float(label),
                    first=int(part[0]),
                    since=at - at[0],
                    measured=measured[part],
                    sigma=sigma[part],
                    residuals=(measured - model)[part],
                    fine=fine - at[0],
                    model=self._since(fine, None, None, label),
                )
            )
        return found, len(parts)

    def _place(self, label: Any) -> int:
        """The number of a curve, by default the first."""
        labels = np.unique(self.data.labels)
        places = np.flatnonzero(labels == label) if label is not None else np.array([0])
        if len(places) != 1:
            raise refusal("curve", label, labels.tolist(), f"= {label!r}: it must be one of {labels.tolist()}")
        return int(places[0])

    def _since(self, at: Array, sun: ArrayLike | None, observer: ArrayLike | None, label: Any) -> Array:
        """The model at times since the epoch."""
        curve, state = self.data.curve, self.seen.state
        _, factors, _, _ = curve.model(state)
        labels, place = np.unique(self.data.labels), self._place(label)
        order = np.argsort(curve.times, kind="stable")
        inside = (at >= curve.times.min()) & (at <= curve.times.max())
        sides = []
        for argument, given, own in (("sun", sun, curve.sun), ("observer", observer, curve.observer)):
            if given is not None:
                vectors = np.broadcast_to(shaped(argument, given, (3,), (len(at), 3)), (len(at), 3))
            elif own.shape[1] == 1:
                vectors = np.broadcast_to(own.T, (len(at), 3))
            elif not inside.all():
                raise refusal(argument, None, "directions", "must be given for times outside the data")
            else:
                vectors = np.stack([np.interp(at, curve.times[order], axis[order]) for axis in own], axis=1)
            sides.append(vectors)
        directions = [vectors.T for vectors in unit_vectors(*sides)]
        with one_thread(curve):
            seen = curve.elsewhere(state, at, directions[0], directions[1])
        zero = self.data.photometry.zero
        photometry = Photometry(seen, seen, None if zero is None else np.full(len(at), zero[self.data.labels == labels[place]][0]))
        return photometry.as_given(factors[place] * seen)


def gaps(times: Array, shortest: float = 0.0) -> NDArray[np.bool_]:
    """Of each step between ordered times, whether it is a gap between nights."""
    steps = np.diff(times)
    long: NDArray[np.bool_] = steps > max(LONG * float(np.median(steps)) if len(steps) else 0.0, shortest)
    return long


def confused(curve: Curve) -> Array:
    """Shifts of the frequency of rotation, which is half that of the brightness, that the gaps between nights confuse: ±½ and ±1 cycle a gap."""
    times = np.sort(curve.times)
    long = gaps(times)
    if not long.any():
        return np.zeros(0)
    starts = times[np.concatenate([[True], long])]
    gap = float(np.min(np.diff(starts)))
    return np.array([-1.0, -0.5, 0.5, 1.0]) / gap
