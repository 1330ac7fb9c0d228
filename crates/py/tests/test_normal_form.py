"""The normal form from Python: exact values of theory §4, bad orders, progress, text formats."""

import json
import math
from fractions import Fraction as F

import pytest

import andoyer
from andoyer import NormalForm

# P_0 … P_9 of theory §4 as {power of β: coefficient}.
TRIAXIALITY = [
    {0: F(2)},
    {0: F(-1)},
    {2: F(-1, 2)},
    {2: F(-5, 8)},
    {2: F(-3, 4), 4: F(-9, 32)},
    {2: F(-7, 8), 4: F(-35, 32)},
    {2: F(-1), 4: F(-354, 128), 6: F(-45, 128)},
    {2: F(-9, 8), 4: F(-9 * 650, 1024), 6: F(-9 * 265, 1024)},
    {2: F(-5, 4), 4: F(-5 * 17120, 8192), 6: F(-5 * 14888, 8192), 8: F(-5 * 953, 8192)},
    {2: F(-11, 8), 4: F(-11 * 13104, 8192), 6: F(-11 * 20212, 8192), 8: F(-11 * 4075, 8192)},
]


@pytest.fixture(scope="module")
def normal_form():
    return NormalForm(9)


def test_triaxiality_polynomials_are_those_of_the_theory(normal_form):
    assert [normal_form.triaxiality_polynomial(n) for n in range(10)] == TRIAXIALITY
    assert all(list(p) == sorted(p) for p in map(normal_form.triaxiality_polynomial, range(10)))


def test_paper_polynomials_are_turned_by_minus_i(normal_form):
    for n in range(10):
        turn = (-1j) ** (n + 1)
        expected = {l: (int(turn.real) * c, int(turn.imag) * c) for l, c in TRIAXIALITY[n].items()}
        assert normal_form.paper_polynomial(n) == expected


def test_generating_function_is_that_of_the_theory(normal_form):
    # S_1 = β (u²+U²) uU/8, S_2 = −(i/4) β (u²+U²) u²U²
    assert normal_form.generator(1) == {(1, 3, 1): (F(1, 8), F(0)), (3, 1, 1): (F(1, 8), F(0))}
    assert normal_form.generator(2) == {(2, 4, 1): (F(0), F(-1, 4)), (4, 2, 1): (F(0), F(-1, 4))}


def test_transformations_of_first_order_are_brackets_with_the_generating_function(normal_form):
    # {u; S_1} = ∂S_1/∂U, {U; S_1} = −∂S_1/∂u, {y; S_1} = −S_1/M (theory §6)
    assert normal_form.direct("u", 1) == {(1, 2, 1): (F(3, 8), F(0)), (3, 0, 1): (F(1, 8), F(0))}
    assert normal_form.direct("U", 1) == {(0, 3, 1): (F(-1, 8), F(0)), (2, 1, 1): (F(-3, 8), F(0))}
    assert normal_form.direct("y", 1) == {(1, 3, 1): (F(-1, 8), F(0)), (3, 1, 1): (F(-1, 8), F(0))}
    for name in ["u", "U", "y"]:
        direct, inverse = normal_form.direct(name, 1), normal_form.inverse(name, 1)
        assert inverse == {key: (-re, -im) for key, (re, im) in direct.items()}


@pytest.mark.parametrize("order", [-1, 10**30, 16382, 2.5, "10", None, math.nan, pytest.param(-(10**5000), id="too long to print")])
def test_order_that_is_none_is_refused(order):
    large = isinstance(order, int) and order > 0
    with pytest.raises(andoyer.RepresentationError if large else andoyer.InputError, match="order"):
        NormalForm(order)


def test_order_outside_what_was_computed_is_refused(normal_form):
    for method, first in [("triaxiality_polynomial", 0), ("paper_polynomial", 0), ("generator", 1)]:
        for n in [first - 1, 10, -5, 1.5]:
            with pytest.raises(andoyer.InputError):
                getattr(normal_form, method)(n)
    for method in ["direct", "inverse"]:
        for n in [0, 10, -1]:
            with pytest.raises(andoyer.InputError):
                getattr(normal_form, method)("u", n)
        with pytest.raises(andoyer.InputError, match='"x"'):
            getattr(normal_form, method)("x", 1)


def test_progress_hears_of_every_order_once():
    told = []
    assert NormalForm(6, progress=lambda *done: told.append(done)) == NormalForm(6)
    assert told == [(done, 6) for done in range(7)]


def test_exception_in_progress_stops_the_work():
    told = []

    def progress(done, of):
        told.append(done)
        if done == 3:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        NormalForm(40, progress=progress)
    assert told == [0, 1, 2, 3]


def test_progress_that_cannot_be_called_is_a_type_error():
    with pytest.raises(TypeError):
        NormalForm(2, progress=3)


def test_order_zero_is_the_main_problem():
    assert NormalForm(0).triaxiality_polynomial(0) == {0: 2}


def test_json_is_exact_and_read_back(normal_form):
    text = normal_form.to_json()
    assert json.loads(text)["order"] == 9
    assert NormalForm.from_json(text) == normal_form
    assert NormalForm.from_json(text).inverse("y", 5) == normal_form.inverse("y", 5)


def test_text_that_is_no_normal_form_is_refused(normal_form):
    document = json.loads(normal_form.to_json())
    spoilt = [document | {"version": 99}, document | {"order": 8}, document | {"format": "other"}, [], {}]
    for text in ["", "{", *map(json.dumps, spoilt)]:
        with pytest.raises(andoyer.FileError):
            NormalForm.from_json(text)


def test_json_with_another_coefficient_is_refused_with_its_order(normal_form):
    document = json.loads(normal_form.to_json())
    document["triaxiality"][2] = [[2, "-3/4"]]
    with pytest.raises(andoyer.FileError, match="triaxiality polynomial of order 2 has the coefficient -3/4.*must be -1/2"):
        NormalForm.from_json(json.dumps(document))
    document = json.loads(normal_form.to_json())
    for term in document["generators"][4]:
        term[3], term[4] = (text if text == "0" else f"-{text}".replace("--", "") for text in term[3:])
    with pytest.raises(andoyer.FileError, match="generating function of order 5"):
        NormalForm.from_json(json.dumps(document))


def test_latex_has_the_parts_and_no_others(normal_form):
    assert r"P_{3} &= -\frac{5}{8}\beta^{2}" in normal_form.to_latex()
    assert len({NormalForm(2).to_latex(what) for what in ["hamiltonian", "generator", "direct", "inverse"]}) == 4
    with pytest.raises(andoyer.InputError, match="lagrangian"):
        normal_form.to_latex("lagrangian")


def test_equality_hash_and_repr_are_those_of_a_value(normal_form):
    other = NormalForm(9)
    assert other == normal_form and hash(other) == hash(normal_form) and other != NormalForm(8)
    assert repr(normal_form) == "NormalForm(order=9)" and normal_form.order == 9


def test_separatrix_action_is_that_of_the_table():
    table = {0: 1, 0.01: 0.91012, 0.1: 0.71956, 0.3: 0.52451, 0.5: 0.39183, 0.8: 0.21635, 0.95: 0.10238, 1: 0}
    for beta, action in table.items():
        assert andoyer.separatrix_action(beta) == pytest.approx(action, abs=5.1e-6)
    for beta in [-0.1, 1.1, math.nan]:
        with pytest.raises(andoyer.InputError, match="beta"):
            andoyer.separatrix_action(beta)
