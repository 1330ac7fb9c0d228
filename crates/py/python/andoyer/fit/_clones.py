"""Clones of a tumbler from published values with their covariance."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Body, Ensemble
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.fit._given import covariances, finite, generator_of, whole_number

PERIODS = ("precession", "rotation")
POLE = ("longitude", "latitude")
PHASES = ("rotation_phase", "precession_phase")
MOMENTS = ("moment_1", "moment_2", "moment_3")
NAMES = (*PERIODS, *POLE, *PHASES, *MOMENTS)


def clones(
    body: Body,
    published: Mapping[str, float],
    covariance: ArrayLike,
    n: int,
    rng: Any = None,
    *,
    mode: Literal["short-axis", "long-axis"] = "short-axis",
    directions: ArrayLike | None = None,
    phases: ArrayLike | None = None,
    convention: Literal["extremal-axis", "long-axis", "short-axis"] = "extremal-axis",
    epoch: Any = None,
    threads: int | None = None,
    **options: Any,
) -> Ensemble:
    """Clones of a tumbler from published periods, pole, phases and moments, drawn from the normal distribution with their covariance.

    A draw that no body can have, for example periods that its moments exclude, is refused as a whole and not repeated: its member is NaN, and `Ensemble.errors` has the reason. So
    ``len(clones.errors)`` counts the refused draws. The draws of a fit have their own way: `Fit.ensemble`.

    Parameters
    ----------
    body : Body
        Its moments are those of all members, but for those in `published`.
    published : dict
        Values by name. "precession" and "rotation" are P_φ and P_ψ, in units of time; both are needed. "longitude" and "latitude" are those of the angular momentum, in rad; a drawn latitude beyond
        a quarter turn is on the other side of the pole. "rotation_phase" and "precession_phase" are the phases at the epoch, in turns; "moment_1", "moment_2" and "moment_3" the moments about
        the body axes.
    covariance : array_like, shape (k, k)
        Covariance of the k published values, in their order. Of standard deviations s and correlations C it is ``np.outer(s, s) * C``.
    n : int
        Number of draws.
    rng : int or numpy.random.Generator, optional
        A seed or a generator of random numbers.
    mode, convention, epoch, threads, **options
        As for `Ensemble.from_periods`.
    directions, phases : array_like, optional
        As for `Ensemble.from_periods`: of all members, or of each, where `published` does not have them.

    Returns
    -------
    Ensemble
        With ``errors="nan"``.

    Raises
    ------
    InputError
        An unknown name, a missing period, longitude without latitude, a phase without the other; a value that is not finite; a covariance of another shape, not finite, not symmetric or not
        positive definite; a latitude beyond π/2; an `n` below 0; a pole or phases given twice; moments of a body with axes of its own; a body with a gravity field.
    TypeError
        A `body` that is not a Body, a `published` that is not a dict, `errors`.

    Examples
    --------
    >>> import numpy as np
    >>> from andoyer import Body, fit
    >>> published = {"precession": 27.45, "rotation": 265.7, "longitude": 4.31, "latitude": -1.03}
    >>> deviations, correlations = np.array([0.07, 6.0, 0.24, 0.12]), np.eye(4)
    >>> correlations[0, 1] = correlations[1, 0] = 0.8
    >>> drawn = fit.clones(Body([0.729, 0.947, 1.0]), published, np.outer(deviations, deviations) * correlations, 1000, rng=1)
    >>> len(drawn), len(drawn.errors)
    (1000, 0)
    >>> periods = drawn.periods["extremal-axis"]
    >>> bool(abs(np.corrcoef(periods.precession, periods.rotation)[0, 1] - 0.8) < 0.03)
    True
    """
    if not isinstance(body, Body):
        raise TypeError(f"body must be an andoyer.Body, not {type(body).__name__}")
    if not isinstance(published, Mapping):
        raise TypeError(f"published must be a dict of values by name, not {type(published).__name__}")
    if "errors" in options:
        raise TypeError('errors is "nan" for clones: a draw that no body can have is refused and counted')
    count, generator = whole_number("n", n, 0), generator_of(rng)
    names = _names(published, {"directions": directions, "phases": phases})
    means = _means(published, names)
    matrix = covariances("covariance", covariance, (len(names), len(names)))
    _doubt(names, np.sqrt(np.diag(matrix)))
    draws = means + generator.standard_normal((count, len(names))) @ np.linalg.cholesky(matrix).T
    drawn = dict(zip(names, draws.T, strict=True))
    if POLE[0] in drawn:
        longitude, latitude = (drawn[name] for name in POLE)
        directions = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=1)
    if PHASES[0] in drawn:
        phases = np.stack([drawn[name] for name in PHASES], axis=1)
    return Ensemble.from_periods(
        _bodies(body, drawn),
        drawn[PERIODS[0]],
        drawn[PERIODS[1]],
        mode,
        directions,
        phases=phases,
        convention=convention,
        epoch=epoch,
        threads=threads,
        errors="nan",
        **options,
    )


def _doubt(names: tuple[str, ...], deviations: Array) -> None:
    """Warns of angles whose standard deviations are more than half a turn, which are probably in degrees."""
    for name, deviation in zip(names, deviations, strict=True):
        half, unit = (np.pi, "angles are in radians") if name in POLE else (0.5, "phases are in turns")
        if name in (*POLE, *PHASES) and deviation > half:
            warnings.warn(f"covariance: {name} has a standard deviation of {deviation:g}, more than half a turn: {unit}, not in degrees", stacklevel=3)


def _means(published: Mapping[str, float], names: tuple[str, ...]) -> Array:
    """The published values. A latitude beyond a quarter turn is refused; a longitude or a phase beyond a turn is doubted: both are probably in degrees."""
    means = finite("published", [published[name] for name in names])
    if means.shape != (len(names),):
        raise refusal("published", list(means.shape), "a number by each name", "has a value that is not a number")
    for name, value in zip(names, means, strict=True):
        if name == POLE[1] and abs(value) > np.pi / 2:
            raise refusal("published", float(value), [-np.pi / 2, np.pi / 2], f"latitude = {value:g}: it must be from -π/2 to π/2, in rad")
        turn, unit = (2 * np.pi, "longitudes are in radians") if name == POLE[0] else (1.0, "phases are in turns")
        if name in (POLE[0], *PHASES) and abs(value) > turn:
            warnings.warn(f"published {name} = {value:g} is more than a whole turn: {unit}, not in degrees", stacklevel=3)
    return means


def _names(published: Mapping[str, float], given: Mapping[str, Any]) -> tuple[str, ...]:
    """The names of the published values, in their order."""
    names = tuple(published)
    for name in names:
        if name not in NAMES:
            raise refusal("published", name, ", ".join(NAMES), f"has {name!r}: it must be of {', '.join(NAMES)}")
    for needed, together in ((True, PERIODS), (False, POLE), (False, PHASES)):
        present = [name for name in together if name in names]
        if len(present) < 2 and (needed or present):
            missing = next(name for name in together if name not in names)
            raise refusal("published", list(names), missing, f"has no {missing!r}: {' and '.join(together)} are needed together")
    for argument, together in (("directions", POLE), ("phases", PHASES)):
        if given[argument] is not None and together[0] in names:
            raise refusal(argument, together[0], None, f"and {' and '.join(together)} in published: give one of them")
    return names


def _bodies(body: Body, drawn: Mapping[str, Array]) -> Body | Array:
    """One body, or moments of each member."""
    if not any(name in drawn for name in MOMENTS):
        return body
    if not np.array_equal(body.principal_axes, np.eye(3)):
        raise refusal("body", "a tensor", "principal axes", "has axes of its own: moments can be drawn for a body whose axes are the principal ones")
    count = len(drawn[PERIODS[0]])
    return np.stack([drawn.get(name, np.full(count, moment)) for name, moment in zip(MOMENTS, body.moments, strict=True)], axis=1)
