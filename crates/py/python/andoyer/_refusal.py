"""Errors of arguments and files, with the attributes argument, value and bound."""

import os
from typing import Any

from andoyer._core import FileError, InputError


def refusal(argument: str, value: Any, bound: Any, message: str) -> InputError:
    """The error of an argument."""
    error = InputError(f"{argument}{message}" if message.startswith("[") else f"{argument} {message}")
    error.argument, error.value, error.bound = argument, value, bound
    return error


def unreadable(path: str | os.PathLike[str], message: object) -> FileError:
    """The error of a file that cannot be read."""
    error = FileError(f"{path}: {message}")
    error.argument, error.value = "path", str(path)
    return error
