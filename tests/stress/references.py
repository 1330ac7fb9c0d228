"""Test of the reference: compare the enclosures with two other computations, which share only the equations of motion with them.

- `torque_free.py`: mpmath, amplitude by Landen's transformation, Legendre's integrals.
- Taylor series of Euler's equations and of q′ = q ω/2 about the epoch, in integers of 400 fractional bits, without elliptic functions.
"""

import sys
from fractions import Fraction
from pathlib import Path

from regimes import case

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))

import enclosures
import torque_free

AGREEMENT = 1e-38  # of numbers of order one, 40 digits each
TERMS, BITS, STEP = 60, 400, Fraction(1, 8)


def taylor(moments, attitude, rates, time):
    """Attitude and rates at `time` by Taylor series in integers of 400 fractional bits, for |ω| t up to about 1/8."""
    i = [Fraction(x) for x in moments]
    w = [[_cut(Fraction(x))] for x in rates]
    norm = _root(sum(Fraction(x) ** 2 for x in attitude))
    q = [[_cut(Fraction(x) / norm)] for x in attitude]
    factor = [(i[1] - i[2]) / i[0], (i[2] - i[0]) / i[1], (i[0] - i[1]) / i[2]]
    for n in range(TERMS):
        pairs = ((1, 2), (2, 0), (0, 1))
        for axis, (a, b) in enumerate(pairs):
            w[axis].append(_cut(factor[axis] * sum(w[a][k] * w[b][n - k] for k in range(n + 1)) / (n + 1)))
        rows = [[q[a][k] for a in range(4)] for k in range(n + 1)]
        sums = [sum(term) for term in zip(*(enclosures.product(rows[k], [w[a][n - k] for a in range(3)] + [0]) for k in range(n + 1)))]
        for a in range(4):
            q[a].append(_cut(sums[a] / (2 * (n + 1))))
    t = Fraction(time)
    return [sum(c * t**n for n, c in enumerate(row)) for row in q], [sum(c * t**n for n, c in enumerate(row)) for row in w]


def _cut(x):
    return Fraction(round(x * 2**BITS), 2**BITS)


def _root(x):
    from math import isqrt

    return Fraction(isqrt(int(x * 4**BITS)), 2**BITS)


def _apart(rows, others, context):
    """The largest difference between the numbers of two states, for either sign of the quaternion."""
    (p, w), (q, v) = rows, others
    p, w = ([context.mpf(x.mid().str(70, radius=False)) for x in row] for row in (p, w))
    q, v = ([context.mpf(x.numerator) / x.denominator if isinstance(x, Fraction) else x for x in row] for row in (q, v))
    sign = 1 if sum(x * y for x, y in zip(p, q)) > 0 else -1
    size = max(abs(x) for x in v) or 1
    return float(max(max(abs(x - sign * y) for x, y in zip(p, q)), max(abs(x - y) for x, y in zip(w, v)) / size))


def compared(seed, numbers):
    """The largest differences from `torque_free.py` and from the Taylor series over these cases, and the number of cases."""
    worst, count = [0.0, 0.0], 0
    for number in numbers:
        one = case(seed, number)
        try:
            motion = torque_free.TorqueFree(one.moments, one.attitude, one.rates, epoch=one.epoch, digits=60)
        except ValueError:
            continue
        rows = enclosures.solve(one.moments, one.attitude, one.rates, one.times, one.epoch)
        for t, q, w in zip(one.times[:2], *rows):
            worst[0] = max(worst[0], _apart((q, w), motion.state(t), motion.context))
        if max(one.moments) < 1e3 * min(one.moments):
            size = max(abs(x) for x in one.rates)
            rates = [x / size for x in one.rates]
            time = float(STEP)
            state = [row[0] for row in enclosures.solve(one.moments, one.attitude, rates, [time])]
            worst[1] = max(worst[1], _apart(state, taylor(one.moments, one.attitude, rates, time), motion.context))
            count += 1
    return worst, count
