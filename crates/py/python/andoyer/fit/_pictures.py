"""Pictures of a fit, for matplotlib. Colours are those of Okabe and Ito."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer.fit._observed import Light, Night
from andoyer.fit._summary import Quantity, with_deviation
from andoyer.interop._foreign import as_one, has_units
from andoyer.plot._style import BLACK, BLUE, GREEN, GREY, STYLE, VERMILION
from andoyer.plot._time import DAYS, HOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 2.4
"""Half the width of a panel, in standard deviations."""
ABSCISSAE = 181
NIGHTS = 12
"""Nights that are drawn; the title counts the rest."""
FLOOR = 0.1
"""Least Δχ² on the logarithmic axis, at which the best minimum is drawn."""
MARKERS = {"short-axis": "o", "long-axis": "s", "principal-axis": "^"}
SHORT = {"pole longitude": "pole λ", "pole latitude": "pole β", "phase μ": "μ", "phase ν": "ν", "phase μ + ν": "μ + ν", "period": "P"}
"""Names of quantities that are short enough for a panel."""


class Minimum(NamedTuple):
    """A minimum of χ² as it is drawn."""

    mode: str
    period: float
    delta_chi_square: float


def corner(parameters: tuple[str, ...], covariance: Array, figure: "Figure | None") -> "Figure":
    """The corner of the free parameters."""
    deviations = np.sqrt(np.diag(covariance))
    below = [f"{name}\n± {deviation:.2g}" for name, deviation in zip(parameters, deviations)]
    return _corner(parameters, below, covariance, figure, 1.1)


def quantity_corner(quantities: Sequence[Quantity], times: Any, figure: "Figure | None") -> "Figure":
    """The corner of quantities of the state, each with its value, standard deviation and unit."""
    ratios = any(quantity.name.startswith("axis ratio") for quantity in quantities)
    # The moments of an ellipsoid follow from the ratios of its axes.
    drawn = [quantity for quantity in quantities if not (ratios and quantity.name.startswith("moment"))]
    slopes = np.array([quantity.slopes for quantity in drawn])
    below, names = [], []
    for quantity in drawn:
        name = SHORT.get(quantity.name, quantity.name.removeprefix("axis ratio ").removeprefix("moment "))
        is_time = quantity.name in ("P_φ", "P_ψ", "period")
        size, unit = _unit(quantity.value) if is_time and _in_seconds(times) else (1.0, quantity.unit)
        number = with_deviation(quantity.value / size, quantity.deviation / size, "")
        names.append(f"{name} [{unit}]" if unit else name)
        below.append(f"{names[-1]}\n{number.replace(' ± ', chr(10) + '± ').replace('-', '−')}")
    return _corner(names, below, slopes @ slopes.T, figure, 1.2)


def _in_seconds(times: Any) -> bool:
    """Whether times have a unit; the fit then has seconds."""
    value = as_one("times", times)
    return hasattr(value, "jd1") or has_units(value)


def _unit(period: float) -> tuple[float, str]:
    """The unit of time for a period [s], in seconds, and its name."""
    return (86400.0, "d") if period > DAYS else (3600.0, "h") if period > HOURS / 4 else (1.0, "s")


def _corner(names: Sequence[str], below: Sequence[str], covariance: Array, figure: "Figure | None", size: float) -> "Figure":
    """Ellipses of one and two standard deviations of every pair, and the density of each alone. `below`: labels of the columns; `size`: of a panel [inch]."""
    plt: Any = extra("matplotlib.pyplot", "andoyer.fit")
    count = len(names)
    deviations = np.sqrt(np.diag(covariance))
    with plt.rc_context(STYLE):
        if figure is None:
            left, bottom = 0.5, 0.75
            side = size * count
            figure = plt.figure(figsize=(side + left, side + bottom))
            figure.subplots_adjust(left / (side + left), bottom / (side + bottom), 1 - 0.1 / side, 1 - 0.1 / side)
        panels = figure.subplots(count, count, squeeze=False)
        for row in range(count):
            for column in range(count):
                _panel(panels[row, column], covariance, deviations, (row, column))
            panels[row, 0].set_ylabel(names[row])
            panels[-1, row].set_xlabel(below[row])
    return figure


def _panel(axes: "Axes", covariance: Array, deviations: Array, place: tuple[int, int]) -> None:
    """One pair of parameters, in standard deviations from the best values."""
    row, column = place
    axes.set(xticks=[], yticks=[], xlim=(-WIDTH, WIDTH))
    if row < column:
        axes.axis("off")
    elif row == column:
        abscissa = np.linspace(-WIDTH, WIDTH, ABSCISSAE)
        axes.plot(abscissa, np.exp(-(abscissa**2) / 2), color=BLUE)
    else:
        pair = deviations[[column, row]]
        block = covariance[np.ix_([column, row], [column, row])] / np.outer(pair, pair) if np.all(pair > 0) else np.zeros((2, 2))
        values, vectors = np.linalg.eigh(block)
        angle = np.linspace(0, 2 * np.pi, ABSCISSAE)
        ellipse = vectors * np.sqrt(np.maximum(values, 0)) @ np.array([np.cos(angle), np.sin(angle)])
        for size, style in ((1, "-"), (2, "--")):
            axes.plot(*(size * ellipse), style, color=BLUE, linewidth=1)
        axes.set_ylim(-WIDTH, WIDTH)


def residuals(times: Any, values: Array, axes: "Axes | None") -> "Axes":
    """Residuals against time: three components of a rotation vector in degrees, or brightnesses."""
    plt: Any = extra("matplotlib.pyplot", "andoyer.fit")
    with plt.rc_context(STYLE):
        axes = plt.subplots(figsize=(8, 3.5), layout="constrained")[1] if axes is None else axes
    times = getattr(times, "datetime64", times)
    if values.ndim == 2:
        for component, color, marker, name in zip(np.degrees(values.T), (BLUE, VERMILION, GREEN), "os^", "123"):
            axes.plot(times, component, marker, color=color, markersize=4, label=f"about axis {name}")
        axes.set_ylabel("measured − model [°]")
        axes.legend(frameon=False, ncols=3)
    else:
        axes.plot(times, values, "o", color=BLUE, markersize=3)
        axes.set_ylabel("measured − model")
    axes.axhline(0, color="0.6", linewidth=0.8)
    axes.set_xlabel("time")
    return axes


def nights_picture(light: Light, figure: "Figure | None") -> "Figure":
    """Two panels for each night: the points with the model, and the residuals."""
    plt: Any = extra("matplotlib.pyplot", "andoyer.fit")
    times = as_one("times", light.data.times)
    in_seconds = _in_seconds(times)
    nights, count = light.nights(NIGHTS, in_seconds)
    columns = len(nights) if len(nights) <= 3 else int(np.ceil(np.sqrt(len(nights))))
    rows = -(-len(nights) // columns)
    size, unit = _axis(max(float(np.ptp(night.since)) for night in nights)) if in_seconds else (1.0, "time")
    several = len(np.unique(light.data.labels)) > 1
    magnitudes = light.data.photometry.zero is not None
    # Intensities of several curves have a unit each.
    alike = magnitudes or not several
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(max(6.0, 3.2 * columns + 0.6), 3.2 * rows + 0.8), layout="constrained") if figure is None else figure
        if figure.get_layout_engine() is None:
            figure.set_layout_engine("constrained")
        grid = figure.add_gridspec(rows, columns)
        lower = None
        for place, night in enumerate(nights):
            # The upper panel is three times as high.
            two = grid[place // columns, place % columns].subgridspec(2, 1, height_ratios=[3, 1])
            upper = figure.add_subplot(two[0])
            lower = figure.add_subplot(two[1], sharex=upper, sharey=lower if alike else None)
            _night(upper, lower, night, size)
            upper.set_title(_heading(night, times, several), loc="left")
            if place % columns == 0:
                upper.set_ylabel("magnitude" if magnitudes else "intensity")
                lower.set_ylabel("measured\n− model")
            if magnitudes:
                upper.invert_yaxis()
        if magnitudes and lower is not None:
            lower.invert_yaxis()
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2, fontsize="small")
        figure.align_ylabels([axes for axes in figure.axes if axes.get_ylabel()])
        figure.supxlabel(f"{unit} since the start of the night", fontsize=STYLE["font.size"])
        if count > len(nights):
            figure.suptitle(f"The first {len(nights)} of {count} nights: {count - len(nights)} are not drawn", fontsize=STYLE["axes.titlesize"])
    return figure


def _axis(longest: float) -> tuple[float, str]:
    """The unit of time of the nights [s] and its name."""
    return (60.0, "minutes") if longest < HOURS / 4 else (3600.0, "hours") if longest < 3 * 86400 else (86400.0, "days")


def _heading(night: Night, times: Any, several: bool) -> str:
    """When a night begins, and which curve it is of."""
    if hasattr(times, "jd1") and hasattr(times, "isot"):
        first = times[night.first]
        begin = f"{first.isot[:16].replace('T', ' ')} {first.scale.upper()}"
    else:
        first = times[night.first] if _in_seconds(times) else np.asarray(times)[night.first]
        begin = f"from {first.sec:.6g} s" if hasattr(first, "jd1") else f"from {first:.6g}"
    return f"curve {night.label:g}: {begin}" if several else begin


def _night(upper: "Axes", lower: "Axes", night: Night, size: float) -> None:
    """The points of a night and their residuals."""
    if len(night.fine) > len(night.since):
        upper.plot(night.fine / size, night.model, color=BLUE, linewidth=1.2, label="model")
    else:
        upper.plot(night.fine / size, night.model, "_", color=BLUE, markersize=9, label="model at the points")
    for axes, values, name in ((upper, night.measured, "measured"), (lower, night.residuals, None)):
        axes.errorbar(night.since / size, values, night.sigma, fmt="o", color=VERMILION, markersize=2.5, elinewidth=0.7, label=name)
    lower.axhline(0, color=GREY, linewidth=0.8)
    upper.tick_params(labelbottom=False)


def _tick(value: float, _place: float) -> str:
    """A number on the axis of Δχ²."""
    return f"≤ {FLOOR:g}" if value <= FLOOR else f"{value:g}"


def minima_picture(minima: Sequence[Minimum], near: float, times: Any, axes: "Axes | None") -> "Axes":
    """Δχ² of minima against their precession periods, the best first. `near`: Δχ² below which one is a rival."""
    plt: Any = extra("matplotlib.pyplot", "andoyer.fit")
    with plt.rc_context(STYLE):
        axes = plt.subplots(figsize=(8, 4.2), layout="constrained")[1] if axes is None else axes
    best = minima[0]
    size, unit = _unit(best.period) if _in_seconds(times) else (1.0, "")
    axes.plot([best.period / size], [FLOOR], MARKERS[best.mode], color=BLACK, markersize=11, label=f"{best.mode}, the best")
    for mode, marker in MARKERS.items():
        for rival, face, color in ((True, VERMILION, VERMILION), (False, "none", BLUE)):
            drawn = [minimum for minimum in minima[1:] if minimum.mode == mode and (minimum.delta_chi_square < near) == rival]
            if drawn:
                periods, heights = (np.array(values) for values in zip(*((one.period / size, max(one.delta_chi_square, FLOOR)) for one in drawn)))
                axes.plot(periods, heights, marker, color=color, markerfacecolor=face, markersize=6, label=f"{mode}, {'rival' if rival else 'no rival'}")
    axes.axhline(near, color=GREY, linestyle="--", linewidth=1, label=f"rivals below Δχ² = {near:.3g}")
    axes.set_yscale("log")
    axes.set_ylim(FLOOR / 2, 2 * max(near, *(minimum.delta_chi_square for minimum in minima)))
    axes.yaxis.set_major_formatter(_tick)
    axes.set_ylabel("Δχ²")
    axes.set_xlabel("precession period P_φ, of a simple rotation its period" + (f" [{unit}]" if unit else ""))
    axes.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1, 1))
    return axes
