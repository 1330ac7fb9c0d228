"""Checks of the answer of a run, before its time counts: P_n of theory §4, and every P_n and S_m of the rival equal to those of andoyer."""

from fractions import Fraction
from math import factorial

# Theory §4: P_n = factor · Σ c β^power.
PUBLISHED = {
    0: (Fraction(2), {0: 1}),
    1: (Fraction(-1), {0: 1}),
    2: (Fraction(-1, 2), {2: 1}),
    3: (Fraction(-5, 8), {2: 1}),
    4: (Fraction(-3, 32), {4: 3, 2: 8}),
    5: (Fraction(-7, 32), {4: 5, 2: 4}),
    6: (Fraction(-1, 128), {6: 45, 4: 354, 2: 128}),
    7: (Fraction(-9, 1024), {6: 265, 4: 650, 2: 128}),
    8: (Fraction(-5, 8192), {8: 953, 6: 14888, 4: 17120, 2: 2048}),
    9: (Fraction(-11, 8192), {8: 4075, 6: 20212, 4: 13104, 2: 1024}),
}


class WrongAnswer(Exception):
    """The answer of an engine is wrong, and its time does not count."""


def check_kernel(engine, polynomials):
    """Compare P_0 … P_N, as {power of β: Fraction}, with theory §4."""
    for n, polynomial in enumerate(polynomials):
        if n in PUBLISHED:
            factor, terms = PUBLISHED[n]
            expected = {power: factor * c for power, c in terms.items()}
            if polynomial != expected:
                raise WrongAnswer(f"{engine}: P_{n} = {polynomial}, but theory §4 has {expected}")


def kernel(algebra, polynomials):
    """{power of β: Fraction} of each polynomial in a, b."""
    return [{p + q: c for (p, q), c in algebra.terms(f).items()} for f in polynomials]


def check_all(rival, algebra, answer, normal_form):
    """Compare every P_n, and every S_m as Σ c u^j U^k β^l, with `normal_form`."""
    polynomials, generators = answer
    for n, polynomial in enumerate(kernel(algebra, polynomials)):
        if polynomial != normal_form.triaxiality_polynomial(n):
            raise WrongAnswer(f"{rival}: P_{n} is not andoyer's")
    for m, generator in enumerate(generators, 1):
        if public_generator(algebra, generator, m) != normal_form.generator(m):
            raise WrongAnswer(f"{rival}: S_{m} is not andoyer's")


def public_generator(algebra, generator, m):
    """S_m = i (m−1)! T_m in u, U: w^k w̄^j = (−i)^j u^j U^k with k − j = 2 (p − q), j + k = 2 (m + 1)."""
    face = {}
    for (p, q), c in algebra.terms(generator).items():
        j, k = m + 1 - (p - q), m + 1 + (p - q)
        c *= factorial(m - 1)
        face[j, k, p + q] = [(c, Fraction()), (Fraction(), c), (-c, Fraction()), (Fraction(), -c)][(1 + 3 * j) % 4]
    return face
