"""Writing a file whole or not at all: the file has a temporary name in the same folder until it is complete."""

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
    """The temporary name to write to. When the block ends without an error, the file gets the name `path`.

    After an error or Ctrl-C the temporary file is removed and an old file at `path` is unchanged. A device or a pipe is written directly.

    Parameters
    ----------
    path : path-like
        File to write.
    force : bool, optional
        If True, an existing file is replaced.

    Raises
    ------
    FileExistsError
        The file exists, and ``force=False``.
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
    # This shows now if the folder cannot be written.
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
    """True if the path is a device or a pipe, which cannot be renamed."""
    try:
        mode = path.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def existing(path: str | os.PathLike[str]) -> FileExistsError:
    """The error for an existing file."""
    return FileExistsError(17, os.strerror(17), str(path))


def _rename_to_new(temporary: Path, target: Path, path: str | os.PathLike[str]) -> None:
    """Rename unless `target` exists by now. Where the file system has links, a link detects this."""
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise existing(path) from None
    except OSError:
        if target.exists():
            raise existing(path) from None
        os.replace(temporary, target)
