"""Normal forms about a periodic motion: Hill's equation, integrations, samples, and what is refused."""

import copy
import itertools
import json
import math
import pickle
import subprocess
import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import andoyer
from andoyer import Driven, DrivenNormalForm, normalize

PAIR = [("x", "p")]
DUFFING = "(p^2 + x^2)/2 - x^3/5 + x^4/4 - 0.2*x*cos(M)"


def duffing_rates(t, z):
    return [z[1], -z[0] + 0.6 * z[0] ** 2 - z[0] ** 3 + 0.2 * math.cos(0.37 * t)]


def integrated(rates, start, times):
    return solve_ivp(rates, (times[0], times[-1]), start, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=times).y.T


def test_motion_is_that_of_an_integration_from_any_time():
    form, times = normalize(DUFFING, 8, PAIR, driven=Driven(0.37)), np.linspace(2.0, 60.0, 30)
    exact = integrated(duffing_rates, [0.25, 0.02], times)
    assert form.trajectory([0.25, 0.02], times - 2.0, time=2.0) == pytest.approx(exact, abs=1e-6)
    assert np.ptp(form.actions(exact, time=times), axis=0).max() < 1e-7
    normal = form.to_normal(exact, time=times)
    assert form.from_normal(normal, time=times) == pytest.approx(exact, abs=1e-13)


def test_energy_along_a_path_is_kept_better_with_each_order():
    times = np.linspace(0.0, 40.0, 40)
    exact = integrated(duffing_rates, [0.35, 0.0], times)
    drifts = [np.ptp(normalize(DUFFING, order, PAIR, driven=Driven(0.37)).actions(exact, time=times)) for order in (2, 4, 6, 8)]
    assert all(later < earlier / 3 for earlier, later in itertools.pairwise(drifts))


def test_samples_and_text_give_the_same_form():
    def samples(phase):
        return {(1, 0): -0.2 * math.cos(phase)}

    static = "(p^2 + x^2)/2 - x^3/5 + x^4/4"
    forms = [normalize(static, 4, PAIR, driven=Driven(0.37, samples)), normalize(DUFFING, 4, PAIR, driven=Driven(0.37))]
    assert forms[0].in_actions() == pytest.approx(forms[1].in_actions(), abs=1e-14)
    every = normalize(None, 2, PAIR, driven=Driven(0.37, lambda M: {(2, 0): 0.5, (0, 2): 0.5, (1, 0): math.sin(M)}))
    assert every.frequencies == pytest.approx((1.0,), abs=1e-14)
    assert every.periodic(math.pi / 2)[0] == pytest.approx(-1 / (1 - 0.37**2), abs=1e-13)


def test_two_phases_move_as_the_formula_says():
    form = normalize("(p^2 + 4*x^2)/2 - x*cos(a) - x*sin(3*b)/2", 2, PAIR, driven=Driven([1.0, 0.7], names=["a", "b"]))
    exact = math.cos(0.3) / 3 + 0.5 * math.sin(6.0) / (4 - 2.1**2)
    assert form.periodic([0.3, 2.0])[0] == pytest.approx(exact, abs=1e-14)
    assert form.driven == {"a": (1.0, 0.0), "b": (0.7, 0.0)} and form.kinds == ("elliptic",)


@pytest.mark.parametrize(("j", "k"), [(9, 9), (10, 9), (7, 7), (2, -11)])
def test_harmonics_of_two_phases_are_those_of_the_formula(j, k):
    # Harmonics that pass for lower ones on a grid of nine times, and at phases in the golden section.
    rates, phases = (0.05, 0.03), (0.3, 0.4)
    exact = 0.1 * math.cos(j * phases[0] + k * phases[1]) / (1 - (j * rates[0] + k * rates[1]) ** 2)
    text = normalize(f"(p^2 + x^2)/2 - x*cos({j}*a {k:+}*b)/10", 0, PAIR, driven=dict(zip("ab", rates, strict=True)))
    assert text.periodic(phases)[0] == pytest.approx(exact, abs=1e-13)
    sampled = Driven(rates, lambda a, b: {(1, 0): -math.cos(j * a + k * b) / 10})
    assert normalize("(p^2 + x^2)/2", 0, PAIR, driven=sampled).periodic(phases)[0] == pytest.approx(exact, abs=1e-13)


@pytest.mark.parametrize("unit", [1e-12, 1e-3, 1e6])
def test_form_in_another_unit_of_time_is_the_same(unit):
    text = f"{unit}*((p^2 + x^2)/2 + x^4/4 - 0.3*x*cos(4*M))"
    form, known = (normalize(one, 4, PAIR, driven={"M": rate}) for one, rate in ((text, 0.1 * unit), (text.replace(f"{unit}*", ""), 0.1)))
    assert form.periodic(0.03) == pytest.approx(known.periodic(0.03), rel=1e-10)
    assert form.frequencies[0] == pytest.approx(known.frequencies[0] * unit, rel=1e-12)
    fast = Driven(0.0213 * unit, lambda M: {(2, 0): unit / 2, (0, 2): unit / 2, (1, 0): -0.3 * unit * math.cos(64 * M)})
    assert normalize(None, 0, PAIR, driven=fast).periodic(0.03)[0] == pytest.approx(0.3 * math.cos(1.92) / (1 - (64 * 0.0213) ** 2), rel=1e-9)
    with pytest.raises(andoyer.TheoryError, match="no periodic motion"):
        normalize(f"{unit}*((p^2 + x^2)/2 - 0.3*x*cos(M))", 0, PAIR, driven={"M": unit})


@pytest.mark.parametrize("mass", [1e-8, 1e5])
def test_form_of_a_light_or_heavy_oscillator_is_the_same(mass):
    # The canonical scaling x → x √m, p → p/√m.
    text = f"p^2/{2 * mass!r} + {mass / 2!r}*x^2 + {mass**2 / 4!r}*x^4 - {0.3 * mass**0.5!r}*x*cos(M)"
    form, known = normalize(text, 4, PAIR, driven={"M": 0.4}), normalize("(p^2 + x^2)/2 + x^4/4 - 0.3*x*cos(M)", 4, PAIR, driven={"M": 0.4})
    assert form.in_actions() == pytest.approx(known.in_actions(), rel=1e-9)


def test_small_force_and_large_force_move_a_linear_oscillator_as_the_formula_says():
    for force, j, rate in ((1e-11, 64, 0.0213), (5e3, 1, 0.4), (1e6, 3, 0.4)):
        form = normalize(f"(p^2 + x^2)/2 - {force}*x*cos({j}*M)", 0, PAIR, driven={"M": rate})
        assert form.periodic(0.03)[0] == pytest.approx(force * math.cos(0.03 * j) / (1 - (j * rate) ** 2), rel=1e-9)


def test_three_pairs_with_two_phases_and_a_saddle_move_as_an_integration():
    text = "(p^2 + x^2)/2 + (q^2 + 2.3*y^2)/2 + (r^2 - 0.4*z^2)/2 + x^2*y/5 + y*z^2/4 - x*cos(a)/10 - y*cos(a - 2*b)/20 + x*z*sin(b)/10"
    form = normalize(text, 4, [("x", "p"), ("y", "q"), ("z", "r")], driven={"a": (0.37, 0.2), "b": (-0.21, 0.5)})

    def rates(t, s):
        x, p, y, q, z, r = s
        a, b = 0.2 + 0.37 * t, 0.5 - 0.21 * t
        return [
            p,
            -x - 0.4 * x * y + math.cos(a) / 10 - z * math.sin(b) / 10,
            q,
            -2.3 * y - x * x / 5 - z * z / 4 + math.cos(a - 2 * b) / 20,
            r,
            0.4 * z - y * z / 2 - x * math.sin(b) / 10,
        ]

    assert form.kinds == ("elliptic", "elliptic", "hyperbolic")
    start, times = form.periodic([0.2, 0.5]) + np.array([0.02, 0.01, -0.02, 0.015, 1e-4, -1e-4]), np.linspace(0, 8, 9)
    assert form.trajectory(start, times) == pytest.approx(integrated(rates, start, times), abs=1e-6)


def test_functions_are_expressed_at_a_time():
    form, state = normalize(DUFFING, 8, PAIR, driven=Driven(0.37)), np.array([0.22, 0.01])
    q, p = form.to_normal(state, time=1.5)
    direct = form.direct("x*p", time=1.5)
    assert sum(c * q**i * p**j for (i, j), c in direct.items()) == pytest.approx(state[0] * state[1], abs=1e-9)
    inverse = form.inverse("x", time=1.5)
    assert sum(c * state[0] ** i * state[1] ** j for (i, j), c in inverse.items()) == pytest.approx(q, abs=1e-4)


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("(p^2 + x^2)/2 - x*cos(M)", {}, "no periodic motion"),
        ("(p^2 + x^2)/2 - 0.2*x^2*cos(2*M)", {"driven": Driven(2.0, names=["M"])}, ""),
        ("(p^2 + x^2)/2 + x^3*cos(3*M)", {}, r"small divisor at order 1: the term u1\^3 with the multiples \[3\] .* k = \[3, -3\]"),
    ],
)
def test_what_theory_cannot_do_says_why(text, options, words):
    if not words:
        assert normalize(text, 0, PAIR, **options).kinds == ("elliptic",)
        return
    with pytest.raises(andoyer.TheoryError, match=words):
        normalize(text, 2, PAIR, **({"driven": Driven(1.0)} | options))


@pytest.mark.parametrize("rate", [0.0, math.nan, math.inf])
def test_rate_that_is_none_is_refused(rate):
    with pytest.raises(andoyer.InputError, match="rate"):
        Driven(rate)


def test_bad_input_names_its_argument():
    with pytest.raises(andoyer.InputError, match="names: 2 names for 1 rates"):
        Driven(1.0, names=["M", "N"])
    for name, value in (("parameters", ["q"]), ("resonances", [(1, -1)]), ("keep", "hyperbolic"), ("frequency", ("w", "s"))):
        with pytest.raises(andoyer.InputError, match=name):
            normalize("(p^2 + x^2)/2", 2, PAIR, driven=Driven(1.0), **{name: value})
    with pytest.raises(andoyer.InputError, match="exact"):
        normalize("(p^2 + x^2)/2", 2, PAIR, driven=Driven(1.0), exact=True)
    with pytest.raises(TypeError, match="a dict of rates by name or a Driven"):
        normalize("(p^2 + x^2)/2", 2, PAIR, driven=0.37)
    with pytest.raises(ZeroDivisionError):
        normalize("(p^2 + x^2)/2", 2, PAIR, driven=Driven(1.0, lambda M: 1 / 0))
    form = normalize("(p^2 + x^2)/2", 2, PAIR, driven=Driven(1.0))
    with pytest.raises(andoyer.InputError, match="phases"):
        form.periodic([0.0, 1.0])
    with pytest.raises(andoyer.InputError, match="phases contains NaN"):
        form.periodic(math.nan)
    with pytest.raises(andoyer.InputError, match="actions = -1 "):
        form.frequency_map([-1.0])
    with pytest.raises(andoyer.TheoryError, match="beyond the range"):
        normalize("(p^2 + x^2)/2 + x^4/4", 6, PAIR, driven={"M": 1.7}).trajectory([3.0, 0.0], [0.0])
    for divisor in (-1.0, 1.5, math.nan):
        with pytest.raises(andoyer.InputError, match="smallest_divisor"):
            normalize("(p^2 + x^2)/2", 2, PAIR, driven={"M": 0.4}, smallest_divisor=divisor)
    for rate in (0, "1e-400", math.inf):
        with pytest.raises(andoyer.InputError, match="M"):
            normalize("(p^2 + x^2)/2", 2, PAIR, driven={"M": rate})
    with pytest.raises(andoyer.InputError, match="while driven phase 0 makes a turn"):
        normalize("(p^2 + x^2)/2", 2, PAIR, driven=Driven(1.0, lambda M: {(1, 0): math.cos(M / 2)}))
    with pytest.raises(TypeError, match="samples must be a callable, not int"):
        Driven(1.0, 5)
    with pytest.raises(andoyer.InputError, match="rate is empty"):
        Driven([])
    assert Driven(1.0, names="N").names == ["N"]
    with pytest.raises(andoyer.TheoryError, match="100000"):
        normalize("(p^2 + x^2)/2 + x^2*cos(M)/10", 0, PAIR, driven={"M": 1e-300})
    with pytest.raises(andoyer.TheoryError, match="20000"):
        normalize("(p^2 + x^2)/2 + x*cos(90*a)/10 + x*cos(90*b)/10", 0, PAIR, driven={"a": 0.0213, "b": 0.0311})
    with pytest.raises(andoyer.InputError, match="state"):
        form.trajectory([0.0], [1.0])
    assert repr(form) == f"<DrivenNormalForm of order 2 with M, {form.times} times>"


PENDULUM = "p^2/2 + x^2/2 - x^4/24 + x^6/720 - x^8/40320 + x^10/3628800 - 0.1*x*cos(M)"


def test_start_chooses_the_periodic_motion_and_one_out_of_phase_is_named():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        near, far = (normalize(PENDULUM, 2, PAIR, driven={"M": 0.8}, start=start) for start in (None, [-1.9, 0.0]))
    with pytest.warns(UserWarning, match="out of phase with the response to a weak drive"):
        beyond = normalize(PENDULUM, 2, PAIR, driven={"M": 0.9})
    for rate, form, side in ((0.8, near, 1), (0.8, far, -1), (0.9, beyond, -1)):

        def rates(t, z, rate=rate):
            x = z[0]
            return [z[1], -x + x**3 / 6 - x**5 / 120 + x**7 / 5040 - x**9 / 362880 + 0.1 * math.cos(rate * t)]

        state = form.periodic(0.0)
        assert side * state[0] > 0.2
        assert integrated(rates, state, [0.0, 2 * math.pi / rate])[-1] == pytest.approx(state, abs=1e-9)


def test_start_that_is_no_state_of_one_phase_is_refused():
    text = "(p^2 + x^2)/2 - 0.1*x*cos(M)"
    for start, driven in (([1.0], {"M": 0.4}), ([math.nan, 0.0], {"M": 0.4}), ([0.1, 0.0], {"M": 0.4, "N": 0.3}), ([0.1, 0.0], None)):
        with pytest.raises(andoyer.InputError, match="start"):
            normalize(text if driven else "(p^2 + x^2)/2", 2, PAIR, driven=driven, start=start)
    with pytest.raises(TypeError, match="start"):
        normalize(text, 2, PAIR, driven={"M": 0.4}, start="near")


def test_exponent_of_mathieu_is_that_of_hill_s_equation_whatever_the_drive():
    a, q = 2.2, 1.0
    form = normalize(f"(p^2 + {a}*x^2)/2 - {q}*x^2*cos(2*M)", 0, PAIR, driven={"M": 1})
    columns = [integrated(lambda t, z: [z[1], -(a - 2 * q * math.cos(2 * t)) * z[0]], start, [0, math.pi])[-1] for start in ([1, 0], [0, 1])]
    assert isinstance(form, DrivenNormalForm)
    assert 2 * math.cos(math.pi * form.frequencies[0]) == pytest.approx(columns[0][0] + columns[1][1], abs=1e-10)


def test_phase_at_time_0_moves_the_time():
    form, later = (normalize(DUFFING, 6, PAIR, driven={"M": (0.37, start)}) for start in (0.0, 0.74))
    times = np.linspace(0.0, 20.0, 5)
    assert later.driven == {"M": (0.37, 0.74)} and later != form and later.periodic(0.74) == pytest.approx(form.periodic(0.74), abs=1e-14)
    assert later.trajectory([0.25, 0.02], times) == pytest.approx(form.trajectory([0.25, 0.02], times, time=2.0), abs=1e-12)
    backwards = normalize(DUFFING.replace("cos(M)", "cos(-M)"), 6, PAIR, driven={"M": (-0.37, -0.74)})
    assert backwards.trajectory([0.25, 0.02], times) == pytest.approx(later.trajectory([0.25, 0.02], times), abs=1e-11)


def test_hamiltonian_that_is_not_driven_has_the_form_that_it_has_without_a_phase():
    text = "(p^2 + x^2)/2 - x^3/5 + x^4/4"
    form, plain = normalize(text, 8, PAIR, driven={"M": 0.37}), normalize(text, 8, PAIR)
    assert form.in_actions() == pytest.approx({powers: float(c) for powers, c in plain.in_actions().items()}, rel=1e-12)
    assert abs(form.periodic(1.0)).max() == 0.0


def test_half_integer_resonance_is_served_with_its_divisor_or_refused_with_it():
    def quartic(drive, **options):
        return normalize(f"(p^2 + x^2)/2 + x^4/4 - {drive}*x^2*cos(M)", 2, PAIR, driven={"M": 2.001}, **options)

    form = quartic(1e-5)
    multiples, divisor = form.divisors[0]
    assert multiples in ((2, -1), (4, -2)) and abs(divisor) == pytest.approx(1e-3 * multiples[0] / 2, rel=0.01)
    with pytest.raises(andoyer.TheoryError, match="small divisor"):
        quartic(1e-5, smallest_divisor=1e-2)
    with pytest.raises(andoyer.TheoryError, match="negative"):
        quartic(0.01)


def test_harmonic_64_of_a_slow_phase_is_that_of_the_formula():
    # At the nine times of the first grid cos 64M is cos M.
    form = normalize("(p^2 + x^2)/2 + x^4/100 - x*cos(64*M)/1000", 2, PAIR, driven={"M": 0.0213})
    linear = normalize("(p^2 + x^2)/2 - x*cos(64*M)/1000", 0, PAIR, driven={"M": 0.0213})
    for phase in (0.0, 0.03):
        exact = 1e-3 / (1 - 1.3632**2) * math.cos(64 * phase)
        assert linear.periodic(phase)[0] == pytest.approx(exact, abs=1e-15)
        assert form.periodic(phase)[0] == pytest.approx(exact, abs=1e-9)
    sampled = normalize("(p^2 + x^2)/2", 0, PAIR, driven=Driven(0.0213, lambda M: {(1, 0): -math.cos(64 * M) / 1000}))
    assert sampled.periodic(0.03) == pytest.approx(linear.periodic(0.03), abs=1e-15)
    with pytest.raises(andoyer.TheoryError, match="with 1020 harmonics"):
        normalize("(p^2 + x^2)/2", 0, PAIR, driven=Driven(0.0213, lambda M: {(1, 0): 1.0 if math.sin(M) > 0 else -1.0}))
    with pytest.raises(andoyer.Error):
        normalize("(p^2 + x^2)/2", 0, PAIR, driven=Driven(0.0213, lambda M: {(1, 0): 1e308 * math.tan(M)}))


ONE = ("(p^2 + x^2)/2 - x^3/5 + x^4/4 - 0.2*x*cos(M) + 0.05*x^2*p*sin(2*M)", PAIR)
SADDLE = ("x*X + (y^2 + Y^2)/2 + x*y^2/4 - y^3/3 - x*cos(M)/20 + X*y*sin(-2*M)/20", [("x", "X"), ("y", "Y")])
CASES = {"one": ONE, "saddle": SADDLE}


@pytest.fixture(scope="module", params=CASES)
def case(request):
    text, pairs = CASES[request.param]
    form = normalize(text, 3, pairs, driven={"M": (0.37, 0.3)})
    normal = np.array([0.02, -0.03, 0.01, 0.02])[: 2 * len(pairs)]
    return form, normal, form.from_normal(normal, time=1.7)


def test_stored_forms_are_the_form(case):
    form, normal, state = case
    for kept in (DrivenNormalForm.from_json(form.to_json()), pickle.loads(pickle.dumps(form)), copy.copy(form), copy.deepcopy(form)):
        assert kept == form and repr(kept) == repr(form) and str(kept) == str(form)
        assert np.array_equal(kept.from_normal(normal, time=1.7), state)
    text = json.loads(form.to_json())
    assert text["driven"] == [["M", 0.37, 0.3]] and text["order"] == 3
    for key, wrong in (("version", 2), ("order", 61), ("driven", [["M", 0.36, 0.3]]), ("hamiltonian", [[[1], 1.0]]), ("more", 1)):
        with pytest.raises((andoyer.FileError, andoyer.RepresentationError)):
            DrivenNormalForm.from_json(json.dumps(text | {key: wrong}))
    with pytest.raises(andoyer.FileError):
        DrivenNormalForm.from_json("[]")


def test_stored_samples_are_cosines_and_sines():
    form = normalize("(p^2 + x^2)/2", 4, PAIR, driven=Driven(0.37, lambda M: {(1, 0): -0.2 / (2 + math.cos(M)), (4, 0): 0.1 * math.sin(3 * M)}))
    kept = DrivenNormalForm.from_json(form.to_json())
    assert kept.in_actions() == pytest.approx(form.in_actions(), rel=1e-11)
    assert kept.periodic(0.5) == pytest.approx(form.periodic(0.5), abs=1e-13)


@pytest.mark.parametrize("what", ["hamiltonian", "generator", "direct", "inverse"])
def test_latex_is_balanced_and_has_the_phase(case, what):
    text = case[0].to_latex(what)
    assert text.count("{") == text.count("}") and "nan" not in text.lower()
    assert ("\\cos(M)" in text) == (what != "hamiltonian")


def test_code_does_what_the_form_does(case, tmp_path):
    form, normal, state = case
    namespace = {}
    exec(form.to_code("python"), namespace)
    assert namespace["from_normal"](normal, 1.7) == pytest.approx(state, abs=1e-14)
    back = namespace["to_normal"](state, 1.7)
    # The inverse series to order 3 leaves the next order, which the iteration does not.
    assert back == pytest.approx(normal, abs=1e-4)
    actions = namespace["actions"](normal)
    assert actions == pytest.approx(form.actions(state, time=1.7), abs=1e-13)
    assert namespace["frequencies"](actions) == pytest.approx(form.frequency_map(actions), rel=1e-13)
    n = len(normal)
    main = {
        "c": f"#include <stdio.h>\nint main(void) {{ const double normal[{n}] = {{{', '.join(map(repr, normal.tolist()))}}}; double state[{n}], back[{n}];"
        f' from_normal(normal, 1.7, state); to_normal(state, 1.7, back); for (int k = 0; k < {n}; ++k) printf("%.17g %.17g ", state[k], back[k]); return 0; }}\n',
        "rust": f"fn main() {{ let state = from_normal(&[{', '.join(map(repr, normal.tolist()))}], 1.7); let back = to_normal(&state, 1.7);"
        ' assert!(frequencies(&actions(&back))[0] != 0.0); for (a, b) in state.iter().zip(&back) { print!("{a:e} {b:e} "); } }\n',
    }
    compilers = {"c": ["cc", "-std=c99", "-Wall", "-Wextra", "-O0"], "rust": ["rustc", "--edition", "2021"]}
    for language, command in compilers.items():
        source, program = tmp_path / f"form.{language[0]}", tmp_path / f"form_{language}"
        source.write_text(form.to_code(language) + main[language])
        subprocess.run([*command, "-o", program, source, *(["-lm"] if language == "c" else [])], check=True)
        found = [float(part) for part in subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()]
        assert found[::2] == pytest.approx(state, abs=1e-14) and found[1::2] == pytest.approx(back, abs=1e-13), language


def test_domain_says_the_best_order():
    domain = normalize(DUFFING, 8, PAIR, driven={"M": 0.37}).domain()
    assert len(domain.norms) == 8 and domain.best_order(0.01) > domain.best_order(2.0)
