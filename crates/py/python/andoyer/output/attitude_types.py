"""Conversion of attitudes and angular velocities to the attitude types of an AEM (504.0-B-2, table 4-4 and annex F), and back.

Attitudes are [x, y, z, w] and rotate body components into components of the reference frame. Angular velocities are body components in rad/s. Angles in the message
are in degrees.
"""

import numpy as np

from andoyer._core import Body
from andoyer._quaternions import Array, conjugate, product, rotate
from andoyer._refusal import refusal

QUATERNION = ["Q1", "Q2", "Q3", "QC"]
ANGLES = ["ANGLE_1", "ANGLE_2", "ANGLE_3"]
ANGULAR_VELOCITY = ["ANGVEL_X", "ANGVEL_Y", "ANGVEL_Z"]
SPIN = ["SPIN_ALPHA", "SPIN_DELTA", "SPIN_ANGLE", "SPIN_ANGLE_VEL"]

FIELDS = {
    "QUATERNION": QUATERNION,
    "QUATERNION/DERIVATIVE": [*QUATERNION, "Q1_DOT", "Q2_DOT", "Q3_DOT", "QC_DOT"],
    "QUATERNION/ANGVEL": [*QUATERNION, *ANGULAR_VELOCITY],
    "QUATERNION/RATE": [*QUATERNION, "RATE_1", "RATE_2", "RATE_3"],
    "EULER_ANGLE": ANGLES,
    "EULER_ANGLE/DERIVATIVE": [*ANGLES, "ANGLE_1_DOT", "ANGLE_2_DOT", "ANGLE_3_DOT"],
    "EULER_ANGLE/ANGVEL": [*ANGLES, *ANGULAR_VELOCITY],
    "EULER_ANGLE/RATE": [*ANGLES, "RATE_1", "RATE_2", "RATE_3"],
    "SPIN": SPIN,
    "SPIN/NUTATION": [*SPIN, "NUTATION", "NUTATION_PER", "NUTATION_PHASE"],
    "SPIN/NUTATION_MOM": [*SPIN, "MOMENTUM_ALPHA", "MOMENTUM_DELTA", "NUTATION_VEL"],
}
"""The numbers of a data line after its epoch, by type."""

VERSION_1 = ["QUATERNION", "QUATERNION/DERIVATIVE", "QUATERNION/RATE", "EULER_ANGLE", "EULER_ANGLE/RATE", "SPIN", "SPIN/NUTATION"]
VERSION_2 = [name for name in FIELDS if not name.endswith("/RATE")]

FROM_SAMPLES = ["QUATERNION", "QUATERNION/DERIVATIVE", "QUATERNION/ANGVEL", "SPIN", "SPIN/NUTATION", "SPIN/NUTATION_MOM"]
"""Types that are written."""

SYMMETRIC = 1e-12
"""Moments whose difference is this part of the largest, or less, are equal."""

LARGEST_NORM_ERROR = 1e-3
"""Messages carry as few as four digits: a quaternion with a norm within this of 1 is normalized."""


def columns_of(name: str, attitude: Array, rates: Array, body: Body | None = None) -> Array:
    """The numbers of the data lines of a type, shape (n, number of `FIELDS`).

    Raises
    ------
    InputError
        SPIN for a body that does not rotate about axis 3 alone; a nutation without a `Body`, for a body whose moments about axes 1 and 2 differ, or for a body at rest.
    """
    if name == "QUATERNION":
        return attitude
    if name == "QUATERNION/ANGVEL":
        return np.column_stack([attitude, np.degrees(rates)])
    if name == "QUATERNION/DERIVATIVE":
        return np.column_stack([attitude, derivative(attitude, rates)])
    axis = rotate(attitude, np.broadcast_to([0.0, 0.0, 1.0], rates.shape))
    alpha, delta = directions(axis)
    # The rest of the attitude, after Z by α + 90° and X by 90° − δ, is about Z.
    rest = product(conjugate(axis_turned(alpha, delta)), attitude)
    angle = np.remainder(2 * np.arctan2(rest[:, 2], rest[:, 3]), 2 * np.pi)
    if name == "SPIN":
        across = np.hypot(rates[:, 0], rates[:, 1])
        if np.any(across > 1e-9 * np.abs(rates[:, 2])):
            raise refusal(
                "attitude_type",
                name,
                "a rotation about body axis 3",
                f"SPIN must have a rotation about body axis 3 alone: {across.max():.3g} rad/s is across it",
            )
        return _degrees(alpha, delta, angle, rates[:, 2])
    momentum, nutation_rate, spin_rate = _nutation(name, rates, body)
    spin = np.column_stack([alpha, delta, angle, spin_rate])
    if name == "SPIN/NUTATION_MOM":
        return _degrees(spin, *directions(rotate(attitude, momentum)), nutation_rate)
    nutation, phase = np.arctan2(np.hypot(momentum[:, 0], momentum[:, 1]), momentum[:, 2]), np.arctan2(-momentum[:, 1], momentum[:, 0])
    return np.column_stack([_degrees(spin, nutation), 2 * np.pi / nutation_rate, _degrees(phase)])


def _degrees(*columns: Array) -> Array:
    """Columns of angles or their rates, in degrees."""
    degrees: Array = np.degrees(np.column_stack(columns))
    return degrees


def _nutation(name: str, rates: Array, body: Body | None) -> tuple[Array, Array, Array]:
    """Directions of the angular momentum in the body, the rate of axis 3 about it, the rate of the body about axis 3 against that motion."""
    if body is None:
        raise refusal("attitude_type", name, "a body", f"{name} must have a body with equal moments about axes 1 and 2: no body was given")
    tensor = (body.principal_axes * body.moments) @ body.principal_axes.T
    across, along = (tensor[0, 0] + tensor[1, 1]) / 2, tensor[2, 2]
    if np.abs(tensor - np.diag([across, across, along])).max() > SYMMETRIC * body.moments.max():
        message = f"{name} must have a body with equal moments about axes 1 and 2: its inertia tensor is {tensor.tolist()}"
        raise refusal("attitude_type", name, "equal moments about axes 1 and 2", message)
    momentum = rates * np.array([across, across, along])
    size = np.linalg.norm(momentum, axis=1)
    if np.any(size == 0):
        raise refusal("attitude_type", name, "a body that turns", f"{name} must have a body that turns: its angular velocity is 0")
    return momentum / size[:, None], size / across, (1 - along / across) * rates[:, 2]


def attitudes_of(name: str, table: Array, sequence: str) -> tuple[Array, Array]:
    """Attitudes from frame B to A, and the angular velocity of B relative to A in components of B [rad/s], or NaN if the type has no rates.

    ANGVEL is returned unchanged, in the frame that the message names.

    Raises
    ------
    ValueError
        A quaternion whose norm is not 1 within `LARGEST_NORM_ERROR`, or a period of nutation that is 0.
    """
    unknown = np.full((len(table), 3), np.nan)
    if name.startswith("QUATERNION"):
        norms = np.linalg.norm(table[:, :4], axis=1, keepdims=True)
        wrong = np.flatnonzero(~(np.abs(norms[:, 0] - 1) <= LARGEST_NORM_ERROR))
        if wrong.size:
            raise ValueError(f"a quaternion must have a norm within {LARGEST_NORM_ERROR:g} of 1: record {wrong[0] + 1} has {norms[wrong[0], 0]:.6g}")
        attitude = table[:, :4] / norms
        if name == "QUATERNION/DERIVATIVE":
            return attitude, 2 * product(conjugate(attitude), table[:, 4:])[:, :3]
        return attitude, np.radians(table[:, 4:]) if name == "QUATERNION/ANGVEL" else unknown
    if name.startswith("EULER_ANGLE"):
        angles = np.radians(table)
        turns = [rotations_about("XYZ".index(axis), angles[:, place]) for place, axis in enumerate(sequence)]
        attitude = product(product(turns[0], turns[1]), turns[2])
        if name == "EULER_ANGLE/DERIVATIVE":
            return attitude, _euler_rates(sequence, turns, angles[:, 3:])
        return attitude, angles[:, 3:] if name == "EULER_ANGLE/ANGVEL" else unknown
    return _spin(name, table)


def _spin(name: str, table: Array) -> tuple[Array, Array]:
    """Annex F5: the body rotates at one rate about axis 3, and this axis precesses at one rate about the angular momentum."""
    spin = np.radians(table[:, :4])
    attitude = product(axis_turned(spin[:, 0], spin[:, 1]), rotations_about(2, spin[:, 2]))
    rates = np.zeros((len(table), 3))
    rates[:, 2] = spin[:, 3]
    if name == "SPIN":
        return attitude, rates
    if name == "SPIN/NUTATION_MOM":
        alpha, delta, nutation_rate = np.radians(table[:, 4:]).T
        inertial = np.column_stack([np.cos(delta) * np.cos(alpha), np.cos(delta) * np.sin(alpha), np.sin(delta)])
        return attitude, rates + nutation_rate[:, None] * rotate(conjugate(attitude), inertial)
    if np.any(table[:, 5] == 0):
        raise ValueError("NUTATION_PER must not be 0")
    nutation, phase = np.radians(table[:, 4]), np.radians(table[:, 6])
    momentum = np.column_stack([np.sin(nutation) * np.cos(phase), -np.sin(nutation) * np.sin(phase), np.cos(nutation)])
    return attitude, rates + (2 * np.pi / table[:, 5])[:, None] * momentum


def _euler_rates(sequence: str, turns: list[Array], speeds: Array) -> Array:
    """The angular velocity in the last frame of three rotations, each about an axis of the frame before it."""
    total = np.zeros_like(speeds)
    since = np.broadcast_to([0.0, 0.0, 0.0, 1.0], turns[0].shape)
    for place in (2, 1, 0):
        axis = np.zeros_like(speeds)
        axis[:, "XYZ".index(sequence[place])] = speeds[:, place]
        total = total + rotate(conjugate(since), axis)
        since = product(turns[place], since)
    return total


def rotations_about(axis: int, angle: Array) -> Array:
    """Rotations about axis 0, 1 or 2."""
    turned = np.zeros((len(angle), 4))
    turned[:, axis], turned[:, 3] = np.sin(angle / 2), np.cos(angle / 2)
    return turned


def axis_turned(alpha: Array, delta: Array) -> Array:
    """Z by α + 90°, then X by 90° − δ: the rotation that puts axis Z to right ascension α and declination δ (annex F5.2)."""
    return product(rotations_about(2, alpha + np.pi / 2), rotations_about(0, np.pi / 2 - delta))


def directions(vectors: Array) -> tuple[Array, Array]:
    """Right ascension in [0, 2π) and declination."""
    across = np.hypot(vectors[:, 0], vectors[:, 1])
    return np.remainder(np.arctan2(vectors[:, 1], vectors[:, 0]), 2 * np.pi), np.arctan2(vectors[:, 2], across)


def derivative(attitude: Array, rates: Array) -> Array:
    """dq/dt = q ω / 2."""
    return product(attitude, np.column_stack([rates, np.zeros(len(rates))])) / 2
