"""The spin state of a SHAPE model (.mod): section {SPIN STATE}, in and out.

SHAPE is the program of Hudson, Ostro and Magri for radar and light curves. As its source has it (read_mod.c, write_mod.c, inteuler.c, euler.c): angles 0, 1, 2
are φ, θ, ψ of the rotation from ecliptic components to body components, R_z(ψ) R_x(θ) R_z(φ) of axes. In this package it is the attitude
`from_euler("ZXZ", [φ, θ, ψ])` of SciPy: intrinsic, body to ecliptic components. The pole, body axis 3, has ecliptic longitude φ − 90° and latitude 90° − θ. The spin is in body
components, which are about the principal axes. Only ratios of the moments count. The date t0 is UTC, and the light left the asteroid at this time.
"""

from __future__ import annotations

import os
import re
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from andoyer._core import Body, Error, FileError, Scene
from andoyer._extra import extra
from andoyer._quaternions import Array, rotate
from andoyer._refusal import refusal, unreadable
from andoyer.interop._foreign import epoch_of
from andoyer.output.files import whole_file
from andoyer.output.message import NUMBER

DEGREES_A_DAY = np.pi / 180 / 86400
"""1 deg/day in rad/s."""
NEAR_SECOND = 1e-6
"""Seconds by which an epoch may miss a whole one, which alone the format can hold."""

TOKEN = re.compile(r"\{([^}]*)\}|([^\s{}]+)|([{}])")
DATE = ("year", "month", "day", "hour", "minute", "second")
STATE = (*(f"angle {axis}" for axis in range(3)), *(f"spin {axis}" for axis in range(3)), *(f"moment of inertia {axis}" for axis in range(3)))
CHANGES = (*(f"spin {axis} dot" for axis in range(3)), "libration amplitude", "libration frequency", "libration phase")
"""Values after the state; files of old versions lack the last or all of them."""


def read_shape(path: str | os.PathLike[str]) -> Scene:
    """Read the spin state of a SHAPE model as a scene.

    The flags c, f and = are read and dropped. Where SHAPE holds spins 0 and 1 at 0 it ignores the moments, and the scene has them all the same.

    Parameters
    ----------
    path : path-like
        File with a section {SPIN STATE}; the sections before it are not read.

    Returns
    -------
    Scene
        About the principal axes, in seconds: attitude to ecliptic axes of J2000, angular velocity [rad/s], moments in the unit of the file. The epoch is an
        astropy Time in UTC.

    Raises
    ------
    ImportError
        Without astropy.
    FileError
        A value that is missing or no number, with the line; a spin that changes by other than free motion: spin dot, libration or impulses that are not 0.
    """
    words = _section(path)
    date = [int(_take(path, words, name, whole=True)) for name in DATE]
    line = words.line
    try:
        moment = datetime(*date)  # type: ignore[arg-type]
    except (ValueError, OverflowError) as error:
        raise _damaged(path, line, f"the date of t0 must be in the calendar: {error}") from None
    values = []
    for name in STATE:
        _flag(path, words, name)
        values.append(_take(path, words, name))
    angles, spin, moments = np.radians(values[:3]), np.array(values[3:6]) * DEGREES_A_DAY, values[6:]
    line = words.line
    _free(path, words)
    time = extra("astropy.time", "the epoch of a SHAPE model").Time(moment, scale="utc")
    try:
        return Scene(Body(moments), _attitude(angles), spin, epoch=time)
    except Error as error:
        raise _damaged(path, line, f"the spin state to this line is no scene: {error}") from error


def write_shape(path: str | os.PathLike[str], scene: Scene, *, force: bool = False) -> None:
    """Write the state of a scene as the section {SPIN STATE} of a SHAPE model, every value held fixed (flag c).

    The other sections of a model are not written; insert the section into yours. Moments are divided by the largest.

    Parameters
    ----------
    path : path-like
        File to write, whole or not at all.
    scene : Scene
        Free body in seconds, attitude to ecliptic axes of J2000. The epoch must be an astropy Time, at a whole second of UTC: of another, give
        ``scene.solve().scene_at(Time(…))``. A body with a tensor is written about its principal axes.
    force : bool, optional
        If True, an existing file is replaced, with all sections that it has.

    Raises
    ------
    FileExistsError
        The file exists, and ``force=False``.
    InputError
        A scene with an orbit or torques; an epoch without a date, or between seconds.

    Examples
    --------
    >>> from astropy.time import Time
    >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [1e-4, 2e-4, 1e-3], epoch=Time("2020-01-01T00:00:00", scale="utc"))
    >>> interop.write_shape("spin.mod", scene)
    >>> bool(abs(interop.read_shape("spin.mod").angular_velocity - scene.angular_velocity).max() < 1e-18)
    True
    """
    if scene.orbit is not None or scene.torques:
        raise refusal("scene", "orbit or torques", "a free body", "has an orbit or torques: SHAPE knows the free motion alone")
    epoch = epoch_of(scene)
    if not hasattr(epoch, "jd1"):
        raise refusal("scene", epoch, "a Time", "must have a Time of astropy as its epoch: SHAPE needs a date")
    date, axes = _whole_second(epoch), scene.body.principal_axes.T
    # Rows: the principal axes in ecliptic components, which is SHAPE's matrix m.
    matrix = rotate(np.broadcast_to(scene.attitude, (3, 4)), axes)
    angles = np.degrees(_angles(matrix)) % 360
    spin = axes @ scene.angular_velocity / DEGREES_A_DAY
    moments = scene.body.moments / scene.body.moments.max()
    period = f" P={360 * 24 / spin[2]:f}" if spin[2] else ""
    notes = [f" (deg) lambda={(angles[0] - 90) % 360:f}", f" (deg) beta={90 - angles[1]:f}", " (deg)", *[" (deg/day)"] * 2, f" (deg/day){period}", "", "", ""]
    lines = ["{SPIN STATE}", f"{' '.join(f'{part:2d}' for part in date.timetuple()[:6])} {{yyyy mo dd hh mm ss of t0}}"]
    lines += [f" c {value:24.16f} {{{name}{note}}}" for name, note, value in zip(STATE, notes, [*angles, *spin, *moments])]
    units = [*["(deg/day/day)"] * 3, "(degrees)", "(degrees/day)", "(degrees)"]
    lines += [f" c {0.0:24.16f} {{{name if 'dot' in name else name.title()} {unit}}}" for name, unit in zip(CHANGES, units)]
    with whole_file(path, force) as temporary:
        temporary.write_text("\n".join([*lines, f"   {0:24d} {{number of spin impulses}}"]) + "\n", encoding="ascii")


class _Words:
    """The words outside of comments, each with its line; `line` is that of the last word taken."""

    def __init__(self, words: list[tuple[int, str]], line: int):
        self.words, self.line, self.place = words, line, 0

    def rest(self) -> int:
        return len(self.words) - self.place

    def take(self) -> str:
        self.line, word = self.words[self.place]
        self.place += 1
        return word


def _section(path: str | os.PathLike[str]) -> _Words:
    data = Path(path).read_bytes()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _damaged(path, data[: error.start].count(b"\n") + 1, "must be text") from error
    words: list[tuple[int, str]] = []
    start = 0
    line, before = 1, 0
    for match in TOKEN.finditer(text):
        line, before = line + text.count("\n", before, match.start()), match.start()
        if match[3]:
            raise _damaged(path, line, "a comment must begin with { and end with }")
        if match[1] is not None and match[1].strip().upper() == "SPIN STATE":
            if start:
                raise _damaged(path, line, f"a second {{SPIN STATE}}: the first is in line {start}")
            start, words = line, []
        elif match[2] and start:
            words.append((line, match[2]))
    if not start:
        raise _damaged(path, 1, "the file has no {SPIN STATE}")
    return _Words(words, start)


def _take(path: str | os.PathLike[str], words: _Words, name: str, whole: bool = False) -> float:
    if not words.rest():
        raise _damaged(path, words.line, f"the spin state ends before {name}")
    word = words.take()
    if not NUMBER.fullmatch(word) or not np.isfinite(float(word)) or (whole and not word.isdigit()):
        raise _damaged(path, words.line, f"{name} must be a {'whole' if whole else 'finite'} number: got {word!r}")
    return float(word)


def _flag(path: str | os.PathLike[str], words: _Words, name: str) -> None:
    if not words.rest():
        raise _damaged(path, words.line, f"the spin state ends before {name}")
    word = words.take()
    if word not in ("c", "f", "="):
        raise _damaged(path, words.line, f"{name} must begin with c, f or =: got {word!r}")


def _free(path: str | os.PathLike[str], words: _Words) -> None:
    """The rest of the section must leave the body free."""
    for name in CHANGES:
        if not words.rest() or words.words[words.place][1] not in ("c", "f", "="):
            break
        words.take()
        value = _take(path, words, name)
        # Without an amplitude the frequency and phase of a libration count for nothing.
        if value and name not in ("libration frequency", "libration phase"):
            raise _damaged(path, words.line, f"{name} must be 0, as of a free body: got {value!r}")
    if words.rest():
        impulses = _take(path, words, "number of spin impulses", whole=True)
        if impulses:
            raise _damaged(path, words.line, f"number of spin impulses must be 0, as of a free body: got {impulses:.0f}")
    if words.rest():
        word = words.take()
        raise _damaged(path, words.line, f"the spin state must end after the number of spin impulses: got {word!r}")


def _attitude(angles: Array) -> Array:
    """The quaternion of turns by φ about z, θ about the new x, ψ about the new z."""
    half, sum_, difference = angles[1] / 2, (angles[0] + angles[2]) / 2, (angles[0] - angles[2]) / 2
    return np.array([np.sin(half) * np.cos(difference), np.sin(half) * np.sin(difference), np.cos(half) * np.sin(sum_), np.cos(half) * np.cos(sum_)])


def _angles(matrix: Array) -> Array:
    """φ, θ, ψ of a matrix from ecliptic to body components, with θ from 0 to π; ψ = 0 where the pole is that of the ecliptic.

    ψ is found from the matrix turned back by φ, so that φ + ψ keeps its digits near the pole of the ecliptic, where each of them loses its own.
    """
    phi = np.arctan2(matrix[2, 0], -matrix[2, 1]) if matrix[2, 0] or matrix[2, 1] else np.arctan2(matrix[0, 1], matrix[0, 0])
    cosine, sine = np.cos(phi), np.sin(phi)
    node = np.array([cosine, sine, 0.0])
    psi = np.arctan2(-matrix[1] @ node, matrix[0] @ node)
    return np.array([phi, np.arctan2(np.hypot(matrix[2, 0], matrix[2, 1]), matrix[2, 2]), psi])


def _whole_second(epoch: Any) -> datetime:
    date: datetime = epoch.utc.to_datetime()
    nearest = (date + timedelta(microseconds=500_000)).replace(microsecond=0)
    missed = abs((date - nearest).total_seconds())
    if missed > NEAR_SECOND:
        raise refusal("scene", str(epoch), "a whole second", f"must have an epoch at a whole second of UTC: {epoch.utc.isot} misses it by {missed:.6f} s")
    return nearest


def _damaged(path: str | os.PathLike[str], line: int, message: str) -> FileError:
    return unreadable(path, f"line {line}: {message}")
