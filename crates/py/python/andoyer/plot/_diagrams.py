"""Diagrams of accuracy: error by order of the series, time against error, domain of a normal form. The first two measure while they draw, relative to the closed form at its smallest tolerance."""

import time
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from andoyer._core import BirkhoffNormalForm, Motion, Scene, TheoryError, ToleranceWarning
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer.plot._style import BLUE, GREY, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

EPOCHS = 50
"""Times at which an error is taken."""
ROTATIONS = 20
"""Rotations over which errors are taken, where the scene has no span: those of a fixed order grow with time."""


@contextmanager
def missed_on_purpose() -> Iterator[None]:
    """Suppress warnings of missed tolerances, since the diagrams show the errors of low orders."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ToleranceWarning)
        yield


@missed_on_purpose()
def error_by_order(scene: Scene, orders: Iterable[int] = range(0, 31, 2), axes: "Axes | None" = None) -> "Axes":
    """Draw the largest attitude error of the series over 20 rotations against the order, with (σ/σ_sep)^(N+1) and the error bound of the closed form.

    The error is relative to the closed form. The dashed line is the error bound of the closed form; errors below it cannot be resolved.

    Parameters
    ----------
    scene : Scene
        The scene. Its method, order, tolerance and span are not used.
    orders : iterable of int, optional
        Orders of the series.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.

    Raises
    ------
    TheoryError
        The motion is on the separatrix, where the series do not exist.
    """
    axes = axes_or_new(axes)
    chosen = list(orders)
    closed, times, truth = _truth(scene)
    errors = [_largest_angle(truth, _variant(scene, method="series", order=order).solve().attitude(times)) for order in chosen]
    ratio = closed.plan.separatrix_ratio
    axes.semilogy(chosen, np.maximum(errors, 1e-17), "o-", color=BLUE, markersize=4, label="series")
    axes.semilogy(chosen, [ratio ** (order + 1) for order in chosen], ":", color=VERMILION, label="(σ/σ_sep)$^{N+1}$")
    axes.axhline(closed.plan.error_bound, color=GREY, linestyle="--", label="bound of the closed form")
    axes.set(xlabel="order N", ylabel="largest attitude error [rad]", title=f"Error of the series by order, σ/σ_sep = {ratio:.3g}")
    axes.set_ylim(bottom=closed.plan.error_bound / 100)
    axes.legend(frameon=False)
    return axes


@missed_on_purpose()
def work_precision(scene: Scene, orders: Iterable[int] = range(0, 21, 2), axes: "Axes | None" = None) -> "Axes":
    """Draw the time of solving against the error: the series by order, the closed form by tolerance. The accuracy increases to the right.

    Errors below the error bound of the closed form cannot be resolved and are drawn at the bound.

    Parameters
    ----------
    scene : Scene
        The scene. Its method, order, tolerance and span are not used.
    orders : iterable of int, optional
        Orders of the series.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.
    """
    axes = axes_or_new(axes)
    best, times, truth = _truth(scene)
    series = [_variant(scene, method="series", order=order) for order in orders]
    closed = [_variant(scene, method="closed", tolerance=tolerance) for tolerance in (1e-3, 1e-6, 1e-9, 1e-12, 1e-15)]
    for label, variants, style in (("series, by order", series, ("o-", BLUE)), ("closed form, by tolerance", closed, ("*--", VERMILION))):
        points = []
        for variant in variants:
            try:
                seconds, motion = _timed(variant)
            except TheoryError:
                continue
            error = max(_largest_angle(truth, motion.attitude(times)), best.plan.error_bound)
            points.append((error, 1e6 * seconds))
        if points:
            axes.loglog(*zip(*points), style[0], color=style[1], markersize=5, label=label)
    axes.set(xlabel="largest attitude error [rad]", ylabel="time of solving [μs]", title="What accuracy costs")
    axes.set_xlim(*sorted(axes.get_xlim(), reverse=True))
    axes.legend(frameon=False)
    return axes


def domain(
    normal_form: BirkhoffNormalForm,
    amplitudes: Iterable[float] = (0.05, 0.1, 0.2, 0.5),
    axes: "Axes | None" = None,
    *,
    parameters: dict[str, float] | None = None,
) -> "Axes":
    """Draw the sizes of the orders of a normal form at some amplitudes. A star marks the best order of each amplitude.

    Parameters
    ----------
    normal_form : BirkhoffNormalForm
        The normal form.
    amplitudes : iterable of float, optional
        Amplitudes √(2|I|) of all modes.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.
    parameters : dict of {str: float}, optional
        Numbers for the parameters of the form.
    """
    axes, estimate = axes_or_new(axes), normal_form.domain(parameters)
    for amplitude, style in zip(amplitudes, cycle(("-", "--", "-.", ":"))):
        sizes = estimate.sizes(amplitude)
        drawn = [(order, size) for order, size in enumerate(sizes, 1) if size > 0]
        if not drawn:
            continue
        (line,) = axes.semilogy(*zip(*drawn), style, marker=".", label=f"amplitude {amplitude:g}")
        best = estimate.best_order(amplitude)
        axes.semilogy(best, sizes[best - 1], "*", markersize=11, color=line.get_color())
    axes.set(xlabel="order", ylabel="size of the order", title="How far the normal form is good")
    axes.legend(frameon=False)
    return axes


def axes_or_new(axes: "Axes | None") -> "Axes":
    """The axes, by default those of a new figure."""
    if axes is not None:
        return axes
    plt: Any = extra("matplotlib.pyplot", "andoyer.plot")
    new: Axes = plt.subplots(layout="constrained")[1]
    return new


def _variant(scene: Scene, **options: Any) -> Scene:
    """The free motion of the scene with other options."""
    return Scene(scene.body, scene.attitude, scene.angular_velocity, epoch=scene.epoch, name=scene.name, **options)


def _truth(scene: Scene) -> tuple[Motion, Array, Array]:
    """The closed form at its smallest tolerance, times, and its attitudes at these times."""
    motion = _variant(scene, method="closed", tolerance=1e-15).solve()
    rotation = motion.periods["long-axis"].precession
    times = scene.epoch + np.linspace(0, ROTATIONS * rotation, EPOCHS)
    return motion, times, motion.attitude(times)


def _largest_angle(first: Array, second: Array) -> float:
    """The largest angle between attitudes, from the vector part of the relative quaternion, which is accurate for small angles."""
    v, w = first[:, :3], first[:, 3:]
    difference = second * np.sign(np.sum(first * second, axis=1, keepdims=True)) - first
    vector = w * difference[:, :3] - v * difference[:, 3:] - np.cross(v, difference[:, :3])
    return float(2 * np.arcsin(np.minimum(np.linalg.norm(vector, axis=1), 1)).max())


def _timed(scene: Scene) -> tuple[float, Motion]:
    """The least of five times of solving [s], and the motion."""
    spans = []
    for _ in range(5):
        start = time.perf_counter()
        motion = scene.solve()
        spans.append(time.perf_counter() - start)
    return min(spans), motion
