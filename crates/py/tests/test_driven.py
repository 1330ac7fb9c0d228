"""Normal forms with driven phases: integrations, Mathieu's functions, kept resonances, and every way in and out."""

import copy
import math
import pickle
import subprocess
from fractions import Fraction

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp
from scipy.special import mathieu_a, mathieu_b

import andoyer
from andoyer import BirkhoffNormalForm, normalize

DUFFING = "(p^2 + x^2)/2 - x^3/5 + x^4/4 - x*cos(M)/20 - x^2*sin(-2*M)/50"
PLANE = [("x", "X"), ("y", "Y")]


def duffing(order, frequency=0.37, phase=0.3, **options):
    return normalize(DUFFING, order, [("x", "p")], driven={"M": (frequency, phase)}, **({"exact": False} | options))


def integrated(rates, start, times, begin=0.0):
    shifted = begin + np.asarray(times)
    return solve_ivp(rates, (begin, shifted[-1]), start, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=shifted).y.T


def duffing_rates(t, z):
    m = 0.3 + 0.37 * t
    return [z[1], -z[0] + 0.6 * z[0] ** 2 - z[0] ** 3 + math.cos(m) / 20 - z[0] * math.sin(2 * m) / 25]


def test_driven_duffing_oscillator_is_that_of_an_integration():
    times, start = np.linspace(0, 50, 26), [0.05, 0.02]
    exact = integrated(duffing_rates, start, times, begin=2.0)
    found, drift = {}, {}
    for order in (2, 5, 10):
        form = duffing(order)
        found[order] = abs(form.trajectory(start, times, time=2.0) - exact).max()
        drift[order] = np.ptp(form.actions(exact, time=2.0 + times), axis=0).max()
    assert found[5] < found[2] / 30 and found[10] < min(found[5] / 30, 2e-6)
    assert drift[10] < drift[5] / 30 < drift[2] / 900


def test_one_time_serves_all_rows_or_each_row_has_its_own():
    form, states = duffing(4), np.array([[0.1, 0.0], [0.0, 0.1], [0.05, 0.05]])
    for method in (form.to_normal, form.from_normal, form.energy, form.rates, form.actions):
        alone = [method(state, time=t) for state, t in zip(states, (1.0, 2.0, 3.0), strict=True)]
        assert np.array_equal(method(states, time=[1.0, 2.0, 3.0]), alone)
        assert np.array_equal(method(states), method(states, time=0.0))
        with pytest.raises(andoyer.InputError, match="time has shape"):
            method(states, time=[1.0, 2.0])
        with pytest.raises(andoyer.InputError, match="not finite"):
            method(states, time=math.nan)
    assert form.from_normal(form.to_normal(states, time=1.5), time=1.5) == pytest.approx(states, abs=1e-3)


def triangle(mu, e, order):
    """The elliptic restricted problem about L4, pulsating coordinates, the true anomaly as the time: H = ((X + y)² + (Y − x)²)/2 − W/(1 + e cos f)."""
    x, y, t = sympy.symbols("x y t")

    def attraction(mass, a, b):
        inverse = (1 - 2 * t * (a * x + b * y) + t**2 * (x**2 + y**2)) ** sympy.Rational(-1, 2)
        series = sympy.series(inverse, t, 0, order + 3).removeO()
        return mass * sum(series.coeff(t, n) for n in range(2, order + 3))

    h = math.sqrt(3) / 2
    potential = sympy.expand((x**2 + y**2) / 2 + attraction(1 - mu, -0.5, -h) + attraction(mu, 0.5, -h))
    beta = (1 - math.sqrt(1 - e**2)) / e if e else 0.0
    f = sympy.Symbol("f")
    wave = (1 + 2 * sum((-beta) ** k * sympy.cos(k * f) for k in range(1, order + 1))) / math.sqrt(1 - e**2)
    X, Y = sympy.symbols("X Y")
    hamiltonian = ((X + y) ** 2 + (Y - x) ** 2) / 2 - potential * wave
    return normalize(sympy.expand(hamiltonian), order, [(x, X), (y, Y)], driven={f: 1.0}, exact=False)


def elliptic(mu, e):
    a, b = 0.5 - mu, math.sqrt(3) / 2

    def rates(f, s):
        x, y = a + s[0], b + s[2]
        r1, r2 = math.hypot(x + mu, y), math.hypot(x - 1 + mu, y)
        pull = (1 - mu) / r1**3, mu / r2**3
        gx = x - pull[0] * (x + mu) - pull[1] * (x - 1 + mu)
        gy = y - (pull[0] + pull[1]) * y
        w = 1 / (1 + e * math.cos(f))
        u, v = s[1] + s[2], s[3] - s[0]
        return [u, v + w * gx, v, -u + w * gy]

    return rates


def test_elliptic_restricted_problem_about_l4_is_that_of_an_integration():
    mu, e = 0.01, 0.02
    times, start = np.linspace(0, 60, 31), [1e-3, 0.0, -5e-4, 1e-3]
    exact = integrated(elliptic(mu, e), start, times)
    found = {order: abs(triangle(mu, e, order).trajectory(start, times) - exact).max() for order in (2, 4, 6)}
    assert found[4] < found[2] / 3 and found[6] < found[4] / 3 and found[6] < 1e-6, found


def test_exponents_of_l4_on_an_ellipse_are_those_of_the_monodromy_matrix():
    mu, e = 0.01, 0.05
    step = 1e-5  # central differences: the flow has third derivatives of 1e4
    ends = [[integrated(elliptic(mu, e), sign * step * row, [2 * math.pi])[0] for sign in (1, -1)] for row in np.eye(4)]
    monodromy = np.array([(up - down) / (2 * step) for up, down in ends]).T
    monodromy = np.sort(np.abs(np.angle(np.linalg.eigvals(monodromy))))[::2] / (2 * math.pi)
    found = np.abs(triangle(mu, e, 8).frequency_map([0.0, 0.0]))
    found = np.sort(np.abs(found - np.round(found)))
    assert found == pytest.approx(monodromy, abs=1e-6)


def test_exponent_of_mathieu_is_the_published_series():
    # DLMF 28.15.1: a = ν² + q²/(2(ν² − 1)) + (5ν² + 7) q⁴/(32 (ν² − 1)³ (ν² − 4)) + …, here at a = 4/9.
    form = normalize("(p^2 + 4/9*x^2)/2 - q*x^2*cos(2*M)", 4, [("x", "p")], parameters=["q"], driven={"M": 1})
    terms = form.in_actions()
    assert terms[1, 0] == Fraction(2, 3) and terms[1, 2] == Fraction(27, 40)
    v, q = sympy.symbols("v q")
    nu = sum(sympy.Rational(c.numerator, c.denominator) * q ** powers[1] for powers, c in terms.items())
    a = v**2 + q**2 / (2 * (v**2 - 1)) + (5 * v**2 + 7) * q**4 / (32 * (v**2 - 1) ** 3 * (v**2 - 4))
    assert sympy.series(a.subs(v, nu), q, 0, 6).removeO() == sympy.Rational(4, 9)


def test_edges_of_mathieu_s_first_tongue_are_its_characteristic_values():
    # a = 1 + d; the resonance φ − t is kept: K = A I + B I cos 2(φ − t), and the edges are A − 1 = ±B.
    form = normalize("(p^2 + (1 + d)*x^2)/2 - q*x^2*cos(2*M)", 10, [("x", "p")], parameters=["d", "q"], degrees={"d": 1}, driven={"M": 1}, resonances=[(1, -1)])
    angles = form.in_angles()
    assert set(angles) == {(0, 0), (2, -2)}
    d, q = sympy.symbols("d q")
    A, B = (sum(c[0] * d ** powers[1] * q ** powers[2] for powers, c in angles[k].items()) for k in ((0, 0), (2, -2)))
    for sign, edge in ((1, mathieu_a(1, 0.1)), (-1, mathieu_b(1, 0.1))):
        found = sympy.nsolve((A - 1 - sign * B).subs(q, 0.1), d, float(edge) - 1)
        assert float(found) == pytest.approx(float(edge) - 1, abs=1e-11)


def test_kept_resonance_is_integrated_with_the_phase():
    # Half-integer resonance: ω = 1/2 and x² cos M with M = t.
    h = "(p^2 + x^2/4)/2 + x^4/10 - x^2*cos(M)/100"
    with pytest.raises(andoyer.TheoryError, match=r"U_x\^2\*exp\(-i\*M\), k = \[2, -1\]"):
        normalize(h, 2, [("x", "p")], driven={"M": 1}, exact=True)
    form = normalize(h, 6, [("x", "p")], driven={"M": 1}, resonances=[(2, -1)])
    half = normalize(h.replace("cos(M)", "cos(2*N)"), 6, [("x", "p")], driven={"N": "1/2"}, resonances=[(1, -1)])
    times, start = np.linspace(0, 100, 11), [0.05, 0.02]
    exact = integrated(lambda t, z: [z[1], -z[0] / 4 - 0.4 * z[0] ** 3 + z[0] * math.cos(t) / 50], start, times, begin=3.0)
    for kept in (form, half):
        assert abs(kept.trajectory(start, times, time=3.0) - exact).max() < 1e-6
        with pytest.raises(andoyer.TheoryError):
            kept.frequency_map([0.1])
    assert "cos(2*phi_x - M)" in str(form) and "exp(i*M)" in str(form)
    backwards = form.trajectory(exact[-1], -100.0, time=103.0)
    assert backwards == pytest.approx(start, abs=1e-6)


def test_centre_manifold_moves_with_the_phase():
    h = "x*X + (y^2 + Y^2)/2 + x*y^2/4 - y^3/3 - x*cos(M)/50 + X*y*sin(M)/20"
    form = normalize(h, 8, PLANE, driven={"M": 0.3}, keep="hyperbolic")
    assert any(powers[-1] for powers in form.centre_manifold())
    states = form.from_centre_manifold([[0.03, 0.0]] * 2, time=[0.0, 1.0])
    normal = form.to_normal(states, time=[0.0, 1.0])
    assert abs(normal[:, :2]).max() < 1e-7 and abs(states[0] - states[1]).max() > 1e-4


def test_text_dictionary_and_sympy_are_the_same_hamiltonian():
    x, p, M = sympy.symbols("x p M", real=True)
    R = sympy.Rational
    expression = (p**2 + x**2) / 2 - x**3 / 5 + x**4 / 4 - x * sympy.cos(M) / 20 - x**2 * sympy.sin(-2 * M) / 50
    F = Fraction
    terms = {(0, 2, 0): F(1, 2), (2, 0, 0): F(1, 2), (3, 0, 0): F(-1, 5), (4, 0, 0): F(1, 4), (1, 0, 1): F(-1, 20), (2, 0, -2): F(1, 50)}
    driven = {"M": (F(37, 100), 0.25)}
    forms = [normalize(h, 3, [("x", "p")], driven=driven, exact=True) for h in (DUFFING, terms, expression)]
    forms.append(normalize(expression, 3, [(x, p)], driven={M: ("37/100", 0.25)}, exact=True))
    forms.append(
        normalize(expression.subs(x * sympy.cos(M), x * sympy.cos(M) * (sympy.cos(M) ** 2 + sympy.sin(M) ** 2)), 3, [("x", "p")], driven=driven, exact=True)
    )
    assert all(form == forms[0] for form in forms) and forms[0].exact
    assert forms[0].driven == {"M": (F(37, 100), 0.25)} and repr(forms[0]) == "<BirkhoffNormalForm of order 3 in x, p, M, exact>"
    assert not normalize(DUFFING, 1, [("x", "p")], driven={"M": 0.37}, resonances=[]).exact
    assert forms[0] != normalize(DUFFING, 3, [("x", "p")], driven={"M": F(37, 100)}, exact=True)
    image = forms[-2].to_sympy("direct")["x"]
    assert M in image.free_symbols and image.coeff(sympy.cos(M)).subs({x: 0, p: 0}) != 0
    linear = normalize(DUFFING, 0, [("x", "p")], driven={"M": "37/100"}, exact=True).to_sympy("direct")["x"]
    assert linear.coeff(sympy.cos(sympy.Symbol("M"))) == R(500, 8631)  # (1/20)/(1 − 0.37²)


@pytest.mark.parametrize("exact", [True, False])
def test_json_pickle_and_copies_are_the_form(exact):
    form = normalize(DUFFING + " - x^2*sin(N)*p/20", 3, [("x", "p")], driven={"M": ("37/100", 0.25), "N": "-7/3"}, exact=exact)
    for kept in (BirkhoffNormalForm.from_json(form.to_json()), pickle.loads(pickle.dumps(form)), copy.deepcopy(form)):
        assert kept == form and kept.driven == form.driven and kept.in_complex() == form.in_complex()
        assert np.array_equal(kept.trajectory([0.1, 0.0], [1.0], time=2.0), form.trajectory([0.1, 0.0], [1.0], time=2.0))
    with pytest.raises(andoyer.FileError):
        BirkhoffNormalForm.from_json(form.to_json().replace('["M","37/100"', '["M","9/25"').replace('["M",0.37', '["M",0.36'))


def test_latex_has_cosines_sines_and_exponentials():
    direct = normalize(DUFFING, 2, [("x", "p")], driven={"M": "37/100"}, exact=True).to_latex("direct")
    assert "\\cos(M)" in direct and "\\sin(2M)" in direct and "M'" not in direct
    resonant = normalize("(p^2 + x^2/4)/2 - x^2*cos(theta)/40", 1, [("x", "p")], driven={"theta": 1}, resonances=[(2, -1)])
    assert "\\mathrm{e}^{\\mathrm{i}\\theta{}}" in resonant.to_latex() and "\\mathrm{e}^{-\\mathrm{i}\\theta{}}" in resonant.to_latex()


def phases_and_parameters():
    h = DUFFING.replace("x^4", "c*x^4") + " + x*p*cos(M - N)/30"
    return normalize(h, 3, [("x", "p")], parameters=["c"], driven={"M": (0.37, 0.3), "N": 1.7})


def test_python_code_does_what_the_form_does():
    form, namespace = phases_and_parameters(), {}
    exec(form.to_code("python"), namespace)
    state, values = [0.05, 0.02], {"c": 0.7}
    normal = namespace["to_normal"](state, [0.7], 2.5)
    assert normal == pytest.approx(list(form.to_normal(state, values, 2.5)), rel=1e-12)
    assert namespace["from_normal"](normal, [0.7], 2.5) == pytest.approx(list(form.from_normal(normal, values, 2.5)), rel=1e-12)
    assert namespace["frequencies"](namespace["actions"](normal), [0.7]) == pytest.approx(
        list(form.frequency_map(form.actions(state, values, 2.5), values)), rel=1e-12
    )


def test_c_and_rust_code_compile_without_a_warning_and_do_what_the_form_does(tmp_path):
    form = phases_and_parameters()
    expected = [*form.to_normal([0.05, 0.02], {"c": 0.7}, 2.5), *form.from_normal([0.05, 0.02], {"c": 0.7}, 2.5)]
    main = {
        "c": """
#include <stdio.h>
int main(void) {
    const double state[2] = {0.05, 0.02}, parameters[1] = {0.7};
    double there[2], back[2], rates[1];
    to_normal(state, parameters, 2.5, there);
    from_normal(state, parameters, 2.5, back);
    frequencies(state, parameters, rates);
    printf("%.17g %.17g %.17g %.17g\\n", there[0], there[1], back[0], back[1]);
    return 0;
}
""",
        "rust": """
fn main() {
    let (there, back) = (to_normal(&[0.05, 0.02], &[0.7], 2.5), from_normal(&[0.05, 0.02], &[0.7], 2.5));
    assert!(frequencies(&actions(&there), &[0.7])[0] > 0.0);
    println!("{:?} {:?} {:?} {:?}", there[0], there[1], back[0], back[1]);
}
""",
    }
    compilers = {"c": ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-O1"], "rust": ["rustc", "-D", "warnings", "--edition", "2021"]}
    for language, command in compilers.items():
        source, program = tmp_path / f"form.{language[0]}", tmp_path / f"form_{language}"
        source.write_text(form.to_code(language) + main[language])
        libraries = ["-lm"] if language == "c" else []
        subprocess.run([*command, "-o", program, source, *libraries], check=True)
        found = [float(part) for part in subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()]
        assert found == pytest.approx(expected, rel=1e-12), language


def test_domain_of_a_driven_form_has_sizes_and_no_radii():
    domain = duffing(8).domain()
    assert domain.radii == [] and len(domain.sizes(0.01)) == 8 and domain.best_order(0.001) > domain.best_order(3.0)
    assert len(str(domain).splitlines()) == 9


@pytest.mark.parametrize(
    ("hamiltonian", "options", "kind", "message"),
    [
        ("(p^2 + x^2)/2 - x*cos(M)", {"driven": {"M": 1}, "exact": True}, andoyer.TheoryError, r"force U_x\*exp\(-i\*M\) is in resonance"),
        ("(p^2 + x^2)/2 - x*M", {"driven": {"M": 2}}, andoyer.InputError, "driven phase"),
        ("(p^2 + x^2)/2 - x*cos(x)", {"driven": {"M": 2}}, andoyer.InputError, "multiples"),
        ("(p^2 + x^2)/2 - x*cos(M)", {}, andoyer.InputError, "is a function"),
        ("(p^2 + x^2)/2", {"driven": {"x": 2}}, andoyer.InputError, "cannot hold"),
        ("(p^2 + x^2)/2", {"driven": {"c": 2}, "parameters": ["c"]}, andoyer.InputError, "cannot hold"),
        ("(p^2 + x^2)/2", {"driven": {"M": 0}}, andoyer.InputError, "other than 0"),
        ("(p^2 + x^2)/2", {"driven": {"M": (1, 2, 3)}}, andoyer.InputError, "3 entries"),
        ("(p^2 + x^2)/2", {"driven": {"M": (1, math.nan)}}, andoyer.InputError, "not finite"),
        ("(p^2 + x^2)/2", {"driven": {"M": math.inf}}, andoyer.InputError, "not finite"),
        ("(p^2 + x^2)/2", {"driven": {"M": "a"}}, andoyer.InputError, "unknown name"),
        ("(p^2 + w^2*x^2)/2", {"driven": {"M": 1}, "parameters": ["w"], "frequency": ("w", "s")}, andoyer.InputError, "scaled away"),
        ("(p^2 + x^2)/2", {"driven": {"M": 3}, "resonances": [(1,)]}, andoyer.InputError, "driven phase"),
        ("(p^2 + x^2)/2 + x^2*cos(9000*M)", {"driven": {"M": 0.3}, "exact": False}, andoyer.RepresentationError, "exceeds the bound"),
        (sympy.Symbol("x") ** 2 * sympy.Symbol("M") + sympy.Symbol("p") ** 2, {"driven": {"M": 3}}, TypeError, "coefficient"),
        ({(2, 0): 1, (0, 2): 1}, {"driven": {"M": 3}}, andoyer.InputError, "exponents of x, p, M"),
        ({(2, -1, 0): 1, (0, 2, 0): 1}, {"driven": {"M": 3}}, andoyer.InputError, "exponents of x, p, M"),
    ],
)
def test_what_gives_no_driven_form_is_refused(hamiltonian, options, kind, message):
    with pytest.raises(kind, match=message):
        normalize(hamiltonian, 3, [("x", "p")], **options)


def test_force_that_is_a_parameter_of_degree_one_is_kept_in_resonance():
    form = normalize("(p^2 + x^2)/2 + x^4/4 - f*x*cos(M)", 4, [("x", "p")], parameters=["f"], degrees={"f": 1}, driven={"M": 1}, resonances=[(1, -1)])
    times, start = np.linspace(0, 30, 4), [0.1, 0.0]
    exact = integrated(lambda t, z: [z[1], -z[0] - z[0] ** 3 + 0.001 * math.cos(t)], start, times)
    assert abs(form.trajectory(start, times, {"f": 0.001}) - exact).max() < 1e-5
