"""Pictures of a motion with matplotlib: polhode, phase portrait, angles, rates, path of the pole, librations.

Each function takes a `Motion`, and optionally times and the axes to draw into. It returns the axes; `summary` and the like return a figure. Angles are those of Andoyer
(theory §1), in degrees. The labels assume that times are in seconds. Lines on the far side of a surface are pale, grey lines are other motions of the same body, and the dashed line is the separatrix. The colours are
those of Okabe and Ito, which colour-blind readers can distinguish; lines also differ in style or marker. The module needs matplotlib, which ``pip install matplotlib`` installs.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Motion, Orbit, Samples
from andoyer._extra import extra
from andoyer._refusal import refusal
from andoyer.output.page import page
from andoyer.output.span import within_span
from andoyer.plot._compared import clock as _clock
from andoyer.plot._compared import components, difference, sampled_rates
from andoyer.plot._diagrams import axes_or_new as _axes
from andoyer.plot._diagrams import domain, error_by_order, work_precision
from andoyer.plot._drawing import near_pole, on_ellipsoid, plane
from andoyer.plot._drawing import surface as draw_surface
from andoyer.plot._film import film
from andoyer.plot._librations import libration_spectrum, libration_summary, librations, pole_librations
from andoyer.plot._style import ARCSECOND, BLUE, GREEN, STYLE, VERMILION, Array

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

plt: Any = extra("matplotlib.pyplot", "andoyer.plot")

TINY = 0.01
"""Amplitude J [rad] below which the polhode is a dot on the sphere, and angles are in microradians."""
STEADY = 1e-11
"""Variation [rad] of an angle below which it is rounding."""
TURNS, SAMPLES = 3, 3000
"""Periods of the polhode that are drawn if no times are given, and how many times."""

__all__ = [
    "angles",
    "animate",
    "components",
    "difference",
    "domain",
    "error_by_order",
    "libration_spectrum",
    "libration_summary",
    "librations",
    "nutation",
    "page",
    "phase_portrait",
    "pole_librations",
    "pole_path",
    "polhode",
    "polhode_near_pole",
    "rates",
    "sampled_rates",
    "samples_summary",
    "summary",
    "whole_turns",
    "work_precision",
]


def whole_turns(motion: Motion, turns: int = TURNS, samples: int = SAMPLES) -> Array:
    """Times over whole periods of the polhode from the epoch, or over whole rotations if the motion is steady. For an integrated motion they end with its span.

    Returns
    -------
    ndarray, shape (samples,)
        The times. For a body at rest they cover `turns` units of time.
    """
    precession, rotation = motion.periods["long-axis"]
    period = next((time for time in (rotation, precession) if math.isfinite(time)), 1.0)
    return np.linspace(*within_span(motion, motion.scene.epoch, motion.scene.epoch + turns * period), samples)


def polhode(motion: Motion, axes: Axes | None = None, *, surface: str = "sphere") -> Axes:
    """Draw the polhode with the separatrix, on the sphere of momentum directions or on Poinsot's inertia ellipsoid, axis 3 up.

    Parameters
    ----------
    motion : Motion
    axes : matplotlib.axes.Axes, optional
        By default those of a new figure.
    surface : {"sphere", "ellipsoid"}, optional
        The surface.

    Raises
    ------
    InputError
        An unknown surface (``"cube"``).
    """
    if surface not in ("sphere", "ellipsoid"):
        raise refusal("surface", surface, "sphere or ellipsoid", f'= {surface!r}: it must be "sphere" or "ellipsoid"')
    axes = _axes(axes)
    numbers, moments, directions = _sorted(motion, whole_turns(motion, 1))
    place = (lambda curve: curve) if surface == "sphere" else on_ellipsoid(moments)
    draw_surface(axes, moments, directions, place, _names(numbers))
    axes.set_title("Polhode on the momentum sphere" if surface == "sphere" else "Polhode on the inertia ellipsoid")
    return axes


def phase_portrait(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None) -> Axes:
    """Draw Andoyer's plane (ν, N/M): level curves of the energy, the separatrix, the motion and its start."""
    axes, times = _axes(axes), _times(motion, times)
    _, moments, directions = _sorted(motion, times)
    nu = np.arctan2(directions[:, 0], directions[:, 1])
    plane(axes, moments, nu, directions[:, 2])
    return axes


def polhode_near_pole(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None) -> Axes:
    """Draw the path of the angular momentum in the body near the axis of greatest inertia, for a motion with small J."""
    axes, times = _axes(axes), _times(motion, times)
    numbers, _, directions = _sorted(motion, times)
    near_pole(axes, directions, _names(numbers))
    return axes


def pole_path(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None) -> Axes:
    """Draw the inertial path of the direction of the angular momentum, in arcseconds from its start. Without a torque the path is a point.

    The default times are one period of the orbit, or the span for several bodies or a table. East is along z × k and north is from k towards z, where k is the first direction.
    """
    axes = _axes(axes)
    orbit, epoch = motion.scene.orbit, motion.scene.epoch
    one = orbit if isinstance(orbit, Orbit) else None
    stop = epoch + 2 * math.pi / one.mean_motion if one else math.inf
    reached = within_span(motion, epoch, stop)
    whole = times is None and one is not None and reached == (epoch, stop)
    if times is None and orbit is not None:
        times = np.linspace(*reached, SAMPLES)
    momentum = motion.angular_momentum(_times(motion, times))
    sizes = np.linalg.norm(momentum, axis=1, keepdims=True)
    directions = momentum / np.where(sizes > 0, sizes, 1)
    first = directions[0]
    east = np.array([-first[1], first[0], 0.0]) if math.hypot(first[0], first[1]) > 1e-9 else np.array([0.0, 1.0, 0.0])
    east /= np.linalg.norm(east)
    across = (directions - first) @ np.array([east, np.cross(first, east)]).T / ARCSECOND
    axes.plot(*across.T, color=BLUE, linewidth=1.4)
    axes.plot(*across[0], "o", color=BLUE, markersize=6, label="start")
    axes.plot(*across[-1], "s", color=VERMILION, markersize=6, label="end")
    axes.set(xlabel="east of where it starts [arcsec]", ylabel="north of where it starts [arcsec]")
    title = "without a torque" if orbit is None else "over one orbit" if whole else "under the gravity gradient"
    axes.set_title(f"Path of the angular momentum {title}", pad=22)
    axes.margins(0.1)
    axes.ticklabel_format(useOffset=False)
    _legend(axes)
    return axes


def nutation(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None) -> Axes:
    """Draw the nutation J, the angle from the angular momentum to the axis of greatest inertia, over time."""
    axes, times = _axes(axes), _times(motion, times)
    angle = _nutation(_sorted(motion, times)[2])
    tiny = angle.max() < TINY
    axes.plot(_clock(times)[0], 1e6 * angle if tiny else np.degrees(angle), color=BLUE)
    axes.set(xlabel=_clock(times)[1], ylabel="J [μrad]" if tiny else "J [deg]")
    axes.set_title("Nutation J: short axis from the angular momentum", loc="left")
    axes.margins(x=0)
    return axes


def angles(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, residual: bool = True) -> Axes:
    """Draw Andoyer's angles μ and ν over time without their mean motion, or ν itself.

    Parameters
    ----------
    motion : Motion
    times : array_like, shape (n,), optional
        Times [s]. By default three periods of the polhode. Each turn of an angle needs more than two times.
    axes : matplotlib.axes.Axes, optional
    residual : bool, optional
    """
    axes, times = _axes(axes), _times(motion, times)
    variables = motion.andoyer(times)
    elapsed, label, _ = _clock(times)
    mu, mu_rate, mu_all = _without_mean(variables[:, 1], times)
    nu, nu_rate, nu_all = _without_mean(variables[:, 2], times)
    if residual:
        axes.plot(elapsed, np.degrees(mu), color=VERMILION, linestyle="--", label="μ")
        axes.plot(elapsed, np.degrees(nu), color=BLUE, label="ν")
        axes.set_ylabel("[deg]")
        if max(np.ptp(mu), np.ptp(nu)) < STEADY:
            axes.set_ylim(-1e-6, 1e-6)
        axes.set_title("μ and ν less their mean motion", loc="left")
        _legend(axes)
    else:
        axes.plot(elapsed, np.degrees(nu_all), color=BLUE)
        if np.ptp(nu_all) > 2 * np.pi:
            axes.yaxis.set_major_locator(plt.MultipleLocator(360 * math.ceil(np.ptp(nu_all) / (8 * math.pi))))
        axes.set_ylabel("ν [deg]")
        axes.set_title(f"ν: period {_period(nu_all, nu_rate)}, μ: period {_period(mu_all, mu_rate)}", loc="left")
    axes.set_xlabel(label)
    axes.margins(x=0)
    return axes


def rates(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None) -> Axes:
    """Draw the angular velocity about the body axes over time. If J is tiny, the rate about the short axis is a text."""
    axes, times = _axes(axes), _times(motion, times)
    numbers, _, directions = _sorted(motion, times)
    values = motion.angular_velocity(times)
    elapsed, label, (unit, seconds) = _clock(times)
    tiny = _nutation(directions).max() < TINY
    unit, scale = (f"μrad/{unit}", 1e6 * seconds) if tiny else (f"deg/{unit}", np.degrees(seconds))
    styles = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."))
    drawn = sorted(numbers[:2]) if tiny else [0, 1, 2]
    for axis in drawn:
        color, style = styles[axis]
        axes.plot(elapsed, scale * values[:, axis], color=color, linestyle=style, label=f"ω{axis + 1}")
    steady = f", ω{numbers[2] + 1} = {values[:, numbers[2]].mean():.6g} rad/s" if tiny else ""
    axes.set(xlabel=label, ylabel=f"[{unit}]")
    axes.set_title(f"Body rates{steady}", loc="left")
    axes.margins(x=0)
    _legend(axes)
    return axes


def summary(motion: Motion, times: ArrayLike | None = None) -> Figure:
    """Draw a figure of a motion: polhode, phase portrait (the path near the pole if J is tiny, the inertial path of the pole under a torque), nutation, angles, rates.

    The labels assume times in seconds and show hours or days for long spans. The default times are three periods of the polhode.
    """
    times = _times(motion, times)
    scene = motion.scene
    tiny = _nutation(_sorted(motion, times)[2]).max() < TINY
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(13, 9), layout="constrained")
        figure.suptitle(scene.name or scene.body.name or "", fontsize=15, fontweight="bold")
        grid = figure.add_gridspec(4, 2, width_ratios=(1, 1.25))
        polhode(motion, figure.add_subplot(grid[:2, 0]))
        lower = figure.add_subplot(grid[2:, 0])
        if scene.orbit is not None:
            pole_path(motion, axes=lower)
        else:
            (polhode_near_pole if tiny else phase_portrait)(motion, times, lower)
        panels = [figure.add_subplot(grid[0, 1])]
        panels += [figure.add_subplot(grid[row, 1], sharex=panels[0]) for row in (1, 2, 3)]
        nutation(motion, times, panels[0])
        angles(motion, times, panels[1], residual=False)
        angles(motion, times, panels[2])
        rates(motion, times, panels[3])
        for panel in panels[:3]:
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)
        figure.align_ylabels(panels)
    return figure


def samples_summary(samples: Samples, motion: Motion | None = None, *, name: str = "") -> Figure:
    """Draw a figure of the samples of a file: quaternions, rates and, if a motion is given, the angle between the samples and the motion.

    Parameters
    ----------
    samples : Samples
        Times are taken to be in seconds.
    motion : Motion, optional
        The motion to compare with the samples.
    name : str, optional
        Title of the figure.
    """
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(11, 9 if motion else 6), layout="constrained")
        figure.suptitle(name, fontsize=15, fontweight="bold")
        panels = figure.subplots(3 if motion else 2, 1, sharex=True)
        components(samples, panels[0])
        sampled_rates(samples, panels[1])
        if motion is not None:
            difference(samples, motion, panels[2])
        for panel in panels[:-1]:
            panel.set_xlabel("")
        figure.align_ylabels(panels)
    return figure


def animate(motion: Motion, times: ArrayLike | None = None, *, interval: float = 40.0) -> FuncAnimation:
    """Animate a motion: body axes, angular momentum upwards, angular velocity, polhode and herpolhode. ``.save`` writes a film.

    Parameters
    ----------
    motion : Motion
    times : array_like, shape (n,), optional
        Times of the frames. By default 300 times over one period of the polhode.
    interval : float, optional
        Time between frames [ms].

    Examples
    --------
    >>> from andoyer import plot
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> plot.animate(motion, [0.0, 0.1, 0.2]).save("motion.gif", writer="pillow")
    """
    return film(motion, whole_turns(motion, 1, 300) if times is None else np.atleast_1d(np.asarray(times, dtype=float)), interval)


def _times(motion: Motion, times: ArrayLike | None) -> Array:
    return whole_turns(motion) if times is None else np.asarray(times, dtype=float)


def _sorted(motion: Motion, times: Array) -> tuple[list[int], Array, Array]:
    """The user's axes of moments A, B, C; these moments; directions of the momentum on them, axis 1 reversed as `Motion.andoyer` has it.

    The directions of a body at rest are NaN, which matplotlib does not draw.
    """
    body = motion.scene.body
    moments = body.moments
    order = np.argsort(moments, kind="stable")
    momentum = (moments * (motion.angular_velocity(times) @ body.principal_axes))[:, order]
    if _left_handed(order):
        momentum[:, 0] *= -1
    sizes = np.linalg.norm(momentum, axis=1, keepdims=True)
    return [int(axis) for axis in order], moments[order], momentum / np.where(sizes > 0, sizes, np.nan)


def _left_handed(order: Any) -> bool:
    return bool(np.linalg.det(np.eye(3)[order]) < 0)


def _names(numbers: list[int]) -> list[str]:
    """The numbers of the user's axes with moments A, B, C; a minus marks a reversed axis 1."""
    names = [str(number + 1) for number in numbers]
    return [f"−{names[0]}", *names[1:]] if _left_handed(numbers) else names


def _nutation(directions: Array) -> Array:
    """J from the components perpendicular to axis 3, because the arccosine of N/M is inaccurate for small J."""
    angle: Array = np.arctan2(np.hypot(directions[:, 0], directions[:, 1]), directions[:, 2])
    return angle


def _without_mean(angle: Array, times: Array) -> tuple[Array, float, Array]:
    """An angle [rad] less its mean motion, the mean motion [rad/s], the angle unwrapped.

    `times` span whole periods of the polhode, and sample every turn of the angle more than twice.
    """
    unwrapped = np.unwrap(angle)
    slope = (unwrapped[-1] - unwrapped[0]) / (times[-1] - times[0])
    rest = unwrapped - slope * (times - times[0])
    return rest - rest.mean(), slope, unwrapped


def _legend(axes: Axes) -> None:
    """A legend above the right end of a panel, outside of the curves."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, fontsize=9, frameon=False)


def _period(unwrapped: Array, rate: float) -> str:
    """The period of an angle of that mean motion, in seconds, hours or days, with its sense."""
    if np.ptp(unwrapped) < STEADY:
        return "none (constant)"
    if abs(unwrapped[-1] - unwrapped[0]) < np.pi:
        return "none (libration)"
    seconds = 2 * np.pi / abs(rate)
    unit, size = ("d", 86400) if seconds > 30 * 86400 else ("h", 3600) if seconds > 1800 else ("s", 1)
    value = f"{seconds / size:.5g} {unit}"
    return value if rate > 0 else f"{value} retrograde"
