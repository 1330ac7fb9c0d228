"""Pictures of an evolution: spin period, obliquity and excess of energy over time, and the path of the pole."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Evolution
from andoyer._extra import extra
from andoyer.interop._foreign import plain
from andoyer.plot._style import BLUE, GREEN, GREY, STYLE, VERMILION
from andoyer.plot._time import clock_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAMPLES = 1000
"""Times that are drawn if none are given."""


def evolution(evolution: Evolution, times: ArrayLike | None = None, *, time_unit: str | None = None) -> Figure:
    """Draw what weak torques do over years: the spin period, the obliquity and the excess of energy over that of the separatrix.

    Parameters
    ----------
    evolution : Evolution
        From `Scene.evolve`.
    times : array_like, shape (n,), optional
        Times in the unit of the scene. By default all that the evolution reaches.
    time_unit : str, optional
        The name of the unit of time of the scene. A scene with a calendar epoch has dates.

    Returns
    -------
    matplotlib.figure.Figure
        With two axes, or three if there is an orbit, against whose normal the obliquity is.
    """
    plt: Any = extra("matplotlib.pyplot", "andoyer.plot")
    drawn = np.linspace(*evolution.reached, SAMPLES) if times is None else np.asarray(plain("times", times), dtype=float)
    states = evolution.at(drawn)
    clock = clock_of(evolution, drawn, time_unit)
    lines = [("spin period" + (f" [{clock.unit}]" if clock.unit and not clock.dated else " [s]" if clock.dated else ""), states.spin_period, BLUE)]
    if states.obliquity is not None:
        lines.append(("obliquity [°]", np.degrees(states.obliquity), VERMILION))
    lines.append(("ξ / ξ_sep", states.excess / separatrix(evolution, states.mode), GREEN))
    with plt.rc_context(STYLE):
        figure: Figure
        figure, axes = plt.subplots(len(lines), 1, sharex=True, layout="constrained", figsize=(7, 2.2 * len(lines)))
        for axis, (name, values, colour) in zip(axes, lines, strict=True):
            axis.plot(clock.values, values, color=colour)
            axis.set_ylabel(name)
        axes[-1].axhline(1.0, color=GREY, linestyle="--")
        axes[0].set_title(f"{states.mode} mode, ends: {evolution.end.reason}", loc="left")
        clock.finish(axes[-1])
    return figure


def separatrix(evolution: Evolution, mode: str | None) -> float:
    """The excess of energy on the separatrix."""
    least, middle, largest = sorted(evolution.scene.body.moments)
    return float(largest / middle - 1 if mode == "short-axis" else 1 - least / middle)
