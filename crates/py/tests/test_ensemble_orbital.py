"""Ensembles whose states are given against the orbital frame, and seen from it: each member is the scene of `Scene.from_orbital`."""

import numpy as np
import pytest

from andoyer import Body, Ensemble, InputError, Orbit, Scene

ORBIT = Orbit(1e-3, eccentricity=0.01, inclination=0.9)
BODY = Body([1.5, 2.0, 1.0])
GIVEN = {"elements_of": "rotating", "frame": "lvlh"}
OPTIONS = {"span": (0, 6e3), "tolerance": 1e-8}
TIMES = np.linspace(0, 6e3, 7)


def draws(count, seed=1):
    generator = np.random.default_rng(seed)
    return 0.2 * generator.standard_normal((count, 3)), 1e-4 * generator.standard_normal((count, 3))


@pytest.mark.parametrize("sequence", ["ZYX", "XZX"])
def test_members_are_the_scenes_of_their_states(sequence):
    angles, rates = draws(20)
    ensemble = Ensemble.from_orbital(BODY, angles, rates, orbit=ORBIT, sequence=sequence, **GIVEN, **OPTIONS)
    seen = ensemble.orbital(TIMES, sequence=sequence, **GIVEN)
    assert seen.attitude.shape == (20, 7, 4) and seen.angles.shape == seen.angular_velocity.shape == (20, 7, 3) and len(seen) == 20
    for index in (0, 7, 19):
        scene = Scene.from_orbital(BODY, angles[index], rates[index], orbit=ORBIT, sequence=sequence, **GIVEN, **OPTIONS)
        assert ensemble.scenes[index] == scene
        alone = scene.solve().orbital(TIMES, sequence=sequence, **GIVEN)
        assert np.abs(seen.angles[index] - alone.angles).max() < 1e-8 and np.abs(seen.attitude[index] - alone.attitude).max() < 1e-8
        assert np.abs(seen.angular_velocity[index] - alone.angular_velocity).max() < 1e-10


def test_the_angles_at_the_epoch_are_those_that_were_given():
    angles, rates = draws(5)
    ensemble = Ensemble.from_orbital(BODY, angles, rates, orbit=ORBIT, epoch=50.0, **GIVEN, span=(50, 100), method="integrated")
    seen = ensemble.orbital(50.0, **GIVEN)
    assert seen.angles.shape == (5, 3) and np.abs(seen.angles - angles).max() < 1e-12 and np.abs(seen.angular_velocity - rates).max() < 1e-15


def test_quaternions_orbits_and_bodies_of_each():
    angles, rates = draws(3)
    orbits = [Orbit(1e-3), Orbit(2e-3, eccentricity=0.1), ORBIT]
    bodies = [BODY, Body([1, 1.2, 1.5]), Body.from_inertia([[1.5, 0.2, 0], [0.2, 1.5, 0], [0, 0, 2]])]
    turns = Ensemble.from_orbital(BODY, angles, rates, orbit=ORBIT, **GIVEN, **OPTIONS).orbital(0.0, **GIVEN).attitude
    ensemble = Ensemble.from_orbital(bodies, np.roll(turns, 1, axis=1), [0, 0, 0], orbits=orbits, scalar_first=True, **GIVEN, **OPTIONS)
    for index, scene in enumerate(ensemble.scenes):
        expected = Scene.from_orbital(bodies[index], turns[index], [0, 0, 0], orbit=orbits[index], **GIVEN, **OPTIONS)
        assert np.abs(np.subtract(scene.attitude, expected.attitude)).max() < 1e-15 and scene.orbit == expected.orbit
    rows = ensemble.orbital(np.stack([TIMES[:2]] * 3), **GIVEN)
    assert np.array_equal(rows.angles, ensemble.orbital(TIMES[:2], **GIVEN).angles)


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"elements_of": "satellite"}, InputError, "elements_of"),
        ({"frame": "ntw"}, InputError, "frame"),
        ({"sequence": "ZZX"}, InputError, "sequence"),
        ({"attitudes": [[0, 0, np.nan]] * 2}, InputError, "0"),
        ({"attitudes": [[0, 0, 0, 2.0]] * 2}, InputError, "0"),
        ({"attitudes": [[0, 0]] * 2}, InputError, "attitudes"),
        ({"attitudes": [[0, 0, 0]] * 3, "angular_velocities": [[0, 0, 0]] * 2}, InputError, "attitudes has 3 members and angular_velocities 2"),
        ({"attitudes": [0, 0, 0]}, InputError, "one of them must have an axis of members"),
        ({"orbit": None}, InputError, "of"),
        ({"colour": 1}, TypeError, "colour is not an option of Ensemble.from_orbital"),
        ({"of": 1}, InputError, "of"),
    ],
)
def test_a_wrong_argument_is_named(changes, error, message):
    given = {"attitudes": [[0, 0, 0], [0, 0, 0.1]], "angular_velocities": [0, 0, 0], "orbit": ORBIT, **GIVEN} | changes
    with pytest.raises(error, match=message):
        Ensemble.from_orbital(BODY, given.pop("attitudes"), given.pop("angular_velocities"), **given)


def test_members_without_a_motion_are_nan():
    ensemble = Ensemble.from_orbital(BODY, [[0, 0, 0, 1], [0, 0, 0, 2.0]], [0, 0, 0], orbit=ORBIT, errors="nan", **GIVEN, **OPTIONS)
    seen = ensemble.orbital([0.0, 10.0], **GIVEN)
    assert np.isfinite(seen.angles[0]).all() and np.isnan(seen.angles[1]).all()
    with pytest.raises(InputError, match="1"):
        Ensemble.from_orbital(BODY, [[0, 0, 0, 1], [0, 0, 0, 2.0]], [0, 0, 0], orbit=ORBIT, **GIVEN, **OPTIONS).orbital(0.0, **GIVEN)
