"""`attitudes`: a state from measured attitudes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._core import Error, InputError, Motion, Scene
from andoyer._extra import extra
from andoyer._quaternions import Array, conjugate, product
from andoyer._refusal import refusal
from andoyer.fit._degeneracy import undetermined
from andoyer.fit._given import enough, freed, from_epoch, scene_of, unit_quaternions, whitening
from andoyer.fit._members import about_body_axes, are_bodies, members
from andoyer.fit._message import composed
from andoyer.fit._result import Fit, judged
from andoyer.fit._rotations import inverse_left_jacobian, logarithm
from andoyer.fit._steps import Steps
from andoyer.interop._foreign import as_one, epoch_of

DEFAULT = ("attitude", "angular_velocity", "moments")
KNOWN = (*DEFAULT, "inertia")
ADVICE = "Try a first state nearer to the data, more names in free, or an orbit; check sigma and that the quaternions rotate body components [x, y, z, w] into inertial ones."
ATTITUDES_AT_ONCE = 1_000_000
"""Attitudes that are compared together, which limits the memory."""
LEANING = 0.5
"""Standard deviation of a step, relative or in rad, that is taken for granted while only a part of the data is fitted."""


def attitudes(
    scene: Scene,
    times: Any,
    attitudes: Any,
    *,
    sigma: ArrayLike,
    free: str | Iterable[str] = DEFAULT,
) -> Fit:
    """Fits the state of a body, and its moments, to measured attitudes.

    The residuals are the rotation vectors about body axes from model to measured attitude, divided by their standard deviations. `scipy.optimize.least_squares` minimizes their sum of squares with
    the derivatives of `Motion.partials` (theory §12). Attitudes determine the moments only up to a common factor; the fit keeps the product of the
    given moments, or the trace of the tensor. Times may be in any order. The function needs SciPy, which ``pip install scipy`` installs.

    Parameters
    ----------
    scene : Scene
        First state of the search, at most about a third of a turn from the measured attitudes. The fitted scene keeps its options.
    times : array_like, shape (n,)
        Times, as for `Motion.attitude`.
    attitudes : array_like, shape (n, 4), or scipy.spatial.transform.Rotation
        Measured unit quaternions [x, y, z, w], body to inertial.
    sigma : float or array_like, shape (n,) or (n, 3, 3)
        Standard deviation about each body axis [rad], or covariances of the error as a rotation vector about body axes [rad²].
    free : iterable of {"attitude", "angular_velocity", "moments", "inertia"}, optional
        The fitted quantities. The others keep the values of `scene`. "moments" are the principal moments about fixed principal axes. "inertia" are the six elements I11, I22, I33, I12, I13, I23 of
        the tensor of a body made by `Body.from_inertia`, in place of "moments".

    Returns
    -------
    Fit
        The fitted scene, its covariance and its residuals.

    Raises
    ------
    InputError
        Fewer data than parameters; quaternions whose norm is not 1 or whose shape is not (n, 4); a `sigma` that is not positive; an unknown name in `free`, "inertia" for a body without a tensor or
        together with "moments"; a time that is not finite.
    TheoryError
        A motion on the separatrix, where derivatives do not exist.

    Examples
    --------
    The fit finds the rate about the axis of greatest inertia from a guess with an error of 1 %:

    >>> import numpy as np
    >>> from andoyer import Body, Scene, fit
    >>> body, times = Body([1, 1.5, 2]), np.linspace(0, 50, 100)
    >>> measured = Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().attitude(times)
    >>> guess = Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.01])
    >>> found = fit.attitudes(guess, times, measured, sigma=0.01, free=["attitude", "angular_velocity"])
    >>> found.scene.angular_velocity.round(9)
    array([0.1, 0.2, 1. ])
    """
    optimize = extra("scipy.optimize", "andoyer.fit")
    names = _of_body(freed(free, KNOWN), scene_of(scene))
    problem = _Problem(scene, times, attitudes, sigma, names)
    first = np.zeros(problem.basis.shape[1])
    problem.motion(first).attitude(times)  # what is wrong with the scene or the times is told here
    for window in problem.windows():
        first = optimize.least_squares(problem.leaning, first, problem.leaning_jacobian, args=(window,), method="trf", ftol=1e-3).x
    first = problem.without_undetermined(first)
    solution = optimize.least_squares(problem.whitened, first, problem.jacobian, method="trf", xtol=1e-12, ftol=1e-12, gtol=1e-15)
    return problem.result(solution.x)


def _of_body(names: tuple[str, ...], scene: Scene) -> tuple[str, ...]:
    """The free quantities, if they are those of the body.

    Raises
    ------
    InputError
        "inertia" for a body without a tensor, or with "moments".
    """
    if "inertia" in names:
        if not scene.body.has_tensor:
            bound = "attitude, angular_velocity or moments"
            raise refusal("free", "inertia", bound, f"has 'inertia' for a body given by moments: it must be {bound}, or the body one of Body.from_inertia")
        if "moments" in names:
            raise refusal(
                "free", "moments, inertia", "one of them", "has 'moments' and 'inertia': it must have one of them, because the tensor has the moments"
            )
    return names


class _Problem:
    """Residuals and their derivatives as functions of reduced steps, without the common factor of the moments, which attitudes do not determine."""

    def __init__(self, scene: Scene, times: Any, measured: Any, sigma: ArrayLike, names: tuple[str, ...]) -> None:
        self.times = as_one("times", times)
        count = np.size(self.times) if np.ndim(self.times) else 1
        self.measured = unit_quaternions("attitudes", measured, count)
        self.whiten = whitening(sigma, count)
        self.since = since_epoch(scene, self.times)
        self.elapsed = np.abs(self.since)
        self.steps = Steps(scene, names, pace=1 / max(self.elapsed.max(initial=0.0), np.finfo(float).tiny))
        self.basis = _without_factor(self.steps.labels)
        enough(3 * count, self.basis.shape[1], "attitudes", "give more attitudes, or name fewer in free")

    def windows(self) -> list[NDArray[np.intp]]:
        """Growing parts of the data nearest to the epoch, each twice as large, up to the full set. A poor first state still predicts data near the epoch."""
        nearest = np.argsort(self.elapsed, kind="stable")
        sizes = [len(nearest) >> halvings for halvings in range(len(nearest).bit_length())]
        return [nearest[:size] for size in reversed(sizes) if 3 * size >= self.basis.shape[1]]

    def leaning(self, reduced: Array, window: NDArray[np.intp]) -> Array:
        """Residuals of the data in a window, then reduced / LEANING, which keeps near 0 the components of the step that these data do not determine."""
        return np.append(self.whitened(reduced).reshape(-1, 3)[window].ravel(), reduced / LEANING)

    def leaning_jacobian(self, reduced: Array, window: NDArray[np.intp]) -> Array:
        jacobian = self.jacobian(reduced)
        of_window = jacobian.reshape(-1, 3, len(reduced))[window].reshape(-1, len(reduced))
        return np.concatenate([of_window, np.eye(len(reduced)) / LEANING])

    def without_undetermined(self, reduced: Array) -> Array:
        """Takes the state at a step as the first one and holds there what the data determine worse than what is taken for granted: noise would lead the search far along it. Returns the step 0."""
        _, singular, directions = np.linalg.svd(self.jacobian(reduced))
        lost = undetermined(singular, directions, LEANING)
        self.steps = Steps(self.steps.scene(self.basis @ reduced), self.steps.free, pace=self.steps.pace)
        self.basis = self.basis @ directions[: len(directions) - len(lost)].T
        return np.zeros(self.basis.shape[1])

    def motion(self, reduced: Array) -> Motion:
        return self.steps.scene(self.basis @ reduced).solve()

    def residuals(self, motion: Motion) -> Array:
        return logarithm(product(conjugate(motion.attitude(self.times)), self.measured))

    def whitened(self, reduced: Array) -> Array:
        try:
            residuals = self.residuals(self.motion(reduced))
        except InputError:  # moments of no body: the step is too long
            return np.full(3 * len(self.measured), np.inf)
        whitened: Array = np.einsum("nij,nj->ni", self.whiten, residuals).ravel()
        return whitened

    def full_jacobian(self, step: Array) -> Array:
        scene = self.steps.scene(step)
        motion = scene.solve()
        columns = self.steps.columns(motion.partials(self.times).attitude, step, scene.body)
        whiten = -self.whiten @ inverse_left_jacobian(self.residuals(motion))
        jacobian: Array = (whiten @ columns).reshape(-1, len(step))
        return jacobian

    def jacobian(self, reduced: Array) -> Array:
        return self.full_jacobian(self.basis @ reduced) @ self.basis

    def result(self, reduced: Array) -> Fit:
        # Derivatives at the solution are taken from there, with a step of 0.
        scene = self.steps.scene(self.basis @ reduced)
        self.steps = Steps(scene, self.steps.free, pace=self.steps.pace)
        step = np.zeros(len(self.basis))
        covariance, lost, sentence = judged(self.steps, step, self.full_jacobian(step))
        chi_square = float(np.sum(self.whitened(np.zeros_like(reduced)) ** 2))
        degrees = 3 * len(self.measured) - (len(step) - len(lost))
        residuals = self.residuals(scene.solve())
        message = composed(chi_square, degrees, ADVICE, sentence)
        return Fit(scene, self.steps.labels, covariance, lost, residuals, chi_square, degrees, message, self.times, self.steps, self)

    @property
    def duration(self) -> float:
        """From the first to the last time."""
        return float(np.ptp(self.since))

    def chi_squares(self, steps: Array) -> Array:
        """χ² of full steps in rows; NaN where no body has the moments."""
        chi_squares = np.full(len(steps), np.nan)
        valid = are_bodies(self.steps, steps)
        for rows in np.array_split(np.flatnonzero(valid), 1 + len(steps) * len(self.measured) // ATTITUDES_AT_ONCE):
            attitudes = about_body_axes(self.steps, steps[rows], members(self.steps, steps[rows], errors="nan").attitude(self.times))
            residuals = logarithm(product(conjugate(attitudes), np.broadcast_to(self.measured, attitudes.shape)))
            chi_squares[rows] = np.sum(np.einsum("nij,mnj->mni", self.whiten, residuals) ** 2, axis=(1, 2))
        return chi_squares

    def derivatives(self, steps: Array) -> tuple[Array, Array]:
        """Residuals over their standard deviations of full steps in rows, with their derivatives; NaN where no body has the moments."""
        residuals = np.full((len(steps), 3 * len(self.measured)), np.nan)
        jacobians = np.full((*residuals.shape, steps.shape[1]), np.nan)
        for place in np.flatnonzero(are_bodies(self.steps, steps)):
            try:
                motion = self.steps.scene(steps[place]).solve()
                residuals[place] = np.einsum("nij,nj->ni", self.whiten, self.residuals(motion)).ravel()
                jacobians[place] = self.full_jacobian(steps[place])
            except Error:  # the step leads to the separatrix, where derivatives do not exist
                continue
        return residuals, jacobians


def since_epoch(scene: Scene, times: Any) -> Array:
    """Times from the epoch, in units of time, or in seconds for values of astropy, shape (n,)."""
    return np.atleast_1d(from_epoch("times", times, epoch_of(scene), scene.epoch))


def _without_factor(labels: tuple[str, ...]) -> Array:
    """A basis of the steps that keep the product of the moments, or the trace of the tensor."""
    first = next((labels.index(label) for label in ("I1", "I11") if label in labels), None)
    if first is None:
        return np.eye(len(labels))
    basis = np.eye(len(labels))
    basis[first : first + 3, first : first + 2] = np.array([[1, 1], [-1, 1], [0, -2]]) / np.sqrt([2, 6])
    return np.delete(basis, first + 2, axis=1)
