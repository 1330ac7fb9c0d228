"""SPICE kernels: C-kernels of motions and of samples, binary PCK of motions. The Rust crates write them; SpiceyPy is needed only to convert times by a clock kernel that is given."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from andoyer._core import InputError, Motion, Samples, _clock_code, _frame_code, _write_motion, _write_samples
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.interop._foreign import epoch_of, scene_times
from andoyer.output.calendar import J2000, TIME_SYSTEMS, seconds_of_tdb
from andoyer.output.record import ShortRecord
from andoyer.output.rows import calendar_times, rows
from andoyer.output.table import Progress, silent

DELTET = {"DELTA_T_A": [32.184], "K": [1.657e-3], "EB": [1.671e-2], "M": [6.239996, 1.99096871e-7]}
"""Constants of TT and TDB for SPICE, as in NAIF's leapseconds kernel naif0012.tls: a clock in TDT needs them, and no leap seconds, because no time is in UTC."""

SPICE = threading.RLock()
"""Held while SpiceyPy has the clock kernel of the user: SPICE has one state for the whole process."""


@dataclass(frozen=True, repr=False)
class Kernel(ShortRecord):
    """The codes, frames, clock and comments of a kernel."""

    instrument: int = None  # type: ignore[assignment]
    """Code of the body frame: its class ID, negative or at least 1,000,000. By default -999000 for the frame ANDOYER_BODY, otherwise a number from -2,147,483,646 to -1,000,000,000
    that is computed from `body_frame`, the same in every run."""
    body_frame: str = "ANDOYER_BODY"
    """Name of the body frame: 1 to 26 capital letters, digits and _, with a letter first, that SPICE has not taken."""
    frame: str = "J2000"
    """Inertial frame of the scene: J2000, ECLIPJ2000, ICRF or another one that SPICE knows."""
    segment: str = "ANDOYER"
    """Name of the segments."""
    clock: str | os.PathLike[str] | None = None
    """A clock kernel (SCLK) of the user, whose ticks SpiceyPy computes. By default the text kernel has the clock of this package, the same for every kernel."""
    clock_id: int | None = None
    """Code of the clock: by default -999, with `clock` the thousands of `instrument`."""
    date: datetime = J2000
    """Calendar date of time 0 in `time_system`; the seconds of the scene are TDB seconds. A scene whose epoch is a Time has its time 0 at the default."""
    time_system: str = "TDB"
    comments: tuple[str, ...] = ()
    """Lines for the comment area, after those on the scene."""
    center: int | None = None
    """NAIF code of the frame's centre. By default that of the body that `instrument` names: the thousands of a code from -1000 to -999,999,999, otherwise the code itself."""

    def __post_init__(self) -> None:
        if self.instrument is None:
            object.__setattr__(self, "instrument", _frame_code(str(self.body_frame)))
        for name, code in (("instrument", self.instrument), ("clock_id", self.clock_id), ("center", self.center)):
            if code is not None and not (isinstance(code, (int, np.integer)) and -(2**31) < code < 2**31):
                raise refusal(name, code, "a code", f"must be a whole number of 32 bits: got {code!r}")
        if not isinstance(self.date, datetime):
            raise TypeError(f"date must be a datetime: got {self.date!r}")

    @property
    def clock_code(self) -> int:
        """The code of the clock: the given one or the default."""
        return _clock_code(self.instrument, self.clock is not None) if self.clock_id is None else self.clock_id


class Written(NamedTuple):
    """The result of `write_ck` and `write_pck`."""

    type: int
    """Type of the segments: 2 or 3."""
    records: int
    """Number of records in all segments."""
    error: float
    """Largest error [rad] of the attitude that SPICE computes: interpolation, and rounding of times past J2000 (6e-8 s in 2026). For samples it is an estimate, and infinite where
    there is none: without rates, for two samples alone."""


def write_ck(
    path: str | os.PathLike[str],
    motion: Motion | Samples,
    interval: Any = None,
    kernel: Kernel = Kernel(),
    *,
    interpolation_error: float = 1e-8,
    longest_step: float = np.inf,
    progress: Progress = silent,
    force: bool = True,
) -> Written:
    """Write a motion, or samples of any origin, as a C-kernel.

    The function also writes the text kernel FILE.tsc for FILE.bc, with the frame of the body and, if no clock is given, the clock. Kernels of any bodies and intervals can be loaded
    together in any order. Threads and processes may write at the same time.

    Parameters
    ----------
    path : path-like
        File of the C-kernel, usually with the ending .bc.
    motion : Motion or Samples
        A motion with times in seconds, the unit of SPICE; or samples of one motion, such as those of `read_aem`. Angular velocities that are all NaN are left out.
    interval : pair of float, Time or TimeDelta, optional
        First and last time [s] of the scene; samples outside are left out. A motion needs it. Times of astropy if the epoch of the scene is one; a TimeDelta counts from the epoch.
    kernel : Kernel, optional
        Codes, frames, clock, date of time 0, comments.
    interpolation_error : float, optional
        Largest angle [rad] between the attitude that SPICE interpolates and that of the motion. Samples are written as they are.
    longest_step : float, optional
        Two samples that are farther apart [s] end an interval; SPICE has no attitude between them.
    progress : callable, optional
        Called as ``progress(done, total)`` with numbers of windows.
    force : bool, optional
        If True, existing files are replaced, FILE.tsc too.

    Returns
    -------
    Written
        Type of the segments, number of their records, error.

    Raises
    ------
    ImportError
        A clock kernel is given, and SpiceyPy is not installed; ``pip install spiceypy`` installs it.
    FileExistsError
        The file exists, and ``force=False``.
    InputError
        An interval of zero length, outside the times of the clock, or of Time objects if the epoch of the scene is a number; an error below 1e-13 rad, or one that needs more than
        5e7 records; a name or a code that SPICE cannot use; a date of time 0 for a scene whose epoch is a Time; samples of an ensemble, fewer than two, at times that do not increase, or half a turn apart; a
        clock kernel with the name of the text kernel.
    OSError
        An error of the system, or of SpiceyPy with a clock kernel.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> written = output.write_ck("wobble.bc", motion, (0.0, 60.0), interpolation_error=1e-6)
    >>> written.type, 7500 < written.records < 7600
    (3, True)
    """
    names = (kernel.body_frame, kernel.frame, kernel.instrument, kernel.segment, kernel.center, kernel.clock_id, kernel.clock is not None)
    text = Path(path).with_suffix(".tsc")
    if kernel.clock is not None and text.exists() and text.samefile(kernel.clock):
        raise refusal(
            "clock", str(kernel.clock), "another name", f"= {kernel.clock}: the text kernel beside {path} has this name; choose another one for either"
        )
    with _ticks(kernel) as ticks:
        if isinstance(motion, Motion):
            zero, ends = _times(motion, interval, kernel)
            options = (zero, float(interpolation_error), force, _comments(kernel), ticks, progress)
            return Written(*_write_motion(path, motion, ends, False, names, options))
        times, attitude, rates, zero = _given(motion, interval, kernel)
        options = (zero, float(interpolation_error), force, _comments(kernel), ticks, progress)
        return Written(*_write_samples(path, times, attitude, rates, float(longest_step), names, options))


def write_pck(
    path: str | os.PathLike[str],
    motion: Motion,
    span: Any,
    *,
    body: int | None = None,
    frame: str = "J2000",
    body_frame: str = "ANDOYER_BODY",
    center: int | None = None,
    interpolation_error: float = 1e-9,
    date: datetime = J2000,
    time_system: str = "TDB",
    progress: Progress = silent,
    force: bool = True,
) -> Written:
    """Write a motion as a binary PCK of type 2: Chebyshev polynomials of three Euler angles.

    The function also writes the text kernel FILE.tf for FILE.bpc, with the frame of the body. Each segment has the one of the inertial frames J2000, ECLIPJ2000 and GALACTIC from whose
    poles the body's axis 3 stays farthest, because the angles are singular there.

    Parameters
    ----------
    path : path-like
        File of the kernel, usually with the ending .bpc.
    motion : Motion
        A motion with times in seconds.
    span : pair of float, Time or TimeDelta
        First and last time, as ``interval`` of `write_ck`.
    body : int, optional
        Class ID of the body frame, as ``instrument`` of `Kernel`; not one by which SPICE has a rotating frame of its own.
    frame, body_frame, center, date, time_system
        As the fields of `Kernel`. The frames of C-kernels and of PCK need different names.
    interpolation_error, progress, force
        As in `write_ck`.

    Returns
    -------
    Written
        Type 2, the number of polynomials for each angle, error.

    Raises
    ------
    FileExistsError, InputError, OSError
        As `write_ck`.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> written = output.write_pck("wobble.bpc", motion, (0.0, 60.0), body=2099942, body_frame="WOBBLING")
    >>> written.type, written.records < 60, written.error < 1.01e-9
    (2, True, True)
    """
    kernel = Kernel(body, body_frame, frame, date=date, time_system=time_system, center=center)  # type: ignore[arg-type]
    zero, ends = _times(motion, span, kernel)
    names = (body_frame, frame, kernel.instrument, kernel.segment, center, None, False)
    options = (zero, float(interpolation_error), force, _comments(kernel), None, progress)
    try:
        return Written(*_write_motion(path, motion, ends, True, names, options))
    except InputError as error:
        if error.argument != "instrument":
            raise
        raise refusal("body", error.value, error.bound, str(error).removeprefix("instrument ")) from None


def _times(motion: Motion, interval: Any, kernel: Kernel) -> tuple[float, tuple[float, float]]:
    """Time 0 of a scene in TDB seconds past J2000, and the ends of the interval in its times."""
    epoch = epoch_of(motion.scene)
    try:
        begin, end = (float(time) for time in scene_times("interval", interval, epoch))
    except InputError:
        raise
    except (TypeError, ValueError):
        raise refusal("interval", repr(interval), "two times", f"must be two times: got {interval!r}") from None
    return _zero(kernel, hasattr(epoch, "jd1")), (begin, end)


def _given(samples: Samples, interval: Any, kernel: Kernel) -> tuple[Array, Array, Array | None, float]:
    """Times, attitudes, rates or None, and time 0 of samples."""
    table, calendar = rows(samples), calendar_times(samples)
    if interval is not None:
        begin, end = scene_times("interval", interval, 0.0 if calendar is None else calendar[0])
        table = table[(table[:, 0] >= begin) & (table[:, 0] <= end)]
    times, attitude, rates = table[:, 0], table[:, 1:5], table[:, 5:]
    return times, attitude, None if np.isnan(rates).all() else rates, _zero(kernel, calendar is not None)


def _zero(kernel: Kernel, of_calendar: bool) -> float:
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


def _comments(kernel: Kernel) -> list[str]:
    lines = (kernel.comments,) if isinstance(kernel.comments, str) else kernel.comments
    return [f"Time 0 of the scene is {kernel.date.isoformat()} {kernel.time_system}.", *(part for line in lines for part in line.splitlines())]


@contextmanager
def _ticks(kernel: Kernel) -> Iterator[Any]:
    """The conversion of ephemeris times to ticks of the user's clock, whose kernel is loaded meanwhile; None without one."""
    if kernel.clock is None:
        yield None
        return
    spice = extra("spiceypy", "the ticks of a clock kernel")
    with SPICE:
        try:
            spice.furnsh(os.fspath(kernel.clock))
            missing = [f"DELTET/{name}" for name in DELTET if not spice.expool(f"DELTET/{name}")]
            for name in missing:
                spice.pdpool(name, DELTET[name.removeprefix("DELTET/")])
            try:
                yield lambda times: [spice.sce2c(kernel.clock_code, time) for time in times]
            finally:
                for name in missing:
                    spice.dvpool(name)
                spice.unload(os.fspath(kernel.clock))
        except spice.exceptions.SpiceyError as error:
            spice.reset()
            raise OSError(f"SPICE: {error.short} {' '.join((error.long or error.explain or '').split())}") from error
