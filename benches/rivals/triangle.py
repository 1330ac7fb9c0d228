"""Deprit's triangle for H and S of the free rigid body, over any algebra of polynomials in two variables.

Convention: all coefficients are rational in w = √L e^{iℓ} (theory §1, §2). By homogeneity and parity a part of order n is I^{n+1} φ with I = w w̄ and φ a polynomial in
a = β w/w̄ and b = β w̄/w of degree at most n (β² = ab). The factors τⁿ and I^{n+1} are not stored.
H is symmetric in a, b and S antisymmetric. With θ = a ∂/∂a − b ∂/∂b and s = {·; i ·},

    [I^r φ; I^s ψ] = 2 I^{r+s−1} (r φ θψ − s ψ θφ) = I^{r+s−1} (X + X with a, b exchanged),   X = (r φ − θφ) (s ψ + θψ),

so a bracket needs one product, and a cell one exchange. The triangle is that of theory §4 without its binomials, with g = f_{n,q}/n! and T_m = S_m/(m−1)!:

    g_{n,q} = (n+1) g_{n+1,q−1} + Σ_{0≤m≤n} [g_{n−m,q−1}; T_{m+1}]

Cost: N(N+1)(N+2)/6 products of dense polynomials of up to N²/2 terms.
"""

from math import factorial


def normalize(algebra, order):
    """P_0 … P_N and T_1 … T_N of theory §4 as polynomials of `algebra`, without the powers of τ and I."""
    cells = [[algebra.one]]  # cells[q][n] = g_{n,q}
    lefts = [[algebra.one]]  # r φ − θφ of each; θ1 = 0
    rights, generators = [], []  # s ψ + θψ of T_m, and T_m
    kernel = [algebra.scale(algebra.one, 2, 1)]
    for n in range(1, order + 1):
        extend(algebra, cells, lefts, rights, n)
        normal, solution = algebra.split(cells[n][0])
        image = cells[n][0] - normal
        generators.append(algebra.scale(solution, 1, factorial(n - 1)))
        kernel.append(algebra.scale(normal, 2, factorial(n)))
        if n < order:  # no other anti-diagonal depends on the last one
            rights.append(algebra.scale(generators[-1], n + 1, 1) + algebra.theta(generators[-1]))
            complete(algebra, cells, lefts, image, n)
    return kernel, generators


def extend(algebra, cells, lefts, rights, n):
    """Add the anti-diagonal n with T_n, which is still unknown, as 0."""
    cells[0].append(algebra.perturbation if n == 1 else algebra.zero)
    cells.append([])
    lefts.append([])
    for q in range(1, n + 1):
        row = n - q
        factors = [(lefts[q - 1][row - m], rights[m]) for m in range(min(row + 1, len(rights)))]
        factors = [(left, right) for left, right in factors if left != algebra.zero]
        carried = algebra.scale(cells[q - 1][row + 1], row + 1, 1)
        if factors:
            half = algebra.dot(factors)
            carried = half + algebra.exchange(half) + carried
        cells[q].append(carried)


def complete(algebra, cells, lefts, image, n):
    """Insert T_n: subtract image/r! from g_{r,n−r}, since [h_0; S_n] is −image. This needs no bracket."""
    for row in range(n + 1):
        q = n - row
        if q > 0:
            cells[q][row] = cells[q][row] - algebra.scale(image, 1, factorial(row))
        lefts[q].append(algebra.scale(cells[q][row], n + 1, 1) - algebra.theta(cells[q][row]))
