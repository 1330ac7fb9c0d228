"""Flybys: orbits with an eccentricity above 1."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import andoyer
from andoyer import Body, Orbit, Scene

MOMENTS = np.array([0.6, 0.8, 1.0])


def place(gm, position, velocity, span, times):
    """Positions by integration of the problem of two bodies."""

    def equations(_time, y):
        return np.concatenate([y[3:], -gm * y[:3] / np.linalg.norm(y[:3]) ** 3])

    return solve_ivp(equations, span, np.concatenate([position, velocity]), "DOP853", t_eval=times, rtol=1e-13, atol=1e-13).y[:3].T


def attitude_by_integration(scene, position, strength, times):
    """Attitudes by DOP853 at 1e-13 under the gravity gradient of a body at position(t) with 3 G m = strength."""
    moments = np.asarray(scene.body.moments)

    def equations(time, y):
        q, w = y[:4], y[4:]
        x, y_, z, s = q
        r = np.array(
            [
                [1 - 2 * (y_ * y_ + z * z), 2 * (x * y_ - z * s), 2 * (x * z + y_ * s)],
                [2 * (x * y_ + z * s), 1 - 2 * (x * x + z * z), 2 * (y_ * z - x * s)],
                [2 * (x * z - y_ * s), 2 * (y_ * z + x * s), 1 - 2 * (x * x + y_ * y_)],
            ]
        )
        place = position(time)
        distance = np.linalg.norm(place)
        u = r.T @ place / distance
        torque = strength / distance**3 * np.cross(u, moments * u)
        rate = (torque - np.cross(w, moments * w)) / moments
        vector = 0.5 * (s * w + np.cross(q[:3], w))
        return np.concatenate([vector, [-0.5 * q[:3] @ w], rate])

    start = np.concatenate([scene.attitude, scene.angular_velocity])
    solution = solve_ivp(equations, (scene.epoch, times[-1]), start, "DOP853", t_eval=times, rtol=1e-13, atol=1e-13)
    return solution.y[:4].T / np.linalg.norm(solution.y[:4].T, axis=1)[:, None]


def angle(one, other):
    """Largest angle between rows of quaternions, without the cancellation of an arccosine."""
    sign = np.sign(np.sum(one * other, axis=1))[:, None]
    return 2 * np.linalg.norm(one - sign * other, axis=1).max()


@pytest.mark.parametrize("eccentricity", [1.0001, 1.01, 1.5, 4.253901873, 20.0])
def test_position_is_that_of_two_bodies(eccentricity):
    orbit = Orbit(0.3, eccentricity, time_of_pericentre=2.0, inclination=0.7, node=1.0, argument_of_pericentre=0.4, semi_major_axis=3.0)
    gm = 0.3**2 * 3.0**3
    times = np.linspace(-30, 40, 57)
    found = orbit.position(times)
    step = 1e-3 * (eccentricity - 1) ** 1.5
    # Pericentre: the distance a(e − 1) and the velocity √(GM(1 + e)/a(e − 1)) across it.
    start = orbit.position(2.0)
    assert np.linalg.norm(start) == pytest.approx(3 * (eccentricity - 1), rel=1e-11)
    ahead = orbit.position(2.0 + step) - orbit.position(2.0 - step)
    speed = math.sqrt(gm * (1 + eccentricity) / (3 * (eccentricity - 1)))
    velocity = ahead / np.linalg.norm(ahead) * speed
    for part, span in ((times[times > 2], (2, 40)), (times[times < 2][::-1], (2, -30))):
        exact = place(gm, start, velocity, span, part)
        rows = np.isin(times, part)
        exact = exact if span[1] > 0 else exact[::-1]
        # The direction of the velocity by a difference of positions is wrong by 1e-11 or so.
        assert np.abs(found[rows] - exact).max() < 3e-9 * np.abs(exact).max()


def test_elements_of_a_state_give_the_state_back():
    random = np.random.default_rng(7)
    for _ in range(200):
        position, velocity = random.normal(size=3), random.normal(size=3)
        speed = math.sqrt(2 * 1.3 / np.linalg.norm(position))
        velocity *= speed * 10 ** random.uniform(-4, 1) / np.linalg.norm(velocity) + speed / np.linalg.norm(velocity)
        orbit = Orbit.from_state(position, velocity, 1.3, 5.0)
        assert orbit.eccentricity > 1
        budget = 1e-13 * max(1.0, 0.01 / (orbit.eccentricity - 1), orbit.semi_major_axis)
        assert np.abs(orbit.position(5.0) - position).max() < budget
        step = 1e-4
        slope = (orbit.position(5 + step) - orbit.position(5 - step)) / (2 * step)
        assert np.abs(slope - velocity).max() < 1e-4 * np.linalg.norm(velocity) ** 3


def test_parabola_is_refused_by_name():
    with pytest.raises(andoyer.InputError, match="orbit.eccentricity = 1: it must be 0 or more, other than 1"):
        Orbit(1.0, 1.0)
    with pytest.raises(andoyer.InputError, match="orbit.eccentricity = inf"):
        Orbit(1.0, math.inf)


def scene(orbit, span, rates=(0.1, 0.2, 1.0), **options):
    return Scene(Body(MOMENTS), [0.1, -0.2, 0.3, math.sqrt(0.86)], rates, orbit=orbit, epoch=span[0], span=span, **options)


@pytest.mark.parametrize("seed", range(12))
def test_flyby_is_that_of_an_independent_integration(seed):
    random = np.random.default_rng(seed)
    eccentricity = 1 + 10 ** random.uniform(-4, math.log10(19))
    # The pericentre is passed with √(3 G m/q³) from 0.3 to 1.5 times the spin.
    rate = random.uniform(0.3, 1.5)
    mean_motion = rate * (eccentricity - 1) ** 1.5 / math.sqrt(3)
    angles = dict(zip(("inclination", "node", "argument_of_pericentre"), random.uniform(0, 3, 3), strict=True))
    orbit = Orbit(mean_motion, eccentricity, time_of_pericentre=random.uniform(-1, 1), semi_major_axis=2.0, **angles)
    span = (-15.0, 15.0)
    flyby = scene(orbit, span, tolerance=1e-12)
    motion = flyby.solve()
    assert motion.plan.method == "integrated" and motion.plan.skipped[0] == "theory: a hyperbola is integrated"
    assert motion.plan.error_bound < 1e-10
    times = np.linspace(*span, 41)
    exact = attitude_by_integration(flyby, orbit.position, 3 * mean_motion**2 * 2.0**3, times)
    # DOP853 at 1e-13 is wrong by some 1e-12 after 30 radians.
    assert angle(motion.attitude(times), exact) < 1e-11
    assert not motion.verify().refuted


def test_fast_pass_gives_the_impulse_of_a_straight_path():
    """In the limit of a fast pass the body stands still: ΔG = ∫ 3 G m/r³ u × I u dt along a straight path."""
    gm, distance = 1e-3, 1.0
    errors = []
    for speed in (1e2, 1e3, 1e4):
        orbit = Orbit.from_state([distance, 0, 0], [0, speed, 0], gm, 0.0)
        reach = 3e3 / speed
        passing = scene(orbit, (-reach, reach), rates=(0, 0, 0), tolerance=1e-16)
        motion = passing.solve()
        change = np.diff(motion.angular_momentum([-reach, reach]), axis=0)[0]
        turn = matrix_of(passing.attitude)
        tensor = turn @ np.diag(MOMENTS) @ turn.T
        # ∫ r rᵀ/r⁵ dt along (d, v t, 0) is diag(4/3, 2/3, 0)/(d² v): the torque 3 G m r × I r/r⁵ has only products of x, y and z.
        i = tensor
        outer = np.diag([4 / 3, 2 / 3, 0]) / (distance**2 * speed)
        product = 3 * gm * (outer @ i)
        impulse = np.array([product[1, 2] - product[2, 1], product[2, 0] - product[0, 2], product[0, 1] - product[1, 0]])
        errors.append(np.linalg.norm(change - impulse) / np.linalg.norm(impulse))
    # The bend of the path is gm/(d v²), and the far ends have (d/(v T))².
    assert errors[0] < 2e-6 and errors[1] < 2e-6 and errors[2] < 2e-6, errors


def matrix_of(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_scenes_with_a_hyperbola_are_integrated_or_refused_by_type(tmp_path):
    orbit = Orbit(0.1, 2.0)
    with pytest.raises(andoyer.InputError, match="span: none is given.*a hyperbola is integrated"):
        Scene(Body(MOMENTS), [0, 0, 0, 1], [0.1, 0.2, 1], orbit=orbit).solve()
    with pytest.raises(andoyer.TheoryError, match="a hyperbola is integrated"):
        scene(orbit, (0, 1), method="closed").solve()
    given = scene(orbit, (-5.0, 5.0))
    path = tmp_path / "flyby.toml"
    path.write_text(given.to_toml(), encoding="utf-8")
    assert Scene.from_toml(path) == given
    later = given.solve().scene_at(2.0)
    assert later.orbit == orbit and later.epoch == 2.0
    with pytest.raises(andoyer.InputError, match="orbit.eccentricity = 2: it must be less than 1"):
        andoyer.cassini_states(Body(MOMENTS), Orbit(0.1, 2.0, node_rate=-1e-3), 1.0)


def test_far_and_long_flyby_of_a_body_at_rest_ends():
    orbit = Orbit(1e-3, 1.5, time_of_pericentre=0.0)
    motion = scene(orbit, (-1e5, 1e5), rates=(0, 0, 0), tolerance=1e-3).solve()
    assert motion.plan.error_bound < 1e-3 and motion.plan.steps < 5000
