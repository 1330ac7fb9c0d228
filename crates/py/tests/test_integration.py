"""The integrated method against SciPy's DOP853, the closed form, and nature; what it refuses."""

import json
import math
import pickle

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer import Body, Orbit, Scene, TabulatedOrbit
from andoyer._quaternions import angle_between

EARTH = {"gm": 3.986004415e14, "j2": 1.08262668e-3, "radius": 6378136.3}
ATTITUDE = [0.1, -0.2, 0.3, 0.9273618495495703]
TILTED = {"inclination": 0.4, "node": 0.7, "argument_of_pericentre": 1.1}


def angle(one, other):
    """Angles between attitudes."""
    x, y, z, w = np.moveaxis(np.asarray(one), -1, 0)
    a, b, c, d = np.moveaxis(np.asarray(other), -1, 0)
    vector = [w * a - d * x - (y * c - z * b), w * b - d * y - (z * a - x * c), w * c - d * z - (x * b - y * a)]
    return 2 * np.arctan2(np.linalg.norm(vector, axis=0), np.abs(w * d + x * a + y * b + z * c))


SCENES = {
    "slow": ([0.5, 0.8, 1.0], [0.01, 0.02, 0.03], Orbit(1.0, 0.1, **TILTED), 10.0),
    "synchronous": ([0.7, 0.85, 1.0], [0.01, 0.02, 1.0], Orbit(1.0, 0.05), 20.0),
    "eccentric": ([0.5, 0.8, 1.0], [1.0, 2.0, 3.0], Orbit(1.0, 0.9, time_of_pericentre=1.0, **TILTED), 6.0),
    "precessing": (
        [0.5, 0.8, 1.0],
        [1.0, 2.0, 3.0],
        Orbit(1.0, 0.2, node_rate=-0.1, pericentre_rate=0.2, attraction=0.5, time_of_pericentre=-3.0, **TILTED),
        8.0,
    ),
    "two bodies": ([0.5, 0.8, 1.0], [0.1, 2.0, 3.0], [Orbit(1.0, 0.2, **TILTED), Orbit(0.3, 0.0, mass_fraction=0.5)], 8.0),
    "at rest": ([0.5, 0.8, 1.0], [0, 0, 0], Orbit(1.0, 0.2, **TILTED), 8.0),
    "B = C": ([0.5, 1.0, 1.0], [0.1, 0.2, 3.0], Orbit(1.0, 0.2, **TILTED), 8.0),
}


@pytest.mark.parametrize("moments, rates, orbit, span", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("direction", [1, -1])
def test_motion_is_that_of_another_integration(moments, rates, orbit, span, direction):
    pytest.importorskip("scipy")
    import full_equations

    ends = (2.0, 2.0 + span) if direction > 0 else (2.0 - span, 2.0)
    scene = Scene(Body(moments), ATTITUDE, rates, epoch=2.0, orbit=orbit, span=ends, tolerance=1e-9, method="integrated")
    motion = scene.solve()
    assert motion.plan.method == "integrated" and motion.plan.meets_tolerance
    times = 2.0 + direction * np.linspace(0, span, 30)
    attitude, velocity = full_equations.states(scene, times)
    found = motion.at(times)
    # DOP853 at a relative tolerance of 1e-13 a step leaves about 1e-11 after the few hundred steps of these spans.
    assert angle(found.attitude, attitude).max() < 1e-10
    assert np.abs(found.angular_velocity - velocity).max() < 1e-9
    turned = motion.rotation(times).apply(found.angular_velocity * np.array(moments))
    assert np.abs(motion.angular_momentum(times) - turned).max() < 1e-14 * (1 + np.abs(turned).max())


@pytest.mark.parametrize("case", json.loads((REPOSITORY / "tests/data/gravity_gradient.json").read_text(encoding="utf-8")), ids=lambda case: case["name"])
def test_thousands_of_rotations_are_those_of_the_reference_within_the_bound(case):
    elements, states = case["orbit"], case["states"]
    orbit = Orbit(elements["mean_motion"], elements["eccentricity"], argument_of_pericentre=elements["pericentre_longitude"])
    times = [state["t"] for state in states]
    scene = Scene(
        Body(case["moments"]), case["attitude0_xyzw"], case["angular_velocity0"], orbit=orbit, span=(0, times[-1]), tolerance=1e-9, method="integrated"
    )
    motion = scene.solve()
    error = angle(motion.attitude(times), [[float(x) for x in state["attitude_xyzw"]] for state in states]).max()
    assert error < motion.plan.error_bound <= 1e-9


def test_times_in_any_order_and_one_by_one_give_the_same_bits():
    scene = Scene(Body([0.5, 0.8, 1.0]), ATTITUDE, [1, 2, 3], orbit=Orbit(1.0, 0.5), span=(-5, 5), tolerance=1e-10, method="integrated")
    motion = scene.solve()
    times = np.random.default_rng(1).uniform(-5, 5, 500)
    together = motion.attitude(times)
    assert np.array_equal(together, [motion.attitude(time) for time in times])
    order = np.argsort(times)
    assert np.array_equal(together[order], motion.attitude(times[order]))


def test_motion_runs_back_to_where_it_came_from():
    body, orbit = Body([0.5, 0.8, 1.0]), Orbit(1.0, 0.3, **TILTED)
    there = Scene(body, ATTITUDE, [0.5, 1.5, 2.0], orbit=orbit, span=(0, 20), tolerance=1e-10, method="integrated").solve()
    end = there.at(20.0)
    back = Scene(body, end.attitude, end.angular_velocity, epoch=20.0, orbit=orbit, span=(0, 20), tolerance=1e-10, method="integrated").solve()
    assert angle(back.attitude(0.0), ATTITUDE) < there.plan.error_bound + back.plan.error_bound < 2e-10


def test_table_of_a_circle_gives_the_motion_of_the_orbit_within_the_bound():
    body, span = Body([0.5, 0.8, 1.0]), (0.0, 10.0)
    by_orbit = Scene(body, ATTITUDE, [0.5, 1.5, 2.0], orbit=Orbit(1.0), span=span, tolerance=1e-10, method="integrated").solve()
    errors = []
    for count in (101, 201):
        times = np.linspace(-1, 11, count)
        table = TabulatedOrbit(times, np.stack([np.cos(times), np.sin(times), 0 * times], axis=1) * 7e6, 7e6**3)
        motion = Scene(body, ATTITUDE, [0.5, 1.5, 2.0], orbit=table, span=span, tolerance=1e-5).solve()
        assert motion.plan.method == "integrated" and "table" in motion.plan.skipped[0]
        at = np.linspace(0, 10, 300)
        errors.append(angle(motion.attitude(at), by_orbit.attitude(at)).max())
        assert errors[-1] < motion.plan.error_bound < 1e-5
    # Degree seven: 2^8 for half the distance of the times.
    assert 150 < errors[0] / errors[1] < 400


def test_theory_gives_way_to_the_integration_where_it_does_not_hold_or_is_not_good_enough():
    body, orbit = Body([1, 1.02, 1.05]), Orbit(1.0, mass_fraction=1e-4)
    state = ([0, 0, 0, 1], [0, 0.01, 1])
    with pytest.raises(andoyer.TheoryError, match="resonance"):
        Scene(body, *state, orbit=orbit, span=(0, 100), method="closed").solve()
    plan = Scene(body, *state, orbit=orbit, span=(0, 100)).solve().plan
    assert plan.method == "integrated" and "resonance" in plan.skipped[0] and plan.steps > 10 and plan.mode == "short-axis"
    assert f"steps         {plan.steps}" in str(plan) and f"order         {plan.order}" in str(plan)
    # The wobble in resonance with the orbit turns the attitude by little within this span, and the theory serves it.
    wobbling = {"orbit": Orbit(0.038348, mass_fraction=1e-4), "span": (0, 100)}
    served = Scene(body, *state, **wobbling, method="closed", tolerance=1e-8).solve()
    exact = Scene(body, *state, **wobbling, method="integrated", tolerance=1e-12).solve()
    assert angle(served.attitude(100.0), exact.attitude(100.0)) <= served.plan.error_bound + exact.plan.error_bound
    fast = Orbit(1e-2, 0.1)
    coarse = Scene(body, *state, orbit=fast, span=(0, 1e3), tolerance=1e-4).solve().plan
    fine = Scene(body, *state, orbit=fast, span=(0, 1e3), tolerance=1e-11).solve().plan
    assert (coarse.method, fine.method) == ("closed", "integrated")
    assert "its error bound is" in fine.skipped[0] and fine.error_bound < 1e-11


def test_integration_needs_a_span_and_ends_with_it():
    body, bodies = Body([1, 1.02, 1.05]), [Orbit(1.0), Orbit(2.0)]
    with pytest.raises(andoyer.InputError, match="span: none is given.*2 disturbing bodies") as caught:
        Scene(body, ATTITUDE, [0, 0, 1], orbit=bodies).solve()
    assert caught.value.argument == "span"
    with pytest.raises(andoyer.TheoryError, match="spin resonance"):
        Scene(body, ATTITUDE, [0, 0, 1], orbit=bodies, span=(0, 1), method="closed").solve()
    motion = Scene(body, ATTITUDE, [0, 0, 1], epoch=1.0, orbit=bodies, span=(2, 5)).solve()
    assert motion.attitude([1.0, 5.0]).shape == (2, 4)
    for time in (0.99, 5.01):
        with pytest.raises(andoyer.RepresentationError, match="over its span"):
            motion.attitude([2.0, time])


def test_integration_of_1e9_rotations_is_refused_with_the_figure():
    with pytest.raises(andoyer.TheoryError, match=r"about \d\.\de10 steps, which take \d+ GB; at most 8388608 are kept") as caught:
        Scene(Body([1, 1.02, 1.05]), ATTITUDE, [0, 0.1, 1], orbit=Orbit(0.5), span=(0, 6.3e9), method="integrated").solve()
    assert caught.value.argument == "span" and caught.value.value > 1e9


def test_chaotic_motion_says_over_which_span_the_tolerance_can_be_had():
    # Hyperion's figure and orbit (Wisdom, Peale, Mignard 1984): Lyapunov time of some orbits.
    scene = Scene(Body([0.57933579, 0.87453875, 1.0]), ATTITUDE, [0.3, 0.4, 0.9], orbit=Orbit(1.0, 0.1), span=(0, 3000), tolerance=1e-8)
    with pytest.raises(andoyer.TheoryError, match="nearby states separate") as caught:
        scene.solve()
    start, stop = caught.value.bound
    assert start == 0 and 10 < stop < 1000
    short = Scene(scene.body, scene.attitude, scene.angular_velocity, orbit=scene.orbit, span=(0, stop), tolerance=1e-8).solve()
    assert short.plan.method == "integrated" and short.plan.error_bound < 1e-7


def test_what_is_no_table_is_refused():
    times, positions = np.arange(10.0), np.ones((10, 3))
    for bad, argument, message in [
        ((times[:7], positions[:7], 1.0), "times", "8 or more"),
        ((times[::-1], positions, 1.0), "times", "greater than the one before it"),
        ((times, positions[:9], 1.0), "positions", "10"),
        ((times, 0 * positions, 1.0), "positions", "origin"),
        ((times, positions * np.nan, 1.0), "positions", "finite"),
        ((times, positions, 0.0), "gm", "positive"),
        ((times, positions[:, :2], 1.0), "positions", r"\(n, 3\)"),
    ]:
        with pytest.raises(andoyer.InputError, match=message) as caught:
            TabulatedOrbit(*bad)
        assert caught.value.argument == argument
    table = TabulatedOrbit(times, positions, 1.0)
    with pytest.raises(andoyer.InputError, match="table of positions only from 0 to 9"):
        Scene(Body([1, 2, 2]), ATTITUDE, [0, 0, 1], orbit=table, span=(0, 9.5)).solve()
    with pytest.raises(TypeError, match="orbit must be an andoyer.Orbit, a TabulatedOrbit, a sequence"):
        Scene(Body([1, 2, 2]), ATTITUDE, [0, 0, 1], orbit=[Orbit(1.0), 3])


def test_scene_keeps_several_bodies_through_pickle_and_file(tmp_path):
    times = np.arange(10.0)
    table = TabulatedOrbit(times, np.stack([1 + times, times, times], axis=1), 2.5)
    precessing = Orbit(1.0, 0.1, node_rate=-0.1, pericentre_rate=0.3, attraction=0.7)
    for orbit in [(precessing, Orbit(2.0)), (precessing, table), table, precessing]:
        scene = Scene(Body([1, 2, 2.5]), ATTITUDE, [0, 0, 1], orbit=orbit, span=(0, 9), method="integrated")
        assert scene.orbit == orbit and pickle.loads(pickle.dumps(scene)) == scene
        path = tmp_path / "scene.toml"
        path.write_text(scene.to_toml(), encoding="utf-8")
        assert Scene.from_toml(path) == scene and hash(Scene.from_toml(path)) == hash(scene)
    assert eval(repr(precessing), {"Orbit": Orbit}) == precessing
    path.write_text(scene.to_toml().replace("attraction = 0.7", "attraction = -1.0"), encoding="utf-8")
    with pytest.raises(andoyer.FileError, match="orbit.attraction"):
        Scene.from_toml(path)


def test_attraction_is_the_mean_motion_squared_times_the_mass_fraction_in_the_theory_too():
    state = ([0, 0, 0, 1], [0, 0.01, 1])
    options = {"span": (0, 1e4), "tolerance": 1e-4, "method": "closed"}
    one = Scene(Body([1, 1.02, 1.05]), *state, orbit=Orbit(2e-3, 0.1, mass_fraction=0.5), **options).solve()
    other = Scene(Body([1, 1.02, 1.05]), *state, orbit=Orbit(2e-3, 0.1, attraction=2e-6), **options).solve()
    full = Scene(Body([1, 1.02, 1.05]), *state, orbit=Orbit(2e-3, 0.1), **options).solve()
    assert angle(one.attitude(1e4), other.attitude(1e4)) < 1e-13 < 1e-4 < angle(one.attitude(1e4), full.attitude(1e4))


def test_rates_of_a_satellite_are_those_of_the_first_order_in_j2():
    # The node of a Sun-synchronous orbit, at 800 km one of 98.603°, turns with the mean Sun, 360° in 365.2422 days.
    orbit = Orbit.around_oblate(EARTH["gm"], EARTH["radius"] + 800e3, 0.0, math.radians(98.603), j2=EARTH["j2"], radius=EARTH["radius"])
    assert math.degrees(orbit.node_rate) * 86400 == pytest.approx(0.985647, rel=2e-3)
    # At the critical inclination the pericentre stands still.
    frozen = Orbit.around_oblate(EARTH["gm"], 26.6e6, 0.7, math.asin(math.sqrt(0.8)), j2=EARTH["j2"], radius=EARTH["radius"])
    assert abs(frozen.pericentre_rate) < 1e-9 * abs(frozen.node_rate)
    assert orbit.attraction == pytest.approx(EARTH["gm"] / (EARTH["radius"] + 800e3) ** 3, rel=1e-15)
    with pytest.raises(andoyer.InputError, match="radius"):
        Orbit.around_oblate(EARTH["gm"], 7e6, 0.0, 1.0, j2=1e-3, radius=0.0)
    # Kilometres beside metres; an axis, or only the pericentre, below the surface.
    for axis, eccentricity in [(6778.0, 0.001), (6e6, 0.0), (9e6, 0.5)]:
        with pytest.raises(andoyer.InputError, match="semi_major_axis.*such that the pericentre") as caught:
            Orbit.around_oblate(EARTH["gm"], axis, eccentricity, 0.9, j2=EARTH["j2"], radius=EARTH["radius"])
        assert (caught.value.argument, caught.value.value) == ("semi_major_axis", axis)
    Orbit.around_oblate(EARTH["gm"], 2 * EARTH["radius"], 0.5, 0.9, j2=EARTH["j2"], radius=EARTH["radius"])


def longitudes(motion, times):
    """Rotation angles of a motion about inertial axis 3, unwrapped."""
    attitude = motion.attitude(times)
    return np.unwrap(2 * np.arctan2(attitude[:, 2], attitude[:, 3]), period=4 * np.pi)


def fitted(values, arguments):
    """Amplitudes of the sines of some arguments."""
    columns = [function(argument) for argument in arguments for function in (np.sin, np.cos)]
    return np.linalg.lstsq(np.stack([*columns, np.ones_like(values)], axis=1), values, rcond=None)[0][::2][: len(arguments)]


def test_phobos_librates_by_the_amplitude_of_the_linear_formula():
    # Moments in M R² and the amplitude −1.143°: IAU 2015 and Willner et al. 2010; e = 0.0151.
    moments, e = [0.3615, 0.4265, 0.5024], 0.0151
    free = 3 * (moments[1] - moments[0]) / moments[2]
    amplitude = 2 * e * free / (free - 1)
    body = Body(moments)
    motion = Scene(body, [0, 0, 0, 1], [0, 0, 1 + amplitude], orbit=Orbit(1.0, e), span=(0, 300), tolerance=1e-8).solve()
    assert motion.plan.method == "integrated"
    times = np.linspace(0, 300, 4000)
    sines = fitted(longitudes(motion, times) - times, [times, 2 * times, math.sqrt(free) * times])
    # The long axis swings by 0.049 rad about the direction of the planet: the torque, sin 2x, is weaker than 2x by (3/4)(2x)²/6 = 1.2e-3, and the amplitude by 1.63 times that.
    assert sines[0] == pytest.approx(amplitude, rel=4e-3)
    assert math.degrees(sines[0]) == pytest.approx(-1.143, abs=0.05)


def test_mercury_stays_in_its_resonance_and_librates_by_the_published_amplitude():
    # (B − A)/Cm from 38.5" (Margot et al. 2012) with Peale's formula; the integration must give 38.5" back.
    e, published = 0.20563593, math.radians(38.5 / 3600)
    shape = 1 - 11 * e**2 + 959 / 48 * e**4 - 3641 / 288 * e**6
    ratio = published / (1.5 * shape)
    body = Body([1 - 2 * ratio, 1 - ratio, 1.0])
    motion = Scene(body, [0, 0, 0, 1], [0, 0, 1.5 + published], orbit=Orbit(1.0, e), span=(0, 2000), tolerance=1e-8).solve()
    assert motion.plan.method == "integrated"
    times = np.linspace(0, 2000, 20000)
    departure = longitudes(motion, times) - 1.5 * times
    assert np.abs(departure).max() < 0.01
    free = math.sqrt(3 * ratio * (3.5 * e - 123 / 16 * e**3))
    assert fitted(departure, [times, 2 * times, free * times])[0] == pytest.approx(published, rel=0.01)


def test_derivatives_are_those_of_nearby_motions():
    scene = Scene(Body([0.5, 0.8, 1.0]), ATTITUDE, [0.5, 1.0, 1.5], orbit=[Orbit(1.0, 0.1), Orbit(0.5)], span=(0, 5), tolerance=1e-11)
    motion = scene.solve()
    found = motion.partials(5.0)
    step = 1e-6
    moved = Scene(scene.body, ATTITUDE, [0.5, 1.0, 1.5 + step], orbit=scene.orbit, span=(0, 5), tolerance=1e-11).solve()
    change = (motion.rotation(5.0).inv() * moved.rotation(5.0)).as_rotvec() / step
    assert motion.plan.partials == "variational"
    assert np.abs(found.attitude[:, 5] - change).max() < 1e-4 * np.abs(change).max()


@pytest.mark.parametrize("length", [0.0, 1e6, 1e20, 1e300])
def test_body_at_rest_stays_where_it_is_over_any_span(length):
    # Powers of a step of 1e20 overflowed, and 0 times infinity was taken for states that separate.
    motion = Scene(Body([0.5, 0.8, 1.0]), ATTITUDE, [0, 0, 0], span=(-length, 2 * length), method="integrated").solve()
    assert angle(motion.attitude([-length, 0.0, 2 * length]), ATTITUDE).max() < motion.plan.error_bound < 1e-13


@pytest.mark.parametrize("eccentricity", [1 - 1e-9, 1 - 1e-6])
def test_passage_that_spins_the_body_up_is_named_at_once(eccentricity):
    """It was refused after 11 s, with the advice to use a span shorter by a factor of 1.1, which still contained the passage."""
    orbit = Orbit(1e-2, eccentricity, time_of_pericentre=10, inclination=0.5)
    state = (Body([0.41, 0.83, 1]), [0, 0, 0, 1], [0.2, 0.3, 1.1])
    with pytest.raises(
        andoyer.TheoryError, match=r"span: the passage at (10|9\.99\d*|10\.0\d*) leaves the body rotating .* end the span before this passage"
    ) as caught:
        Scene(*state, method="integrated", tolerance=1e-8, span=(0, 300), orbit=orbit).solve()
    assert caught.value.argument == "span" and caught.value.value == pytest.approx(10, abs=0.01)
    Scene(*state, method="integrated", tolerance=1e-8, span=(0, 9.9), orbit=orbit).solve()


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_rates_are_within_their_bound_and_a_later_scene_within_what_they_cost():
    """The rates of the theory against an integration, at both levels; the motion from a later state departs by their error times the time."""
    random = np.random.default_rng(11)
    found = 0
    while found < 16:
        moments = np.sort(random.uniform(0.5, 1.0, 3))
        state = (Body(moments), [0, 0, 0, 1], random.normal(size=3) * [0.2, 0.2, 0] + [0, 0, 1])
        orbit = Orbit(10 ** random.uniform(-3.5, -2), random.uniform(0, 0.5), inclination=random.uniform(0, 2))
        level = ["full", "second-order"][found % 2]
        try:
            motion = Scene(*state, orbit=orbit, span=(0, 1000), tolerance=1e-9, method="closed", level=level).solve()
        except andoyer.Error:
            continue
        found += 1
        truth = Scene(*state, orbit=orbit, span=(0, 1000), tolerance=1e-13, method="integrated").solve()
        times = np.linspace(0, 1000, 200)
        rates = np.linalg.norm(motion.angular_velocity(times) - truth.angular_velocity(times), axis=1)
        assert rates.max() < motion.plan.rate_error_bound + truth.plan.rate_error_bound
        later = motion.scene_at(500.0).solve()
        apart = angle_between(later.attitude([1000.0]), motion.attitude([1000.0]))[0]
        assert apart < motion.plan.error_bound + later.plan.error_bound + 500 * motion.plan.rate_error_bound
