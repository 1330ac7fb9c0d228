"""Attitudes in values of other packages, as quaternions [x, y, z, w].

Some packages store the scalar last, some first, and NumPy sees only the memory. A value that names its components x, y, z and w is read by these names. So are the rows of a list, the
elements of an array of quaternions, the columns of a table and the labels of an axis. A class that does not name them is refused, because its order cannot be seen.

A package is imported only when one of its values is given.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from andoyer.interop._foreign import has_units

NAMES = (("x", "y", "z", "w"), ("qx", "qy", "qz", "qw"))
"""Names of the components, scalar last."""
REMEDY = "give numbers [x, y, z, w], scalar last, or [w, x, y, z] where the function has scalar_first=True"


def quaternions(argument: str, value: Any) -> tuple[Any, bool]:
    """The quaternions in `value`, and whether they are [x, y, z, w] for sure: by the names of their components, or from a rotation of SciPy.

    Plain numbers, arrays of NumPy and values with units are returned unchanged, with False.

    Raises
    ------
    TypeError
        A value whose order of components cannot be seen; a list of values of both kinds.
    """
    if hasattr(value, "as_quat"):
        return value.as_quat(), True
    by_name = named(argument, value)
    if by_name is not None:
        return by_name, True
    if isinstance(value, (list, tuple)):
        return _rows(argument, value)
    if is_labelled(value):
        raise TypeError(f"{argument} is a {_kind(value)} with labels other than x, y, z, w or qx, qy, qz, qw: {REMEDY}")
    opaque = not any(hasattr(value, name) for name in ("__array__", "__len__", "unit", "units")) and not _is_number(value)
    if opaque or is_foreign_array(value):
        raise TypeError(f"{argument} is a {_kind(value)}, whose order of components is not known: {REMEDY}")
    return value, False


def _rows(argument: str, values: Any) -> tuple[Any, bool]:
    """The quaternions of a list, as of `quaternions`."""
    if all(isinstance(value, (float, int)) for value in values) or all(is_plain(value) for value in values):
        return values, False
    rows = [quaternions(argument, value) for value in values]
    order = {known for _, known in rows}
    if len(order) > 1:
        kinds = " and ".join(_kind(next(value for value, row in zip(values, rows) if row[1] is known)) for known in (True, False))
        raise TypeError(f"{argument} must hold values of one kind: got {kinds}")
    return [row for row, _ in rows], order.pop()


def _is_number(value: Any) -> bool:
    """Whether `value` is a number, or no quaternion at all: an object of Python itself."""
    try:
        float(value)
    except (TypeError, ValueError):
        return type(value).__module__ == "builtins"
    return True


def is_plain(value: Any) -> bool:
    """Whether `value` is an array of numbers of NumPy's own class."""
    return type(value) is np.ndarray and value.dtype.kind in "iuf"


def is_labelled(value: Any) -> bool:
    """Whether the columns of a table, or the places along an axis, have texts as labels."""
    labels = [*getattr(value, "columns", ())]
    for axis in getattr(value, "dims", ()):
        labels += value.coords[axis].values.tolist() if axis in value.coords else []
    return any(isinstance(label, str) for label in labels)


def is_foreign_array(value: Any) -> bool:
    """Whether `value` is an array of a class that is not NumPy's and carries no unit."""
    return isinstance(value, np.ndarray) and type(value).__module__.partition(".")[0] != "numpy" and not has_units(value)


def named(argument: str, value: Any) -> Any:
    """The components of `value` by their names, shape (…, 4), or None if it names none."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "OV" and value.dtype.names is None and value.size:
        # An array of quaternions, each one object.
        parts = [named(argument, part) for part in value.ravel()]
        return None if any(part is None for part in parts) else np.reshape(parts, (*value.shape, 4))
    for names in NAMES:
        parts = [_part(value, name) for name in names]
        if not any(part is None for part in parts):
            return _joined(argument, value, parts)
    return None


def _part(value: Any, name: str) -> Any:
    """A component by its name: an attribute, a field or a column, or the label of an axis; None without it."""
    if hasattr(type(value), name):
        try:
            return getattr(value, name)
        except Exception:  # a property of another package, of a value that it was not made for
            return ()
    if name in (getattr(getattr(value, "dtype", None), "names", None) or ()):
        return value[name]
    for axis in getattr(value, "dims", ()):
        if axis in value.coords and name in value.coords[axis].values.tolist():
            return value.sel({axis: name})
    return getattr(value, name, None)


def _joined(argument: str, value: Any, parts: list[Any]) -> Any:
    """Components as one array, shape (…, 4).

    Raises
    ------
    TypeError
        Components that are no numbers, or not one for each quaternion: a stack made by a class for one quaternion.
    """
    try:
        joined = np.stack([np.asarray(part, dtype=np.float64) for part in parts], axis=-1)
    except (TypeError, ValueError):
        joined = np.empty(0)
    stored = np.asarray(value) if is_foreign_array(value) and value.dtype.kind in "iuf" else joined
    if joined.shape[-1:] != (4,) or not np.array_equal(np.sort(joined), np.sort(stored), equal_nan=True):
        raise TypeError(f"{argument} is a {_kind(value)}, whose components x, y, z and w are not numbers, one for each quaternion: {REMEDY}")
    return joined


def _kind(value: Any) -> str:
    """The class of a value and its package."""
    kind = type(value)
    return f"{kind.__name__} of {kind.__module__.partition('.')[0]}"
