"""Normal forms about a periodic motion: Hill's equation, integrations, samples, and what is refused."""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import andoyer
from andoyer import Driven, normalize

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
    assert form.driven == {"a": 1.0, "b": 0.7} and form.kinds == ("elliptic",)


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
        ("(p^2 + x^2)/2 + x^3*cos(3*M)", {}, "small divisor"),
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
    with pytest.raises(andoyer.InputError, match="state"):
        form.trajectory([0.0], [1.0])
    assert repr(form) == f"<DrivenNormalForm of order 2 with M, {form.times} times>"
