"""Rotation vectors: exponential, logarithm, and their derivatives, in arrays of shape (…, 3)."""

import numpy as np

from andoyer._quaternions import Array

SMALL_ANGLE = 1e-4
"""Angle [rad] below which series replace the quotients; the terms that they drop are of size SMALL_ANGLE⁴."""


def cross_matrix(vector: Array) -> Array:
    """[v]×, shape (…, 3, 3): [v]× u = v × u."""
    matrix = np.zeros((*vector.shape, 3))
    x, y, z = np.moveaxis(vector, -1, 0)
    matrix[..., 0, 1], matrix[..., 0, 2], matrix[..., 1, 2] = -z, y, -x
    matrix[..., 1, 0], matrix[..., 2, 0], matrix[..., 2, 1] = z, -y, x
    return matrix


def exponential(vector: Array) -> Array:
    """The unit quaternions [x, y, z, w] of rotation vectors."""
    half = np.linalg.norm(vector, axis=-1, keepdims=True) / 2
    return np.concatenate([vector * (np.sinc(half / np.pi) / 2), np.cos(half)], axis=-1)


def logarithm(quaternion: Array) -> Array:
    """The rotation vectors of unit quaternions, of angles up to π."""
    quaternion = np.where(quaternion[..., 3:] < 0, -quaternion, quaternion)
    sine = np.linalg.norm(quaternion[..., :3], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, quaternion[..., 3:])
    factor = np.divide(angle, sine, out=np.full_like(sine, 2.0), where=sine > 0)
    vector: Array = factor * quaternion[..., :3]
    return vector


def right_jacobian(vector: Array) -> Array:
    """J with exp(v + δ) = exp(v) exp(J δ) to first order, shape (…, 3, 3)."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    safe = np.maximum(angle, SMALL_ANGLE)
    first = np.where(angle < SMALL_ANGLE, 1 / 2 - angle**2 / 24, (1 - np.cos(safe)) / safe**2)
    second = np.where(angle < SMALL_ANGLE, 1 / 6 - angle**2 / 120, (safe - np.sin(safe)) / safe**3)
    cross = cross_matrix(vector)
    jacobian: Array = np.eye(3) - first * cross + second * (cross @ cross)
    return jacobian


def inverse_left_jacobian(vector: Array) -> Array:
    """K with log(exp(δ) exp(v)) = v + K δ to first order, shape (…, 3, 3), for angles up to π."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    safe = np.maximum(angle, SMALL_ANGLE)
    second = np.where(angle < SMALL_ANGLE, 1 / 12 + angle**2 / 720, 1 / safe**2 - 1 / (2 * safe * np.tan(safe / 2)))
    cross = cross_matrix(vector)
    jacobian: Array = np.eye(3) - cross / 2 + second * (cross @ cross)
    return jacobian
