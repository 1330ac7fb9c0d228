"""Time axes of pictures: calendar dates if the epoch is a date, otherwise the times of the scene in their own unit.

A scene with a number as its epoch does not know its unit of time, so its axis has the name "time" without a unit, or the unit that the user names. With a calendar
epoch the unit is the second; rates are then per second or per hour, and periods in seconds, hours or days.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Evolution, Motion
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.interop._foreign import epoch_of, plain
from andoyer.output.span import within_span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

J2000 = np.datetime64("2000-01-01T12:00:00", "us")
DATES = (-6.2e10, 2.5e11)
"""TDB seconds since J2000 that matplotlib can draw as dates: the years 36 to 9922."""
HOURS, DAYS = 7200.0, 30 * 86400.0
"""A span above which rates are per hour, and a period above which it is in days [s]."""
TURNS, SAMPLES = 3, 3000
"""Periods of the polhode that are drawn if no times are given, and how many times."""
SLOW = 10.0
"""Rate in mean motions of the orbit below which a body turns with its orbit: polhodes are then no more than parts of the motion."""
PER_TURN, MOST = 16, 48000
"""Times for each turn of the body over a whole span, and the most times; a longer span is not drawn as a whole by itself."""


class Clock(NamedTuple):
    """The times of a picture."""

    values: Any
    """What is drawn: numbers or dates."""
    label: str
    dated: bool
    unit: str
    """The unit of time of rates; empty if it has no name."""
    seconds: float
    """This unit in units of time of the scene."""

    @property
    def per(self) -> str:
        """The end of the name of a unit of rates."""
        return f"/{self.unit}" if self.unit else " per unit of time"

    def period(self, value: float) -> str:
        """A period as text, with its unit."""
        if not self.dated:
            return f"{value:.5g} {self.unit}".rstrip()
        unit, size = ("d", 86400) if value > DAYS else ("h", 3600) if value > HOURS / 4 else ("s", 1)
        return f"{value / size:.5g} {unit}"

    def finish(self, axes: Axes) -> None:
        """Labels the time axis."""
        axes.set_xlabel(self.label)
        axes.margins(x=0)
        if self.values.dtype.kind == "M":
            dates = extra("matplotlib.dates", "andoyer.plot")
            locator = dates.AutoDateLocator(minticks=3, maxticks=7)
            axes.xaxis.set_major_locator(locator)
            axes.xaxis.set_major_formatter(dates.ConciseDateFormatter(locator))


def clock(times: Array, dated: bool, time_unit: str | None) -> Clock:
    """The time axis of times in the unit of the scene, which are TDB seconds since J2000 if `dated`.

    Raises
    ------
    TypeError
        A unit that is not a text.
    InputError
        The name of a unit beside a calendar epoch, whose axis has dates.
    """
    if time_unit is not None and not isinstance(time_unit, str):
        raise TypeError(f"time_unit must be a str, the name of the unit of time: got {type(time_unit).__name__}")
    if not dated:
        return Clock(times, "time" if time_unit is None else f"time [{time_unit}]", False, time_unit or "", 1.0)
    if time_unit is not None:
        raise refusal("time_unit", time_unit, "absent with a calendar epoch", f"= {time_unit!r}: the epoch is a calendar time, so the axis has dates")
    unit, seconds = ("h", 3600.0) if np.ptp(times) > HOURS else ("s", 1.0)
    if not (DATES[0] < times.min() and times.max() < DATES[1]):
        return Clock(times, "TDB since J2000 [s]", True, unit, seconds)
    dates = J2000 + np.round(times * 1e6).astype("timedelta64[us]")
    return Clock(dates, "date (TDB)", True, unit, seconds)


def clock_of(motion: Motion | Evolution, times: Array, time_unit: str | None) -> Clock:
    """The time axis of a motion or an evolution."""
    return clock(times, hasattr(epoch_of(motion.scene), "jd1"), time_unit)


def is_periodic(motion: Motion) -> bool:
    """Whether a motion repeats, but for slow changes: it is free, or there is one orbit, an ellipse, and no other torque."""
    scene = motion.scene
    orbits = scene.orbit if isinstance(scene.orbit, tuple) else (scene.orbit,)
    return not scene.torques and len(orbits) == 1 and (orbits[0] is None or getattr(orbits[0], "eccentricity", 1.0) < 1.0)


def turns_with_orbit(motion: Motion) -> bool:
    """Whether a motion is so slow that the orbit, not the polhode, sets its time: a satellite or a moon, integrated or librating."""
    scene = motion.scene
    orbits = scene.orbit if isinstance(scene.orbit, tuple) else (scene.orbit,)
    rate = max((getattr(orbit, "mean_motion", 0.0) for orbit in orbits), default=0.0)
    return motion.plan.method in ("integrated", "libration") and float(np.linalg.norm(scene.angular_velocity)) < SLOW * rate


def whole_span(motion: Motion) -> Array | None:
    """Times over the span of a motion, enough for every turn of the body; None without a span, or if it has too many turns."""
    if motion.scene.span is None:
        return None
    few = np.linspace(*motion.scene.span, SAMPLES)
    fastest = np.linalg.norm(motion.angular_velocity(few), axis=1).max()
    count = PER_TURN * fastest * np.ptp(few) / (2 * np.pi)
    return np.linspace(*motion.scene.span, max(SAMPLES, int(count) + 1)) if count < MOST else None


def whole_turns(motion: Motion, turns: int = TURNS, samples: int = SAMPLES) -> Array:
    """Times over whole periods of the polhode from the epoch, or over whole rotations if the motion is steady. For an integrated motion they end with its span.

    Returns
    -------
    ndarray, shape (samples,)
        The times. For a body at rest they cover `turns` units of time.
    """
    precession, rotation = motion.periods["long-axis"]
    period = next((time for time in (rotation, precession) if np.isfinite(time)), 1.0)
    return np.linspace(*within_span(motion, motion.scene.epoch, motion.scene.epoch + turns * period), samples)


def chosen(motion: Motion, times: ArrayLike | None, turns: int = TURNS) -> Array:
    """The times of a picture: as given; or the whole span of a motion that is not periodic or that turns with its orbit; or whole periods of the polhode."""
    if times is not None:
        return np.asarray(plain("times", times), dtype=float)
    spanned = None if is_periodic(motion) and not turns_with_orbit(motion) else whole_span(motion)
    return whole_turns(motion, turns) if spanned is None else spanned
