"""Pictures of a libration: its angles over time, and the spectrum of its terms. Periods are in orbits, whatever the unit of time of the scene; so are times, unless the epoch is a date."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Libration, LibrationTerm, Motion
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.interop._foreign import plain
from andoyer.output.span import within_span
from andoyer.plot._diagrams import axes_or_new
from andoyer.plot._style import BLACK, BLUE, GREEN, GREY, STYLE, VERMILION, angular_unit
from andoyer.plot._time import clock_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SWINGS, LEAST_ORBITS, SAMPLES = 2, 5, 4000
"""Proper periods in longitude that are drawn if no times are given, at least so many orbits, and how many times."""
LINES = {"longitude": (BLUE, "-", "o", "ψ"), "pole-1": (VERMILION, "-", "^", "θ"), "pole-2": (GREEN, "--", "v", "φ")}
"""Colour, dash, marker and letter of each angle."""
ROUNDING = 1e-9
"""Part of the largest amplitude below which a term is not drawn."""


def librations(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, time_unit: str | None = None) -> Axes:
    """Draw the libration in longitude over time: the angle ψ of the long axis from the direction that turns with the resonance.

    Parameters
    ----------
    motion : Motion
        A motion by ``method="libration"``.
    times : array_like, shape (n,), optional
        Times in the unit of the scene. By default two proper periods in longitude from the epoch, at least five orbits.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.
    time_unit : str, optional
        The name of the unit of time of the scene, for an axis in this unit instead of orbits. A scene with a calendar epoch has dates.

    Raises
    ------
    InputError
        The motion is not a libration (``motion.libration`` is None).
    """
    axes = axes_or_new(axes)
    _angles(motion, times, axes, ["longitude"], time_unit)
    axes.set_title("Libration in longitude", loc="left")
    return axes


def pole_librations(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, time_unit: str | None = None) -> Axes:
    """Draw the libration of the pole over time: θ about the intermediate axis, and φ about the long axis.

    Parameters
    ----------
    motion, times, axes, time_unit
        As in `librations`.

    Raises
    ------
    InputError
        The motion is not a libration.
    """
    axes = axes_or_new(axes)
    _angles(motion, times, axes, ["pole-1", "pole-2"], time_unit)
    axes.set_title("Libration of the pole", loc="left")
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=2, fontsize=9, frameon=False)
    return axes


def libration_spectrum(motion: Motion, axes: Axes | None = None) -> Axes:
    """Draw the amplitude of each term of a libration against its period. Filled markers are free terms, open ones are terms that the orbit forces.

    The dotted lines are the proper periods. Constants are not drawn.

    Parameters
    ----------
    motion : Motion
        A motion by ``method="libration"``.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.

    Raises
    ------
    InputError
        The motion is not a libration.
    """
    libration, orbit = _locked(motion)
    axes = axes_or_new(axes)
    terms = _varying(libration)
    largest = max((term.amplitude for term in terms), default=1.0)
    terms = [term for term in terms if term.amplitude > ROUNDING * largest]
    size, unit = angular_unit(largest)
    for angle, (color, _, marker, letter) in LINES.items():
        for forced, kind in ((False, "free"), (True, "forced")):
            chosen = [term for term in terms if term.angle == angle and (not any(term.multiples[:3])) == forced]
            if not chosen:
                continue
            periods, sizes = np.array([(term.period / orbit, term.amplitude / size) for term in chosen]).T
            axes.vlines(periods, ROUNDING * largest / size, sizes, color=color, linewidth=0.7, alpha=0.35)
            face = "none" if forced else color
            axes.plot(periods, sizes, marker, color=color, markerfacecolor=face, markersize=7 if forced else 4, label=f"{letter}, {kind}")
    for name, period, amplitude in zip(("ψ", "θ, φ", "θ, φ"), libration.periods / orbit, libration.amplitudes, strict=True):
        if amplitude > ROUNDING * largest:
            axes.axvline(period, color=GREY, linestyle=":", linewidth=1.0, zorder=0)
            axes.annotate(name, (period, 1), (2, -2), xycoords=("data", "axes fraction"), textcoords="offset points", va="top", fontsize=8, color=BLACK)
    axes.set(xscale="log", yscale="log", xlabel="period [orbits]", ylabel=f"amplitude [{unit}]")
    if terms:
        axes.set_ylim(bottom=min(term.amplitude for term in terms) / size / 3)
    axes.set_title("Terms of the libration, and proper periods", loc="left", pad=22)
    if terms:
        axes.legend(loc="lower right", bbox_to_anchor=(1, 0.985), ncols=6, fontsize=8, frameon=False, columnspacing=0.8, handletextpad=0.1)
    return axes


def libration_summary(motion: Motion, times: ArrayLike | None = None, *, time_unit: str | None = None) -> Figure:
    """Draw a figure of a libration: longitude and pole over time, and the spectrum.

    Parameters
    ----------
    motion, times, time_unit
        As in `librations`.

    Raises
    ------
    InputError
        The motion is not a libration.
    """
    _locked(motion)
    plt: Any = extra("matplotlib.pyplot", "andoyer.plot")
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(10, 9), layout="constrained")
        figure.suptitle(motion.scene.name or motion.scene.body.name or "", fontsize=15, fontweight="bold")
        grid = figure.add_gridspec(3, 1, height_ratios=(1, 1, 1.5))
        upper = figure.add_subplot(grid[0])
        lower = figure.add_subplot(grid[1], sharex=upper)
        librations(motion, times, upper, time_unit=time_unit)
        pole_librations(motion, times, lower, time_unit=time_unit)
        libration_spectrum(motion, figure.add_subplot(grid[2]))
        upper.set_xlabel("")
        upper.tick_params(labelbottom=False)
        upper.xaxis.get_offset_text().set_visible(False)
    return figure


def _locked(motion: Motion) -> tuple[Libration, float]:
    """The libration of a motion, and the period of the orbit."""
    libration = motion.libration
    if libration is None:
        advice = f'is solved by method "{motion.plan.method}": a libration needs method="libration"'
        raise refusal("motion", motion.plan.method, "libration", advice)
    return libration, 2 * math.pi / libration.mean_motion


def _angles(motion: Motion, times: ArrayLike | None, axes: Axes, names: list[str], time_unit: str | None) -> None:
    libration, orbit = _locked(motion)
    epoch = motion.scene.epoch
    if times is None:
        span = max(SWINGS * libration.periods[0], LEAST_ORBITS * orbit)
        times = np.linspace(*within_span(motion, epoch, epoch + span), SAMPLES)
    instants = np.atleast_1d(np.asarray(plain("times", times), dtype=float))
    if not np.isfinite(instants).all():
        raise refusal("times", times, "finite numbers", "must be finite")
    values = {name: _sum([term for term in libration.terms() if term.angle == name], instants - epoch) for name in names}
    clock = clock_of(motion, instants, time_unit)
    if not clock.dated and time_unit is None:
        clock = clock._replace(values=(instants - epoch) / orbit, label="time from the epoch [orbits]")
    size, unit = angular_unit(max((float(np.abs(value).max()) for value in values.values() if value.size), default=0.0))
    for name, value in values.items():
        color, dash, _, letter = LINES[name]
        axes.plot(clock.values, value / size, color=color, linestyle=dash, linewidth=1.2, label=letter)
    axes.set_ylabel(f"{', '.join(LINES[name][3] for name in names)} [{unit}]")
    axes.ticklabel_format(axis="y", useOffset=False)
    clock.finish(axes)


def _sum(terms: list[LibrationTerm], elapsed: Array) -> Array:
    """The angle that terms add up to."""
    total = np.zeros_like(elapsed)
    for term in terms:
        total += term.amplitude * np.sin(term.phase + 2 * math.pi / term.period * elapsed)
    return total


def _varying(libration: Libration) -> list[LibrationTerm]:
    return [term for term in libration.terms() if math.isfinite(term.period)]
