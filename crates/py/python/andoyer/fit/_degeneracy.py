"""What data do not determine, in words: directions of small singular values of the whitened Jacobian."""

import numpy as np

from andoyer._quaternions import Array
from andoyer.fit._steps import WORDS

LOST = 1e-10
"""Singular values below this part of the largest are those of a direction that the data do not see at all."""
LOOSE = 1.0
"""Standard deviation of a step, relative or in rad, above which a direction counts as not determined."""
PART = 0.999
"""Part of a named direction that lies in the directions that are not determined, for the name to be used."""


def undetermined(singular: Array, directions: Array) -> Array:
    """Directions, as rows, along which the data do not determine a step; `singular` values of the whitened Jacobian and its right `directions` as rows."""
    largest = singular[0] if len(singular) else 0.0
    known = np.zeros(len(directions), dtype=bool)
    known[: len(singular)] = (singular > LOST * largest) & (singular * LOOSE > 1.0)
    rows: Array = directions[~known]
    return rows


def sentence(lost: Array, labels: tuple[str, ...], factor: Array | None = None) -> str:
    """One sentence that names the directions; `factor` is the common factor of a tensor's elements."""
    if not len(lost):
        return "The data determine every free parameter."
    return f"The data do not determine {', nor '.join(_names(lost, labels, factor))}."


def _names(lost: Array, labels: tuple[str, ...], factor: Array | None) -> list[str]:
    """Names that span the directions: all moments, a common factor of them and single components where they fit, combinations for the rest."""
    names = []
    for name, rows in _named(labels, factor):
        if len(lost) >= len(rows) and np.all(np.linalg.norm(rows @ lost.T, axis=1) > PART):
            names.append(name)
            for row in rows:
                lost = _without(lost, row)
    return names + [_combination(row, labels) for row in lost]


def _named(labels: tuple[str, ...], factor: Array | None) -> list[tuple[str, Array]]:
    """Names with the directions that they stand for, the widest first."""
    unit = np.eye(len(labels))
    moments = unit[[place for place, label in enumerate(labels) if label in ("I1", "I2", "I3")]]
    together = [("the moments", moments), ("a common factor of the moments", moments.sum(axis=0, keepdims=True) / np.sqrt(3))]
    if factor is not None:
        together = [("the inertia tensor", unit[labels.index("I11") :]), ("a common factor of the inertia tensor", factor[None])]
    return (together if len(moments) or factor is not None else []) + [(WORDS[label], unit[[place]]) for place, label in enumerate(labels)]


def _without(lost: Array, direction: Array) -> Array:
    """A basis of the directions that remain beside one of them."""
    direction = direction @ lost.T @ lost
    rest = lost - np.outer(lost @ direction, direction) / (direction @ direction)
    _, _, basis = np.linalg.svd(rest)
    remaining: Array = basis[: len(lost) - 1]
    return remaining


def _combination(row: Array, labels: tuple[str, ...]) -> str:
    """A direction by its larger components, the largest of which is positive."""
    row = row * np.sign(row[np.argmax(np.abs(row))])
    order = np.argsort(-np.abs(row))
    terms = [f"{row[place]:+.2f} {labels[place]}" for place in order if abs(row[place]) > 0.1]
    return f"the combination {' '.join(terms)} (relative changes, rad)"
