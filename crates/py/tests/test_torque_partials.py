"""Derivatives with respect to the parameters of torques, against closed forms and differences of solved motions."""

import numpy as np
import pytest

import andoyer

BODY = andoyer.Body([1.0, 1.4, 2.0])
TENSOR = andoyer.Body.from_inertia([[1.5, 0.2, 0.1], [0.2, 1.4, 0.0], [0.1, 0.0, 2.0]])
STATE = ([0.1, 0.2, -0.1, 0.95], [0.3, -0.2, 0.5])
ATTITUDE = np.array(STATE[0]) / np.linalg.norm(STATE[0])
SPAN = 20.0


def solved(body, torques):
    return andoyer.Scene(body, ATTITUDE, STATE[1], torques=torques, span=(0, SPAN), tolerance=1e-13, orbit=andoyer.Orbit(0.02, 0.1)).solve()


def turn(start, end):
    """The rotation vector from one attitude to another one nearby, in body components."""
    u, w = -start[:3], start[3]
    v = w * end[:3] + end[3] * u + np.cross(u, end[:3])
    return 2 * v * np.sign(w * end[3] - u @ end[:3])


def by_differences(body, make, parameters, step):
    columns = []
    origin = solved(body, make(parameters)).at([SPAN])
    for k in range(len(parameters)):
        sum_turn, sum_rate = 0, 0
        for place, weight in ((1, 8), (-1, -8), (2, -1), (-2, 1)):
            moved = np.array(parameters, dtype=float)
            moved[k] += place * step
            found = solved(body, make(moved)).at([SPAN])
            sum_turn = sum_turn + weight * turn(origin.attitude[0], found.attitude[0]) / (12 * step)
            sum_rate = sum_rate + weight * (found.angular_velocity[0] - origin.angular_velocity[0]) / (12 * step)
        columns.append(np.concatenate([sum_turn, sum_rate]))
    return np.array(columns).T


def held(body, make, parameters, names, step=1e-4, tolerance=1e-8):
    partials = solved(body, make(parameters)).partials([SPAN], with_respect_to=[("torque", 0)])
    assert partials.parameters == tuple(names)
    found = np.concatenate([partials.attitude[0], partials.angular_velocity[0]])
    expected = by_differences(body, make, parameters, step)
    assert np.allclose(found, expected, rtol=0, atol=tolerance * abs(expected).max())


@pytest.mark.parametrize("body", [BODY, TENSOR])
def test_constant_torques_rotors_and_dampings(body):
    held(body, lambda p: andoyer.Torque.constant(p), [1e-2, -2e-2, 1e-2], ["constant_1", "constant_2", "constant_3"])
    held(body, lambda p: andoyer.Torque.rotor(p), [0.1, -0.2, 0.05], ["rotor_1", "rotor_2", "rotor_3"])
    names = [f"damping_{i}{k}" for i in (1, 2, 3) for k in (1, 2, 3)]
    held(body, lambda p: andoyer.Torque.damping(np.reshape(p, (3, 3))), [1e-2, 2e-3, 0, 0, 2e-2, 1e-3, -1e-3, 0, 3e-2], names)


@pytest.mark.parametrize("body", [BODY, TENSOR])
def test_dipoles_polynomials_and_their_factor(body):
    path = andoyer.Orbit(0.02, 0.1, semi_major_axis=7000.0, inclination=1.0)
    field = andoyer.Field.dipole(radius=6371.2, equatorial=1.0, axis=(0.1, 0, -1), orbit=path, rotation_rate=1e-3)
    for given in (field, [0.3, 0.1, -2.0]):
        for moment in ([2e-2, 1e-2, -3e-2], [0.0, 0.0, 0.0]):
            held(body, lambda p, given=given: andoyer.Torque.dipole(p, given), moment, ["dipole_1", "dipole_2", "dipole_3"])

    def polynomial(p):
        factor, first, second = p
        return andoyer.Torque.polynomial([f"{factor * first}*s3", "0", f"{factor * second}*s1^2*w2"], sources={"s": [1, 2, 2]})

    held(body, polynomial, [1.0, 1e-2, 2e-2], ["factor", "coefficient_1:s3", "coefficient_3:s1^2*w2"])


def test_a_constant_torque_on_a_sphere_in_closed_form():
    # About a fixed axis the angle is ωt + Tt²/2I.
    motion = andoyer.Scene(andoyer.Body([2, 2, 2]), [0, 0, 0, 1], [0, 0, 0.3], torques=andoyer.Torque.constant([0, 0, 0.1]), span=(0, 30)).solve()
    partials = motion.partials([30.0], with_respect_to=["torque"])
    assert partials.attitude[0, 2, 2] == pytest.approx(30**2 / 4, rel=1e-13)
    assert partials.angular_velocity[0, 2, 2] == pytest.approx(15, rel=1e-13)


def test_a_gravity_field_has_no_columns_of_its_orbit():
    body = andoyer.Body([1, 1.4, 2], gravity=andoyer.Gravity({"C30": 0.1}, 3.0, inertia_factor=0.4))
    motion = andoyer.Scene(body, ATTITUDE, STATE[1], orbit=andoyer.Orbit(0.02, 0.1, semi_major_axis=10.0), span=(0, 20)).solve()
    with pytest.raises(andoyer.InputError, match="gravity field"):
        motion.partials([5.0], with_respect_to=["orbit"])
    assert motion.partials([5.0], with_respect_to=["attitude"]).attitude.shape == (1, 3, 3)


def test_several_torques_need_an_index_and_inner_friction_has_no_parameters():
    torques = [andoyer.Torque.constant([0, 0, 1e-3]), andoyer.Torque.rotor([0, 0, 0.1])]
    motion = solved(BODY, torques)
    names = motion.partials([1.0], with_respect_to=["attitude", ("torque", 1)]).parameters
    assert names[3:] == ("rotor_1[1]", "rotor_2[1]", "rotor_3[1]")
    for given, said in (("torque", "pair"), (("torque", 2), "from 0 to 1")):
        with pytest.raises(andoyer.InputError, match=said):
            motion.partials([1.0], with_respect_to=[given])
    free = andoyer.Scene(BODY, *([0, 0, 0, 1], [0, 0, 1])).solve()
    with pytest.raises(andoyer.InputError, match="without torques"):
        free.partials([1.0], with_respect_to=["torque"])
