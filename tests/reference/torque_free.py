"""Torque-free rigid-body motion from Jacobi's closed form in multiple precision. It is a reference for other solutions.

Inputs are doubles or decimal strings and count as exact; the quaternion is normalized first. Attitudes are unit quaternions
[x, y, z, w], Hamilton product, that rotate body components into inertial ones. Rates are body components.

Axes are renamed so that the angular momentum circles axis 3 (the shortest or the longest axis) and the rate about it is positive:

    w1 = a1 cn(u), w2 = s a2 sn(u), w3 = a3 dn(u),    u = u0 + n t,    s = sign(I3 - I2)
    P = G^2 - 2T I1 = I2 (I2-I1) w2^2 + I3 (I3-I1) w3^2          Q = 2T I3 - G^2 = I1 (I3-I1) w1^2 + I2 (I3-I2) w2^2
    a1^2 = Q/(I1 (I3-I1)),   a2^2 = Q/(I2 (I3-I2)),   a3^2 = P/(I3 (I3-I1)),   n^2 = P (I3-I2)/(I1 I2 I3)
    m = Q (I2-I1)/(P (I3-I2)),   1-m = (I3-I1) [I3 (I3-I2) w3^2 - I1 (I2-I1) w1^2]/(P (I3-I2))

and the angle of axis 3 about the angular momentum is, with nu = -I3 (I2-I1)/(I1 (I3-I2)) <= 0 and am = am(u | m),

    phi(t) - phi(0) = (G/I3) t + G (I3-I1)/(I1 I3 n) [Pi(nu; am(u) | m) - Pi(nu; am(u0) | m)]

P and Q are sums of terms of one sign, so there is no cancellation at J -> 0. The formulas are valid for every motion except those on the separatrix itself, which raise
ValueError. Steady rotations (sphere, a principal axis, rest) are the exponential of the constant rate. A state takes a few milliseconds.
Source: theory §10; Jacobi's solution as in R. van Zon and J. Schofield, J. Comput. Phys. 225 (2007) 145-164.

    python torque_free.py data/torque_free.json      compares every case of such a file, exit status 1 if one is worse than 1e-25
"""

import json
import sys
import time

from mpmath import MPContext

GUARD_DIGITS = 40  # a long phase n t and a state near the separatrix lose about 15 digits each


class TorqueFree:
    """The motion through one state: `moments` about body axes 1, 2, 3 in any order, `attitude` [x, y, z, w], `angular_velocity` in the body.

    `mode` is "short-axis", "long-axis", "axisymmetric", "spherical", "principal-axis" or "at-rest"; `parameter` and `complement` are m and
    1-m of the elliptic functions (0 and 1 for steady rotations). Results have `digits` significant digits.
    """

    def __init__(self, moments, attitude, angular_velocity, *, epoch=0.0, digits=40):
        self.digits = digits
        self.context = MPContext()
        self.context.dps = digits + GUARD_DIGITS
        self.moments = [self._exact(x) for x in moments]
        self.rates = [self._exact(x) for x in angular_velocity]
        self.attitude = _unit([self._exact(x) for x in attitude], self.context)
        self.epoch = self._exact(epoch)
        self.parameter, self.complement = self.context.mpf(0), self.context.mpf(1)
        if min(self.moments) <= 0 or len(self.moments) != 3 or len(self.rates) != 3:
            raise ValueError(f"three positive moments and three rates are needed, not {moments} and {angular_velocity}")
        (i1, i2, i3), (w1, w2, w3) = self.moments, self.rates
        self.steady = not any([(i2 - i3) * w2 * w3, (i3 - i1) * w3 * w1, (i1 - i2) * w1 * w2])
        if self.steady:
            self.mode = "at-rest" if not any(self.rates) else "spherical" if i1 == i2 == i3 else "principal-axis"
        else:
            self._choose_axes()
            self._set_constants()

    def _exact(self, x):
        """A double (NumPy's too), an integer or a decimal string as a number of the private context, a double without rounding."""
        return self.context.mpf(x) if isinstance(x, (str, int)) or hasattr(x, "_mpf_") else self.context.mpf(float(x))

    def _choose_axes(self):
        """Finds axes (i1, i2, i3) of a right-handed set, as (index, sign) pairs, with axis 3 the one circled and w3 > 0."""
        low, middle, high = sorted(range(3), key=lambda i: self.moments[i])
        a, b, c = (self.moments[i] for i in (low, middle, high))
        # The sign of G^2 - 2T B determines which axis is circled. With exact inputs and guard digits it is certain unless the value is zero.
        excess = c * (c - b) * self.rates[high] ** 2 - a * (b - a) * self.rates[low] ** 2
        if excess == 0:
            raise ValueError("the state lies on the separatrix (G^2 = 2TB exactly), where the closed form in sn, cn, dn degenerates")
        order = (low, middle, high) if excess > 0 else (high, middle, low)
        self.mode = "axisymmetric" if a == b or b == c else "short-axis" if excess > 0 else "long-axis"
        sign3 = 1 if self.rates[order[2]] > 0 else -1
        parity = 1 if order in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
        self.axes = ((order[0], 1), (order[1], parity * sign3), (order[2], sign3))

    def _set_constants(self):
        """The constants of the module's formulas, and u0, phi(0) and the quaternion from the invariable frame."""
        cx = self.context
        i1, i2, i3 = self.principal = [self.moments[i] for i, _ in self.axes]
        w1, w2, w3 = w = [sign * self.rates[i] for i, sign in self.axes]
        p = i2 * (i2 - i1) * w2**2 + i3 * (i3 - i1) * w3**2
        q = i1 * (i3 - i1) * w1**2 + i2 * (i3 - i2) * w2**2
        self.amplitudes = [cx.sqrt(q / (i1 * (i3 - i1))), cx.sign(i3 - i2) * cx.sqrt(q / (i2 * (i3 - i2))), cx.sqrt(p / (i3 * (i3 - i1)))]
        self.rate = cx.sqrt(p * (i3 - i2) / (i1 * i2 * i3))
        self.parameter = q * (i2 - i1) / (p * (i3 - i2))
        self.complement = (i3 - i1) * (i3 * (i3 - i2) * w3**2 - i1 * (i2 - i1) * w1**2) / (p * (i3 - i2))
        self.characteristic = -i3 * (i2 - i1) / (i1 * (i3 - i2))
        self.momentum = cx.sqrt(sum((moment * x) ** 2 for moment, x in zip(self.principal, w)))
        self.factor = self.momentum * (i3 - i1) / (i1 * i3 * self.rate)
        start = cx.atan2(w2 / self.amplitudes[1], w1 / self.amplitudes[0])
        self.phase = cx.ellipf(start, self.parameter)
        self.quarter_period = cx.ellipk(self.parameter)
        self.turn = 2 * cx.ellippi(self.characteristic, self.parameter)
        self.start = self._third_kind(start)
        # Body to inertial = (invariable frame to inertial) (body to invariable frame): the first is constant.
        self.frame = _product(self.attitude, _conjugate(self._in_invariable_frame(w, self.context.mpf(0))))

    def _third_kind(self, phi):
        """Pi(nu; phi | m) for any real phi, unwrapped: Pi(phi + j pi) = Pi(phi) + 2 j Pi(pi/2)."""
        turns = self.context.nint(phi / self.context.pi)
        return turns * self.turn + self.context.ellippi(self.characteristic, phi - turns * self.context.pi, self.parameter)

    def _amplitude(self, u):
        """am(u | m), unwrapped, by the descending Landen transformation (Abramowitz and Stegun 16.4)."""
        cx = self.context
        a, b, c, steps = cx.mpf(1), cx.sqrt(self.complement), cx.sqrt(self.parameter), []
        while abs(c) > cx.eps * a:
            a, b, c = (a + b) / 2, cx.sqrt(a * b), (a - b) / 2
            steps.append(c / a)
        phi = 2 ** len(steps) * a * u
        for ratio in reversed(steps):
            phi = (phi + cx.asin(ratio * cx.sin(phi))) / 2
        return phi

    def _in_invariable_frame(self, w, phi):
        """The quaternion body -> invariable frame (z along the angular momentum) of rates `w` about the renamed axes, axis 3 at angle `phi`."""
        cx = self.context
        g1, g2, g3 = (moment * x / self.momentum for moment, x in zip(self.principal, w))
        psi, tilt = cx.atan2(g1, g2), (g1**2 + g2**2) / (2 * (1 + g3))  # tilt = sin^2(J/2)
        a = cx.sqrt((1 + g3) / 2) * cx.expj((phi + psi) / 2)
        b = cx.sqrt(tilt) * cx.expj((phi - psi) / 2)
        return _product([b.real, b.imag, a.imag, a.real], self._renaming())

    def _renaming(self):
        """The quaternion body axes -> renamed axes: of the signed permutation, by whichever of its four components is largest."""
        cx = self.context
        r = [[cx.mpf(sign if j == i else 0) for j in range(3)] for i, sign in self.axes]
        trace = r[0][0] + r[1][1] + r[2][2]
        squares = [1 + 2 * r[i][i] - trace for i in range(3)] + [1 + trace]
        big = max(range(4), key=lambda i: squares[i])
        skew = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]]
        if big == 3:
            return _unit([*skew, squares[3]], cx)
        return _unit([squares[big] if j == big else r[j][big] + r[big][j] for j in range(3)] + [skew[big]], cx)

    def state(self, t):
        """The attitude quaternion [x, y, z, w] and the body rates at time `t`, as lists of multiple-precision numbers.

        The quaternion's sign is not continuous in t: q and -q are the same attitude.
        """
        cx = self.context
        elapsed = self._exact(t) - self.epoch
        if self.steady:
            return self._steady_state(elapsed)
        am = self._amplitude(self.phase + self.rate * elapsed)
        s, c = cx.sin(am), cx.cos(am)
        dn = cx.sqrt(self.complement + self.parameter * c * c)
        w = [a * x for a, x in zip(self.amplitudes, (c, s, dn))]
        phi = self.momentum * elapsed / self.principal[2] + self.factor * (self._third_kind(am) - self.start)
        attitude = _product(self.frame, self._in_invariable_frame(w, phi))
        rates = [cx.mpf(0)] * 3
        for x, (i, sign) in zip(w, self.axes):
            rates[i] = sign * x
        return attitude, rates

    def mean_rates(self):
        """The mean rates of axis 3 about the angular momentum and of the body about axis 3 (of mu and nu in a short-axis mode with N > 0).

        Axis 3 is the circled axis, on the side of the angular momentum. These rates are not defined for steady rotations.
        """
        period = 4 * self.quarter_period / self.rate  # of the rates, in which am advances by 2 pi
        about_momentum = self.momentum / self.principal[2] + 2 * self.factor * self.turn / period
        return about_momentum, -self.context.sign(self.amplitudes[1]) * 2 * self.context.pi / period

    def _steady_state(self, elapsed):
        cx = self.context
        speed = cx.sqrt(sum(x * x for x in self.rates))
        if not speed:
            return list(self.attitude), list(self.rates)
        s, c = cx.sin(speed * elapsed / 2), cx.cos(speed * elapsed / 2)
        return _product(self.attitude, [s * x / speed for x in self.rates] + [c]), list(self.rates)


def solve(moments, attitude, angular_velocity, times, *, epoch=0.0, digits=40):
    """Attitude quaternions and body rates at `times`, each a list with one row of multiple-precision numbers for each time."""
    motion = TorqueFree(moments, attitude, angular_velocity, epoch=epoch, digits=digits)
    states = [motion.state(t) for t in times]
    return [q for q, _ in states], [w for _, w in states]


def attitude_error(q, q_ref, digits=40):
    """The angle [rad] of the rotation between two attitudes, each normalized first: 4 atan2(|p - r|, |p + r|), accurate at 0 and at pi."""
    cx = MPContext()
    cx.dps = digits + GUARD_DIGITS
    p, r = (_unit([cx.mpf(x) if isinstance(x, str) or hasattr(x, "_mpf_") else cx.mpf(float(x)) for x in row], cx) for row in (q, q_ref))
    apart, sum_ = (cx.sqrt(sum((x + sign * y) ** 2 for x, y in zip(p, r))) for sign in (-1, 1))
    return 4 * cx.atan2(min(apart, sum_), max(apart, sum_))


def _unit(q, context):
    norm = context.sqrt(sum(x * x for x in q))
    if norm == 0 or len(q) != 4:
        raise ValueError(f"an attitude is a quaternion [x, y, z, w] other than zero, not {q}")
    return [x / norm for x in q]


def _conjugate(q):
    return [-q[0], -q[1], -q[2], q[3]]


def _product(p, q):
    """Hamilton product p q, scalars last."""
    (a, b, c, d), (e, f, g, h) = p, q
    return [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g]


def residual(motion, t, step="1e-20"):
    """The residual of the state at `t` in q' = q w/2 and in Euler's equations: the largest component, by central differences.

    The differences are taken at the working precision. With rates of order one their truncation error is of order step^2.
    """
    step, t = motion.context.mpf(step), motion.context.mpf(t)
    (q0, w0), (q, w), (q1, w1) = (motion.state(x) for x in (t - step, t, t + step))
    q0, q1 = ([-x for x in row] if sum(x * y for x, y in zip(row, q)) < 0 else row for row in (q0, q1))
    i1, i2, i3 = motion.moments
    euler = [(i2 - i3) * w[1] * w[2] / i1, (i3 - i1) * w[2] * w[0] / i2, (i1 - i2) * w[0] * w[1] / i3]
    right = [x / 2 for x in _product(q, [*w, motion.context.mpf(0)])] + euler
    return max(abs((b - a) / (2 * step) - x) for a, b, x in zip(q0 + w0, q1 + w1, right))


def compare(path):
    """Print, for every case of the JSON file at `path`, the largest differences from this module. Return the largest of all.

    The last columns are `residual` at the last epoch of the case, which does not use the closed form, and the speed.
    """
    worst = 0.0
    print(f"{'case':22s} {'mode':15s} {'epochs':>6s} {'attitude [rad]':>15s} {'rates (relative)':>17s} {'residual':>9s} {'epochs/s':>9s}")
    with open(path, encoding="utf-8") as file:
        cases = json.load(file)
    for case in cases:
        motion = TorqueFree(case["moments"], case["attitude0_xyzw"], case["angular_velocity0"])
        attitude = rates = 0.0
        clock = time.perf_counter()
        for row in case["states"]:
            q, w = motion.state(row["t"])
            ref = [motion.context.mpf(x) for x in row["angular_velocity"]]
            size = max(abs(x) for x in ref) or 1
            attitude = max(attitude, float(attitude_error(q, row["attitude_xyzw"])))
            rates = max(rates, float(max(abs(x - y) for x, y in zip(w, ref)) / size))
        speed = len(case["states"]) / (time.perf_counter() - clock)
        left = float(residual(motion, case["states"][-1]["t"]))
        print(f"{case['name']:22s} {motion.mode:15s} {len(case['states']):6d} {attitude:15.1e} {rates:17.1e} {left:9.0e} {speed:9.0f}")
        worst = max(worst, attitude, rates, left)
    print(f"largest difference: {worst:.1e}")
    return worst


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: python {sys.argv[0]} FILE.json")
    sys.exit(compare(sys.argv[1]) > 1e-25)
