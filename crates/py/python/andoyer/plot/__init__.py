"""Pictures of a motion with matplotlib: polhode, phase portrait, angles, rates, path of the pole, librations, roll, pitch and yaw against the orbital frame.

Each function takes a `Motion`, and optionally times and the axes to draw into. It returns the axes; `summary` and the like return a figure. Angles are those of Andoyer
(theory §1), in degrees. Time axes have calendar dates if the epoch of the scene is a date. Otherwise they have the times of the scene, and `time_unit` names their unit. Without `times` a motion that
is not periodic is drawn over its whole span: under user torques, beside a hyperbola, a table or several bodies; and so is one that turns with its orbit, as a satellite does. Lines on the far side of a surface are pale, grey lines are other motions of the same body, and the dashed line is the separatrix. The colours are
those of Okabe and Ito, which colour-blind readers can distinguish; lines also differ in style or marker. The module needs matplotlib, which ``pip install matplotlib`` installs.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Motion, Orbit, Samples
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.output.page import page
from andoyer.output.span import within_span
from andoyer.plot._compared import components, difference, sampled_rates
from andoyer.plot._diagrams import axes_or_new as _axes
from andoyer.plot._diagrams import domain, error_by_order, work_precision
from andoyer.plot._distribution import distribution
from andoyer.plot._drawing import near_pole, on_ellipsoid, plane
from andoyer.plot._drawing import surface as draw_surface
from andoyer.plot._evolution import evolution
from andoyer.plot._film import film
from andoyer.plot._librations import libration_spectrum, libration_summary, librations, pole_librations
from andoyer.plot._mode import about, in_order, is_still, mode_axis, names, nutation_angle, precession_and_spin, without_mean
from andoyer.plot._orbital import Whose, angles_against, orbital
from andoyer.plot._style import BLUE, GREEN, STYLE, VERMILION, angular_unit
from andoyer.plot._time import SAMPLES, Clock, chosen, clock_of, is_periodic, turns_with_orbit, whole_span, whole_turns

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

plt: Any = extra("matplotlib.pyplot", "andoyer.plot")

TINY = 0.01
"""Amplitude J [rad] below which the polhode is a dot on the sphere, and angles are in microradians."""
STEADY = 1e-11
"""Variation [rad] of an angle below which it is rounding."""
ROUNDED = 1e-7
"""Length [arcsec] of a path of the pole below which it is rounding."""

__all__ = [
    "angles",
    "animate",
    "components",
    "difference",
    "distribution",
    "domain",
    "error_by_order",
    "evolution",
    "libration_spectrum",
    "libration_summary",
    "librations",
    "nutation",
    "orbital",
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
    numbers, moments, directions = in_order(motion, chosen(motion, None, 1))
    place = (lambda curve: curve) if surface == "sphere" else on_ellipsoid(moments)
    draw_surface(axes, moments, directions, place, names(numbers))
    axes.set_title("Polhode on the momentum sphere" if surface == "sphere" else "Polhode on the inertia ellipsoid")
    return axes


def phase_portrait(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, axis: str = "short-axis") -> Axes:
    """Draw Andoyer's plane (ν, N/M): level curves of the energy, the separatrix, the motion and its start. With ``axis="long-axis"`` ν, N and J are about the long axis."""
    axes, times = _axes(axes), chosen(motion, times)
    _, moments, directions = about(motion, times, axis)
    nu = np.arctan2(directions[:, 0], directions[:, 1])
    plane(axes, moments, nu, directions[:, 2])
    if axis == "long-axis":
        axes.set_title("Plane (ν, N/M) about the long axis")
    return axes


def polhode_near_pole(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, axis: str = "short-axis") -> Axes:
    """Draw the path of the angular momentum in the body near the axis of greatest inertia, for a motion with small J, or near that of least inertia with ``axis="long-axis"``."""
    axes, times = _axes(axes), chosen(motion, times)
    numbers, _, directions = about(motion, times, axis)
    near_pole(axes, directions, names(numbers))
    return axes


def pole_path(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None) -> Axes:
    """Draw the inertial path of the direction of the angular momentum, in arcseconds or degrees from its start. Without a torque the path is a point.

    The default times are one period of an elliptic orbit. A motion that is not periodic, or that turns with its orbit, is drawn over its whole span. East is along z × k and north is from k towards z, where k is the first direction.
    """
    axes = _axes(axes)
    times, title = (chosen(motion, times), "under the torques") if times is not None else _over(motion)
    momentum = motion.angular_momentum(times)
    sizes = np.linalg.norm(momentum, axis=1, keepdims=True)
    directions = momentum / np.where(sizes > 0, sizes, 1)
    first = directions[0]
    east = np.array([-first[1], first[0], 0.0]) if math.hypot(first[0], first[1]) > 1e-9 else np.array([0.0, 1.0, 0.0])
    east /= np.linalg.norm(east)
    across = (directions - first) @ np.array([east, np.cross(first, east)]).T
    size, unit = angular_unit(float(np.abs(across).max()), 1.0)
    across /= size
    axes.plot(*across.T, color=BLUE, linewidth=1.4)
    axes.plot(*across[0], "o", color=BLUE, markersize=6, label="start")
    axes.plot(*across[-1], "s", color=VERMILION, markersize=6, label="end")
    axes.set(xlabel=f"east of where it starts [{unit}]", ylabel=f"north of where it starts [{unit}]")
    scene = motion.scene
    forces = "under the gravity gradient" if title == "under the torques" and not scene.torques else title
    axes.set_title(f"Path of the angular momentum {'without a torque' if scene.orbit is None and not scene.torques else forces}", pad=22)
    axes.margins(0.1)
    if float(np.abs(across).max()) < ROUNDED and unit == "arcsec":
        axes.set(xlim=(-1, 1), ylim=(-1, 1))
    axes.ticklabel_format(useOffset=False)
    _legend(axes)
    return axes


def _over(motion: Motion) -> tuple[Array, str]:
    """The times of the path of the pole if none are given, and over what they are."""
    scene = motion.scene
    periodic = is_periodic(motion) and not turns_with_orbit(motion)
    if periodic and isinstance(scene.orbit, Orbit):
        stop = scene.epoch + 2 * math.pi / scene.orbit.mean_motion
        reached = within_span(motion, scene.epoch, stop)
        return np.linspace(*reached, SAMPLES), "over one orbit" if reached == (scene.epoch, stop) else "under the torques"
    if periodic or scene.span is None:
        return whole_turns(motion), "under the torques"
    spanned = whole_span(motion)
    return np.linspace(*scene.span, SAMPLES) if spanned is None else spanned, "over the span"


def nutation(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, axis: str = "short-axis", time_unit: str | None = None) -> Axes:
    """Draw the nutation J, the angle from the angular momentum to the axis of greatest inertia, over time.

    Parameters
    ----------
    motion : Motion
    times : array_like, shape (n,), optional
        Times of the scene. By default three periods of the polhode, or the whole span of a motion that is not periodic.
    axes : matplotlib.axes.Axes, optional
    axis : {"short-axis", "long-axis"}, optional
        The axis: that of greatest or that of least inertia.
    time_unit : str, optional
        The name of the unit of time of the scene, for example "h". A scene with a calendar epoch has dates instead.
    """
    axes, times = _axes(axes), chosen(motion, times)
    clock = clock_of(motion, times, time_unit)
    angle = nutation_angle(about(motion, times, axis)[2])
    tiny = angle.max() < TINY
    axes.plot(clock.values, 1e6 * angle if tiny else np.degrees(angle), color=BLUE)
    axes.set_ylabel("J [μrad]" if tiny else "J [deg]")
    axes.set_title(f"Nutation J: {axis.replace('-', ' ')} from the angular momentum", loc="left")
    clock.finish(axes)
    return axes


def angles(
    motion: Motion,
    times: ArrayLike | None = None,
    axes: Axes | None = None,
    *,
    residual: bool = True,
    axis: str = "short-axis",
    time_unit: str | None = None,
) -> Axes:
    """Draw Andoyer's angles μ and ν over time without their mean motion, or ν itself.

    Parameters
    ----------
    motion : Motion
    times : array_like, shape (n,), optional
        As in `nutation`. Each turn of an angle needs more than two times.
    axes : matplotlib.axes.Axes, optional
    residual : bool, optional
    axis, time_unit
        As in `nutation`; about the long axis ν is the rotation about it, and μ its precession.
    """
    axes, times = _axes(axes), chosen(motion, times)
    clock = clock_of(motion, times, time_unit)
    of_mu, of_nu = (without_mean(angle, times) for angle in precession_and_spin(motion, times, axis))
    if residual:
        axes.plot(clock.values, np.degrees(of_mu[0]), color=VERMILION, linestyle="--", label="μ")
        axes.plot(clock.values, np.degrees(of_nu[0]), color=BLUE, label="ν")
        axes.set_ylabel("[deg]")
        if max(np.ptp(of_mu[0]), np.ptp(of_nu[0])) < STEADY:
            axes.set_ylim(-1e-6, 1e-6)
        axes.set_title("μ and ν less their mean motion", loc="left")
        _legend(axes)
    else:
        nu = of_nu[2]
        axes.plot(clock.values, np.degrees(nu), color=BLUE)
        if np.ptp(nu) > 2 * np.pi:
            axes.yaxis.set_major_locator(plt.MultipleLocator(360 * math.ceil(np.ptp(nu) / (8 * math.pi))))
        axes.set_ylabel("ν [deg]")
        axes.set_title(f"ν: period {_period(of_nu, clock)}, μ: period {_period(of_mu, clock)}", loc="left")
    clock.finish(axes)
    return axes


def rates(motion: Motion, times: ArrayLike | None = None, axes: Axes | None = None, *, axis: str = "short-axis", time_unit: str | None = None) -> Axes:
    """Draw the angular velocity about the body axes over time. If J is tiny, the rate about `axis` is a text. Arguments are as in `nutation`."""
    axes, times = _axes(axes), chosen(motion, times)
    numbers, _, directions = about(motion, times, axis)
    values = motion.angular_velocity(times)
    clock = clock_of(motion, times, time_unit)
    tiny = nutation_angle(directions).max() < TINY
    unit, scale = (f"μrad{clock.per}", 1e6 * clock.seconds) if tiny else (f"deg{clock.per}", np.degrees(clock.seconds))
    styles = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."))
    drawn = sorted(numbers[:2]) if tiny else [0, 1, 2]
    for number in drawn:
        color, style = styles[number]
        axes.plot(clock.values, scale * values[:, number], color=color, linestyle=style, label=f"ω{number + 1}")
    steady = f", ω{numbers[2] + 1} = {values[:, numbers[2]].mean() * clock.seconds:.6g} rad{clock.per}" if tiny else ""
    axes.set_ylabel(f"[{unit}]")
    axes.set_title(f"Body rates{steady}", loc="left")
    clock.finish(axes)
    _legend(axes)
    return axes


def summary(motion: Motion, times: ArrayLike | None = None, *, elements_of: Whose | None = None, time_unit: str | None = None) -> Figure:
    """Draw a figure of a motion: polhode, phase portrait (the path near the pole if J is tiny, the inertial path of the pole under a torque), nutation, angles, rates.

    With `elements_of` it is the figure of a satellite: roll, pitch and yaw against the frame "lvlh" and the rate against it, the body rates, and the inertial path of the angular momentum.

    The panels are about the axis that the angular momentum circles at the epoch: the short axis, or the long axis of a body in a long-axis mode. The default times are three periods of the
    polhode, or the whole span of a motion that is not periodic or that turns with its orbit.

    Parameters
    ----------
    motion, times, time_unit
        As in `nutation`.
    elements_of : {"rotating", "disturbing"}, optional
        Whose orbit the scene has, as in `Scene.from_orbital`. With it the angles are those of `orbital`.

    Raises
    ------
    InputError
        An unknown `elements_of`, or one of a scene without an orbit.
    """
    if elements_of is not None:
        return _of_satellite(motion, times, elements_of, time_unit)
    times = chosen(motion, times)
    scene, axis = motion.scene, mode_axis(motion)
    tiny = nutation_angle(about(motion, times, axis)[2]).max() < TINY
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(13, 9), layout="constrained")
        figure.suptitle(scene.name or scene.body.name or "", fontsize=15, fontweight="bold")
        grid = figure.add_gridspec(4, 2, width_ratios=(1, 1.25))
        polhode(motion, figure.add_subplot(grid[:2, 0]))
        lower = figure.add_subplot(grid[2:, 0])
        if scene.orbit is not None or scene.torques:
            pole_path(motion, axes=lower)
        else:
            (polhode_near_pole if tiny else phase_portrait)(motion, times, lower, axis=axis)
        panels = [figure.add_subplot(grid[0, 1])]
        panels += [figure.add_subplot(grid[row, 1], sharex=panels[0]) for row in (1, 2, 3)]
        nutation(motion, times, panels[0], axis=axis, time_unit=time_unit)
        angles(motion, times, panels[1], residual=False, axis=axis, time_unit=time_unit)
        angles(motion, times, panels[2], axis=axis, time_unit=time_unit)
        rates(motion, times, panels[3], axis=axis, time_unit=time_unit)
        for panel in panels[:3]:
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)
            panel.xaxis.get_offset_text().set_visible(False)
        figure.align_ylabels(panels)
    return figure


def _of_satellite(motion: Motion, times: ArrayLike | None, elements_of: Whose, time_unit: str | None) -> Figure:
    """The figure of a motion against its orbit."""
    # Refused before there is a figure.
    motion.orbital(motion.scene.epoch, elements_of=elements_of)
    asked = {"elements_of": elements_of, "frame": "lvlh", "sequence": "ZYX", "of": 0}
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(13, 9), layout="constrained")
        halves: Any = figure.subfigures(1, 2, width_ratios=(1, 1.25))
        left, right = halves
        path, body = left.subplots(2, 1)
        name, drawn = angles_against(motion, times, list(right.subplots(4, 1, sharex=True)), asked, time_unit)
        figure.suptitle(name, fontsize=15, fontweight="bold")
        pole_path(motion, drawn, path)
        rates(motion, drawn, body, time_unit=time_unit)
    return figure


def samples_summary(samples: Samples, motion: Motion | None = None, *, name: str = "", time_unit: str | None = None) -> Figure:
    """Draw a figure of the samples of a file: quaternions, rates and, if a motion is given, the angle between the samples and the motion.

    Parameters
    ----------
    samples : Samples
    motion : Motion, optional
        The motion to compare with the samples.
    name : str, optional
        Title of the figure.
    time_unit : str, optional
        The name of the unit of the times. Samples with calendar times have dates instead.
    """
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(11, 9 if motion else 6), layout="constrained")
        figure.suptitle(name, fontsize=15, fontweight="bold")
        panels = figure.subplots(3 if motion else 2, 1, sharex=True)
        components(samples, panels[0], time_unit=time_unit)
        sampled_rates(samples, panels[1], time_unit=time_unit)
        if motion is not None:
            difference(samples, motion, panels[2], time_unit=time_unit)
        for panel in panels[:-1]:
            panel.set_xlabel("")
            panel.xaxis.get_offset_text().set_visible(False)
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
    return film(motion, whole_turns(motion, 1, 300) if times is None else np.atleast_1d(chosen(motion, times)), interval)


def _legend(axes: Axes) -> None:
    """A legend above the right end of a panel, outside of the curves."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, fontsize=9, frameon=False)


def _period(angle: tuple[Array, float, Array], clock: Clock) -> str:
    """The period of an angle less its mean motion, its mean motion and itself unwrapped, with its sense."""
    _, rate, unwrapped = angle
    if np.ptp(unwrapped) < STEADY:
        return "none (constant)"
    if is_still(unwrapped):
        return "none (libration)"
    value = clock.period(2 * np.pi / abs(rate))
    return value if rate > 0 else f"{value} retrograde"
