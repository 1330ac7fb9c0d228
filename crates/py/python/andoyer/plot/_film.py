"""A Matplotlib animation of a motion, for films: axes, angular momentum, angular velocity and its paths."""

from typing import TYPE_CHECKING, Any

import numpy as np

from andoyer._core import Motion
from andoyer._extra import extra
from andoyer._quaternions import Array, rotate
from andoyer.plot._style import BLACK, BLUE, GREEN, VERMILION
from andoyer.plot._time import clock_of

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation

SKY, ORANGE, PURPLE = "#56B4E9", "#E69F00", "#CC79A7"
REACH = 1.2
"""Length of the longest angular velocity; the axes have length 1."""


def film(motion: Motion, times: Array, interval: float) -> "FuncAnimation":
    """The animation, with one frame for each time and the angular momentum upwards."""
    plt, animation = (extra(module, "andoyer.plot.animate") for module in ("matplotlib.pyplot", "matplotlib.animation"))
    samples = motion.at(times)
    upright = _upright(motion.angular_momentum(times[0]))
    largest = np.linalg.norm(samples.angular_velocity, axis=1).max()
    rates = samples.angular_velocity * (REACH / largest if largest > 0 else 0.0)
    figure = plt.figure(figsize=(7, 7))
    axes: Any = figure.add_subplot(projection="3d")
    axes.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1), box_aspect=(1, 1, 1))
    axes.set_axis_off()
    paths = rotate(samples.attitude, rates) @ upright.T
    axes.plot([0, 0], [0, 0], [0, REACH], color=PURPLE, linewidth=2, label="angular momentum")
    lines = [axes.plot([], [], [], color=color, linewidth=2, label=f"body axis {k + 1}")[0] for k, color in enumerate((VERMILION, GREEN, BLUE))]
    rate = axes.plot([], [], [], color=ORANGE, linewidth=2, label="angular velocity, herpolhode")[0]
    herpolhode = axes.plot([], [], [], color=ORANGE, linewidth=1)[0]
    polhode = axes.plot([], [], [], color=SKY, linewidth=1.5, label="polhode")[0]
    clock = axes.text2D(0.02, 0.97, "", transform=axes.transAxes, color=BLACK)
    axes.legend(loc="lower right", fontsize=9, frameon=False)

    drawn = clock_of(motion, times, None).values
    stamps = drawn.astype("datetime64[ms]").astype(str) if drawn.dtype.kind == "M" else [f"t = {time:.6g}" for time in drawn]

    def show(frame: int) -> list[Any]:
        attitude = samples.attitude[frame]
        for axis, line in zip(np.eye(3), lines):
            _set(line, np.array([np.zeros(3), upright @ rotate(attitude, axis)]))
        _set(rate, np.array([np.zeros(3), paths[frame]]))
        _set(herpolhode, paths[: frame + 1])
        _set(polhode, rotate(np.broadcast_to(attitude, samples.attitude.shape), rates) @ upright.T)
        clock.set_text(stamps[frame])
        return [*lines, rate, herpolhode, polhode, clock]

    made: FuncAnimation = animation.FuncAnimation(figure, show, frames=len(times), interval=interval, blit=False)
    plt.close(figure)
    return made


def _upright(momentum: Array) -> Array:
    """The matrix that turns the angular momentum upwards."""
    size = np.linalg.norm(momentum)
    pole = momentum / size if size > 0 else np.array([0.0, 0.0, 1.0])
    side = np.eye(3)[np.argmin(np.abs(pole))]
    east = np.cross(side, pole)
    east /= np.linalg.norm(east)
    return np.array([east, np.cross(pole, east), pole])


def _set(line: Any, points: Array) -> None:
    line.set_data_3d(points[:, 0], points[:, 1], points[:, 2])
