"""The normal form as SymPy expressions, held against the brackets that it must obey."""

import sys

import pytest
import sympy

import andoyer
from andoyer import NormalForm

ORDER = 3
M, C, L, V, sigma, alpha, beta, gamma, u, U, y = sympy.symbols("M C L V sigma alpha beta gamma u U y")


POINT = {u: sympy.Rational(2, 3), U: sympy.Rational(-5, 7), y: 3, V: 11, C: 13, beta: sympy.Rational(1, 4), gamma: 9}
"""Where identities too long to expand are looked at: α alone is left, and rational numbers."""


@pytest.fixture(scope="module")
def normal_form():
    return NormalForm(ORDER)


def bracket(f, g):
    """{f; g} in the pairs (u, U) and (y, Y), Y = V/√γ (theory §1)."""
    slope = sympy.sqrt(gamma)
    first = f.diff(u) * g.diff(U) - f.diff(U) * g.diff(u)
    return first + slope * (f.diff(y) * g.diff(V) - f.diff(V) * g.diff(y))


def orders(expression):
    """Coefficients of α⁰, α¹, …: every order of the theory has one more power of it."""
    coefficients = sympy.Poly(sympy.expand(expression), alpha).all_coeffs()
    return [sympy.expand(c) for c in reversed(coefficients)]


@pytest.mark.parametrize("what", ["direct", "inverse"])
@pytest.mark.parametrize("pair, value", [("uU", 1), ("yu", 0), ("yU", 0)])
def test_transformation_is_canonical_to_its_order(normal_form, what, pair, value):
    variables = normal_form.to_sympy(what)
    found = orders(bracket(*(variables[name] for name in pair)))
    assert found[: ORDER + 1] == [value] + [0] * ORDER
    assert any(found[ORDER + 1 :])


def test_inverse_of_direct_is_the_identity_to_its_order():
    direct, inverse = (NormalForm(2).to_sympy(what) for what in ["direct", "inverse"])
    assert list(direct) == list(inverse) == ["u", "U", "y"]
    new = {u: inverse["u"].subs(POINT), U: inverse["U"].subs(POINT), y: inverse["y"].subs(POINT)}
    for name, symbol in [("u", u), ("U", U), ("y", y)]:
        difference = orders(direct[name].subs(POINT | new) - POINT[symbol])
        assert difference[:3] == [0, 0, 0] and any(difference[3:])


def test_hamiltonian_has_the_triaxiality_polynomials(normal_form):
    K = sympy.expand(normal_form.to_sympy("hamiltonian"))
    assert sympy.expand(normal_form.to_sympy()) == K
    assert K.coeff(sigma, 0) == M**2 / (2 * C)
    for n in range(ORDER + 1):
        P = sum(sympy.Rational(c) * beta**power for power, c in normal_form.triaxiality_polynomial(n).items())
        assert sympy.expand(K.coeff(sigma, n + 1) - M**2 / (2 * C) * gamma * (alpha / gamma) ** n * P) == 0
    assert K.coeff(sigma, ORDER + 2) == 0


def test_torque_free_hamiltonian_in_the_new_variables_is_the_normal_form(normal_form):
    # theory §2, with M = V/√γ and L = −i uU.
    main = V**2 / (2 * C * gamma) - V * sympy.sqrt(gamma) / C * sympy.I * u * U
    H = main + alpha / (4 * C) * (2 * u**2 * U**2 - sympy.I * beta * (u**3 * U - u * U**3))
    direct, K = normal_form.to_sympy("direct"), normal_form.to_sympy()
    new = H.subs(POINT | {u: direct["u"].subs(POINT), U: direct["U"].subs(POINT)})
    expected = K.subs(sigma, -sympy.I * u * U / M).subs(M, V / sympy.sqrt(gamma)).subs(POINT)
    difference = orders(new - expected)
    assert difference[: ORDER + 1] == [0] * (ORDER + 1) and any(difference[ORDER + 1 :])


def test_first_transformations_are_brackets_with_the_generating_function(normal_form):
    S = normal_form.to_sympy("generator")
    assert len(S) == ORDER
    direct = normal_form.to_sympy("direct")
    for name, symbol in [("u", u), ("U", U), ("y", y)]:
        assert sympy.expand(orders(direct[name])[1] - bracket(symbol, S[0]) / alpha) == 0


def test_slopes_of_the_hamiltonian_are_the_frequencies_that_emitted_code_returns(normal_form):
    K = normal_form.to_sympy().subs(sigma, L / M)
    namespace = {}
    exec(normal_form.to_code("python"), namespace)
    b, a = sympy.Rational(3, 10), sympy.Rational(1, 4)
    g = a * sympy.sqrt(1 - b**2)
    at = {M: 2, C: 3, L: sympy.Rational(1, 5), alpha: a, beta: b, gamma: g}
    *_, anomaly, longitude = namespace["short_axis_rotation"](0.3, 0.1, 0.7)
    assert float(K.diff(L).subs(at)) == pytest.approx(2 * float(g) / 3 * anomaly, rel=1e-14)
    assert float(K.diff(M).subs(at)) == pytest.approx(2 / 3 * (1 + float(g) * longitude), rel=1e-14)


def test_numbers_are_exact(normal_form):
    parts = [normal_form.to_sympy(what) for what in ["hamiltonian", "generator", "direct", "inverse"]]
    found = [parts[0], *parts[1], *parts[2].values(), *parts[3].values()]
    assert not [e for e in found if e.atoms(sympy.Float)]
    assert not [s for e in found for s in e.free_symbols if s != sympy.Symbol(s.name)]


def test_order_zero_is_the_main_problem():
    assert sympy.expand(NormalForm(0).to_sympy() - M**2 / (2 * C) * (1 + 2 * gamma * sigma)) == 0
    assert NormalForm(0).to_sympy("generator") == []
    assert NormalForm(0).to_sympy("direct") == {"u": u, "U": U, "y": y}


def test_missing_sympy_is_an_import_error_that_says_what_to_install(normal_form, monkeypatch):
    monkeypatch.setitem(sys.modules, "sympy", None)
    with pytest.raises(ImportError, match="pip install sympy"):
        normal_form.to_sympy()
    with pytest.raises(andoyer.InputError, match="lagrangian"):
        normal_form.to_sympy("lagrangian")


def test_any_normal_form_is_expressions_in_its_own_names():
    x, p, c, action = sympy.symbols("x p c I_x")
    duffing = andoyer.normalize("(p^2 + x^2)/2 + c*x^4/4", 2, [("x", "p")], parameters=["c"])
    assert duffing.to_sympy() == action + sympy.Rational(3, 8) * c * action**2
    direct, inverse = duffing.to_sympy("direct"), duffing.to_sympy("inverse")
    assert list(direct) == list(inverse) == ["x", "p"]
    (first, second), change = duffing.to_sympy("generator"), sympy.Poly(direct["x"] - x, x, p)
    # S_1 = 0 and x = x' + {x'; S_2}/2.
    assert first == 0 and sympy.expand(second.diff(p) / 2 - change.as_expr()) == 0 and change.total_degree() == 3
    back = sympy.Poly(sympy.expand(direct["x"].subs({x: inverse["x"], p: inverse["p"]}, simultaneous=True)), x, p)
    assert sum(co * x**j * p**k for (j, k), co in back.terms() if j + k < 5) == x
    assert not duffing.to_sympy("direct")["p"].atoms(sympy.Float)


def test_resonant_normal_form_is_an_expression_in_the_variables():
    n, angular = sympy.sympify("(x**2 + X**2 + y**2 + Y**2)/2"), sympy.sympify("x*Y - y*X")
    h = sympy.sympify("x**2*y - y**3/3") + n
    resonant = andoyer.normalize(h, 2, [("x", "X"), ("y", "Y")], resonances=[(1, -1)]).to_sympy()
    assert sympy.expand(resonant - (n - sympy.Rational(5, 12) * n**2 + sympy.Rational(7, 12) * angular**2)) == 0


def test_floats_stay_floats_and_unknown_parts_are_refused():
    floats = andoyer.normalize({(2, 0): 0.5, (0, 2): 0.5, (4, 0): 0.1}, 2, [("x", "p")])
    assert floats.to_sympy().coeff(sympy.Symbol("I_x"), 2) == sympy.Float(floats.in_actions()[2,])
    with pytest.raises(andoyer.InputError, match="lagrangian"):
        floats.to_sympy("lagrangian")
