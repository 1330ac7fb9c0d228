"""`Scene.locked`: the relaxed state of a locked body, and free librations that are asked for."""

import re
from fractions import Fraction

import numpy as np
import pytest

from andoyer import Body, InputError, Orbit, Scene, TheoryError

BODY = Body([0.3, 0.35, 0.4])
ORBIT = Orbit(1.0, eccentricity=0.02)


def longitude(motion, times, orbit):
    """The angle of the long axis from the mean direction of the disturbing body, in the plane of the orbit."""
    axis = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y + z * w)] for x, y, z, w in motion.attitude(times)])
    angle = np.arctan2(axis[:, 1], axis[:, 0]) - orbit.mean_motion * np.asarray(times)
    return (angle + np.pi / 2) % np.pi - np.pi / 2


def test_a_relaxed_body_has_the_forced_libration_alone():
    # ψ″ + ω² ψ = 2e sin M forces the amplitude 2e ω²/(ω² - 1) of ψ against M, ω² = 3(B - A)/C, to first order in e (Danby 1962, section 14.3).
    orbit = Orbit(1.0, eccentricity=1e-4)
    motion = Scene.locked(BODY, orbit, method="integrated", span=(0, 400), tolerance=1e-10).solve()
    times = np.linspace(0, 400, 4000)
    square = 3 * 0.05 / 0.4
    seen = longitude(motion, times, orbit)
    forced = 2e-4 * square / (square - 1)
    assert np.abs(seen - forced * np.sin(times)).max() < 1e-7
    # A natural start has a free libration as large as the forced one.
    at_rest = Scene(BODY, [0, 0, 0, 1], [0, 0, 1], orbit=orbit, method="integrated", span=(0, 400), tolerance=1e-10).solve()
    assert np.abs(longitude(at_rest, times, orbit) - forced * np.sin(times)).max() > 1e-4


@pytest.mark.parametrize("resonance", [1, Fraction(3, 2), 2.0])
def test_free_librations_are_those_that_were_asked_for(resonance):
    orbit = Orbit(1.0, eccentricity=0.2, inclination=0.3, node=1.0, argument_of_pericentre=0.4)
    body = Body([0.99e-2 + 0.39, 0.399, 0.4])
    asked, phases = [0.03, 0.01, 0.02], [0.5, -1.0, 2.0]
    scene = Scene.locked(body, orbit, resonance=resonance, amplitudes=asked, phases=phases, epoch=2.0, method="libration", tolerance=1e-6, span=(0, 100))
    libration = scene.solve().libration
    assert np.abs(libration.amplitudes - asked).max() < 1e-7
    assert np.abs(np.exp(1j * libration.phases) - np.exp(1j * np.array(phases))).max() < 1e-5
    relaxed = Scene.locked(body, orbit, resonance=resonance, method="libration", tolerance=1e-8, span=(-50, 50)).solve()
    assert np.abs(relaxed.libration.amplitudes).max() < 1e-9 and relaxed.plan.resonance == Fraction(resonance)


def test_a_precessing_orbit_has_the_pole_of_its_cassini_state():
    orbit = Orbit(1.0, eccentricity=0.05, inclination=0.09, node_rate=-0.004, pericentre_rate=0.002)
    body = Body([0.3998, 0.39989, 0.4])
    motion = Scene.locked(body, orbit, method="libration", tolerance=1e-6, span=(0, 50)).solve()
    assert np.abs(motion.libration.amplitudes).max() < 1e-8 and motion.libration.obliquity != 0


def test_axes_in_any_order_and_a_tensor_give_one_motion():
    times = np.linspace(0, 20, 5)
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    body = Body.from_inertia(turn @ np.diag([0.3, 0.35, 0.4]) @ turn.T)
    options = {"method": "libration", "tolerance": 1e-9, "span": (0, 20), "amplitudes": [0.05, 0, 0.02]}
    one, other = (Scene.locked(of, ORBIT, **options).solve() for of in (BODY, body))
    momenta = [motion.angular_momentum(times) for motion in (one, other)]
    assert np.abs(momenta[0] - momenta[1]).max() < 1e-9


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"resonance": 0.7}, InputError, "resonance = 0.7"),
        ({"resonance": 5}, InputError, "resonance = 5"),
        ({"resonance": float("nan")}, InputError, "resonance = NaN"),
        ({"amplitudes": [0.1, -0.1, 0]}, InputError, r"amplitudes\[1\] = -0.1"),
        ({"amplitudes": [0.1, 0]}, InputError, "amplitudes"),
        ({"phases": [0, 0, float("inf")]}, InputError, r"phases\[2\]"),
        ({"amplitudes": [1.5, 0, 0]}, TheoryError, "beyond the range of the series"),
        ({"scalar_first": True}, TypeError, "scalar_first"),
    ],
)
def test_a_wrong_argument_is_named(options, error, message):
    with pytest.raises(error, match=message):
        Scene.locked(BODY, ORBIT, **options)


def planar_growth(twist, e):
    """The largest multiplier of ψ″ = -twist/2 (a/r)³ sin 2(ψ + M - f) about its motion with the period of the orbit, by DOP853 of SciPy: twist = 3 (B - A)/C."""
    integrate = pytest.importorskip("scipy.integrate").solve_ivp

    def slope(anomaly, y):
        eccentric = anomaly
        for _ in range(60):
            eccentric -= (eccentric - e * np.sin(eccentric) - anomaly) / (1 - e * np.cos(eccentric))
        distance, seen = 1 - e * np.cos(eccentric), 2 * np.arctan2(np.sqrt(1 + e) * np.sin(eccentric / 2), np.sqrt(1 - e) * np.cos(eccentric / 2))
        angle = 2 * (y[0] + anomaly - seen)
        bend = -twist * np.cos(angle) / distance**3
        return [y[1], -twist / 2 * np.sin(angle) / distance**3, y[3], bend * y[2], y[5], bend * y[4]]

    def after_an_orbit(state):
        return integrate(slope, (0, 2 * np.pi), [*state, 1, 0, 0, 1], "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]

    root = pytest.importorskip("scipy.optimize").fsolve(lambda state: after_an_orbit(state)[:2] - state, np.zeros(2), xtol=1e-11)
    end = after_an_orbit(root)
    course = np.array([[end[2], end[4]], [end[3], end[5]]])
    assert np.abs(end[:2] - root).max() < 1e-8
    return np.abs(np.linalg.eigvals(course)).max()


@pytest.mark.parametrize(
    ("moments", "e", "out"),
    [
        ([0.65, 0.97, 1], 0.25, "stable"),
        ([0.8, 0.9, 1], 0.15, "stable"),
        ([0.5, 0.75, 1], 0.3, None),
        ([0.5, 0.8, 1], 0.15, "unstable"),
        ([0.6, 0.9, 1], 0.1, "unstable"),
    ],
)
def test_the_plane_of_an_instability_is_that_of_an_own_integration(moments, e, out):
    growth = planar_growth(3 * (moments[1] - moments[0]), e)
    with pytest.raises(TheoryError) as caught:
        Scene.locked(Body(moments), Orbit(1.0, eccentricity=e))
    said = str(caught.value)
    assert ("the resonance 1 is unstable in the orbit's plane" in said) == (growth > 1.001)
    if out == "stable":
        # The growth is that of the longitude alone.
        orbits = float(re.search(r"\(([\d.]+) orbits", said)[1])
        assert ", stable out of it" in said and orbits == pytest.approx(1 / np.log(growth), rel=5e-3)
    elif out == "unstable":
        assert "unstable out of it" in said


def test_a_resonance_without_torque_or_stability_is_said_in_words():
    with pytest.raises(TheoryError, match="3/2 has no torque"):
        Scene.locked(BODY, Orbit(1.0), resonance=1.5)
    with pytest.raises(TheoryError, match="A = B"):
        Scene.locked(Body([0.3, 0.3, 0.4]), ORBIT)
    # A body that stands on its long axis about the middle one: stable in the plane, unstable out of it (the Lagrange and DeBra-Delp regions, here k1 = 0.3, k3 = 0.6 beyond both).
    hyperion = Body([0.57933579, 0.87453875, 1.0])
    with pytest.raises(TheoryError, match="stable in the orbit's plane, unstable out of it: a small angle grows by a factor e in"):
        Scene.locked(hyperion, Orbit(2 * np.pi / 21.28, eccentricity=0.1230))
