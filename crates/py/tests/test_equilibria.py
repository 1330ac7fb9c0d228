"""Normal forms at L1, L2 and L4, of saddles, detunings and resonances: published values and integrations of the full equations."""

import copy
import json
import math
import pickle
import subprocess

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp

import andoyer
from andoyer import BirkhoffNormalForm, normalize

MU = 0.012150585609624
PLANE = [("x", "X"), ("y", "Y")]
SPACE = [*PLANE, ("z", "Z")]


def legendre(direction, highest):
    """ρⁿ P_n((a·r)/ρ) in x, y, z as dictionaries of coefficients by exponents."""
    along = {tuple(int(i == k) for i in range(3)): c for k, c in enumerate(direction) if c}
    square = {tuple(2 * int(i == k) for i in range(3)): 1.0 for k in range(3)}

    def product(a, b):
        result = {}
        for m, c in a.items():
            for n, d in b.items():
                key = tuple(i + j for i, j in zip(m, n, strict=True))
                result[key] = result.get(key, 0.0) + c * d
        return result

    terms = [{(0, 0, 0): 1.0}, along]
    for n in range(2, highest + 1):
        first, second = product(along, terms[-1]), product(square, terms[-2])
        terms.append({m: ((2 * n - 1) * first.get(m, 0.0) - (n - 1) * second.get(m, 0.0)) / n for m in first | second})
    return terms


def hamiltonian(attractions, highest):
    """(X² + Y² + Z²)/2 + y X − x Y − Σ m/|r − d a| about a point in the rotating frame, without constant and linear terms."""
    terms = {(0, 2, 0, 0, 0, 0): 0.5, (0, 0, 0, 2, 0, 0): 0.5, (0, 0, 0, 0, 0, 2): 0.5, (0, 1, 1, 0, 0, 0): 1.0, (1, 0, 0, 1, 0, 0): -1.0}
    for mass, direction, distance in attractions:
        for n, part in enumerate(legendre(direction, highest)):
            for (i, j, k), c in part.items() if n > 1 else ():
                key = (i, 0, j, 0, k, 0)
                terms[key] = terms.get(key, 0.0) - mass * c / distance ** (n + 1)
    return terms


def collinear(highest, second=False, mu=MU):
    """About L1 or L2 in units of the distance to the smaller body; x points to it from L1 and away from the larger one from L2."""
    sign = 1 if second else -1
    roots = np.roots([1, sign * (3 - mu), 3 - 2 * mu, -mu, -2 * sign * mu, -mu])
    gamma = float(min(root.real for root in roots if abs(root.imag) < 1e-12 and root.real > 0))
    near = (-1.0, 0.0, 0.0) if second else (1.0, 0.0, 0.0)
    attractions = [(mu / gamma**3, near, 1.0), ((1 - mu) / gamma**3, (-1.0, 0.0, 0.0), (1 + sign * gamma) / gamma)]
    return hamiltonian(attractions, highest), attractions


def equations(attractions):
    """Rates of x, X, y, Y, z, Z in the full problem, whose constant forces cancel."""

    def rates(_, state):
        x, px, y, py, z, pz = state
        force = np.zeros(3)
        for mass, direction, distance in attractions:
            apart = np.array([x, y, z]) - distance * np.array(direction)
            force -= mass * (apart / np.linalg.norm(apart) ** 3 + np.array(direction) / distance**2)
        return [px + y, py + force[0], py - x, -px + force[1], pz, force[2]]

    return rates


@pytest.mark.parametrize("second", [False, True])
def test_orbits_on_the_centre_manifold_stay_there_longer_with_every_order(second):
    # The action q p of the saddle is zero on the manifold; the error of the start grows by e^{2.9 t} on the way, to e^9 = 8000 times at t = 3.
    centre = [0.06, 0.0, 0.05, 0.04]
    drifts = []
    for order in (2, 4, 6):
        terms, attractions = collinear(order + 2, second)
        form = normalize(terms, order, SPACE, keep="hyperbolic")
        assert form.kinds == ("hyperbolic", "elliptic", "elliptic")
        start = form.from_centre_manifold(centre)
        orbit = solve_ivp(equations(attractions), (0.0, 2.0), start, method="DOP853", rtol=1e-13, atol=1e-15, t_eval=np.linspace(0, 2, 21))
        normal = form.to_normal(orbit.y.T)
        energies = form.energy(normal)[:, 0]
        drifts.append((np.abs(normal[:, :2]).max(), np.ptp(energies)))
    saddle, energy = np.array(drifts).T
    assert all(saddle[1:] < 0.5 * saddle[:-1]) and saddle[-1] < 0.05 * saddle[0], drifts
    assert all(energy[1:] < 0.5 * energy[:-1]) and energy[-1] < 0.05 * energy[0], drifts


def test_restricted_hamiltonian_of_the_centre_manifold_has_no_saddle_and_its_value_is_the_energy():
    form = normalize(collinear(6)[0], 4, SPACE, keep="hyperbolic")
    reduced = form.centre_manifold()
    assert all(exponents[:2] == (0, 0) for exponents in reduced)
    centre = np.array([0.1, -0.05, 0.03, 0.08])
    value = sum(c * math.prod(v**e for v, e in zip(centre, exponents[2:], strict=True)) for exponents, c in reduced.items())
    assert form.energy([0.0, 0.0, *centre])[0] == pytest.approx(value, rel=1e-13)
    with pytest.raises(andoyer.InputError, match='it must be "hyperbolic"'):
        normalize("x*X", 2, [("x", "X")], keep="elliptic")


def test_triangular_point_moves_as_the_full_equations():
    height = math.sqrt(0.75)
    attractions = [(1 - MU, (-0.5, -height, 0.0), 1.0), (MU, (0.5, -height, 0.0), 1.0)]
    start = np.array([0.003, 0.001, -0.002, 0.002, 0.002, -0.001])
    times = np.linspace(0, 30, 31)
    truth = solve_ivp(equations(attractions), (0, 30), start, method="DOP853", rtol=1e-13, atol=1e-15, t_eval=times).y.T
    errors = []
    for order in (0, 2, 4):
        form = normalize(hamiltonian(attractions, order + 2), order, SPACE)
        errors.append(np.abs(form.trajectory(start, times) - truth).max())
    assert form.frequencies[0] > 0 > form.frequencies[1] and form.frequencies[2] == pytest.approx(1.0, rel=1e-15)
    assert errors[1] < 0.2 * errors[0] and errors[2] < 0.2 * errors[1], errors


def integrated(rates, start, times):
    return solve_ivp(rates, (0, times[-1]), start, method="DOP853", rtol=1e-13, atol=1e-16, t_eval=times).y.T


def test_henon_heiles_in_resonance_moves_as_its_equations():
    text = "(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3"
    times, start = np.linspace(0, 60, 13), np.array([0.04, 0.0, 0.01, 0.03])
    truth = integrated(lambda _, s: [s[1], -s[0] - 2 * s[0] * s[2], s[3], -s[2] - s[0] ** 2 + s[2] ** 2], start, times)
    errors = [np.abs(normalize(text, order, PLANE, resonances=[(1, -1)]).trajectory(start, times) - truth).max() for order in (1, 3, 5)]
    assert errors[1] < 0.1 * errors[0] and errors[2] < 0.1 * errors[1], errors
    form = normalize(text, 5, PLANE, resonances=[(1, -1)])
    assert form.resonances == ((1, -1),)
    # Both ways, in any order of the times, and a single one.
    forward = form.trajectory(start, [5.0, -3.0, 0.0])
    assert np.allclose(form.trajectory(forward[1], 3.0), start, atol=1e-7) and np.allclose(forward[2], start, atol=1e-7)
    assert np.allclose(form.trajectory(start, 5.0), forward[0], atol=1e-12)


def test_elastic_pendulum_with_a_detuning_moves_as_its_equations():
    # Frequencies 1 and 2 + d near the 2:1 resonance; the detuning is a letter until the motion is asked for.
    text = "(x^2 + X^2)/2 + (2 + d)*(y^2 + Y^2)/2 + x^2*y"
    d, times, start = 0.004, np.linspace(0, 60, 13), np.array([0.03, 0.0, 0.01, 0.02])
    truth = integrated(lambda _, s: [s[1], -s[0] - 2 * s[0] * s[2], (2 + d) * s[3], -(2 + d) * s[2] - s[0] ** 2], start, times)
    errors = []
    for order in (1, 3, 5):
        form = normalize(text, order, PLANE, parameters=["d"], resonances=[(2, -1)])
        errors.append(np.abs(form.trajectory(start, times, {"d": d}) - truth).max())
    assert errors[1] < 0.1 * errors[0] and errors[2] < 0.2 * errors[1], errors
    assert any(exponents[4] for exponents in form.in_real())
    plain = normalize("(x^2 + X^2)/2 + (2 + 0.004)*(y^2 + Y^2)/2 + x^2*y", 5, PLANE, resonances=[(2, -1)], smallest_divisor=0.01)
    assert np.allclose(plain.trajectory(start, times), form.trajectory(start, times, {"d": d}), atol=2e-7)


def test_letter_as_a_frequency_is_refused_with_what_to_do():
    with pytest.raises(andoyer.InputError, match=r"in the term 1/2\*x\^2\*w\^2: write the parameter as a number and a detuning"):
        normalize("X^2/2 + w^2*x^2/2 + x^4", 2, [("x", "X")], parameters=["w"])
    # Detuning: w = 2 + d, and the series in d that it is.
    form = normalize("X^2/2 + (2 + d)^2*x^2/2 + x^4", 6, [("x", "X")], parameters=["d"], degrees={"d": 1})
    assert form.in_actions()[1, 1] == 1 and form.in_actions()[1, 0] == 2
    # K = w I + (3/2) I²/w² + …: (3/2)/(2 + d)² = 3/8 − 3/8 d + …
    assert form.in_actions()[2, 0] == pytest.approx(3 / 8) and form.in_actions()[2, 1] == pytest.approx(-3 / 8)
    with pytest.raises(andoyer.InputError, match='degrees: "e" is not a parameter'):
        normalize("x^2 + X^2", 2, [("x", "X")], parameters=["d"], degrees={"e": 1})


def test_coupled_oscillators_need_no_eigenvectors():
    chain = normalize("(X^2 + Y^2)/2 + x^2 - x*y + y^2 + x^4/4", 2, PLANE)
    assert not chain.exact and sorted(chain.frequencies) == pytest.approx([1.0, math.sqrt(3)], rel=1e-15)
    exact = normalize("(X^2 + Y^2)/2 + (5*x^2 - 6*x*y + 5*y^2)/4 + x^4/4", 2, PLANE)
    assert exact.exact and exact.frequencies == (2, 1)
    m = sympy.Matrix(exact.linear_change)
    J = sympy.diag(sympy.Matrix([[0, 1], [-1, 0]]), sympy.Matrix([[0, 1], [-1, 0]]))
    assert m.T * J * m == J


@pytest.mark.parametrize(
    "hamiltonian, error, message",
    [
        ("x^2 + X^2 + Y^2", andoyer.TheoryError, r"in \(y, Y\) has a zero frequency, along the direction with the components y 1.000"),
        ("x*X + y*Y + x*Y", andoyer.TheoryError, r"eigenvalues ±1.000000000 have a Jordan block, with the eigenvector of components y 1.000"),
        ("x^2 + X^2 + y - cos(y)", andoyer.InputError, r'"cos" is a function.*expand it as a Taylor polynomial, for a normal form of order N to degree N \+ 2'),
        ("0.5(x^2 + X^2)", andoyer.InputError, r"a factor in brackets needs \*"),
    ],
)
def test_what_has_no_normal_form_is_refused_by_name(hamiltonian, error, message):
    with pytest.raises(error, match=message):
        normalize(hamiltonian, 2, PLANE)


FORMS = {
    "exact": lambda: normalize("(x^2 + X^2)/2 + 5/4*(y^2 + Y^2) + c*x^2*y^2 + x^2*y", 2, PLANE, parameters=["c"]),
    "resonant": lambda: normalize("(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3", 4, PLANE, resonances=[(1, -1)]),
    "manifold": lambda: normalize(collinear(5)[0], 3, SPACE, keep="hyperbolic"),
}


@pytest.mark.parametrize("name", FORMS)
def test_a_form_is_kept_as_json_and_by_pickle(name):
    form = FORMS[name]()
    text = form.to_json()
    assert json.loads(text)["version"] == 1
    for kept in (BirkhoffNormalForm.from_json(text), pickle.loads(pickle.dumps(form)), copy.deepcopy(form)):
        assert kept == form and kept.in_complex() == form.in_complex() and kept.frequencies == form.frequencies
    with pytest.raises(andoyer.FileError):
        BirkhoffNormalForm.from_json(text.replace('"version":1', '"version":9'))


def test_python_code_does_what_the_form_does():
    form = FORMS["exact"]()
    namespace = {}
    exec(form.to_code("python"), namespace)
    state, values = [0.05, 0.02, -0.03, 0.04], {"c": 0.7}
    normal = namespace["to_normal"](state, [0.7])
    assert normal == pytest.approx(list(form.to_normal(state, values)), rel=1e-14)
    assert namespace["from_normal"](normal, [0.7]) == pytest.approx(list(form.from_normal(normal, values)), rel=1e-14)
    assert namespace["actions"](normal) == pytest.approx(list(form.actions(state, values)), rel=1e-14)
    rates = namespace["frequencies"]([0.01, 0.02], [0.7])
    assert rates == pytest.approx(list(form.frequency_map([0.01, 0.02], values)), rel=1e-15)
    manifold, namespace = FORMS["manifold"](), {}
    exec(manifold.to_code("python"), namespace)
    state = [0.02, 0.01, -0.01, 0.02, 0.03, 0.01]
    normal = namespace["to_normal"](state)
    assert normal == pytest.approx(list(manifold.to_normal(state)), rel=1e-12)
    assert namespace["from_normal"](normal) == pytest.approx(list(manifold.from_normal(normal)), rel=1e-12)
    assert "frequencies" not in namespace


def test_c_code_compiles_without_a_warning_and_does_what_the_form_does(tmp_path):
    form = FORMS["manifold"]()
    main = """
#include <stdio.h>
int main(void) {
    const double state[6] = {0.02, 0.01, -0.01, 0.02, 0.03, 0.01};
    double normal[6];
    to_normal(state, normal);
    for (int i = 0; i < 6; i++) printf("%.17g\\n", normal[i]);
    return 0;
}
"""
    source, program = tmp_path / "form.c", tmp_path / "form"
    source.write_text(form.to_code("c") + main)
    subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-o", program, source], check=True)
    found = [float(line) for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()]
    assert found == pytest.approx(list(form.to_normal([0.02, 0.01, -0.01, 0.02, 0.03, 0.01])), rel=1e-12)


def test_latex_has_the_names_and_exact_numbers():
    duffing = normalize("(p^2 + q1^2)/2 + epsilon*q1^4/4", 2, [("q1", "p")], parameters=["epsilon"])
    assert "K &= I_{q1} + \\frac{3}{8}I_{q1}^{2}\\epsilon{}" in duffing.to_latex()
    assert "{q_{1}'}^{3}" in duffing.to_latex("direct") and "S_{2} &=" in duffing.to_latex("generator")
    with pytest.raises(andoyer.InputError, match="lagrangian"):
        duffing.to_latex("lagrangian")


def test_sympy_gives_the_caller_s_symbols_back():
    x, p = sympy.symbols("x p", real=True)
    c = sympy.Symbol("c", positive=True)
    form = normalize((x**2 + p**2) / 2 + c * x**4 / 4, 2, [(x, p)], parameters=[c])
    for kept in (form, pickle.loads(pickle.dumps(form))):
        assert c in kept.to_sympy().free_symbols and {x, p, c} == kept.to_sympy("direct")["x"].free_symbols
    by_name = normalize("(x^2 + p^2)/2 + c*x^4/4", 2, [("x", "p")], parameters=["c"])
    assert sympy.Symbol("c") in by_name.to_sympy().free_symbols and by_name == form
    # The expression's symbols count where the variables are names.
    mixed = normalize((x**2 + p**2) / 2 + c * x**4 / 4, 2, [("x", "p")], parameters=["c"])
    assert c in mixed.to_sympy().free_symbols


def test_domain_shrinks_with_the_order_and_the_actions_drift_as_it_says():
    form = normalize("(x^2 + X^2)/2 + sqrt2*(y^2 + Y^2)/2 + x^2*y - y^3/3".replace("sqrt2", "1.4142135623730951"), 12, PLANE, exact=False)
    domain = form.domain()
    assert len(domain.norms) == 12 and len(domain.radii) == 10 and domain.radii[-1] < domain.radii[1]
    assert domain.best_order(0.01) == 12 and domain.best_order(2.0) < 4
    assert str(domain).splitlines()[0].split() == ["order", "norm", "radius"] and len(str(domain).splitlines()) == 13
    # The drift of the formal integrals along an integrated orbit: small amplitudes gain from every order, large ones are beyond the range of high orders.
    w, drift = 1.4142135623730951, {}
    for amplitude in (0.05, 0.4):
        start = np.array([amplitude, 0.0, 0.0, amplitude])
        orbit = integrated(lambda _, s: [s[1], -s[0] - 2 * s[0] * s[2], w * s[3], -w * s[2] - s[0] ** 2 + s[2] ** 2], start, np.linspace(0, 50, 101))
        for order in (1, 3, 8, 12):
            lower = normalize("(x^2 + X^2)/2 + 1.4142135623730951*(y^2 + Y^2)/2 + x^2*y - y^3/3", order, PLANE, exact=False)
            if amplitude == 0.4:
                with pytest.raises(andoyer.TheoryError, match="beyond the range"):
                    lower.actions(orbit)
                continue
            drift[amplitude, order] = np.ptp(lower.actions(orbit), axis=0).max()
    assert drift[0.05, 1] > 100 * drift[0.05, 3] > 1e4 * drift[0.05, 8] > 1e6 * drift[0.05, 12], drift
    assert domain.best_order(0.4) < 4
    with pytest.raises(andoyer.InputError, match="amplitude"):
        domain.best_order(-1.0)


def test_picture_of_the_domain_has_a_line_for_each_amplitude():
    pytest.importorskip("matplotlib").use("Agg")
    from andoyer import plot

    axes = plot.domain(normalize("(x^2 + X^2)/2 - x^3/3", 8, [("x", "X")]), amplitudes=(0.1, 0.5, 1.0))
    assert len(axes.get_lines()) >= 3 and "order" in axes.get_xlabel()


@pytest.mark.parametrize("states", [[], np.zeros((3, 0))])
def test_a_form_without_a_centre_has_no_centre_manifold(states):
    saddle = normalize("2*x*X + x**2*X**2", 2, [("x", "X")], keep="hyperbolic")
    with pytest.raises(andoyer.InputError, match="form without a centre") as refused:
        saddle.from_centre_manifold(states)
    assert (refused.value.argument, refused.value.value) == ("states", 0)
