"""Attitude under the gravity gradient of a Keplerian body by numerical integration: an independent check of the averaged theory.

It integrates Euler's equations with the torque 3 n^2 f (a/r)^3 r x (I r) and the kinematics of the quaternion; r is the unit vector to the disturbing body in body components, and f is its share of
the mass. SciPy's DOP853 with relative tolerance 1e-13 is accurate to about 1e-11 rad over 100 rotations. The module shares nothing with the
library: it uses neither averaging nor angles. It needs numpy and scipy.

    python tests/reference/gravity_gradient.py tests/data/gravity_gradient.json     compares the file with this module; takes some minutes
"""

import json
import math
import sys
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp


class GravityGradient:
    """The motion of a body with `moments` from a state at `epoch`; `orbit` has the attributes of andoyer.Orbit."""

    def __init__(self, moments, attitude, angular_velocity, orbit, epoch=0.0):
        self.moments = [float(moment) for moment in moments]
        self.start = [*map(float, attitude), *map(float, angular_velocity)]
        self.orbit, self.epoch = orbit, float(epoch)
        self.axes = _plane(orbit.inclination, orbit.node, orbit.argument_of_pericentre)

    def states(self, times):
        """Attitudes (n, 4) and body rates (n, 3) at ascending `times`, the first of them not before the epoch."""
        ends = (self.epoch, max(float(times[-1]), self.epoch))
        if ends[0] == ends[1]:
            return np.array([self.start[:4]]), np.array([self.start[4:]])
        solution = solve_ivp(self._slope, ends, self.start, "DOP853", t_eval=times, rtol=1e-13, atol=1e-18)
        attitude = solution.y[:4].T
        return attitude / np.linalg.norm(attitude, axis=1, keepdims=True), solution.y[4:].T

    def direction(self, time):
        """Unit vector to the disturbing body, inertial components, and a/r."""
        e = self.orbit.eccentricity
        mean = math.remainder(self.orbit.mean_motion * (time - self.orbit.time_of_pericentre), 2 * math.pi)
        anomaly = mean + e * math.sin(mean)
        for _ in range(50):
            step = (anomaly - e * math.sin(anomaly) - mean) / (1 - e * math.cos(anomaly))
            anomaly -= step
            if abs(step) < 1e-15:
                break
        else:
            raise ArithmeticError(f"Kepler's equation: no convergence at e = {e}, M = {mean}")
        distance = 1 - e * math.cos(anomaly)
        along, across = (math.cos(anomaly) - e) / distance, math.sqrt(1 - e * e) * math.sin(anomaly) / distance
        return [along * p + across * q for p, q in zip(*self.axes)], 1 / distance

    def _slope(self, time, state):
        x, y, z, w, p, q, r = state
        a, b, c = self.moments
        (i, j, k), near = self.direction(time)
        # The vector in the body's axes: the conjugate rotation, v + 2 u x (u x v) - 2 w u x v.
        s, t, u = y * k - z * j, z * i - x * k, x * j - y * i
        i, j, k = (
            i + 2 * (y * u - z * t) - 2 * w * s,
            j + 2 * (z * s - x * u) - 2 * w * t,
            k + 2 * (x * t - y * s) - 2 * w * u,
        )
        force = 3 * self.orbit.mean_motion**2 * self.orbit.mass_fraction * near**3
        return [
            0.5 * (w * p + y * r - z * q),
            0.5 * (w * q + z * p - x * r),
            0.5 * (w * r + x * q - y * p),
            -0.5 * (x * p + y * q + z * r),
            (c - b) * (force * j * k - q * r) / a,
            (a - c) * (force * k * i - r * p) / b,
            (b - a) * (force * i * j - p * q) / c,
        ]


def _plane(inclination, node, argument):
    """Unit vectors to the pericentre and, perpendicular to it in the orbit plane, in the direction of motion."""
    (ci, si), (cn, sn), (cw, sw) = ((math.cos(x), math.sin(x)) for x in (inclination, node, argument))
    pericentre = [cn * cw - sn * sw * ci, sn * cw + cn * sw * ci, sw * si]
    across = [-cn * sw - sn * cw * ci, -sn * sw + cn * cw * ci, cw * si]
    return pericentre, across


def compare(path):
    """Print, for every case of the JSON file at `path`, the largest differences from this module. Return the largest of all."""
    worst = 0.0
    print(f"{'case':16s} {'epochs':>6s} {'attitude [rad]':>15s} {'rates':>9s}")
    with open(path, encoding="utf-8") as file:
        cases = json.load(file)
    for case in cases:
        elements = case["orbit"]
        orbit = SimpleNamespace(**elements, inclination=0.0, node=0.0, argument_of_pericentre=elements["pericentre_longitude"], mass_fraction=1.0)
        motion = GravityGradient(case["moments"], case["attitude0_xyzw"], case["angular_velocity0"], orbit)
        attitudes, rates = motion.states([state["t"] for state in case["states"]])
        found = np.array([[*map(float, state["attitude_xyzw"])] for state in case["states"]])
        signs = np.sign(np.sum(attitudes * found, axis=1, keepdims=True))
        attitude = 2 * np.linalg.norm(signs * attitudes - found, axis=1).max()
        rate = np.abs(rates - [[*map(float, state["angular_velocity"])] for state in case["states"]]).max()
        print(f"{case['name']:16s} {len(found):6d} {attitude:15.1e} {rate:9.1e}", flush=True)
        worst = max(worst, attitude, rate)
    print(f"largest difference: {worst:.1e}")
    return worst


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: python {sys.argv[0]} FILE.json")
    sys.exit(bool(compare(sys.argv[1]) > 1e-9))
