"""The sentences of `Fit.message`: whether the fit is good, which other minima fit nearly as well, and what the data do not determine."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from andoyer._extra import extra
from andoyer.fit._optimum import Alias, Optimum, aliases

NEAR = 25.0
"""Largest Δχ² of the minima that the message names: five standard deviations of one parameter."""
CHANCE = 1e-6
"""Probability with which noise alone makes a fit that is called bad."""
NAMED = 5
"""Largest number of pairs of periods that the message names."""


def largest_reduced(degrees: int) -> float:
    """The reduced χ² that noise alone exceeds with the probability `CHANCE`; infinite without degrees of freedom."""
    return float(extra("scipy.special", "andoyer.fit").chdtri(degrees, CHANCE)) / degrees if degrees > 0 else np.inf


def composed(chi_square: float, degrees: int, advice: str, undetermined: str | None, rivals: str | None = None) -> str:
    """The whole message. `advice` says what to try if the fit is bad; `undetermined` and `rivals` are sentences, None where there is nothing to say."""
    largest = largest_reduced(degrees)
    bad = None
    if degrees > 0 and not chi_square / degrees <= largest:
        bad = (
            f"The fit is bad: its reduced χ² is {chi_square / degrees:.3g}, and noise of this sigma gives at most {largest:.3g}. "
            f"Its uncertainties are too small. {advice}"
        )
    sentences = [sentence for sentence in (bad, rivals, undetermined) if sentence]
    return " ".join(sentences) or "The data determine every free parameter."


def rivals(optima: Sequence[Optimum], duration: float) -> str | None:
    """A sentence on the minima within Δχ² = NEAR of the best, the first of `optima`."""
    near = [optimum for optimum in optima if optimum.chi_square <= optima[0].chi_square + NEAR]
    if len(near) < 2:
        return None
    other = aliases(near, duration)
    best = near[0].periods
    parts = [_written(alias) for alias in other[:NAMED]]
    if len(other) > NAMED:
        parts.append(f"{len(other) - NAMED} more pairs of periods")
    # One minimum stands for each pair; the others have the periods of the best or of a pair before them.
    rest = [optimum for optimum in near[1:] if all(optimum.scene is not alias.scene for alias in other)]
    if rest:
        least = min(optimum.chi_square for optimum in rest) - near[0].chi_square
        parts.append(
            f"{len(rest)} with {'one of these pairs' if other else 'the same periods'}, such as a mirrored motion (Δχ² {'from ' * (len(rest) > 1)}{least:.1f})"
        )
    count = len(near) - 1
    lie = "Another minimum lies" if count == 1 else f"{count} other minima lie"
    return f"{lie} within Δχ² = {NEAR:g} of the best (P_φ {best.precession:.6g}, P_ψ {best.rotation:.6g}): {'; '.join(parts)}."


def _written(alias: Alias) -> str:
    return f"P_φ {alias.periods.precession:.6g}, P_ψ {alias.periods.rotation:.6g} (Δχ² {alias.delta_chi_square:.1f})"
