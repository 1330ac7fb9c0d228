"""The file of a comparison: a row a line, floats with four digits, "–" where there is no value."""

import csv


def cell(value):
    """A value as text."""
    return f"{value:.4g}" if isinstance(value, float) else "–" if value in (None, "") else value


def write(path, columns, rows):
    """Write the rows, if a path was asked for."""
    if path:
        with path.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([columns, *(map(cell, row) for row in rows)])
