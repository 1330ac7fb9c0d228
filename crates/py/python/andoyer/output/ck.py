"""Writer of C-kernels of SPICE, by SpiceyPy: type 3, or type 2 for uniform rotation.

A C-kernel gives the matrix from an inertial frame to the body axes, and the angular velocity in inertial components, at times of a spacecraft clock.
The SPICE quaternion of that matrix is [w, -x, -y, -z] for the attitude [x, y, z, w]. Type 3 rotates uniformly between its records; `andoyer.output.nodes` computes
their times. Type 2 has one angular velocity for each record. If no clock kernel is given, one is written too. Its ticks are
the seconds of ephemeris time (TDB) minus a whole number, so that no digit is lost.

SPICE has one state for the whole process and is not safe for threads. `write_ck` therefore writes one kernel at a time; calls of SpiceyPy elsewhere in the process must not run
in another thread meanwhile.
"""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from andoyer._core import Motion, __version__
from andoyer._extra import extra
from andoyer._quaternions import Array, rotate
from andoyer._refusal import refusal
from andoyer.interop._foreign import epoch_of, scene_times
from andoyer.output.calendar import J2000, TIME_SYSTEMS, seconds_of_tdb
from andoyer.output.files import whole_file
from andoyer.output.nodes import SMALLEST_ERROR, estimate, nodes, windows
from andoyer.output.record import ShortRecord
from andoyer.output.table import Progress, silent

STEADY = ("principal-axis", "spherical", "at-rest")
"""Modes of uniform rotation, if there is no torque."""

MOST_RECORDS = 50_000_000
"""64 bytes each: more would not fit a file that anyone loads."""

LONGEST_SEGMENT = 200_000
"""Records of a segment, and those of a window more: SPICE looks for a segment one after the other."""

LONGEST_NAME = 255
"""Characters of a path that SPICE opens."""

SPICE = threading.RLock()
"""Held while a kernel is written. A progress callback may write another kernel in the same thread."""

LONGEST_LINE = 80
ROUNDING = 2.0**-51
"""Part of a rotation angle by which its sine may be off, with room."""


@dataclass(frozen=True, repr=False)
class Kernel(ShortRecord):
    """The codes, frames, clock and comments of a C-kernel."""

    instrument: int = -999000
    """Code of the body frame: its class ID."""
    body_frame: str = "ANDOYER_BODY"
    """Name of the body frame in the text kernel."""
    frame: str = "J2000"
    """Inertial frame of the scene, by a name that SPICE knows."""
    segment: str = "ANDOYER"
    """Name of the segments."""
    clock: str | os.PathLike[str] | None = None
    """A clock kernel (SCLK). By default the text kernel contains a clock of ephemeris seconds."""
    clock_id: int | None = None
    """Code of the clock: by default the thousands of a negative instrument code, otherwise -999."""
    date: datetime = J2000
    """Calendar date of time 0 in `time_system`; the seconds of the scene are TDB seconds. A scene whose epoch is a Time has its time 0 at the default."""
    time_system: str = "TDB"
    comments: tuple[str, ...] = ()
    """Lines for the comment area, after those on the scene."""

    @property
    def clock_code(self) -> int:
        """The code of the clock: the given one or the default."""
        if self.clock_id is not None:
            return self.clock_id
        return -(-self.instrument // 1000) if self.instrument <= -1000 else -999


class Written(NamedTuple):
    """The result of `write_ck`."""

    type: int
    """Type of the C-kernel: 2 or 3."""
    records: int
    """Number of records in all segments."""


def write_ck(
    path: str | os.PathLike[str],
    motion: Motion,
    interval: Any,
    kernel: Kernel = Kernel(),
    *,
    interpolation_error: float = 1e-8,
    progress: Progress = silent,
    force: bool = True,
) -> Written:
    """Write a motion as a C-kernel. The attitude that SPICE interpolates differs from the motion by at most a given angle.

    The function also writes the text kernel FILE.tsc for FILE.bc, with the frame of the body and, if no clock is given, a clock. SPICE has one state for the whole process: kernels
    are written one at a time, and other calls of SpiceyPy must wait until the function returns.

    Parameters
    ----------
    path : path-like
        File of the C-kernel, usually with the ending .bc.
    motion : Motion
        A motion with times in seconds, the unit of SPICE.
    interval : pair of float, Time or TimeDelta
        First and last time [s] of the scene. Times of astropy if the epoch of the scene is one; a TimeDelta counts from the epoch.
    kernel : Kernel, optional
        Codes, frames, clock, date of time 0, comments.
    interpolation_error : float, optional
        Largest angle [rad] between the attitude of SPICE and that of the motion.
    progress : callable, optional
        Called as ``progress(done, total)`` with numbers of windows.
    force : bool, optional
        If True, existing files are replaced.

    Returns
    -------
    Written
        Type of the segments and number of their records.

    Raises
    ------
    ImportError
        SpiceyPy is not installed; ``pip install spiceypy`` installs it.
    FileExistsError
        The file exists, and ``force=False``.
    InputError
        An interval of zero length, or of Time objects if the epoch of the scene is a number; an error below 1e-13 rad, or one that needs more than 5e7 records; a frame that SPICE does
        not know; a name that is too long for SPICE; a date of time 0 for a scene whose epoch is a Time.
    OSError
        An error of SPICE, with its message.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> written = output.write_ck("wobble.bc", motion, (0.0, 60.0), interpolation_error=1e-6)
    >>> written.type, 7500 < written.records < 7600
    (3, True)
    """
    spice = extra("spiceypy", "writing a C-kernel")
    epoch = epoch_of(motion.scene)
    begin, end = _ends(scene_times("interval", interval, epoch))
    _check(path, begin, end, interpolation_error)
    zero = _time_zero(kernel, hasattr(epoch, "jd1"))
    steady = motion.plan.mode in STEADY and motion.scene.orbit is None
    segments = _uniform(motion, begin, end, interpolation_error, zero) if steady else _tabulated(motion, begin, end, interpolation_error, zero, progress)
    # The text kernel is beside the given name, also if this is a link to a file elsewhere.
    text = Path(path).with_suffix(".tsc")
    with SPICE, whole_file(path, force) as binary, whole_file(text, force) as beside, _plain_errors(spice), _clock(spice, kernel, zero + begin) as ticks:
        if not spice.namfrm(kernel.frame):
            known = "one that SPICE knows, such as J2000 or ECLIPJ2000"
            raise refusal("frame", kernel.frame, known, f"must be {known}: got {kernel.frame!r}")
        beside.write_text(_text_kernel(kernel, zero + begin), encoding="ascii", errors="replace")
        binary.unlink()
        return _write(spice, binary, segments, kernel, (ticks, zero), _comments(motion, kernel, interpolation_error), interpolation_error)


class _Segment(NamedTuple):
    """Records of one segment: times [s] of the scene, attitudes, angular velocities in inertial components."""

    times: Array
    attitude: Array
    angular_velocity: Array
    uniform: bool


def _ends(interval: Any) -> tuple[float, float]:
    """First and last time."""
    try:
        begin, end = (float(time) for time in interval)
    except (TypeError, ValueError):
        raise refusal("interval", repr(interval), "two times", f"must be two times: got {interval!r}") from None
    return begin, end


def _check(path: str | os.PathLike[str], begin: float, end: float, error: float) -> None:
    if not (math.isfinite(begin) and math.isfinite(end) and begin < end):
        raise refusal("interval", (begin, end), "two finite times", f"must be two finite times, the first below the second: got {(begin, end)!r}")
    if not SMALLEST_ERROR <= error < math.inf:
        raise refusal("interpolation_error", error, SMALLEST_ERROR, f"must be finite and at least {SMALLEST_ERROR:g} rad: got {error!r}")
    length, most = len(os.fsencode(os.path.realpath(path))), LONGEST_NAME - 16
    if length >= most:
        raise refusal("path", length, most, f"must have fewer than {most} characters for SPICE: got {length}")


def _time_zero(kernel: Kernel, of_calendar: bool) -> float:
    """Time 0 of the scene in TDB seconds since J2000."""
    given = f"{kernel.date.isoformat()} {kernel.time_system}"
    if kernel.time_system not in TIME_SYSTEMS:
        allowed = ", ".join(TIME_SYSTEMS)
        raise refusal("time_system", kernel.time_system, allowed, f"must be one of {allowed}: got {kernel.time_system!r}")
    if of_calendar and (kernel.date, kernel.time_system) != (J2000, "TDB"):
        default = f"{J2000.isoformat()} TDB"
        raise refusal("date", given, default, f"must be {default}, the time 0 of a scene whose epoch is a Time: got {given}")
    try:
        return seconds_of_tdb(kernel.date, kernel.time_system)
    except ValueError as error:
        raise refusal("date", given, "a time of the calendar", f"= {given}: {error}") from error


def _segment(motion: Motion, times: Array, zero: float, uniform: bool) -> _Segment:
    """Evaluate the motion at times that are exact in ephemeris time: the sum with `zero` seconds is rounded first."""
    times = (zero + times) - zero
    samples = motion.at(times)
    return _Segment(times, samples.attitude, rotate(samples.attitude, samples.angular_velocity), uniform)


def _uniform(motion: Motion, begin: float, end: float, error: float, zero: float) -> Iterator[_Segment]:
    """Records of type 2: one, or as many as keep the rounding of the angle of a record below the error."""
    angle = float(np.linalg.norm(motion.angular_velocity(begin))) * (end - begin)
    count = max(1, math.ceil(angle * ROUNDING / error))
    _limit(count, error)
    yield _segment(motion, np.linspace(begin, end, count + 1), zero, True)


def _tabulated(motion: Motion, begin: float, end: float, error: float, zero: float, progress: Progress) -> Iterator[_Segment]:
    """Segments of type 3, each with whole windows. Neighbouring segments share a node, so that there is no gap."""
    borders = windows(motion, begin, end)
    _limit(round(estimate(motion, borders, error)), error)
    parts: list[Array] = []
    try:
        for done, times in enumerate(nodes(motion, borders, error), 1):
            parts.append(times[1:] if parts else times)
            if done == len(borders) - 1 or sum(map(len, parts)) > LONGEST_SEGMENT:
                yield _segment(motion, np.concatenate(parts), zero, False)
                parts = []
            progress(done, len(borders) - 1)
    except ArithmeticError as left:
        message = f"must be above the rounding error of this motion: got {error!r}, but {left}"
        raise refusal("interpolation_error", error, "above the rounding error", message) from left


def _limit(records: int, error: float) -> None:
    if records > MOST_RECORDS:
        message = f"= {error:g} rad needs about {records} records over this interval, more than {MOST_RECORDS}: ask for a larger error or a shorter interval"
        raise refusal("interpolation_error", records, MOST_RECORDS, message)


@contextmanager
def _clock(spice: Any, kernel: Kernel, begin: float) -> Iterator[Any]:
    """Conversion of ephemeris times to ticks, by the given clock, which is loaded meanwhile, or by the written clock."""
    if kernel.clock is None:
        yield lambda times: times - math.floor(begin)
        return
    spice.furnsh(os.fspath(kernel.clock))
    try:
        yield lambda times: np.array([spice.sce2c(kernel.clock_code, float(time)) for time in times])
    finally:
        spice.unload(os.fspath(kernel.clock))


@contextmanager
def _plain_errors(spice: Any) -> Iterator[None]:
    """Turn an error of SPICE into an OSError with its short message and its explanation."""
    try:
        yield
    except spice.exceptions.SpiceyError as error:
        spice.reset()
        raise OSError(f"SPICE: {error.short} {' '.join((error.long or error.explain or '').split())}") from error


def _write(spice: Any, path: Path, segments: Iterator[_Segment], kernel: Kernel, clock: tuple[Any, float], comments: Sequence[str], error: float) -> Written:
    """Write the segments; `clock` has the conversion to ticks and time 0 of the scene."""
    ticks, zero = clock
    handle = spice.ckopn(str(path), "ANDOYER", 0)
    try:
        spice.dafac(handle, list(comments))
        written = Written(3, 0)
        for segment in segments:
            times = ticks(zero + segment.times)
            if np.any(np.diff(times) <= 0):
                apart = float(np.spacing(times[-1]))
                message = f"must leave records that the clock tells apart: some are less than {apart:.2g} ticks apart"
                raise refusal("interpolation_error", error, f"records {apart:.2g} ticks apart", message)
            quaternions = np.ascontiguousarray(segment.attitude[:, [3, 0, 1, 2]] * np.array([1.0, -1.0, -1.0, -1.0]))
            head = (handle, times[0], times[-1], kernel.instrument, kernel.frame)
            if segment.uniform:
                rates = np.diff(segment.times) / np.diff(times)
                spice.ckw02(*head, kernel.segment, len(times) - 1, times[:-1], times[1:], quaternions[:-1], segment.angular_velocity[:-1], rates)
                written = Written(2, len(times) - 1)
            else:
                spice.ckw03(*head, True, kernel.segment, len(times), times, quaternions, segment.angular_velocity, 1, times[:1])
                written = Written(3, written.records + len(times))
    except BaseException:
        # A file with no segment cannot be closed as a C-kernel, one on a full disk not at all.
        spice.reset()
        try:
            spice.dafcls(handle)
        except Exception:
            spice.reset()
        raise
    spice.ckcls(handle)
    return written


def _comments(motion: Motion, kernel: Kernel, error: float) -> list[str]:
    """The comment area: a description of the kernel, its error, the scene."""
    plan = motion.plan
    lines = [
        f"Attitude of {motion.scene.name or motion.scene.body.name or 'a rigid body'}, written by andoyer {__version__}.",
        "",
        f"Frame {kernel.body_frame} (class ID {kernel.instrument}) against {kernel.frame}; clock {kernel.clock_code}.",
        f"Time 0 of the scene is {kernel.date.isoformat()} {kernel.time_system}.",
        f"Error bound of the motion: {plan.error_bound:.3g} rad; of SPICE's interpolation: {error:.3g} rad.",
        "The bound of the interpolation is on the attitude. Angular velocities are those of the motion at the",
        "records and interpolated linearly between them.",
        *([] if plan.missed_tolerance is None else [plan.missed_tolerance]),
        *kernel.comments,
        "",
        "The scene:",
        "",
        *motion.scene.to_toml().splitlines(),
    ]
    return [piece for line in lines for piece in _pieces(line)]


def _pieces(line: str) -> list[str]:
    """A line in printable ASCII, in pieces that are short enough for SPICE."""
    text = "".join(letter if letter.isprintable() else " " for letter in line.encode("ascii", "replace").decode())
    return [text[start : start + LONGEST_LINE] for start in range(0, len(text), LONGEST_LINE)] or [" "]


def _text_kernel(kernel: Kernel, begin: float) -> str:
    """The frame of the body and, unless one is given, a clock whose ticks are seconds of TDB."""
    code, name, clock = kernel.instrument, kernel.body_frame, kernel.clock_code
    lines = [
        "KPL/SCLK" if kernel.clock is None else "KPL/FK",
        "",
        f"Written by andoyer {__version__} beside a C-kernel.",
        "",
        r"\begindata",
        "",
        f"FRAME_{name} = {code}",
        f"FRAME_{code}_NAME = '{name}'",
        f"FRAME_{code}_CLASS = 3",
        f"FRAME_{code}_CLASS_ID = {code}",
        f"FRAME_{code}_CENTER = {clock}",
        f"CK_{code}_SCLK = {clock}",
        f"CK_{code}_SPK = {clock}",
        "",
    ]
    if kernel.clock is None:
        number, zero = -clock, math.floor(begin)
        lines += [
            "SCLK_KERNEL_ID = ( @2000-01-01 )",
            f"SCLK_DATA_TYPE_{number} = ( 1 )",
            f"SCLK01_TIME_SYSTEM_{number} = ( 1 )",
            f"SCLK01_N_FIELDS_{number} = ( 2 )",
            f"SCLK01_MODULI_{number} = ( 1000000000000 1 )",
            f"SCLK01_OFFSETS_{number} = ( 0 0 )",
            f"SCLK01_OUTPUT_DELIM_{number} = ( 1 )",
            f"SCLK_PARTITION_START_{number} = ( 0.0 )",
            f"SCLK_PARTITION_END_{number} = ( 1000000000000.0 )",
            f"SCLK01_COEFFICIENTS_{number} = ( 0.0 {zero:d} 1.0 )",
            "",
        ]
    return "\n".join([*lines, r"\begintext", ""])
