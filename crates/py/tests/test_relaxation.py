"""The relaxation of a tumbler: times, ages, their reverse, published facts, and what is refused."""

import copy
import math
import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_dissipation import SHAPES, dissipation, scene

import andoyer

YEAR = 365.25 * 86400.0
# (long, 1e-4) to (short, 1e-4); (long, 0.01) to the separatrix; from there to (short, 0.01).
TIMES = [
    ("mild", 0.25, "quality", (98.8200324088, 15.2838805003, 36.2117005018)),
    ("mild", 0.5, "viscosity", (52.5231569847, 10.8493693257, 16.8934962600)),
    ("long", 0.25, "quality", (199.099118842, 47.5122278777, 73.0474797897)),
    ("long", 0.5, "viscosity", (136.198321084, 59.9823372063, 23.8953088231)),
]


def angle(x):
    return math.asin(math.sqrt(x))


@pytest.mark.parametrize("row", TIMES)
def test_times_are_those_of_the_table(row):
    shape, poisson, loss, (whole, before, after) = row
    made = dissipation(SHAPES[shape], poisson, **{loss: 1.0})
    relaxation = made.relax(scene(SHAPES[shape], 1e-4, "long-axis"))
    assert_allclose(relaxation.time_to(angle(1e-4)), whole, rtol=3e-12)
    separatrix = relaxation.time_to(math.pi / 2)
    assert separatrix == relaxation.time_to(math.pi / 2, "long-axis")
    assert_allclose(separatrix - relaxation.time_to(angle(0.01), "long-axis"), before, rtol=1e-11)
    assert_allclose(relaxation.time_to(angle(0.01)) - separatrix, after, rtol=1e-11)


def test_prolate_body_ends_perpendicular_in_finite_time():
    axes = (1.0, 0.5, 0.5)
    relaxation = dissipation(axes).relax(scene(axes, 0.3, "long-axis"))
    end = relaxation.time_to(math.pi / 2, "long-axis")
    # dt/dx from the powers, on the side of the end in u = sqrt(1 - x), in which it is smooth.
    nodes, weights = np.polynomial.legendre.leggauss(60)
    u = math.sqrt(0.7) * (1 + nodes) / 2
    rates = [dissipation(axes).rate(scene(axes, 1 - v * v, "long-axis", complement=v * v)) for v in u]
    assert_allclose(end, math.sqrt(0.7) / 2 * np.sum(weights * 2 * u / rates), rtol=1e-11)
    states = relaxation.at([0.999 * end, 2 * end])
    assert list(states.mode) == ["long-axis"] * 2 and states.angle[1] == math.pi / 2 and states.power[1] == 0
    assert_allclose(states.energy_ratio[1], 1, rtol=1e-15)
    with pytest.raises(andoyer.InputError, match="short-axis") as caught:
        relaxation.time_to(0.1)
    assert caught.value.argument == "mode"


def test_oblate_body_has_no_past_before_its_equator():
    axes = (1.0, 1.0, 0.5)
    relaxation = dissipation(axes).relax(scene(axes, 0.5))
    start = relaxation.time_to(math.pi / 2)
    assert relaxation.at(0.999 * start).angle > 1.55
    with pytest.raises(andoyer.InputError, match="at least") as caught:
        relaxation.at([0.0, 1.001 * start])
    assert (caught.value.argument, caught.value.value) == ("times", 1.001 * start)


@pytest.mark.parametrize(("mode", "factor"), [("short-axis", 17.0), ("long-axis", 28.8)])
def test_small_angles_change_exponentially(mode, factor):
    """Equation (18). The factor of S Q/(density R1² w³) for the angle, with w = M/C or M/A, is known to three digits."""
    axes = SHAPES["mild"]
    made = dissipation(axes)
    order = [0, 1, 2] if mode == "short-axis" else [2, 1, 0]
    (a, b, c), momentum = made.moments[order], made.moments[2]
    w23, w31 = np.diag(made.inertia_response)[3:][order[:2]]
    first, second = c / a - 1, c / b - 1
    expected = -momentum / c * math.sqrt(first * second) * (momentum / c) ** 2 * (w23 / b**2 + w31 * second / first / a**2) / (1 / b - 1 / c)
    state = scene(axes, 1e-12, mode)
    rate = made.rate(state)
    assert_allclose(rate / 1e-12, expected, rtol=1e-11)
    assert_allclose(2e-12 / abs(rate) * (momentum / c) ** 3, factor, rtol=3e-3)
    assert_allclose(made.relax(state).at([3.0, 0.0]).angle, 1e-6 * np.exp([3.0 * expected / 2, 0]), rtol=1e-11)
    if mode == "long-axis":
        assert_allclose(made.relax(state).at([-100.0, -1e30]).angle, [1e-6 * math.exp(-50.0 * expected), 0], rtol=1e-9)
    else:
        assert_allclose(made.relax(state).at(1e3).angle, 1e-6 * math.exp(500.0 * expected), rtol=1e-9)


@pytest.mark.parametrize("mode", ["short-axis", "long-axis"])
def test_times_between_two_angles_are_integrals_of_the_inverse_rate(mode):
    """At angles in the middle of the way, where the panels are short."""
    axes = SHAPES["long"]
    made = dissipation(axes)
    relaxation = made.relax(scene(axes, 0.5, mode))
    nodes, weights = np.polynomial.legendre.leggauss(24)
    for low, high in ((0.3, 0.37), (0.61, 0.69), (0.8, 0.83)):
        rates = [made.rate(scene(axes, x, mode)) for x in (low + high) / 2 + (high - low) / 2 * nodes]
        expected = (high - low) / 2 * np.sum(weights / rates)
        assert_allclose(relaxation.time_to(angle(high), mode) - relaxation.time_to(angle(low), mode), expected, rtol=2e-12)


@pytest.mark.parametrize("loss", [{"quality": 2.0}, {"viscosity": 0.7}, {"loss": lambda f: f / (1 + f * f)}])
def test_state_after_a_time_and_a_time_is_that_after_their_sum(loss):
    axes = SHAPES["mild"]
    made = dissipation(axes, **loss)
    way = made.relax(scene(axes, 0.2, "long-axis"))
    whole = way.time_to(angle(0.01))
    times = whole * np.linspace(-0.3, 1.2, 7)
    states = way.at(times)
    for time, mode, theta, ratio, power in zip(times, states.mode, states.angle, states.energy_ratio, states.power):
        assert_allclose(way.time_to(theta, mode), time, rtol=1e-11, atol=1e-12 * whole)
        middle = scene(axes, math.sin(theta) ** 2, mode, complement=math.cos(theta) ** 2)
        assert_allclose([middle.solve().energy_ratio, made.power(middle)], [ratio, power], rtol=1e-11)
        assert_allclose(made.relax(middle).time_to(angle(0.01)), whole - time, rtol=1e-10, atol=1e-11 * whole)
    assert np.all(np.diff(states.energy_ratio) < 0)
    assert states.mode[0] == "long-axis" and states.mode[-1] == "short-axis"
    # E' = -P, with E = M² ratio/(2C).
    moments = made.moments
    step = 1e-3 * whole
    ends = way.at([0.5 * whole - step, 0.5 * whole, 0.5 * whole + step])
    assert_allclose(np.diff(ends.energy_ratio)[::1].sum() / (2 * step) * moments[2] / 2, -ends.power[1], rtol=1e-4)


def test_age_and_its_reverse_are_proportional():
    axes = SHAPES["mild"]
    state = scene(axes, 0.05)
    age = dissipation(axes, quality=3.0).age(state, 1.5, "short-axis")
    assert_allclose(age, 3.0 * dissipation(axes).age(state, 1.5), rtol=1e-12)
    bare = andoyer.Dissipation(state.body, axes, andoyer.Material(density=1.0, rigidity=1.0))
    assert_allclose(bare.quality_from_age(state, age, 1.5), 3.0, rtol=1e-12)
    age = dissipation(axes, viscosity=0.2).age(state.solve(), 0.01, mode="long-axis")
    assert_allclose(bare.viscosity_from_age(state, age, 0.01, mode="long-axis"), 0.2, rtol=1e-12)
    assert_allclose(age, -dissipation(axes, viscosity=0.2).relax(state).time_to(0.01, mode="long-axis"), rtol=1e-14)


def rock(body, radius, density, product=5e11):
    """Rock with this product of rigidity and quality factor in Pa."""
    return andoyer.Dissipation(body, radius, andoyer.Material(density=density, rigidity=product / 100, quality=100.0))


@pytest.mark.parametrize(("axes", "folds"), [((5, 1, 0.9), (4.7, 1.7)), ((6, 1, 0.95), (4.0, 1.4)), ((6, 5, 1.2), (35, 13)), ((1, 0.6, 0.5), (3.2, 1.1))])
def test_oumuamua_relaxes_in_a_billion_years_or_more(axes, folds):
    """Fraser et al. 2018: at least one billion years. A period of 8 h, 1000 kg/m³, radii of 60 and 100 m, S Q = 5e11 Pa: years to a fraction 1/e of a small angle."""
    body = andoyer.Body.ellipsoid(*axes)
    state = scene(axes, 1e-8, rate=2 * math.pi / (8 * 3600))
    for radius, fold in zip((60.0, 100.0), folds):
        relaxation = rock(body, radius, 1000.0).relax(state)
        time = relaxation.time_to(math.atan(1e-4 / math.e)) / YEAR / 1e9
        assert time > 1 and abs(time / fold - 1) < 0.04


def test_toutatis_relaxes_more_slowly_than_the_solar_system_ages():
    """Harris 1994. Periods 7.40 d and 5.38 d, a radius of 1225 m, 2100 kg/m³, S Q = 5e11 Pa."""
    body = andoyer.Body([1, 3.0836, 3.235])
    state = andoyer.Scene.from_periods(body, 7.40 * 86400, 5.38 * 86400, mode="long-axis")
    made = rock(body, 1225.0, 2100.0)
    assert_allclose(math.sin(made.relax(state).at(0.0).angle) ** 2, 0.600, atol=5e-4)
    assert_allclose(made.age(state, angle(0.01)) / YEAR / 1e9, 22, atol=0.5)
    assert_allclose(made.relax(state).time_to(angle(0.0025)) / YEAR / 1e9, 185, atol=0.5)


def test_apophis_has_billions_of_years_left():
    body = andoyer.Body([0.61, 0.965, 1.0])
    state = andoyer.Scene.from_periods(body, 27.38 * 3600, 263.0 * 3600)
    relaxation = rock(body, 170.0, 2000.0).relax(state)
    assert_allclose(math.sin(relaxation.at(0.0).angle) ** 2, 0.652, atol=5e-4)
    assert_allclose(relaxation.time_to(angle(0.0025)) / YEAR / 1e9, 25, atol=0.5)


def test_from_the_separatrix_the_time_is_that_of_the_short_axis_mode():
    """A (B - A)/(C (C - B)) is 1/16: rates of 1 and 1/4 are on the separatrix to the last bit."""
    body = andoyer.Body([9.0, 10.0, 18.0])
    made = andoyer.Dissipation(body, 1.0, andoyer.Material(density=1.0, rigidity=1.0, quality=1.0))
    falling = andoyer.Scene(body, [0, 0, 0, 1], [1.0, 0.5, 0.25])
    assert falling.solve().plan.mode == "separatrix"
    assert made.power(falling) == made.rate(falling) == 0 and made.harmonics(falling) == []
    relaxation = made.relax(falling)
    assert relaxation.time_to(math.pi / 2) == 0 and abs(relaxation.at(0.0).angle - math.pi / 2) < 1e-8
    beside = andoyer.Scene(body, [0, 0, 0, 1], [1.0, 0.5, 0.25 + 1e-12])
    assert_allclose(made.relax(beside).time_to(0.1), relaxation.time_to(0.1), rtol=1e-10)
    for rates in ([0, 1, 0], [0, 0, 1], [0, 0, 0]):
        assert made.power(andoyer.Scene(body, [0, 0, 0, 1], rates)) == 0


CASES = [
    ("density", lambda: andoyer.Material(density=0.0, rigidity=1.0)),
    ("rigidity", lambda: andoyer.Material(density=1.0, rigidity=math.nan)),
    ("poisson", lambda: andoyer.Material(density=1.0, rigidity=1.0, poisson=0.51)),
    ("quality", lambda: andoyer.Material(density=1.0, rigidity=1.0, quality=-1.0)),
    ("viscosity", lambda: andoyer.Material(density=1.0, rigidity=1.0, viscosity=math.inf)),
    ("quality, viscosity, loss", lambda: andoyer.Material(density=1.0, rigidity=1.0, viscosity=1.0, quality=1.0)),
    ("body", lambda: rock(andoyer.Body([1, 1, 1]), 1.0, 1.0)),
    ("body", lambda: rock(andoyer.Body([1, 1, 2]), 1.0, 1.0)),
    ("radius", lambda: rock(andoyer.Body([1, 1.5, 2]), 0.0, 1.0)),
    ("radius", lambda: rock(andoyer.Body([1, 1.5, 2]), 1e80, 1.0)),
    ("semi_axes", lambda: rock(andoyer.Body([1, 1.5, 2]), (1, -0.7, 0.5), 1.0)),
    ("semi_axes", lambda: rock(andoyer.Body.ellipsoid(1, 0.7, 0.5), (1, 0.7, 0.501), 1.0)),
    (
        "material",
        lambda: andoyer.Dissipation(scene(SHAPES["mild"], 0.1).body, 1.0, andoyer.Material(density=1.0, rigidity=1.0)).power(scene(SHAPES["mild"], 0.1)),
    ),
    ("loss", lambda: dissipation(SHAPES["mild"], loss=lambda f: -f).power(scene(SHAPES["mild"], 0.1))),
    ("scene", lambda: dissipation(SHAPES["mild"]).power(scene(SHAPES["long"], 0.1))),
    ("scene", lambda: dissipation(SHAPES["mild"]).relax(scene(SHAPES["mild"], 0.0))),
    ("angle", lambda: dissipation(SHAPES["mild"]).relax(scene(SHAPES["mild"], 0.1)).time_to(0.0)),
    ("angle", lambda: dissipation(SHAPES["mild"]).relax(scene(SHAPES["mild"], 0.1)).time_to(1.6)),
    ("mode", lambda: dissipation(SHAPES["mild"]).relax(scene(SHAPES["mild"], 0.1)).time_to(0.1, mode="separatrix")),
    ("times", lambda: dissipation(SHAPES["mild"]).relax(scene(SHAPES["mild"], 0.1)).at([0.0, math.inf])),
    ("age", lambda: dissipation(SHAPES["mild"]).quality_from_age(scene(SHAPES["mild"], 0.1), -1.0, 1.0)),
    ("start_angle", lambda: dissipation(SHAPES["mild"]).age(scene(SHAPES["mild"], 0.1), 0.1)),
    ("start_angle", lambda: dissipation(SHAPES["mild"]).age(scene(SHAPES["mild"], 0.1, "long-axis"), 0.5)),
]


@pytest.mark.parametrize(("argument", "call"), CASES)
def test_bad_input_names_its_argument(argument, call):
    with pytest.raises(andoyer.InputError, match=argument) as caught:
        call()
    assert caught.value.argument == argument and caught.value.value is not None and caught.value.bound is not None


def test_scene_with_a_torque_has_a_power_and_no_relaxation():
    free = scene(SHAPES["mild"], 0.3)
    pulled = andoyer.Scene(free.body, free.attitude, free.angular_velocity, orbit=andoyer.Orbit(1e-3))
    made = dissipation(SHAPES["mild"])
    assert made.power(pulled) == made.power(free)
    with pytest.raises(andoyer.InputError, match="without orbits and torques"):
        made.relax(pulled)


def test_wrong_types_are_type_errors():
    body, material = andoyer.Body.ellipsoid(1, 0.7, 0.5), andoyer.Material(density=1.0, rigidity=1.0, quality=1.0)
    for call in (
        lambda: andoyer.Dissipation(body, material=material),
        lambda: andoyer.Dissipation(body, 1.0, material, semi_axes=(1, 0.7, 0.5)),
        lambda: andoyer.Dissipation(body, 1.0, {"density": 1.0}),
        lambda: andoyer.Dissipation(body.moments, 1.0, material),
        lambda: andoyer.Dissipation(body, 1.0, material).power(body),
        lambda: andoyer.Material(density=1.0, rigidity=1.0, loss=0.01),
        lambda: andoyer.Material(density="1", rigidity=1.0),
        lambda: dissipation(SHAPES["mild"], loss=lambda f: "no number").power(scene(SHAPES["mild"], 0.3)),
    ):
        with pytest.raises(TypeError):
            call()


def test_exception_of_a_loss_function_is_raised_as_it_is():
    def failing(frequency):
        raise KeyError(frequency)

    made = dissipation(SHAPES["mild"], loss=failing)
    for call in (made.power, made.rate, made.harmonics, made.relax):
        with pytest.raises(KeyError):
            call(scene(SHAPES["mild"], 0.3))


def test_copies_and_pickles_give_the_same_times():
    axes = SHAPES["mild"]
    made = dissipation(axes, viscosity=0.3, shear_only=True)
    relaxation = made.relax(scene(axes, 0.3))
    expected = relaxation.time_to(0.1)
    for other in (pickle.loads(pickle.dumps(relaxation)), copy.deepcopy(relaxation), copy.copy(relaxation)):
        assert other.time_to(0.1) == expected
    radius = andoyer.Dissipation(made.body, 2.0, made.material)
    assert pickle.loads(pickle.dumps(radius)).radius == 2.0
    assert repr(pickle.loads(pickle.dumps(made))) == repr(made)
    assert "shear_only=True" in repr(made) and "0.5796" in repr(relaxation)


def test_scalar_times_have_no_axis():
    states = dissipation(SHAPES["mild"]).relax(scene(SHAPES["mild"], 0.3)).at(0)
    assert states.angle.shape == states.mode.shape == () and states.mode == "short-axis"
    assert_allclose(states.angle, angle(0.3), rtol=1e-14)
    with pytest.raises(TypeError):
        len(states)


def test_a_loss_that_vanishes_with_the_frequency_has_no_time_from_the_separatrix_of_a_symmetric_body():
    """Kelvin and Voigt: |dt/dy| tends to a constant there, and the time grows by the same for each power of ten of the angle."""
    rock = andoyer.Material(density=1.0, rigidity=1.0, loss=lambda f: 1e-3 * f / (1 + (1e-3 * f) ** 2))
    made = andoyer.Dissipation(andoyer.Body([1, 1, 1.5]), 1.0, rock)
    relaxation = made.relax(andoyer.Scene(made.body, [0, 0, 0, 1], [0.3, 0, 1]))
    times = [relaxation.time_to(math.pi / 2 - 10.0**-k) for k in (3, 4, 5, 6)]
    assert_allclose(np.diff(times, 2), 0, atol=1e-5 * abs(times[1] - times[0]))
    with pytest.raises(andoyer.InputError, match="infinite time"):
        relaxation.time_to(math.pi / 2)
    quality = andoyer.Dissipation(made.body, 1.0, andoyer.Material(density=1.0, rigidity=1.0, quality=100.0))
    assert math.isfinite(quality.relax(andoyer.Scene(made.body, [0, 0, 0, 1], [0.3, 0, 1])).time_to(math.pi / 2))


def test_spheres_and_symmetric_bodies_from_turned_tensors_are_what_they_are():
    random, rock = np.random.default_rng(4), andoyer.Material(density=1.0, rigidity=1.0, quality=1.0)
    expected = andoyer.Dissipation(andoyer.Body([1, 1, 1.5]), 1.0, rock)
    for _ in range(10):
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        with pytest.raises(andoyer.InputError, match="a sphere"):
            andoyer.Dissipation(andoyer.Body.from_inertia(turn @ turn.T), 1.0, rock)
        turn *= np.linalg.det(turn)
        body = andoyer.Body.from_inertia(turn @ np.diag([1, 1, 1.5]) @ turn.T)
        relaxation = andoyer.Dissipation(body, 1.0, rock).relax(andoyer.Scene(body, [0, 0, 0, 1], turn @ [0.3, 0, 1]))
        alone = expected.relax(andoyer.Scene(expected.body, [0, 0, 0, 1], [0.3, 0, 1]))
        assert_allclose(relaxation.time_to(0.05), alone.time_to(0.05), rtol=1e-11)
        with pytest.raises(andoyer.Error):
            relaxation.time_to(0.1, mode="long-axis")
