"""Conversion of normal forms to SymPy expressions, for the methods `to_sympy`. Only `_sympy` imports SymPy.

All coefficients of `NormalForm` are exact, `Rational` and `I`. Its symbols have no assumptions, so ``sympy.Symbol("beta")`` is equal to the symbol in the
expression. `BirkhoffNormalForm` uses the symbols of the caller if they were given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from andoyer._core import TheoryError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from fractions import Fraction

    from andoyer import BirkhoffNormalForm, NormalForm


def expressions(normal_form: NormalForm, what: str) -> Any:
    """A part of a normal form; `what` is as in `NormalForm.to_latex`."""
    sympy = _sympy()
    if what == "hamiltonian":
        return _hamiltonian(sympy, normal_form)
    if what == "generator":
        return [_tau(sympy) ** m * _form(sympy, normal_form.generator(m)) for m in range(1, normal_form.order + 1)]
    series = normal_form.direct if what == "direct" else normal_form.inverse
    return {name: _transformation(sympy, series, name, normal_form.order) for name in ("u", "U", "y")}


def birkhoff(normal_form: BirkhoffNormalForm, what: str, symbols: Mapping[str, Any]) -> Any:
    """A part of a Birkhoff normal form; `what` is as in `expressions`, and `symbols` are those of the caller by name."""
    sympy = _sympy()
    variables = [name for pair in normal_form.variables for name in pair]
    names, phases = [*variables, *normal_form.parameters], list(normal_form.driven)
    if what == "hamiltonian":
        try:
            return _polynomial(sympy, normal_form.in_actions(), [f"I_{q}" for q, _ in normal_form.variables] + names[len(variables) :], symbols)
        except TheoryError:
            return _polynomial(sympy, normal_form.in_real(), names, symbols, phases)
    if what == "generator":
        return [_polynomial(sympy, normal_form.generator(m), names, symbols, phases) for m in range(1, normal_form.order + 1)]
    series = normal_form.direct if what == "direct" else normal_form.inverse
    return {name: _polynomial(sympy, series(name), names, symbols, phases) for name in variables}


def _sympy() -> Any:
    try:
        import sympy
    except ImportError as error:
        raise ImportError("to_sympy needs SymPy, which is not installed: pip install sympy", name="sympy") from error
    return sympy


def _polynomial(
    sympy: Any, terms: Mapping[tuple[int, ...], Fraction | float], names: Sequence[str], known: Mapping[str, Any], phases: Sequence[str] = ()
) -> Any:
    """Σ c x₁^e₁ x₂^e₂ … cos(j M) or sin(j M) …, with floats as SymPy floats of 53 bits."""
    symbols, driven = ([known.get(name, sympy.Symbol(name)) for name in list_] for list_ in (names, phases))

    def term(exponents: tuple[int, ...], c: Fraction | float) -> Any:
        number = sympy.Float(c) if isinstance(c, float) else _rational(sympy, c)
        powers = [symbol**e for symbol, e in zip(symbols, exponents[: len(symbols)], strict=True)]
        harmonics = [sympy.cos(j * phase) if j >= 0 else sympy.sin(-j * phase) for phase, j in zip(driven, exponents[len(symbols) :], strict=True)]
        return sympy.Mul(number, *powers, *harmonics)

    return sympy.Add(*(term(exponents, c) for exponents, c in terms.items()))


def _hamiltonian(sympy: Any, normal_form: NormalForm) -> Any:
    """K = M²/(2C) [1 + γ Σ P_n κⁿ σⁿ⁺¹], κ = α/γ (theory §4)."""
    M, C, sigma, alpha, beta, gamma = sympy.symbols("M C sigma alpha beta gamma")
    terms = []
    for n in range(normal_form.order + 1):
        coefficients = normal_form.triaxiality_polynomial(n).items()
        polynomial = sympy.Add(*(_rational(sympy, c) * beta**power for power, c in coefficients))
        terms.append(polynomial * (alpha / gamma) ** n * sigma ** (n + 1))
    return M**2 / (2 * C) * (1 + gamma * sympy.Add(*terms))


def _transformation(sympy: Any, series: Any, name: str, order: int) -> Any:
    """A variable of one side as a function of those of the other side. The terms of y have the factor 1/M = √γ/V (theory §6)."""
    gamma, V = sympy.symbols("gamma V")
    factor = sympy.sqrt(gamma) / V if name == "y" else 1
    terms = (factor * _tau(sympy) ** n * _form(sympy, series(name, n)) for n in range(1, order + 1))
    return sympy.Add(sympy.Symbol(name), *terms)


def _tau(sympy: Any) -> Any:
    """τ = α/(√γ V), the small parameter."""
    alpha, gamma, V = sympy.symbols("alpha gamma V")
    return alpha / (sympy.sqrt(gamma) * V)


def _form(sympy: Any, form: dict[tuple[int, int, int], tuple[Fraction, Fraction]]) -> Any:
    """Σ c uʲ Uᵏ βˡ."""
    u, U, beta = sympy.symbols("u U beta")
    terms = ((_rational(sympy, re) + sympy.I * _rational(sympy, im)) * u**j * U**k * beta**l for (j, k, l), (re, im) in form.items())
    return sympy.Add(*terms)


def _rational(sympy: Any, number: Fraction) -> Any:
    return sympy.Rational(number.numerator, number.denominator)
