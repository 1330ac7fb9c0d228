"""Derivatives with respect to the state and the moments: shapes, agreement with differences, errors, pickling."""

import json
import pickle

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer import Body, Scene

CASES = {case["name"]: case for case in json.loads((REPOSITORY / "tests/data/partials.json").read_text(encoding="utf-8"))}


@pytest.mark.parametrize("name", ["short-axis", "long-axis", "oblate", "axis-3", "sphere"])
def test_derivatives_are_those_of_the_reference(name):
    case = CASES[name]
    motion = Scene(Body(case["moments"]), case["attitude0_xyzw"], case["angular_velocity0"]).solve()
    partials = motion.partials([state["t"] for state in case["states"]])
    for attitude, rates, state in zip(partials.attitude, partials.angular_velocity, case["states"], strict=True):
        for found, expected in ((attitude, state["attitude"]), (rates, state["angular_velocity"])):
            assert np.abs(found - expected).max() <= 2e-14 * np.abs(expected).max()
    assert motion.plan.partials == "closed"


def test_shapes_follow_the_times_and_the_arrays_belong_to_the_object(motion):
    partials = motion.partials([2.0, 3.0, 4.0])
    assert partials.times.tolist() == [2.0, 3.0, 4.0]
    assert partials.attitude.shape == partials.angular_velocity.shape == (3, 3, 9) and len(partials) == 3
    assert repr(partials) == "<Partials at 3 times>"
    scalar = motion.partials(3.0)
    assert scalar.attitude.shape == (3, 9) and scalar.times.shape == () and repr(scalar) == "<Partials at a scalar time>"
    assert (scalar.attitude == partials.attitude[1]).all()
    with pytest.raises(TypeError, match="no len"):
        len(scalar)
    assert motion.partials([]).attitude.shape == (0, 3, 9)


def test_many_times_on_threads_have_the_bits_of_few(motion):
    times = np.linspace(0, 1000, 20_001)
    many = motion.partials(times)
    for start in (0, 7, 10_240, 19_990):
        few = motion.partials(times[start : start + 11])
        assert (few.attitude == many.attitude[start : start + 11]).all()
        assert (few.angular_velocity == many.angular_velocity[start : start + 11]).all()


def test_partials_are_pickled(motion):
    partials = motion.partials([2.0, 3.0])
    again = pickle.loads(pickle.dumps(partials))
    assert (again.attitude == partials.attitude).all() and (again.times == partials.times).all()


def test_errors_say_why_there_are_no_derivatives(motion):
    falling = Scene(Body([3.0, 4.0, 6.0]), [0, 0, 0, 1], [2.0, 0.5, 1.0]).solve()
    assert falling.plan.mode == "separatrix" and falling.plan.partials is None
    with pytest.raises(andoyer.TheoryError, match="frequencies have no derivatives"):
        falling.partials(1.0)
    with pytest.raises(andoyer.InputError):
        motion.partials(np.nan)


def test_scene_with_an_orbit_has_derivatives_by_differences():
    scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0.02, 0.01, 1.0], orbit=andoyer.Orbit(1e-3, 0.1))
    motion = scene.solve()
    assert motion.plan.partials == "differences"
    free = Scene(scene.body, scene.attitude, scene.angular_velocity).solve().partials([10.0, 20.0])
    disturbed = motion.partials([10.0, 20.0])
    assert 1e-7 < np.abs(disturbed.attitude - free.attitude).max() < 1e-3
