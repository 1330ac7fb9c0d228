"""
The Moon's L1
=============

Near the collinear point L1 of Earth and Moon most motions escape along a saddle. The normal form separates the saddle from the centre manifold. The centre manifold contains the bounded
motions: planar and vertical Lyapunov orbits and the tori around them. This example computes a Poincaré section of it from a Hamiltonian of two degrees of freedom.
"""

import math
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import andoyer
from andoyer import plot

# %%
# The Hamiltonian about L1 is H = (X² + Y² + Z²)/2 + yX − xY − Σ c_n ρⁿ P_n(x/ρ) with Legendre polynomials P_n. The unit of length is the distance γ from L1 to the Moon.

MU = 0.012150585609624
ORDER = 8


def gamma(mu: float) -> float:
    """The distance from L1 to the smaller body, in units of the distance between the bodies."""
    return brentq(lambda g: ((((g - (3 - mu)) * g + (3 - 2 * mu)) * g - mu) * g + 2 * mu) * g - mu, 1e-3, 0.9, xtol=1e-16)


def potential(degree: int) -> dict[tuple[int, int], float]:
    """Σ c_n ρⁿ P_n(x/ρ), n = 2 … degree, by exponents of x and of s = y² + z²."""
    g = gamma(MU)
    result: dict[tuple[int, int], float] = {}
    for n in range(2, degree + 1):
        c = (MU + (-1) ** n * (1 - MU) * (g / (1 - g)) ** (n + 1)) / g**3
        for k in range(n // 2 + 1):
            # ρⁿ P_n(x/ρ) = Σ (−1)^k C(n, 2k) C(2k, k)/4^k x^(n−2k) s^k
            term = (-1) ** k * math.comb(n, 2 * k) * math.comb(2 * k, k) / 4**k
            result[n - 2 * k, k] = result.get((n - 2 * k, k), 0.0) + c * term
    return result


terms = {(0, 2, 0, 0, 0, 0): 0.5, (0, 0, 0, 2, 0, 0): 0.5, (0, 0, 0, 0, 0, 2): 0.5, (0, 1, 1, 0, 0, 0): 1.0, (1, 0, 0, 1, 0, 0): -1.0}
for (i, k), c in potential(ORDER + 2).items():
    for j in range(k + 1):
        key = (i, 0, 2 * j, 0, 2 * (k - j), 0)
        terms[key] = terms.get(key, 0.0) - c * math.comb(k, j)
form = andoyer.normalize(terms, ORDER, [("x", "X"), ("y", "Y"), ("z", "Z")], keep="hyperbolic")
print(form.kinds, [complex(frequency) for frequency in form.frequencies])

# %%
# The Hamiltonian on the manifold has two pairs of variables, (y, Y) horizontal and (z, Z) vertical. In the section z = 0, Z > 0 at one energy, the closed curves are tori around
# the vertical Lyapunov orbit.

reduced = form.centre_manifold()
exponents, coefficients = np.array([key[2:] for key in reduced]), np.array(list(reduced.values()))


def energy(state: Any) -> float:
    """K on the manifold at (y, Y, z, Z)."""
    return float(coefficients @ np.prod(np.asarray(state) ** exponents, axis=1))


def slope(slot: int) -> tuple[Any, Any]:
    """Exponents and coefficients of the derivative of K with respect to one variable."""
    lowered = exponents - np.eye(4, dtype=int)[slot]
    return np.maximum(lowered, 0), coefficients * exponents[:, slot]


slopes = [slope(slot) for slot in range(4)]


def rates(_: float, state: Any) -> list[float]:
    """Hamilton's equations of K."""
    y, Y, z, Z = (float(c @ np.prod(state**powers, axis=1)) for powers, c in slopes)
    return [Y, -y, Z, -z]


def section(y: float, momentum: float, level: float, crossings: int) -> Any:
    """Points (y, Y) where the orbit through a point of the section, at an energy, crosses z = 0 upwards."""
    if energy([y, momentum, 0.0, 0.0]) >= level:
        return np.empty((0, 2))
    vertical = brentq(lambda Z: energy([y, momentum, 0.0, Z]) - level, 0.0, 3.0)

    def upwards(_: float, state: Any) -> float:
        return float(state[2])

    crossed: Any = upwards
    crossed.direction = 1.0
    period = 2 * math.pi / abs(complex(form.frequencies[2]))
    found: Any = solve_ivp(rates, (1e-9, crossings * period), [y, momentum, 0.0, vertical], method="DOP853", rtol=1e-7, atol=1e-9, events=crossed)
    return found.y_events[0][:, :2]


figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
for y in np.linspace(-0.5, 0.5, 7):
    points = section(y, 0.0, 0.35, 25)
    left.plot(points[:, 0], points[:, 1], ".", markersize=3)
left.set(xlabel="y", ylabel="Y", title="Centre manifold of L1: z = 0 at energy 0.35", aspect="equal")

# %%
# The sizes of the orders at three amplitudes show the range of validity of the form.

plot.domain(form, amplitudes=(0.1, 0.2, 0.4), axes=right)
plt.show()
