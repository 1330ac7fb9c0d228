"""Drawing functions of `andoyer.plot`: the surface of the polhode, Andoyer's plane, the neighbourhood of the pole."""

from typing import TYPE_CHECKING, Any

import numpy as np

from andoyer._quaternions import Array
from andoyer.plot._style import ARCSECOND, BLACK, BLUE, GREY, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def on_ellipsoid(moments: Array) -> Any:
    """The map from directions of the momentum to the angular velocities of energy 1/2 along them, with the longest semi-axis 1."""

    def place(directions: Array) -> Array:
        rates = directions / moments
        scaled: Array = rates / np.sqrt(np.sum(directions * rates, axis=-1, keepdims=True)) * np.sqrt(moments[0])
        return scaled

    return place


def _polhode(moments: Array, energy: float) -> tuple[Array, Array]:
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


def _separatrix(moments: Array) -> tuple[Array, ...]:
    """The two great circles of the separatrix, or none for an axisymmetric body."""
    a, b, c = 1 / moments
    if a == b or b == c:
        return ()
    angle = np.linspace(0, 2 * np.pi, 721)
    across = np.array([np.sqrt(b - c), 0, np.sqrt(a - b)]) / np.sqrt(a - c)
    return tuple(np.outer(np.cos(angle), across * [sign, 1, 1]) + np.outer(np.sin(angle), [0, 1, 0]) for sign in (1, -1))


def surface(axes: "Axes", moments: Array, pole: Array, place: Any, names: list[str]) -> None:
    """Draw the image of the momentum sphere under `place`, seen from between the body axes, axis 3 up."""
    azimuth, elevation = np.radians(32), np.radians(24)
    view = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    up = np.cross(view, right)
    screen = np.array([right, up])

    def line(curve: Array, **style: Any) -> None:
        # The momentum is normal to the inertia ellipsoid, so its sign along the view separates front and back on both surfaces.
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


def plane(axes: "Axes", moments: Array, nu: Array, cosine: Array) -> None:
    """Draw the (nu, N/M) plane: level curves of the energy, the separatrix, the motion."""
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


def near_pole(axes: "Axes", pole: Array, names: list[str]) -> None:
    """Draw the path of the angular momentum in the body near axis 3, with axes in microradians and in arcseconds."""
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
