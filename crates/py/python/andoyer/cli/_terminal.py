"""Output for terminals: a progress bar and bold names, and streams that are closed. Files and pipes get plain text."""

import os
import sys
import time
from typing import TextIO

WIDTH = 30
PATIENCE = 0.3
"""Seconds before a bar is shown: short work has none."""


class ProgressBar:
    """A progress bar on stderr, if stderr is a terminal. Call it with the amount done and the total, and `close` it at the end."""

    def __init__(self, what: str, stream: TextIO | None = None) -> None:
        self.what = what
        self.stream = sys.stderr if stream is None else stream
        self.visible = self.stream.isatty()
        self.started = time.monotonic()
        self.last = ""

    def __call__(self, done: int, of: int) -> None:
        """Show the progress."""
        if not self.visible or time.monotonic() - self.started < PATIENCE:
            return
        share = done / of if of else 1.0
        bar = "#" * int(WIDTH * share)
        line = f"{self.what} [{bar:-<{WIDTH}}] {100 * share:3.0f} %  {done} of {of}"
        if line != self.last:
            self.stream.write(f"\r{line}\x1b[K")
            self.stream.flush()
            self.last = line

    def close(self) -> None:
        """Clear the line of the bar."""
        if self.last:
            self.stream.write("\r\x1b[K")
            self.stream.flush()


def label(name: str, stream: TextIO | None = None) -> str:
    """A name in front of a value, bold on a terminal unless NO_COLOR is set."""
    terminal = (sys.stdout if stream is None else stream).isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return f"\x1b[1m{name:13}\x1b[0m" if terminal else f"{name:13}"


def replace_closed_streams() -> None:
    """Replace stdout and stderr if the shell has closed them (``>&-``): writing to stdout is then an error of the system, and what goes to stderr is lost."""
    if sys.stdout is None:
        sys.stdout = os.fdopen(os.open(os.devnull, os.O_RDONLY), "w", encoding="utf-8")
    if sys.stderr is None:
        sys.stderr = os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8")


def discard_stdout() -> None:
    """Discard what cannot be written to stdout, so that Python does not try again at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def flush_or_discard_stdout() -> None:
    """Write what is left for stdout, or discard it if it cannot be written."""
    try:
        sys.stdout.flush()
    except OSError:
        discard_stdout()
