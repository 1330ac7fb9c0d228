"""`light_curve`: a state from brightnesses."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._core import Body, Ensemble, Scene
from andoyer._extra import extra
from andoyer._quaternions import Array, angle_between, product
from andoyer._refusal import refusal
from andoyer.fit._curve import Curve, States
from andoyer.fit._given import enough, from_first, generator_of, moderate, scene_of, shaped, span, whole_number
from andoyer.fit._message import composed, largest_reduced, rivals
from andoyer.fit._optimum import Optimum
from andoyer.fit._result import Fit, judged
from andoyer.fit._rotations import right_jacobian
from andoyer.fit._scattering import axes_of, law, unit_vectors
from andoyer.fit._search import Population, best, improve, moved, random_states, reflections, search
from andoyer.fit._steps import LABELS, Steps, moments_of_ellipsoid
from andoyer.interop._foreign import epoch_of

POLISHED = 32
"""States that are improved to the end, of either mode half."""
SETTLING = 60
"""Steps of them all before each is polished alone."""
SAME = 0.02
"""Largest angle [rad], at three times of the data, between attitudes of one optimum."""


def light_curve(
    axes: ArrayLike,
    times: Any,
    brightness: ArrayLike,
    *,
    sun: ArrayLike,
    observer: ArrayLike,
    sigma: ArrayLike,
    periods: Any = None,
    curves: ArrayLike | None = None,
    scattering: str = "lommel-seeliger",
    shape: bool = False,
    scene: Scene | None = None,
    starts: int = 100_000,
    delta_chi_square: float = np.inf,
    rng: Any = 0,
) -> Fit:
    """Fits the state of a homogeneous ellipsoid to its brightnesses, from many random starts.

    The starts have random directions of the angular momentum in space and in the body, half of them in each mode, and precession frequencies between those of `periods`. All starts are
    evaluated. The best of each mode are improved together by Levenberg and Marquardt's method with the derivatives of `Ensemble.partials` (theory §12), in rounds with fewer and fewer states.
    `scipy.optimize.least_squares` improves the last few. Reflections of these minima, which can look nearly the same, are starts too. The fit includes a brightness factor for each curve. Half turns about the body axes do not change the brightness; one of the four
    equivalent states is returned. The function needs SciPy, which ``pip install scipy`` installs.

    Parameters
    ----------
    axes : array_like, shape (3,)
        Semi-axes along body axes 1, 2, 3; only their ratios matter.
    times : array_like, shape (n,)
        Times, in the unit of `periods`; for a Time, a TimeDelta or a Quantity of astropy the unit is the second. The first time is the epoch of the fitted scene. A TimeDelta counts from the
        epoch of `scene`, or from 0 without it; the first one must be 0.
    brightness : array_like, shape (n,)
        Brightnesses as intensities, each in the unit of its curve; magnitudes m are converted by ``10**(-0.4*m)``.
    sun, observer : array_like, shape (3,) or (n, 3)
        Directions from the body to the Sun and the observer, inertial components.
    sigma : float or array_like, shape (n,)
        Standard deviations of the brightnesses.
    periods : (float, float)
        The shortest and the longest mean precession period P_φ of the starts, in the convention "extremal-axis" of `Motion.periods`; also a Quantity of astropy. Not needed with
        `scene`.
    curves : array_like of int, shape (n,), optional
        Number of the curve of each point, 0, 1, …; by default all points belong to one curve.
    scattering : {"lommel-seeliger", "geometric"}, optional
        Law of scattering, as for `brightness`.
    shape : bool, optional
        If True, the axis ratios b/a and c/a are fitted too.
    scene : Scene, optional
        A torque-free first state that rotates, instead of random states; its moments are replaced by those of the ellipsoid. The fit finds the minimum next to it, and no rival minima.
    starts : int, optional
        Number of random starts.
    delta_chi_square : float, optional
        Largest difference of χ² from the least χ² in `Fit.optima`, 0 or more; by default all minima are listed.
    rng : int or numpy.random.Generator, optional
        A seed or a generator of the starts.

    Returns
    -------
    Fit
        The fit; `Fit.optima` has the mode and χ² of every minimum, the best first.

    Raises
    ------
    InputError
        Fewer points than parameters; a semi-axis, a brightness or a `sigma` that is not from 1e-40 to 1e40; no start with a motion over the times; a shortest period above the longest; a direction of length 0; Sun and observer on opposite sides; a first
        TimeDelta other than 0; a `scene` with an orbit or at rest.

    Warns
    -----
    UserWarning
        The fit is bad and the brightnesses, all below 30, can be magnitudes.

    Examples
    --------
    An ellipsoid that rotates about its short axis, at a phase angle of 30°:

    >>> import numpy as np
    >>> from andoyer import Body, Scene, fit
    >>> axes, times = [1.0, 0.7, 0.5], np.linspace(0, 3, 60)
    >>> scene = Scene(Body.ellipsoid(*axes), [0, 0, 0, 1], [0.3, 0.1, 6.0])
    >>> sun, observer = [np.cos(np.pi / 6), np.sin(np.pi / 6), 0], [1, 0, 0]
    >>> measured = fit.brightness(axes, scene.solve().attitude(times), sun, observer)
    >>> guess = Scene(scene.body, [0.01, 0, 0, 0.99995], [0.3, 0.1, 6.02])
    >>> found = fit.light_curve(axes, times, measured, sun=sun, observer=observer, sigma=0.01, scene=guess)
    >>> found.scene.angular_velocity.round(6)
    array([0.3, 0.1, 6. ])
    """
    extra("scipy.optimize", "andoyer.fit")
    semi_axes = axes_of(axes)
    law(scattering)
    if not isinstance(shape, (bool, np.bool_)):
        raise refusal("shape", repr(shape), "True or False", f"= {shape!r}: it must be True or False")
    largest = _difference(delta_chi_square)
    curve, epoch = _curve((times, scene), brightness, (sun, observer), sigma, curves, (scattering, shape))
    enough(len(curve.times), 6 + 2 * shape + curve.members.shape[1], "times", "give more points")
    if epoch is None:
        epoch = 0.0 if scene is None else epoch_of(scene_of(scene))
    # A start that runs to a shape without a body has an infinite χ², and the search passes it over.
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        if scene is not None:
            first = _state_of(scene_of(scene), semi_axes, epoch)
            population = improve(curve, Population(first, curve.chi_squares(first)), SETTLING)
        else:
            drawn = random_states(semi_axes, _range(periods), whole_number("starts", starts, 1), generator_of(rng))
            population = search(curve, drawn)
            population = improve(curve, best(_distinct(curve, population), POLISHED), SETTLING)
        population = _polished(curve, population)
        if scene is None:
            population = _with_reflections(curve, population)
    return _result(curve, population, epoch, times, largest)


def _curve(
    dates: tuple[Any, Scene | None],
    brightness: ArrayLike,
    seen: tuple[ArrayLike, ArrayLike],
    sigma: ArrayLike,
    curves: ArrayLike | None,
    model: tuple[str, bool],
) -> tuple[Curve, Any]:
    """The data, and the epoch: a number, a Time for times of astropy, or None for durations, which count from the epoch of the scene."""
    at, epoch = from_first("times", *dates)
    count = len(at)
    values = shaped("brightness", brightness, (count,))
    if not np.all(values > 0):
        worst = float(values.min())
        raise refusal("brightness", worst, "above 0", f"= {worst}: an intensity is above 0; for magnitudes m give the intensities 10**(-0.4*m)")
    values = moderate("brightness", values, (count,))
    deviations = np.broadcast_to(moderate("sigma", sigma, (), (count,)), (count,))
    for argument, vectors in zip(("sun", "observer"), seen):
        shaped(argument, vectors, (3,), (count, 3))
    sun, observer = (np.atleast_2d(vectors).T for vectors in unit_vectors(*seen))
    labels = np.zeros(count) if curves is None else shaped("curves", curves, (count,))
    members = (labels[:, None] == np.unique(labels)).astype(float)
    return Curve(at, values, deviations**-2.0, sun, observer, members, *model), epoch


def _range(periods: Any) -> tuple[float, float]:
    if periods is None:
        raise refusal("periods", None, "(shortest, longest)", "is missing: give the shortest and the longest precession period, or a scene to begin from")
    shortest, longest = span("periods", periods)
    if not shortest <= longest:
        raise refusal("periods", (float(shortest), float(longest)), "(shortest, longest)", f"= ({shortest}, {longest}): the first must not exceed the second")
    return float(shortest), float(longest)


def _difference(delta_chi_square: Any) -> float:
    if np.ndim(delta_chi_square) == 0 and delta_chi_square == np.inf:
        return np.inf
    difference = float(shaped("delta_chi_square", delta_chi_square, ()))
    if difference < 0:
        raise refusal("delta_chi_square", difference, 0.0, f"= {difference}: it must be 0 or more")
    return difference


def _state_of(scene: Scene, axes: Array, epoch: Any) -> States:
    """The state of a scene at the epoch."""
    if scene.orbit is not None:
        raise refusal("scene", "orbit", "none", "has an orbit: light curves are fitted without torques")
    if not np.any(scene.angular_velocity):
        raise refusal("scene", "at rest", "a rotation", "is at rest: give a state that rotates")
    sample = scene.solve().at(epoch)
    return States(axes[None].copy(), sample.attitude[None], sample.angular_velocity[None])


ADVICE = (
    "Try more starts, other periods, shape=True, curves with their own factors or the other law of scattering; check sigma, the directions, "
    "and that the brightnesses are intensities, not magnitudes."
)
BRIGHTEST, FAINTEST = 3.0, 30.0
"""Numbers between them are read as magnitudes. Relative intensities are smaller."""

HALF_TURNS = np.array([[0, 0, 0, 1.0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])
"""Turns of the body that leave the ellipsoid as it is."""


def _sorting(axes: Array) -> Array:
    """Turns of the body axes that put the semi-axes in descending order, shape (m, 4): a fit of the shape can find the same ellipsoid with its axes in any order."""
    columns = np.swapaxes(np.eye(3)[np.argsort(-axes, axis=1, kind="stable")], 1, 2)
    columns[:, :, 2] *= np.linalg.det(columns)[:, None]
    rotation = extra("scipy.spatial.transform", "andoyer.fit").Rotation
    turns: Array = rotation.from_matrix(columns).as_quat()
    return turns


def _distinct(curve: Curve, population: Population) -> Population:
    """The best of all states that show the same attitudes."""
    chosen = _different(curve, population)
    return Population(population.states.part(chosen), population.chi_squares[chosen])


def _different(curve: Curve, population: Population) -> NDArray[np.intp]:
    """Indices of distinct states, the best first: of states whose sorted axes have the same attitudes up to half turns of the body, the best alone."""
    order = np.argsort(population.chi_squares, kind="stable")
    states = population.states.part(order)
    times = curve.times[[0, len(curve.times) // 2, -1]]
    moments = moments_of_ellipsoid(states.axes)
    motions = Ensemble(moments, states.attitudes, states.rates, tolerance=1e-6, span=(times.min(), times.max()), errors="nan")
    attitudes = product(motions.attitude(times), _sorting(states.axes)[:, None])
    kept: list[int] = []
    for place, attitude in enumerate(attitudes):
        turned = product(attitude[None], HALF_TURNS[:, None, :])
        apart = angle_between(attitudes[kept][:, None], turned[None]).max(axis=-1).min(axis=-1, initial=np.inf)
        if np.isfinite(attitude).all() and not np.any(apart < SAME):
            kept.append(place)
    places: NDArray[np.intp] = order[kept]
    return places


def _with_reflections(curve: Curve, minima: Population) -> Population:
    """Minima together with those to which their reflections lead, the best first."""
    mirrored = reflections(curve, minima.states)
    found = improve(curve, Population(mirrored, curve.chi_squares(mirrored)), SETTLING)
    places = _different(curve, _joined(minima, found))[:POLISHED]
    new = places[places >= len(minima.chi_squares)] - len(minima.chi_squares)
    if not len(new):
        return minima
    polished = _polished(curve, Population(found.states.part(new), found.chi_squares[new]))
    kept = best(_distinct(curve, _joined(minima, polished)), POLISHED)
    order = np.argsort(kept.chi_squares, kind="stable")
    return Population(kept.states.part(order), kept.chi_squares[order])


def _joined(first: Population, second: Population) -> Population:
    states = States(*(np.concatenate(arrays) for arrays in zip(first.states, second.states)))
    return Population(states, np.concatenate([first.chi_squares, second.chi_squares]))


def _polished(curve: Curve, population: Population) -> Population:
    """Each state improved alone by SciPy, and those that are the same left out."""
    optimize = extra("scipy.optimize", "andoyer.fit")
    found = []
    for place in range(len(population.chi_squares)):
        state = population.states.part(slice(place, place + 1))
        first = np.zeros(6 + 2 * curve.shape)
        if not np.all(np.isfinite(curve.residuals(state)[1])):
            continue
        solution = optimize.least_squares(_residuals, first, _jacobian, args=(curve, state), method="trf", xtol=1e-12, ftol=1e-12, gtol=1e-15)
        found.append((moved(state, solution.x[None]), 2 * solution.cost))
    if not found:
        last = float(curve.times[-1])
        raise refusal("times", last, "within the reach of a motion", f"[-1] is {last} after the first: no start has a motion and a finite χ² up to there")
    states = States(*(np.concatenate(arrays) for arrays in zip(*(state for state, _ in found))))
    return _distinct(curve, Population(states, np.array([chi_square for _, chi_square in found])))


def _residuals(step: Array, curve: Curve, state: States) -> Array:
    residuals, _ = curve.residuals(moved(state, step[None]))
    finite: Array = np.nan_to_num(residuals[0], nan=np.inf)
    return finite


def _jacobian(step: Array, curve: Curve, state: States) -> Array:
    """Derivatives of the residuals (measured minus model) with respect to a step from `state`."""
    jacobian: Array = Seen(curve, state).derivatives(step[None])[1][0]
    return jacobian


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
        return moved(States(*(np.repeat(array, len(steps), axis=0) for array in self.state)), steps)

    def chi_squares(self, steps: Array) -> Array:
        """χ² of steps in rows."""
        return self.curve.chi_squares(self._moved(steps))

    def derivatives(self, steps: Array) -> tuple[Array, Array]:
        """Residuals (measured minus model) over σ of steps in rows, and their derivatives with respect to the steps."""
        there = self._moved(steps)
        parts = self.curve.in_chunks(there, self.curve.residuals)
        residuals, slopes = (np.concatenate(arrays) for arrays in zip(*parts))
        jacobian = -np.swapaxes(slopes, 1, 2)
        jacobian[..., :3] = jacobian[..., :3] @ right_jacobian(steps[:, :3])
        jacobian[..., 3:6] *= (np.linalg.norm(self.state.rates) / np.linalg.norm(there.rates, axis=1))[:, None, None]
        return residuals, jacobian


def _result(curve: Curve, population: Population, epoch: Any, times: Any, delta_chi_square: float) -> Fit:
    minima = [_optimum(population.states.part(slice(place, place + 1)), float(chi_square), epoch) for place, chi_square in enumerate(population.chi_squares)]
    best = minima[0]
    optima = tuple(minimum for minimum in minima if minimum.chi_square <= best.chi_square + delta_chi_square)
    state = population.states.part(slice(0, 1))
    model = Seen(curve, state)
    residuals, jacobian = (array[0] for array in model.derivatives(np.zeros((1, 6 + 2 * curve.shape))))
    names = tuple(name for name in LABELS if name in ("attitude", "angular_velocity") or (name == "shape" and curve.shape))
    steps = Steps(best.scene, names, state.axes[0])
    covariance, lost, sentence = judged(steps, np.zeros(jacobian.shape[1]), jacobian)
    degrees = len(curve.times) - curve.members.shape[1] - (jacobian.shape[1] - len(lost))
    message = composed(best.chi_square, degrees, ADVICE, sentence, rivals(minima, model.duration))
    _warn_of_magnitudes(curve.brightness, best.chi_square, degrees)
    measured = residuals / np.sqrt(curve.weights)
    return Fit(best.scene, steps.labels, covariance, lost, measured, best.chi_square, degrees, message, times, steps, model, optima, state.axes[0])


def _warn_of_magnitudes(brightness: Array, chi_square: float, degrees: int) -> None:
    """Warns where the fit is bad and the brightnesses can be magnitudes. Without degrees of freedom no fit is bad; then numbers that relative intensities seldom have are enough."""
    least, most = float(brightness.min()), float(brightness.max())
    bad = degrees > 0 and chi_square / degrees > largest_reduced(degrees)
    if most <= FAINTEST and (bad or (degrees <= 0 and least >= BRIGHTEST)):
        warnings.warn(
            f"the brightnesses lie between {least:.3g} and {most:.3g}{', and the fit is bad' if bad else ''}: if they are magnitudes m, give the intensities 10**(-0.4*m) "
            "with the standard deviations 0.921*intensity*sigma",
            stacklevel=4,
        )


def _optimum(state: States, chi_square: float, epoch: Any) -> Optimum:
    body = Body(moments_of_ellipsoid(state.axes)[0])
    scene = Scene(body, state.attitudes[0], state.rates[0], epoch=epoch)
    return Optimum(scene, scene.solve().plan.mode, chi_square)
