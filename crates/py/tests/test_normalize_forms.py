"""What `normalize` prints, the numbers of its parameters, and the remedies that its refusals name."""

import math
from fractions import Fraction

import numpy as np
import pytest

import andoyer
from andoyer import normalize

SPRING = "(p^2 + x^2)/2 + (P^2 + 4*y^2)/2 + x^2*y"
PAIRS = [("x", "p"), ("y", "P")]


def test_parameter_with_a_number_is_replaced_by_it():
    text, pair = "(p^2 + x^2)/2 + c*x^4/4", [("x", "p")]
    found = normalize(text, 4, pair, parameters={"c": 0.1})
    expected = normalize("(p^2 + x^2)/2 + x^4/40", 4, pair, exact=False)
    assert found.parameters == () and not found.exact
    for powers, c in expected.in_actions().items():
        assert found.in_actions()[powers] == pytest.approx(c, rel=1e-14)
    exact = normalize(text, 4, pair, parameters={"c": Fraction(1, 10)})
    assert exact == normalize("(p^2 + x^2)/2 + x^4/40", 4, pair) == normalize(text, 4, pair, parameters={"c": "0.1"})
    # None keeps a symbol, in its place among the others.
    mixed = normalize("(p^2 + x^2)/2 + a*x^3 + b*c^2*x^4", 2, pair, parameters={"a": None, "b": 3, "c": None})
    assert mixed.parameters == ("a", "c") and mixed == normalize("(p^2 + x^2)/2 + a*x^3 + 3*c^2*x^4", 2, pair, parameters=["a", "c"])
    # Also in the quadratic part, where a symbol would be a detuning; with degrees; and beside a scaling.
    assert normalize("(p^2 + d*x^2)/2", 2, pair, parameters={"d": 4}).frequencies == (2,)
    scaled = normalize("p^2/2 + w^2*x^2/2 + c*x^4/4", 2, pair, parameters={"w": None, "c": 2}, frequency=("w", "s"))
    assert str(scaled) == "I_x + 3/4*I_x^2*s^6"
    for bad in (math.nan, math.inf):
        with pytest.raises(andoyer.InputError, match='parameters\\["c"\\]: the coefficient .* is not finite'):
            normalize(text, 4, pair, parameters={"c": bad})
    with pytest.raises(TypeError, match='parameters\\["c"\\]'):
        normalize(text, 4, pair, parameters={"c": [0.1]})


def test_scaling_by_the_frequency_drops_terms_without_variables():
    plain = normalize("p^2/2 + w^2*q^2/2 + q^4/4", 2, [("q", "p")], parameters=["w"], frequency=("w", "s"))
    for constant in ("3", "3*w^2", "w^5 - 1"):
        assert normalize(f"p^2/2 + w^2*q^2/2 + q^4/4 + {constant}", 2, [("q", "p")], parameters=["w"], frequency=("w", "s")) == plain
    with pytest.raises(andoyer.InputError, match=r"the term q\^4\*w\^5 has the power -4"):
        normalize("p^2/2 + w^2*q^2/2 + q^4*w^5", 2, [("q", "p")], parameters=["w"], frequency=("w", "s"))


def test_saddle_and_quartet_print_as_the_products_that_they_are():
    saddle = normalize("2*x*X + (y^2 + Y^2)/2 + x*X*y^2 + x^2*X^2", 2, [("x", "X"), ("y", "Y")])
    assert str(saddle) == "2*(x*X) + I_y + (x*X)^2 + (x*X)*I_y"
    assert "2(xX) + I_{y} + (xX)^{2} + (xX)I_{y}" in saddle.to_latex()
    quartet = normalize("1/5*(a*A + b*B) - 7/10*(a*B - b*A) + a^2*A^2", 2, [("a", "A"), ("b", "B")])
    assert str(quartet).startswith("1/5*(a*A + b*B) - 7/10*(a*B - b*A) + 3/8*(a*A + b*B)^2")
    assert "(aA + bB)" in quartet.to_latex()
    # The text is a polynomial in the new variables, and the same one.
    for form, pairs in ((saddle, [("x", "X"), ("y", "Y")]), (quartet, [("a", "A"), ("b", "B")])):
        text = str(form).replace("I_y", "((y^2 + Y^2)/2)")
        assert normalize(text, 2, pairs).in_real() == form.in_real()


def evaluated(form, normal, actions, angles):
    """K by `in_angles`."""
    value = 0.0
    for k, terms in form.in_angles().items():
        angle = np.dot(k, angles)
        for powers, (cosine, sine) in terms.items():
            value += math.prod(action ** (power / 2) for action, power in zip(actions, powers)) * (cosine * math.cos(angle) + sine * math.sin(angle))
    return value


@pytest.mark.parametrize(
    "text, order, resonances",
    [
        (SPRING, 4, [(2, -1)]),
        ("(p^2 + x^2)/2 + (P^2 + y^2)/2 + x^2*y - y^3/3", 4, [(1, -1)]),
        ("(2*p^2 + x^2/2)/2 + (3*P^2 + 3*y^2) + x^3*y + x^3*P + x^4", 2, [(6, -1)]),
        ("(p^2 + x^2)/2 - (P^2 + 9*y^2)/2 + x^3*y + x^2*p*P", 2, [(3, 1)]),
        ("(p^2 + 2*x^2)/2 + (P^2 + 8*y^2)/2 + x^2*y", 2, [(2, -1)]),
    ],
)
def test_actions_and_angles_give_the_same_energy(text, order, resonances):
    form = normalize(text, order, PAIRS, resonances=resonances)
    rng = np.random.default_rng(3)
    for _ in range(20):
        q1, p1, q2, p2 = normal = rng.uniform(-1, 1, 4)
        actions, angles = [], []
        for (q, p), r in zip(((q1, p1), (q2, p2)), map(float, form.ratios)):
            actions.append((q * q / r + r * p * p) / 2)
            angles.append(math.atan2(q / math.sqrt(r), p * math.sqrt(r)))
        assert evaluated(form, normal, actions, angles) == pytest.approx(form.energy(normal), rel=1e-12, abs=1e-13)


def test_resonant_form_prints_in_complex_variables_and_in_actions_and_the_resonant_angle():
    form = normalize(SPRING, 1, PAIRS, resonances=[(2, -1)])
    assert str(form).splitlines() == [
        "-i*u_x*U_x - 2*i*u_y*U_y - 1/2*i*u_x^2*U_y - 1/8*U_x^2*u_y",
        "= I_x + 2*I_y + 1/2*I_x*I_y^(1/2)*sin(2*phi_x - phi_y)",
    ]
    # With r = 1 and 3 a factor (2 r_x)^(1/2) (2 r_y)^(3/2) = 12 sqrt(3) stays a root, and in floats it is a number.
    other = "(p^2 + x^2)/2 + (P^2 + y^2/9)/2 + x*y^3"
    assert str(normalize(other, 2, PAIRS, resonances=[(1, -3)])).splitlines()[1] == "= I_x + 1/3*I_y - 3/2*sqrt(3)*I_x^(1/2)*I_y^(3/2)*cos(phi_x - 3*phi_y)"
    assert str(normalize(other, 2, PAIRS, resonances=[(1, -3)], exact=False)).splitlines()[1] == (
        "= I_x + 0.33333333333*I_y - 2.59807621135*I_x^(1/2)*I_y^(3/2)*cos(phi_x - 3*phi_y)"
    )
    floats = normalize(SPRING.replace("x^2*y", "0.1*x^2*y"), 1, PAIRS, resonances=[(2, -1)], exact=False)
    assert str(floats).splitlines()[1] == "= I_x + 2*I_y + 0.05*I_x*I_y^(1/2)*sin(2*phi_x - phi_y)"


def test_terms_without_an_angle_print_in_real_variables():
    manifold = normalize("x*X + (y^2 + Y^2)/2 + x*y^2/4 + X^2*y/2 - y^3/3", 1, [("x", "X"), ("y", "Y")], keep="hyperbolic")
    assert str(manifold).splitlines()[1] == "= x*X + 1/2*y^2 + 1/2*Y^2 - 1/3*y^3"
    two_saddles = normalize("x*X + y*Y + x^2*Y^2", 2, [("x", "X"), ("y", "Y")], resonances=[(1, -1)])
    assert str(two_saddles).splitlines()[1] == "= x*X + y*Y + x^2*Y^2"
    with pytest.raises(andoyer.TheoryError, match="contains u_x"):
        two_saddles.in_angles()


def test_domain_has_no_negative_zero():
    domain = normalize("(p^2 + q^2)/2 - q^4/24", 4, [("q", "p")]).domain()
    assert "-0" not in str(domain) and [math.copysign(1, norm) for norm in domain.norms] == [1, 1, 1, 1]


def test_function_or_root_of_sympy_is_named_with_its_remedy():
    sympy = pytest.importorskip("sympy")
    q, p, a = sympy.symbols("q p a")
    oscillator = (p**2 + q**2) / 2
    taylor = "expand it as a Taylor polynomial, for a normal form of order N to degree N \\+ 2"
    for function in (sympy.cos(q), 3 * q * sympy.exp(q + p), sympy.Abs(q), (1 + sympy.sin(q)) ** 2):
        name = next(part for part in sympy.preorder_traversal(function) if part.is_Function).func
        with pytest.raises(
            andoyer.InputError,
            match=f'^hamiltonian is no polynomial: .*; "{name}" is a function, and only polynomials are read, and cosines and sines of named driven phases: {taylor}$',
        ):
            normalize(oscillator + function, 2, [(q, p)])
    for power in (1 / (1 + q), sympy.sqrt(1 + q), q**a, 2**q):
        with pytest.raises(andoyer.InputError, match="; expand .* as a Taylor polynomial, for a normal form of order N to degree N \\+ 2$"):
            normalize(oscillator + power, 2, [(q, p)], parameters=[a])
    with pytest.raises(
        andoyer.InputError,
        match=r'; write a parameter w in place of sqrt\(a\), and scale w away with frequency = \("w", "s"\) if all frequencies are proportional to w$',
    ):
        normalize(p**2 / 2 + sympy.sqrt(a) * q**2 / 2, 2, [(q, p)], parameters=[a])
    with pytest.raises(andoyer.InputError, match='"f" is a function'):
        normalize(oscillator + sympy.Function("f")(q), 2, [(q, p)])


def test_square_root_in_a_text_is_named_as_one():
    with pytest.raises(
        andoyer.InputError, match='"sqrt" is a square root, .*write a number in decimals, or, .*write a parameter w .*in Python the argument frequency'
    ):
        normalize("sqrt(2)*(p^2 + q^2)/2", 2, [("q", "p")])


def test_irrational_square_root_names_the_way_by_frequency():
    with pytest.raises(
        andoyer.RepresentationError, match=r"square root of 2, .*: use floats, or, .*write w\^2 for 2 with a parameter w .*in Python the argument frequency"
    ):
        normalize("p^2/2 + q^2 + q^4", 2, [("q", "p")], exact=True)
    # The named way.
    exact = normalize("p^2/2 + w^2*q^2/2 + q^4", 2, [("q", "p")], parameters=["w"], frequency=("w", "s"), exact=True)
    s = 2**-0.25
    floats = normalize("p^2/2 + q^2 + q^4", 2, [("q", "p")]).in_actions()
    assert math.sqrt(2) * float(exact.in_actions()[2, 6]) * s**6 == pytest.approx(floats[2,], rel=1e-14)
    with pytest.raises(andoyer.RepresentationError, match=r"not rational: use floats, or, .*write a parameter w .*in Python the argument frequency"):
        normalize("(X^2 + Y^2)/2 + x^2 - x*y + y^2", 2, [("x", "X"), ("y", "Y")], exact=True)


@pytest.mark.parametrize("power", range(-18, 19, 3))
def test_radius_is_printed_with_its_digits_at_any_size(power):
    """With c x^3 the radius is proportional to 1/c: it was printed with three decimals, 8.5e-5 as 0.000."""
    form = normalize(f"(p^2 + x^2)/2 + {10.0**power!r}*x^3", 5, [("x", "p")], exact=False)
    radius = form.domain().radii[-1]
    shown = repr(form).partition("radius ")[2].rstrip(">")
    assert float(shown) == pytest.approx(radius, rel=6e-4) and len(shown) < 20
    unit = normalize("(p^2 + x^2)/2 + x^3", 5, [("x", "p")], exact=False).domain().radii[-1]
    assert radius == pytest.approx(unit / 10.0**power, rel=1e-9)
