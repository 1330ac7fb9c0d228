"""Attitude errors relative to tests/reference/torque_free.py, for many evaluations of the same motion at the same times.

A reference attitude is stored as a sum of two doubles, so that differences from it are accurate to 1e-32. The angle comes from the relative quaternion, which is accurate for
small and large angles.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from torque_free import TorqueFree

import andoyer

# Separatrix and long phases lose only guard digits; 20 digits are more than a double has.
DIGITS = 20


class Reference:
    """The attitudes of a body at `times`, from `attitude` and `angular_velocity` at time 0. An attitude takes about 6 ms."""

    def __init__(self, moments: ArrayLike, attitude: ArrayLike, angular_velocity: ArrayLike, times: ArrayLike) -> None:
        motion = TorqueFree(moments, attitude, angular_velocity, digits=DIGITS)
        self.times = np.asarray(times, dtype=float)
        states = [motion.state(t)[0] for t in self.times]
        self.high = np.array([[float(x) for x in q] for q in states])
        self.low = np.array([[float(x - float(x)) for x in q] for q in states])

    def errors(self, attitudes: NDArray[np.float64]) -> NDArray[np.float64]:
        """The angle [rad] between each of `attitudes` (n, 4), at the times of the reference, and the true one."""
        sign = np.sign(np.sum(attitudes * self.high, axis=1, keepdims=True))
        difference = (sign * attitudes - self.high) - self.low
        # The relative quaternion is 1 + conj(reference) difference. Its vector part does not contain the 1, so small angles are accurate.
        scalar = np.sum(self.high * difference, axis=1)
        v, w = self.high[:, :3], self.high[:, 3:]
        vector = w * difference[:, :3] - v * difference[:, 3:] - np.cross(v, difference[:, :3])
        angles: NDArray[np.float64] = 2 * np.arctan2(np.linalg.norm(vector, axis=1), 1 + scalar)
        return angles

    def largest_error(self, motion: andoyer.Motion) -> float:
        """The largest attitude error [rad] of `motion`."""
        return float(self.errors(motion.attitude(self.times)).max())
