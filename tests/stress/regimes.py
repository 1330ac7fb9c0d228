"""Random scenes in the regimes in which the numerics are weakest. A seed and a number determine each scene.

A regime makes body, state, epoch and times; all are doubles, which the reference takes as exact. The direction of the angular
momentum follows from its excess of energy as a part of that of the separatrix (theory §5). Rounding to doubles changes the direction by about 1e-16 before the reference is computed.
"""

from dataclasses import dataclass, field

import numpy as np

# Smallest tilt from the middle axis. The code treats a tilt below 1e-150 as 0, with an error bound of π. From other axes tilts may be denormal.
SMALLEST_TILT = 1e-145


@dataclass(frozen=True)
class Case:
    """A random scene and its times."""

    regime: str
    moments: tuple
    attitude: tuple
    rates: tuple
    epoch: float
    times: tuple
    complement: float  # requested 1 − m of the elliptic functions, or 0
    tags: dict = field(default_factory=dict)


def decades(random, least, most):
    """10^x, x uniform."""
    return 10.0 ** random.uniform(least, most)


def body(random):
    """Moments A ≤ B ≤ C of any shape, C = 1."""
    least = random.uniform(0.05, 0.95)
    return [least, max(least, 1 - least) + (1 - max(least, 1 - least)) * random.uniform(0.02, 0.98), 1.0]


def turned(random, moments, part, long_axis):
    """A direction of the angular momentum whose excess of energy is this part of that of the separatrix; A ≤ B ≤ C."""
    _a, b, _c = moments
    circled, other = (0, 2) if long_axis else (2, 0)
    # Differences of 1/I without cancellation; they vanish for equal moments.
    most = abs(moments[circled] - moments[other]) / (moments[other] * moments[circled])
    least = abs(moments[circled] - b) / (b * moments[circled])
    angle = random.uniform(0, 2 * np.pi)
    tilt2 = part * least / (most * np.sin(angle) ** 2 + least * np.cos(angle) ** 2) if least > 0 else part * random.uniform(0, 1)
    direction = np.zeros(3)
    direction[other], direction[1] = np.sqrt(tilt2) * np.sin(angle), np.sqrt(tilt2) * np.cos(angle)
    direction[circled] = np.sqrt(max(0.0, 1 - tilt2)) * random.choice([-1, 1])
    return direction


def finished(random, regime, moments, direction, *, scale=None, epoch=0.0, attitude=None, rotations=None, complement=0.0):
    """The case: axes in random order, rates of random size unless given, four times up to some thousand rotations."""
    moments = np.asarray(moments, dtype=float)
    unit, speed = scale or (1.0, decades(random, -3, 3))
    order = random.permutation(3)
    rates = np.asarray(direction) / moments * speed * moments[2]
    attitude = random.normal(size=4) if attitude is None else attitude
    rotation = 2 * np.pi / np.max(np.abs(rates))
    spread = rotations if rotations is not None else [0.0, random.uniform(-2, 2), random.uniform(-50, 50), random.choice([-1, 1]) * decades(random, 2, 4)]
    times = [epoch + rotation * x for x in spread]
    # The triangle inequality must also hold for the rounded moments.
    grown = _possible(moments * unit)
    return Case(
        regime, tuple(grown[order]), tuple(attitude / np.linalg.norm(attitude)), tuple(rates[order]), float(epoch), tuple(map(float, times)), complement
    )


def _possible(moments):
    a, b, c = moments
    while c > a + b:
        c = np.nextafter(c, 0)
    return np.array([a, b, c])


def small_wobble(r):
    moments = body(r)
    tilt, angle = decades(r, -15, -2), r.uniform(0, 2 * np.pi)
    return moments, [tilt * np.sin(angle), tilt * np.cos(angle), r.choice([-1, 1]) * np.sqrt(1 - tilt * tilt)], {}


def any_motion(long_axis):
    def make(r):
        moments, part = body(r), r.uniform(0, 0.95)
        return moments, turned(r, moments, part, long_axis), {}

    return make


def next_to_separatrix(long_axis):
    def make(r):
        moments, complement = body(r), decades(r, -14, -1)
        return moments, turned(r, moments, 1 - complement, long_axis), {"complement": complement}

    return make


def beta_to_zero(r):
    b = r.uniform(0.55, 0.95)
    moments = [b - decades(r, -15, -3), b, 1.0]
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {}


def beta_to_one(r):
    moments = [r.uniform(0.05, 0.95), 1 - decades(r, -12, -3), 1.0]
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {}


def needle(r):
    a = decades(r, -9, -1)
    moments = [a, 1 - a * r.uniform(0, 1) ** 2, 1.0]
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {}


def disc(r):
    b = r.uniform(0.5, 0.98)
    moments = [1 - b * (1 - (0.0 if r.uniform() < 0.5 else decades(r, -16, -3))), b, 1.0]
    moments[:2] = sorted(moments[:2])
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {}


def nearly_spherical(r):
    moments = sorted(1 - decades(r, -15, -2) * r.uniform(0, 1, 3))
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {}


def scaled(r):
    moments, scale = body(r), (decades(r, -30, 60), decades(r, -12, 6))
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {"scale": scale}


def long_epochs(r):
    moments = body(r)
    far = r.choice([-1, 1], 4) * 10.0 ** np.append(r.uniform(4, 9, 3), 9.0)
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {"rotations": far, "epoch": r.choice([0.0, 1e3, -2.5e5]) * r.uniform()}


def nearly_unit(r):
    moments = body(r)
    return moments, turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5), {"norm": 1 + r.choice([-1, 1]) * decades(r, -16, -6.05)}


def beside_an_axis(r):
    moments, axis = body(r), r.integers(3)
    smallest = np.log10(SMALLEST_TILT) if axis == 1 else -300
    sizes = [decades(r, smallest, -1), decades(r, smallest, -1)] if r.uniform() < 0.5 else [decades(r, -20, -1), decades(r, -20, -1)]
    direction = np.insert(np.array(sizes) * r.choice([-1, 1], 2), axis, r.choice([-1, 1]))
    return moments, direction, {}


def denormals(r):
    moments = body(r)
    direction = turned(r, moments, r.uniform(0, 0.95), r.uniform() < 0.5)
    tiny = [0.0, -0.0, 5e-324, -5e-324, 1e-310, -2e-308, 1e-200]
    for axis in r.choice(3, r.integers(1, 3), replace=False):
        direction[axis] = r.choice(tiny)
    if (np.abs(direction) < 1e-100).all():
        direction[2] = 1.0
    if (np.abs(direction[[0, 2]]) < SMALLEST_TILT).all():
        direction[[1, 2]] = direction[[2, 1]]
    return moments, direction, {"scale": (1.0, 1.0), "rotations": [-0.0, 5e-324, r.uniform(-5, 5), r.uniform(-1e3, 1e3)]}


def axisymmetric(r):
    if r.uniform() < 0.5:
        b = r.uniform(0.51, 1.0)
        moments = [b, b, 1.0]
    else:
        moments = [r.uniform(0.01, 1.0), 1.0, 1.0]
    direction = r.normal(size=3)
    return moments, direction / np.linalg.norm(direction), {}


REGIMES = {
    "J from 1e-15 to 0.01": small_wobble,
    "short-axis, any J": any_motion(False),
    "long-axis": any_motion(True),
    "1−m from 1e-14 to 0.1, short-axis": next_to_separatrix(False),
    "1−m from 1e-14 to 0.1, long-axis": next_to_separatrix(True),
    "β → 0: B−A from 1e-15 C": beta_to_zero,
    "β → 1: C−B from 1e-12 C": beta_to_one,
    "needles: A from 1e-9 C": needle,
    "discs: C = A+B and near": disc,
    "nearly spherical: from 1e-15": nearly_spherical,
    "axisymmetric": axisymmetric,
    "moments 1e-30 to 1e60, rates 1e-12 to 1e6": scaled,
    "epochs −1e9 to 1e9 rotations": long_epochs,
    "nearly unit quaternions": nearly_unit,
    "beside an axis: 1−m from 1e-290": beside_an_axis,
    "denormals and signed zeros": denormals,
}


def case(seed, number):
    """The case of this number, which is the same in every process. The regimes alternate."""
    random = np.random.default_rng([seed, number])
    regime = list(REGIMES)[number % len(REGIMES)]
    moments, direction, told = REGIMES[regime](random)
    norm = told.pop("norm", None)
    made = finished(random, regime, moments, direction, **told)
    if norm is not None:
        made = Case(**{**made.__dict__, "attitude": tuple(np.array(made.attitude) * norm)})
    return made
