"""The algebras of the rivals with the operations of the triangle, each written as its manual recommends.

An algebra has `one`, `zero`, `perturbation` = −(2 + a + b)/4, polynomials with + − !=, and the methods of `Flint` below. A module
is imported when its algebra is made, so that unused rivals take no time.
"""

from fractions import Fraction


class Flint:
    """`fmpq_mpoly` of python-flint: packed exponents, one common denominator, dense products by Kronecker substitution."""

    def __init__(self):
        from flint import Ordering, fmpq, fmpq_mpoly_ctx, fmpq_poly

        self.rational, self.dense = fmpq, fmpq_poly
        # lex, deglex and degrevlex differ by less than 10 %.
        self.context = fmpq_mpoly_ctx.get(("a", "b"), Ordering.lex)
        self.a, self.b = self.context.gens()
        self.zero, self.one = self.context.constant(0), self.context.constant(1)
        self.perturbation = (2 + self.a + self.b) * fmpq(-1, 4)

    def scale(self, f, numerator, denominator):
        """f numerator/denominator."""
        return f * self.rational(numerator, denominator)

    def theta(self, f):
        """θf = a ∂f/∂a − b ∂f/∂b."""
        return self.a * f.derivative(0) - self.b * f.derivative(1)

    def exchange(self, f):
        """f with a and b exchanged. A conversion by dictionary would take ten times as long."""
        return f.compose(self.b, self.a)

    def dot(self, factors):
        """Σ left · right."""
        total = self.zero
        for left, right in factors:
            total += left * right
        return total

    def split(self, f):
        """The part of f in the kernel of θ, and the solution ψ of −2 θψ = the other part."""
        terms = f.to_dict()
        kernel = {(p, q): c for (p, q), c in terms.items() if p == q}
        solution = {(p, q): c / (2 * (q - p)) for (p, q), c in terms.items() if p != q}
        return self.context.from_dict(kernel), self.context.from_dict(solution)

    def univariate(self, f):
        """A polynomial of the kernel as a dense polynomial in β² = ab."""
        terms = f.to_dict()
        length = 1 + max((p for p, _ in terms), default=0)
        return self.dense([terms.get((p, p), 0) for p in range(length)])

    def terms(self, f):
        """{(power of a, power of b): Fraction}."""
        if isinstance(f, self.dense):
            terms = {(p, p): c for p, c in enumerate(f.coeffs()) if c != 0}
        else:
            terms = f.to_dict()
        return {powers: Fraction(int(c.p), int(c.q)) for powers, c in terms.items()}

    def forget(self):
        """Empty the caches of a run, so that the next run computes everything again. FLINT has no cache."""


class SympyRing:
    """SymPy's sparse polynomials, `sympy.polys.rings`, over QQ with python-flint's rationals."""

    def __init__(self):
        from sympy import QQ
        from sympy.polys.orderings import lex
        from sympy.polys.rings import ring

        self.field = QQ
        self.ring, self.a, self.b = ring("a, b", QQ, lex)
        self.zero, self.one = self.ring.zero, self.ring.one
        self.perturbation = (2 + self.a + self.b) * QQ(-1, 4)

    def scale(self, f, numerator, denominator):
        return f.mul_ground(self.field(numerator, denominator))

    def theta(self, f):
        return f.new({(p, q): c * (p - q) for (p, q), c in f.items() if p != q})

    def exchange(self, f):
        return f.new({(q, p): c for (p, q), c in f.items()})

    def dot(self, factors):
        total = self.zero
        for left, right in factors:
            total += left * right
        return total

    def split(self, f):
        kernel = f.new({(p, q): c for (p, q), c in f.items() if p == q})
        return kernel, f.new({(p, q): c / (2 * (q - p)) for (p, q), c in f.items() if p != q})

    def terms(self, f):
        return {powers: Fraction(int(c.numerator), int(c.denominator)) for powers, c in f.items()}

    def forget(self):
        """The ring has no cache."""


class Expressions:
    """Expanded expressions of SymPy, or of SymEngine, which has the same Python interface."""

    def __init__(self, module, forget):
        self.module, self.forget = module, forget
        self.a, self.b = module.symbols("a b")
        self.zero, self.one = module.Integer(0), module.Integer(1)
        self.perturbation = self.scale(2 + self.a + self.b, -1, 4)

    def scale(self, f, numerator, denominator):
        return self.module.expand(f * self.module.Rational(numerator, denominator))

    def theta(self, f):
        return self.module.expand(self.a * f.diff(self.a) - self.b * f.diff(self.b))

    def exchange(self, f):
        return f.xreplace({self.a: self.b, self.b: self.a})

    def dot(self, factors):
        # One sum, expanded once; an expansion of each product takes longer.
        return self.module.expand(self.module.Add(*(left * right for left, right in factors)))

    def powers(self, f):
        """((power of a, power of b), monomial, coefficient) for each term."""
        # For SymEngine a single number is a monomial.
        for monomial, c in ({1: f} if f.is_Number else f.as_coefficients_dict()).items():
            powers = self.module.sympify(monomial).as_powers_dict()
            yield (int(powers.get(self.a, 0)), int(powers.get(self.b, 0))), monomial, c

    def split(self, f):
        kernel, solution = [], []
        for (p, q), monomial, c in self.powers(f):
            if p == q:
                kernel.append(c * monomial)
            else:
                solution.append(c * monomial / (2 * (q - p)))
        return self.module.Add(*kernel), self.module.Add(*solution)

    def terms(self, f):
        return {powers: Fraction(str(c)) for powers, _, c in self.powers(f) if c != 0}


def sympy_expressions():
    """SymPy's expressions. The cache of SymPy is emptied before each run, because a warm cache shortens the time to a fraction."""
    import sympy
    from sympy.core.cache import clear_cache

    return Expressions(sympy, clear_cache)


def symengine_expressions():
    """SymEngine's expressions. SymEngine has no cache."""
    import symengine

    return Expressions(symengine, lambda: None)
