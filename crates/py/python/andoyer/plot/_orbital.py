"""Pictures of a satellite against the orbital frame: the three angles and the relative rate over the span, of a motion or of the members of an ensemble."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Ensemble, Motion, Scene
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.interop._foreign import epoch_of, plain
from andoyer.plot._compared import LINES
from andoyer.plot._librations import LEAST_ORBITS, SWINGS
from andoyer.plot._style import BLACK, BLUE, GREY, STYLE
from andoyer.plot._time import MOST, PER_TURN, SAMPLES, Clock, clock, whole_turns

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Frame = Literal["rtn", "lvlh"]
Whose = Literal["rotating", "disturbing"]

LINES_OF_MEMBERS = 20
"""Members of an ensemble up to which each is drawn as a line; of more the median and the quantiles are drawn."""
BANDS = ((0.05, 0.95, 0.2), (0.25, 0.75, 0.35))
"""Lower and upper quantile of a band, and its opacity."""
ROWS = 4_000_000
"""Attitudes of an ensemble that are evaluated at most, unless a member would have fewer than `LEAST` times."""
LEAST = 1000
TICKS = (15, 30, 45, 90, 180)
"""Steps between ticks of angles that vary by more than four of the first [deg]."""
STEADY = 1e-8
"""Variation [deg] of an angle below which it is rounding."""
NAMES = {"X": "roll", "Y": "pitch", "Z": "yaw"}


class Panel(NamedTuple):
    """The angle of a panel: its place in the sequence, and its name."""

    place: int
    name: str


def orbital(
    motion: Motion | Ensemble,
    times: ArrayLike | None = None,
    *,
    elements_of: Whose,
    frame: Frame = "lvlh",
    sequence: str = "ZYX",
    of: int = 0,
    time_unit: str | None = None,
) -> Figure:
    """Draw the attitude against the orbital frame over time: roll, pitch and yaw in degrees, and the angular velocity against the turning frame.

    Angles are continuous: they run on beyond ±180°, and through ±90° of the middle angle (of a sequence such as "ZXZ" 0° and 180°). Where the middle angle turns back close to these, the other two
    change fast by half a turn, as they must. Each shown triple is an attitude of `Motion.orbital`. In the frame "rtn", and by a sequence with an axis twice, an angle has the name of its axis.

    Of an ensemble with at most 20 members each is a line. Of more, the line is the median of the members, and the bands have 50 % and 90 % of them.

    Parameters
    ----------
    motion : Motion or Ensemble
        Members of an ensemble without a motion are left out.
    times : array_like, shape (n,), optional
        Times of the scene. By default the whole span (of an ensemble what the spans of all members have in common); without a span five orbits from the epoch, of a libration at least two
        proper periods. Of more than 3,000 rotations (of an ensemble fewer, if it has more than 83 members) the first are drawn, and the title says it.
    elements_of, frame, sequence, of
        As in `Scene.from_orbital`.
    time_unit : str, optional
        The name of the unit of time of the scene, for example "s". A scene with a calendar epoch has dates instead.

    Returns
    -------
    matplotlib.figure.Figure
        With four axes: three angles, and the rate: about the body axes, of an ensemble its size.

    Raises
    ------
    InputError
        As `Motion.orbital`; spans of members that have no time in common; no member with a motion; a `time_unit` beside a calendar epoch.

    Examples
    --------
    >>> from andoyer import plot
    >>> given = {"elements_of": "rotating", "frame": "lvlh"}
    >>> scene = Scene.from_orbital(Body([1.5, 2, 1]), [0, 0.1, 0], [0, 0, 0], orbit=Orbit(1e-3), **given, span=(0, 6e3), method="integrated")
    >>> [axes.get_ylabel() for axes in plot.orbital(scene.solve(), **given, time_unit="s").axes]
    ['roll [deg]', 'pitch [deg]', 'yaw [deg]', '[deg/s]']
    """
    if not isinstance(motion, Motion | Ensemble):
        raise TypeError(f"motion must be a Motion or an Ensemble: got {type(motion).__name__}")
    plt: Any = extra("matplotlib.pyplot", "andoyer.plot")
    asked = {"elements_of": elements_of, "frame": frame, "sequence": sequence, "of": of}
    with plt.rc_context(STYLE):
        figure: Figure = plt.figure(figsize=(10, 9), layout="constrained")
        try:
            panels = list(figure.subplots(4, 1, sharex=True))
            name, _ = angles_against(motion, times, panels, asked, time_unit)
        except BaseException:
            plt.close(figure)
            raise
        figure.suptitle(name, fontsize=15, fontweight="bold")
    return figure


def angles_against(motion: Motion | Ensemble, times: ArrayLike | None, panels: list[Axes], asked: dict[str, Any], time_unit: str | None) -> tuple[str, Array]:
    """Draw the three angles and the rate into four panels. Returns the name of the motion or of the ensemble, and the times."""
    several, missing = isinstance(motion, Ensemble), 0
    scenes = [scene for scene in motion.scenes if scene is not None] if isinstance(motion, Ensemble) else [motion.scene]
    if not scenes:
        raise refusal("motion", "no members with a motion", "at least one", "has no member with a motion")
    part = 1.0
    if times is None:
        drawn, part = _whole(motion, scenes, asked)
    else:
        drawn = np.atleast_1d(np.asarray(plain("times", times), dtype=float))
    if drawn.ndim != 1 or not drawn.size:
        raise refusal("times", drawn.shape, "shape (n,)", f"must have shape (n,), with at least one time: got {drawn.shape}")
    seen = motion.orbital(drawn, **asked)
    angles, rates = np.atleast_3d(seen.angles) if several else seen.angles, seen.angular_velocity
    if several:
        moving = np.isfinite(angles).all(axis=(1, 2))
        if not moving.any():
            raise refusal("motion", "no members with a motion", "at least one", "has no member with a motion")
        missing, angles, rates = int((~moving).sum()), angles[moving], rates[moving]
    sequence = str(asked["sequence"]).upper()
    angles = np.degrees(continuous(angles, sequence))
    if several:
        # A cloud about ±180° is not torn.
        first = np.radians(angles[:, :1])
        middle = np.degrees(np.angle(np.exp(1j * first).mean(axis=0)))
        angles = angles - 360 * np.round((np.degrees(first) - middle) / 360)
    time = clock(drawn, all(hasattr(epoch_of(scene), "jd1") for scene in scenes), time_unit)
    shown = _panels(sequence, str(asked["frame"]).lower())
    for axes, panel in zip(panels, shown, strict=False):
        _draw(axes, time, angles[..., panel.place], several)
        _ticks(axes, angles[..., panel.place], several)
        axes.set_ylabel(f"{panel.name} [deg]")
    scale = math.degrees(time.seconds)
    if several:
        _draw(panels[3], time, scale * np.linalg.norm(rates, axis=-1), several)
        panels[3].set_ylim(bottom=0)
        if len(angles) > LINES_OF_MEMBERS:
            panels[3].legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, fontsize=9, frameon=False)
    else:
        for axis, (color, dash) in enumerate(LINES[:3]):
            panels[3].plot(time.values, scale * rates[:, axis], color=color, linestyle=dash, label=f"ω{axis + 1}")
        panels[3].legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, fontsize=9, frameon=False)
    panels[3].set_ylabel(f"[deg{time.per}]")
    frame = "LVLH (forward, against the normal, to the primary)" if asked["frame"].lower() == "lvlh" else "RTN (radial, transverse, normal)"
    said = f"Angles against {frame}, sequence {sequence}" + (f", the first {100 * part:.2g} % of the span" if part < 1 else "")
    panels[0].set_title(said, loc="left")
    panels[3].set_title("Size of the rate against the frame" if several else "Body rates against the frame", loc="left")
    for axes in panels[:3]:
        axes.margins(x=0)
        axes.tick_params(labelbottom=False)
        axes.xaxis.get_offset_text().set_visible(False)
    time.finish(panels[3])
    panels[0].figure.align_ylabels(panels)
    if not several:
        return scenes[0].name or scenes[0].body.name or "", drawn

    return f"{len(angles)} members" + (f", {missing} without a motion" if missing else ""), drawn


def continuous(angles: Array, sequence: str) -> Array:
    """Angles [rad] of a sequence without jumps, shape (…, n, 3): of each attitude's two triples that which is nearer to the one before, then whole turns."""
    twice = sequence[0] == sequence[2]
    other = np.stack([angles[..., 0] + np.pi, -angles[..., 1] if twice else np.pi - angles[..., 1], angles[..., 2] + np.pi], axis=-1)
    steps = [np.sum(_wrapped(turned[..., 1:, :] - angles[..., :-1, :]) ** 2, axis=-1) for turned in (angles, other)]
    flipped = np.cumsum(steps[1] < steps[0], axis=-1) % 2 == 1
    flipped = np.concatenate([np.zeros_like(flipped[..., :1]), flipped], axis=-1) if flipped.shape[-1] else np.zeros(angles.shape[:-1], bool)
    whole: Array = np.unwrap(np.where(flipped[..., None], other, angles), axis=-2)
    return whole


def _wrapped(angle: Array) -> Array:
    return np.mod(angle + np.pi, 2 * np.pi) - np.pi


def _whole(motion: Motion | Ensemble, scenes: list[Scene], asked: dict[str, Any]) -> tuple[Array, float]:
    """The times of a picture if none are given, and the part of the span that they cover."""
    spans = np.array([scene.span or _orbits(motion, scene, asked["of"]) for scene in scenes])
    start, stop = spans[:, 0].max(), spans[:, 1].min()
    if not start < stop:
        raise refusal("times", None, "the times of the picture", "must be given, since the spans of the members have no time in common")
    if isinstance(motion, Motion):
        few = motion.angular_velocity(np.linspace(start, stop, SAMPLES))
        least, most = SAMPLES, MOST
    else:
        few = np.array([scene.angular_velocity for scene in scenes])
        least, most = LEAST, max(LEAST, min(MOST, ROWS // len(motion)))
    count = PER_TURN * np.linalg.norm(few, axis=1).max() * (stop - start) / (2 * math.pi)
    if count <= most:
        return np.linspace(start, stop, max(least, int(count) + 1)), 1.0
    return np.linspace(start, start + (stop - start) * most / count, most), most / count


def _orbits(motion: Motion | Ensemble, scene: Scene, of: int) -> tuple[float, float]:
    """The interval of a scene without a span: some orbits, or the swings of a libration."""
    orbits = scene.orbit if isinstance(scene.orbit, tuple) else (scene.orbit,)
    rate = getattr(orbits[of], "mean_motion", None) if isinstance(of, int) and 0 <= of < len(orbits) else None
    if rate is None:
        # Without such a body `Motion.orbital` says so.
        return (scene.epoch, scene.epoch + 1) if isinstance(motion, Ensemble) else tuple(whole_turns(motion)[[0, -1]])
    least = LEAST_ORBITS * 2 * math.pi / rate
    libration = motion.libration if isinstance(motion, Motion) else None
    return scene.epoch, scene.epoch + (least if libration is None else max(least, SWINGS * libration.periods[0]))


def _panels(sequence: str, frame: str) -> list[Panel]:
    """The angles in the order of the panels: roll, pitch, yaw, or by the axes of the frame, or in the order of the sequence if an axis is there twice."""
    if len(set(sequence)) < 3:
        return [Panel(place, f"{number}, about {axis}") for place, (number, axis) in enumerate(zip(("first", "second", "third"), sequence, strict=True))]
    return [Panel(sequence.index(axis), NAMES[axis] if frame == "lvlh" else f"about {axis}") for axis in "XYZ"]


def _draw(axes: Axes, time: Clock, values: Array, several: bool) -> None:
    """One angle of a motion, or of each member."""
    if not several:
        axes.plot(time.values, values, color=BLUE, linewidth=1.3)
    elif len(values) <= LINES_OF_MEMBERS:
        axes.plot(time.values, values.T, color=BLUE, linewidth=0.7, alpha=0.6)
    else:
        for lower, upper, opacity in BANDS:
            edges = np.quantile(values, (lower, upper), axis=0)
            axes.fill_between(time.values, *edges, color=BLUE, alpha=opacity, linewidth=0, label=f"{100 * lower:g} to {100 * upper:g} %")
        axes.plot(time.values, np.median(values, axis=0), color=BLACK, linewidth=1.0, label="median")
    axes.ticklabel_format(axis="y", useOffset=False)


def _ticks(axes: Axes, values: Array, several: bool) -> None:
    """Ticks at parts of a turn, and a line at zero where it is in reach; rounding is not stretched over the panel."""
    drawn = np.quantile(values, (BANDS[0][0], BANDS[0][1]), axis=0) if several and len(values) > LINES_OF_MEMBERS else values
    least, most = float(drawn.min()), float(drawn.max())
    size = most - least
    if size < STEADY:
        axes.set_ylim(least - 0.01, most + 0.01)
    elif size > 4 * TICKS[0]:
        ticker = extra("matplotlib.ticker", "andoyer.plot")
        axes.yaxis.set_major_locator(ticker.MultipleLocator(next((step for step in TICKS if size <= 5 * step), 360 * math.ceil(size / 1800))))
    if least < 0 < most:
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=0)
