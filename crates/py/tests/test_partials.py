"""Derivatives with respect to the state and the moments: shapes, agreement with differences, errors, pickling."""

import json
import math
import pickle

import numpy as np
import pytest
from conftest import REPOSITORY
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import andoyer
from andoyer import Body, Ensemble, Orbit, Scene, TabulatedOrbit, Torque

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


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_scene_with_an_orbit_has_derivatives_by_variational_equations():
    scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0.02, 0.01, 1.0], orbit=andoyer.Orbit(1e-3, 0.1))
    motion = scene.solve()
    assert motion.plan.partials == "variational"
    free = Scene(scene.body, scene.attitude, scene.angular_velocity).solve().partials([10.0, 20.0])
    disturbed = motion.partials([10.0, 20.0])
    assert 1e-7 < np.abs(disturbed.attitude - free.attitude).max() < 1e-3


ELEMENTS = ("mean_motion", "eccentricity", "time_of_pericentre", "inclination", "node", "argument_of_pericentre")
STATE = ([0.1, 0.2, 0.3, 0.9273618495495703], [0.2, 0.4, 1.1])


def two_bodies(**options):
    orbits = [Orbit(0.02, 0.3, inclination=0.4, mass_fraction=0.5), Orbit(0.03, 0.1, node=1.0)]
    return Scene(Body([1.0, 1.3, 1.5]), *STATE, orbit=orbits, span=(-50, 50), **options).solve()


def test_columns_are_those_asked_for_with_their_names():
    motion = two_bodies(method="integrated")
    every = motion.partials([0.0, 40.0], with_respect_to=["moments", ("orbit", 1), ("attraction", 0)])
    assert every.parameters == ("moment_1", "moment_2", "moment_3", *(f"{name}[1]" for name in ELEMENTS), "attraction[0]")
    assert every.attitude.shape == every.angular_velocity.shape == (2, 3, 10)
    assert (every.attitude[0] == 0).all()
    whole = motion.partials([0.0, 40.0])
    np.testing.assert_allclose(every.attitude[:, :, :3], whole.attitude[:, :, 6:], rtol=1e-12, atol=1e-12 * np.abs(whole.attitude).max())
    pair = motion.partials(40.0, with_respect_to=("orbit", 1))
    np.testing.assert_allclose(pair.attitude, every.attitude[1, :, 3:9], rtol=1e-11, atol=1e-13)
    again = pickle.loads(pickle.dumps(every))
    assert again.parameters == every.parameters and (again.attitude == every.attitude).all()


def test_a_free_motion_gives_the_columns_asked_for(motion):
    whole = motion.partials([2.0, 3.0])
    assert whole.parameters == tuple(f"{name}_{axis}" for name in ("attitude", "angular_velocity", "moment") for axis in (1, 2, 3))
    chosen = motion.partials([2.0, 3.0], with_respect_to=("moments", "attitude"))
    assert chosen.parameters == whole.parameters[6:] + whole.parameters[:3]
    assert (chosen.attitude == whole.attitude[:, :, [6, 7, 8, 0, 1, 2]]).all()
    assert motion.partials(2.0, with_respect_to="angular_velocity").attitude.shape == (3, 3)
    assert motion.partials(2.0, with_respect_to=()).attitude.shape == (3, 0)


@pytest.mark.parametrize("options", [{"method": "integrated"}, {}])
def test_derivatives_by_the_attraction_and_an_element_are_differences_of_motions(options):
    def motion(attraction, inclination):
        orbit = Orbit(0.004, 0.3, inclination=inclination, attraction=attraction)
        return Scene(Body([1.0, 1.3, 1.5]), *STATE, orbit=orbit, span=(0, 150), **options).solve()

    partials = motion(1e-5, 0.4).partials(150.0, with_respect_to=("attraction", "orbit"))
    for column, step in ((0, [1e-8, 0]), (4, [0, 1e-3])):
        changed = [motion(1e-5 + sign * step[0], 0.4 + sign * step[1]).rotation(150.0) for sign in (1, -1)]
        turned = (changed[1].inv() * changed[0]).as_rotvec() / (2 * max(step))
        # Those of an averaged motion are derivatives of the equations: the theory's change of the attitude has an error of the second order.
        assert np.abs(partials.attitude[:, column] - turned).max() <= (1e-5 if options else 1e-2) * np.abs(turned).max()


@pytest.mark.parametrize(
    ("asked", "error", "message"),
    [
        ("mass", andoyer.InputError, '"mass"'),
        ("orbit", andoyer.InputError, "several"),
        (("orbit", 2), andoyer.InputError, "from 0 to 1"),
        (("moments", 0), andoyer.InputError, "without an index"),
        ([("orbit", -1)], andoyer.InputError, "from 0"),
        (("attraction", 2**64), andoyer.InputError, "from 0"),
        (("orbit", 1.0), TypeError, "name and index"),
        (3, TypeError, "not 3"),
        ([None], TypeError, "not"),
    ],
)
def test_a_parameter_that_the_scene_lacks_is_named(asked, error, message):
    with pytest.raises(error, match=message):
        two_bodies(method="integrated").partials(1.0, with_respect_to=asked)


def test_a_body_without_an_orbit_has_no_elements(motion):
    with pytest.raises(andoyer.InputError, match="without a disturbing body"):
        motion.partials(1.0, with_respect_to="orbit")
    times = np.linspace(-1, 11, 60)
    path = TabulatedOrbit(times, np.stack([np.cos(0.1 * times), np.sin(0.1 * times), 0 * times], 1), 0.01)
    table = Scene(Body([1.0, 1.3, 1.5]), *STATE, orbit=path, span=(0, 10), method="integrated").solve()
    assert table.partials(1.0, with_respect_to="moments").attitude.shape == (3, 3)
    with pytest.raises(andoyer.InputError, match="table"):
        table.partials(1.0, with_respect_to="attraction")


def test_derivatives_of_a_libration_are_those_of_the_integration():
    state = ([0.0, 0.0, 0.004, math.sqrt(1 - 0.004**2)], [0, 0, 1])
    made = {
        method: Scene(Body([0.99, 0.996, 1.0]), *state, orbit=Orbit(1.0, 0.01), span=(0, 1e3), tolerance=1e-7, method=method)
        for method in ("libration", "integrated")
    }
    one, other = (scene.solve().partials(1e3, with_respect_to=["attitude", "orbit"]).attitude for scene in made.values())
    np.testing.assert_array_equal(one, other)


def test_a_body_of_nearly_no_attraction_has_derivatives_by_its_attraction():
    orbit = Orbit(0.02, 0.3, inclination=0.4, attraction=1e-300)
    motion = Scene(Body([1.0, 1.3, 1.5]), *STATE, orbit=orbit, span=(0, 20)).solve()
    partials = motion.partials(20.0, with_respect_to=("orbit", "attraction"))
    assert np.abs(partials.attitude[:, :6]).max() <= 1e-290 and np.abs(partials.attitude[:, 6]).max() > 1


def euler(moments, attitude, rates, orbit, time):
    """Attitude of a body under the gravity gradient of a body on an orbit, by SciPy."""
    n, e, tilt = orbit
    moments = np.asarray(moments)

    def direction(t):
        anomaly = n * t
        for _ in range(60):
            anomaly -= (anomaly - e * math.sin(anomaly) - n * t) / (1 - e * math.cos(anomaly))
        x, y = math.cos(anomaly) - e, math.sqrt(1 - e * e) * math.sin(anomaly)
        return np.array([x, y * math.cos(tilt), y * math.sin(tilt)]), math.hypot(x, y)

    def slope(t, state):
        q, w = state[:4], state[4:]
        place, distance = direction(t)
        u = Rotation.from_quat(q).inv().apply(place / distance)
        torque = 3 * n * n / distance**3 * np.cross(u, moments * u)
        v, s = q[:3], q[3]
        turned = 0.5 * np.array([*(s * w + np.cross(v, w)), -v @ w])
        return np.concatenate([turned, (torque - np.cross(w, moments * w)) / moments])

    state = np.concatenate([attitude, rates])
    end = solve_ivp(slope, (0, time), state, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    return Rotation.from_quat(end[:4]), end[4:]


@pytest.mark.parametrize("rates", [[0.2, 0.3, 1.1], [0.0, 0.0, 0.0]])
@pytest.mark.parametrize("tensor", [False, True])
def test_derivatives_of_a_sphere_by_its_moments_are_those_of_bodies_beside_it_under_the_torque(rates, tensor):
    orbit, attitude, time, step = (0.3, 0.1, 0.3), [0.1, -0.3, 0.2, math.sqrt(0.86)], 12.0, 1e-4
    body = Body.from_inertia(np.eye(3)) if tensor else Body([1, 1, 1])
    path = Orbit(orbit[0], orbit[1], inclination=orbit[2])
    partials = Scene(body, attitude, rates, orbit=path).solve().partials(time)
    for axis in range(3):
        ends = [euler(1 + sign * step * np.eye(3)[axis], attitude, rates, orbit, time) for sign in (-1, 1)]
        turned = (ends[0][0].inv() * ends[1][0]).as_rotvec() / (2 * step)
        faster = (ends[1][1] - ends[0][1]) / (2 * step)
        np.testing.assert_allclose(partials.attitude[:, 6 + axis], turned, atol=1e-5)
        np.testing.assert_allclose(partials.angular_velocity[:, 6 + axis], faster, atol=1e-5)


def test_no_orbit_turns_a_sphere_and_its_columns_are_in_their_places():
    bodies = [Orbit(0.01, 0.1), Orbit(0.02, 1.4)]
    motion = Scene(Body([1, 1, 1]), *STATE, orbit=bodies, span=(0, 100)).solve()
    free = Scene(Body([1, 1, 1]), *STATE).solve().partials([1.0, 10.0])
    chosen = [("orbit", 1), "angular_velocity", ("attraction", 0), "attitude"]
    partials = motion.partials([1.0, 10.0], with_respect_to=chosen)
    assert partials.attitude.shape == (2, 3, 13)
    for found, own in ((partials.attitude, free.attitude), (partials.angular_velocity, free.angular_velocity)):
        assert (found[..., :6] == 0).all() and (found[..., 9] == 0).all()
        np.testing.assert_allclose(found[..., 6:9], own[..., 3:6], atol=1e-14)
        np.testing.assert_allclose(found[..., 10:], own[..., :3], atol=1e-14)


@pytest.mark.parametrize("bodies", [1, 2])
def test_derivatives_of_a_sphere_in_ensembles_and_under_torques_that_vanish_at_its_state(bodies):
    # The motions of bodies beside the sphere give the derivatives by their differences: a torque that is 0 at the state is none beside it.
    orbits, attitude, rates, time, step = (
        [Orbit(0.3, 0.1, inclination=0.3), Orbit(0.2, 0.2, inclination=1.0, mass_fraction=0.3)],
        STATE[0],
        [0.2, 0.3, 1.1],
        12.0,
        1e-4,
    )
    torques = [Torque.rotor([0, 0, 0]), Torque.polynomial(["-0.1*(w1 - 0.2)", "0", "0"])]

    def by_differences(**options):
        def ends(axis):
            beside = [np.ones(3) + sign * step * np.eye(3)[axis] for sign in (-1, 1)]
            return [Scene(Body(m), attitude, rates, span=(0, time), tolerance=1e-12, method="integrated", **options).solve() for m in beside]

        turns = [[Rotation.from_quat(motion.attitude(time)) for motion in ends(axis)] for axis in range(3)]
        return np.array([(one.inv() * other).as_rotvec() / (2 * step) for one, other in turns]).T

    paths = orbits[:bodies]
    alone = Scene(Body([1, 1, 1]), attitude, rates, orbit=paths, span=(0, time)).solve().partials(time).attitude
    np.testing.assert_allclose(alone[:, 6:], by_differences(orbit=paths), atol=1e-5)
    under = Scene(Body([1, 1, 1]), attitude, rates, orbit=paths, torques=torques, span=(0, time), tolerance=1e-9).solve().partials(time).attitude
    np.testing.assert_allclose(under[:, 6:], by_differences(orbit=paths, torques=torques), atol=1e-5)
    if bodies == 1:
        members = Ensemble(np.ones((2, 3)), [attitude] * 2, [rates, [0.0, 0.0, 1.0]], orbits=paths[0], span=(0, time)).partials([time])
        np.testing.assert_allclose(members.attitude[0, 0], alone, atol=1e-12)


def test_derivatives_that_overflow_are_refused():
    strong = Orbit(0.3, 1 - 1e-16, attraction=8e285)
    motion = Scene(Body([1, 1, 1]), *STATE, orbit=strong, span=(0, 12)).solve()
    for parameters in (None, ["moments"]):
        with pytest.raises(andoyer.RepresentationError, match="a derivative may overflow a double") as caught:
            motion.partials([0.0, 1.0, 12.0], **({} if parameters is None else {"with_respect_to": parameters}))
        assert caught.value.argument == "times"
    weak = Scene(Body([1, 1, 1]), *STATE, orbit=Orbit(0.3, 0.1, attraction=1e-300), span=(0, 12)).solve().partials([1.0, 12.0])
    free = Scene(Body([1, 1, 1]), *STATE).solve().partials([1.0, 12.0])
    np.testing.assert_allclose(weak.attitude, free.attitude, atol=1e-13)
