"""Pictures of a motion, for matplotlib: polhode, phase portrait, angles, rates, the path of the pole.

Each function takes a `Motion`, optionally times and the axes to draw into, and returns the axes; `summary` composes a figure. Angles are Andoyer's,
theory §1, shown in degrees; times are taken to be in seconds; lines on the far side of a surface are pale, grey lines are other motions of the same body, the dashed line is the separatrix. Colours are
those of Okabe and Ito, safe for colour-blind readers, and no line is told from another by colour alone. Needs matplotlib: the extra ``andoyer[plot]``.
"""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._core import Motion
from andoyer._extra import extra

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

plt: Any = extra("matplotlib.pyplot", "plot", "andoyer.plot")

_Array = NDArray[np.float64]

BLUE, VERMILION, GREEN, BLACK, GREY = "#0072B2", "#D55E00", "#009E73", "#222222", "#9A9A9A"
TINY = 0.01
"""Amplitude J [rad] below which the polhode is a dot on the sphere, and angles are in microradians."""
ARCSECOND = math.pi / 648000
STYLE = {"font.size": 10, "axes.titlesize": 10.5, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}
TURNS, SAMPLES = 3, 3000
"""Periods of the polhode that are drawn if no times are given, and how many times."""

__all__ = ["angles", "nutation", "phase_portrait", "polhode", "polhode_near_pole", "pole_path", "rates", "summary", "whole_turns"]


def whole_turns(motion: Motion, turns: int = TURNS, samples: int = SAMPLES) -> _Array:
    """Times over whole periods of the polhode from the epoch, or of the rotation where there is no polhode.

    Returns
    -------
    ndarray, shape (samples,)
        A unit of time for a body at rest.
    """
    precession, rotation = motion.periods["long-axis"]
    period = next((time for time in (rotation, precession) if math.isfinite(time)), 1.0)
    return motion.scene.epoch + np.linspace(0, turns * period, samples)


def polhode(motion: Motion, axes: "Axes | None" = None, *, surface: str = "sphere") -> "Axes":
    """The polhode with the separatrix, on the sphere of momentum directions or on the inertia ellipsoid of Poinsot, axis 3 up.

    Parameters
    ----------
    motion : Motion
    axes : matplotlib.axes.Axes, optional
        By default those of a new figure.
    surface : {"sphere", "ellipsoid"}, optional

    Raises
    ------
    ValueError
        ``surface="cube"``.
    """
    if surface not in ("sphere", "ellipsoid"):
        raise ValueError(f'surface = {surface!r}: it must be "sphere" or "ellipsoid"')
    axes = _axes(axes)
    numbers, moments, directions = _sorted(motion, whole_turns(motion, 1))
    place = (lambda curve: curve) if surface == "sphere" else _on_ellipsoid(moments)
    _surface(axes, moments, directions, place, _names(numbers))
    axes.set_title("Polhode on the momentum sphere" if surface == "sphere" else "Polhode on the inertia ellipsoid")
    return axes


def phase_portrait(motion: Motion, times: ArrayLike | None = None, axes: "Axes | None" = None) -> "Axes":
    """Andoyer's plane (ν, N/M): level curves of the energy, the separatrix, the motion and where it starts."""
    axes, times = _axes(axes), _times(motion, times)
    _, moments, directions = _sorted(motion, times)
    nu = np.arctan2(directions[:, 0], directions[:, 1])
    _plane(axes, moments, nu, directions[:, 2])
    return axes


def polhode_near_pole(motion: Motion, times: ArrayLike | None = None, axes: "Axes | None" = None) -> "Axes":
    """The path of the angular momentum in the body, near the axis of greatest inertia: of a motion whose J is small."""
    axes, times = _axes(axes), _times(motion, times)
    numbers, _, directions = _sorted(motion, times)
    _near_pole(axes, directions, _names(numbers))
    return axes


def pole_path(motion: Motion, times: ArrayLike | None = None, axes: "Axes | None" = None) -> "Axes":
    """The path of the angular momentum's direction among the stars, in arcseconds from where it starts: a point without a torque.

    By default over one period of the orbit, if there is one. East is along z × k, north from k towards z, with k the first direction.
    """
    axes = _axes(axes)
    orbit = motion.scene.orbit
    if times is None and orbit is not None:
        times = motion.scene.epoch + np.linspace(0, 2 * math.pi / orbit.mean_motion, SAMPLES)
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
    axes.set(xlabel="east, along z × k [arcsec]", ylabel="north, towards z [arcsec]")
    title = "without a torque" if orbit is None else "under the gravity gradient"
    axes.set_title(f"Path of the angular momentum {title}", pad=22)
    axes.margins(0.1)
    axes.ticklabel_format(useOffset=False)
    _legend(axes)
    return axes


def nutation(motion: Motion, times: ArrayLike | None = None, axes: "Axes | None" = None) -> "Axes":
    """The nutation J, of the axis of greatest inertia from the angular momentum, over time."""
    axes, times = _axes(axes), _times(motion, times)
    angle = _nutation(_sorted(motion, times)[2])
    tiny = angle.max() < TINY
    axes.plot(_clock(times)[0], 1e6 * angle if tiny else np.degrees(angle), color=BLUE)
    axes.set(xlabel=_clock(times)[1], ylabel="J [μrad]" if tiny else "J [deg]")
    axes.set_title("Nutation J: short axis from the angular momentum", loc="left")
    axes.margins(x=0)
    return axes


def angles(motion: Motion, times: ArrayLike | None = None, axes: "Axes | None" = None, *, residual: bool = True) -> "Axes":
    """Andoyer's angles μ and ν over time, less their mean motion, or ν as it is.

    Parameters
    ----------
    motion : Motion
    times : array_like, shape (n,), optional
        By default three periods of the polhode. Each turn of an angle must be sampled more than twice.
    axes : matplotlib.axes.Axes, optional
    residual : bool, optional
    """
    axes, times = _axes(axes), _times(motion, times)
    variables = motion.andoyer(times)
    elapsed, label, _ = _clock(times)
    mu, mu_rate, _ = _without_mean(variables[:, 1], times)
    nu, nu_rate, nu_all = _without_mean(variables[:, 2], times)
    if residual:
        axes.plot(elapsed, np.degrees(mu), color=VERMILION, linestyle="--", label="μ")
        axes.plot(elapsed, np.degrees(nu), color=BLUE, label="ν")
        axes.set_ylabel("[deg]")
        axes.set_title("μ and ν less their mean motion", loc="left")
        _legend(axes)
    else:
        axes.plot(elapsed, np.degrees(nu_all), color=BLUE)
        if np.ptp(nu_all) > 2 * np.pi:
            axes.yaxis.set_major_locator(plt.MultipleLocator(360 * math.ceil(np.ptp(nu_all) / (8 * math.pi))))
        axes.set_ylabel("ν [deg]")
        axes.set_title(f"ν: period {_period(nu_rate, times)}, μ: period {_period(mu_rate, times)}", loc="left")
    axes.set_xlabel(label)
    axes.margins(x=0)
    return axes


def rates(motion: Motion, times: ArrayLike | None = None, axes: "Axes | None" = None) -> "Axes":
    """Angular velocity about the body's axes over time; where J is tiny, that about the short axis in words."""
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


def summary(motion: Motion, times: ArrayLike | None = None) -> "Figure":
    """A figure of a motion: polhode, phase portrait (near the pole, if J is tiny; under a torque, the pole's path), nutation, angles, rates.

    Times are taken to be in seconds, and are shown in hours or days; by default they cover three periods of the polhode.
    """
    times = _times(motion, times)
    scene = motion.scene
    tiny = _nutation(_sorted(motion, times)[2]).max() < TINY
    with plt.rc_context(STYLE):
        figure: "Figure" = plt.figure(figsize=(13, 9), layout="constrained")
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
        plt.close(figure)
    return figure


def _axes(axes: "Axes | None") -> "Axes":
    return plt.figure(layout="constrained").add_subplot() if axes is None else axes


def _times(motion: Motion, times: ArrayLike | None) -> _Array:
    return whole_turns(motion) if times is None else np.asarray(times, dtype=float)


def _sorted(motion: Motion, times: _Array) -> tuple[list[int], _Array, _Array]:
    """The user's axes of moments A, B, C; these moments; directions of the momentum on them, axis 1 reversed as `Motion.andoyer` has it.

    A body at rest has no direction: NaN, which matplotlib leaves out.
    """
    moments = motion.scene.body.moments
    order = np.argsort(moments, kind="stable")
    momentum = (moments * motion.angular_velocity(times))[:, order]
    if _left_handed(order):
        momentum[:, 0] *= -1
    sizes = np.linalg.norm(momentum, axis=1, keepdims=True)
    return [int(axis) for axis in order], moments[order], momentum / np.where(sizes > 0, sizes, np.nan)


def _left_handed(order: Any) -> bool:
    return bool(np.linalg.det(np.eye(3)[order]) < 0)


def _names(numbers: list[int]) -> list[str]:
    """What the axes of moments A, B, C are called among the user's: with a minus where axis 1 is reversed."""
    names = [str(number + 1) for number in numbers]
    return [f"−{names[0]}", *names[1:]] if _left_handed(numbers) else names


def _nutation(directions: _Array) -> _Array:
    """J from the components across axis 3: the arccosine of N/M would lose a small one."""
    angle: _Array = np.arctan2(np.hypot(directions[:, 0], directions[:, 1]), directions[:, 2])
    return angle


def _on_ellipsoid(moments: _Array) -> Any:
    """From momentum directions to the angular velocities of energy 1/2 along them, the longest semi-axis being 1."""

    def place(directions: _Array) -> _Array:
        rates = directions / moments
        scaled: _Array = rates / np.sqrt(np.sum(directions * rates, axis=-1, keepdims=True)) * np.sqrt(moments[0])
        return scaled

    return place


def _polhode(moments: _Array, energy: float) -> tuple[_Array, _Array]:
    """Both closed curves on the unit sphere with 2T/M^2 = `energy`, as (n, 3) arrays."""
    inverse = 1 / moments
    angle = np.linspace(0, 2 * np.pi, 721)
    pole = 2 if energy < inverse[1] else 0
    i, j = (0, 1) if pole == 2 else (2, 1)
    along = (inverse[i] - inverse[pole]) * np.sin(angle) ** 2 + (inverse[j] - inverse[pole]) * np.cos(angle) ** 2
    tilt = np.sqrt((energy - inverse[pole]) / along)
    curve = np.empty((angle.size, 3))
    curve[:, i], curve[:, j], curve[:, pole] = tilt * np.sin(angle), tilt * np.cos(angle), np.sqrt(1 - tilt**2)
    mirrored = curve.copy()
    mirrored[:, pole] *= -1
    return curve, mirrored


def _separatrix(moments: _Array) -> tuple[_Array, ...]:
    """The two great circles of the separatrix, or none for an axisymmetric body."""
    a, b, c = 1 / moments
    if a == b or b == c:
        return ()
    angle = np.linspace(0, 2 * np.pi, 721)
    across = np.array([np.sqrt(b - c), 0, np.sqrt(a - b)]) / np.sqrt(a - c)
    return tuple(np.outer(np.cos(angle), across * [sign, 1, 1]) + np.outer(np.sin(angle), [0, 1, 0]) for sign in (1, -1))


def _surface(axes: "Axes", moments: _Array, pole: _Array, place: Any, names: list[str]) -> None:
    """The surface that `place` makes of the momentum sphere, seen from between the body axes, axis 3 up."""
    azimuth, elevation = np.radians(32), np.radians(24)
    view = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    up = np.cross(view, right)
    screen = np.array([right, up])

    def line(curve: _Array, **style: Any) -> None:
        # The momentum is normal to the inertia ellipsoid: it tells front from back on either surface.
        flat, front = place(curve) @ screen.T, curve @ view >= 0
        label = style.pop("label", None)
        axes.plot(*np.where(front[:, None], flat, np.nan).T, label=label, **style)
        axes.plot(*np.where(front[:, None], np.nan, flat).T, **{**style, "alpha": 0.25})

    circle = np.linspace(0, 2 * np.pi, 361)[:, None]
    axes.fill(*(place(np.cos(circle) * right + np.sin(circle) * up) @ screen.T).T, facecolor="#F3F5F7", edgecolor=GREY, linewidth=0.8, zorder=0)
    a, b, c = 1 / moments
    for low, high in ((c, b), (b, a)):
        for share in (0.12, 0.35, 0.65) if high > low else ():
            for curve in _polhode(moments, low + share * (high - low)):
                line(curve, color=GREY, linewidth=0.6)
    for number, curve in enumerate(_separatrix(moments)):
        line(curve, color=VERMILION, linewidth=1.3, linestyle=(0, (5, 2)), label="separatrix" if number == 0 else None)
    line(pole, color=BLUE, linewidth=2.4, label="this motion")
    axes.plot(*(screen @ place(pole[0])), "o", color=BLUE, markersize=6, label="start")
    for axis, letter in enumerate("ABC"):
        tip = screen @ place(np.eye(3)[axis])
        ahead = 0.32 * screen[:, axis] / np.hypot(*screen[:, axis])
        axes.annotate("", tip + ahead, tip, arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 1.2})
        x, y = tip + 1.5 * ahead
        axes.text(x, y, f"{names[axis]} ({letter})", ha="center", va="center", fontweight="bold")
    axes.set(xlim=(-1.6, 1.6), ylim=(-1.3, 1.6), aspect="equal")
    axes.axis("off")
    axes.legend(loc="upper right", fontsize=9, frameon=False)


def _plane(axes: "Axes", moments: _Array, nu: _Array, cosine: _Array) -> None:
    """The (nu, N/M) plane: level curves of the energy, the separatrix, the motion."""
    a, b, c = moments
    alpha = (c / a + c / b) / 2 - 1
    beta = (c / a - c / b) / 2 / alpha if alpha else 0
    low, high = (0 if cosine.min() > 0 else -1), (0 if cosine.max() < 0 else 1)
    angle, height = np.meshgrid(np.linspace(-np.pi, np.pi, 361), np.linspace(low, high, 201 * (high - low)))
    energy = (1 - height**2) * (1 - beta * np.cos(2 * angle))
    shares = np.array([0.1, 0.3, 0.6])
    levels = np.unique([*(1 - beta) * shares, *(1 - beta) + 2 * beta * shares])
    axes.contour(np.degrees(angle), height, energy, levels, colors=GREY, linewidths=0.6)
    if 0 < beta < 1:
        axes.contour(np.degrees(angle), height, energy, [1 - beta], colors=VERMILION, linewidths=1.3, linestyles=[(0, (5, 2))])
    wrapped = np.degrees(np.angle(np.exp(1j * nu)))
    gap = np.abs(np.diff(wrapped, append=wrapped[-1])) > 180
    axes.plot(np.where(gap, np.nan, wrapped), cosine, color=BLUE, linewidth=2.4)
    axes.plot(wrapped[0], cosine[0], "o", color=BLUE, markersize=6)
    axes.set(xlim=(-180, 180), ylim=(1.02 * low, 1.02 * high), xticks=range(-180, 181, 90))
    axes.set(xlabel="ν [deg]", ylabel="N/M = cos J", title="Andoyer's plane (ν, N/M)")


def _near_pole(axes: "Axes", pole: _Array, names: list[str]) -> None:
    """The path of the angular momentum in the body, near axis 3; angles beside it in microradians and in arcseconds."""
    x, y = 1e6 * pole[:, 0], 1e6 * pole[:, 1]
    axes.plot(x, y, color=BLUE, linewidth=1.8)
    axes.plot(x[0], y[0], "o", color=BLUE, markersize=6)
    axes.plot(0, 0, "+", color=BLACK, markersize=10)
    axes.annotate(f"axis {names[2]}", (0, 0), (6, 6), textcoords="offset points")
    size = max(np.abs(x).max(), np.abs(y).max())
    reach = 1.2 * size if size > 0 else 1.0
    if size > 0:
        tail, tip = len(x) // 48, len(x) // 48 + max(1, len(x) // 300)
        arrow = {"arrowstyle": "-|>", "color": BLUE, "mutation_scale": 20, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (x[tip], y[tip]), (x[tail], y[tail]), arrowprops=arrow)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel=f"towards axis {names[0]} [μrad]", ylabel=f"towards axis {names[1]} [μrad]")
    axes.set_title(f"Path of the angular momentum near axis {names[2]}")
    scale = 1e-6 / ARCSECOND
    second = axes.secondary_yaxis("right", functions=(lambda v: np.multiply(v, scale), lambda v: np.divide(v, scale)))
    second.set_ylabel("[arcsec]")


def _clock(times: _Array) -> tuple[_Array, str, tuple[str, float]]:
    """Times since the first one in seconds, hours or days, the axis label, and the unit of time of rates with its seconds."""
    elapsed = times - times[0]
    unit, seconds = ("d", 86400) if elapsed[-1] > 30 * 86400 else ("h", 3600) if elapsed[-1] > 7200 else ("s", 1)
    return elapsed / seconds, f"time [{unit}]", ("s", 1.0) if unit == "s" else ("h", 3600.0)


def _without_mean(angle: _Array, times: _Array) -> tuple[_Array, float, _Array]:
    """An angle [rad] less its mean motion, the mean motion [rad/s], the angle unwrapped.

    `times` span whole periods of the polhode, and sample every turn of the angle more than twice.
    """
    unwrapped = np.unwrap(angle)
    slope = (unwrapped[-1] - unwrapped[0]) / (times[-1] - times[0])
    rest = unwrapped - slope * (times - times[0])
    return rest - rest.mean(), slope, unwrapped


def _legend(axes: "Axes") -> None:
    """A legend above the right end of a panel, where it hides no line."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, fontsize=9, frameon=False)


def _period(rate: float, times: _Array) -> str:
    """The period of a mean motion, in seconds, hours or days, with its sense."""
    if abs(rate) * (times[-1] - times[0]) < np.pi:
        return "none (libration)"
    seconds = 2 * np.pi / abs(rate)
    unit, size = ("d", 86400) if seconds > 30 * 86400 else ("h", 3600) if seconds > 1800 else ("s", 1)
    value = f"{seconds / size:.5g} {unit}"
    return value if rate > 0 else f"{value} retrograde"
