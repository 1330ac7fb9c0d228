"""A file is written whole or not at all: under another name in the same folder, which is renamed when it is complete."""

import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

LONGEST_STEM = 40
"""Characters of the file's own name that the temporary name has."""


@contextmanager
def whole_file(path: str | os.PathLike[str], force: bool = True) -> Iterator[Path]:
    """The name to write under; when the block ends without an error, the file gets the name `path`.

    An error, or Ctrl-C, removes what was written and leaves a file that was at `path` as it was. A device or a pipe is written directly.

    Parameters
    ----------
    path : path-like
    force : bool, optional
        Whether a file that is there already is replaced.

    Raises
    ------
    FileExistsError
        There is such a file, and ``force=False``.
    """
    target = Path(os.path.realpath(path))
    if is_stream(target):
        yield target
        return
    if target.is_dir():
        raise IsADirectoryError(21, os.strerror(21), str(path))
    if not force and target.exists():
        raise existing(path)
    temporary = target.with_name(f".{target.stem[:LONGEST_STEM]}-{secrets.token_hex(4)}{target.suffix}")
    # The system says now whether the folder can be written.
    os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    try:
        yield temporary
        if force:
            os.replace(temporary, target)
        else:
            _rename_to_new(temporary, target, path)
    finally:
        temporary.unlink(missing_ok=True)


def is_stream(path: Path) -> bool:
    """Whether a device or a pipe is there: it has no name to be renamed to."""
    try:
        mode = path.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def existing(path: str | os.PathLike[str]) -> FileExistsError:
    """The error for a file that is there."""
    return FileExistsError(17, os.strerror(17), str(path))


def _rename_to_new(temporary: Path, target: Path, path: str | os.PathLike[str]) -> None:
    """Rename unless something has come to be at `target` meanwhile; a link fails on it, where the file system has links."""
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise existing(path) from None
    except OSError:
        if target.exists():
            raise existing(path) from None
        os.replace(temporary, target)
