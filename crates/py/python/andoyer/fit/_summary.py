"""Quantities of the best state for `print(fit)`: periods, pole, phases and moments, each with its standard deviation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from andoyer._core import Error, Scene
from andoyer._quaternions import Array
from andoyer.fit._optimum import free_motion
from andoyer.fit._steps import Steps, root

DIFFERENCE = 1e-2
"""Steps of the differences, in standard deviations, or relative and in rad along what the data do not determine."""
ANGLES = ("pole longitude", "pole latitude", "phase μ", "phase ν", "phase μ + ν")


def _quantities(scene: Scene, semi_axes: Array | None, simple: bool) -> dict[str, float]:
    """What the summary lists; of a simple rotation one period and one phase."""
    motion = free_motion(scene)
    periods = motion.periods["extremal-axis"]
    x, y, z = (float(component) for component in motion.angular_momentum(0.0))
    _, mu, nu = (float(angle) for angle in motion.andoyer(0.0)[:3])
    values = {
        "P_φ": periods.precession,
        "P_ψ": periods.rotation,
        "pole longitude": np.degrees(np.arctan2(y, x)) % 360,
        "pole latitude": np.degrees(np.arctan2(z, np.hypot(x, y))),
        "phase μ": np.degrees(mu) % 360,
        "phase ν": np.degrees(nu) % 360,
    }
    if simple:
        del values["P_φ"], values["P_ψ"], values["phase μ"], values["phase ν"]
        values = {"period": 2 * np.pi / float(np.linalg.norm(scene.angular_velocity)), **values, "phase μ + ν": np.degrees(mu + nu) % 360}
    values |= {f"moment I{place}": float(moment) for place, moment in enumerate(scene.body.moments, 1)}
    if semi_axes is not None:
        values |= {f"axis ratio {name}": float(axis / semi_axes[0]) for name, axis in zip(("b/a", "c/a"), semi_axes[1:])}
    return values


class Quantity(NamedTuple):
    """A quantity of the best state."""

    name: str
    value: float
    slopes: Array
    """Derivatives along the columns of a square root of the covariance: the covariance of two quantities is the product of theirs."""
    lost: bool
    """Whether the data do not determine it."""

    @property
    def deviation(self) -> float:
        """The standard deviation; NaN where it is not known."""
        return float(np.linalg.norm(self.slopes))

    @property
    def unit(self) -> str:
        """The unit after a number: of angles."""
        return "°" if self.name in ANGLES else ""

    @property
    def held(self) -> bool:
        """Whether no free parameter changes it."""
        return self.deviation <= 1e-14 * abs(self.value)

    @property
    def free(self) -> bool:
        """Whether it has a value and a standard deviation above 0."""
        return bool(np.isfinite(self.value) and np.isfinite(self.deviation)) and not self.lost and not self.held

    def __str__(self) -> str:
        if not np.isfinite(self.value):
            return "none"
        if self.lost:
            return "not determined"
        if not np.isfinite(self.deviation):
            return f"{self.value:.6g}{self.unit}"
        return f"{self.value:.6g}{self.unit}  (held)" if self.held else with_deviation(self.value, self.deviation, self.unit)


def described(steps: Steps, covariance: Array, undetermined: Array) -> list[Quantity]:
    """Each quantity of the state that the steps begin at, with its derivatives and what the covariance of the free parameters says of it.

    `undetermined`: the directions of steps that the data do not determine, shape (d, k).
    """
    values = _quantities(steps.origin, steps.semi_axes, "spin" in steps.free)
    slopes = _slopes(steps, root(covariance, steps), list(values))
    lost = _slopes(steps, undetermined.T, list(values))
    found = []
    for name, value in values.items():
        # The moments keep their common factor, which the message names.
        gone = not name.startswith(("moment", "axis")) and _is_lost(name, float(np.linalg.norm(slopes[name])), float(np.linalg.norm(lost[name])))
        found.append(Quantity(name, value, slopes[name], gone))
    return found


def _is_lost(name: str, deviation: float, lost: float) -> bool:
    """Whether a quantity changes along what the data do not determine by more than its standard deviation, or an angle is anything."""
    return lost > max(deviation, 1e-6) or (name in ANGLES and deviation > 180)


def _slopes(steps: Steps, columns: Array, names: list[str]) -> dict[str, Array]:
    """Derivatives of the quantities along the columns of an array of steps, by central differences; by a one-sided difference if only one side is a body, NaN if neither is."""
    found: dict[str, list[float]] = {name: [] for name in names}
    here = _after(steps, np.zeros(len(columns)))
    for column in columns.T:
        sides = [(side, _after(steps, side * column)) for side in (DIFFERENCE, -DIFFERENCE)]
        (first, up), (last, down) = ((side, values) if values is not None else (0.0, here) for side, values in sides)
        for name in names:
            if up is None or down is None or first == last or not (np.isfinite(up[name]) and np.isfinite(down[name])):
                found[name].append(np.nan)
                continue
            difference = up[name] - down[name]
            turned = (difference + 180) % 360 - 180 if name in ANGLES else difference
            found[name].append(turned / (first - last))
    return {name: np.array(slopes) for name, slopes in found.items()}


def _after(steps: Steps, step: Array) -> dict[str, float] | None:
    """The quantities after a step; None where it leads to no body."""
    try:
        return _quantities(steps.scene(step), _axes(steps, step), "spin" in steps.free)
    except Error:
        return None


def _axes(steps: Steps, step: Array) -> Array | None:
    return None if steps.semi_axes is None else steps.axes(step)


def with_deviation(value: float, deviation: float, unit: str) -> str:
    """A value and its standard deviation to two digits, both with as many decimals."""
    decimals = max(0, 1 - int(np.floor(np.log10(deviation))))
    if decimals > 15:
        return f"{value:.15g} ± {deviation:.2g}{unit}"
    return f"{value:.{decimals}f} ± {deviation:.{decimals}f}{unit}"
