"""χ² of simple rotations of a body of another shape: a Fourier series in the angle of rotation beside the ellipsoid's brightness.

Eggs and boxes have harmonics that an ellipsoid has not. In simple rotation these have the period of rotation, whatever the shape, with amplitudes that change slowly as the directions to Sun and
observer do. A tumbling motion has other frequencies too, which the series cannot take up. The series, a constant for each curve and small steps of the state are fitted together by linear least squares
to the residuals of a minimum.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from andoyer._quaternions import Array
from andoyer.fit._curve import Curve, States
from andoyer.fit._facets import Facets

HARMONICS = np.arange(1, 9)
"""Multiples of the frequency of rotation."""
AMPLITUDE = 0.3
"""Prior standard deviation of an amplitude and of its change, in the root mean square of the data about their means."""


class OtherShapes(NamedTuple):
    """Simple rotations with their series."""

    chi_squares: Array
    """Of each, the prior of the amplitudes included, shape (m,); infinite without a motion."""
    residuals: Array
    """Over σ, shape (m, n)."""
    parameters: int
    """What is fitted to the data: the state, the shape, the factors of the curves and the series."""


def other_shapes(curve: Curve, states: States, square: float) -> OtherShapes:
    """The series beside each of some simple rotations, or their facets. `square`: χ² of constant brightness in each curve."""
    if isinstance(curve, Facets):
        residuals, jacobians = curve.residuals(states)
        return OtherShapes(
            np.nan_to_num(np.sum(residuals**2, axis=1), nan=np.inf), residuals[:, : len(curve.times)], curve.members.shape[1] + jacobians.shape[1]
        )
    root = np.sqrt(curve.weights if curve.logarithms else curve.weights * curve.brightness**2)
    deviation = AMPLITUDE * np.sqrt(square / np.sum(root**2))
    change = 2 * (curve.times - curve.times.min()) / max(float(np.ptp(curve.times)), 1e-300) - 1
    residuals, jacobians = curve.residuals(states)
    rates = np.linalg.norm(states.rates, axis=1)
    count = curve.members.shape[1] + jacobians.shape[1]
    found, left = np.full(len(residuals), np.inf), residuals.copy()
    for place, (residual, jacobian, rate) in enumerate(zip(residuals, jacobians, rates)):
        if not (np.isfinite(residual).all() and np.isfinite(jacobian).all()):
            continue
        angles = rate * np.outer(HARMONICS, curve.times)
        waves = np.concatenate([np.cos(angles), np.sin(angles)]) * root * deviation
        waves = np.concatenate([waves, waves * change])
        columns = np.concatenate([curve.members.T * root, jacobian, waves]).T
        prior = np.eye(len(waves), columns.shape[1], count)
        rest = np.concatenate([residual, np.zeros(len(waves))])
        columns = np.concatenate([columns, prior])
        rest = rest - columns @ np.linalg.lstsq(columns, rest, rcond=None)[0]
        found[place], left[place] = rest @ rest, rest[: len(residual)]
    return OtherShapes(found, left, count + 4 * len(HARMONICS))
