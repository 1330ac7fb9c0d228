"""Minima of χ², and pairs of periods that fit nearly as well as the best."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from andoyer._core import Motion, Scene
from andoyer._quaternions import Array
from andoyer.mean import Periods

HALF_TURN = 0.5
"""Difference of two phases [turns] over the data from which two pairs of periods count as different: half the resolution of the data in frequency."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """A minimum of χ² from a search with many starts."""

    scene: Scene
    mode: str
    """The mode of its motion, such as "short-axis"; "principal-axis" for a simple rotation."""
    chi_square: float
    """χ² at the minimum."""
    delta_chi_square: float
    """χ² less that of the best minimum."""
    _made: Callable[[], Any]

    def fit(self) -> Any:
        """The `Fit` of this minimum, with the standard deviations of its own."""
        return self._made()

    @property
    def periods(self) -> Periods:
        """The mean periods (P_φ, P_ψ) in the convention "extremal-axis" of `Motion.periods`; of a simple rotation its period and infinity."""
        if self.mode == "principal-axis":
            return Periods(float(2 * np.pi / np.linalg.norm(self.scene.angular_velocity)), np.inf)
        return free_motion(self.scene).periods["extremal-axis"]

    @property
    def direction(self) -> Array:
        """The direction of the angular momentum, inertial components, shape (3,)."""
        momentum = free_motion(self.scene).angular_momentum(0.0)
        unit: Array = momentum / np.linalg.norm(momentum)
        return unit

    @property
    def pole(self) -> Array:
        """Longitude and latitude of the angular momentum [rad], shape (2,), as `momentum_direction` of `Scene.from_periods` takes them."""
        x, y, z = self.direction
        return np.array([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))])

    def __repr__(self) -> str:
        if self.mode == "principal-axis":
            return f"Optimum({self.mode}, P={2 * np.pi / np.linalg.norm(self.scene.angular_velocity):.6g}, χ²={self.chi_square:.6g})"
        precession, rotation = self.periods
        return f"Optimum({self.mode}, P_φ={precession:.6g}, P_ψ={rotation:.6g}, χ²={self.chi_square:.6g})"


@dataclass(frozen=True, eq=False)
class Alias:
    """A pair of periods other than that of the best state, with which the data are fitted next best."""

    periods: Periods
    """The mean periods (P_φ, P_ψ) in the convention "extremal-axis" of `Motion.periods`."""
    delta_chi_square: float
    """χ² of the best minimum with these periods, less the least χ² of all minima."""
    scene: Scene
    """The scene of this minimum."""

    def __repr__(self) -> str:
        return f"Alias(P_φ={self.periods.precession:.6g}, P_ψ={self.periods.rotation:.6g}, Δχ²={self.delta_chi_square:.4g})"


def free_motion(scene: Scene) -> Motion:
    """The motion without torques from the state of a scene, with the epoch 0."""
    return Scene(scene.body, scene.attitude, scene.angular_velocity).solve()


def aliases(optima: Sequence[Optimum], duration: float) -> list[Alias]:
    """Of the minima with other periods than the best, the first of `optima`, the best with each pair of periods."""
    found: list[Alias] = []
    known: list[Periods] = [optima[0].periods] if optima else []
    for optimum in optima[1:]:
        periods = optimum.periods
        if all(turns(periods, other, duration) > HALF_TURN for other in known):
            known.append(periods)
            found.append(Alias(periods, optimum.chi_square - optima[0].chi_square, optimum.scene))
    return found


def turns(first: Periods, second: Periods, duration: float) -> float:
    """The largest difference of the phases [turns] of two pairs of periods after a duration."""
    # A period that does not exist is infinite, and its frequency 0.
    return float(np.max(np.abs(1 / np.array(first) - 1 / np.array(second)))) * duration
