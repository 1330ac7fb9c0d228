"""From the bytes of an ephemeris message to its texts, numbers and times: what the readers of attitudes and of orbits share."""

import re
from fractions import Fraction

import numpy as np

from andoyer.output.calendar import parse
from andoyer.output.kvn import parse_kvn
from andoyer.output.raw import Kind, RawMessage, RawSegment, Record
from andoyer.output.xml import parse_xml

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def messages(data: bytes, kind: Kind) -> list[RawMessage]:
    """The messages of that kind in a file, in either notation.

    Raises
    ------
    ValueError
        Text that the standard does not allow, with the number of the line.
    """
    is_xml = data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")
    return parse_xml(data, kind) if is_xml else [parse_kvn(_decoded(data), kind)]


def _decoded(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise ValueError(f"line {line}: must be text") from error


def choice(raw: RawSegment, key: str, allowed: list[str]) -> str:
    """A value of the metadata that must be one of a few texts, in any case; blanks count as underscores.

    Raises
    ------
    ValueError
        No value, or another one.
    """
    value = raw.metadata.get(key)
    if value is None:
        raise ValueError(f"{raw.where}: {key} must be given")
    for name in allowed:
        if spelled(value) == spelled(name):
            return name
    raise ValueError(f"{raw.where}: {key} must be {', '.join(allowed)}: got {value!r}")


def spelled(text: str) -> str:
    """A text without the differences that the standard ignores (6.8.6, 6.8.8)."""
    return " ".join(text.replace("_", " ").upper().split())


def row(record: Record, fields: list[str]) -> list[float]:
    """The numbers of a record, by name or by place.

    Raises
    ------
    ValueError
        Other names; another number of values; a value that is not a finite number.
    """
    values = record.values
    if isinstance(values, dict):
        if set(values) != set(fields):
            raise ValueError(f"{record.where}: a record of this type must have {', '.join(fields)}: got {', '.join(values)}")
        values = [values[field] for field in fields]
    if len(values) != len(fields):
        raise ValueError(f"{record.where}: a record of this type must have {len(fields)} numbers, {', '.join(fields)}: got {len(values)}")
    for field, value in zip(fields, values):
        if not NUMBER.fullmatch(value) or not np.isfinite(float(value)):
            raise ValueError(f"{record.where}: {field} must be a finite number: got {value!r}")
    return [float(value) for value in values]


def ascending(raw: RawSegment, system: str) -> list[Fraction]:
    """The times of the records, as of `calendar.parse`.

    Raises
    ------
    ValueError
        A text that is no time; a time that is not after the one before it.
    """
    moments: list[Fraction] = []
    for record in raw.records:
        try:
            moments.append(parse(record.epoch, system))
        except ValueError as error:
            raise ValueError(f"{record.where}: {error}") from error
        if len(moments) > 1 and moments[-2] >= moments[-1]:
            raise ValueError(f"{record.where}: times must ascend: got {record.epoch} after one that is not before it")
    return moments
