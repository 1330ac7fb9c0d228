"""Compare normal forms with a driven phase with heyoka's integration: run time against error, by order and by tolerance.

    python benches/rivals/driven.py [--periods 1000] [--output FILE.csv]

Three systems: a driven Duffing oscillator, a quartic oscillator in a lattice (Mathieu's equation with a cubic force), L4 of the elliptic restricted problem of the Earth and the Moon. A motion is given at
200 times over so many periods of the drive. The reference is heyoka in extended precision (80 bits, tolerance 1e-19). Times are CPU seconds, the least of three rounds. heyoka's time excludes its
compilation; "form" is the time of the normal form, "motion" that of the state's transformation and the 200 samples by a form that exists.
"""

import argparse
import functools
import math
import os
import sys
from pathlib import Path

os.environ["RAYON_NUM_THREADS"] = "1"

import heyoka as hy
import numpy as np
from libration import seconds
from written import write

from andoyer import Driven, normalize

SAMPLES = 200
ORDERS = (2, 4, 6, 8, 10)
TOLERANCES = (1e-6, 1e-9, 1e-12, 1e-15)
HALF_ROOT = math.sqrt(3) / 2
MOON, ECCENTRICITY = 0.0121505856, 0.0549
"""Mass fraction and eccentricity of the Moon."""


def duffing():
    """x″ + x + x³ = 0.3 cos 0.4t."""
    x, v = hy.make_vars("x", "v")
    field = [(x, v), (v, 0.3 * hy.cos(0.4 * hy.time) - x - x**3)]
    return 0.4, lambda order: normalize("(p^2 + x^2)/2 + x^4/4 - 0.3*x*cos(M)", order, [("x", "p")], driven={"M": 0.4}), field, [0.4, 0.0]


def lattice():
    """x″ + (2.5 − cos 2t) x + x³ = 0."""
    x, v = hy.make_vars("x", "v")
    field = [(x, v), (v, (hy.cos(2.0 * hy.time) - 2.5) * x - x**3)]
    return 2.0, lambda order: normalize("(p^2 + 2.5*x^2)/2 - x^2*cos(M)/2 + x^4/4", order, [("x", "p")], driven={"M": 2.0}), field, [0.1, 0.0]


def triangle():
    """L4 in pulsating coordinates, with the true anomaly as the time."""
    x, p, y, q = hy.make_vars("x", "X", "y", "Y")
    a, b = 0.5 - MOON + x, HALF_ROOT + y
    near = MOON * ((a - 1 + MOON) ** 2 + b**2) ** -1.5
    far = (1 - MOON) * ((a + MOON) ** 2 + b**2) ** -1.5
    weight = 1.0 / (1.0 + ECCENTRICITY * hy.cos(hy.time))
    pull = a - far * (a + MOON) - near * (a - 1 + MOON), b - (far + near) * b
    field = [(x, p + y), (p, q - x + weight * pull[0]), (y, q - x), (q, -p - y + weight * pull[1])]
    return 1.0, triangle_form, field, [1e-3, 0.0, -5e-4, 1e-3]


def triangle_form(order):
    """The normal form about L4: the attractions as Legendre's polynomials."""
    terms = {(2, 0, 0, 0): 0.5, (0, 0, 2, 0): 0.5}
    for mass, along in ((1 - MOON, -0.5), (MOON, 0.5)):
        for degree in range(2, order + 3):
            for k, coefficient in enumerate(np.polynomial.legendre.leg2poly([0] * degree + [1])):
                # P_n(c) r^n with r c = u, r² = x² + y².
                if (degree - k) % 2 == 0:
                    add_power(terms, mass * coefficient, (along, -HALF_ROOT), k, (degree - k) // 2)
    return normalize("((X + y)^2 + (Y - x)^2)/2", order, [("x", "X"), ("y", "Y")], driven=Driven(1.0, lambda f: wave(terms, f)))


def add_power(terms, factor, direction, power, squares):
    """terms += factor (a x + b y)^power (x² + y²)^squares."""
    a, b = direction
    for i in range(power + 1):
        for j in range(squares + 1):
            powers = (i + 2 * j, 0, power - i + 2 * (squares - j), 0)
            terms[powers] = terms.get(powers, 0.0) + factor * math.comb(power, i) * a**i * b ** (power - i) * math.comb(squares, j)


def wave(terms, anomaly):
    """The coefficients at a true anomaly."""
    weight = -1 / (1 + ECCENTRICITY * math.cos(anomaly))
    return {powers: weight * coefficient for powers, coefficient in terms.items()}


CASES = {"Duffing": duffing, "lattice": lattice, "L4": triangle}


def integrated(field, start, times, tolerance, kind=float):
    """The work of an integration by heyoka, compiled."""
    start, times = np.array(start, kind), np.array(times, kind)
    integrator = hy.taylor_adaptive(field, start, tol=kind(tolerance), fp_type=kind)

    def work():
        integrator.time = kind(0)
        integrator.state[:] = start
        return integrator.propagate_grid(times)[-1].astype(float)

    return work


def measured(name, periods):
    """The rows of a case."""
    rate, form_of, field, start = CASES[name]()
    times = np.linspace(0, 2 * math.pi / rate * periods, SAMPLES)
    exact = integrated(field, start, times, 1e-19, np.longdouble)()

    def row(engine, setting, found, *costs):
        error = float(np.abs(found - exact).max())
        print(f"{name:8s} {engine:8s} {setting:6s} error {error:.1e}  " + "  ".join(f"{1e3 * cost:9.3f} ms" for cost in costs), flush=True)
        return [name, engine, setting, f"{error:.2e}", *(f"{cost:.5g}" for cost in costs), *[None] * (2 - len(costs))]

    for order in ORDERS:
        whole, form = seconds(functools.partial(form_of, order))
        least, found = seconds(functools.partial(form.trajectory, start, times))
        yield row("form", str(order), found, least, whole)
    for tolerance in TOLERANCES:
        least, found = seconds(integrated(field, start, times, tolerance))
        yield row("heyoka", f"{tolerance:.0e}", found, least)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--periods", type=float, default=1000)
    options.add_argument("--output", type=Path)
    asked = options.parse_args()
    rows = [row for name in CASES for row in measured(name, asked.periods)]
    write(asked.output, ["case", "engine", "setting", "error", "motion", "form"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
