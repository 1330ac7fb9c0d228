"""Pictures of the samples of a file, and of the angle between them and a motion."""

from typing import TYPE_CHECKING

import numpy as np

from andoyer._core import InputError, Motion, Samples
from andoyer._quaternions import Array, angle_between
from andoyer._refusal import refusal
from andoyer.output.rows import rows
from andoyer.plot._diagrams import axes_or_new
from andoyer.plot._style import BLACK, BLUE, GREEN, VERMILION
from andoyer.plot._time import Clock, clock

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINES = [(BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (BLACK, ":")]
"""Colour and dash of each component: no line is told from another by colour alone."""

LEAST_ANGLE = 1e-17
"""An angle of zero [rad] is drawn here on the logarithmic axis."""


def components(samples: Samples, axes: "Axes | None" = None, *, time_unit: str | None = None) -> "Axes":
    """Draw the components of the quaternions over time. The sign of each quaternion is chosen so that the curves are continuous.

    Parameters
    ----------
    samples : Samples
        Samples of one motion, or of a file.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.
    time_unit : str, optional
        The name of the unit of the times. Samples with calendar times have dates instead.
    """
    axes = axes_or_new(axes)
    table = rows(samples)
    time = _clock(samples, table[:, 0], time_unit)
    attitude = table[:, 1:5]
    turned = np.sum(attitude[1:] * attitude[:-1], axis=1) < 0
    attitude = attitude * np.where(np.concatenate([[False], np.cumsum(turned) % 2 == 1]), -1.0, 1.0)[:, None]
    for name, values, (color, dash) in zip("xyzw", attitude.T, LINES):
        axes.plot(time.values, values, color=color, linestyle=dash, label=f"q{name}")
    axes.set(ylabel="quaternion [1]")
    axes.set_title("Attitude: quaternion, body to inertial", loc="left")
    return _finished(axes, time)


def sampled_rates(samples: Samples, axes: "Axes | None" = None, *, time_unit: str | None = None) -> "Axes":
    """Draw the angular velocities about the body axes over time.

    Parameters
    ----------
    samples, axes, time_unit
        As in `components`.
    """
    axes = axes_or_new(axes)
    table = rows(samples)
    time = _clock(samples, table[:, 0], time_unit)
    missing = bool(np.isnan(table[:, 5:]).any())
    for axis, (color, dash) in enumerate(LINES[:3]):
        axes.plot(time.values, np.degrees(table[:, 5 + axis]) * time.seconds, color=color, linestyle=dash, label=f"ω{axis + 1}")
    axes.set(ylabel=f"[deg{time.per}]")
    axes.set_title("Body rates: the file has none" if missing else "Body rates", loc="left")
    return _finished(axes, time)


def difference(samples: Samples, motion: Motion | Samples, axes: "Axes | None" = None, *, time_unit: str | None = None) -> "Axes":
    """Draw the angle between samples and a motion over time, on a logarithmic axis.

    Parameters
    ----------
    samples : Samples
        Samples of one motion, or of a file.
    motion : Motion or Samples
        A motion, evaluated at the times of `samples`, or other samples at the same times.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; by default those of a new figure.
    time_unit : str, optional
        The name of the unit of the times. Samples with calendar times have dates instead.

    Raises
    ------
    InputError
        The two samples have different times.
    """
    axes = axes_or_new(axes)
    table = rows(samples)
    time = _clock(samples, table[:, 0], time_unit)
    angle = angles_between(samples, motion)
    axes.semilogy(time.values, np.maximum(angle, LEAST_ANGLE), color=BLUE)
    axes.set(ylabel="angle between [rad]")
    axes.set_title(f"Angle between the file and the scene: {angle.max():.3g} rad at most, median {np.median(angle):.3g}", loc="left")
    time.finish(axes)
    return axes


def angles_between(samples: Samples, motion: Motion | Samples) -> Array:
    """The angles [rad] between samples and a motion at their times, or other samples of the same times."""
    table = rows(samples)
    other = rows(_at(motion, samples, table[:, 0]) if isinstance(motion, Motion) else motion)
    if not np.array_equal(other[:, 0], table[:, 0]):
        raise refusal("samples", "different times", "the same times", "that are compared must have the same times")
    return angle_between(table[:, 1:5], other[:, 1:5])


def _at(motion: Motion, samples: Samples, times: Array) -> Samples:
    """The motion at the times of samples: at calendar times if the epoch of the motion is one, otherwise at seconds since J2000."""
    try:
        return motion.at(samples.times)
    except InputError:
        return motion.at(times)


def _clock(samples: Samples, times: Array, time_unit: str | None) -> Clock:
    """The time axis of samples: dates if their times are calendar times."""
    return clock(times, hasattr(samples.times, "jd1") and hasattr(samples.times, "tdb"), time_unit)


def _finished(axes: "Axes", time: Clock) -> "Axes":
    time.finish(axes)
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=4, fontsize=9, frameon=False)
    return axes
