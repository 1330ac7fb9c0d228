"""Readers of photometry: ALCDEF files of magnitudes, and light-curve files of DAMIT and convexinv.

Sources: *The Asteroid Lightcurve Data Exchange Format Standard* (ALCDEF) v 2.1.1 (2015), whose sections are named below; for the other the
description of its input that programs around convexinv give.
"""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from andoyer._core import FileError
from andoyer._quaternions import Array
from andoyer._refusal import unreadable
from andoyer.output.message import NUMBER

WHOLE = re.compile(r"\d{1,9}", re.ASCII)
KEYWORD = re.compile(r"([A-Z][A-Z0-9_]*)\s*=\s*(.*)", re.ASCII)
CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
LINE_END = re.compile(r"\r\n|\r|\n")

UTC = "UTC"
UTC_AT_ASTEROID = "UTC (light time applied)"
AT_ASTEROID = "not stated (light time applied)"

DELIMITERS = {"PIPE": "|", "TAB": "\t"}
"""Names of delimiters, section 1.1.3: the standard excludes the space and the comma."""
CHOICES = {
    "DELIMITER": tuple(DELIMITERS),
    "DIFFERMAGS": ("TRUE", "FALSE"),
    "STANDARD": ("NONE", "INTERNAL", "TRANSFORMED"),
    "LTCAPP": ("NONE", "AVERAGE", "POINT"),
    "LTCTYPE": ("NONE", "LIGHTTIME"),
    "REDUCEDMAGS": ("NONE", "AVERAGE", "POINT"),
}
"""Values of the keywords that say what the numbers are, section 5."""
NUMBERS = ("LTCDAYS", "MAGADJUST", "UCORMAG", "PHASE", "PABL", "PABB")
LIGHT_TIME = 0.005772
"""Days per au in LTCDAYS = -0.005772 * distance, section 5."""
JULIAN = (1_000_000.0, 4_000_000.0)
"""Julian dates that are taken: years −1975 to 6239. A modified Julian date is outside."""


@dataclass(frozen=True, eq=False)
class LightCurves:
    """Light curves of a file, n points in k curves. What the file does not have is None.

    Attributes
    ----------
    times : ndarray, shape (n,)
        Julian dates as in the file.
    time_scale : str
        Scale of the dates: "UTC", "UTC (light time applied)" or "not stated (light time applied)". If the light time is applied, the light left the asteroid
        at this time; otherwise it arrived.
    magnitudes : ndarray, shape (n,), or None
        Magnitudes, with MAGADJUST of the curve added.
    brightness : ndarray, shape (n,), or None
        Intensities, in any unit. Those of calibrated curves are reduced to 1 au from the Sun and 1 au from the observer.
    sigma : ndarray, shape (n,), or None
        Errors of the magnitudes; NaN for a point without one.
    curves : ndarray of int, shape (n,)
        Number of the curve of each point, from 0.
    sun, observer : ndarray, shape (n, 3), or None
        Vectors [au] from the asteroid to the Sun and to the observer, in the ecliptic axes of the file, which its format does not date.
    distances : ndarray, shape (n,), or None
        Distance [au] from the asteroid to the observer; NaN in a curve without one.
    relative : ndarray of bool, shape (k,)
        True for a curve with a zero point of its own.
    metadata : list of dict
        Keywords and texts of each curve. The texts of a keyword that is given several times are joined by line ends.
    """

    times: Array
    time_scale: str
    magnitudes: Array | None
    brightness: Array | None
    sigma: Array | None
    curves: np.typing.NDArray[np.int64]
    sun: Array | None
    observer: Array | None
    distances: Array | None
    relative: np.typing.NDArray[np.bool_]
    metadata: list[dict[str, str]]

    def __len__(self) -> int:
        """The number of points."""
        return len(self.times)

    def __repr__(self) -> str:
        first, last = self.times.min(), self.times.max()
        return f"LightCurves({len(self)} points in {len(self.relative)} curve{'s' * (len(self.relative) > 1)}, JD {first:.5f} to {last:.5f} {self.time_scale})"


def read_alcdef(path: str | os.PathLike[str]) -> LightCurves:
    """Read the light curves of an ALCDEF file.

    A curve is a block STARTMETADATA … ENDMETADATA, DATA=…, ENDDATA. Its magnitudes are relative if DIFFERMAGS is TRUE or STANDARD is NONE. They are reduced to
    1 au from the Sun and 1 au from the observer if REDUCEDMAGS in the metadata is not NONE; the reader does not reduce them. Dates are UTC at mid-exposure. LTCAPP
    other than NONE states that the light time is subtracted. LTCDAYS is the light time at the middle of the session, whether applied or not; it gives
    `distances`, one for each curve. Air masses are read and dropped. Keywords outside the standard are kept in the metadata.

    Parameters
    ----------
    path : path-like
        File to read: ASCII or UTF-8.

    Returns
    -------
    LightCurves

    Raises
    ------
    FileError
        A line that the standard does not allow, with its number; curves with and without an applied light time in one file.

    Warns
    -----
    UserWarning
        No block of the file ends with ENDDATA, as in the exports of the database of ALCDEF. A file that is cut off looks the same.
    """
    blocks = _blocks(path, _lines(path))
    applied = [_light_time_applied(path, block) for block in blocks]
    for block, here in zip(blocks, applied):
        if here != applied[0]:
            which = "has" if here else "has not"
            raise _damaged(path, block.line, f"this curve {which} the light time applied, unlike the first: such curves must be in files of their own")
    counts = [len(block.rows) for block in blocks]
    rows = np.array([row for block in blocks for row in block.rows])
    distances = np.repeat([_distance(path, block) for block in blocks], counts)
    shifts = np.repeat([block.number(path, "MAGADJUST", 0.0) for block in blocks], counts)
    return LightCurves(
        times=rows[:, 0],
        time_scale=UTC_AT_ASTEROID if applied[0] else UTC,
        magnitudes=rows[:, 1] + shifts,
        brightness=None,
        sigma=None if np.isnan(rows[:, 2]).all() else rows[:, 2],
        curves=np.repeat(np.arange(len(blocks)), counts),
        sun=None,
        observer=None,
        distances=None if np.isnan(distances).all() else distances,
        relative=np.array([block.choices.get("DIFFERMAGS") == "TRUE" or block.choices.get("STANDARD") == "NONE" for block in blocks]),
        metadata=[block.metadata for block in blocks],
    )


def read_damit(path: str | os.PathLike[str]) -> LightCurves:
    """Read the light curves of a file of DAMIT or convexinv (lc.txt).

    The first line is the number of curves. Each curve is a line "points flag", flag 0 for relative and 1 for calibrated, and a line for each point: Julian date with
    the light time subtracted, intensity, vector to the Sun, vector to the Earth. Vectors are from the asteroid, in ecliptic axes, in au. The format does not
    state the scale of the dates; TDB − UTC is 42 to 70 s since 1972.

    Parameters
    ----------
    path : path-like
        File to read.

    Returns
    -------
    LightCurves

    Raises
    ------
    FileError
        A line with another form or count, with its number.

    Examples
    --------
    >>> with open("lc.txt", "w") as file:
    ...     count = file.write("1\\n2 0\\n2456965.73 1.02 0.8 -1.5 0.1 0.3 -0.4 0.0\\n2456965.74 0.98 0.8 -1.5 0.1 0.3 -0.4 0.0\\n")
    >>> curves = interop.read_damit("lc.txt")
    >>> curves
    LightCurves(2 points in 1 curve, JD 2456965.73000 to 2456965.74000 not stated (light time applied))
    >>> curves.distances.tolist()
    [0.5, 0.5]
    """
    lines = [(line, text.split()) for line, text in _lines(path) if text.strip()]
    if not lines:
        raise _damaged(path, 1, "the file is empty")
    (line, words), place = lines[0], 1
    if len(words) != 1 or not WHOLE.fullmatch(words[0]) or int(words[0]) == 0:
        raise _damaged(path, line, f"the first line must be the number of curves: got {' '.join(words)!r}")
    curves = int(words[0])
    rows: list[list[float]] = []
    counts, relative = [], []
    for curve in range(curves):
        if place == len(lines):
            raise _damaged(path, lines[-1][0], f"the file ends after {curve} of {curves} curves")
        line, words = lines[place]
        if len(words) != 2 or not WHOLE.fullmatch(words[0]) or int(words[0]) == 0 or words[1] not in ("0", "1"):
            raise _damaged(path, line, f"a curve must start with its number of points, and 0 (relative) or 1 (calibrated): got {' '.join(words)!r}")
        count = int(words[0])
        points = lines[place + 1 : place + 1 + count]
        rows += [_point(path, *point) for point in points]
        if len(points) < count:
            raise _damaged(path, lines[-1][0], f"the file ends after {len(points)} of {count} points of curve {curve + 1}")
        counts.append(count)
        relative.append(words[1] == "0")
        place += 1 + count
    if place < len(lines):
        raise _damaged(path, lines[place][0], f"the file must end after curve {curves}: got {' '.join(lines[place][1])!r}")
    table = np.array(rows)
    return LightCurves(
        times=table[:, 0],
        time_scale=AT_ASTEROID,
        magnitudes=None,
        brightness=table[:, 1],
        sigma=None,
        curves=np.repeat(np.arange(curves), counts),
        sun=table[:, 2:5],
        observer=table[:, 5:8],
        distances=np.linalg.norm(table[:, 5:8], axis=1),
        relative=np.array(relative),
        metadata=[{} for _ in counts],
    )


class _Block:
    """A curve of an ALCDEF file: its first line, its metadata with their lines, and its rows [JD, magnitude, error]."""

    def __init__(self, line: int):
        self.line = line
        self.metadata: dict[str, str] = {}
        self.lines: dict[str, int] = {}
        self.choices: dict[str, str] = {}
        self.rows: list[list[float]] = []

    def put(self, path: str | os.PathLike[str], line: int, key: str, value: str) -> None:
        if key in CHOICES and value:
            if value.upper() not in CHOICES[key]:
                raise _damaged(path, line, f"{key} must be {' or '.join(CHOICES[key])}: got {value!r}")
            if self.choices.get(key, value.upper()) != value.upper():
                raise _damaged(path, line, f"{key} is given twice, in line {self.lines[key]} with another value")
            self.choices[key] = value.upper()
        elif key in NUMBERS and value:
            if key in self.lines:
                raise _damaged(path, line, f"{key} is given twice, before in line {self.lines[key]}")
            _number(path, line, key, value)
        self.metadata[key] = f"{self.metadata[key]}\n{value}" if key in self.metadata else value
        if value:
            self.lines[key] = line

    def number(self, path: str | os.PathLike[str], key: str, default: float) -> float:
        return _number(path, self.lines[key], key, self.metadata[key]) if key in self.lines else default


def _blocks(path: str | os.PathLike[str], lines: list[tuple[int, str]]) -> list[_Block]:
    blocks: list[_Block] = []
    ended: list[int] = []
    part, last = "between blocks", 1
    for line, text in lines:
        # A delimiter TAB at the end of a line is part of it.
        text = text.strip(" ")
        if not text.strip():
            continue
        last, word = line, text.strip()
        if word == "STARTMETADATA" and part != "metadata":
            if part == "data" and not blocks[-1].rows:
                raise _damaged(path, line, "a block must have DATA")
            blocks.append(_Block(line))
            part = "metadata"
        elif part == "metadata" and word == "ENDMETADATA":
            if "DELIMITER" not in blocks[-1].choices:
                raise _damaged(path, line, "DELIMITER must be given in the metadata")
            part = "data"
        elif part == "data" and word == "ENDDATA":
            if not blocks[-1].rows:
                raise _damaged(path, line, "a block must have DATA")
            ended.append(len(blocks))
            part = "between blocks"
        elif part == "between blocks":
            raise _damaged(path, line, f"a block must start with STARTMETADATA: got {word!r}")
        else:
            match = KEYWORD.fullmatch(text)
            if match is None or (match[1] == "DATA") != (part == "data"):
                allowed = "KEYWORD=value or ENDMETADATA" if part == "metadata" else "DATA=…, ENDDATA or STARTMETADATA"
                raise _damaged(path, line, f"the {part} must have {allowed}: got {word!r}")
            if part == "metadata":
                blocks[-1].put(path, line, match[1], match[2].strip())
            else:
                blocks[-1].rows.append(_data(path, line, match[2], blocks[-1].choices["DELIMITER"]))
    if not blocks:
        raise _damaged(path, last, "the file is empty")
    if part == "metadata" or not blocks[-1].rows:
        raise _damaged(path, last, f"the file ends in the {part} of a block")
    missing = sorted(set(range(1, len(blocks) + 1)) - set(ended))
    if missing and ended:
        raise _damaged(path, blocks[missing[0]].line if missing[0] < len(blocks) else last, f"block {missing[0]} must end with ENDDATA, as other blocks do")
    if missing:
        warnings.warn(f"{path}: no block ends with ENDDATA: the last one, to line {last}, may be cut off", UserWarning, stacklevel=3)
    return blocks


def _data(path: str | os.PathLike[str], line: int, value: str, delimiter: str) -> list[float]:
    """Julian date, magnitude and error, NaN without one. Between two delimiters may be nothing."""
    fields = [field.strip() for field in value.split(DELIMITERS[delimiter])]
    if not 2 <= len(fields) <= 5 or any(fields[4:]):
        raise _damaged(path, line, f"DATA must be JD, magnitude, error and air mass, with the delimiter {delimiter}: got {value!r}")
    numbers = [
        _number(path, line, name, field) if field or at < 2 else np.nan for at, (name, field) in enumerate(zip(("JD", "MAG", "MAGERR", "AIRMASS"), fields))
    ]
    numbers += [np.nan] * (3 - len(numbers))
    _dated(path, line, numbers[0])
    if numbers[2] < 0:
        raise _damaged(path, line, f"MAGERR must not be negative: got {fields[2]}")
    return numbers[:3]


def _light_time_applied(path: str | os.PathLike[str], block: _Block) -> bool:
    """Section 5, LTCAPP, LTCTYPE and LTCDAYS: the three agree, or the block is rejected. LTCTYPE is missing in later versions."""
    applied = block.choices.get("LTCAPP", "NONE") != "NONE"
    kind = block.choices.get("LTCTYPE")
    if (kind == "LIGHTTIME" and not applied) or (kind == "NONE" and applied):
        line = max(block.lines.get("LTCTYPE", 0), block.lines.get("LTCAPP", 0))
        raise _damaged(path, line, f"LTCAPP and LTCTYPE contradict each other: {block.choices.get('LTCAPP', 'NONE')} and {kind}")
    return applied


def _distance(path: str | os.PathLike[str], block: _Block) -> float:
    """LTCDAYS = −LIGHT_TIME · distance."""
    days = block.number(path, "LTCDAYS", 0.0)
    if days > 0:
        raise _damaged(path, block.lines["LTCDAYS"], f"LTCDAYS must be negative: date at the asteroid = date at the Earth + LTCDAYS: got {days}")
    return -days / LIGHT_TIME if days else np.nan


def _point(path: str | os.PathLike[str], line: int, words: list[str]) -> list[float]:
    if len(words) != 8:
        raise _damaged(path, line, f"a point must have 8 numbers, date, intensity, Sun and Earth: got {len(words)}")
    names = ("JD", "intensity", "Sun x", "Sun y", "Sun z", "Earth x", "Earth y", "Earth z")
    numbers = [_number(path, line, name, word) for name, word in zip(names, words)]
    _dated(path, line, numbers[0])
    if not numbers[1] > 0:
        raise _damaged(path, line, f"intensity must be above 0: got {words[1]}")
    for name, vector in (("the Sun", numbers[2:5]), ("the Earth", numbers[5:8])):
        if not any(vector):
            raise _damaged(path, line, f"the vector to {name} must not be 0")
    return numbers


def _dated(path: str | os.PathLike[str], line: int, date: float) -> None:
    if not JULIAN[0] <= date <= JULIAN[1]:
        raise _damaged(path, line, f"JD must be a full Julian date, from {JULIAN[0]:.0f} to {JULIAN[1]:.0f}: got {date!r}")


def _number(path: str | os.PathLike[str], line: int, name: str, text: str) -> float:
    if not NUMBER.fullmatch(text) or not np.isfinite(float(text)):
        raise _damaged(path, line, f"{name} must be a finite number: got {text!r}")
    return float(text)


def _lines(path: str | os.PathLike[str]) -> list[tuple[int, str]]:
    """The lines of a text with their numbers."""
    data = Path(path).read_bytes()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _damaged(path, data[: error.start].count(b"\n") + 1, "must be text") from error
    lines = list(enumerate(LINE_END.split(text), 1))
    for line, part in lines:
        if CONTROL.search(part):
            raise _damaged(path, line, "must be text")
    return lines


def _damaged(path: str | os.PathLike[str], line: int, message: str) -> FileError:
    return unreadable(path, f"line {line}: {message}")
