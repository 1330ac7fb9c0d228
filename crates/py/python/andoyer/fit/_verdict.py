"""`Verdict`: how far light curves determine periods, pole and mode, from the minima of χ² and the hypothesis of simple rotation.

Differences of χ² are divided by a scale: the reduced χ² of the best fit if it is above 1, for what the model cannot show, times the correlation of neighbouring residuals, for what is
counted several times. A rival is a minimum whose scaled Δχ² is below `NEAR`. A body is no ellipsoid, so a Fourier series of one period is a rival too: simple rotation with any light curve.

Simple rotation stands where tumbling gains no more than by chance. That does not make its period secure: of few points, of much noise or of a poor search nothing is gained either. It is secure if the best
rotation, with a Fourier series in its angle beside it for another shape (`_other_shape`), leaves no room for a wobble: a wobble J [rad] changes the brightness by about J times the signal, and what is left
beyond the noise, with `TRIALS` for what would not be seen, must be less than J²/2 of the squared signal for J = `WOBBLE`. No other period may fit as well, and the data must last through `COVERED` periods,
nights alone counted. Such a rotation stands even where a tumbling ellipsoid fits better. The P_φ of a tumbler must be covered so too.

benches/verdicts.py measures on simulated data how often a verdict is right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer.fit._optimum import HALF_TURN, Optimum, turns
from andoyer.fit._other_shape import OtherShapes

SECURE, AMBIGUOUS, LOST = "secure", "ambiguous", "not determined"
NEAR = 16.0
"""Scaled Δχ² below which a minimum is a rival: four standard deviations of one parameter."""
MANY = 6
"""So many rival pairs of periods, or poles, determine none."""
SEPARATE = np.radians(15.0)
"""Angle [rad] between two poles that are not the same."""
REACHED = 2
"""Starts that must have led to the best minimum."""
LONGEST = 10
"""Largest correlation of residuals, in points."""
CHANCE = 1e-3
"""Probability of an improvement by chance above which a hypothesis with fewer parameters stands."""
TRIALS = 40.0
"""Twice the logarithm of the ratio of the likelihoods of tumbling and of a series of one period, up to which the series stands: `NEAR` and 2 ln of 2e5 pairs of periods tried."""
WOBBLE = np.radians(3.0)
"""Angle [rad] between axis and angular momentum that would show if it were there, for a simple rotation to be secure."""
COVERED = 2.0
"""Periods that the data last, gaps between nights apart: what was seen once does not repeat."""


@dataclass(frozen=True, eq=False)
class SimpleRotation:
    """The hypothesis of rotation about the axis of greatest inertia, from the same data."""

    optimum: Optimum
    """Its best minimum."""
    delta_chi_square: float
    """Its χ² less that of the tumbling motion."""
    probability: float
    """Probability that two further parameters lower the scaled χ² so much by chance (F test)."""

    @property
    def period(self) -> float:
        """The period of rotation."""
        return float(2 * np.pi / np.linalg.norm(self.optimum.scene.angular_velocity))

    def fit(self) -> Any:
        """The `Fit` of this hypothesis."""
        return self.optimum.fit()

    def __repr__(self) -> str:
        return f"SimpleRotation(P={self.period:.6g}, Δχ²={self.delta_chi_square:.4g}, probability {self.probability:.2g})"


@dataclass(frozen=True)
class Verdict:
    """What the data determine. `str` gives one sentence."""

    periods: str
    """"secure", "ambiguous" or "not determined": of the pair of periods, or the period of a simple rotation."""
    pole: str
    """The same of the direction of the angular momentum."""
    mode: str
    """The same of the mode: "short-axis", "long-axis" or "principal-axis"."""
    margins: tuple[float, float, float]
    """Scaled Δχ² of the next minimum with other periods, another pole, another mode; infinite without one."""
    reached: int
    """Starts that led to the best minimum."""
    simple: bool
    """Whether simple rotation explains the data as well: `periods` is then said of its period."""
    sentence: str

    def __str__(self) -> str:
        return self.sentence


@dataclass(frozen=True, eq=False)
class Evidence:
    """What a verdict is found from."""

    optima: Sequence[Optimum]
    """All minima, the best first."""
    residuals: Array
    """Over their standard deviations."""
    curves: Array
    """Of each point the number of its curve."""
    degrees: int
    """Degrees of freedom of the best fit."""
    duration: float
    reached: int
    """Starts that led to the best minimum."""
    simple: Sequence[Optimum]
    """Simple rotations, the best first, beside a tumbling motion."""
    other_shapes: OtherShapes | None
    """Each simple rotation with a Fourier series in its angle."""
    observed: float
    """Duration without the gaps between nights."""
    series: float
    """χ² of a Fourier series of one period: of a simple rotation with another shape than an ellipsoid."""
    constant: float
    """χ² of constant brightness in each curve."""
    undetermined: frozenset[str]
    """Names of the quantities of the summary that the best fit itself does not determine."""
    unit: str
    """Of time: " s", or nothing."""


def scale(evidence: Evidence) -> float:
    """By what differences of χ² are divided."""
    reduced = evidence.optima[0].chi_square / max(evidence.degrees, 1)
    return max(1.0, reduced) * correlation(evidence.residuals, evidence.curves)


def correlation(residuals: Array, curves: Array) -> float:
    """1 + 2Σρ of residuals within curves, up to the first lag without correlation: the number of points that count as one."""
    total = float(np.sum(residuals**2))
    found = 1.0
    for lag in range(1, LONGEST):
        same = curves[lag:] == curves[:-lag]
        rho = float(np.sum((residuals[lag:] * residuals[:-lag])[same])) / total if total > 0 else 0.0
        if rho <= 2 / np.sqrt(max(len(residuals), 1)):
            break
        found += 2 * rho
    return min(found, float(LONGEST))


def simple_rotation(evidence: Evidence) -> SimpleRotation | None:
    """The hypothesis of simple rotation beside the best motion."""
    if not evidence.simple:
        return None
    best = evidence.optima[0].chi_square
    simple = evidence.simple[0]
    return SimpleRotation(simple, simple.chi_square - best, _chance(max(simple.chi_square - best, 0.0) / 2, best, evidence))


def _chance(gain: float, best: float, evidence: Evidence) -> float:
    """Of F = gain a parameter over χ² a degree of freedom, with as many independent points as the residuals have."""
    tau = correlation(evidence.residuals, evidence.curves)
    degrees = max(evidence.degrees / tau, 1.0)
    return float(extra("scipy.special", "andoyer.fit").fdtrc(2, degrees, gain / tau / max(best / tau / degrees, 1e-300)))


@dataclass(frozen=True)
class Rotation:
    """What speaks for a simple rotation of a body of any shape."""

    stands: bool
    """Whether tumbling explains no more."""
    near: tuple[Optimum, ...]
    """Simple rotations that fit nearly as well as the best, the one without a series first."""
    wobble: float
    """The least angle [rad] between axis and angular momentum that would have shown; infinite if the data have few points."""
    established: bool
    """Whether it leaves no room for a wobble, and the data cover it."""


def rotation(evidence: Evidence) -> Rotation:
    """How well simple rotations with a series explain the data."""
    simple, others = simple_rotation(evidence), evidence.other_shapes
    if simple is None or others is None:
        return Rotation(False, (), np.inf, False)
    order = np.argsort(others.chi_squares, kind="stable")
    least, left = float(others.chi_squares[order[0]]), others.residuals[order[0]]
    tau, points = correlation(left, evidence.curves), len(left)
    wobble, by = np.inf, tau
    if points >= 2 * others.parameters and np.isfinite(least):
        reduced = max(1.0, least / (points - others.parameters))
        by = reduced * tau
        wobble = float(np.sqrt(2 * ((reduced - 1) * points + TRIALS * tau) / max(evidence.constant, 1e-300)))
    near = [evidence.simple[place] for place in order if others.chi_squares[place] - least < NEAR * by]
    bounded = wobble < WOBBLE
    return Rotation(simple.probability > CHANCE or bounded, (evidence.simple[0], *near), wobble, bounded and _covered(evidence, simple.period))


def _covered(evidence: Evidence, period: float) -> bool:
    return evidence.observed >= COVERED * period


def judge(evidence: Evidence) -> Verdict:
    """The verdict."""
    best = evidence.optima[0]
    by = scale(evidence)
    margins = [(optimum.chi_square - best.chi_square) / by for optimum in evidence.optima]
    pairs, poles, modes = [best.periods], [best.direction], {best.mode}
    first = [np.inf, np.inf, np.inf]
    for optimum, margin in zip(evidence.optima[1:], margins[1:]):
        others = (
            all(turns(optimum.periods, pair, evidence.duration) > HALF_TURN for pair in pairs),
            all(np.arccos(np.clip(optimum.direction @ pole, -1, 1)) > SEPARATE for pole in poles),
            optimum.mode != best.mode,
        )
        first = [min(known, margin) if other else known for known, other in zip(first, others)]
        if margin >= NEAR:
            if np.isfinite(first).all():
                break
            continue
        pairs += [optimum.periods] * others[0]
        poles += [optimum.direction] * others[1]
        modes.add(optimum.mode)
    seen = (evidence.constant - best.chi_square) / by > NEAR * (6 if best.mode != "principal-axis" else 4)
    found = evidence.reached >= REACHED and _covered(evidence, best.periods.precession)
    simple, steady = simple_rotation(evidence), rotation(evidence)
    stands = steady.stands
    if stands:
        pairs, found, seen = [], steady.established, seen or steady.established
        for optimum in steady.near:
            pairs += [optimum.periods] * all(turns(optimum.periods, pair, evidence.duration) > HALF_TURN for pair in pairs)
            poles += [optimum.direction] * all(np.arccos(np.clip(optimum.direction @ pole, -1, 1)) > SEPARATE for pole in poles)
    periods = _of(len(pairs), seen, found)
    if evidence.undetermined & ({"period"} if stands else {"P_φ", "P_ψ", "period"}):
        periods = LOST
    lost = periods == LOST or evidence.undetermined & {"pole longitude", "pole latitude"}
    pole = _of(len(poles), seen and not lost, found)
    if stands or (simple is not None and _shapeless(evidence)):
        modes.add("principal-axis")
    mode = _of(len(modes), seen, found and periods == SECURE)
    if mode == AMBIGUOUS and periods == SECURE and "principal-axis" in modes and best.mode != "principal-axis" and not stands:
        # The periods of a tumbler that may not tumble.
        periods = AMBIGUOUS
    return Verdict(
        periods,
        pole,
        mode,
        (first[0], first[1], first[2]),
        evidence.reached,
        stands,
        _sentence(evidence, (periods, pole, mode), (len(pairs), len(poles)), sorted(modes), simple, steady),
    )


def _shapeless(evidence: Evidence) -> bool:
    """Whether simple rotation of a body of another shape is not excluded.

    Either by a series of one period, for noise of unknown size and the number of independent points, or because P_ψ is P_φ or twice that: such a tumbler repeats itself, and with few
    parameters it has the odd harmonics that an ellipsoid in rotation has not.
    """
    precession, rotation = evidence.optima[0].periods
    if any(abs(k / precession - 2 / rotation) * evidence.duration < 2 * HALF_TURN for k in (1, 2)):
        return True
    points = len(evidence.residuals) / correlation(evidence.residuals, evidence.curves)
    return bool(points * np.log(max(evidence.series, 1e-300) / max(evidence.optima[0].chi_square, 1e-300)) < TRIALS)


def _of(count: int, seen: bool, found: bool) -> str:
    if not seen or count > MANY:
        return LOST
    return SECURE if count == 1 and found else AMBIGUOUS


def _sentence(
    evidence: Evidence, words: tuple[str, str, str], counts: tuple[int, int], modes: list[str], simple: SimpleRotation | None, steady: Rotation
) -> str:
    best = evidence.optima[0]
    periods, pole, mode = words
    if best.mode == "principal-axis":
        what = f"The period {best.periods.precession:.6g}{evidence.unit}"
    elif simple is not None and steady.stands:
        what = f"The period {simple.period:.6g}{evidence.unit} of a simple rotation"
    else:
        precession, rotation = best.periods
        what = f"The periods P_φ {precession:.6g}{evidence.unit}, P_ψ {rotation:.6g}{evidence.unit}"
    several = f" ({counts[0]} within the scaled Δχ² {NEAR:g})" if counts[0] > 1 else ""
    longitude, latitude = np.degrees(best.pole)
    of_pole = f" ({counts[1]} of them)" if counts[1] > 1 else ""
    text = f"{what} {'is' if what.startswith('The period ') else 'are'} {periods}{several}, the pole λ {longitude % 360:.1f}° β {latitude:.1f}° {pole}{of_pole}, the mode {best.mode} {mode}"
    if simple is not None:
        worse = f"worse by Δχ² {simple.delta_chi_square:.4g}" if simple.delta_chi_square > 0.05 else "as well"
        text += f"; simple rotation with {simple.period:.6g}{evidence.unit} fits {worse} (by chance {simple.probability:.1g})"
        if steady.established:
            text += f"; with another shape it leaves no wobble above {np.degrees(steady.wobble):.1f}°"
    elif len(modes) > 1:
        text += f" (also {', '.join(name for name in modes if name != best.mode)})"
    if evidence.reached < REACHED:
        text += "; one start alone led to the best minimum, so try more"
    return text + "."
