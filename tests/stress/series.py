"""Tests of the series: errors by tolerance, differences from the closed form, errors of the orders 0 to 60, and the canonicity of the transformation.

The error of order N is about (σ/σ_sep)^(N+1) (theory §5). `by_order` divides the error of each order over one rotation by 8 (σ/σ_sep)^(N+1) plus rounding. A value above 1 means that the error does not
fall with the order, or grows again after it has reached rounding error.
"""

import warnings
from collections import defaultdict

import numpy as np
from accuracy import angle, truth
from regimes import Case, body, decades, turned

import andoyer

warnings.simplefilter("ignore", andoyer.ToleranceWarning)  # the errors of low orders are measured here

ORDERS = 61
BUDGETS = {"error / tolerance": 1.0, "error / bound": 1.0, "series − closed / bounds": 1.0, "error by order": 1.0, "brackets": 0.0}
ROUNDING = 2e-14  # rounding error of order 60 with its 60 harmonics; lower orders have less
FACTOR = 8.0


def scene(random, part, rotations):
    """A short-axis scene and its reference times."""
    moments = np.array(body(random))
    direction = turned(random, moments, part, False)
    rates = direction / moments
    attitude = random.normal(size=4)
    times = tuple(float(x) for x in 2 * np.pi / abs(rates[2]) * rotations * random.uniform(-1, 1, 4))
    return Case("series", tuple(moments), tuple(attitude / np.linalg.norm(attitude)), tuple(rates), 0.0, times, 0.0)


def by_tolerance(seed, number):
    """(regime, {check: value}, number) of the series, and of the closed form, for a random scene that the series serve."""
    random = np.random.default_rng([seed, number, 1])
    small = number % 2 == 0
    part = decades(random, -28, -2) if small else random.uniform(0, 0.55)
    one = scene(random, part, 100.0)
    asked = float(decades(random, -13, -3))
    given = andoyer.Body(one.moments)
    span = (min(one.times), max(one.times))
    motion = andoyer.Scene(given, one.attitude, one.rates, tolerance=asked, method="series", span=span).solve()
    closed = andoyer.Scene(given, one.attitude, one.rates, tolerance=asked, method="closed", span=span).solve()
    (attitude, low), _ = truth(one)
    samples = motion.attitude(one.times)
    error = float(angle(samples, attitude, low).max())
    apart = float(angle(samples, closed.attitude(one.times)).max())
    found = {
        "error / tolerance": error / asked,
        "error / bound": error / motion.plan.error_bound,
        "series − closed / bounds": apart / (motion.plan.error_bound + closed.plan.error_bound),
    }
    return "series, J from 1e-14" if small else "series, σ/σ_sep to 0.6", found, number


def by_order(seed, number):
    """The largest ratio of the error of an order to the error expected by the theory."""
    random = np.random.default_rng([seed, number, 2])
    one = scene(random, random.uniform(0.01, 0.97), 1.0)
    given = andoyer.Body(one.moments)
    (attitude, low), _ = truth(one)
    worst = 0.0
    for order in range(ORDERS):
        motion = andoyer.Scene(given, one.attitude, one.rates, tolerance=1e-15, method="series", order=order, span=(min(one.times), max(one.times))).solve()
        error = float(angle(motion.attitude(one.times), attitude, low).max())
        worst = max(worst, error / (FACTOR * motion.plan.separatrix_ratio ** (order + 1) + ROUNDING))
    return "orders 0 to 60, σ/σ_sep to 0.99", {"error by order": worst}, number


def brackets(order):
    """The largest coefficient of {u; U} − 1, {y; u} and {y; U} up to this order, in exact arithmetic (theory §1, §6). All should vanish.

    With u = Σ τⁿ u_n, τ ∝ 1/M, and y = y′ + (1/M) Σ τⁿ y_n, {y; u} = (1/M) Σ τⁿ [Σ {y_a; u_b} − n u_n], a + b = n.
    """
    form = andoyer.NormalForm(order)
    series = {name: [form.direct(name, n) for n in range(1, order + 1)] for name in ("u", "U", "y")}
    one = (1, 0)
    series["u"].insert(0, {(1, 0, 0): one})
    series["U"].insert(0, {(0, 1, 0): one})
    series["y"].insert(0, {})
    worst = 0
    for first, second in (("u", "U"), ("y", "u"), ("y", "U")):
        for n in range(order + 1):
            left = defaultdict(lambda: (0, 0))
            for a in range(n + 1):
                bracket(left, series[first][a], series[second][n - a])
            expected = {key: (n * re, n * im) for key, (re, im) in series[second][n].items()} if first == "y" else {(0, 0, 0): one} if n == 0 else {}
            for key in left.keys() | expected.keys():
                (re, im), (real, imaginary) = left[key], expected.get(key, (0, 0))
                worst = max(worst, abs(re - real), abs(im - imaginary))
    return worst


def bracket(into, f, g):
    """Add ∂f/∂u ∂g/∂U − ∂f/∂U ∂g/∂u."""
    for (j, k, beta), (a, b) in f.items():
        for (m, n, more), (c, d) in g.items():
            factor = j * n - k * m
            if factor:
                key = (j + m - 1, k + n - 1, beta + more)
                re, im = into[key]
                into[key] = (re + factor * (a * c - b * d), im + factor * (a * d + b * c))
