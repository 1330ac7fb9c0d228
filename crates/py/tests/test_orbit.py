"""Orbits: what they hold and refuse; motions under the gravity gradient against an integration, and what they cost."""

import copy
import math
import pickle
import warnings

import numpy as np
import pytest
from conftest import REPOSITORY
from gravity_gradient import GravityGradient

import andoyer
from andoyer import Body, InputError, Orbit, Scene

NAN, INF = math.nan, math.inf
ELEMENTS = ["mean_motion", "eccentricity", "time_of_pericentre", "inclination", "node", "argument_of_pericentre", "mass_fraction"]
VALUES = [2e-3, 0.1, -5.0, 0.4, 0.5, 0.6, 0.7]
TILTED = Orbit(**dict(zip(ELEMENTS, VALUES)))


def angle(p, q):
    """Angles [rad] of the rotations between attitudes."""
    apart = np.minimum(np.linalg.norm(p - q, axis=-1), np.linalg.norm(p + q, axis=-1))
    return 4 * np.arcsin(apart / 2)


@pytest.fixture(scope="module")
def scene():
    nutation = 0.02
    pole = np.array([math.sin(nutation), 0.0, math.cos(nutation)])
    return Scene(Body([1, 1.02, 1.05]), [0.1, 0.2, 0.4, math.sqrt(0.79)], pole / [1, 1.02, 1.05], epoch=3.0, orbit=TILTED, tolerance=1e-7)


def test_orbit_holds_what_it_was_given_or_the_defaults():
    assert [getattr(TILTED, name) for name in ELEMENTS] == VALUES
    assert [getattr(Orbit(1), name) for name in ELEMENTS] == [1, 0, 0, 0, 0, 0, 1]
    assert Orbit(np.float32(0.5), np.array(0.25)).eccentricity == 0.25


def test_orbit_is_compared_hashed_copied_pickled_and_pasted_back_by_its_elements():
    assert eval(repr(TILTED), vars(andoyer).copy()) == TILTED
    assert pickle.loads(pickle.dumps(TILTED)) == TILTED and copy.deepcopy(TILTED) is TILTED
    assert Orbit(1, 0.5) == Orbit(1.0, 0.5, node=-0.0) and hash(Orbit(1, 0.5)) == hash(Orbit(1.0, 0.5, node=-0.0))
    for name in ELEMENTS:
        assert Orbit(**dict(zip(ELEMENTS, VALUES)) | {name: 0.3}) != TILTED


BAD_ELEMENTS = [
    *[("mean_motion", value) for value in [0, -1, NAN, INF]],
    *[("eccentricity", value) for value in [1, -0.1, NAN]],
    *[("mass_fraction", value) for value in [0, 1.1, NAN]],
    *[(name, value) for name in ELEMENTS[2:6] for value in [NAN, -INF]],
]


@pytest.mark.parametrize("name, value", BAD_ELEMENTS)
def test_element_that_no_orbit_has_is_refused_and_named(name, value):
    with pytest.raises(andoyer.InputError, match=f"orbit.{name} = .*: it must be"):
        Orbit(**{"mean_motion": 1.0, name: value})
    with pytest.raises(TypeError) as caught:
        Orbit(**{"mean_motion": 1.0, name: "much"})
    assert str(caught.value) == f"{name} must be a real number: got 'much'"


def test_scene_keeps_its_orbit_through_pickle_repr_and_file(scene, tmp_path):
    given = Scene(scene.body, scene.attitude, scene.angular_velocity, orbit=TILTED, averaging="spin", level="moving")
    assert (given.orbit, given.averaging, given.level) == (TILTED, "spin", "moving")
    assert eval(repr(given), vars(andoyer).copy()) == given == pickle.loads(pickle.dumps(given))
    assert given != Scene(scene.body, scene.attitude, scene.angular_velocity, averaging="spin", level="moving")
    path = tmp_path / "orbit.toml"
    path.write_text(given.to_toml(), encoding="utf-8")
    assert Scene.from_toml(path) == given and hash(Scene.from_toml(path)) == hash(given)
    assert Scene(scene.body, [0, 0, 0, 1], [0, 0, 1]).orbit is None


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_attitude_is_that_of_an_integration_within_the_bound_of_the_plan(scene):
    motion = scene.solve()
    times = scene.epoch + np.linspace(0, 600, 13)
    attitude, rates = GravityGradient(scene.body.moments, scene.attitude, scene.angular_velocity, TILTED, scene.epoch).states(times)
    found = motion.at(times)
    spanned = Scene(scene.body, scene.attitude, scene.angular_velocity, epoch=3.0, orbit=TILTED, tolerance=1e-7, span=(3, 603)).solve()
    # 1e-11 for the integration over 100 rotations.
    bound = spanned.plan.error_bound + 1e-11
    free = Scene(scene.body, scene.attitude, scene.angular_velocity, epoch=3.0).solve()
    assert bound < 1e-7 < 1e-5 < angle(free.attitude(times), attitude).max()
    assert angle(found.attitude, attitude).max() < bound
    assert np.abs(found.angular_velocity - rates).max() < bound


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_angular_momentum_is_that_of_the_state_and_varies(scene):
    motion = scene.solve()
    times = scene.epoch + np.linspace(0, 600, 7)
    momentum, samples = motion.angular_momentum(times), motion.at(times)
    turned = motion.rotation(times).apply(samples.angular_velocity * scene.body.moments)
    assert np.abs(momentum - turned).max() < 1e-14
    assert np.linalg.norm(momentum - momentum[0], axis=1)[1:].min() > 1e-6
    free = Scene(scene.body, scene.attitude, scene.angular_velocity).solve()
    assert np.ptp(free.angular_momentum(times), axis=0).max() == 0


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_plan_says_how_the_torque_is_averaged_and_how_large_it_is(scene):
    plan = scene.solve().plan
    assert plan.averaging == "spin" and 1e-7 < plan.torque < 1e-5
    assert f"averaged over the {plan.averaging}" in str(plan)
    assert plan.level in ("full", "second-order") and f"gradient      {plan.level}," in str(plan)
    coarse = Scene(scene.body, scene.attitude, scene.angular_velocity, orbit=TILTED, averaging="orbit", tolerance=1e-2)
    assert coarse.solve().plan.averaging == "orbit"
    free = Scene(scene.body, scene.attitude, scene.angular_velocity).solve().plan
    assert (free.averaging, free.torque) == (None, 0.0)


NOT_AVERAGED = {
    "resonance": (andoyer.TheoryError, [0, 0.01, 1], Orbit(0.038348, inclination=0.5, mass_fraction=3e-2), r"\(h, m\) = \(2, 0\).*more than 3"),
    "separatrix": (andoyer.TheoryError, [0, 1, 1e-3], Orbit(1e-3), "σ/σ_sep = 0.99.*0.9"),
    "rest": (andoyer.TheoryError, [0, 0, 0], Orbit(1e-3), "^orbit: a body at rest has no averaged theory$"),
}


@pytest.mark.parametrize("error, rates, orbit, message", NOT_AVERAGED.values(), ids=NOT_AVERAGED)
def test_motion_without_an_averaged_theory_is_refused(error, rates, orbit, message):
    with pytest.raises(error, match=message):
        Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], rates, orbit=orbit).solve()


@pytest.mark.parametrize("error, keyword", [(andoyer.InputError, "averaging"), (andoyer.InputError, "level")])
def test_unknown_choice_is_refused_with_the_known_ones(error, keyword):
    with pytest.raises(error, match=f'{keyword} = "moon".*must be "'):
        Scene(Body([1, 2, 2]), [0, 0, 0, 1], [0, 0, 1], **{keyword: "moon"})


def test_what_is_no_orbit_is_refused_by_its_kind():
    with pytest.raises(TypeError) as caught:
        Scene(Body([1, 2, 2]), [0, 0, 0, 1], [0, 0, 1], orbit=1e-3)
    assert str(caught.value) == "orbit must be an andoyer.Orbit, a TabulatedOrbit, a sequence of them or None: got float; use Orbit(mean_motion)"
    # The keys of a dict were taken for bodies: "got str".
    with pytest.raises(TypeError, match="got dict; use Orbit"):
        Scene(Body([1, 2, 2]), [0, 0, 0, 1], [0, 0, 1], orbit={"n": 1e-3})


def test_attraction_stands_without_a_mass_fraction():
    assert Orbit(1.0, 0.5, attraction=0.3, mass_fraction=1.0) == Orbit(1.0, 0.5, attraction=0.3)
    # The fraction was ignored.
    with pytest.raises(andoyer.InputError, match="orbit.attraction = 0.3: it must be absent, or given with no mass_fraction other than 1"):
        Orbit(1.0, 0.5, attraction=0.3, mass_fraction=0.5)


def test_example_scene_precesses_at_the_rate_of_the_averaged_theory():
    motion = Scene.from_toml(REPOSITORY / "examples/scenes/eros-sun.toml").solve()
    year, orbits = 31557600.0, 100
    period = 2 * math.pi / motion.scene.orbit.mean_motion
    times = [0.0, orbits * period]
    variables, momentum = motion.andoyer(times), motion.angular_momentum(times)
    rate = (variables[1, 0] - variables[0, 0]) / times[1] * year * 648000 / math.pi
    # -2.872 "/yr at J = 0, as its source says. The mean of (3 T33 - A - B - C)/2 over the wobble is 1.0 % below d; the pole's yearly swing of 52" starts
    # at its lowest, so that cos I = 0.01745 is 0.9 % more on the mean. Short-period terms at the ends, 1.3e-6 rad, are 0.1 %.
    assert rate == pytest.approx(-2.872, rel=5e-3)
    assert variables[:, 0] == pytest.approx(np.arctan2(momentum[:, 0], -momentum[:, 1]), abs=1e-15)
    assert variables[:, 3] == pytest.approx(momentum[:, 2], rel=1e-15)
    assert variables[:, 4] == pytest.approx(np.linalg.norm(momentum, axis=1), rel=1e-15)


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_andoyer_angles_give_the_attitude_back_under_a_torque(scene):
    from scipy.spatial.transform import Rotation

    motion = scene.solve()
    times = scene.epoch + np.linspace(-300, 600, 50)
    node, mu, nu, axial, total, spin = motion.andoyer(times).T
    angles = np.column_stack([node, np.arccos(axial / total), mu])
    tilt = np.column_stack([np.arccos(spin / total), nu])
    found = (Rotation.from_euler("ZXZ", angles) * Rotation.from_euler("XZ", tilt)).as_quat()
    # The arccosine of N/M loses half the digits at J = 0.02.
    assert angle(found, motion.attitude(times)).max() < 1e-13


@pytest.mark.parametrize(
    ("elements", "argument"),
    [
        ({"mean_motion": 5e-324}, "mean_motion"),
        ({"mean_motion": 1e-300}, "mean_motion"),
        ({"mean_motion": 1e200}, "mean_motion"),
        ({"mean_motion": 0.1, "mass_fraction": 5e-324}, "mass_fraction"),
        ({"mean_motion": 1e-150, "mass_fraction": 1e-20}, "mass_fraction"),
        ({"mean_motion": 1e-200, "attraction": 1e-6}, "attraction"),
        ({"mean_motion": 1e100, "attraction": 1e-200}, "attraction"),
        ({"mean_motion": 0.1, "attraction": 1e308}, "attraction"),
    ],
)
@pytest.mark.parametrize("method", ["auto", "integrated"])
def test_a_torque_that_no_double_holds_is_refused_by_name(elements, argument, method):
    orbit = Orbit(eccentricity=0.1, **elements)
    with pytest.raises(InputError, match=f"orbit.{argument} = .* normal doubles") as caught:
        Scene(Body([0.5, 0.75, 1.0]), [0, 0, 0, 1], [0.2, 0.3, 1.1], orbit=orbit, span=(0, 20), method=method)
    assert caught.value.argument == argument


@pytest.mark.parametrize(("length", "time", "gm", "factor"), [(1.0, 1.0, 3.986e14, "1.0e-9"), (1e3, 1.0, 3.986e5, "1.0e9"), (1.0, 1 / 86400, 3.986e5, "7.5e9")])
def test_units_of_a_table_that_do_not_fit_those_of_gm_are_said(length, time, gm, factor):
    seconds = np.arange(0, 86400, 600.0)
    angle = 7.2921e-5 * seconds
    kilometres = 42164.2 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    with pytest.warns(UserWarning, match=f"acceleration of the table is {factor} times gm: do positions, times and gm have the same units"):
        andoyer.TabulatedOrbit(seconds * time, kilometres * length, gm)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        andoyer.TabulatedOrbit(seconds, kilometres, 3.986e5)
        andoyer.TabulatedOrbit(seconds, kilometres, 3.986e5 / 82)  # a small partner, whose primary is heavier


@pytest.mark.parametrize(("gm", "distance", "angle"), [(324858.6, 1.8e8, 0.4), (42828.4, 2.2e8, 1.3), (1.9e-3, 5e6, 2.0)])
def test_a_body_that_does_not_hold_the_satellite_has_no_doubtful_units(gm, distance, angle):
    """Venus, Mars and a small asteroid from a low orbit: the satellite's acceleration is that towards the Earth."""
    seconds = np.arange(0, 86400, 60.0)
    turned = np.sqrt(398600.4418 / 7000**3) * seconds
    satellite = 7000 * np.stack([np.cos(turned), np.sin(turned) * np.cos(0.9), np.sin(turned) * np.sin(0.9)], axis=1)
    far = distance * np.array([np.cos(angle), np.sin(angle), 0.05])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        andoyer.TabulatedOrbit(seconds, far - satellite, gm)
