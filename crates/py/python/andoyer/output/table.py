"""Tables of samples: CSV, NPZ and Parquet, written and read back to the same bits.

NPZ and Parquet files also have the convention, the units, the scene and, if the samples have times of astropy, these times. A CSV file may have the scene.
"""

import json
import os
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TextIO, TypeAlias

import numpy as np

from andoyer._core import Error, Orbital, Samples, Scene
from andoyer._extra import extra
from andoyer._quaternions import Array
from andoyer._refusal import refusal, unreadable
from andoyer.output.files import whole_file
from andoyer.output.rows import COLUMNS, CONVENTION, calendar_times, rows, samples_of

ROWS_AT_ONCE = 2**20
"""Rows of a group of Parquet: each takes a fraction of a second."""

LINES_AT_ONCE = 10_000
"""Lines between two words on how far the writing is."""

COMMENT = "# "
"""Begins the lines of a CSV file that hold no numbers."""

RATES = COLUMNS.split(",")[5:]

JULIAN = ["jd1", "jd2"]
"""Columns of a calendar time: its Julian date in two doubles, as astropy has it."""

ORBITAL = ("ox", "oy", "oz", "ow", "angle_1", "angle_2", "angle_3", "rx", "ry", "rz")
"""Columns against the orbital frame: the quaternion, scalar last, the three angles, the angular velocity relative to the frame."""

AGAINST = (
    "; ox, oy, oz, ow: unit quaternion, body components to those of the orbital frame; angle_1, angle_2, angle_3: intrinsic angles [rad]; "
    "rx, ry, rz: angular velocity relative to the frame, body components"
)
"""What the columns of `ORBITAL` mean, after `CONVENTION`."""

ENDINGS = [".csv", ".npz", ".parquet"]

Progress: TypeAlias = Callable[[int, int], None]
"""Called with how much is done, and of how much."""


def silent(_done: int, _of: int) -> None:
    """A progress callback that does nothing."""


@dataclass(frozen=True)
class Table:
    """The contents of a table of samples, from `read_table`."""

    samples: Samples
    """The samples; their times are an astropy Time if the file has calendar times."""
    scene: Scene | None = None
    """The scene of the samples, if the file has it."""
    units: dict[str, str] = field(default_factory=dict)
    """Unit of each column, if the file has units."""


def write_csv(
    path: str | os.PathLike[str],
    samples: Samples,
    progress: Progress = silent,
    *,
    scene: Scene | None = None,
    remark: str | None = None,
    orbital: Orbital | None = None,
    force: bool = True,
) -> None:
    """Write samples as a CSV file. Scene and remark, if given, follow the table as lines that begin with #.

    Parameters
    ----------
    path : path-like
        File to write.
    samples : Samples
        Samples of one motion.
    progress : callable, optional
        Called as ``progress(done, total)`` with numbers of lines.
    scene, remark
        As in `write_npz`; each is one line, the text as JSON.
    orbital : Orbital, optional
        Attitudes and rates against the orbital frame at the same times: further columns.
    force : bool, optional
        If True, an existing file is replaced.

    Raises
    ------
    FileExistsError
        The file exists, and ``force=False``.
    InputError
        Samples of an ensemble.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    >>> output.write_csv("wobble.csv", motion.at([0.0, 1.0]))
    >>> open("wobble.csv").readline()
    't,qx,qy,qz,qw,wx,wy,wz\\n'
    """
    with whole_file(path, force) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as file:
        write_table(file, samples, progress, orbital)
        texts = {"scene": scene.to_toml() if scene is not None else None, "remark": remark}
        file.writelines(f"{COMMENT}{key}: {json.dumps(text)}\n" for key, text in texts.items() if text)


def write_table(file: TextIO, samples: Samples, progress: Progress = silent, orbital: Orbital | None = None) -> None:
    """Write samples as CSV into an open text file: a line of column names, then one line for each time, with 17 digits. `progress` is called with the lines written."""
    further = against(orbital, rows(samples))
    table = np.column_stack([rows(samples), *further.values()])
    file.write(",".join([COLUMNS, *further]) + "\n")
    for start in range(0, len(table), LINES_AT_ONCE):
        np.savetxt(file, table[start : start + LINES_AT_ONCE], fmt="%.17g", delimiter=",")
        progress(min(start + LINES_AT_ONCE, len(table)), len(table))


def write_npz(
    path: str | os.PathLike[str],
    samples: Samples,
    *,
    scene: Scene | None = None,
    remark: str | None = None,
    orbital: Orbital | None = None,
    force: bool = True,
) -> None:
    """Write samples as an NPZ file: arrays times, attitude (scalar last), angular_velocity, and texts convention, units, scene.

    Parameters
    ----------
    path : path-like
        File to write.
    samples : Samples
        Samples of one motion.
    scene : Scene, optional
        The scene of the samples; the file keeps its TOML text.
    remark : str, optional
        A remark on the samples, for example that they miss the tolerance.
    orbital : Orbital, optional
        Attitudes and rates against the orbital frame at the same times: arrays or columns with the names of `ORBITAL`.
    force : bool, optional
        If True, an existing file is replaced.

    Raises
    ------
    FileExistsError
        The file exists, and ``force=False``.
    InputError
        Samples of an ensemble.
    """
    table = rows(samples)
    texts, julian = _about(scene, calendar_times(samples), orbital)
    texts |= {"remark": remark} if remark else {}
    arrays: dict[str, Any] = {"times": table[:, 0], "attitude": table[:, 1:5], "angular_velocity": table[:, 5:]}
    arrays |= julian | against(orbital, table) | {key: np.array(text) for key, text in texts.items()}
    with whole_file(path, force) as temporary, temporary.open("wb") as file:
        np.savez(file, **arrays)


def write_parquet(
    path: str | os.PathLike[str],
    samples: Samples,
    *,
    scene: Scene | None = None,
    remark: str | None = None,
    orbital: Orbital | None = None,
    force: bool = True,
) -> None:
    """Write samples as a Parquet file: the columns of the CSV as float64; convention, units and scene in the metadata of the schema.

    Parameters
    ----------
    path, samples, scene, remark, orbital, force
        As in `write_npz`.

    Raises
    ------
    ImportError
        pyarrow is not installed; ``pip install pyarrow`` installs it.
    FileExistsError, InputError
        As in `write_npz`.
    """
    arrow, parquet = (extra(module, "writing Parquet") for module in ("pyarrow", "pyarrow.parquet"))
    table = rows(samples)
    texts, julian = _about(scene, calendar_times(samples), orbital)
    texts |= {"remark": remark} if remark else {}
    columns = dict(zip(COLUMNS.split(","), np.ascontiguousarray(table.T))) | julian | against(orbital, table)
    schema = arrow.schema([(name, arrow.float64()) for name in columns], metadata=texts)
    with whole_file(path, force) as temporary, parquet.ParquetWriter(temporary, schema) as writer:
        # Rows are written in groups, and Python checks for Ctrl-C between them. A table without rows has one group.
        for start in range(0, max(len(table), 1), ROWS_AT_ONCE):
            part = [column[start : start + ROWS_AT_ONCE] for column in columns.values()]
            writer.write_table(arrow.table(part, schema=schema))


def against(orbital: Orbital | None, table: Array) -> dict[str, Array]:
    """The columns of `ORBITAL` for samples against the orbital frame; none without them."""
    if orbital is None:
        return {}
    numbers = np.column_stack([np.atleast_2d(part) for part in (orbital.attitude, orbital.angles, orbital.angular_velocity)])
    if len(numbers) != len(table):
        raise refusal("orbital", len(numbers), len(table), f"must have the {len(table)} times of the samples: got {len(numbers)}")
    return dict(zip(ORBITAL, np.ascontiguousarray(numbers.T)))


def read_table(path: str | os.PathLike[str]) -> Table:
    """Read the samples and the other contents of a CSV, NPZ or Parquet file. The ending of the name determines the format.

    Columns are found by their names. They may be in any order, with other columns between them. Without the columns of the rates, and where those of a row are NaN, the angular velocity is
    unknown: NaN.

    Parameters
    ----------
    path : path-like
        File to read.

    Returns
    -------
    Table
        Samples, scene and units.

    Raises
    ------
    ImportError
        A Parquet file without pyarrow; calendar times without astropy.
    FileError
        Another ending; a column that is missing, is there twice or has a value that is not a finite number; a file whose content does not fit its ending.

    Examples
    --------
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], name="wobble").solve()
    >>> output.write_npz("wobble.npz", motion.at([0.0, 1.0]), scene=motion.scene)
    >>> table = output.read_table("wobble.npz")
    >>> table.scene == motion.scene, table.samples.attitude.shape
    (True, (2, 4))
    """
    path = Path(path)
    try:
        return _read(path)
    except Error:
        raise
    except (ValueError, KeyError) as error:
        raise unreadable(path, error) from error


def _read(path: Path) -> Table:
    readers = {".csv": _read_csv, ".npz": _read_npz, ".parquet": _read_parquet}
    if path.suffix.lower() not in readers:
        raise ValueError(f"the name must end in {', '.join(ENDINGS)}")
    columns, texts = readers[path.suffix.lower()](path)
    if not any(name in columns for name in RATES):
        columns |= dict.fromkeys(RATES, np.full_like(columns.get("t", np.zeros(0)), np.nan))
    missing = [name for name in COLUMNS.split(",") if name not in columns]
    if missing:
        raise ValueError(f"must have the columns {COLUMNS}, or those of the rates not at all: {', '.join(missing)} missing")
    table = np.column_stack([columns[name] for name in COLUMNS.split(",")])
    wrong = ~np.isfinite(table)
    wrong[:, 5:] &= ~np.isnan(table[:, 5:]).all(axis=1, keepdims=True)
    if wrong.any():
        raise ValueError(f"must hold finite numbers, or NaN for all rates of a row: row {np.flatnonzero(wrong.any(axis=1))[0] + 1} does not")
    times = None
    if texts.get("time_scale"):
        time = extra("astropy.time", f"reading calendar times of {path}")
        times = time.Time(columns["jd1"], columns["jd2"], format="jd", scale=texts["time_scale"])
    samples = samples_of(table[:, 0], table[:, 1:5], table[:, 5:], times)
    scene = _scene(texts["scene"]) if texts.get("scene") else None
    return Table(samples, scene, json.loads(texts.get("units", "{}")))


def _about(scene: Scene | None, times: Any, orbital: Orbital | None) -> tuple[dict[str, str], dict[str, Array]]:
    """The texts of a table, and the columns of calendar times."""
    unit = "unit of time of the scene" if times is None else "s"
    units = {"t": unit} | dict.fromkeys(["qx", "qy", "qz", "qw"], "1") | dict.fromkeys(["wx", "wy", "wz"], "rad/s" if times is not None else f"rad per {unit}")
    if orbital is not None:
        units |= dict(zip(ORBITAL, ["1"] * 4 + ["rad"] * 3 + [units["wx"]] * 3))
    texts = {"convention": CONVENTION + (AGAINST if orbital is not None else ""), "units": json.dumps(units)}
    if scene is not None:
        texts["scene"] = scene.to_toml()
    if times is None:
        return texts, {}
    texts["time_scale"] = times.scale
    return texts, {name: np.atleast_1d(np.asarray(getattr(times, name), dtype=np.float64)) for name in JULIAN}


def _read_csv(path: Path) -> tuple[dict[str, Array], dict[str, str]]:
    try:
        # Spreadsheets write a byte-order mark.
        with path.open(encoding="utf-8-sig") as file:
            names = file.readline().strip().split(",")
            table = np.loadtxt(file, delimiter=",", ndmin=2, comments=COMMENT)
        with path.open(encoding="utf-8-sig") as file:
            said = [line.removeprefix(COMMENT).partition(": ") for line in file if line.startswith(COMMENT)]
        texts = {key: json.loads(text) for key, _, text in said if key in ("scene", "remark") and text.startswith('"')}
    except ValueError as error:
        raise ValueError(f"must be a table in CSV: {error}") from error
    _once(names)
    if table.size and table.shape[1] != len(names):
        raise ValueError(f"must have as many numbers in a line as names in the first: {table.shape[1]} and {len(names)}")
    return dict(zip(names, table.reshape(-1, len(names)).T)), texts


def _read_npz(path: Path) -> tuple[dict[str, Array], dict[str, str]]:
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
            arrays.setdefault("angular_velocity", np.full((len(arrays["times"]), 3), np.nan))
            numbers = [arrays[key].astype(np.float64).reshape(len(arrays["times"]), -1) for key in ("times", "attitude", "angular_velocity")]
    except (KeyError, ValueError, TypeError, EOFError, AttributeError, zipfile.BadZipFile) as error:
        raise ValueError(f"must be an NPZ with the arrays times, attitude, angular_velocity: {error}") from error
    table = np.column_stack(numbers)
    texts = {key: str(value) for key, value in arrays.items() if value.dtype.kind == "U"}
    return dict(zip(COLUMNS.split(","), table.T)) | {name: arrays[name] for name in JULIAN if name in arrays}, texts


def _read_parquet(path: Path) -> tuple[dict[str, Array], dict[str, str]]:
    arrow, parquet = (extra(module, "reading Parquet") for module in ("pyarrow", "pyarrow.parquet"))
    try:
        _once(parquet.read_schema(path).names)
        table = parquet.read_table(path)
        columns = {name: table.column(name).to_numpy().astype(np.float64) for name in table.column_names if name in [*COLUMNS.split(","), *JULIAN]}
    except (arrow.ArrowInvalid, ValueError, TypeError) as error:
        raise ValueError(f"must be a Parquet table of numbers: {error}") from error
    return columns, {key.decode(): value.decode() for key, value in (table.schema.metadata or {}).items() if not key.startswith(b"ARROW:")}


def _once(names: list[str]) -> None:
    """Refuse a column of samples that is there twice."""
    for name in [*COLUMNS.split(","), *JULIAN]:
        if names.count(name) > 1:
            raise ValueError(f"must have the column {name} once: got {names.count(name)} columns of this name")


def _scene(text: str) -> Scene:
    """A scene from its TOML, which `Scene.from_toml` reads from a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return Scene.from_toml(path)
