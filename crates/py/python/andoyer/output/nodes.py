"""Times at which a motion is tabulated, so that uniform rotation between neighbouring times stays within a given error.

Between two attitudes a C-kernel of type 3 rotates about one axis at one rate. For a motion with the angular acceleration α = |dω/dt| the error
is h²α/8 in the middle of an interval h, the difference between a parabola and its chord. The smallest number of nodes for an error ε therefore has the density √(α/8ε), and
the number is the integral of the density. α is computed from the attitude in the middle of a short interval and includes every torque.
An interval is at most a quarter of a turn long, because SPICE takes the shorter of the two rotations.
"""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from andoyer._core import Motion
from andoyer._quaternions import Array, angle_between, between

ROTATIONS = 32
"""Rotations that are looked at together."""

GRID = 64
"""Places a rotation where the density is measured."""

LONGEST = math.pi / 2
"""Rotation [rad] from one node to the next, at most."""

MARGIN = 0.98
"""Part of the error that the nodes are laid out for: the maximum need not lie where it is measured."""

SMALLEST_ERROR = 1e-13
"""Attitudes near one have rounding errors of 1e-15 rad: below this they would be measured."""

ATTEMPTS = 8


def windows(motion: Motion, start: float, stop: float) -> Array:
    """Borders of the windows, the parts of the interval that are tabulated one after the other: `ROTATIONS` rotations each, or the whole interval."""
    rate = float(np.max(np.linalg.norm(motion.angular_velocity(np.linspace(start, stop, 1024)), axis=1)))
    count = max(1, math.ceil((stop - start) * rate / (2 * math.pi * ROTATIONS)))
    return np.linspace(start, stop, count + 1)


def estimate(motion: Motion, borders: Array, error: float) -> float:
    """Estimate the number of nodes from the first window."""
    _, integral = _count(motion, float(borders[0]), float(borders[1]), MARGIN * error)
    return float(integral[-1]) * (len(borders) - 1)


def nodes(motion: Motion, borders: Array, error: float) -> Iterator[Array]:
    """The nodes of each window between two borders; both borders are nodes.

    Raises
    ------
    ArithmeticError
        More nodes do not bring the error below its bound, because rounding dominates.
    """
    for start, stop in itertools.pairwise(borders):
        yield _window(motion, float(start), float(stop), error)


def _window(motion: Motion, start: float, stop: float, error: float) -> Array:
    places, integral = _count(motion, start, stop, MARGIN * error)
    more = 1.0
    for _ in range(ATTEMPTS):
        count = max(1, math.ceil(more * integral[-1]))
        times = np.interp(np.linspace(0, integral[-1], count + 1), integral, places)
        times[0], times[-1] = start, stop
        worst = _error(motion, times)
        if worst <= error:
            return times
        more *= math.sqrt(worst / error) * 1.01
    raise ArithmeticError(f"{worst:.3g} rad are left between nodes from {start!r} to {stop!r}")


def _count(motion: Motion, start: float, stop: float, error: float) -> tuple[Array, Array]:
    """Times in the interval, and the number of nodes that are needed up to each time."""
    steps = ROTATIONS * GRID
    times = np.linspace(start, stop, 2 * steps + 1)
    samples = motion.at(times)
    length = (stop - start) / steps
    lacking = angle_between(between(samples.attitude[:-2:2], samples.attitude[2::2], 0.5), samples.attitude[1::2])
    acceleration = 8 * lacking / length**2
    rate = np.linalg.norm(samples.angular_velocity[1::2], axis=1)
    density = np.maximum(np.sqrt(acceleration / (8 * error)), rate / LONGEST)
    return times[::2], np.concatenate([[0.0], np.cumsum(density) * length])


def _error(motion: Motion, times: Array) -> float:
    """The largest error [rad] of uniform rotation from each time to the next, at three times between them."""
    attitude = motion.attitude(times)
    widths = np.diff(times)
    return max(
        float(np.max(angle_between(between(attitude[:-1], attitude[1:], part), motion.attitude(times[:-1] + part * widths)))) for part in (0.25, 0.5, 0.75)
    )
