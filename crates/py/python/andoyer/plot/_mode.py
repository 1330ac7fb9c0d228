"""The momentum in the body and Andoyer's angles about either extremal axis: the short one, as in theory §1, or the long one."""

import math
from typing import Any

import numpy as np

from andoyer._core import Motion
from andoyer._quaternions import Array, rotate
from andoyer._refusal import refusal

AXES = ("short-axis", "long-axis")
POLE = 1e-12
"""Sine of J below which the node on the equator is rounding; ν is then 0, and μ the whole turn."""


def mode_axis(motion: Motion) -> str:
    """The axis that the momentum circles at the epoch: "long-axis" if the energy is above that of rotation about the intermediate axis."""
    _, moments, directions = in_order(motion, np.atleast_1d(motion.scene.epoch))
    return "long-axis" if float(np.sum(directions[0] ** 2 / moments)) > 1 / moments[1] else "short-axis"


def in_order(motion: Motion, times: Array, reverse: bool = False) -> tuple[list[int], Array, Array]:
    """The user's axes of moments A, B, C, or C, B, A; these moments; directions of the momentum on them, the first axis reversed as `Motion.andoyer` has it.

    The directions of a body at rest are NaN, which matplotlib does not draw.
    """
    body = motion.scene.body
    moments = body.moments
    order = np.argsort(moments, kind="stable")[:: -1 if reverse else 1]
    momentum = (moments * (motion.angular_velocity(times) @ body.principal_axes))[:, order]
    if left_handed(order):
        momentum[:, 0] *= -1
    sizes = np.linalg.norm(momentum, axis=1, keepdims=True)
    return [int(axis) for axis in order], moments[order], momentum / np.where(sizes > 0, sizes, np.nan)


def about(motion: Motion, times: Array, axis: str) -> tuple[list[int], Array, Array]:
    """The same with `axis` as the third one: A, B, C about the short axis, C, B, A about the long one.

    Raises
    ------
    InputError
        An unknown axis (``"middle"``).
    """
    if axis not in AXES:
        raise refusal("axis", axis, ", ".join(AXES), f'= {axis!r}: it must be "short-axis" or "long-axis"')
    return in_order(motion, times, axis == "long-axis")


def precession_and_spin(motion: Motion, times: Array, axis: str) -> tuple[Array, Array]:
    """Andoyer's angles μ and ν about an axis [rad]."""
    if axis == "short-axis":
        variables = motion.andoyer(times)
        return variables[:, 1], variables[:, 2]
    numbers, _, directions = about(motion, times, axis)
    principal = motion.scene.body.principal_axes[:, numbers] * [-1.0 if left_handed(numbers) else 1.0, 1, 1]
    attitude = motion.at(times).attitude
    # The axes of the body in inertial components, then on the axes of the momentum: node, across, momentum.
    turned = np.stack([rotate(attitude, column) for column in principal.T], axis=-1)
    momentum = motion.angular_momentum(times)
    up = momentum / np.linalg.norm(momentum, axis=1, keepdims=True)
    flat = np.hypot(up[:, 0], up[:, 1])
    node = np.where(flat[:, None] > POLE, np.column_stack([-up[:, 1], up[:, 0], 0 * flat]) / np.maximum(flat, POLE)[:, None], [1.0, 0.0, 0.0])
    frame = np.stack([node, np.cross(up, node), up], axis=1)
    matrix = frame @ turned
    sloped = np.hypot(directions[:, 0], directions[:, 1]) > POLE
    mu = np.where(sloped, np.arctan2(matrix[:, 0, 2], -matrix[:, 1, 2]), np.arctan2(matrix[:, 1, 0], matrix[:, 0, 0]))
    return mu, np.where(sloped, np.arctan2(directions[:, 0], directions[:, 1]), 0.0)


def left_handed(order: Any) -> bool:
    """Whether axes in an order form a left-handed system."""
    return bool(np.linalg.det(np.eye(3)[order]) < 0)


def names(numbers: list[int]) -> list[str]:
    """The numbers of the user's axes in an order; a minus marks a reversed first axis."""
    labels = [str(number + 1) for number in numbers]
    return [f"−{labels[0]}", *labels[1:]] if left_handed(numbers) else labels


def nutation_angle(directions: Array) -> Array:
    """J from the components perpendicular to axis 3, because the arccosine of N/M is inaccurate for small J."""
    angle: Array = np.arctan2(np.hypot(directions[:, 0], directions[:, 1]), directions[:, 2])
    return angle


def without_mean(angle: Array, times: Array) -> tuple[Array, float, Array]:
    """An angle [rad] less its mean motion, the mean motion [rad per unit of time], the angle unwrapped.

    `times` span whole periods of the polhode, and sample every turn of the angle more than twice.
    """
    unwrapped = np.unwrap(angle)
    slope = (unwrapped[-1] - unwrapped[0]) / (times[-1] - times[0])
    rest = unwrapped - slope * (times - times[0])
    return rest - rest.mean(), slope, unwrapped


def is_still(unwrapped: Array) -> bool:
    """Whether an angle that is unwrapped ends within half a turn of its start."""
    return bool(abs(unwrapped[-1] - unwrapped[0]) < math.pi)
