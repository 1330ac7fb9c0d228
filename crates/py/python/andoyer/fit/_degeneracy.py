"""What data do not determine, in words: directions of small singular values of the whitened Jacobian, and sizes that are equal within their uncertainty."""

from __future__ import annotations

import numpy as np

from andoyer._quaternions import Array
from andoyer.fit._steps import LABELS, WORDS, Steps

LOST = 1e-10
"""Singular values below this part of the largest are those of a direction that the data do not see at all."""
LOOSE = 1.0
"""Standard deviation of a step, relative or in rad, above which a direction counts as not determined."""
ALIKE = 2.0
"""Standard deviations within which two moments, or two semi-axes, count as equal."""
MOMENTS, RATIOS = LABELS["moments"], LABELS["shape"]
SPANNED = 0.999
"""A name is used if its direction, of length 1, has a projection on the undetermined directions that is longer than this."""
SMALL = 0.05
"""A difference of two parameters counts as determined if its projection on the undetermined directions is shorter than this: √(1 − SPANNED²)."""


def undetermined(singular: Array, directions: Array, loose: float = LOOSE) -> Array:
    """Directions, as rows, along which a step has a standard deviation above `loose`; `singular` values of the whitened Jacobian and its right `directions` as rows."""
    largest = singular[0] if len(singular) else 0.0
    known = np.zeros(len(directions), dtype=bool)
    known[: len(singular)] = (singular > LOST * largest) & (singular * loose > 1.0)
    rows: Array = directions[~known]
    return rows


def sentence(lost: Array, steps: Steps, step: Array, covariance: Array) -> str | None:
    """One sentence that names the directions, and the sizes that are equal within their uncertainty; None if there are none. `covariance` is that of steps at `step`."""
    names = [*_names(lost, steps, step), *_equal(lost, steps, step, covariance)]
    return f"The data do not determine {', nor '.join(names)}." if names else None


def _names(lost: Array, steps: Steps, step: Array) -> list[str]:
    """Names that span the directions: all moments, a common factor of them and single components where they fit, combinations for the rest."""
    names = []
    for name, rows in _named(steps, step):
        if len(lost) >= len(rows) and np.all(np.linalg.norm(rows @ lost.T, axis=1) > SPANNED):
            names.append(name)
            for row in rows:
                lost = _without(lost, row)
    return names + [_combination(row, steps.labels) for row in lost]


def _named(steps: Steps, step: Array) -> list[tuple[str, Array]]:
    """Names with the directions that they stand for, the widest first."""
    labels = steps.labels
    unit = np.eye(len(labels))
    named = [(WORDS[label], unit[[place]]) for place, label in enumerate(labels)]
    moments = unit[[place for place, label in enumerate(labels) if label in MOMENTS]]
    if len(moments):
        named = [("the moments", moments), ("a common factor of the moments", moments.sum(axis=0, keepdims=True) / np.sqrt(3)), *named]
    factor = steps.common_factor(step)
    if factor is not None:
        named = [("the inertia tensor", unit[labels.index("I11") :]), ("a common factor of the inertia tensor", factor[None]), *named]
    return [*named, *_symmetric(steps)]


def _symmetric(steps: Steps) -> list[tuple[str, Array]]:
    """Of an ellipsoid of revolution the direction in which the body axes turn about the axis of symmetry. The brightness does not depend on it."""
    if steps.semi_axes is None or not {"θ1", "ω1"} <= set(steps.labels):
        return []
    rates = steps.origin.angular_velocity / steps.rate
    found = []
    for axis, unit in enumerate(np.eye(3)):
        first, second = np.delete(steps.semi_axes, axis)
        if first == second:
            row = np.concatenate([unit, -np.cross(unit, rates), np.zeros(len(steps.labels) - 6)])
            found.append((f"the rotation of the body axes about axis {axis + 1}, about which the body is symmetric", row[None] / np.linalg.norm(row)))
    return found


def _equal(lost: Array, steps: Steps, step: Array, covariance: Array) -> list[str]:
    """The fitted moments, or semi-axes, that differ by no more than `ALIKE` standard deviations."""
    unit = np.eye(len(steps.labels))
    if steps.semi_axes is None:
        what, names, logarithms = "moments", MOMENTS, np.log(steps.moments(step))
        rows = unit[[place for place, label in enumerate(steps.labels) if label in MOMENTS]]
    else:
        what, names, logarithms = "semi-axes", ("a", "b", "c"), np.log(steps.axes(step))
        ratios = unit[[place for place, label in enumerate(steps.labels) if label in RATIOS]]
        rows = np.concatenate([np.zeros((1, len(unit))), ratios])
    pairs = []
    for first, second in ((0, 1), (1, 2), (0, 2)) if len(rows) == 3 else ():
        row = rows[first] - rows[second]
        difference, deviation = float(logarithms[first] - logarithms[second]), float(np.sqrt(row @ covariance @ row))
        # A difference that lies in the directions that are not determined is named with them.
        if abs(difference) <= ALIKE * deviation and np.linalg.norm(lost @ row) < SMALL:
            pairs.append(f"{names[first]} and {names[second]} ({100 * difference:.2g} ± {100 * deviation:.2g} %)")
    return [f"the difference of the {what} {', '.join(pairs)}"] if pairs else []


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
