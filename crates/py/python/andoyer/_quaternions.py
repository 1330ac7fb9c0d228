"""Quaternions [x, y, z, w] in arrays of shape (n, 4): Hamilton product, scalar last, as everywhere in this package."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]


def conjugate(q: Array) -> Array:
    """The inverse rotations."""
    inverse: Array = q * np.array([-1.0, -1.0, -1.0, 1.0])
    return inverse


def product(p: Array, q: Array, arrays: Any = np) -> Array:
    """The rotation q followed by p, with the functions of NumPy or of another module of arrays."""
    u, a, v, b = p[..., :3], p[..., 3:], q[..., :3], q[..., 3:]
    turn: Array = arrays.concatenate([a * v + b * u + arrays.cross(u, v), a * b - arrays.sum(u * v, axis=-1, keepdims=True)], axis=-1)
    return turn


def rotate(q: Array, vectors: Array) -> Array:
    """Rotate vectors by q. For an attitude q this turns body components into inertial ones."""
    twice = 2 * np.cross(q[..., :3], vectors)
    rotated: Array = vectors + q[..., 3:] * twice + np.cross(q[..., :3], twice)
    return rotated


def angle_between(p: Array, q: Array) -> Array:
    """The angle [rad] from 0 to π of the rotation from p to q, accurate for small angles too."""
    difference = product(conjugate(p), q)
    angle: Array = 2 * np.arctan2(np.linalg.norm(difference[..., :3], axis=-1), np.abs(difference[..., 3]))
    return angle


def between(p: Array, q: Array, fraction: float) -> Array:
    """The rotation at `fraction` of the way from p to q, about one axis at one rate on the shorter way."""
    difference = product(conjugate(p), q)
    difference *= np.where(difference[..., 3:] < 0, -1.0, 1.0)
    size = np.linalg.norm(difference[..., :3], axis=-1, keepdims=True)
    half = fraction * np.arctan2(size, difference[..., 3:])
    part = np.concatenate([np.sin(half) * difference[..., :3] / np.where(size > 0, size, 1.0), np.cos(half)], axis=-1)
    return product(p, part)
