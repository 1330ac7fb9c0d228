"""States drawn from the distribution exp(−χ²/2) about a minimum of χ².

Steps of the normal distribution of the covariance are candidates, with the weights exp(−χ²/2) over their own density. Where the model is curved within the covariance, such weights are those of
a few candidates. Then each candidate solves Qᵀ[r(x) − r(0)] = z instead, for a normal z: r are the residuals over their standard deviations, and the orthonormal columns of Q span their
derivatives at the minimum (J = QR). The density of these candidates is |det QᵀJ(x)| exp(−|z|²/2), and their weights are nearly equal (randomize-then-optimize: Bardsley, Solonen, Haario,
Laine, SIAM J. Sci. Comput. 36, A1895, 2014). The draws are taken from the candidates by their weights.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from andoyer._quaternions import Array

CANDIDATES_AT_ONCE = 1000
"""Candidates that are solved for together."""
SPARE = 2
"""Candidates of the normal distribution for each draw. They are taken if their effective size is the number of draws."""
GAP = 1e-3
"""Largest difference of Qᵀ[r(x) − r(0)] from z, in standard deviations."""
LONGEST_STEP = 0.3
"""Longest step of any component, relative or in rad."""
SHORTEST = 1e-3
"""Smallest fraction of Newton's step that is tried. If it does not help either, the candidate has no solution."""
ITERATIONS = 60


class Model(Protocol):
    """The data with a model, as functions of steps from the minimum in rows, shape (m, k). Values are NaN where a step leads to no body."""

    @property
    def duration(self) -> float:
        """From the first to the last time of the data, in units of time."""
        ...

    def chi_squares(self, steps: Array) -> Array:
        """χ², shape (m,)."""
        ...

    def derivatives(self, steps: Array) -> tuple[Array, Array]:
        """Residuals over their standard deviations, shape (m, n), and their derivatives, shape (m, n, k)."""
        ...


class Candidates(NamedTuple):
    """Steps with their χ² and weights."""

    steps: Array
    chi_squares: Array
    logarithms: Array
    """Of exp(−χ²/2) over the density of a candidate, less that of their number: exp of them has the integral of exp(−χ²/2) over steps as its sum. −∞ for what is no body."""

    @property
    def weights(self) -> Array:
        """With the largest 1, or all 0 where no candidate is a body."""
        largest = self.logarithms.max(initial=-np.inf)
        weights: Array = np.exp(self.logarithms - largest) if np.isfinite(largest) else np.zeros(len(self.logarithms))
        return weights

    @property
    def effective_size(self) -> float:
        """(Σw)²/Σw²: the number of equal weights that would hold as much."""
        squares = float(np.sum(self.weights**2))
        return float(np.sum(self.weights)) ** 2 / squares if squares > 0 else 0.0

    def drawn(self, count: int, generator: np.random.Generator) -> NDArray[np.intp]:
        """Places of draws: of each candidate n times its weight, rounded up or down (systematic resampling)."""
        total = np.cumsum(self.weights)
        found = np.searchsorted(total, total[-1] * (generator.uniform() + np.arange(count)) / count, side="right")
        places: NDArray[np.intp] = np.minimum(found, np.flatnonzero(self.weights)[-1])
        return places


def candidates(model: Model, lost: Array, count: int, generator: np.random.Generator) -> Candidates:
    """Weighted steps about the minimum for this number of draws, without components along the rows of `lost`."""
    basis = np.linalg.svd(lost)[2][len(lost) :].T if len(lost) else np.eye(lost.shape[1])
    residuals, jacobian = (array[0] for array in model.derivatives(np.zeros((1, lost.shape[1]))))
    frame, triangle = np.linalg.qr(jacobian @ basis)
    normal = generator.standard_normal((SPARE * count, basis.shape[1]))
    steps = np.linalg.solve(triangle, normal.T).T @ basis.T
    chi_squares = model.chi_squares(steps)
    volume = 0.5 * basis.shape[1] * np.log(2 * np.pi)
    logarithms = volume - np.linalg.slogdet(triangle)[1] - 0.5 * (chi_squares - np.sum(normal**2, axis=1))
    found = _weighed(steps, chi_squares, logarithms)
    if found.effective_size >= count:
        return found
    search = _Search(model, basis, frame, triangle, residuals)
    parts = [search.solved(normal[start : start + CANDIDATES_AT_ONCE]) for start in range(0, count, CANDIDATES_AT_ONCE)]
    steps, chi_squares, logarithms = (np.concatenate(arrays) for arrays in zip(*parts))
    return _weighed(steps, chi_squares, logarithms + volume)


def _weighed(steps: Array, chi_squares: Array, logarithms: Array) -> Candidates:
    return Candidates(steps, chi_squares, np.where(np.isfinite(logarithms), logarithms, -np.inf) - np.log(max(len(steps), 1)))


class _Search(NamedTuple):
    """Newton's method for Qᵀ[r(x) − r(0)] = z, for many z at once."""

    model: Model
    basis: Array
    frame: Array
    triangle: Array
    residuals: Array

    def solved(self, normal: Array) -> tuple[Array, Array, Array]:
        """Steps, their χ² and the logarithms of their weights, which are −∞ where no solution was found."""
        count = len(normal)
        least = float(self.residuals @ self.residuals)
        places = np.zeros_like(normal)
        missing, gaps = normal.copy(), np.linalg.norm(normal, axis=1)
        slopes = np.repeat(self.triangle[None], count, axis=0)
        chi_squares, part = np.full(count, least), np.ones(count)
        for _ in range(ITERATIONS):
            active = np.flatnonzero((gaps > GAP) & (part > SHORTEST))
            if not len(active):
                break
            trial = places[active] + part[active, None] * _limited(slopes[active], missing[active])
            residuals, jacobian = self.model.derivatives(trial @ self.basis.T)
            left = normal[active] - (residuals - self.residuals) @ self.frame
            gap = np.linalg.norm(left, axis=1)
            nearer = gap < gaps[active] * (1 - 0.1 * part[active])  # false for NaN
            kept = active[nearer]
            places[kept], missing[kept], gaps[kept] = trial[nearer], left[nearer], gap[nearer]
            slopes[kept] = self.frame.T @ jacobian[nearer] @ self.basis
            chi_squares[kept] = np.sum(residuals[nearer] ** 2, axis=1)
            part[kept] = np.minimum(1.0, 2 * part[kept])
            part[active[~nearer]] /= 4
        logarithms = -0.5 * (chi_squares - np.sum(normal**2, axis=1)) - np.linalg.slogdet(slopes)[1]
        return places @ self.basis.T, chi_squares, np.where(gaps <= GAP, logarithms, -np.inf)


def _limited(slopes: Array, missing: Array) -> Array:
    """Newton's steps, of which no component is longer than the longest."""
    try:
        steps = np.linalg.solve(slopes, missing[..., None])[..., 0]
    except np.linalg.LinAlgError:
        steps = (np.linalg.pinv(slopes) @ missing[..., None])[..., 0]
    longest = np.max(np.abs(steps), axis=1, keepdims=True)
    limited: Array = steps * np.minimum(1.0, LONGEST_STEP / np.maximum(longest, LONGEST_STEP))
    return limited
