"""Each feature of a normal form with driven phases: signs of the multiples, kinds of modes, resonances, small divisors, and every way out, in each language."""

import copy
import json
import math
import pickle
import shutil
import subprocess

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp

import andoyer
from andoyer import BirkhoffNormalForm, normalize

PLANE = [("x", "X"), ("y", "Y")]
STATE = [0.02, -0.03, 0.01, 0.02]
TIME = 1.7

# A centre and a saddle; a quartet; coupled centres with two phases; a half-integer resonance; a parameter.
CENTRES = "(X^2 + x^2)/2 + 7/10*(Y^2 + y^2) + x^2*y/4 - y*sin(-2*M + N)/40 + x*Y*cos(3*N)/20 + x*cos(M)/30 - X*sin(2*M)/50"
SADDLE = "x*X + (y^2 + Y^2)/2 + x*y^2/4 - y^3/3 - x*cos(M)/50 + X*y*sin(-2*M)/20"
QUARTET = "(x*X + y*Y)/2 + x*Y - y*X + x^3/3 + x*cos(M)/40 - Y^2*sin(M)/10"
HALF = "(X^2 + x^2/4)/2 + (Y^2 + 2*y^2)/2 + x^4/10 - x^2*cos(M)/100 + x*y*sin(-M)/30"
FORMS = {
    "centres": (CENTRES, {"driven": {"M": (0.21, 0.3), "N": (-1.8347, 1.1)}}),
    "saddle": (SADDLE, {"driven": {"M": (0.3, 0.2)}}),
    "centre manifold": (SADDLE, {"driven": {"M": (0.3, 0.2)}, "keep": "hyperbolic"}),
    "quartet": (QUARTET, {"driven": {"M": (0.6, -0.4)}}),
    "half-integer resonance": (HALF, {"driven": {"M": (1, 0.5)}, "resonances": [(2, 0, -1)]}),
    "backwards": (HALF, {"driven": {"M": (-1, 0.5)}, "resonances": [(2, 0, 1)]}),
}
FORMS = {name: (h, {"exact": False} | options) for name, (h, options) in FORMS.items()}


@pytest.fixture(scope="module")
def forms():
    return {name: normalize(h, 3, PLANE, **options) for name, (h, options) in FORMS.items()}


@pytest.mark.parametrize("name", FORMS)
def test_transformation_is_symplectic_and_its_own_inverse_at_any_time(forms, name):
    form, step = forms[name], 1e-5
    rows = [form.from_normal(STATE + np.outer([step, -step], row), time=TIME) for row in np.eye(4)]
    jacobian = np.array([(up - down) / (2 * step) for up, down in rows]).T
    j = np.kron(np.eye(2), [[0, 1], [-1, 0]])
    # The direct transformation to order 3 leaves the next order.
    assert jacobian.T @ j @ jacobian == pytest.approx(j, abs=2e-3)
    assert form.to_normal(form.from_normal(STATE, time=TIME), time=TIME) == pytest.approx(STATE, abs=2e-4)


@pytest.mark.parametrize("name", FORMS)
def test_polynomials_in_the_phases_are_what_the_numbers_are(forms, name):
    form = forms[name]
    phases = [phase + float(frequency) * TIME for frequency, phase in form.driven.values()]

    def value(polynomial, point):
        total = 0.0
        for powers, c in polynomial.items():
            variables, multiples = powers[:4], powers[4:]
            waves = [math.cos(j * m) if j >= 0 else math.sin(-j * m) for j, m in zip(multiples, phases, strict=True)]
            total += float(c) * math.prod(x**k for x, k in zip(point, variables, strict=True)) * math.prod(waves)
        return total

    names = [name for pair in form.variables for name in pair]
    assert [value(form.direct(name), STATE) for name in names] == pytest.approx(list(form.from_normal(STATE, time=TIME)), abs=1e-14)
    assert [value(form.inverse(name), STATE) for name in names] == pytest.approx(list(form.to_normal(STATE, time=TIME)), abs=1e-14)
    assert value(form.in_real(), STATE) == pytest.approx(float(form.energy(STATE, time=TIME)[0]), abs=1e-15)
    # e^{ijM} in complex variables belongs to K as well: the coefficients with −j are the conjugates of a real function.
    assert any(any(powers[4:]) for powers in form.in_complex()) == any(any(powers[4:]) for powers in form.in_real())


@pytest.mark.parametrize("name", FORMS)
def test_rates_are_the_derivatives_of_the_energy(forms, name):
    form, step = forms[name], 1e-6
    up, down = (form.energy(STATE + sign * step * np.eye(4), time=TIME) for sign in (1, -1))
    gradient = (up - down).ravel() / (2 * step)
    assert form.rates(STATE, time=TIME) == pytest.approx([gradient[1], -gradient[0], gradient[3], -gradient[2]], abs=1e-9)


@pytest.mark.parametrize("name", FORMS)
def test_stored_forms_are_the_form(forms, name):
    form = forms[name]
    for kept in (BirkhoffNormalForm.from_json(form.to_json()), pickle.loads(pickle.dumps(form)), copy.copy(form), copy.deepcopy(form)):
        assert kept == form and kept.driven == form.driven and kept.resonances == form.resonances and kept.kinds == form.kinds
        assert repr(kept) == repr(form) and str(kept) == str(form) and kept.to_code("c") == form.to_code("c")
        assert np.array_equal(kept.from_normal(STATE, time=TIME), form.from_normal(STATE, time=TIME))
    text = json.loads(form.to_json())
    assert [entry[0] for entry in text["driven"]] == list(form.driven)


@pytest.mark.parametrize("name", FORMS)
def test_sympy_has_the_same_transformation_and_generator(forms, name):
    form = forms[name]
    numbers = dict(zip(["x", "X", "y", "Y"], STATE, strict=True))
    numbers |= {phase: start + float(rate) * TIME for phase, (rate, start) in form.driven.items()}
    evaluated = {what: form.to_sympy(what) for what in ("direct", "inverse")}
    for what, method in (("direct", form.from_normal), ("inverse", form.to_normal)):
        found = [float(evaluated[what][key].subs(numbers)) for key in evaluated[what]]
        assert found == pytest.approx(list(method(STATE, time=TIME)), abs=1e-13)
    generators = form.to_sympy("generator")
    assert len(generators) == form.order and any(sympy.Symbol(phase) in w.free_symbols for w in generators for phase in form.driven)


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize("what", ["hamiltonian", "generator", "direct", "inverse"])
def test_latex_is_balanced_and_has_the_phases(forms, name, what):
    text = forms[name].to_latex(what)
    assert text.count("{") == text.count("}") and text.count("\\left") == text.count("\\right")
    assert what == "hamiltonian" or "M" in text
    assert "nan" not in text.lower() and "M^" not in text


def expected(form):
    there, back = form.to_normal(STATE, time=TIME), form.from_normal(STATE, time=TIME)
    return [*there, *back]


@pytest.mark.parametrize("name", FORMS)
def test_python_code_does_what_the_form_does(forms, name):
    form, namespace = forms[name], {}
    exec(form.to_code("python"), namespace)
    found = [*namespace["to_normal"](STATE, TIME), *namespace["from_normal"](STATE, TIME)]
    assert found == pytest.approx(expected(form), rel=1e-11, abs=1e-15)
    # A resonant K, and one that keeps the centres as they are, has no frequencies.
    assert ("frequencies" in namespace) == (name in ("centres", "saddle", "quartet"))


MAIN = {
    "c": """
#include <stdio.h>
int main(void) {
    const double state[4] = {%s};
    double there[4], back[4];
    to_normal(state, %r, there);
    from_normal(state, %r, back);
    for (int k = 0; k < 4; ++k) printf("%%.17g ", there[k]);
    for (int k = 0; k < 4; ++k) printf("%%.17g ", back[k]);
    return 0;
}
""",
    "rust": """
fn main() {
    let state = [%s];
    for x in to_normal(&state, %r).iter().chain(&from_normal(&state, %r)) { print!("{:e} ", x); }
}
""",
}
COMPILERS = {"c": ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-O1"], "rust": ["rustc", "-A", "dead_code", "-D", "warnings", "--edition", "2021"]}


@pytest.mark.parametrize("language", COMPILERS)
@pytest.mark.parametrize("name", ["saddle", "quartet", "backwards"])
def test_compiled_code_does_what_the_form_does(forms, name, language, tmp_path):
    if shutil.which(COMPILERS[language][0]) is None:
        pytest.skip(f"no {COMPILERS[language][0]}")
    form, source, program = forms[name], tmp_path / f"form.{language[0]}", tmp_path / "form"
    source.write_text(form.to_code(language) + MAIN[language] % (", ".join(map(str, STATE)), TIME, TIME))
    subprocess.run([*COMPILERS[language], "-o", program, source, *(["-lm"] if language == "c" else [])], check=True)
    found = [float(part) for part in subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()]
    assert found == pytest.approx(expected(form), rel=1e-11, abs=1e-15)


def rates_of(hamiltonian, driven):
    """Hamilton's equations of a text."""
    x, X, y, Y, M, N = sympy.symbols("x X y Y M N")
    h = sympy.sympify(hamiltonian.replace("^", "**"), locals={"N": N})
    slopes = [sympy.lambdify((x, X, y, Y, M, N), sympy.diff(h, v)) for v in (x, X, y, Y)]

    def rates(t, z):
        phases = [driven.get(name, (0.0, 0.0)) for name in ("M", "N")]
        values = [slope(*z, *(start + float(rate) * t for rate, start in phases)) for slope in slopes]
        return [values[1], -values[0], values[3], -values[2]]

    return rates


@pytest.mark.parametrize(("name", "limits"), [("centres", (3e-3, 2e-5)), ("half-integer resonance", (1e-3, 2e-5)), ("backwards", (1e-3, 2e-5))])
def test_motion_with_multiples_of_both_signs_is_that_of_an_integration(name, limits):
    hamiltonian, options = FORMS[name]
    times = np.linspace(0, 30, 7)
    exact = solve_ivp(rates_of(hamiltonian, options["driven"]), (2, 32), STATE, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=2 + times).y.T
    errors = [abs(normalize(hamiltonian, order, PLANE, **options).trajectory(STATE, times, time=2.0) - exact).max() for order in (2, 6)]
    assert errors[0] < limits[0] and errors[1] < limits[1] and errors[1] < errors[0] / 5, errors


def test_a_phase_that_runs_backwards_is_the_phase_with_the_other_sign():
    forward = normalize(CENTRES, 3, PLANE, driven={"M": (0.21, 0.3), "N": (-1.8347, 1.1)}, exact=False)
    backward = normalize(CENTRES.replace("+ N", "- N").replace("3*N", "-3*N"), 3, PLANE, driven={"M": (0.21, 0.3), "N": (1.8347, -1.1)}, exact=False)
    assert backward.in_actions() == pytest.approx(forward.in_actions())
    assert backward.from_normal(STATE, time=TIME) == pytest.approx(forward.from_normal(STATE, time=TIME), abs=1e-15)


def test_small_divisor_with_a_phase_is_refused_by_the_bound_that_is_given():
    h, driven = "(p^2 + x^2)/2 + x^3*cos(M)/10", {"M": 3.00001}
    with pytest.raises(andoyer.TheoryError, match=r"U_x\^3\*exp\(-i\*M\), k = \[3, -1\], has") as caught:
        normalize(h, 3, [("x", "p")], driven=driven, smallest_divisor=1e-4, exact=False)
    assert "below the bound" in str(caught.value)
    free = normalize(h, 3, [("x", "p")], driven=driven, smallest_divisor=1e-7, exact=False)
    kept = normalize(h, 3, [("x", "p")], driven=driven, smallest_divisor=1e-4, resonances=[(3, -1)])
    assert max(map(abs, free.generator(2).values())) > 1e3 > max(map(abs, kept.generator(2).values()))
    assert kept.resonances == ((3, -1),) and (3, -1) in kept.in_angles()


def test_degrees_of_parameters_count_beside_the_phase():
    options = {"parameters": ["c", "d"], "degrees": {"c": 1, "d": 3}, "driven": {"M": "3/10"}}
    form = normalize("(p^2 + x^2)/2 + c*x^3*cos(M) + d*x^2 + c*x^2*sin(-M)", 4, [("x", "p")], **options)
    orders = {sum(powers[:1]) * 2 + powers[1] + 3 * powers[2] for powers in form.in_actions()}
    assert max(orders) <= 6 and form.exact
    numbers = normalize("(p^2 + x^2)/2 + c*x^3*cos(M) + d*x^2 + c*x^2*sin(-M)", 4, [("x", "p")], **options | {"parameters": {"c": 0.01, "d": 1e-6}})
    values = {"c": 0.01, "d": 1e-6}
    assert numbers.from_normal([0.02, 0.01], time=TIME) == pytest.approx(list(form.from_normal([0.02, 0.01], values, TIME)), abs=1e-6)


def test_progress_of_a_driven_form_is_told_and_can_end_it():
    told = []
    normalize(CENTRES, 4, PLANE, driven={"M": 0.21, "N": -1.8347}, exact=False, progress=lambda order, orders: told.append((order, orders)))
    assert told and told[-1][1] == 4

    def stop(order, orders):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        normalize(CENTRES, 4, PLANE, driven={"M": 0.21, "N": -1.8347}, exact=False, progress=stop)


def test_sizes_of_a_driven_form_are_drawn():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from andoyer import plot

    axes = plot.domain(normalize(CENTRES, 5, PLANE, driven={"M": 0.21, "N": -1.8347}, exact=False))
    assert len(axes.lines) == 8
