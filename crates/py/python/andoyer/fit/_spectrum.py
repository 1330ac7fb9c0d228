"""Starts of a tumbling motion from the frequencies of its brightness.

The brightness of an ellipsoid that tumbles freely is a Fourier series in the angles of precession and rotation. Its frequencies are j/P_φ + 2k/P_ψ for whole numbers j and k: quadratic forms of
directions about body axes have |j| ≤ 2, and half turns about the extremal axis change nothing (Kaasalainen, A&A 376, 302, 2001; Pravec et al., Icarus 173, 108, 2005). For pairs of frequencies on a
grid the series of low order is fitted by linear least squares, with a constant for each curve. Starts have the pairs that fit best, and random angles.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from andoyer._core import Ensemble
from andoyer._quaternions import Array
from andoyer.fit._curve import Curve, States
from andoyer.fit._search import Population, best, improve, random_spins
from andoyer.fit._steps import moments_of_ellipsoid

ROUNDS = ((64, 300, 16, 8), (16, 800, 40, 8), (4, 2000, 80, 10))
"""Rounds of a tumbling motion: number of pairs, starts of each pair, improved starts of each pair, steps."""
SPIN_ROUNDS = ((32, 100, 6, 6), (8, 400, 20, 8))
"""Rounds of a simple rotation."""
ENDED, LAST = 6, 30
"""States of each pair of the second round that are improved at the end, and their steps."""
TERMS = np.array([(0, 1), *((j, k) for j in (1, 2) for k in (-1, 0, 1))])
"""The multiples (j, k) of 1/P_φ and 2/P_ψ. Further ones fit wrong pairs better. Of the 41 tumblers of benches/verdicts.py with seeds 0 to 80 the true pair is among the best 64 for 35."""
SPIN_TERMS = np.array([(j, 0) for j in (1, 2, 3, 4)])
"""The multiples (j, 0) of a simple rotation."""
SERIES = np.array([(j, 0) for j in (1, 2, 3, 4, 5, 6)])
"""The multiples of the series of a simple rotation of any shape."""
FINE, FINEST = 3, 6
"""Frequencies of the grid in the inverse duration of the data, for starts and for the series of a simple rotation."""
PRIOR, FREE = 0.3, 100.0
"""Prior mean square of an amplitude, in that of the data: for starts, and for the χ² of a simple rotation."""
AT_ONCE = 1024
"""Pairs that are computed together."""
MOST = 500_000
"""Pairs of a whole grid at most; of longer data those are tried that explain two of the strongest frequencies."""
PEAKS = 40
"""The number of strongest frequencies."""
APART = 2
"""Steps of the grid by which chosen pairs differ."""
SPREAD = 0.1
"""Deviation of the logarithms of axis ratios of starts, where the shape is fitted."""
SHAPES = 16
"""Shapes of the starts, where the shape is fitted."""
REFINED, REFINING = 4, 6
"""The best of so many states of an ellipsoid gets facets, and its steps with them."""
ENERGIES = 200
"""Motions of each mode from which frequency ratios are interpolated."""


def grid(curve: Curve, ratios: tuple[float, float], periods: tuple[float, float]) -> NDArray[np.intp]:
    """Pairs (1/P_φ, 2/P_ψ) in steps of 1/(FINE duration), shape (m, 2), for the periods P_φ and the ratios P_φ/P_ψ."""
    first = line(curve, periods, FINE)[:, 0]
    if not len(first):
        return np.zeros((0, 2), dtype=np.intp)
    # A slower rotation does not show within the data.
    second = np.arange(max(FINE, int(2 * ratios[0] * first[0])), int(2 * ratios[1] * first[-1]) + 1, dtype=np.intp)
    if len(first) * len(second) <= MOST:
        pairs = np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1).reshape(-1, 2)
    else:
        alone = np.arange(FINE, 2 * first[-1] + second[-1] + 1, dtype=np.intp)[:, None] * [1, 0]
        peaks = likeliest(alone, left(curve, alone, np.array([(1, 0)])), PEAKS)[:, 0]
        two = np.stack(np.meshgrid(peaks, peaks), axis=-1).reshape(-1, 2)
        terms = [np.array([a, b]) for a in TERMS for b in TERMS]
        pairs = np.unique(np.concatenate([np.rint(two @ np.linalg.inv(term).T) for term in terms if abs(np.linalg.det(term)) > 0.5]).astype(np.intp), axis=0)
        pairs = pairs[(pairs[:, 0] >= first[0]) & (pairs[:, 0] <= first[-1]) & (pairs[:, 1] >= FINE)]
    chosen: NDArray[np.intp] = pairs[(pairs[:, 1] >= 2 * ratios[0] * pairs[:, 0]) & (pairs[:, 1] <= 2 * ratios[1] * pairs[:, 0])]
    return chosen


def line(curve: Curve, periods: tuple[float, float], fine: int) -> NDArray[np.intp]:
    """Frequencies in steps of 1/(fine duration), with a second one of 0, shape (m, 2)."""
    cells = fine * float(np.ptp(curve.times))
    first = np.arange(max(int(np.ceil(cells / periods[1])), 1), int(cells / periods[0]) + 1, dtype=np.intp)
    pairs: NDArray[np.intp] = np.stack([first, np.zeros_like(first)], axis=1)
    return pairs


def left(curve: Curve, pairs: NDArray[np.intp], terms: NDArray[np.intp], fine: int = FINE, amplitude: float = PRIOR) -> Array:
    """χ² of the fitted series of each pair."""
    times = curve.times - curve.times.min()
    step = 1 / (fine * np.ptp(times))
    data = curve.brightness if curve.logarithms else np.log(np.maximum(curve.brightness, 1e-300))
    weights = curve.weights if curve.logarithms else curve.weights * curve.brightness**2
    totals = weights @ curve.members
    data = data - curve.members @ ((weights * data) @ curve.members / totals)
    last = 2 * int(np.max(pairs @ np.abs(terms).max(axis=0))) + 1
    # Σ w e^{2πi f t} of each curve, and Σ w y e^{2πi f t}.
    columns = np.concatenate([weights[:, None] * curve.members, (weights * data)[:, None]], axis=1)
    sums = np.concatenate([np.exp(2j * np.pi * step * np.outer(part, times)) @ columns for part in np.array_split(np.arange(last + 1), last // AT_ONCE + 1)])
    of_curves, of_data = sums[:, :-1], sums[:, -1]
    of_all = of_curves.sum(axis=1)
    square = float(np.sum(weights * data**2))
    prior = float(np.sum(weights)) / len(times) / amplitude
    found = [_explained(pairs[start : start + AT_ONCE] @ terms.T, of_all, of_curves, of_data, totals, prior) for start in range(0, len(pairs), AT_ONCE)]
    chi_squares: Array = square - np.concatenate(found)
    return chi_squares


def _explained(places: NDArray[np.intp], sums: Array, of_curves: Array, of_data: Array, totals: Array, prior: float) -> Array:
    """The square that series take up; `places`: frequencies of their terms on the grid, shape (m, k)."""
    places = np.abs(places)
    difference = places[:, :, None] - places[:, None, :]
    minus, plus = sums[np.abs(difference)], sums[places[:, :, None] + places[:, None, :]]
    odd = np.where(difference < 0, -minus.imag, minus.imag)
    matrix = np.block([[minus.real + plus.real, plus.imag - odd], [plus.imag + odd, minus.real - plus.real]]) / 2
    waves, right = of_curves[places], of_data[places]
    means = np.concatenate([waves.real, waves.imag], axis=1) / np.sqrt(totals)
    matrix -= means @ np.swapaxes(means, 1, 2)
    matrix += prior * np.eye(matrix.shape[1])
    vector = np.concatenate([right.real, right.imag], axis=1)
    explained: Array = np.sum(vector * np.linalg.solve(matrix, vector[..., None])[..., 0], axis=1)
    return explained


def of_one_period(curve: Curve, periods: tuple[float, float]) -> float:
    """The least χ² of a series in one angle: a simple rotation of a body of any shape, seen from one side; infinite without a frequency to try."""
    pairs = line(curve, periods, FINEST)
    return float(left(curve, pairs, SERIES, FINEST, FREE).min()) if len(pairs) else np.inf


def likeliest(pairs: NDArray[np.intp], chi_squares: Array, count: int) -> NDArray[np.intp]:
    """The best pairs that are `APART`, the best first."""
    left_over = chi_squares.copy()
    chosen: list[NDArray[np.intp]] = []
    while len(chosen) < count and np.isfinite(left_over).any():
        chosen.append(pairs[np.argmin(left_over)])
        left_over[np.all(np.abs(pairs - chosen[-1]) < APART, axis=1)] = np.inf
    return np.array(chosen, dtype=np.intp).reshape(-1, 2)


def polhodes(moments: Array, energies: Array, short: NDArray[np.bool_], phases: Array) -> Array:
    """Directions of the angular momentum about body axes, shape (m, 3): of the mode's range of 2T/M² the part `energies`, from 0 at rotation about the extremal axis to 1 at the separatrix."""
    order = np.argsort(moments, axis=1)
    order = np.where(short[:, None], order[:, ::-1], order)
    last, middle, first = 1 / np.take_along_axis(moments, order, axis=1).T
    over = energies * (middle - last)
    along_first, along_middle = np.sqrt(over / (first - last)) * np.cos(phases), np.sqrt(energies) * np.sin(phases)
    sorted_ = np.stack([np.sqrt(np.maximum(1 - along_first**2 - along_middle**2, 0.0)), along_middle, along_first], axis=1)
    momenta = np.empty_like(sorted_)
    np.put_along_axis(momenta, order, sorted_, axis=1)
    return momenta


def frequencies_of(states: States) -> Array:
    """1/P_φ and 1/P_ψ of each state, shape (m, 2)."""
    ensemble = Ensemble(moments_of_ellipsoid(states.axes), states.attitudes, states.rates, tolerance=1e-6, span=(0.0, 1.0), errors="nan")
    periods = ensemble.periods["extremal-axis"]
    return 1 / np.stack([np.asarray(periods.precession), np.asarray(periods.rotation)], axis=1)


class Shapes(NamedTuple):
    """Shapes of starts, each in either mode, with the frequencies of motions of the angular momentum 1."""

    axes: Array
    short: NDArray[np.bool_]
    energies: Array
    first: Array
    """1/P_φ, shape (m, energies)."""
    ratios: Array
    """P_φ/P_ψ."""

    @classmethod
    def around(cls, axes: Array, spread: float, generator: np.random.Generator) -> Shapes:
        """The given axes, and others with a deviation of the logarithms of their ratios."""
        shapes = axes * np.exp(spread * generator.standard_normal((SHAPES if spread else 1, 3)) * [0, 1, 1])
        energies = 1 - np.linspace(1, 0, ENERGIES + 1)[:-1] ** 2 * (1 - 1e-4) - 1e-5
        several, short = np.repeat(shapes, 2, axis=0), np.tile([False, True], len(shapes))
        axes = np.repeat(several, ENERGIES, axis=0)
        moments = moments_of_ellipsoid(axes)
        rates = polhodes(moments, np.tile(energies, len(several)), np.repeat(short, ENERGIES), np.zeros(len(axes))) / moments
        first, second = frequencies_of(States(axes, np.tile([0.0, 0.0, 0.0, 1.0], (len(axes), 1)), rates)).T.reshape(2, len(several), -1)
        return cls(several, short, energies, first, second / first)

    def starts(self, pairs: Array, generator: np.random.Generator) -> States:
        """A state for each pair (1/P_φ, 1/P_ψ), with random angles: of a shape and a mode that have its ratio, or of those next to it."""
        count, wanted = len(pairs), pairs[:, 1] / pairs[:, 0]
        off = np.maximum(self.ratios.min(axis=1)[:, None] - wanted, 0) + np.maximum(wanted - self.ratios.max(axis=1)[:, None], 0)
        chosen = np.argmin(off + 1e-9 * generator.random(off.shape), axis=0)
        energy, first = np.empty(count), np.empty(count)
        for place in np.unique(chosen):
            rows, order = chosen == place, np.argsort(self.ratios[place])
            energy[rows] = np.interp(wanted[rows], self.ratios[place][order], self.energies[order])
            first[rows] = np.interp(energy[rows], self.energies, self.first[place])
        moments = moments_of_ellipsoid(self.axes[chosen])
        momenta = polhodes(moments, energy, self.short[chosen], generator.uniform(0, 2 * np.pi, count))
        attitudes = generator.standard_normal((count, 4))
        attitudes /= np.linalg.norm(attitudes, axis=1, keepdims=True)
        return States(self.axes[chosen].copy(), attitudes, momenta / moments * (pairs[:, 0] / first)[:, None])


def pairs_of(curve: Curve, shapes: Shapes | None, periods: tuple[float, float], count: int) -> Array:
    """The pairs (1/P_φ, 1/P_ψ) with which the series fit best, the best first; of simple rotations (1/P, 0)."""
    if shapes is None:
        pairs, terms = line(curve, periods, FINE), SPIN_TERMS
    else:
        pairs, terms = grid(curve, (float(shapes.ratios.min()), float(shapes.ratios.max())), periods), TERMS
    if not len(pairs):
        return np.zeros((0, 2))
    chosen: Array = likeliest(pairs, left(curve, pairs, terms), count) / (FINE * float(np.ptp(curve.times))) * [1, 0.5]
    return chosen


def from_spectrum(curve: Curve, axes: Array, periods: tuple[float, float], generator: np.random.Generator) -> Population:
    """States to which random angles at the best pairs of frequencies lead: in each round of fewer pairs, with more angles."""
    spin, rounds = curve.spin, ROUNDS if curve.spin is None else SPIN_ROUNDS
    shapes = Shapes.around(axes, SPREAD if curve.shape else 0.0, generator) if spin is None else None
    pairs = pairs_of(curve, shapes, periods, rounds[0][0])
    found: list[list[Population]] = [[] for _ in pairs]
    for count, each, kept, steps in rounds:
        for place, pair in enumerate(pairs[:count]):
            if shapes is None:
                states = random_spins(axes, spin or 0, (1 / pair[0], 1 / pair[0]), each, generator)
            else:
                states = shapes.starts(np.tile(pair, (each, 1)), generator)
            first = lowest(Population(states, curve.rough.chi_squares(states)), kept)
            found[place].append(refined(curve, improve(curve.rough, first, steps)))
        order = np.argsort([min(float(population.chi_squares.min()) for population in populations) for populations in found], kind="stable")
        pairs, found = pairs[order], [found[place] for place in order]
    if not found:
        return Population(States(np.zeros((0, 3)), np.zeros((0, 4)), np.zeros((0, 3))), np.zeros(0))
    return improve(curve, together([lowest(together(populations), ENDED) for populations in found[: rounds[1][0]]]), LAST)


def refined(curve: Curve, population: Population) -> Population:
    """The best of the states of an ellipsoid, of either mode as many, with the facets of the curve if it has any: a step with them takes ten times as long."""
    if curve.rough is curve:
        return population
    states = best(population, max(len(population.chi_squares) // REFINED, 2)).states
    return improve(curve, Population(states, curve.chi_squares(states)), REFINING)


def lowest(population: Population, count: int) -> Population:
    """The states of the least χ²."""
    chosen = np.argsort(np.nan_to_num(population.chi_squares, nan=np.inf), kind="stable")[:count]
    return Population(population.states.part(chosen), population.chi_squares[chosen])


def together(populations: list[Population]) -> Population:
    """All states of several populations."""
    states = States(*(np.concatenate(arrays) for arrays in zip(*(population.states for population in populations))))
    return Population(states, np.concatenate([population.chi_squares for population in populations]))
