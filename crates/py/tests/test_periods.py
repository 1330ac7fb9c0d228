"""Scenes from periods and Andoyer variables, bodies from tensors and shapes."""

import copy
import pickle

import numpy as np
import pytest

import andoyer
from andoyer import Body, InputError, Orbit, Scene

APOPHIS = Body([0.61, 0.965, 1.0])
TENSOR = [[1.2, 0.1, -0.05], [0.1, 1.5, 0.2], [-0.05, 0.2, 1.9]]


@pytest.mark.parametrize("convention", ["extremal-axis", "long-axis", "short-axis"])
@pytest.mark.parametrize("mode", ["short-axis", "long-axis"])
def test_a_motion_has_the_periods_that_it_was_made_from(mode, convention):
    body = Body([1.5, 1.0, 1.9])
    low, high = body.period_ratios(mode, convention=convention)
    assert 0 < low < high
    scene = Scene.from_periods(body, 7.0, 7.0 * 1.2 * low, mode=mode, convention=convention, phases=(0.3, 0.8))
    assert scene.solve().plan.mode == mode
    assert scene.solve().periods[convention] == pytest.approx((7.0, 7.0 * 1.2 * low), rel=1e-12)
    for ratio in np.geomspace(1.5 * low, high, 7)[:-1]:
        motion = Scene.from_periods(body, 7.0, 7.0 * ratio, mode=mode, convention=convention, phases=(0.3, 0.8)).solve()
        assert motion.plan.mode == mode
        assert motion.periods[convention] == pytest.approx((7.0, 7.0 * ratio), rel=1e-9)
    with pytest.raises(InputError, match="P_ψ/P_φ from"):
        Scene.from_periods(body, 7.0, 7.0 * 1.01 * high, mode=mode, convention=convention)


def test_options_are_those_of_a_scene():
    orbit = Orbit(1e-5)
    scene = Scene.from_periods(APOPHIS, 27.38, 263.0, epoch=4.0, orbit=orbit, tolerance=1e-9, span=(0, 10), name="Apophis")
    assert (scene.epoch, scene.orbit, scene.tolerance, scene.span, scene.name) == (4.0, orbit, 1e-9, (0, 10), "Apophis")
    assert scene.body == APOPHIS
    again = Scene.from_andoyer(APOPHIS, scene.solve().andoyer(4.0), epoch=4.0, orbit=orbit, method="closed")
    assert again.method == "closed"
    assert np.abs(again.angular_velocity - Scene.from_periods(APOPHIS, 27.38, 263.0).angular_velocity).max() < 1e-6
    for bad in ({"scalar_first": True}, {"torque": 1}):
        with pytest.raises(TypeError):
            Scene.from_periods(APOPHIS, 27.38, 263.0, **bad)


def test_momentum_points_to_a_longitude_and_a_latitude_or_along_a_vector():
    by_angles = Scene.from_periods(APOPHIS, 27.38, 263.0, momentum_direction=[0.4, -1.1]).solve()
    vector = [np.cos(1.1) * np.cos(0.4), np.cos(1.1) * np.sin(0.4), -np.sin(1.1)]
    momentum = by_angles.angular_momentum(0.0)
    assert momentum / np.linalg.norm(momentum) == pytest.approx(vector, abs=4e-15)
    by_vector = Scene.from_periods(APOPHIS, 27.38, 263.0, momentum_direction=np.multiply(vector, 3)).solve()
    assert by_vector.angular_momentum(0.0) == pytest.approx(momentum, abs=4e-15)
    with pytest.raises(andoyer.InputError, match=r"\(4,\): it must be \(3,\) or \(2,\)"):
        Scene.from_periods(APOPHIS, 27.38, 263.0, momentum_direction=[1, 2, 3, 4])


@pytest.mark.parametrize(
    "arguments, said",
    [
        ({"precession": 263.0, "rotation": 27.38}, "P_ψ/P_φ from 7.56"),
        ({"precession": 0.0}, "precession = 0"),
        ({"rotation": np.inf}, "rotation = inf"),
        ({"mode": "tumbling"}, 'mode = "tumbling"'),
        ({"convention": "L"}, 'convention = "L"'),
        ({"momentum_direction": [0, 0, 0]}, "momentum_direction"),
        ({"phases": [0, np.nan]}, "phases"),
        ({"body": Body([1, 1, 1.5]), "mode": "long-axis"}, "two smallest moments are equal"),
    ],
)
def test_periods_that_no_motion_has_are_refused(arguments, said):
    arguments = {"body": APOPHIS, "precession": 27.38, "rotation": 263.0} | arguments
    with pytest.raises(InputError) as problem:
        Scene.from_periods(**arguments)
    assert said in str(problem.value)


def test_andoyer_variables_out_of_bounds_are_refused():
    for index, value in ((0, np.nan), (3, 2.0), (4, 0.0), (5, -2.0)):
        variables = [0.1, 0.2, 0.3, 0.5, 1.0, 0.9]
        variables[index] = value
        with pytest.raises(InputError, match=rf"andoyer\[{index}\]"):
            Scene.from_andoyer(APOPHIS, variables)


def test_a_tensor_keeps_the_axes_of_its_user():
    body = Body.from_inertia(TENSOR, name="satellite")
    assert body.inertia.tolist() == TENSOR
    axes = body.principal_axes
    assert np.abs(axes @ np.diag(body.moments) @ axes.T - TENSOR).max() < 4e-15
    assert np.abs(axes.T @ axes - np.eye(3)).max() < 2e-15 and np.linalg.det(axes) > 0
    motion = Scene(body, [0.1, -0.2, 0.3, 0.9273618495495703], [0.3, -0.1, 1.0]).solve()
    samples = motion.at(np.linspace(0, 50, 11))
    momenta = motion.rotation(samples.times).apply(samples.angular_velocity @ np.array(TENSOR))
    assert momenta == pytest.approx(motion.angular_momentum(samples.times), abs=1e-14)
    assert motion.scene.body is not None and motion.scene.body == body


def test_bodies_of_a_tensor_are_kept(body):
    tilted = Body.from_inertia(TENSOR, name="satellite")
    for kept in (pickle.loads(pickle.dumps(tilted)), copy.deepcopy(tilted), eval(repr(tilted), vars(andoyer))):
        assert kept == tilted and hash(kept) == hash(tilted) and kept.name == "satellite"
    scene = Scene(tilted, [0, 0, 0, 1], [0.3, -0.1, 1.0])
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert tilted != body


def test_a_scene_of_a_tensor_is_written_to_a_file(tmp_path):
    scene = Scene(Body.from_inertia(TENSOR), [0, 0, 0, 1], [0.3, -0.1, 1.0])
    path = tmp_path / "scene.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    assert Scene.from_toml(path) == scene


def test_shapes_have_the_moments_of_their_textbook():
    assert Body.ellipsoid(3, 2, 1, mass=5).moments.tolist() == [5.0, 10.0, 13.0]
    assert Body.box(3, 2, 1, mass=12, name="book").moments.tolist() == [5.0, 10.0, 13.0]
    assert Body.box(3, 2, 1, name="book").name == "book"
    for shape in (Body.ellipsoid, Body.box):
        for bad in ((0, 1, 1), (1, -1, 1), (1, 1, np.nan)):
            with pytest.raises(andoyer.InputError, match="must be positive and finite"):
                shape(*bad)
        with pytest.raises(andoyer.InputError, match="mass = 0"):
            shape(1, 1, 1, mass=0)


def test_bad_tensors_are_refused_and_a_tensor_given_to_body_points_to_from_inertia():
    with pytest.raises(andoyer.InputError, match=r"\(3, 3\).*Body\.from_inertia"):
        Body(TENSOR)
    with pytest.raises(andoyer.InputError, match=r"\(3,\): it must be \(3, 3\)"):
        Body.from_inertia([1, 1.5, 2])
    for bad, said in (
        ([[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]], r"tensor\[0\]\[1\] = 0.1 and tensor\[1\]\[0\] = 0.2"),
        ([[1, 2, 0], [2, 1, 0], [0, 0, 1]], "each must be positive"),
        (np.full((3, 3), np.nan), "finite and symmetric"),
        ([[1, 0.3, 0], [0.3, 1, 0], [0, 0, 2.5]], "the largest must not exceed"),
    ):
        with pytest.raises(andoyer.InputError, match=said):
            Body.from_inertia(bad)


@pytest.mark.parametrize("mode, axis", [("short-axis", 2), ("long-axis", 0)])
def test_state_near_an_attitude_and_its_sense(mode, axis, tmp_path):
    ratio = 1.05 * APOPHIS.period_ratios(mode)[0]
    common = {"mode": mode, "momentum_direction": [1.0, 2.0, -0.5]}
    for sense in (1, -1, np.sign(-3.0)):
        own = Scene.from_periods(APOPHIS, 3.0, 3.0 * ratio, sense=sense, phases=(0.3, 0.8), **common)
        assert own.angular_velocity[axis] * sense > 0
        for attitude, options in ((own.attitude, {}), (np.roll(own.attitude, 1), {"scalar_first": True})):
            near = Scene.from_periods(APOPHIS, 3.0, 3.0 * ratio, attitude=attitude, **common, **options)
            assert near.attitude == pytest.approx(own.attitude, abs=1e-9) or near.attitude == pytest.approx(-own.attitude, abs=1e-9)
            assert near.angular_velocity == pytest.approx(own.angular_velocity, abs=1e-8)
        text = f"[body]\nmoments = {APOPHIS.moments.tolist()}\n[periods]\nprecession = 3.0\nrotation = {3.0 * ratio!r}\nmode = '{mode}'\n"
        text += f"momentum_direction = [1.0, 2.0, -0.5]\nsense = {int(sense)}\n"
        (tmp_path / "scene.toml").write_text(text + "phases = [0.3, 0.8]\n", encoding="utf-8")
        assert Scene.from_toml(tmp_path / "scene.toml").attitude == pytest.approx(own.attitude, abs=1e-15)
        (tmp_path / "scene.toml").write_text(text + f"attitude = {own.attitude.tolist()}\n", encoding="utf-8")
        assert Scene.from_toml(tmp_path / "scene.toml").angular_velocity == pytest.approx(own.angular_velocity, abs=1e-8)
    with pytest.raises(andoyer.InputError, match="sense"):
        Scene.from_periods(APOPHIS, 3.0, 3.0 * ratio, sense=2, **common)
    with pytest.raises(andoyer.InputError, match="phases"):
        Scene.from_periods(APOPHIS, 3.0, 3.0 * ratio, attitude=[0, 0, 0, 1], phases=(0.0, 0.0), **common)
    with pytest.raises(andoyer.InputError, match="attitude"):
        Scene.from_periods(APOPHIS, 3.0, 3.0 * ratio, attitude=[0, 0, 0, 2], **common)
