"""Orbits from a position and a velocity, positions on orbits, the scene of a later state, and periods that are refused.

The positions are held against Lagrange's coefficients f and g in 40 digits (mpmath), which use no angles of the orbit, and the elements against SPICE (oscelt and conics).
"""

import copy
import math
import pickle
import re

import mpmath
import numpy as np
import pytest

import andoyer
from andoyer import Body, Orbit, Scene

GM = 3.986004415e14
EARTH = {"j2": 1.08262668e-3, "radius": 6378136.3}


def moved(position, velocity, gm, duration):
    """The position after `duration`, in 40 digits: f r + g v, with the change of the eccentric anomaly from Kepler's equation for it."""
    with mpmath.workdps(40):
        r, v = ([mpmath.mpf(float(x)) for x in vector] for vector in (position, velocity))
        gm, duration = mpmath.mpf(gm), mpmath.mpf(duration)
        radius = mpmath.sqrt(sum(x * x for x in r))
        a = 1 / (2 / radius - sum(x * x for x in v) / gm)
        n = mpmath.sqrt(gm / a**3)
        cosine, sine = 1 - radius / a, sum(x * y for x, y in zip(r, v)) / mpmath.sqrt(gm * a)
        equation = lambda change: change - cosine * mpmath.sin(change) + sine * (1 - mpmath.cos(change)) - n * duration  # noqa: E731
        bound = mpmath.sqrt(cosine**2 + sine**2) + abs(sine) + 1
        change = mpmath.findroot(equation, (n * duration - bound, n * duration + bound), solver="anderson", tol=1e-60, maxsteps=500)
        f, g = 1 - a / radius * (1 - mpmath.cos(change)), duration - (change - mpmath.sin(change)) / n
        return np.array([float(f * x + g * y) for x, y in zip(r, v)]), float(a)


def state(e, inclination, node, argument, f, p=1.3, gm=2.0):
    """Position and velocity of elements, by the orbit equation."""
    axes = [np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]]) for a in (inclination,)]
    about = lambda a: np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])  # noqa: E731
    turn = about(node) @ axes[0] @ about(argument)
    position = p / (1 + e * math.cos(f)) * np.array([math.cos(f), math.sin(f), 0])
    velocity = math.sqrt(gm / p) * np.array([-math.sin(f), e + math.cos(f), 0])
    return turn @ position, turn @ velocity


def cases():
    rng = np.random.default_rng(31)
    for e in (0.0, 1e-16, 1e-9, 0.1, 0.6, 0.95, 1 - 1e-6):
        for inclination in (0.0, 1e-12, 0.4, math.pi / 2, 2.5, math.pi):
            yield e, inclination, *rng.uniform(0, 2 * math.pi, 3)


def test_position_is_that_of_the_state_moved_by_f_and_g_in_40_digits_on_circles_and_in_the_plane_too():
    gm, time = 2.0, 5.0
    for elements in cases():
        position, velocity = state(*elements, gm=gm)
        if elements[1] in (0.0, math.pi):
            position[2] = velocity[2] = 0.0
        orbit = Orbit.from_state(position, velocity, gm, time)
        for periods in (0.0, 0.01, 0.37, 0.5, -0.8, 3.3):
            duration = periods * 2 * math.pi / orbit.mean_motion
            truth, a = moved(position, velocity, gm, duration)
            # Rounding of the elements: of e at 1e-16, of 1/a by the cancellation of 2/r and v², of the mean anomaly by 3.3 turns, and dE/dM ≤ 1/(1 − e) at the pericentre.
            size = a * (1 + orbit.eccentricity)
            bound = 1e-14 * size * (1 + size / np.linalg.norm(position)) * (1 + abs(periods)) / math.sqrt(1 - orbit.eccentricity)
            error = np.abs(orbit.position(time + duration) - truth).max()
            assert error < bound, (elements, periods, error / size)


def test_elements_are_those_of_spice():
    spice = pytest.importorskip("spiceypy")
    rng = np.random.default_rng(7)
    for _ in range(200):
        e, inclination = rng.uniform(0.001, 0.95), rng.uniform(0.01, 3.13)
        r, v = state(e, inclination, *rng.uniform(0, 2 * math.pi, 3), p=rng.uniform(0.1, 10))
        orbit = Orbit.from_state(r, v, 2.0, 4.0)
        nearest, ecc, inc, node, argument, anomaly, *_ = spice.oscelt([*r, *v], 4.0, 2.0)
        found = [orbit.semi_major_axis * (1 - orbit.eccentricity), orbit.eccentricity, orbit.inclination]
        assert found == pytest.approx([nearest, ecc, inc], rel=1e-12, abs=1e-12)
        angles = np.array([orbit.node - node, orbit.argument_of_pericentre - argument, orbit.mean_motion * (4.0 - orbit.time_of_pericentre) - anomaly])
        assert np.abs(np.sin(angles / 2)).max() < 1e-11
        times = 4.0 + rng.uniform(-20, 20, 5)
        truth = [spice.conics([nearest, ecc, inc, node, argument, anomaly, 4.0, 2.0], t)[:3] for t in times]
        assert np.abs(orbit.position(times) - truth).max() < 1e-11 * orbit.semi_major_axis


def test_circle_and_equatorial_orbit_have_the_angles_that_are_promised():
    circle = Orbit.from_state([0, 2.0, 0], [-1.0, 0, 0], 2.0, 3.0)
    assert (circle.eccentricity, circle.inclination, circle.node, circle.time_of_pericentre) == (0, 0, 0, 3.0)
    assert circle.argument_of_pericentre == pytest.approx(math.pi / 2, abs=1e-15)
    backwards = Orbit.from_state([0, 2.0, 0], [1.0, 0, 0], 2.0, 3.0)
    assert (backwards.inclination, backwards.node) == (math.pi, 0) and backwards.argument_of_pericentre == pytest.approx(1.5 * math.pi, abs=1e-15)
    assert backwards.position(3.0 + math.pi) == pytest.approx([2.0 * math.sin(math.pi / 2), 0, 0], abs=1e-14)


def test_orbit_of_a_state_turns_the_body_as_the_orbit_of_its_elements_does():
    r, v = state(0.3, 0.4, 0.5, 0.6, 0.0, p=1.3 * 0.91, gm=1e-6 * 1.3**3)
    from_state, given = (
        Orbit.from_state(r, v, 1e-6 * 1.3**3, 2.0, mass_fraction=0.5),
        Orbit(1e-3, 0.3, inclination=0.4, node=0.5, argument_of_pericentre=0.6, time_of_pericentre=2.0, mass_fraction=0.5),
    )
    assert from_state.semi_major_axis == pytest.approx(1.3, rel=1e-14) and from_state.attraction == pytest.approx(given.attraction, rel=1e-14)
    scenes = [Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0.1, 1], orbit=orbit, span=(0, 1000), tolerance=1e-6) for orbit in (from_state, given)]
    first, second = (scene.solve().attitude(np.linspace(0, 1000, 9)) for scene in scenes)
    assert np.abs(first - second).max() < 1e-12


def test_position_follows_the_secular_rates():
    orbit = Orbit(
        1.0, 0.2, inclination=0.7, node=0.1, argument_of_pericentre=0.3, time_of_pericentre=2.0, node_rate=-0.05, pericentre_rate=0.08, semi_major_axis=3.0
    )
    for time in (-40.0, 2.0, 17.3):
        turned = Orbit(
            1.0, 0.2, inclination=0.7, node=0.1 - 0.05 * (time - 2), argument_of_pericentre=0.3 + 0.08 * (time - 2), time_of_pericentre=2.0, semi_major_axis=3.0
        )
        assert np.abs(orbit.position(time) - turned.position(time)).max() < 1e-13


def test_semi_major_axis_is_kept_by_copies_files_and_repr(tmp_path):
    orbit = Orbit(1e-3, 0.1, semi_major_axis=7e6)
    assert Orbit(1e-3, 0.1).semi_major_axis is None and orbit != Orbit(1e-3, 0.1) and orbit != Orbit(1e-3, 0.1, semi_major_axis=8e6)
    assert eval(repr(orbit), vars(andoyer).copy()) == pickle.loads(pickle.dumps(orbit)) == copy.copy(orbit) == orbit
    assert hash(orbit) == hash(Orbit(1e-3, 0.1, semi_major_axis=7e6))
    scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0.1, 1], orbit=orbit)
    path = tmp_path / "scene.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    assert "semi_major_axis = 7000000.0" in path.read_text(encoding="utf-8") and Scene.from_toml(path) == scene
    path.write_text(scene.to_toml().replace("7000000.0", "-1.0"), encoding="utf-8")
    with pytest.raises(andoyer.FileError, match="orbit.semi_major_axis = -1: it must be positive and at most 1e300"):
        Scene.from_toml(path)
    assert Orbit.around_oblate(GM, 7e6, 0.01, 1.0, **EARTH).position(0.0) == pytest.approx([0.99 * 7e6, 0, 0], abs=1e-6)


BAD_STATES = [
    (([0, 0, 0], [0, 1, 0], 1, 0), "position = .*finite and not 0"),
    (([math.nan, 0, 0], [0, 1, 0], 1, 0), "position = .*finite"),
    (([1, 0, 0], [0, math.inf, 0], 1, 0), "velocity = .*finite"),
    (([1, 0, 0], [0, 1, 0], -1, 0), "orbit.gm = -1: it must be positive and finite"),
    (([1, 0, 0], [0, 1, 0], 1, math.inf), "orbit.time = inf: it must be finite"),
    (([1, 0, 0], [0, 0, 0], 1, 0), "orbit.eccentricity = 1: it must be other than 1"),
    (([1, 0, 0], [0.5, 0, 0], 1, 0), "orbit.eccentricity = 1: it must be other than 1"),
    (([1, 0, 0], [0, math.sqrt(2), 0], 1, 0), "orbit.eccentricity = 1.*: it must be other than 1"),
    (([1, 0, 0], [1e200, 1, 0], 1e-200, 0), "orbit.eccentricity = .*: it must be other than 1"),
    (([1e200, 0, 0], [0, 1e-250, 0], 1, 0), "orbit.eccentricity = .*: it must be other than 1"),
]


@pytest.mark.parametrize("arguments, message", BAD_STATES)
def test_state_that_no_conic_has_is_refused_by_name(arguments, message):
    with pytest.raises(andoyer.InputError, match=message):
        Orbit.from_state(*arguments)


def test_huge_and_tiny_states_have_their_orbit():
    for scale, speed in ((1e150, 1e-3), (1e-150, 1e100), (1e-3, 1e-120)):
        orbit = Orbit.from_state([scale, 0, 0], [0, 0.9 * speed, 0], scale * speed**2, 0.0)
        assert orbit.eccentricity == pytest.approx(0.19, rel=1e-14) and orbit.semi_major_axis == pytest.approx(scale / 1.19, rel=1e-14)


def test_position_without_a_length_or_at_a_time_without_a_phase_is_refused():
    with pytest.raises(andoyer.InputError, match="orbit.semi_major_axis: none is given, and a position on the orbit needs it") as caught:
        Orbit(1.0).position(0.0)
    assert caught.value.argument == "semi_major_axis"
    for time in (math.nan, math.inf, 1e17):
        with pytest.raises(andoyer.InputError, match="orbit.time = .*: it must be finite and within 1e15 periods"):
            Orbit(1.0, semi_major_axis=1.0).position([0.0, time])
    assert Orbit(1.0, semi_major_axis=1.0).position([]).shape == (0, 3)


def test_quantities_and_times_of_astropy_are_converted():
    units, astropy_time = pytest.importorskip("astropy.units"), pytest.importorskip("astropy.time")
    start = astropy_time.Time("2000-01-01T13:00:00", scale="tdb")
    orbit = Orbit.from_state([7000, 0, 0] * units.km, [0, 7.5, 0] * units.km / units.s, GM * units.m**3 / units.s**2, start)
    # astropy gives the time to 1e-11 s.
    assert orbit.position(3660.0) == pytest.approx(Orbit.from_state([7e6, 0, 0], [0, 7.5e3, 0], GM, 3600.0).position(3660.0), rel=1e-13, abs=1e-6)
    assert orbit.position(start + 60 * units.s) == pytest.approx(orbit.position(3660.0), rel=1e-13, abs=1e-6)


def test_first_sentence_about_an_oblate_primary_says_mean_elements():
    assert "from its mean elements" in Orbit.around_oblate.__doc__.split(".")[0]


@pytest.mark.parametrize("inclination", [28.5, 51.6, 98.0])
def test_osculating_elements_about_an_oblate_primary_miss_by_the_distance_that_the_docstring_states(inclination):
    from scipy.integrate import solve_ivp

    def rates(_, y):
        r, square = np.linalg.norm(y[:3]), (y[2] / np.linalg.norm(y[:3])) ** 2
        oblate = 1.5 * EARTH["j2"] * (EARTH["radius"] / r) ** 2
        return np.r_[y[3:], -GM * y[:3] / r**3 * (1 + oblate * (np.array([1, 1, 3]) - 5 * square))]

    misses = []
    for f in np.linspace(0, 2 * math.pi, 13)[:-1]:
        r, v = state(0.0, math.radians(inclination), 0.0, 0.0, f, p=6878e3, gm=GM)
        osculating = Orbit.from_state(r, v, GM, 0.0)
        names = ("semi_major_axis", "eccentricity", "inclination", "node", "argument_of_pericentre", "time_of_pericentre")
        given = Orbit.around_oblate(GM, **{name: getattr(osculating, name) for name in names}, **EARTH)
        truth = solve_ivp(rates, (0, 3600), np.r_[r, v], method="DOP853", rtol=1e-11, atol=1e-6).y[:3, -1]
        misses.append(np.linalg.norm(given.position(3600.0) - truth) / 1e3)
    assert 9 <= min(misses) < max(misses) < 80
    assert "9 to 80 km off after an hour" in " ".join(Orbit.around_oblate.__doc__.split())


# The scene of a later state.


def test_scene_at_a_time_goes_on_as_the_motion_does():
    sun = Orbit(2e-3, 0.1, inclination=0.4)
    for options in ({}, {"orbit": sun, "span": (0, 1000), "tolerance": 1e-9, "name": "box"}):
        scene = Scene(Body.from_inertia([[1.0, 0.1, 0], [0.1, 1.2, 0.05], [0, 0.05, 1.5]]), [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=1.0, **options)
        motion = scene.solve()
        later = motion.scene_at(300.0)
        assert (later.epoch, later.body, later.orbit, later.span, later.tolerance, later.name) == (
            300.0,
            scene.body,
            scene.orbit,
            scene.span,
            scene.tolerance,
            scene.name,
        )
        assert np.array_equal(later.attitude, motion.attitude(300.0)) and np.array_equal(later.angular_velocity, motion.angular_velocity(300.0))
        found, expected = (some.attitude([200.0, 300.0, 900.0]) for some in (later.solve(), motion))
        assert np.abs(found - expected).max() < (2e-9 if options else 1e-12)
    assert pickle.loads(pickle.dumps(later)) == later
    with pytest.raises(TypeError, match=r"time must be one time, not an array of shape \[2\]"):
        motion.scene_at([1.0, 2.0])
    with pytest.raises(andoyer.InputError, match="times"):
        motion.scene_at(math.nan)


def test_scene_after_a_torque_has_the_periods_of_that_time():
    # A passage at 1.5 radii of the Earth within a tenth of a rotation's phase changes the spin.
    scene = Scene(Body([1, 1.6, 2]), [0, 0, 0, 1], [0.01, 0.02, 0.03], orbit=Orbit(0.02, 0.5), span=(-1000, 1000), tolerance=1e-7)
    motion = scene.solve()
    assert motion.plan.method == "integrated"
    later = motion.scene_at(900.0)
    free = Scene(later.body, later.attitude, later.angular_velocity, epoch=900.0).solve()
    before, after = (some.periods["short-axis"].precession for some in (motion, later.solve()))
    assert after == free.periods["short-axis"].precession and abs(after / before - 1) > 0.01


def test_scene_at_a_calendar_time_has_a_calendar_epoch():
    units, astropy_time = pytest.importorskip("astropy.units"), pytest.importorskip("astropy.time")
    start = astropy_time.Time("2024-03-01", scale="tdb")
    motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=start).solve()
    end = start + 1e6 * units.s
    for time in (end, astropy_time.TimeDelta(1e6 * units.s), float(motion.scene.epoch) + 1e6):
        later = motion.scene_at(time)
        assert np.abs(later.solve().attitude(end + 5 * units.s) - motion.attitude(end + 5 * units.s)).max() < (1e-12 if not isinstance(time, float) else 1e-6)
        assert pickle.loads(pickle.dumps(later)) == later


# Periods that a body cannot have.


def test_refused_periods_say_in_which_mode_and_convention_they_are_possible():
    # The published periods of Toutatis are those of the long axis in the long-axis mode (Ostro et al. 1995).
    body = Body([3.085, 3.235, 1.0])
    with pytest.raises(andoyer.InputError, match="rotation/precession = 0.727") as caught:
        Scene.from_periods(body, 7.40, 5.38)
    assert str(caught.value).endswith('; the ratio is possible with mode = "long-axis" and convention = "extremal-axis"')
    Scene.from_periods(body, 7.40, 5.38, mode="long-axis")
    # A ratio that two conventions of one mode have, or both modes.
    apophis = Body([0.61, 0.965, 1.0])
    with pytest.raises(andoyer.InputError) as caught:
        Scene.from_periods(apophis, 10.0, 30.0, mode="short-axis")
    named = re.findall(r'mode = "([a-z-]+)" and convention = "([a-z-]+)"', str(caught.value).split("the ratio is possible with")[1])
    assert len(named) == 2
    for mode in ("short-axis", "long-axis"):
        for convention in ("extremal-axis", "long-axis", "short-axis"):
            least, most = apophis.period_ratios(mode=mode, convention=convention)
            assert ((mode, convention) in named) <= (least <= 3 <= most)


def test_periods_that_fit_only_if_they_are_swapped_are_named():
    body = Body([0.61, 0.965, 1.0])
    with pytest.raises(andoyer.InputError, match="the two periods fit only if they are swapped, with ") as caught:
        Scene.from_periods(body, 263.0, 27.38)
    named = re.findall(r'mode = "([a-z-]+)" and convention = "([a-z-]+)"', str(caught.value))
    assert ("short-axis", "extremal-axis") in named
    assert all(Scene.from_periods(body, 27.38, 263.0, mode=mode, convention=convention) for mode, convention in named)
    with pytest.raises(andoyer.InputError, match="no mode and no convention has this ratio, nor its inverse"):
        Scene.from_periods(Body([1.0, 1.0, 1.0 + 1e-9]), 1.0, 3.0)


@pytest.mark.parametrize("gap", [1e-3, 1.2e-6, 1e-9, 1e-12])
def test_position_far_from_the_pericentre_of_a_needle_is_that_of_thirty_digits(gap):
    mpmath = pytest.importorskip("mpmath")
    orbit = andoyer.Orbit(1.0, 1 - gap, semi_major_axis=1.0)
    with mpmath.workdps(30):
        e = mpmath.mpf(orbit.eccentricity)
        for time in (0.3, 1.0, 2.0, 3.0, 3.14):
            anomaly = mpmath.findroot(lambda x, m=time: x - e * mpmath.sin(x) - mpmath.mpf(m), max(time, 1.5))
            expected = [mpmath.cos(anomaly) - e, mpmath.sqrt(1 - e * e) * mpmath.sin(anomaly), mpmath.mpf(0)]
            found = orbit.position(time)
            off = mpmath.sqrt(sum((mpmath.mpf(float(x)) - y) ** 2 for x, y in zip(found, expected, strict=True)))
            # With 1 + e cos f the difference was 8.5e-11 at 1.2e-6 and 3.4e-5 at 1e-12.
            assert off <= 1e-14 * mpmath.sqrt(sum(y * y for y in expected)), (time, float(off))
