"""`light_curve`: a state from brightnesses."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._core import Body, Ensemble, Scene
from andoyer._extra import extra
from andoyer._quaternions import Array, angle_between, product
from andoyer._refusal import refusal
from andoyer.fit._curve import Curve, States
from andoyer.fit._facets import one_thread, with_facets
from andoyer.fit._given import enough, generator_of, scene_of, shaped, span, whole_number
from andoyer.fit._magnitudes import POGSON, ZeroPoints
from andoyer.fit._message import composed, largest_reduced, rivals
from andoyer.fit._observed import Data, Light, Seen, confused, data_of, gaps
from andoyer.fit._optimum import HALF_TURN, Optimum
from andoyer.fit._other_shape import other_shapes
from andoyer.fit._result import Fit, Photometric, judged
from andoyer.fit._scattering import axes_of, law
from andoyer.fit._search import Population, at_other_rates, best, improve, random_spins, random_states, reflections, search
from andoyer.fit._spectrum import frequencies_of, from_spectrum, of_one_period, refined, together
from andoyer.fit._steps import Steps, moments_of_ellipsoid
from andoyer.fit._summary import described
from andoyer.fit._verdict import REACHED, Evidence, judge, scale, simple_rotation
from andoyer.interop._foreign import as_one, epoch_of, has_units

POLISHED = 32
"""States that are improved to the end, of either mode half."""
SETTLING = 60
"""Steps of them all before each is polished alone."""
FAR = 4.0
"""Minima whose χ² is more than so many times the least stay as the steps together leave them."""
FEW = 2000
"""Least number of starts of the hypothesis of simple rotation."""
WOBBLE = 1e-3
"""Rates across the axis, in parts of the rotation, with which a simple rotation becomes the start of a tumbling motion."""
HYPOTHESES = 4
"""Simple rotations that are improved to the end beside a tumbling motion."""
PRINCIPAL = "principal-axis"
FACETS = "facets"
SAME = 0.02
"""Largest angle [rad], at three times of the data, between attitudes of one optimum."""


def light_curve(
    axes: ArrayLike,
    times: Any,
    brightness: ArrayLike | None = None,
    *,
    magnitudes: ArrayLike | None = None,
    sun: ArrayLike,
    observer: ArrayLike,
    sigma: ArrayLike,
    periods: Any = None,
    curves: ArrayLike | None = None,
    distances: ArrayLike | None = None,
    scattering: str = "lommel-seeliger",
    shape: bool | str = False,
    mode: str | None = None,
    scene: Scene | None = None,
    starts: int = 100_000,
    delta_chi_square: float = np.inf,
    scale_errors: bool = False,
    rng: Any = 0,
) -> Fit:
    """Fits the state of a homogeneous ellipsoid to its brightnesses, from many starts.

    Some starts have the pairs of periods with which a Fourier series in two angles fits the data best, and random angles. The others have random directions of the angular momentum in space and in the body, half of them in each mode, and precession frequencies between those of `periods`. All starts are
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
    brightness : array_like, shape (n,), optional
        Brightnesses as intensities, each in the unit of its curve; or instead
    magnitudes : array_like, shape (n,), optional
        Magnitudes, each with the zero point of its curve, which comes back in `Fit.zero_points`.
    sun, observer : array_like, shape (3,) or (n, 3)
        Directions from the body to the Sun and the observer, inertial components.
    sigma : float or array_like, shape (n,)
        Standard deviations of the brightnesses, or of the magnitudes.
    periods : (float, float)
        The shortest and the longest mean precession period P_φ of the starts, in the convention "extremal-axis" of `Motion.periods`; also a Quantity of astropy. With
        ``mode="principal-axis"`` of the period of rotation. Not needed with `scene`.
    curves : array_like of int, shape (n,), optional
        Number of the curve of each point, 0, 1, …; by default all points belong to one curve. Absolute magnitudes of several nights are one curve; relative ones are a curve for each night.
    distances : array_like, shape () or (n,), optional
        Distances of the observer from the body: numbers in au, or a Quantity of astropy. The light time is then taken from `times`, which must be a Time or a Quantity. The brightnesses are not
        changed: curves that last longer than a night are reduced to unit distances, by −5 lg(rΔ) in magnitudes.
    scattering : {"lommel-seeliger", "geometric"}, optional
        Law of scattering, as for `brightness`.
    shape : bool or "facets", optional
        If True, the axis ratios b/a and c/a are fitted too. With "facets" the body, as those in nature, may also differ from the ellipsoid: each of 42 facets gets an area of its own (`Fit.facets`). Their deviations from
        those of the ellipsoid have the prior deviation 50 %, which is a part of χ². Logarithms of the brightness are then fitted. Needs ``scattering="lommel-seeliger"``
        and threadpoolctl, which ``pip install threadpoolctl`` installs: NumPy's BLAS gets one thread meanwhile.
    mode : {None, "principal-axis"}, optional
        "principal-axis" holds the body in rotation about its axis of greatest inertia: period, pole and phase are fitted. By default any motion is fitted, and simple rotation too, as a
        hypothesis beside it: `Fit.simple_rotation`.
    scene : Scene, optional
        A torque-free first state that rotates, instead of random states; its moments are replaced by those of the ellipsoid. The fit finds the minimum next to it, and no rival minima.
    starts : int, optional
        Number of random starts, beside those from the spectrum of the data.
    delta_chi_square : float, optional
        Largest difference of χ² from the least χ² in `Fit.optima`, 0 or more; by default all minima are listed.
    scale_errors : bool, optional
        If True, a reduced χ² above 1 multiplies the covariance: the errors of the data are then taken as too small by one factor.
    rng : int or numpy.random.Generator, optional
        A seed or a generator of the starts.

    Returns
    -------
    Fit
        The fit; `Fit.optima` has the mode and χ² of every minimum, the best first, and `Fit.verdict` says what the data determine.

    Raises
    ------
    InputError
        Fewer points than parameters; a semi-axis, a brightness or a `sigma` that is not from 1e-40 to 1e40; no start with a motion over the times; a shortest period above the longest; a direction of length 0; Sun and observer on opposite sides; a first
        TimeDelta other than 0; a `scene` with an orbit or at rest; both brightness and magnitudes, or neither; distances with times that have no unit; another mode or shape; facets with another law of scattering, or with an
        intensity below ten times its `sigma`.

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
    if not isinstance(scale_errors, (bool, np.bool_)):
        raise refusal("scale_errors", repr(scale_errors), "True or False", f"= {scale_errors!r}: it must be True or False")
    faceted = isinstance(shape, str) and shape == FACETS
    if not (faceted or isinstance(shape, (bool, np.bool_))):
        raise refusal("shape", repr(shape), f"True, False or {FACETS!r}", f"= {shape!r}: it must be True, False or {FACETS!r}")
    if faceted and scattering != "lommel-seeliger":
        raise refusal("shape", FACETS, "lommel-seeliger", f"= {FACETS!r} needs the scattering 'lommel-seeliger', not {scattering!r}")
    if mode not in (None, PRINCIPAL):
        raise refusal("mode", mode, PRINCIPAL, f"= {mode!r}: it must be None or {PRINCIPAL!r}")
    largest = _difference(delta_chi_square)
    data = data_of((times, scene), (brightness, magnitudes, sigma), (sun, observer), curves, distances)
    curve = replace(data.curve, scattering=scattering, shape=bool(shape), spin=int(np.argmax(moments_of_ellipsoid(semi_axes))) if mode else None)
    if faceted:
        curve = with_facets(curve)
    enough(len(curve.times), len(curve.columns) + curve.members.shape[1], "times", "give more points")
    if data.epoch is None:
        data = replace(data, epoch=0.0 if scene is None else epoch_of(scene_of(scene)))
    data = replace(data, curve=curve)
    # A start that runs to a shape without a body has an infinite χ², and the search passes it over.
    with one_thread(curve), np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        if scene is not None:
            first = _state_of(scene_of(scene), semi_axes, data.epoch)
            if curve.spin is not None:
                first = first._replace(rates=np.where(np.arange(3) == curve.spin, np.linalg.norm(first.rates), 0.0)[None])
            found = Found(_polished(curve, improve(curve, Population(first, curve.chi_squares(first)), SETTLING)), REACHED)
            return _result(data, found, None, largest, scale_errors)
        count, generator = whole_number("starts", starts, 1), generator_of(rng)
        limits = _range(periods)
        if curve.spin is not None:
            return _result(data, _simple(curve, semi_axes, limits, (count, POLISHED), generator), None, largest, scale_errors)
        found = _searched(curve, random_states(semi_axes, limits, count, generator), from_spectrum(curve, semi_axes, limits, generator))
        # The spin of a body that hardly wobbles is slower than its precession: by A/C at most.
        moments = np.sort(moments_of_ellipsoid(semi_axes))
        simple = replace(curve, spin=int(np.argmax(moments_of_ellipsoid(semi_axes))))
        slow = limits[0], limits[1] * moments[2] / moments[0]
        rotation = _simple(simple, semi_axes, slow, (max(FEW, count // 5), HYPOTHESES), generator)
        if rotation.population.chi_squares[0] < found.population.chi_squares[0]:
            found = _from_rotation(curve, found, rotation)
        # Facets are a body of another shape already.
        series = np.inf if faceted else of_one_period(curve, slow)
    return _result(data, found, Hypothesis(replace(data, curve=simple), rotation, series), largest, scale_errors)


@dataclass(frozen=True, eq=False)
class Found:
    """Minima, the best first, and how many starts ended with the periods of the best, below all others."""

    population: Population
    reached: int


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Simple rotation, beside a tumbling motion."""

    data: Data
    found: Found
    series: float
    """χ² of a Fourier series of one period; infinite where facets are fitted."""


def _searched(curve: Curve, drawn: States, spectral: Population, count: int = POLISHED) -> Found:
    """The minima to which random starts and those from the spectrum lead, with their reflections and their aliases by the gaps of the data."""
    ended = population = together([refined(curve, search(curve.rough, drawn)), spectral])
    population = _polished(curve, improve(curve, best(_distinct(curve, population), count), SETTLING))
    if count == POLISHED:
        population = _with_others(curve, population)
    return Found(population, _reached(curve, ended, population))


def _reached(curve: Curve, ended: Population, minima: Population) -> int:
    """The starts that ended with the periods of the best minimum, below the minima with others."""
    duration = float(np.ptp(curve.times))
    best, *others = frequencies_of(minima.states)
    other = np.max(np.abs(np.reshape(others, (-1, 2)) - best), axis=1, initial=0.0) * duration > HALF_TURN
    lowest = float(np.min(minima.chi_squares[1:][other], initial=np.inf))
    same = np.max(np.abs(frequencies_of(ended.states) - best), axis=1) * duration <= HALF_TURN
    return int(np.sum(same & (ended.chi_squares < min(lowest, FAR * float(minima.chi_squares[0])))))


def _simple(curve: Curve, axes: Array, periods: tuple[float, float], starts: tuple[int, int], generator: np.random.Generator) -> Found:
    """Simple rotations from random starts, of which so many minima are improved to the end."""
    assert curve.spin is not None
    return _searched(curve, random_spins(axes, curve.spin, periods, starts[0], generator), from_spectrum(curve, axes, periods, generator), starts[1])


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


def _from_rotation(curve: Curve, found: Found, rotation: Found) -> Found:
    """The minima together with the one next to the best simple rotation: a tumbling motion fits no worse than that."""
    state = rotation.population.states.part(slice(0, 1))
    nudged = state._replace(rates=state.rates + WOBBLE * np.linalg.norm(state.rates))
    population = _polished(curve, improve(curve, Population(nudged, curve.chi_squares(nudged)), SETTLING))
    kept = _distinct(curve, together([found.population, population]))
    order = np.argsort(kept.chi_squares, kind="stable")
    return Found(Population(kept.states.part(order), kept.chi_squares[order]), rotation.reached)


def _state_of(scene: Scene, axes: Array, epoch: Any) -> States:
    """The state of a scene at the epoch."""
    if scene.orbit is not None:
        raise refusal("scene", "orbit", "none", "has an orbit: light curves are fitted without torques")
    if not np.any(scene.angular_velocity):
        raise refusal("scene", "at rest", "a rotation", "is at rest: give a state that rotates")
    sample = scene.solve().at(epoch)
    return States(axes[None].copy(), sample.attitude[None], sample.angular_velocity[None])


ADVICE = (
    'Try more starts, other periods, shape=True or "facets", curves with their own factors or the other law of scattering; check sigma, the directions, '
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


def _with_others(curve: Curve, minima: Population) -> Population:
    """Minima together with those to which their reflections lead, and the best at rates that the gaps of the data confuse with its own, the best first."""
    mirrored = reflections(curve, minima.states)
    shifts = confused(curve)
    if len(shifts):
        shifted = at_other_rates(minima.states.part(slice(0, 4)), shifts)
        mirrored = States(*(np.concatenate(arrays) for arrays in zip(mirrored, shifted)))
    found = improve(curve, Population(mirrored, curve.chi_squares(mirrored)), SETTLING)
    places = _different(curve, together([minima, found]))[:POLISHED]
    new = places[places >= len(minima.chi_squares)] - len(minima.chi_squares)
    if not len(new):
        return minima
    polished = _polished(curve, Population(found.states.part(new), found.chi_squares[new]))
    kept = best(_distinct(curve, together([minima, polished])), POLISHED)
    order = np.argsort(kept.chi_squares, kind="stable")
    return Population(kept.states.part(order), kept.chi_squares[order])


def _polished(curve: Curve, population: Population) -> Population:
    """Each state improved alone by SciPy if it is near the best, and those that are the same left out."""
    optimize = extra("scipy.optimize", "andoyer.fit")
    found = []
    least = float(np.min(population.chi_squares))
    for place in range(len(population.chi_squares)):
        state = population.states.part(slice(place, place + 1))
        first = np.zeros(len(curve.columns))
        if not np.all(np.isfinite(curve.residuals(state)[1])):
            continue
        if population.chi_squares[place] > FAR * least:
            found.append((state, float(population.chi_squares[place])))
            continue
        solution = optimize.least_squares(_residuals, first, _jacobian, args=(curve, state), method="trf", xtol=1e-12, ftol=1e-12, gtol=1e-15)
        found.append((curve.moved(state, solution.x[None]), 2 * solution.cost))
    if not found:
        last = float(curve.times[-1])
        raise refusal("times", last, "within the reach of a motion", f"[-1] is {last} after the first: no start has a motion and a finite χ² up to there")
    states = States(*(np.concatenate(arrays) for arrays in zip(*(state for state, _ in found))))
    return _distinct(curve, Population(states, np.array([chi_square for _, chi_square in found])))


def _residuals(step: Array, curve: Curve, state: States) -> Array:
    residuals, _ = curve.residuals(curve.moved(state, step[None]))
    finite: Array = np.nan_to_num(residuals[0], nan=np.inf)
    return finite


def _jacobian(step: Array, curve: Curve, state: States) -> Array:
    """Derivatives of the residuals (measured minus model) with respect to a step from `state`."""
    jacobian: Array = Seen(curve, state).derivatives(step[None])[1][0]
    return jacobian


def _result(data: Data, found: Found, hypothesis: Hypothesis | None, delta_chi_square: float, scale_errors: bool) -> Fit:
    """The fit of the best minimum, with all minima and the verdict."""
    minima = _optima(data, found, scale_errors)
    best = minima[0]
    optima = tuple(minimum for minimum in minima if minimum.delta_chi_square <= delta_chi_square)
    fit, zero_points, lost, residuals = _of_minimum(data, found.population.states.part(slice(0, 1)), best, scale_errors)
    simple = _optima(hypothesis.data, hypothesis.found, scale_errors) if hypothesis is not None else []
    curve = data.curve
    of_means = np.sum(
        (curve.weights * curve.brightness) @ curve.members / (curve.weights @ curve.members) * ((curve.weights * curve.brightness) @ curve.members)
    )
    constant = float(np.sum(curve.weights * curve.brightness**2) - of_means)
    others = other_shapes(hypothesis.data.curve, hypothesis.found.population.states, constant) if hypothesis is not None else None
    steps = np.diff(np.sort(curve.times))
    evidence = Evidence(
        optima=minima,
        residuals=residuals,
        curves=np.argmax(curve.members, axis=1),
        degrees=fit.degrees_of_freedom,
        duration=float(np.ptp(curve.times)),
        reached=found.reached,
        simple=simple,
        other_shapes=others,
        observed=float(np.sum(steps[~gaps(np.sort(curve.times))])),
        series=hypothesis.series if hypothesis is not None else np.inf,
        constant=constant,
        undetermined=frozenset(quantity.name for quantity in described(fit._steps, fit.covariance, fit.undetermined) if quantity.lost),
        unit=" s" if hasattr(data.epoch, "jd1") or has_units(as_one("times", data.times)) else "",
    )
    if data.photometry.zero is None:
        _warn_of_magnitudes(data.photometry.brightness, best.chi_square, fit.degrees_of_freedom)
    message = composed(best.chi_square, fit.degrees_of_freedom, ADVICE, lost, rivals(minima, evidence.duration))
    light = Light(data, fit._model)  # type: ignore[arg-type]
    photometric = Photometric(zero_points, judge(evidence), simple_rotation(evidence), light, scale(evidence))
    return replace(fit, message=message, optima=optima, _photometric=photometric)


@dataclass(frozen=True, eq=False)
class Refit:
    """The fit of a minimum, made when it is asked for."""

    data: Data
    state: States
    chi_square: float
    scale_errors: bool

    def __call__(self) -> Fit:
        alone = Found(Population(self.state, np.array([self.chi_square])), REACHED)
        return _result(self.data, alone, None, np.inf, self.scale_errors)


def _optima(data: Data, found: Found, scale_errors: bool) -> list[Optimum]:
    """The minima of a search as scenes."""
    least = float(found.population.chi_squares[0])
    optima = []
    for place, chi_square in enumerate(found.population.chi_squares):
        state = found.population.states.part(slice(place, place + 1))
        body = Body(moments_of_ellipsoid(state.axes)[0])
        scene = Scene(body, state.attitudes[0], state.rates[0], epoch=data.epoch)
        mode = PRINCIPAL if data.curve.spin is not None else scene.solve().plan.mode

        optima.append(Optimum(scene, mode, float(chi_square), float(chi_square) - least, Refit(data, state, float(chi_square), scale_errors)))
    return optima


def _of_minimum(data: Data, state: States, best: Optimum, scale_errors: bool) -> tuple[Fit, ZeroPoints, str | None, Array]:
    """The fit of one minimum, without what others say of it; zero points, what the data do not determine, residuals over σ."""
    curve = data.curve
    model = Seen(curve, state)
    residuals, jacobian = (array[0] for array in model.derivatives(np.zeros((1, len(curve.columns)))))
    residuals = residuals[: len(curve.times)]
    names = ("attitude", "angular_velocity" if curve.spin is None else "spin", *(("shape",) if curve.shape else ()))
    steps = Steps(best.scene, names, state.axes[0], spin=curve.spin or 0)
    covariance, lost, sentence = judged(steps, np.zeros(jacobian.shape[1]), jacobian)
    degrees = len(curve.times) - curve.members.shape[1] - (jacobian.shape[1] - len(lost))
    factor = max(1.0, best.chi_square / degrees) if scale_errors and degrees > 0 else 1.0
    units = steps.units(np.zeros(jacobian.shape[1]))
    zero_points = _zero_points(data, state, covariance / np.outer(units, units), factor)
    fit = Fit(
        scene=best.scene,
        parameters=steps.labels,
        covariance=factor * covariance,
        undetermined=lost,
        residuals=data.photometry.given - Light(data, model).at(None, None, None, None),
        chi_square=best.chi_square,
        degrees_of_freedom=degrees,
        message="",
        times=data.times,
        _steps=steps,
        _model=model,
        optima=(best,),
        semi_axes=state.axes[0],
    )
    return fit, zero_points, sentence, residuals


def _zero_points(data: Data, state: States, covariance: Array, factor: float) -> ZeroPoints:
    """Zero points with their errors, those of the state included: of ln s, variance at a fixed state plus its derivatives by the steps."""
    _, factors, slopes, variances = data.curve.model(state)
    relative = variances + np.einsum("kc,kl,lc->c", slopes, covariance, slopes)
    first = np.argmax(data.curve.members, axis=0)
    magnitude = np.zeros(len(factors)) if data.photometry.zero is None else data.photometry.zero[first]
    # The model is in units of (π/2) a³.
    unit = np.pi / 2 * state.axes[0, 0] ** 3
    return ZeroPoints(data.labels[first], magnitude - POGSON * np.log(factors / unit), POGSON * np.sqrt(factor * relative))


def _warn_of_magnitudes(brightness: Array, chi_square: float, degrees: int) -> None:
    """Warns where the fit is bad and the brightnesses can be magnitudes. Without degrees of freedom no fit is bad; then numbers that relative intensities seldom have are enough."""
    least, most = float(brightness.min()), float(brightness.max())
    bad = degrees > 0 and chi_square / degrees > largest_reduced(degrees)
    if most <= FAINTEST and (bad or (degrees <= 0 and least >= BRIGHTEST)):
        warnings.warn(
            f"the brightnesses lie between {least:.3g} and {most:.3g}{', and the fit is bad' if bad else ''}: if they are magnitudes, give them as magnitudes=",
            stacklevel=4,
        )
