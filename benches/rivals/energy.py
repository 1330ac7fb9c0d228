"""The normal form by conservation of energy on python-flint, with the algorithm of `andoyer.NormalForm`.

The rivals with the triangle measure algorithm and arithmetic together. This rival has the same algorithm as andoyer, so its ratio measures the arithmetic
alone. Variables and T_m are as in triangle.py, with h = −(2 + a + b)/4, D = 2θ and dH/dε = Σ c_n ε^{n−1} H^{n+1} at fixed action:

    D T_m = Σ_{k≥1} c_{m−k} C(m−k+1, k) h^k + c_m − h [m = 1] + m (D h) T_{m−1} − 2 h D T_{m−1}

The mean of this equation gives c_m. Then n k_n = Σ_j c_j [ε^{n−j}] (K/J)^{j+1} and P_n = 2 k_n. The derivation is in crates/series/src/energy.rs.
"""

from math import comb


def normalize(algebra, order):
    """P_0 … P_N as polynomials in β² = ab, and T_1 … T_N as in the triangle; `algebra` is the algebra on FLINT."""
    h = algebra.perturbation
    slope_of_h = algebra.scale(algebra.theta(h), 2, 1)
    slopes, generators = [algebra.zero], []
    for m in range(1, order + 1):
        source = forcing(algebra, slopes, m)
        if m == 1:
            source -= h
        else:
            last = generators[-1]
            source += slope_of_h * algebra.scale(last, m, 1) - h * algebra.scale(algebra.theta(last), 4, 1)
        mean, solution = algebra.split(source)
        slopes.append(algebra.scale(mean, -1, 1))
        generators.append(algebra.scale(solution, -1, 1))  # `split` solves −2 θψ = source
    return kernel(algebra, [algebra.univariate(slope) for slope in slopes]), generators


def forcing(algebra, slopes, m):
    """Σ_{k≥1} c_{m−k} C(m−k+1, k) h^k by Horner's rule. The binomial ends the sum, and there is no c_0."""
    total = algebra.zero
    for k in range(min((m + 1) // 2, m - 1), 0, -1):
        total = (total + algebra.scale(slopes[m - k], comb(m - k + 1, k), 1)) * algebra.perturbation
    return total


def kernel(algebra, slopes):
    """2 k_0 … 2 k_N; powers[p][i] = [ε^i] (K/J)^{p+1}."""
    order = len(slopes) - 1
    zero = algebra.univariate(algebra.zero)
    powers = [[zero + 1] for _ in range(order + 1)]
    first = powers[0]
    for n in range(1, order + 1):
        first.append(sum((slopes[j] * powers[j][n - j] for j in range(1, n + 1)), zero) / n)
        for p in range(1, order - n + 1):
            powers[p].append(sum((first[i] * powers[p - 1][n - i] for i in range(n + 1)), zero))
    return [2 * k for k in first]
