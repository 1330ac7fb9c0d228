"""Torques beside the gravity gradient: against SciPy, as values, and bad input."""

import copy
import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import andoyer
from andoyer import Body, Orbit, Scene, TabulatedOrbit, Torque

MOMENTS = np.array([1.0, 1.5, 2.0])
ATTITUDE = [0.1, -0.2, 0.3, np.sqrt(0.86)]
RATES = [0.1, 0.2, 1.0]
TABLE = TabulatedOrbit(np.linspace(-1, 40, 200), np.stack([np.cos(np.linspace(-1, 40, 200)), np.sin(np.linspace(-1, 40, 200)), np.full(200, 0.2)], axis=1), 1.0)


def scene(torques, **options):
    return Scene(Body(MOMENTS), ATTITUDE, RATES, span=(0, 20), tolerance=1e-11, torques=torques, **options)


def matrix(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def integrated(torque, times, rotor=np.zeros(3)):
    """Attitudes by DOP853; `torque` is a function of time, matrix and rates."""

    def slope(time, state):
        q, w = state[:4], state[4:]
        x, y, z, s = q
        turned = 0.5 * np.array(
            [s * w[0] + y * w[2] - z * w[1], s * w[1] + z * w[0] - x * w[2], s * w[2] + x * w[1] - y * w[0], -x * w[0] - y * w[1] - z * w[2]]
        )
        return np.concatenate([turned, (torque(time, matrix(q), w) - np.cross(w, MOMENTS * w + rotor)) / MOMENTS])

    solved = solve_ivp(slope, (0, times[-1]), [*ATTITUDE, *RATES], method="DOP853", rtol=3e-14, atol=1e-15, t_eval=times)
    return solved.y[:4].T / np.linalg.norm(solved.y[:4], axis=0)[:, None]


def apart(one, other):
    return max(2 * np.arcsin(min(1, np.linalg.norm(np.cross(p[:3], -q[:3]) + p[3] * -q[:3] + q[3] * p[:3]))) for p, q in zip(one, other))


@pytest.mark.parametrize("seed", range(12))
def test_random_polynomials_are_those_of_scipy(seed):
    random = np.random.default_rng(seed)
    orbit = Orbit(0.3, 0.4, inclination=0.5, node=1.0, argument_of_pericentre=2.0, semi_major_axis=2.0)
    direction = random.normal(size=3)
    power = float(random.integers(1, 5))
    names = ["s1", "s2", "s3", "w1", "w2", "w3"] if seed % 2 else ["b1", "b2", "b3", "w1", "w2", "w3"]
    texts, terms = [], []
    for _ in range(3):
        chosen = [(random.normal() * 0.05, [names[k] for k in random.integers(0, 6, size=random.integers(0, 5))]) for _ in range(4)]
        texts.append(" + ".join("*".join([f"({c!r})", *factors]) for c, factors in chosen))
        terms.append(chosen)
    sources, powers, distances = ({"s": orbit}, {"s": power}, {"s": 1.7}) if seed % 2 else ({"b": direction}, {}, {})
    rotor, damping = random.normal(size=3) * 0.3, random.normal(size=(3, 3)) * 0.01

    def torque(time, rotation, rates):
        if seed % 2:
            position = orbit.position(time)
            distance = np.linalg.norm(position)
            unit, factor = rotation.T @ (position / distance), (1.7 / distance) ** power
        else:
            unit, factor = rotation.T @ (direction / np.linalg.norm(direction)), 1.0
        values = dict(zip(names, [*unit, *rates]))
        return factor * np.array([sum(c * np.prod([values[name] for name in factors]) for c, factors in chosen) for chosen in terms]) - damping @ rates

    polynomial = Torque.polynomial(texts, sources=sources, distance_powers=powers, reference_distances=distances)
    motion = scene([polynomial, Torque.rotor(rotor), Torque.damping(damping)]).solve()
    times = np.linspace(0, 20, 9)
    error = apart(motion.attitude(times), integrated(torque, times, rotor))
    # SciPy loses some 1e-12.
    assert error <= motion.plan.error_bound + 2e-11, (error, motion.plan.error_bound)


def test_damping_is_a_number_a_diagonal_or_a_matrix():
    times = np.linspace(0, 20, 5)
    solved = [scene(Torque.damping(given)).solve().attitude(times) for given in (0.02, [0.02] * 3, 0.02 * np.eye(3))]
    assert np.array_equal(solved[0], solved[1]) and np.array_equal(solved[0], solved[2])


def test_torques_are_values():
    torques = [
        Torque.constant([1e-3, 0, 0]),
        Torque.damping(np.arange(9.0).reshape(3, 3)),
        Torque.rotor([0, 0, 1]),
        Torque.polynomial(["0", "s1*b2", "w1^2"], sources={"s": Orbit(1.0, 0.1), "b": [0, 0, 1]}, distance_powers={"s": 2}, reference_distances={"s": 3.0}),
    ]
    assert [torque.kind for torque in torques] == ["constant", "damping", "rotor", "polynomial"]
    for torque in torques:
        assert eval(repr(torque), {"Torque": Torque, "Orbit": Orbit}) == torque
        assert pickle.loads(pickle.dumps(torque)) == torque and copy.deepcopy(torque) is torque
        assert hash(pickle.loads(pickle.dumps(torque))) == hash(torque)
        assert torque != Torque.constant([9, 9, 9])
    assert Torque.constant([0.0, 0, 1]) == Torque.constant([-0.0, 0, 1]) and hash(Torque.constant([0.0, 0, 1])) == hash(Torque.constant([-0.0, 0, 1]))
    without_power = Torque.polynomial(["s2", "0", "0"], sources={"s": Orbit(1.0)}, reference_distances={"s": 7000.0})
    assert pickle.loads(pickle.dumps(without_power)) == without_power
    with_table = Torque.polynomial(["s2", "0", "0"], sources={"s": TABLE})
    assert pickle.loads(pickle.dumps(with_table)) == with_table
    whole = scene(torques)
    assert whole.torques == tuple(torques) and scene(torques[0]).torques == (torques[0],) and scene(None).torques == ()
    again = pickle.loads(pickle.dumps(whole))
    assert again == whole and hash(again) == hash(whole) and "Torque.rotor" in repr(whole)
    assert Scene.from_andoyer(Body(MOMENTS), [0.1, 0.2, 0.3, 0.5, 1.0, 0.9], torques=torques).torques == tuple(torques)


def test_scene_file_has_the_torques(tmp_path):
    whole = scene([Torque.rotor([0, 0, 1]), Torque.polynomial(["s2", "0", "0"], sources={"s": TABLE})])
    path = tmp_path / "scene.toml"
    path.write_text(whole.to_toml(), encoding="utf-8")
    assert Scene.from_toml(path) == whole


def test_angular_momentum_includes_rotors():
    motion = scene(Torque.rotor([0.3, -0.2, 0.5])).solve()
    momenta = motion.angular_momentum(np.linspace(0, 20, 5))
    first = motion.rotation(0.0).apply(MOMENTS * RATES + [0.3, -0.2, 0.5])
    assert np.abs(momenta - first).max() <= 1e-12
    assert abs(motion.andoyer(20.0)[4] - np.linalg.norm(first)) <= 1e-12
    again = Scene.from_andoyer(Body(MOMENTS), motion.andoyer(0.0), torques=motion.scene.torques)
    assert np.abs(again.angular_velocity - RATES).max() <= 1e-13


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_table_as_a_source_and_derivatives():
    motion = scene(Torque.polynomial(["0.01*s2", "0", "0.02*s1*s3"], sources={"s": TABLE})).solve()
    assert not motion.verify().refuted
    partials = motion.partials(10.0)
    step = 1e-5
    moved = [
        Scene(Body(MOMENTS), ATTITUDE, [0.1, 0.2, 1.0 + sign * step], span=(0, 20), tolerance=1e-11, torques=motion.scene.torques).solve().attitude(10.0)
        for sign in (1, -1)
    ]
    difference = (Rotation.from_quat(moved[1]).inv() * Rotation.from_quat(moved[0])).as_rotvec() / (2 * step)
    assert np.abs(partials.attitude[:, 5] - difference).max() <= 1e-6 * np.abs(difference).max()


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: Torque.constant([np.nan, 0, 0]), "torque.constant = NaN"),
        (lambda: Torque.constant([1, 2]), "shape"),
        (lambda: Torque.damping(np.eye(2)), "shape"),
        (lambda: Torque.rotor([0, 0, np.inf]), "torque.rotor = inf"),
        (lambda: Torque.polynomial(["w1^9", "0", "0"]), "degree 9"),
        (lambda: Torque.polynomial(["b1", "0", "0"]), "b1"),
        (lambda: Torque.polynomial(["0"] * 3, sources={"b": [0, 0, 0]}), "other than 0"),
        (lambda: Torque.polynomial(["0"] * 3, sources={"b": [0, 0, 1]}, distance_powers={"b": 2}), "no distance"),
        (lambda: Torque.polynomial(["0"] * 3, sources={"b": Orbit(1.0, semi_major_axis=7e6)}, distance_powers={"b": 3}), "reference_distances = b: none"),
        (lambda: Torque.polynomial(["0"] * 3, sources={"b": TABLE}, distance_powers={"b": -2}), "reference_distances = b: none"),
    ],
)
def test_bad_torques_are_input_errors(made, said):
    with pytest.raises(andoyer.InputError, match=said):
        made()


@pytest.mark.parametrize(
    "made",
    [
        lambda: scene("rotor"),
        lambda: scene([1.0]),
        lambda: Torque.polynomial(["0", "0"]),
        lambda: Torque.polynomial("000"),
        lambda: Torque.polynomial(["0"] * 3, distance_powers={"b": 2}),
        lambda: Torque(),
    ],
)
def test_torques_of_another_type_are_type_errors(made):
    with pytest.raises(TypeError):
        made()


@pytest.mark.parametrize("size", [6.878e6, 1.0, 3e-4])
def test_distance_power_does_not_depend_on_the_unit_of_length(size):
    def rates(reference=None, **axis):
        source = Orbit(0.3, 0.2, inclination=0.7, **axis)
        distances = {} if reference is None else {"reference_distances": {"b": reference}}
        torque = Torque.polynomial(["0", "-0.02*b3", "0.02*b2"], sources={"b": source}, distance_powers={"b": 3}, **distances)
        return scene(torque).solve().angular_velocity(20.0)

    assert rates(1.3 * size, semi_major_axis=size) == pytest.approx(rates(1.3), abs=1e-9)
    assert rates() == pytest.approx(rates(1.0), abs=0) and np.abs(rates() - scene(None, orbit=None).solve().angular_velocity(20.0)).max() > 1e-3


def test_torque_needs_an_integration():
    torque = Torque.constant([1e-3, 0, 0])
    with pytest.raises(andoyer.InputError, match="span"):
        Scene(Body(MOMENTS), ATTITUDE, RATES, torques=torque).solve()
    with pytest.raises(andoyer.TheoryError, match="integrated"):
        scene(torque, method="closed").solve()
