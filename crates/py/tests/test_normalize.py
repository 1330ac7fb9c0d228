"""Birkhoff normal forms from Python: three ways to give a Hamiltonian, published values, integrations, refusals."""

import math
from fractions import Fraction as F

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp

import andoyer
from andoyer import normalize

PLANE = [("x", "X"), ("y", "Y")]
HENON_HEILES = "(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3"


def pendulum(order):
    """p²/2 + 1 − cos q to degree order + 2, by exponents."""
    terms = {(n, 0): F((-1) ** (n // 2 + 1), math.factorial(n)) for n in range(2, order + 3, 2)}
    return normalize(terms | {(0, 2): F(1, 2)}, order, [("q", "p")])


def test_text_dictionary_and_sympy_are_the_same_hamiltonian():
    x, p, y, q, b = sympy.symbols("x X y Y b")
    expression = (x**2 + p**2) / 2 + sympy.Rational(5, 4) * (y**2 + q**2) + b * x**2 * y + y**4 / 3
    terms = {
        (2, 0, 0, 0, 0): "1/2",
        (0, 2, 0, 0, 0): F(1, 2),
        (0, 0, 2, 0, 0): "1.25",
        (0, 0, 0, 2, 0): F(5, 4),
        (2, 0, 1, 0, 1): 1,
        (0, 0, 4, 0, 0): F(1, 3),
    }
    text = "(x**2 + X**2)/2 + 1.25*(y^2 + Y^2) + b*x**2*y + y^4/3"
    forms = [normalize(h, 4, PLANE, parameters=["b"]) for h in [text, terms, expression, sympy.Poly(expression, y, x, p, q)]]
    forms.append(normalize(expression, 4, [(x, p), (y, q)], parameters=[b]))
    assert all(form == forms[0] and form.exact for form in forms)
    assert normalize(text, 3, PLANE, parameters=["b"]) != forms[0]


def test_henon_heiles_of_degree_four_is_that_of_the_published_toda_lattice_less_its_quartic_terms():
    # -(5/12) N^2 + (7/12) L^2 with N = I_x + I_y and L = x Y - y X: derived in crates/series/tests/algebra/birkhoff.rs.
    x, p, y, q = sympy.symbols("x X y Y")
    n = (x**2 + p**2 + y**2 + q**2) / 2
    expected = sympy.Poly(n - sympy.Rational(5, 12) * n**2 + sympy.Rational(7, 12) * (x * q - y * p) ** 2, x, p, y, q)
    normal_form = normalize(HENON_HEILES, 2, PLANE, resonances=[(1, -1)])
    assert normal_form.in_real() == {powers: F(c.p, c.q) for powers, c in expected.terms()}
    assert (normal_form.order, normal_form.degree, normal_form.exact) == (2, 4, True)
    assert (normal_form.variables, normal_form.parameters) == (tuple(PLANE), ())
    assert normal_form.frequencies == normal_form.ratios == (1, 1)


def test_third_integral_of_henon_heiles_commutes_with_it_to_the_order():
    x, p, y, q = symbols = sympy.symbols("x X y Y")
    order = 4
    normal_form = normalize(HENON_HEILES, order, PLANE, resonances=[(1, -1)])
    integral = sum(
        sympy.Rational(c.numerator, c.denominator) * math.prod(s**e for s, e in zip(symbols, powers, strict=True))
        for powers, c in normal_form.inverse("(x^2 + X^2 + y^2 + Y^2)/2").items()
    )
    h = sympy.sympify(HENON_HEILES.replace("^", "**"))
    bracket = sum(integral.diff(a) * h.diff(b) - integral.diff(b) * h.diff(a) for a, b in [(x, p), (y, q)])
    assert min(map(sum, sympy.Poly(sympy.expand(bracket), *symbols).monoms())) == order + 3


def test_pendulum_is_the_published_one_and_its_frequency_that_of_the_elliptic_integral():
    # Nikolaev, arXiv:1612.05207, supplement pendulum_explicit.log, coefficients of (q^2 + p^2)^n = (2 I)^n.
    normal_form = pendulum(20)
    published = {2: F(1, 64), 3: F(1, 2048), 4: F(5, 131072), 5: F(33, 8388608), 11: F(4194753, 144115188075855872)}
    k = normal_form.in_actions()
    assert k[1,] == 1 and all(k[n,] == -c * 2**n for n, c in published.items())
    # Swing of amplitude a: Omega = pi/(2 K(sin(a/2)^2)); error a^22 / 4^11 and less at a = 0.5.
    from scipy.special import ellipk

    action = normal_form.actions([0.5, 0.0])
    expected = math.pi / (2 * ellipk(math.sin(0.25) ** 2))
    assert normal_form.frequency_map(action)[0] == pytest.approx(expected, rel=1e-13)


def test_irrational_frequencies_and_floats_are_floats_unless_told():
    exact, rational = normalize("x^2 + X^2/2 + x^4", 2, [("x", "X")]), normalize("x^2 + X^2 + x^4", 2, [("x", "X")])
    assert not exact.exact and exact.frequencies == (math.sqrt(2),) and rational.exact and rational.frequencies == (2,)
    with pytest.raises(andoyer.RepresentationError, match="square root of 2, which is not rational"):
        normalize("x^2 + X^2/2 + x^4", 2, [("x", "X")], exact=True)
    terms = {(2, 0): 0.5, (0, 2): F(1, 2), (4, 0): np.float64(0.1)}
    assert not normalize(terms, 2, [("x", "X")]).exact
    assert normalize(terms, 2, [("x", "X")], exact=True).in_actions()[2,] == F(3, 2) * F(0.1)
    floats = normalize(rational_text := "x^2 + X^2 + x^3 + x^4", 6, [("x", "X")], exact=False)
    for powers, c in normalize(rational_text, 6, [("x", "X")]).in_actions().items():
        assert floats.in_actions()[powers] == pytest.approx(float(c), rel=1e-13)
    x, p = sympy.symbols("x X")
    assert normalize(sympy.sqrt(2) * x**2 / 2 + sympy.sqrt(2) * p**2 / 2, 1, [(x, p)]).frequencies == (math.sqrt(2),)


def test_trajectory_is_that_of_a_numerical_integration():
    # Frequencies 1, sqrt 2, sqrt 7, no symmetry; the error of order N at amplitude a is a^(N + 2): halving a divides it by 2^8.
    space = [("x", "X"), ("y", "Y"), ("z", "Z")]
    h = "(x^2 + X^2)/2 + (y^2 + 2*Y^2)/2 + (7*z^2 + Z^2)/2 + 0.3*x^2*y + 0.2*x*y*z - 0.25*z^3 + 0.1*y^2*X*Z"
    normal_form = normalize(h, 6, space)
    names = sympy.symbols("x X y Y z Z")
    gradient = [sympy.sympify(h.replace("^", "**")).diff(name) for name in names]
    rate = sympy.lambdify([names], [g * s for (a, b) in zip(gradient[::2], gradient[1::2], strict=True) for g, s in [(b, 1), (a, -1)]])
    times = np.linspace(0, 20, 41)
    errors, drifts = [], []
    for amplitude in [0.12, 0.06]:
        start = amplitude * np.array([0.8, -0.3, 0.5, 0.4, -0.2, 0.9])
        solution = solve_ivp(lambda _, s: rate(s), (0, 20), start, t_eval=times, method="DOP853", rtol=1e-13, atol=1e-16).y.T
        errors.append(abs(normal_form.trajectory(start, times) - solution).max())
        actions = normal_form.actions(solution)
        drifts.append(abs(actions - actions[0]).max())
    assert errors[0] < 1e-7 and math.log2(errors[0] / errors[1]) == pytest.approx(8, abs=0.3)
    assert drifts[0] < 1e-8 and math.log2(drifts[0] / drifts[1]) == pytest.approx(9, abs=0.3)


def test_rigid_body_as_any_hamiltonian_has_the_triaxiality_polynomials():
    # Theory §2 at beta = 3/5, kappa = 5/4 in units of gamma/(2C), M = 1: K = sum of P_n kappa^n L^(n+1).
    k = normalize("1.25*(1.6*x^2 + 0.4*X^2)*(1 - (x^2 + X^2)/4)", 12, [("x", "X")]).in_actions()
    rigid = andoyer.NormalForm(6)
    for n in range(7):
        value = sum(c * F(3, 5) ** power for power, c in rigid.triaxiality_polynomial(n).items())
        assert k[n + 1,] == value * F(5, 4) ** n


def test_states_go_there_and_back_in_rows_and_alone():
    normal_form = pendulum(8)
    states = np.array([[0.1, 0.0], [0.05, -0.1], [0.0, 0.0]])
    normal = normal_form.to_normal(states)
    assert normal.shape == (3, 2) and np.array_equal(normal[1], normal_form.to_normal(states[1]))
    # Error of degree 11 (the pendulum is odd): 0.1^11 and less.
    assert np.allclose(normal_form.from_normal(normal), states, rtol=0, atol=1e-11)
    actions = normal_form.actions(states)
    assert actions.shape == (3, 1) and np.allclose(actions[:, 0], (normal**2).sum(axis=1) / 2, rtol=1e-12)
    assert normal_form.trajectory(states[0], 1.0).shape == (2,) and normal_form.trajectory(states[0], []).shape == (0, 2)


def test_direct_and_inverse_take_functions_and_names():
    normal_form = normalize("(x^2 + X^2)/2 + x^3", 1, [("x", "X")])
    assert normal_form.direct("x") == {(1, 0): 1, (2, 0): -1, (0, 2): -2}
    assert normal_form.inverse({(1, 0): 1}) == {(1, 0): 1, (2, 0): 1, (0, 2): 2}
    assert normal_form.direct(sympy.Symbol("x") * 2)[2, 0] == -2
    assert normal_form.direct("(x^2 + X^2)/2 + x^3") == normal_form.in_real() == {(2, 0): F(1, 2), (0, 2): F(1, 2)}
    # S_1: {x; S_1} = dS_1/dX is the change of x.
    generator = normal_form.generator(1)
    assert {(j, k - 1): k * c for (j, k), c in generator.items() if k} == {(2, 0): -1, (0, 2): -2}
    for m in [0, 2, -1, True]:
        with pytest.raises((andoyer.InputError, TypeError)):
            normal_form.generator(m)


def test_parameters_are_symbols_and_then_numbers():
    symbolic = normalize("(x^2 + X^2)/2 + a*x^3 + b*x^4", 2, [("x", "X")], parameters=["a", "b"])
    assert symbolic.in_actions() == {(1, 0, 0): 1, (2, 2, 0): F(-15, 4), (2, 0, 1): F(3, 2)}
    assert symbolic.parameters == ("a", "b") and str(symbolic) == "I_x + 3/2*I_x^2*b - 15/4*I_x^2*a^2"
    numeric = normalize("(x^2 + X^2)/2 + 0.5*x^3 - 0.25*x^4", 2, [("x", "X")])
    values = {"b": -0.25, "a": 0.5}
    assert np.allclose(symbolic.to_normal([0.1, 0.2], values), numeric.to_normal([0.1, 0.2]), rtol=1e-14)
    assert symbolic.frequency_map([0.1], {"a": 0, "b": 1})[0] == pytest.approx(1.3, rel=1e-15)
    for wrong in [None, {"a": 1}, {"a": 1, "b": 2, "c": 3}]:
        with pytest.raises(andoyer.InputError, match=r"they are \[a, b\]"):
            symbolic.to_normal([0.1, 0.2], wrong)


def test_complex_form_has_real_and_imaginary_parts():
    assert normalize("x^2 + X^2 + 7", 0, [("x", "X")]).in_complex() == {(0, 0): (7, 0), (1, 1): (0, -2)}
    resonant = normalize(HENON_HEILES, 2, PLANE, resonances=[(1, -1)])
    # x Y - y X = u_x U_y - U_x u_y, and its square has the coefficient 7/12.
    assert resonant.in_complex()[2, 0, 0, 2] == (F(7, 12), 0) and str(resonant).startswith("-i*u_x*U_x")


@pytest.mark.parametrize(
    "hamiltonian, message",
    [
        ("x^2 + X^2 + y^2 + Y^2 + 2*x*y", r"in \(x, X\), \(y, Y\) has a zero frequency, along the direction with the components x 1.000, y 1.000"),
        ("x^2 + X^2 + y^2 + Y^2 - Y", "the origin is not an equilibrium: the linear term Y has the coefficient -1"),
        ("x^2 + X^2 + y^4 + Y^2", r"in \(y, Y\) has a zero frequency"),
        ("x^2 +", "at byte 5"),
        ("sin(x)", "at byte"),
        ({(2, 0): 1}, r"tuple of exponents of x, X, y, Y"),
        ({(2, 0, 0, -1): 1}, "tuple of exponents"),
        ({(2, 0, 0, 0): math.nan}, "NaN is not finite"),
        (sympy.sin(sympy.Symbol("x")), "no polynomial"),
        (sympy.Integer(3), "no polynomial"),
    ],
)
def test_hamiltonian_that_is_none_is_refused(hamiltonian, message):
    kind = andoyer.TheoryError if "zero frequency" in message else andoyer.InputError
    with pytest.raises(kind, match=message):
        normalize(hamiltonian, 2, PLANE)


def test_unknown_variables_are_refused_by_name():
    for hamiltonian in ["x^2 + X^2 + z^3", sympy.Symbol("x") ** 2 + sympy.Symbol("z") ** 3]:
        with pytest.raises(andoyer.InputError, match='"z"'):
            normalize(hamiltonian, 2, [("x", "X")])
    with pytest.raises(andoyer.InputError, match='"z"'):
        normalize("x^2 + X^2", 2, [("x", "X")]).direct("z")


def test_resonances_not_asked_for_and_none_are_refused():
    with pytest.raises(andoyer.TheoryError, match=r"order 2: the term u_x\^2\*U_y\^2, k = \[-2, 2\]"):
        normalize(HENON_HEILES, 4, PLANE)
    with pytest.raises(andoyer.InputError, match=r"k = \[2, -1\] is not a resonance"):
        normalize(HENON_HEILES, 4, PLANE, resonances=[(2, -1)])
    for wrong in [[(0, 0)], [(1, -1, 0)], [(1,)]]:
        with pytest.raises(andoyer.InputError, match="is not a resonance vector"):
            normalize(HENON_HEILES, 4, PLANE, resonances=wrong)
    resonant = normalize(HENON_HEILES, 4, PLANE, resonances=[(1, -1)])
    for ask in [resonant.in_actions, lambda: resonant.frequency_map([0.1, 0.1])]:
        with pytest.raises(andoyer.TheoryError, match=r"contains u_x\^2\*U_y\^2"):
            ask()
    assert resonant.to_normal([0.1, 0, 0, 0.1]).shape == (4,)
    # 1 and 1.999 are 2:-1 within the wider bound only.
    near = "(x^2 + X^2)/2 + 0.9995*(y^2 + Y^2) + x^2*y"
    assert len(normalize(near, 1, PLANE, resonances=[(2, -1)], smallest_divisor=0.01).in_complex()) == 4
    with pytest.raises(andoyer.TheoryError, match="bound 0.0198"):
        normalize(near, 1, PLANE, smallest_divisor=0.01 - 5e-5)
    for bound in [-1.0, 2.0, math.nan]:
        with pytest.raises(andoyer.InputError, match="smallest_divisor"):
            normalize(near, 1, PLANE, smallest_divisor=bound)


def test_sizes_and_orders_out_of_bounds_are_refused():
    for order, error in [(-1, andoyer.InputError), (2.5, andoyer.InputError), ("4", andoyer.InputError), (32764, andoyer.RepresentationError)]:
        with pytest.raises(error, match="order"):
            normalize("x^2 + X^2", order, [("x", "X")])
    with pytest.raises(andoyer.RepresentationError, match="170"):
        normalize("x^2 + X^2", 171, [("x", "X")], exact=False)
    pairs = [(name, name.upper()) for name in "abcde"]
    for variables, parameters in [(pairs, []), ([], []), (pairs[:3], ["r", "s", "t"])]:
        with pytest.raises(andoyer.InputError, match="at most 8 variables"):
            normalize("1", 2, variables, parameters=parameters)
    with pytest.raises(andoyer.InputError, match="cannot hold"):
        normalize("x^2", 2, [("x", "x")])
    normal_form = pendulum(2)
    for wrong, message in [([0.1], "has shape"), ([[[0.1, 0.0]]], "has shape"), (0.1, "= 0.1 is one number"), ([0.1, 0.0, 0.0], "has shape")]:
        with pytest.raises(andoyer.InputError, match=f"states {message}"):
            normal_form.to_normal(wrong)
    for wrong in [[math.nan, 0.0], [math.inf, 0.0], [1e200, 0.0]]:
        with pytest.raises(andoyer.InputError, match="not finite"):
            normal_form.to_normal(wrong)
    for wrong in [3, None, b"x^2", [("x", 1)]]:
        with pytest.raises(TypeError, match="must be a text, a dict or a SymPy expression"):
            normalize(wrong, 2, [("x", "X")])
    for wrong in [None, True, 1j, [1]]:
        with pytest.raises(TypeError, match="coefficient must be a real number"):
            normalize({(2, 0): wrong}, 2, [("x", "X")])


def test_progress_hears_of_every_order_and_stops():
    told = []
    normalize("x^2 + X^2 + x^3", 3, [("x", "X")], progress=lambda *done: told.append(done))
    assert told == [(done, 3) for done in range(4)]

    def progress(done, of):
        if done == 2:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        normalize("x^2 + X^2 + x^3", 100, [("x", "X")], progress=progress)


def test_normal_form_is_a_value():
    normal_form = pendulum(4)
    assert normal_form == pendulum(4) and normal_form != pendulum(6) and str(normal_form) == "I_q - 1/16*I_q^2 - 1/256*I_q^3"
    assert repr(normal_form) == "<BirkhoffNormalForm of order 4 in q, p, exact, radius 3.119>"
    with pytest.raises(AttributeError):
        normal_form.order = 3


def test_refusals_name_the_argument():
    h = "(x^2 + X^2)/2 + x^3"
    for wrong in ["xX", ["x", "X"], ("x", "X"), [("x",)], [("x", "X", "y")], None, 1]:
        with pytest.raises(TypeError, match=r"variables must be a sequence of pairs \(q, p\)"):
            normalize(h, 2, wrong)
    assert normalize(h, 2, [["x", "X"]]) == normalize(h, 2, (("x", "X"),)) == normalize(h, 2, [("x", "X")])
    for wrong in ["a", 1]:
        with pytest.raises(TypeError, match="parameters must be a sequence of names"):
            normalize(h, 2, [("x", "X")], parameters=wrong)
    for wrong in [(2, -1), [(1.0,)], [(2**70,)], ["11"], 1]:
        with pytest.raises(TypeError, match="resonances must be a sequence of vectors of integers"):
            normalize(h, 2, [("x", "X")], resonances=wrong)
    for wrong, kind in [("x^2 +", andoyer.InputError), ("cos(x)", andoyer.InputError), ({(70000, 0): 1}, andoyer.RepresentationError)]:
        with pytest.raises(kind, match="^hamiltonian: "):
            normalize(wrong, 2, [("x", "X")])
    with pytest.raises(andoyer.InputError, match="^function: at byte 3"):
        normalize(h, 2, [("x", "X")]).direct("x +")
    with pytest.raises(andoyer.InputError, match="^variables: .*2y"):
        normalize(h, 2, [("x", "2y")])
