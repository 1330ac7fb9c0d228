"""Pictures of a torque-free motion: the polhode on the momentum sphere, the (nu, N/M) plane or the pole path, angles and rates over time.

Angles are Andoyer's of a short-axis mode, theory §1. The sphere is an orthographic view, lines on its far side are pale; grey lines are
other polhodes of the same body, the dashed line is the separatrix. Colours are those of Okabe and Ito, safe for colour-blind readers, and
no line is told from another by colour alone. Needs numpy and matplotlib.
"""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

BLUE, VERMILION, GREEN, BLACK, GREY = "#0072B2", "#D55E00", "#009E73", "#222222", "#9A9A9A"
TINY = 0.01  # amplitude J [rad] below which the polhode is a dot on the sphere and the pole path is drawn instead
ARCSECOND = np.pi / 648000
STYLE = {"font.size": 10, "axes.titlesize": 10.5, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}


def draw(path, name, moments, times, andoyer, rates):
    """Writes the picture of one motion.

    `times` span whole periods of the polhode, so that mean motions can be read from their ends. `moments` about body axes 1, 2, 3 with A <= B <= C;
    `times` (n,) [s]; `andoyer` (n, 6), columns lambda mu nu Lambda M N; `rates` (n, 3) [rad/s].
    """
    moments = np.asarray(moments, dtype=float)
    momentum = moments * rates
    size = np.linalg.norm(momentum, axis=1, keepdims=True)
    pole = momentum / size
    # From the components across axis 3: arccos(N/M) would lose a small J.
    nutation = np.arctan2(np.hypot(pole[:, 0], pole[:, 1]), pole[:, 2])
    tiny = nutation.max() < TINY
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(13, 9), layout="constrained")
        figure.suptitle(name, fontsize=15, fontweight="bold")
        grid = figure.add_gridspec(4, 2, width_ratios=(1, 1.25))
        _sphere(figure.add_subplot(grid[:2, 0]), moments, pole)
        if tiny:
            _pole_path(figure.add_subplot(grid[2:, 0]), pole)
        else:
            _plane(figure.add_subplot(grid[2:, 0]), moments, andoyer[:, 2], pole[:, 2])
        _angles(figure, grid, times, andoyer, nutation)
        _rates(figure.add_subplot(grid[3, 1], sharex=figure.axes[-1]), times, rates, tiny)
        figure.align_ylabels(figure.axes[2:])
        figure.savefig(path, dpi=130)
        plt.close(figure)


def _polhode(moments, energy):
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


def _separatrix(moments):
    """The two great circles of the separatrix, or none for an axisymmetric body."""
    a, b, c = 1 / moments
    if a == b or b == c:
        return ()
    angle = np.linspace(0, 2 * np.pi, 721)
    across = np.array([np.sqrt(b - c), 0, np.sqrt(a - b)]) / np.sqrt(a - c)
    return tuple(np.outer(np.cos(angle), across * [sign, 1, 1]) + np.outer(np.sin(angle), [0, 1, 0]) for sign in (1, -1))


def _sphere(axes, moments, pole):
    """The momentum sphere seen from between the body axes, axis 3 up."""
    azimuth, elevation = np.radians(32), np.radians(24)
    view = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    screen = np.array([right, np.cross(view, right)])

    def line(curve, **style):
        flat, front = curve @ screen.T, curve @ view >= 0
        label = style.pop("label", None)
        axes.plot(*np.where(front[:, None], flat, np.nan).T, label=label, **style)
        axes.plot(*np.where(front[:, None], np.nan, flat).T, **{**style, "alpha": 0.25})

    axes.add_patch(plt.Circle((0, 0), 1, facecolor="#F3F5F7", edgecolor=GREY, linewidth=0.8, zorder=0))
    a, b, c = 1 / moments
    for low, high in ((c, b), (b, a)):
        for share in (0.12, 0.35, 0.65) if high > low else ():
            for curve in _polhode(moments, low + share * (high - low)):
                line(curve, color=GREY, linewidth=0.6)
    for number, curve in enumerate(_separatrix(moments)):
        line(curve, color=VERMILION, linewidth=1.3, linestyle=(0, (5, 2)), label="separatrix" if number == 0 else None)
    turn = np.abs(np.unwrap(np.arctan2(pole[:, 1], pole[:, 0])))
    once = pole[: max(2, np.searchsorted(np.abs(turn - turn[0]), 2 * np.pi) + 1)]
    line(once, color=BLUE, linewidth=2.4, label="this motion")
    axes.plot(*(screen @ pole[0]), "o", color=BLUE, markersize=6, label="start")
    for axis, (moment, letter) in enumerate(zip(moments, "ABC")):
        tip = screen[:, axis]
        axes.annotate("", 1.32 * tip, tip, arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 1.2})
        axes.text(*(1.32 * tip + 0.17 * tip / np.hypot(*tip)), f"{axis + 1} ({letter})", ha="center", va="center", fontweight="bold")
    axes.set(xlim=(-1.5, 1.5), ylim=(-1.2, 1.45), aspect="equal", title="Polhode on the momentum sphere")
    axes.axis("off")
    axes.legend(loc="upper right", fontsize=9)


def _plane(axes, moments, nu, cosine):
    """The (nu, N/M) plane: level curves of the energy, the separatrix, the motion."""
    a, b, c = moments
    alpha = (c / a + c / b) / 2 - 1
    beta = (c / a - c / b) / 2 / alpha if alpha else 0
    low, high = -1 if cosine.min() < 0 else 0, 1 if cosine.max() > 0 else 0
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


def _pole_path(axes, pole):
    """The path of the angular momentum in the body, near axis 3; angles beside it in microradians and in arcseconds."""
    x, y = 1e6 * pole[:, 0], 1e6 * pole[:, 1]
    axes.plot(x, y, color=BLUE, linewidth=1.8)
    axes.plot(x[0], y[0], "o", color=BLUE, markersize=6)
    axes.plot(0, 0, "+", color=BLACK, markersize=10)
    axes.annotate("axis 3", (0, 0), (6, 6), textcoords="offset points")
    tail, tip = len(x) // 48, len(x) // 48 + len(x) // 300
    arrow = {"arrowstyle": "-|>", "color": BLUE, "mutation_scale": 20, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (x[tip], y[tip]), (x[tail], y[tail]), arrowprops=arrow)
    reach = 1.2 * max(np.abs(x).max(), np.abs(y).max())
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="towards axis 1 [μrad]", ylabel="towards axis 2 [μrad]")
    axes.set_title("Path of the angular momentum near axis 3")
    scale = 1e-6 / ARCSECOND
    second = axes.secondary_yaxis("right", functions=(lambda v: v * scale, lambda v: v / scale))
    second.set_ylabel("[arcsec]")


def _clock(times):
    """Times since the first one in hours or days, and the axis label."""
    elapsed = times - times[0]
    unit, seconds = ("d", 86400) if elapsed[-1] > 30 * 86400 else ("h", 3600)
    return elapsed / seconds, f"time [{unit}]"


def _without_mean(angle, times):
    """An angle [rad] less its mean motion, the mean motion [rad/s], the angle unwrapped.

    `times` span whole periods of the polhode, and sample every turn of the angle more than twice.
    """
    unwrapped = np.unwrap(angle)
    slope = (unwrapped[-1] - unwrapped[0]) / (times[-1] - times[0])
    rest = unwrapped - slope * (times - times[0])
    return rest - rest.mean(), slope, unwrapped


def _angles(figure, grid, times, andoyer, nutation):
    """J; nu; the periodic parts of mu and nu: three panels that share their time."""
    elapsed, _ = _clock(times)
    tiny = nutation.max() < TINY
    panels = [figure.add_subplot(grid[0, 1])]
    panels += [figure.add_subplot(grid[row, 1], sharex=panels[0]) for row in (1, 2)]
    panels[0].plot(elapsed, 1e6 * nutation if tiny else np.degrees(nutation), color=BLUE)
    panels[0].set(ylabel="J [μrad]" if tiny else "J [deg]", title="Nutation J: short axis from the angular momentum")
    mu, mu_rate, _ = _without_mean(andoyer[:, 1], times)
    nu, nu_rate, nu_all = _without_mean(andoyer[:, 2], times)
    panels[1].plot(elapsed, np.degrees(nu_all), color=BLUE)
    if np.ptp(nu_all) > 2 * np.pi:
        panels[1].yaxis.set_major_locator(plt.MultipleLocator(360))
    panels[1].set(ylabel="ν [deg]", title=f"ν: period {_period(nu_rate, times)}, μ: period {_period(mu_rate, times)}")
    panels[2].plot(elapsed, np.degrees(mu), color=VERMILION, linestyle="--", label="μ")
    panels[2].plot(elapsed, np.degrees(nu), color=BLUE, label="ν")
    panels[2].set(ylabel="[deg]", title="μ and ν less their mean motion")
    _legend(panels[2])
    for panel in panels:
        panel.margins(x=0)
        panel.tick_params(labelbottom=False)


def _legend(axes):
    """A legend above the right end of a panel, where it hides no line."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, fontsize=9)


def _period(rate, times):
    """The period of a mean motion, in hours or days, with its sense."""
    if abs(rate) * (times[-1] - times[0]) < np.pi:
        return "none (libration)"
    hours = 2 * np.pi / abs(rate) / 3600
    value = f"{hours / 24:.5g} d" if hours > 720 else f"{hours:.5g} h"
    return value if rate > 0 else f"{value} retrograde"


def _rates(axes, times, rates, tiny):
    """Body rates; axis 3 only in words where it does not move visibly."""
    elapsed, label = _clock(times)
    unit, scale = ("μrad/h", 3.6e9) if tiny else ("deg/h", np.degrees(3600))
    styles = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."))
    for axis, (color, style) in enumerate(styles[: 2 if tiny else 3]):
        axes.plot(elapsed, scale * rates[:, axis], color=color, linestyle=style, label=f"ω{axis + 1}")
    steady = f", ω3 = {rates[:, 2].mean():.6g} rad/s" if tiny else ""
    axes.set(xlabel=label, ylabel=f"[{unit}]", title=f"Body rates{steady}")
    axes.margins(x=0)
    _legend(axes)
