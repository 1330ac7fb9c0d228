"""χ² of light curves, with its gradient, for many states at once.

The model is s B: brightness B of an ellipsoid and a factor s for each curve, which is solved for (variable projection). Derivatives of the residuals are those of B without the part
along B, times s (Kaufman, BIT 15, 1975): what the factors take up is no part of the fit.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from andoyer._core import Ensemble
from andoyer._quaternions import Array, product
from andoyer.fit._rotations import exponential
from andoyer.fit._scattering import with_derivatives
from andoyer.fit._steps import logarithms_by_shape, moments_of_ellipsoid

POINTS_AT_ONCE = 8192
"""Points that are computed together, so that their arrays stay in the cache."""

TOLERANCE = 1e-9
"""Attitude error [rad] of the states that are tried."""

T = TypeVar("T")


class States(NamedTuple):
    """States of ellipsoids, one in each row."""

    axes: Array
    attitudes: Array
    rates: Array

    def part(self, rows: "slice | NDArray[np.intp]") -> "States":
        """The states of these rows."""
        return States(*(array[rows] for array in self))


class Normal(NamedTuple):
    """χ² and its normal equations."""

    chi_square: Array
    gradient: Array
    matrix: Array


@dataclass(frozen=True, eq=False)
class Curve:
    """Brightnesses with what they were seen from."""

    times: Array
    """Since the epoch."""
    brightness: Array
    """Intensities, or with `logarithms` their natural logarithms."""
    weights: Array
    """1/σ², shape (n,)."""
    sun: Array
    """Unit vectors, shape (3, 1) or (3, n)."""
    observer: Array
    members: Array
    """Of each curve the points that belong to it: ones and zeros, shape (n, c)."""
    scattering: str
    shape: bool
    """Whether the axis ratios are free."""
    logarithms: bool = False
    """Whether differences of logarithms are fitted: magnitudes, whose factors are then weighted means."""
    spin: int | None = None
    """The body axis of a simple rotation, about which alone the body turns; None for any motion."""

    @property
    def rough(self) -> "Curve":
        """The same data with the model of an ellipsoid: what a search begins with."""
        return self

    @property
    def columns(self) -> list[int]:
        """The free components of a step: of the attitude, the angular velocity and the shape."""
        rates = [3, 4, 5] if self.spin is None else [3 + self.spin]
        return [0, 1, 2, *rates, *([6, 7] if self.shape else [])]

    def moved(self, states: States, steps: Array) -> States:
        """The states after a step each."""
        full = np.zeros((len(steps), 8))
        full[:, self.columns] = steps
        rates = states.rates + full[:, 3:6] * np.linalg.norm(states.rates, axis=1, keepdims=True)
        axes = states.axes.copy()
        axes[:, 1:] *= np.exp(full[:, 6:])
        if self.spin is not None:
            # A rotation about another axis than that of greatest inertia is no state of this curve.
            rates = np.where((axes[:, self.spin] <= axes.min(axis=1))[:, None], rates, np.nan)
        attitudes = product(states.attitudes, exponential(full[:, :3]))
        return States(axes, attitudes / np.linalg.norm(attitudes, axis=1, keepdims=True), rates)

    def in_chunks(self, states: States, task: Callable[[States], T]) -> list[T]:
        """Apply `task` to parts of the states, on one thread for each core; the list of results."""
        count = max(1, POINTS_AT_ONCE // len(self.times))
        parts = [states.part(slice(start, start + count)) for start in range(0, len(states.axes), count)]
        if len(parts) == 1:
            return [task(parts[0])]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(task, parts))

    def chi_squares(self, states: States) -> Array:
        """χ² of each state."""
        return np.concatenate(self.in_chunks(states, self._chi_squares))

    def normal_equations(self, states: States) -> Normal:
        """χ² of each state, half its gradient and the matrix JᵀJ."""
        parts = self.in_chunks(states, self._normal)
        return Normal(*(np.concatenate(arrays) for arrays in zip(*parts)))

    def _chi_squares(self, states: States) -> Array:
        attitudes = self._ensemble(states).attitude(self.times)
        value = with_derivatives(*self._seen(states, attitudes), self.scattering, derivatives=False).value
        chi_squares: Array = self._left(value) ** 2 @ self.weights
        return chi_squares

    def factors(self, value: Array) -> Array:
        """The factor of each curve, shape (m, c)."""
        if self.logarithms:
            return np.exp((self.weights * (self.brightness - np.log(value))) @ self.members / (self.weights @ self.members))
        factors: Array = (self.weights * self.brightness * value) @ self.members / ((self.weights * value * value) @ self.members)
        return factors

    def _left(self, value: Array) -> Array:
        """Data less the model with the best factors."""
        factors = self.factors(value) @ self.members.T
        left: Array = self.brightness - np.log(factors * value) if self.logarithms else self.brightness - factors * value
        return left

    def _normal(self, states: States) -> Normal:
        residuals, jacobian = self.residuals(states)
        matrix = jacobian @ np.swapaxes(jacobian, 1, 2)
        gradient = np.squeeze(jacobian @ residuals[..., None], -1)
        return Normal(np.sum(residuals**2, axis=1), gradient, matrix)

    def residuals(self, states: States) -> tuple[Array, Array]:
        """Residuals over σ, shape (m, n), and the derivatives of the model over σ, shape (m, k, n), with respect to steps."""
        value, by_step, factors = self._model(states)
        relative, along = self._relative(value, by_step)
        size = np.sqrt(self.weights) if self.logarithms else (factors @ self.members.T) * value * np.sqrt(self.weights)
        jacobian = (relative - along @ self.members.T) * (size if self.logarithms else size[:, None])
        return self._left(value) * np.sqrt(self.weights), jacobian

    def model(self, state: States) -> tuple[Array, Array, Array, Array]:
        """Of one state the brightness without a factor, shape (n,), the factors, shape (c,), the derivatives of their logarithms by a step, shape (k, c), and the variances of these at a fixed
        state."""
        value, by_step, factors = self._model(state)
        _, along = self._relative(value, by_step)
        weights = self.weights if self.logarithms else self.weights * (factors[0] @ self.members.T * value[0]) ** 2
        return value[0], factors[0], -along[0], 1 / (weights @ self.members)

    def elsewhere(self, state: States, times: Array, sun: Array, observer: Array) -> Array:
        """The brightness of a state at other times and directions, components in the leading axis, without a factor."""
        there = self._at(times, sun, observer)
        seen = there._seen(state, there._ensemble(state).attitude(times))
        value: Array = with_derivatives(*seen, self.scattering, derivatives=False).value[0]
        return value

    def _at(self, times: Array, sun: Array, observer: Array) -> Self:
        return replace(self, times=times, sun=sun, observer=observer)

    def _model(self, states: States) -> tuple[Array, Array, Array]:
        """Brightnesses, their derivatives by a step, shape (m, k, n), and the factors of the curves."""
        ensemble = self._ensemble(states)
        found = with_derivatives(*self._seen(states, ensemble.attitude(self.times)), self.scattering, shape=self.shape)
        by_step = self._by_step(states, ensemble.partials(self.times).attitude, found.by_turn, found.by_shape)
        return found.value, by_step, self.factors(found.value)

    def _by_step(self, states: States, partials: Array, by_turn: Array, by_shape: Array) -> Array:
        """Derivatives by the free components of a step, shape (m, k, n), from those by a rotation about body axes and by the shape, in leading axes, and from the partials of the attitudes."""
        by_state = np.einsum("imn,mnij->mjn", by_turn, partials)
        by_state[:, 3:6] *= np.linalg.norm(states.rates, axis=1)[:, None, None]
        by_step = by_state[:, :6]
        if self.shape:
            by_logarithm = by_state[:, 6:] * moments_of_ellipsoid(states.axes)[:, :, None]
            by_step = np.concatenate([by_step, np.swapaxes(logarithms_by_shape(states.axes), 1, 2) @ by_logarithm + np.moveaxis(by_shape, 0, 1)], axis=1)
        free: Array = by_step[:, self.columns]
        return free

    def _relative(self, value: Array, by_step: Array) -> tuple[Array, Array]:
        """Derivatives of the logarithms of the brightnesses, shape (m, k, n), and their means over each curve, shape (m, k, c), which the factors take up."""
        relative = by_step / value[:, None]
        weights = np.broadcast_to(self.weights, value.shape) if self.logarithms else self.weights * value * value
        along: Array = ((relative * weights[:, None]) @ self.members) / (weights @ self.members)[:, None]
        return relative, along

    def _ensemble(self, states: States) -> Ensemble:
        span = (self.times.min(), self.times.max())
        return Ensemble(moments_of_ellipsoid(states.axes), states.attitudes, states.rates, tolerance=TOLERANCE, span=span, threads=1, errors="nan")

    def _seen(self, states: States, attitudes: Array) -> tuple[Array, Array, Array]:
        """Semi-axes, and the directions of Sun and observer about body axes, components in the leading axis."""
        x, y, z, w = np.moveaxis(attitudes, -1, 0)
        turned = [
            np.stack(
                [
                    (1 - 2 * (y * y + z * z)) * a + 2 * (x * y + z * w) * b + 2 * (x * z - y * w) * c,
                    2 * (x * y - z * w) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z + x * w) * c,
                    2 * (x * z + y * w) * a + 2 * (y * z - x * w) * b + (1 - 2 * (x * x + y * y)) * c,
                ]
            )
            for a, b, c in (self.sun, self.observer)
        ]
        return states.axes.T[:, :, None], turned[0], turned[1]
