"""Minima of χ² from many starts, by Levenberg–Marquardt iterations of all states at once.

Every start is evaluated once. Each following round keeps the best remaining states, the same number of each mode, and improves them by a few steps.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from andoyer._core import Ensemble
from andoyer._quaternions import Array, product
from andoyer.fit._curve import Curve, States
from andoyer.fit._steps import moments_of_ellipsoid

ROUNDS = ((0.1, 4), (0.25, 8), (0.2, 40))
"""Of each round the part of the states that it takes, and its steps. Tried on simulated light curves, of which docs/fits.md has the figures."""
FEWEST = 64
"""States that a round takes at least."""
LONGEST_STEP = 0.3
"""Longest step of any component, relative or in rad."""
DAMPING, FALL, RISE = 1e-2, 0.2, 5.0
"""Damping at first, and its factors after a step that lowers χ² and after one that does not."""


class Population(NamedTuple):
    """States with their χ²."""

    states: States
    chi_squares: Array


def random_states(axes: Array, periods: tuple[float, float], count: int, generator: np.random.Generator) -> States:
    """States of an ellipsoid: any direction of the angular momentum in space and in the body, of either mode as many, with precession frequencies between those of the periods.

    Of the four states that a half turn about a body axis makes of one, which look the same, only one is drawn.
    """
    order = np.argsort(moments_of_ellipsoid(axes))
    momentum = _momenta(moments_of_ellipsoid(axes), count, generator)
    momentum[:, order[:2]] = np.abs(momentum[:, order[:2]])
    attitudes = generator.standard_normal((count, 4))
    attitudes /= np.linalg.norm(attitudes, axis=1, keepdims=True)
    moments = np.broadcast_to(moments_of_ellipsoid(axes), (count, 3))
    rates = momentum / moments
    unit = Ensemble(moments, attitudes, rates, tolerance=1e-6, span=(0.0, 1.0)).periods["extremal-axis"].precession
    frequencies = generator.uniform(1 / periods[1], 1 / periods[0], count)
    return States(np.broadcast_to(axes, (count, 3)).copy(), attitudes, rates * (unit * frequencies)[:, None])


def random_spins(axes: Array, axis: int, periods: tuple[float, float], count: int, generator: np.random.Generator) -> States:
    """Simple rotations about a body axis: any attitude, frequencies between those of the periods."""
    attitudes = generator.standard_normal((count, 4))
    rates = np.zeros((count, 3))
    rates[:, axis] = 2 * np.pi * generator.uniform(1 / periods[1], 1 / periods[0], count)
    return States(np.broadcast_to(axes, (count, 3)).copy(), attitudes / np.linalg.norm(attitudes, axis=1, keepdims=True), rates)


def at_other_rates(states: States, shifts: Array) -> States:
    """Each state with its rotation changed by each of some frequencies [cycles per unit of time], as far as they leave some of it."""
    sizes = np.linalg.norm(states.rates, axis=1)
    factors = 1 + 2 * np.pi * shifts[:, None] / sizes
    repeated = States(*(np.concatenate([array] * len(shifts)) for array in states))
    faster = States(repeated.axes, repeated.attitudes, repeated.rates * factors.reshape(-1, 1))
    return faster.part(factors.ravel() > 0.05)


def _momenta(moments: Array, count: int, generator: np.random.Generator) -> Array:
    """Directions of the angular momentum in the body, half of them of either mode where both take some part of the sphere."""
    half = count // 2
    found: dict[bool, Array] = {True: np.zeros((0, 3)), False: np.zeros((0, 3))}
    drawn = np.zeros((0, 3))
    for _ in range(20):
        drawn = generator.standard_normal((2 * count, 3))
        drawn /= np.linalg.norm(drawn, axis=1, keepdims=True)
        short = short_axis(moments, drawn / moments)
        for mode in found:
            found[mode] = np.concatenate([found[mode], drawn[short == mode]])
        if all(len(rows) >= count - half for rows in found.values()):
            break
    chosen = np.concatenate([found[True][: count - half], found[False][:half], drawn])
    return chosen[:count]


def short_axis(moments: Array, rates: Array) -> NDArray[np.bool_]:
    """Whether motions are of the short-axis mode: 2TB > M²."""
    momentum = moments * rates
    middle = np.sort(moments, axis=-1)[..., 1]
    energy, square = np.sum(momentum * rates, axis=-1), np.sum(momentum**2, axis=-1)
    short: NDArray[np.bool_] = energy * middle < square
    return short


def reflections(curve: Curve, states: States) -> States:
    """Three motions for each state that look nearly the same: the motion turned by π about each principal axis of the directions to Sun and observer.

    The brightness depends on squares and products of the two directions about body axes. If both lie in a plane at all times, a half turn about its normal changes the sign of both and
    leaves the brightness as it is. Near opposition half turns about the other two axes nearly do so.
    """
    directions = np.concatenate(np.broadcast_arrays(curve.sun, curve.observer), axis=1)
    _, axes = np.linalg.eigh(directions @ directions.T)
    turns = np.concatenate([axes.T, np.zeros((3, 1))], axis=1)
    attitudes = np.concatenate([product(np.broadcast_to(turn, states.attitudes.shape), states.attitudes) for turn in turns])
    return States(np.tile(states.axes, (3, 1)), attitudes, np.tile(states.rates, (3, 1)))


def search(curve: Curve, starts: States) -> Population:
    """The states to which the best starts lead."""
    population = Population(starts, _finite(curve.chi_squares(starts)))
    for part, steps in ROUNDS:
        population = improve(curve, best(population, max(FEWEST, int(part * len(population.chi_squares)))), steps)
    return population


def best(population: Population, count: int) -> Population:
    """The best states, of either mode as many where there are."""
    states, chi_squares = population
    order = np.argsort(chi_squares, kind="stable")
    short = short_axis(moments_of_ellipsoid(states.axes), states.rates)[order]
    modes = [order[short], order[~short]]
    half = [rows[: max(count // 2, count - len(modes[1 - place]))] for place, rows in enumerate(modes)]
    chosen = np.concatenate(half)
    return Population(states.part(chosen), chi_squares[chosen])


def improve(curve: Curve, population: Population, steps: int) -> Population:
    """Some steps of Levenberg and Marquardt, each of all states."""
    states = population.states
    current = curve.normal_equations(states)
    chi_squares = _finite(current.chi_square)
    damping = np.full(len(chi_squares), DAMPING)
    for _ in range(steps):
        trial = curve.moved(states, _step(current.gradient, current.matrix, damping))
        found = curve.normal_equations(trial)
        better = found.chi_square < chi_squares
        for kept, new in zip((*states, *current), (*trial, *found)):
            kept[better] = new[better]
        chi_squares = np.where(better, found.chi_square, chi_squares)
        damping = np.clip(damping * np.where(better, FALL, RISE), 1e-9, 1e9)
    return Population(states, chi_squares)


def _step(gradient: Array, matrix: Array, damping: Array) -> Array:
    """Damped steps, of which no component is longer than the longest."""
    gradient, matrix = np.nan_to_num(gradient), np.nan_to_num(matrix)
    size = np.maximum(np.einsum("mii->mi", matrix), 1e-30)
    scale = 1 / np.sqrt(size)
    scaled = matrix * scale[:, :, None] * scale[:, None, :] + (damping[:, None] + 1e-12)[:, :, None] * np.eye(matrix.shape[1])
    step = np.linalg.solve(scaled, (gradient * scale)[..., None])[..., 0] * scale
    longest = np.max(np.abs(step), axis=1, keepdims=True)
    limited: Array = step * np.minimum(1.0, LONGEST_STEP / np.maximum(longest, 1e-30))
    return limited


def _finite(chi_squares: Array) -> Array:
    """Infinite where a state has no motion or no derivatives."""
    return np.where(np.isfinite(chi_squares), chi_squares, np.inf)
