"""Mean rates of weak torques: against quadratures over both angles, and in closed form."""

import re

import numpy as np
import pytest
from polhodes import FAMILIES, MOMENTS, SOURCE, polhode, quaternion, random_texts, separatrix, state
from scipy.spatial.transform import Rotation

from andoyer import Body, Orbit, Scene, Torque


def torus_mean(value, axis, sign, excess, momentum):
    """Means of Ġ and ξ̇ over both angles, by 128 × 24 points."""
    size = np.linalg.norm(momentum)
    k = momentum / size
    g, alpha = polhode(axis, sign, excess, 2 * np.pi * (np.arange(128) + 0.5) / 128)
    c = k @ SOURCE
    x = SOURCE - c * k
    across = np.linalg.norm(x)
    x /= across
    z = np.cross(k, x)
    first = np.cross(g, [0.3, 0.5, -0.4])
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(g, first)
    rate, rise = np.zeros(3), 0.0
    for angle in 2 * np.pi * np.arange(24) / 24:
        body_x = first * np.cos(angle) + second * np.sin(angle)
        body_z = np.cross(body_x, g) * -1  # ẑ = k × x̂
        torque = value(c * g + across * body_x, size * g / MOMENTS)
        along, sideways, beside = ((torque * v).sum(axis=1).mean() for v in (g, body_x, body_z))
        rate += (along * k + sideways * x + beside * z) / 24
        rise += 2 / size * (g * torque * (alpha - excess)).sum(axis=1).mean() / 24
    return rate, rise


@pytest.mark.parametrize(("axis", "sign"), FAMILIES)
@pytest.mark.parametrize("part", [0.05, 0.3, 0.9])
@pytest.mark.parametrize("degree", [1, 4, 8])
def test_drift_is_the_mean_over_both_angles(axis, sign, part, degree):
    texts, value = random_texts(degree, 10 * degree + axis, 1e-3)
    momentum, excess = np.array([0.3, -0.4, 0.85]), part * separatrix(axis)
    torque = Torque.polynomial(texts, sources={"s": SOURCE})
    drift = Scene(Body(MOMENTS), *state(axis, sign, excess, momentum), torques=[torque]).drift()
    rate, rise = torus_mean(value, axis, sign, excess, momentum)
    assert np.abs(drift.momentum - rate).max() < 2e-17 + 2e-13 * 1e-3
    assert drift.excess == pytest.approx(rise, rel=0, abs=2e-16)
    assert np.allclose(sum(momentum for momentum, _ in drift.by_degree), drift.momentum, rtol=0, atol=1e-18)


def test_the_order_of_the_axes_does_not_matter():
    # Axes relabelled: body components (x, y, z) → (z, x, y), a rotation.
    texts, _ = random_texts(3, 5, 1e-3)
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.3 * separatrix(2)
    attitude, rates = state(2, 1, excess, momentum)
    torque = Torque.polynomial(texts, sources={"s": SOURCE})
    plain = Scene(Body(MOMENTS), attitude, rates, torques=[torque]).drift()
    turn = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])  # new = turn @ old
    matrix = Rotation.from_quat(attitude).as_matrix() @ turn.T
    swap = str.maketrans({"1": "2", "2": "3", "3": "1"})

    def renamed(text):
        return re.sub(r"[sw][123]", lambda m: m[0].translate(swap), text)

    relabelled = [renamed(texts[2]), renamed(texts[0]), renamed(texts[1])]
    torque = Torque.polynomial(relabelled, sources={"s": SOURCE})
    other = Scene(Body(MOMENTS[[2, 0, 1]]), quaternion(matrix), turn @ rates, torques=[torque]).drift()
    assert np.allclose(other.momentum, plain.momentum, rtol=0, atol=1e-17)
    assert other.excess == pytest.approx(plain.excess, rel=1e-10)
    tensor = turn @ np.diag(MOMENTS) @ turn.T
    third = Scene(Body.from_inertia(tensor), quaternion(matrix), turn @ rates, torques=[torque]).drift()
    assert np.allclose(third.momentum, plain.momentum, rtol=0, atol=1e-17)


def test_special_torques():
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.3 * separatrix(2)
    size = np.linalg.norm(momentum)
    start = state(2, 1, excess, momentum)

    def drift(torque, **options):
        return Scene(Body(MOMENTS), *start, torques=torque, **options).drift()

    inertial = drift([Torque.polynomial([f"1e-3*s{i}" for i in (1, 2, 3)], sources={"s": SOURCE})])
    assert np.allclose(inertial.momentum, 1e-3 * SOURCE, rtol=0, atol=1e-18)
    assert abs(inertial.excess) < 1e-18
    damping = drift([Torque.damping(1e-3 * MOMENTS)])
    assert np.allclose(damping.momentum, -1e-3 * momentum, rtol=0, atol=1e-18)
    assert abs(damping.excess) < 1e-18
    constant = drift([Torque.constant([1e-3, 2e-3, 3e-3])])
    g3 = polhode(2, 1, excess, 2 * np.pi * np.arange(64) / 64)[0][:, 2].mean()
    assert np.allclose(constant.momentum, 3e-3 * g3 * momentum / size, rtol=0, atol=1e-17)
    # u × ∇V of V = u1² u2 + u3^4: a potential keeps M and ξ.
    potential = ["1e-3*(s2*4*s3^3 - s3*s1^2)", "1e-3*(s3*2*s1*s2 - s1*4*s3^3)", "1e-3*(s1^3 - s2*2*s1*s2)"]
    conservative = drift([Torque.polynomial(potential, sources={"s": SOURCE})])
    assert abs(conservative.momentum @ momentum) < 1e-18
    assert abs(conservative.excess) < 1e-18
    assert np.linalg.norm(conservative.momentum) > 1e-5


def test_gravity_gradient_is_the_mean_precession():
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.3 * separatrix(2)
    start = state(2, 1, excess, momentum)
    orbit = Orbit(1e-3, 0.2, inclination=0.4, node=0.3)
    built_in = Scene(Body(MOMENTS), *start, orbit=orbit).drift(average="orbit")
    a, b, c = MOMENTS.tolist()
    texts = [f"3e-6*{c - b!r}*r2*r3", f"3e-6*{a - c!r}*r3*r1", f"3e-6*{b - a!r}*r1*r2"]
    torque = Torque.polynomial(texts, sources={"r": orbit}, distance_powers={"r": 3})
    stated = Scene(Body(MOMENTS), *start, torques=[torque]).drift(average="orbit")
    assert np.allclose(built_in.momentum, stated.momentum, rtol=1e-12, atol=0)
    g = polhode(2, 1, excess, 2 * np.pi * (np.arange(64) + 0.5) / 64)[0]
    axial = 1.5 * (g**2 @ MOMENTS).mean() - 0.5 * MOMENTS.sum()
    normal = np.array([np.sin(0.4) * np.sin(0.3), -np.sin(0.4) * np.cos(0.3), np.cos(0.4)])
    k = momentum / np.linalg.norm(momentum)
    # ⟨(a/r)³ r̂r̂ᵀ⟩ = ½(1−e²)^(−3/2) (1 − n̂n̂ᵀ)
    expected = 1.5e-6 * (1 - 0.2**2) ** -1.5 * axial * (k @ normal) * np.cross(k, normal)
    assert np.allclose(built_in.momentum, expected, rtol=1e-12, atol=1e-21)
    assert abs(built_in.excess) < 1e-20


def test_average_over_the_orbit_is_the_mean_of_places():
    texts, _ = random_texts(4, 3, 1e-6)
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.3 * separatrix(0)
    start = state(0, -1, excess, momentum)
    for power in (2, 3, 0):
        orbit = Orbit(1e-6, 0.2, inclination=0.4, node=0.3, argument_of_pericentre=1.0)
        torque = Torque.polynomial(texts, sources={"s": orbit}, distance_powers={"s": power})
        mean = Scene(Body(MOMENTS), *start, torques=[torque]).drift(average="orbit")
        epochs = 2 * np.pi * 1e6 * np.arange(48) / 48
        places = [Scene(Body(MOMENTS), *start, epoch=epoch, torques=[torque]).drift(average="spin") for epoch in epochs]
        assert np.allclose(np.mean([place.momentum for place in places], axis=0), mean.momentum, rtol=0, atol=1e-19)
        assert np.mean([place.excess for place in places]) == pytest.approx(mean.excess, rel=0, abs=1e-19)


def test_friction_keeps_the_momentum():
    # T = k (h (h·ω) − h² ω), h = Iω: |M| stays, and Ė = ⟨T·ω⟩ = 2CĖ/M² in ξ̇.
    a, b, c = MOMENTS.tolist()
    dot, square = f"({a!r}*w1^2 + {b!r}*w2^2 + {c!r}*w3^2)", f"({a * a!r}*w1^2 + {b * b!r}*w2^2 + {c * c!r}*w3^2)"
    texts = [f"1e-3*({moment!r}*w{i}*{dot} - {square}*w{i})" for i, moment in enumerate((a, b, c), 1)]
    momentum, excess = np.array([0.3, -0.4, 0.85]), 0.3 * separatrix(2)
    size = np.linalg.norm(momentum)
    drift = Scene(Body(MOMENTS), *state(2, 1, excess, momentum), torques=[Torque.polynomial(texts)]).drift()
    assert np.abs(drift.momentum).max() < 1e-18
    g = polhode(2, 1, excess, 2 * np.pi * (np.arange(64) + 0.5) / 64)[0]
    h, w = size * g, size * g / MOMENTS
    power = 1e-3 * ((h * w).sum(axis=1) ** 2 - size**2 * (w * w).sum(axis=1)).mean()
    assert drift.excess == pytest.approx(2 * c * power / size**2, rel=1e-10)
    assert drift.excess < 0


def test_a_satellite_with_equal_sides_has_no_drift_over_an_orbit():
    orbit = Orbit(2e-7, 0.2)
    start = state(2, 1, 0.2 * separatrix(2), np.array([0.3, -0.4, 0.85]))
    plates = [[0.2, 0.1, 1], [1, 0.3, -0.2]], [2.0, 1.0], [[1, 0.2, 0.1], [-0.3, 1, 0.2]]
    torque = Torque.panels(*plates, specular=0.3, two_sided=True, pressure=1e-3, source=orbit)
    scene = Scene(Body(MOMENTS), *start, torques=[torque])
    within, over = scene.drift(average="spin"), scene.drift(average="orbit")
    assert np.linalg.norm(over.momentum) < 1e-14 * np.linalg.norm(within.momentum)


def octahedron(a, b, c):
    """Corners and sides, counter-clockwise from outside."""
    corners = [[a, 0, 0], [-a, 0, 0], [0, b, 0], [0, -b, 0], [0, 0, c], [0, 0, -c]]
    return corners, [[i, j, k] if (i + j + k) % 2 == 0 else [j, i, k] for i in (0, 1) for j in (2, 3) for k in (4, 5)]


@pytest.mark.parametrize("axis", [0, 2])
def test_a_body_with_three_planes_of_symmetry_has_no_yorp(axis):
    # Light makes it precess, no more; a sphere has no torque.
    orbit = Orbit(2e-7, 0.2, inclination=0.4, node=0.3)
    momentum = np.array([0.3, -0.4, 0.85])
    light = Torque.from_facets(*octahedron(1.3, 1.1, 0.9), specular=0.2, diffuse=0.1, pressure=1e-4, source=orbit)
    scene = Scene(Body(MOMENTS), *state(axis, 1, 0.2 * separatrix(axis), momentum), torques=[light])
    drift = scene.drift(average="orbit")
    size = np.linalg.norm(drift.momentum)
    assert size > 1e-7
    assert abs(drift.momentum @ momentum) < 1e-13 * size
    assert abs(drift.obliquity) < 1e-13 * size
    assert abs(drift.excess) < 1e-13 * size
    ball = Torque.from_facets(*octahedron(1, 1, 1), specular=0.2, diffuse=0.1, pressure=1e-4, source=orbit)
    assert np.abs(ball.value([[0.3, 0.5, -0.8], [1, 2, 3]])).max() < 1e-17


def test_absorbed_light_on_a_closed_body_has_no_drift_over_an_orbit():
    # What is absorbed and not radiated pushes along −u: the torque is odd in u.
    corners = np.array([[1.2, 1, 1], [1, -1.1, -1], [-1, 1, -1.3], [-1, -0.8, 1.5]])
    sides = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    start = state(2, 1, 0.2 * separatrix(2), np.array([0.3, -0.4, 0.85]))
    rates = []
    for emission in (0.0, 1.0):
        light = Torque.from_facets(corners - corners.mean(axis=0), sides, emission=emission, pressure=1e-4, source=Orbit(2e-7, 0.2))
        rates.append(np.linalg.norm(Scene(Body(MOMENTS), *start, torques=[light]).drift(average="orbit").momentum))
    assert rates[0] < 1e-13 * rates[1]
