"""Types of the arguments of the command line. Each reads a text or raises an error that states the allowed values."""

import argparse
import math
from collections.abc import Callable
from datetime import datetime, timedelta
from typing import TypeVar

Value = TypeVar("Value")

MOST_SAMPLES = 10**9
"""More would not fit a file that anyone reads."""


class InputError(Exception):
    """An argument of the command line that cannot be used."""


def number(text: str) -> float:
    """A finite number."""
    return checked(text, float, math.isfinite, "a finite number")


def time(text: str) -> float:
    """A time of a scene. For a date the message says what the number counts."""
    advice = ", a time in the unit of the scene (if its epoch is a date, TDB seconds since J2000)" if is_date(text) else ""
    return checked(text, float, math.isfinite, f"a finite number{advice}")


def is_date(text: str) -> bool:
    """Whether a text is a date and no number."""
    try:
        datetime.fromisoformat(text)
    except ValueError:
        return False
    return not text.isdigit()


def step(text: str) -> float:
    """A step of time."""
    return checked(text, float, lambda value: 0 < value < math.inf, "a finite number above 0")


def whole(text: str) -> int:
    """A whole number."""
    return checked(text, int, lambda _: True, "a whole number")


def sample_count(text: str) -> int:
    """A number of samples."""
    return checked(text, int, lambda value: 1 <= value <= MOST_SAMPLES, f"a whole number from 1 to {MOST_SAMPLES}")


def date(text: str) -> datetime:
    """A calendar date without a zone, or with Z for UTC."""
    return checked(
        text, datetime.fromisoformat, lambda value: value.utcoffset() in (None, timedelta()), "a date like 2000-01-01T12:00:00, without a zone but Z for UTC"
    )


def word(text: str) -> str:
    """A word of printable ASCII characters."""
    return checked(text, str, lambda value: value.isascii() and value.isprintable() and value.split() == [value], "one word in ASCII")


def words(text: str) -> str:
    """Words of printable ASCII characters."""
    return checked(text, str, lambda value: value.isascii() and value.isprintable() and bool(value.split()), "words in ASCII")


def interpolation(text: str) -> tuple[str, int]:
    """A method of interpolation and its degree, METHOD:DEGREE."""
    method, _, degree = text.partition(":")
    return method.upper(), checked(degree, int, lambda value: value >= 1, "METHOD:DEGREE, such as HERMITE:3, with a degree of 1 or more")


def checked(text: str, read: Callable[[str], Value], accepts: Callable[[Value], bool], expected: str) -> Value:
    """`text`, converted by `read` and checked. argparse puts the name of the argument before the message."""
    refusal = argparse.ArgumentTypeError(f"must be {expected}: got {text!r}")
    try:
        value = read(text)
    except ValueError:
        raise refusal from None
    if not accepts(value):
        raise refusal
    return value
