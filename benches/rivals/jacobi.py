"""Jacobi's closed form on arrays with SciPy's special functions: elliptic functions, and the angle about the momentum by Carlson's integrals.

The formulas are those of tests/reference/torque_free.py (theory §10). The energies are formed without cancellation, for the best accuracy in double
precision. The period of the angle is subtracted before the integral.
"""

import math

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import ellipj, ellipkinc, ellipkm1, elliprf, elliprj


class Jacobi:
    """The motion through one state. Axes are renamed so that the angular momentum circles axis 3 and the rate about it is positive."""

    def __init__(self, moments, attitude, rates):
        order = np.argsort(moments, kind="stable")
        a, b, c = (moments[i] for i in order)
        excess = c * (c - b) * rates[order[2]] ** 2 - a * (b - a) * rates[order[0]] ** 2
        if excess < 0:
            order = order[::-1]
        upright = 1 if rates[order[2]] > 0 else -1
        even = (order[0] + 1) % 3 == order[1]
        self.order, self.signs = order, np.array([1, (1 if even else -1) * upright, upright])
        i1, i2, i3 = self.moments = np.array([moments[i] for i in order])
        w1, w2, w3 = w = self.signs * np.array([rates[i] for i in order])
        p = i2 * (i2 - i1) * w2**2 + i3 * (i3 - i1) * w3**2
        q = i1 * (i3 - i1) * w1**2 + i2 * (i3 - i2) * w2**2
        self.amplitudes = np.array([math.sqrt(q / (i1 * (i3 - i1))), math.copysign(math.sqrt(q / (i2 * (i3 - i2))), i3 - i2), math.sqrt(p / (i3 * (i3 - i1)))])
        self.rate = math.sqrt(p * (i3 - i2) / (i1 * i2 * i3))
        self.m = q * (i2 - i1) / (p * (i3 - i2))
        self.complement = (i3 - i1) * excess / (p * (i3 - i2))
        self.nu = -i3 * (i2 - i1) / (i1 * (i3 - i2))
        self.momentum = math.sqrt(sum((self.moments * w) ** 2))
        self.factor = self.momentum * (i3 - i1) / (i1 * i3 * self.rate)
        self.quarter = ellipkm1(self.complement)
        start = math.atan2(w2 / self.amplitudes[1], w1 / self.amplitudes[0])
        self.phase = ellipkinc(start, self.m)
        self.turn = 2 * self.third_kind(1.0, 0.0)
        turns = round(start / math.pi)
        self.start = turns * self.turn + self.third_kind(math.sin(start - turns * math.pi), math.cos(start - turns * math.pi))
        self.renaming = renaming(self.order, self.signs)
        body = product(in_invariable_frame(self.moments * w / self.momentum, 0.0), self.renaming)
        self.frame = product(attitude, body * [-1, -1, -1, 1])

    def third_kind(self, sine, cosine):
        """Π(ν; φ | m) for |φ| ≤ π/2."""
        c2, d2 = cosine**2, self.complement + self.m * cosine**2
        return sine * elliprf(c2, d2, 1) + self.nu / 3 * sine**3 * elliprj(c2, d2, 1, 1 - self.nu * sine**2)

    def at(self, times):
        """Attitudes and rates, (n, 4) and (n, 3)."""
        u = self.phase + self.rate * times
        turns = np.round(u / (2 * self.quarter))
        sn, cn, dn, _ = ellipj(u - 2 * self.quarter * turns, self.m)
        third = turns * self.turn + self.third_kind(sn, np.abs(cn))
        flip = 1 - 2 * np.mod(turns, 2)
        w = self.amplitudes * np.stack([flip * cn, flip * sn, dn], axis=-1)
        angle = self.momentum / self.moments[2] * times + self.factor * (third - self.start)
        body = product(in_invariable_frame(self.moments * w / self.momentum, angle), self.renaming)
        rates = np.empty_like(w)
        rates[:, self.order] = self.signs * w
        return product(self.frame, body), rates


def in_invariable_frame(g, angle):
    """Quaternions from renamed axes to the invariable frame, of the unit momentum there; axis 3 at `angle`."""
    psi, tilt = np.arctan2(g[..., 0], g[..., 1]), (g[..., 0] ** 2 + g[..., 1] ** 2) / (2 * (1 + g[..., 2]))
    a, b = np.sqrt((1 + g[..., 2]) / 2), np.sqrt(tilt)
    plus, minus = (angle + psi) / 2, (angle - psi) / 2
    return np.stack([b * np.cos(minus), b * np.sin(minus), a * np.sin(plus), a * np.cos(plus)], axis=-1)


def renaming(order, signs):
    """The quaternion from body axes to renamed ones."""
    matrix = np.zeros((3, 3))
    matrix[range(3), order] = signs
    return Rotation.from_matrix(matrix).as_quat()


def product(p, q):
    """Hamilton products, scalars last."""
    a, b, c, d = np.moveaxis(p, -1, 0)
    e, f, g, h = np.moveaxis(q, -1, 0)
    rows = [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g]
    return np.stack(rows, axis=-1)
