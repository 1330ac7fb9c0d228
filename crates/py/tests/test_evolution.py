"""The motion averaged over the rotation: against integrations of the full equations, and where it ends."""

import numpy as np
import pytest
from polhodes import FAMILIES, MOMENTS, SOURCE, quaternion, random_texts, rotation_to, separatrix, state
from scipy.integrate import solve_ivp

from andoyer import Body, InputError, Orbit, Scene, TabulatedOrbit, TheoryError, Torque


@pytest.mark.parametrize(("axis", "sign"), FAMILIES)
def test_evolution_is_the_integration_to_first_order(axis, sign):
    errors = []
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.1 * separatrix(axis)  # no low resonance is on the way
    start = state(axis, sign, excess, momentum)
    for size in (4e-3, 5e-4):
        texts, _ = random_texts(2, 17 + axis, size)
        torque = Torque.polynomial(texts, sources={"s": SOURCE})
        times = np.linspace(0, 0.2 / size, 9)
        scene = Scene(Body(MOMENTS), *start, torques=[torque], span=(0, times[-1]), tolerance=1e-9)
        truth = scene.solve().angular_momentum(times)
        averaged = scene.evolve().at(times).momentum
        errors.append(np.abs(truth - averaged).max() / size)
        assert np.abs(truth[-1] - truth[0]).max() > 0.02
    # The error is of the order of the torque: over its size it stays the same.
    assert max(errors) < 3
    assert errors[1] < 1.5 * errors[0]


def test_the_plan_predicts_the_error():
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.3 * separatrix(0)
    texts, _ = random_texts(3, 1, 3e-4)
    torque = Torque.polynomial(texts, sources={"s": SOURCE})
    scene = Scene(Body(MOMENTS), *state(0, 1, excess, momentum), torques=[torque], span=(0, 900), tolerance=1e-10)
    evolution, times = scene.evolve(tolerance=1e-10), np.linspace(800, 900, 401)
    difference = (scene.solve().angular_momentum(times) - evolution.at(times).momentum).mean(axis=0)
    plan = evolution.plan
    assert plan.truncation == 0
    assert np.linalg.norm(difference) / np.linalg.norm(momentum) < 3 * plan.error_bound
    assert plan.error_bound < 0.05


def test_evolution_solves_the_averaged_equations():
    # DOP853 of SciPy on the rates of `drift` at ξ and G of the step.
    texts, _ = random_texts(3, 9, 1e-3)
    torque = Torque.polynomial(texts, sources={"s": SOURCE})
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.2 * separatrix(2)

    def slope(_, y):
        drift = Scene(Body(MOMENTS), *state(2, 1, y[3], y[:3]), torques=[torque]).drift()
        return np.append(drift.momentum, drift.excess)

    evolution = Scene(Body(MOMENTS), *state(2, 1, excess, momentum), torques=[torque]).evolve((-100, 300), tolerance=1e-10)
    start = evolution.at(0.0)  # the mean state
    for end in (-100.0, 300.0):
        expected = solve_ivp(slope, (0, end), np.append(start.momentum, start.excess), "DOP853", rtol=1e-9, atol=1e-12).y[:, -1]
        found = evolution.at(end)
        assert np.allclose(found.momentum, expected[:3], rtol=0, atol=1e-8)
        assert found.excess == pytest.approx(expected[3], rel=1e-7)
    assert evolution.at([0.0, 150.0]).momentum.shape == (2, 3)
    assert evolution.end.reason == "span"
    assert evolution.reached == (-100.0, 300.0)


def test_the_band_is_what_the_averages_leave_out():
    texts, _ = random_texts(2, 17, 1e-5)
    torque = Torque.polynomial(texts, sources={"s": SOURCE})
    for part in (1e-6, 0.3):
        start = state(2, 1, part * separatrix(2), np.array([0.3, -0.4, 0.85]))
        scene = Scene(Body(MOMENTS), *start, torques=[torque], span=(0, 1500), tolerance=1e-10)
        times = np.linspace(0, 1500, 1501)
        evolution = scene.evolve(tolerance=1e-10)
        difference = scene.solve().angular_momentum(times) - evolution.at(times).momentum
        left = np.sqrt((difference**2).sum(axis=1).mean()) / np.linalg.norm([0.3, -0.4, 0.85])
        assert evolution.at([0.0]).band[0, 0] == pytest.approx(left, rel=0.2)
        # The epoch is corrected by phase: without it the mean difference would be of the order of the band.
        assert np.abs(difference.mean(axis=0)).max() < 0.1 * left


def test_it_ends_at_the_separatrix():
    momentum, excess = np.array([0.0, 0.0, 1.0]), 0.5 * separatrix(2)
    # Damping about the short axis alone moves the energy up.
    scene = Scene(Body(MOMENTS), *state(2, 1, excess, momentum), torques=[Torque.damping([0, 0, 1e-4])])
    evolution = scene.evolve((0, 1e6))
    assert evolution.end.reason == "separatrix"
    at = evolution.at([0, evolution.end.time])
    assert at.excess[-1] == pytest.approx(separatrix(2), rel=2e-6)
    assert at.mode == "short-axis"
    with pytest.raises(ValueError, match="times"):
        evolution.at(1.01 * evolution.end.time)
    full = Scene(
        Body(MOMENTS), *state(2, 1, excess, momentum), torques=[Torque.damping([0, 0, 1e-4])], span=(0, 1.3 * evolution.end.time), tolerance=1e-6
    ).solve()
    times = np.linspace(0, 1.3 * evolution.end.time, 4000)
    g2 = (full.angular_velocity(times) * MOMENTS) ** 2
    outside = g2 @ (1 / MOMENTS * MOMENTS[2] - 1) / g2.sum(axis=1) > separatrix(2)
    assert times[np.argmax(outside)] == pytest.approx(evolution.end.time, rel=0.02)


def test_it_ends_where_the_rotation_is_slow():
    # A constant torque against the rotation stops it in time M/N.
    start = [0, 0, 0, 1], [0, 0, 1.0]
    evolution = Scene(Body(MOMENTS), *start, torques=[Torque.constant([0, 0, -1e-4])]).evolve((0, 2e4))
    assert evolution.end.reason == "slow rotation"
    assert 0.8e4 < evolution.end.time < 1e4
    last = evolution.at(evolution.end.time)
    assert last.momentum[2] == pytest.approx(1 - 1e-4 * evolution.end.time)
    assert last.spin_period == pytest.approx(2 * np.pi / last.momentum[2])


def test_periods_are_those_of_the_free_motion():
    for axis, sign in FAMILIES:
        scene = Scene(Body(MOMENTS), *state(axis, sign, 0.4 * separatrix(axis), np.array([0.3, -0.4, 0.85])))
        free = scene.solve().periods
        now = scene.evolve((0, 1)).at(0.0).periods
        for convention, pair in free.items():
            assert now[convention].precession == pytest.approx(pair.precession, rel=1e-10)
            assert now[convention].rotation == pytest.approx(pair.rotation, rel=1e-12)


def test_obliquity_and_period_have_the_rates_of_drift():
    orbit = Orbit(2e-9, 0.1, inclination=0.5)
    plates = [[0.2, 0.1, 1], [1, 0.3, -0.2]], [2.0, 1.0], [[1, 0.2, 0.1], [-0.3, 1, 0.2]]
    torque = Torque.panels(*plates, specular=0.3, pressure=1e-7, source=orbit)
    scene = Scene(Body(MOMENTS), *state(2, 1, 0.2 * separatrix(2), np.array([0.3, -0.4, 0.85])), torques=[torque])
    drift, step = scene.drift(average="orbit"), 10.0
    ends = scene.evolve((-step, step), average="orbit", tolerance=1e-12).at([-step, step])
    for name in ("obliquity", "spin_period", "excess"):
        low, high = getattr(ends, name)
        assert (high - low) / 2 / step == pytest.approx(getattr(drift, name), rel=1e-4)
    assert ends.obliquity.shape == (2,)


@pytest.mark.filterwarnings("ignore:the error of the angular momentum may reach")  # of the polynomials, over ten years
def test_years_of_a_satellite():
    # The invented satellite of the theory's measurements: a Python program of its own (DOP853, degree 8, 1e-8) reaches the separatrix after 7.684 years.
    size, walls = np.array([2.3, 2.0, 1.9]), np.vstack([np.eye(3), -np.eye(3)])
    array, trim = np.array([0, 0.3, 1]), np.array([0.1, -0.4, 1])
    places = [*(walls * size / 2 + [0.1, 0, 0]), [4.2, 0.1, 0.2], [4.2, 0.1, 0.2], [-14, 0, 0.3], [-14, 0, 0.3]]
    areas = [*np.tile([size[1] * size[2], size[0] * size[2], size[0] * size[1]], 2), 11, 11, 1.2, 1.2]
    finish = {"specular": [0.25] * 6 + [0.15, 0.05, 0.6, 0.2], "diffuse": [0.15] * 6 + [0.05, 0.5, 0.1, 0.3]}
    moments, year = np.array([980.0, 3430.0, 3570.0]), 3.156e7
    sun = Orbit(2 * np.pi / year, inclination=np.radians(23.44))
    light = Torque.panels([*walls, array, -array, trim, -trim], areas, places, **finish, pressure=4.56e-6, source=sun)
    assert light.truncation == pytest.approx(0.019, abs=0.002)
    momentum = 3570 * 2 * np.pi / 300 * np.array([0.1, -0.3, 0.95])
    excess = 0.4 * (1 - 980 / 3430)
    g = np.array([np.sqrt(1 - excess / (1 - 980 / 3570)), 0, np.sqrt(excess / (1 - 980 / 3570))])
    k = momentum / np.linalg.norm(momentum)
    rates = np.linalg.norm(momentum) * g / moments
    evolution = Scene(Body(moments), quaternion(rotation_to(k, g)), rates, torques=[light]).evolve((0, 10 * year), tolerance=1e-8)
    assert evolution.average == "spin"
    assert evolution.end.reason == "separatrix"
    assert evolution.end.time / year == pytest.approx(7.684, rel=0.01)
    before = evolution.at(7.65 * year)
    assert np.linalg.norm(before.momentum) == pytest.approx(23.0, rel=0.02)


def test_a_table_of_places_is_followed():
    orbit = Orbit(1e-3, 0.1, semi_major_axis=2.0)
    times = np.linspace(-100, 7000, 500)
    table = TabulatedOrbit(times, [orbit.position(time) for time in times], 8e-6)
    start = state(2, 1, 0.2 * separatrix(2), np.array([0.3, -0.4, 0.85]))
    texts, _ = random_texts(2, 4, 1e-4)
    ends = []
    for source in (orbit, table):
        torque = Torque.polynomial(texts, sources={"s": source}, distance_powers={"s": 2}, reference_distances={"s": 2.0})
        ends.append(Scene(Body(MOMENTS), *start, torques=[torque]).evolve((0, 6500), average="spin", tolerance=1e-9).at(6500.0).momentum)
    assert np.allclose(*ends, rtol=0, atol=1e-6)


def test_refusals():
    body, weak = Body(MOMENTS), Torque.constant([0, 0, 1e-9])
    with pytest.raises(InputError, match="span"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[weak]).evolve()
    with pytest.raises(InputError, match="span"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[weak]).evolve((2, 1))
    with pytest.raises(InputError, match="average"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[weak]).evolve((0, 1), average="day")
    with pytest.raises(InputError, match="tolerance"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[weak]).evolve((0, 1), tolerance=0)
    with pytest.raises(InputError, match="rotor"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[Torque.rotor([0, 0, 0.1])]).evolve((0, 1))
    two = Torque.polynomial(["1e-6*a1*b2", "0", "0"], sources={"a": [1, 0, 0], "b": [0, 1, 0]})
    with pytest.raises(InputError, match="the direction or the distance of one source in each term"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[two]).evolve((0, 1))
    for rates in ([0, 1, 0], [0, 0, 0]):
        with pytest.raises(TheoryError, match="no average"):
            Scene(body, [0, 0, 0, 1], rates, torques=[weak]).evolve((0, 1))
    with pytest.raises(TheoryError, match="momentum times the rate of the rotation"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[Torque.constant([0, 0, 0.2])]).drift()
    near = Body([1 - 1e-6, 1, 1 + 1e-6])
    with pytest.raises(TheoryError, match="nearly a sphere"):
        Scene(near, [0, 0, 0, 1], [0, 0, 1], torques=[Torque.constant([0, 0, 1e-4])]).drift()
    with pytest.raises(TheoryError, match="rate of the direction to a source"):
        fast = Torque.polynomial(["0", "0", "1e-9*s1"], sources={"s": Orbit(0.3)})
        Scene(body, [0, 0, 0, 1], [0, 0, 1], torques=[fast]).drift()
    with pytest.raises(InputError, match=r"Scene\.evolve"):
        Scene(body, [0, 0, 0, 1], [0, 0, 1], method="averaged")


@pytest.mark.parametrize(("moment", "rate"), [(1e15, 1.0), (1e-12, 1.0), (1e15, 1e-4), (1.0, 1e6)])
def test_units_change_nothing(moment, rate):
    def evolved(moment, rate):
        light = Torque.panels(
            [[1, 0, 0], [0, 0.8, 0.6]],
            [1.0, 2.0],
            [[0.1, 0.5, 0.3], [0.4, -0.2, 0.3]],
            pressure=1e-4 * moment * rate**2,
            source=SOURCE,
            degree=4,
            two_sided=True,
        )
        scene = Scene(Body(moment * np.array(MOMENTS)), [0, 0, 0, 1], rate * np.array([0.1, 0.2, 1.0]), torques=[light])
        evolution = scene.evolve((0, 1000 / rate))
        at = evolution.at(np.array([0.0, 300, 900]) / rate)
        plan = evolution.plan
        return at.momentum / moment / rate, at.excess, at.band, np.array(plan.second_order) / rate, plan.error_bound

    momentum, excess, band, second_order, bound = evolved(1.0, 1.0)
    others = evolved(moment, rate)
    assert band[0].min() > 1e-5
    for found, expected, tolerance in zip(others, (momentum, excess, band, second_order, bound), (1e-9, 1e-9, 1e-6, 1e-2, 1e-2), strict=True):
        assert np.allclose(found, expected, rtol=tolerance, atol=0 if np.ndim(expected) else 1e-9)
