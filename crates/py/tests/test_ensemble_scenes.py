"""Ensembles of scenes of any kind, clones from periods, and how members tumble at a time."""

import pickle
import warnings

import numpy as np
import pytest

import andoyer
from andoyer import Body, Ensemble, Orbit, Scene, TabulatedOrbit, Torque

TIMES = np.linspace(0.0, 40.0, 7)


def table():
    """Positions of an ellipse, 40 rows an orbit."""
    orbit = Orbit(0.3, 0.2, inclination=0.4, semi_major_axis=1.0)
    times = np.arange(-20.0, 61.0, 0.25)
    return TabulatedOrbit(times, orbit.position(times), 0.09)


def drawn(kind, random):
    """A random scene of a kind."""
    moments = np.sort(random.uniform(0.6, 1.0, 3))
    body, attitude = Body(moments), random.normal(size=4)
    attitude /= np.linalg.norm(attitude)
    rates, options = random.normal(size=3), {"span": (0.0, 40.0), "tolerance": 1e-9}
    match kind:
        case "averaged":
            body, rates = Body([0.9, 0.95, 1.0]), np.array([0.05, 0.02, 1.0])
            options |= {"orbit": Orbit(5e-3, random.uniform(0, 0.3), inclination=random.uniform(0, 1)), "tolerance": 1e-6}
        case "two bodies":
            options["orbit"] = [Orbit(0.1, 0.1), Orbit(0.2, 0.3, inclination=1.0, attraction=0.01)]
        case "precessing":
            options["orbit"] = Orbit(0.1, 0.2, node_rate=0.01, inclination=0.5)
        case "hyperbola":
            options["orbit"] = Orbit(0.1, 1.3, time_of_pericentre=20.0)
        case "table":
            options |= {"orbit": table(), "tolerance": 1e-6}
        case "torques":
            options["torques"] = [Torque.constant([1e-3, 0, 2e-3]), Torque.damping(1e-3)]
        case "tensor":
            turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
            body = Body.from_inertia(turn @ np.diag(moments) @ turn.T)
        case "locked":
            body, attitude, rates = Body([0.95, 0.98, 1.0]), [0, 0, np.sin(0.02), np.cos(0.02)], [0, 0, 1.0]
            options |= {"orbit": Orbit(1.0, 0.02), "method": "libration", "tolerance": 1e-3}
    return Scene(body, attitude, rates, **options)


KINDS = ["free", "averaged", "two bodies", "precessing", "hyperbola", "table", "torques", "tensor", "locked"]


def test_members_of_any_kind_are_their_scenes_and_depend_neither_on_neighbours_nor_on_threads():
    random = np.random.default_rng(70)
    scenes = [drawn(kind, random) for kind in KINDS for _ in range(3)]
    ensemble = Ensemble.from_scenes(scenes)
    found = ensemble.attitude(TIMES)
    for scene, rows, plan in zip(scenes, found, ensemble.plans, strict=True):
        motion = scene.solve()
        assert plan.method == motion.plan.method
        if plan.method == "integrated":
            assert np.abs(rows - motion.attitude(TIMES)).max() < 2 * (plan.error_bound + motion.plan.error_bound)
        else:
            np.testing.assert_array_equal(rows, motion.attitude(TIMES))
    order = random.permutation(len(scenes))
    shuffled = Ensemble.from_scenes([scenes[k] for k in order], threads=2)
    np.testing.assert_array_equal(shuffled.attitude(TIMES), found[order])
    assert ensemble.scenes == scenes and ensemble[4].scene == scenes[4]
    np.testing.assert_array_equal(ensemble[3:9:2].attitude(TIMES), found[3:9:2])


def test_an_ensemble_of_scenes_is_pickled_and_says_what_it_is():
    random = np.random.default_rng(71)
    ensemble = Ensemble.from_scenes([drawn(kind, random) for kind in KINDS], threads=1, errors="nan")
    copy = pickle.loads(pickle.dumps(ensemble))
    assert copy == ensemble and copy.threads == 1 and repr(copy) == "<Ensemble of 9 scenes, threads=1>"
    columns = Ensemble([1, 1.5, 2], [0, 0, 0, 1], [[0.1, 0.2, 1]] * 2, torques=Torque.damping(0.1), orbit=[Orbit(0.1), Orbit(0.2)], span=(0, 5), level="full")
    copy = pickle.loads(pickle.dumps(columns))
    assert copy == columns and len(copy.torques) == 1 and copy.level == "full" and [len(bodies) for bodies in copy.orbits] == [2]


def test_options_of_all_members_are_those_of_scenes():
    body, rates = Body([0.8, 0.9, 1.0]), [[0.1, 0.2, 1.0], [1.0, 0.1, 0.3]]
    options = {"torques": Torque.constant([1e-3, 0, 0]), "orbit": [Orbit(0.1, 0.1), table()], "span": (0, 40), "tolerance": 1e-6, "method": "integrated"}
    ensemble = Ensemble(None, [0, 0, 0, 1], rates, bodies=body, **options)
    for rate, rows in zip(rates, ensemble.attitude(TIMES), strict=True):
        np.testing.assert_allclose(rows, Scene(body, [0, 0, 0, 1], rate, **options).solve().attitude(TIMES), atol=1e-12)
    each = Ensemble(None, [0, 0, 0, 1], rates, bodies=[body, Body([1, 1, 1.5])], orbits=[None, [Orbit(0.1), Orbit(0.2)]], span=(0, 40), tolerance=1e-9)
    assert [plan.method for plan in each.plans] == ["closed", "integrated"]


def test_what_is_no_scene_or_no_body_is_named():
    scene = drawn("free", np.random.default_rng(1))
    with pytest.raises(TypeError, match=r"scenes\[1\] must be an andoyer.Scene, not dict"):
        Ensemble.from_scenes([scene, {}])
    with pytest.raises(TypeError, match="moments or bodies must be given"):
        Ensemble(None, [[0, 0, 0, 1]], [0, 0, 1])
    with pytest.raises(TypeError, match=r"bodies\[0\] must be an andoyer.Body, not list"):
        Ensemble(None, [0, 0, 0, 1], [[0, 0, 1]], bodies=[[1, 1, 1]])
    with pytest.raises(TypeError, match="orbits must be None beside it"):
        Ensemble([1, 1, 1], [0, 0, 0, 1], [[0, 0, 1]], orbit=Orbit(0.1), orbits=[Orbit(0.1)])
    with pytest.raises(TypeError, match="torques must be an andoyer.Torque"):
        Ensemble([1, 1, 1], [0, 0, 0, 1], [[0, 0, 1]], torques=[1.0])
    dated = pytest.importorskip("astropy.time").Time("2026-01-01")
    with pytest.raises(andoyer.InputError, match="one has a calendar epoch"):
        Ensemble.from_scenes([scene, Scene(scene.body, [0, 0, 0, 1], [0, 0, 1], epoch=dated)])


def test_clones_have_the_periods_asked_for_and_those_that_no_body_can_have_are_counted():
    body = Body([1.0, 3.0836, 3.235])
    random = np.random.default_rng(5)
    precession, rotation = 27.38 + 0.1 * random.normal(size=20), 263.0 + 3 * random.normal(size=20)
    rotation[7] = 1.0  # shorter than this body's shape allows
    directions = np.array([4.8, -1.4]) + 0.02 * random.normal(size=(20, 2))
    options = {"phases": (0.2, 0.3), "epoch": 10.0, "tolerance": 1e-9}
    with pytest.raises(andoyer.InputError, match="member 7"):
        Ensemble.from_periods(body, precession, rotation, "short-axis", directions, **options)
    clones = Ensemble.from_periods(body, precession, rotation, "short-axis", directions, errors="nan", **options)
    assert list(clones.errors) == [7] and clones.scenes[7] is None
    periods = clones.periods["extremal-axis"]
    served = np.arange(20) != 7
    np.testing.assert_allclose(periods.precession[served], precession[served], rtol=1e-12)
    np.testing.assert_allclose(periods.rotation[served], rotation[served], rtol=1e-12)
    alone = Scene.from_periods(body, precession[3], rotation[3], mode="short-axis", momentum_direction=directions[3], **options)
    np.testing.assert_array_equal(clones.attitude(50.0)[3], alone.solve().attitude(50.0))
    assert clones == Ensemble.from_periods(body, precession, rotation, "short-axis", directions, errors="nan", **options) and clones.epochs == 10.0
    one = Ensemble.from_periods([body], precession[:1], rotation[:1], "short-axis", directions[:1], span=None, **options)
    np.testing.assert_array_equal(one.attitude(50.0)[0], clones.attitude(50.0)[0])
    with pytest.raises(andoyer.InputError, match="precession has 20 members and rotation 1"):
        Ensemble.from_periods(body, precession, rotation[:1])
    with pytest.raises(andoyer.InputError, match="precession has 20 members and rotation 3"):
        Ensemble.from_periods(body, precession, rotation[:3])
    with pytest.raises(TypeError, match="order is not an option"):
        Ensemble.from_periods(body, precession, 263.0, order=3)


@pytest.mark.parametrize("dated", [False, True])
@pytest.mark.parametrize("place", [0, 3])
def test_refused_members_are_pickled_with_their_errors(place, dated):
    epoch, seconds = 10.0, 1.0
    if dated:
        epoch, seconds = pytest.importorskip("astropy.time").Time("2026-01-01", scale="tdb"), pytest.importorskip("astropy.units").s
    rotation = np.full(5, 263.0) + np.arange(5)
    rotation[place] = 1.0  # shorter than this body's shape allows
    options = {"errors": "nan", "epoch": epoch, "orbit": Orbit(1e-3, 0.1), "span": (epoch, epoch + 9.0 * seconds), "tolerance": 1e-6}
    clones = Ensemble.from_periods(Body([1.0, 3.0836, 3.235]), 27.38, rotation, phases=(0.1, 0.2), **options)
    copy = pickle.loads(pickle.dumps(clones))
    assert copy == clones and pickle.loads(pickle.dumps(copy)) == clones and copy[1:] == clones[1:]
    assert list(copy.errors) == list(clones.errors) == [place]
    error, same = clones.errors[place], copy.errors[place]
    assert (type(same), str(same), same.argument, same.value, same.bound, same.index) == (
        type(error),
        str(error),
        error.argument,
        error.value,
        error.bound,
        error.index,
    )
    times = epoch + np.array([0.0, 5.0]) * seconds
    kept, given = copy.at(times), clones.at(times)
    for name in ("attitude", "angular_velocity"):
        assert getattr(kept, name).tobytes() == getattr(given, name).tobytes() and np.isnan(getattr(given, name)[place]).all()


def test_an_error_in_the_place_of_a_scene_is_that_of_the_member():
    scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1])
    problem = andoyer.TheoryError("no motion")
    assert list(Ensemble.from_scenes([scene, problem], errors="nan").errors) == [1]
    with pytest.raises(andoyer.TheoryError, match="member 1: no motion"):
        Ensemble.from_scenes([scene, problem])
    alone = Ensemble.from_scenes([problem, problem], errors="nan")
    assert pickle.loads(pickle.dumps(alone)) == alone and np.isnan(alone.attitude(0.0)).all()
    # The error of a member has its number once, and attributes that are none are left out.
    of_member = alone.errors[1]
    of_member.argument, of_member.value = 5, 10**40
    again = Ensemble.from_scenes([scene, scene, of_member], errors="nan").errors[2]
    assert (str(again), again.argument, again.value, again.index) == ("member 2: no motion", None, str(10**40), 2)


def test_columns_refuse_a_body_with_a_gravity_field():
    body = Body([0.729, 0.947, 1.0], gravity=andoyer.Gravity({"C30": 1e-3}, 1.0, inertia_factor=0.4))
    with pytest.raises(andoyer.InputError, match=r"bodies has a gravity field.*from_scenes"):
        Ensemble.from_periods(body, [27.45, 27.5], 265.7)
    with pytest.raises(andoyer.InputError, match=r"bodies\[1\] has a gravity field"):
        Ensemble(None, [0, 0, 0, 1], [0.1, 0.2, 1], bodies=[Body([1, 1.5, 2]), body])


def test_a_distribution_has_the_free_motion_of_each_state_then():
    body = Body([1.0, 1.5, 2.0])
    rates = np.array([[0.1, 0.2, 1.0], [1.0, 0.2, 0.1], [0.3, 0.9, 0.42]])
    torque = Torque.polynomial(["0.05*w1*w2*w2", "-0.05*w1*w1*w2", "0"])  # turns the momentum within the body
    ensemble = Ensemble(None, [0, 0, 0, 1], rates, bodies=body, torques=torque, span=(0, 60), tolerance=1e-9)
    found = ensemble.after(60.0)
    samples = ensemble.at(60.0)
    for member in range(3):
        free = Scene(body, samples.attitude[member], samples.angular_velocity[member]).solve()
        assert found.mode[member] == free.plan.mode
        assert found.energy_ratio[member] == pytest.approx(free.energy_ratio, rel=1e-12)
        for convention, pair in free.periods.items():
            assert found.periods[convention].precession[member] == pytest.approx(pair.precession, rel=1e-9)
        np.testing.assert_allclose(found.angular_momentum[member], free.angular_momentum(0.0), atol=1e-12)
    np.testing.assert_array_equal(found.changed, [found.mode[k] != ensemble[k].plan.mode for k in range(3)])
    np.testing.assert_allclose(np.linalg.norm(found.direction, axis=1), 1, rtol=1e-14)
    assert sum(found.share().values()) == pytest.approx(1)
    assert found.quantiles([0, 1])["momentum"].tolist() == [found.momentum.min(), found.momentum.max()]
    assert found.to_pandas()["mode"].tolist() == found.mode.tolist()
    with pytest.raises(TypeError, match="time must be one time"):
        ensemble.after([1.0, 2.0])


def test_a_member_that_does_not_reach_the_time_is_counted_out():
    random = np.random.default_rng(2)
    short = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1], torques=Torque.damping(0.01), span=(0, 10), tolerance=1e-9)
    ensemble = Ensemble.from_scenes([short, drawn("free", random)], errors="nan")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ensemble.after(20.0)
    assert list(found.errors) == [0] and found.mode[0] == "" and np.isnan(found.momentum[0]) and len(found.share()) == 1


def test_what_scenes_do_not_have_in_common_is_none_and_no_motion_has_no_quantile():
    free = {"body": Body([1, 1.5, 2]), "attitude": [0, 0, 0, 1], "angular_velocity": [0.1, 0.2, 1]}
    mixed = Ensemble.from_scenes([Scene(**free, tolerance=1e-9), Scene(**free, tolerance=1e-6, torques=Torque.damping(0.1), span=(0, 1))])
    assert mixed.tolerance is None and mixed.torques is None and mixed.span is None and mixed.method == "auto"
    assert Ensemble.from_scenes([Scene(**free, tolerance=1e-9)] * 2).tolerance == 1e-9
    assert all(np.isnan(value) for value in Ensemble.from_scenes([]).after(0.0).quantiles(0.5).values())


def test_a_distribution_is_drawn_by_mode():
    pytest.importorskip("matplotlib").use("Agg")
    from andoyer import plot

    ensemble = Ensemble([1, 1.5, 2], [0, 0, 0, 1], [[0.1, 0.2, 1], [1, 0.2, 0.1], [0.2, 0.1, 1]])
    figure = plot.distribution(ensemble.after(0.0))
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["short-axis, 66.7 %", "long-axis, 33.3 %"]
    assert [len(drawn.get_offsets()) for drawn in figure.axes[1].collections] == [2, 1]
