"""Pictures of a fit, for matplotlib. Colours are those of Okabe and Ito."""

from typing import TYPE_CHECKING, Any

import numpy as np

from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer.plot._style import BLUE, GREEN, STYLE, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 2.4
"""Half the width of a panel, in standard deviations."""
ABSCISSAE = 181


def corner(parameters: tuple[str, ...], covariance: Array, figure: "Figure | None") -> "Figure":
    """Ellipses of one and two standard deviations of every pair of parameters, and the density of each alone."""
    plt: Any = extra("matplotlib.pyplot", "andoyer.fit")
    count = len(parameters)
    deviations = np.sqrt(np.diag(covariance))
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(1.1 * count + 1, 1.1 * count + 1)) if figure is None else figure
        panels = figure.subplots(count, count, squeeze=False)
        for row in range(count):
            for column in range(count):
                _panel(panels[row, column], covariance, deviations, (row, column))
            panels[row, 0].set_ylabel(parameters[row])
            panels[-1, row].set_xlabel(f"{parameters[row]}\n± {deviations[row]:.2g}")
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
