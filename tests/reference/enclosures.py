"""Torque-free rigid-body motion in ball arithmetic: every number has a proven bound of its error, at 40 digits or more.

The formulas are those of Jacobi in the axes of `torque_free.py` (the angular momentum circles axis 3, and the rate about it is positive), evaluated in
a different way: sn, cn, dn as quotients of theta functions of the nome, integrals in Carlson's symmetric forms. With s, c, d = sn, cn, dn of u,

    theta quotients      s = t3 t1(z)/(t2 t4(z)),  c = t4 t2(z)/(t2 t4(z)),  d = t4 t3(z)/(t3 t4(z)),   z = u/(2K),  tau = i K'/K
    angle of axis 3      phi = G t/I1 + f [T(u0 + n t) - T(u0)],   f = G (I3-I1)/(I1 I3 n),   v = -I3 (I2-I1)/(I1 (I3-I2))
                         T(u) = (v/3) s^3 RJ(c^2, d^2, 1, 1 - v s^2)   for |u| <= K,   T(u + 2jK) = T(u) + 2j T(K)

Inputs are doubles that count as exact; the quaternion is normalized. If a ball is wider than requested, the computation is repeated with twice the
bits. A state next to the separatrix, or a phase after 1e9 rotations, therefore takes more time but loses no digits. Exact integers decide which axis is circled.
On the separatrix itself (G^2 = 2TB exactly) ValueError is raised. A state takes about 0.1 ms with FLINT's Arb (python-flint).
Sources: theory §10; B. C. Carlson, Numer. Algorithms 10 (1995) 13-26; NIST DLMF 22.2, 19.25.
`stress/references.py` compares the results with `torque_free.py` (mpmath, Landen, Legendre) and with Taylor series of the equations of motion.
"""

from fractions import Fraction

from flint import acb, arb, ctx, fmpq

FIRST_BITS, MOST_BITS = 192, 1 << 15
WIDEST = 2.0**-133  # of an attitude's and a relative rate's ball: 40 digits


class TooWide(ArithmeticError):
    """The balls are wider than requested, and more bits are needed."""


def solve(moments, attitude, angular_velocity, times, epoch=0.0):
    """Attitudes [x, y, z, w] and body rates at `times` as pairs (n, 4), (n, 3) of lists of balls, the first four of unit norm."""
    bits = FIRST_BITS
    while bits <= MOST_BITS:
        ctx.prec = bits
        try:
            return Enclosure(moments, attitude, angular_velocity, epoch).states(times)
        except TooWide:
            bits *= 2
    raise ArithmeticError(f"{MOST_BITS} bits do not suffice")


def split(ball):
    """A ball's midpoint as the sum of two doubles."""
    middle = ball.mid()
    high = float(middle)
    return high, float(middle - arb(high))


class Enclosure:
    """The motion through one state, at the precision that `flint.ctx` has now; use `solve`."""

    def __init__(self, moments, attitude, angular_velocity, epoch=0.0):
        self.moments, self.rates = ([arb(float(x)) for x in row] for row in (moments, angular_velocity))
        self.epoch = arb(float(epoch))
        quaternion = [arb(float(x)) for x in attitude]
        norm = sum((x * x for x in quaternion), arb(0)).sqrt()
        self.attitude = [x / norm for x in quaternion]
        exact = [Fraction(float(x)) for x in moments]
        speeds = [Fraction(float(x)) for x in angular_velocity]
        self.steady = not any((exact[i] - exact[j]) * speeds[i] * speeds[j] for i, j in ((0, 1), (1, 2), (2, 0)))
        if not self.steady:
            self._choose_axes(exact, speeds)
            self._set_constants(exact, speeds)

    def _choose_axes(self, exact, speeds):
        low, middle, high = sorted(range(3), key=lambda i: exact[i])
        a, b, c = (exact[i] for i in (low, middle, high))
        excess = c * (c - b) * speeds[high] ** 2 - a * (b - a) * speeds[low] ** 2
        if excess == 0:
            raise ValueError("the state lies on the separatrix (G^2 = 2TB exactly)")
        order = (low, middle, high) if excess > 0 else (high, middle, low)
        sign = 1 if speeds[order[2]] > 0 else -1
        parity = 1 if order in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
        self.axes = ((order[0], 1), (order[1], parity * sign), (order[2], sign))

    def _set_constants(self, exact, speeds):
        # Squares and differences are exact rationals. Only products and roots follow, which do not cancel.
        i1, i2, i3 = (exact[i] for i, _ in self.axes)
        w1, w2, w3 = (sign * speeds[i] for i, sign in self.axes)
        p = i2 * (i2 - i1) * w2**2 + i3 * (i3 - i1) * w3**2
        q = i1 * (i3 - i1) * w1**2 + i2 * (i3 - i2) * w2**2
        parameter = q * (i2 - i1) / (p * (i3 - i2))
        self.parameter, self.complement = ball(parameter), ball(1 - parameter)
        self.amplitudes = [ball(q / (i1 * (i3 - i1))).sqrt(), ball(q / (i2 * (i3 - i2))).sqrt(), ball(p / (i3 * (i3 - i1))).sqrt()]
        if i3 < i2:
            self.amplitudes[1] = -self.amplitudes[1]
        self.rate = ball(p * (i3 - i2) / (i1 * i2 * i3)).sqrt()
        self.characteristic = ball(-i3 * (i2 - i1) / (i1 * (i3 - i2)))
        self.momentum = ball(sum((i * w) ** 2 for i, w in zip((i1, i2, i3), (w1, w2, w3)))).sqrt()
        self.precession = self.momentum / ball(i1)
        self.factor = self.momentum * ball((i3 - i1) / (i1 * i3)) / self.rate
        self.principal = [ball(i) for i in (i1, i2, i3)]
        # K = pi / (2 agm(1, k')), and K' with k: neither needs a difference from 1.
        self.quarter = arb.pi() / 2 / arb(1).agm(self.complement.sqrt())
        if parameter:
            self.tau = acb(0, arb.pi() / 2 / arb(1).agm(self.parameter.sqrt()) / self.quarter)
            self.constants = [x.real for x in acb(0).modular_theta(self.tau)]
        self.turn = 2 * self._third(arb(1), arb(0), self.complement)
        first, second = ball(w1) / self.amplitudes[0], ball(w2) / self.amplitudes[1]
        third = ball(w3) / self.amplitudes[2]
        self.phase = second * acb.elliptic_rf(first * first, third * third, 1).real
        self.start = self._third(second, first * first, third * third)
        if w1 < 0:  # beyond a quarter period: u = 2K sign(s) - u, T likewise
            sign = 1 if w2 * (i3 - i2) >= 0 else -1
            self.phase, self.start = 2 * sign * self.quarter - self.phase, sign * self.turn - self.start
        self.frame = product(self.attitude, conjugate(self._in_invariable_frame([ball(w1), ball(w2), ball(w3)], arb(0))))

    def _third(self, s, cosine2, delta2):
        """T of the module's formulas from sn, cn^2, dn^2, |u| <= K."""
        v = self.characteristic
        if v.is_zero() or s.is_zero():
            return arb(0)
        return v / 3 * s * s * s * acb.elliptic_rj(cosine2, delta2, 1, 1 - v * s * s).real

    def _third_at_ends(self, u, s, c):
        """T(u) for u that may be 0, K or -K, where Carlson's integral is at the edge of its domain: dT/du = v s^2/(1 - v s^2), and |s| <= |u|."""
        if s.contains(0):
            return self.characteristic * u * u * u * arb(0, 1)
        if c.contains(0):
            sign = 1 if s > 0 else -1
            return sign * self.turn / 2 + (u - sign * self.quarter) * arb(0, 1)
        return None

    def _in_invariable_frame(self, w, phi):
        g1, g2, g3 = (moment * x / self.momentum for moment, x in zip(self.principal, w))
        # A direction of (0, 0) is arbitrary, because the tilt is zero too.
        tilt2 = g1 * g1 + g2 * g2
        tilt = tilt2.sqrt()
        up = ((1 + g3) / 2).sqrt()
        s, c = (phi / 2).sin_cos()
        # e^{i psi/2} with tan psi = g1/g2, up to a sign that is common to both numbers of the quaternion.
        cosine, sine = g2 / tilt, g1 / tilt
        if cosine > 0:
            b = ((1 + cosine) / 2).sqrt()
            a = sine / (2 * b)
        else:
            a = ((1 - cosine) / 2).sqrt()
            if sine < 0:
                a = -a
            b = sine / (2 * a)
        across = tilt / (2 * up)
        return product([across * (c * b + s * a), across * (s * b - c * a), up * (s * b + c * a), up * (c * b - s * a)], self._renaming())

    def _renaming(self):
        """The quaternion body axes -> renamed axes of the signed permutation, from its largest component."""
        r = [[sign if j == i else 0 for j in range(3)] for i, sign in self.axes]
        trace = r[0][0] + r[1][1] + r[2][2]
        squares = [1 + 2 * r[i][i] - trace for i in range(3)] + [1 + trace]
        big = max(range(4), key=lambda i: squares[i])
        skew = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]]
        whole = [*skew, squares[3]] if big == 3 else [squares[big] if j == big else r[j][big] + r[big][j] for j in range(3)] + [skew[big]]
        norm = arb(sum(x * x for x in whole)).sqrt()
        return [x / norm for x in whole]

    def states(self, times):
        """Attitudes and rates at times."""
        found = [self.state(t) for t in times]
        scale = max(abs(float(x)) for x in self.rates)
        for attitude, rates in found:
            if not all(x.rad() < WIDEST for x in attitude) or not all(x.rad() <= WIDEST * scale for x in rates):
                raise TooWide
        return [q for q, _ in found], [w for _, w in found]

    def state(self, t):
        """Attitude and rates at a time."""
        elapsed = arb(float(t)) - self.epoch
        if self.steady:
            return self._steady_state(elapsed)
        u = self.phase + self.rate * elapsed
        turns = (u / (2 * self.quarter)).mid()
        turns = arb((turns + arb(0.5)).floor().unique_fmpz())
        u -= 2 * turns * self.quarter
        s, c, d = self._jacobi(u)
        third = self._third_at_ends(u, s, c)
        if third is None:
            third = self._third(s, c * c, d * d)
        third += turns * self.turn
        if int(float(turns)) % 2:
            s, c = -s, -c
        w = [a * x for a, x in zip(self.amplitudes, (c, s, d))]
        attitude = product(self.frame, self._in_invariable_frame(w, self.precession * elapsed + self.factor * (third - self.start)))
        rates = [arb(0)] * 3
        for x, (i, sign) in zip(w, self.axes):
            rates[i] = sign * x
        return attitude, rates

    def _jacobi(self, u):
        if self.parameter.is_zero():
            return *u.sin_cos(), arb(1)
        t1, t2, t3, t4 = (x.real for x in acb(u / (2 * self.quarter)).modular_theta(self.tau))
        _, c2, c3, c4 = self.constants
        return c3 * t1 / (c2 * t4), c4 * t2 / (c2 * t4), c4 * t3 / (c3 * t4)

    def _steady_state(self, elapsed):
        speed = sum((x * x for x in self.rates), arb(0)).sqrt()
        if not any(float(x) for x in self.rates):
            return list(self.attitude), list(self.rates)
        s, c = (speed * elapsed / 2).sin_cos()
        return product(self.attitude, [s * x / speed for x in self.rates] + [c]), list(self.rates)


def ball(fraction):
    """A rational as a ball of the current precision."""
    return arb(fmpq(fraction.numerator, fraction.denominator))


def conjugate(q):
    """The inverse of a unit quaternion."""
    return [-q[0], -q[1], -q[2], q[3]]


def product(p, q):
    """Hamilton product p q, scalars last."""
    (a, b, c, d), (e, f, g, h) = p, q
    return [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g]
