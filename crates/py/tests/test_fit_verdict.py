"""Verdicts on simple rotation: bodies of another shape, noise that hides a wobble, periods seen once. Brightnesses are ellipsoids with added harmonics, so the answers are known."""

import numpy as np
import pytest

from andoyer import Body, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer.fit import _observed, _other_shape
from andoyer.fit._curve import States

AXES = np.array([1.0, 0.7, 0.5])
SUN, OBSERVER = np.array([1.0, 0.3, 0.1]), np.array([0.8, -0.3, 0.05])


def simulated(rates, noise, third=0.0):
    """Three nights of 40 magnitudes with a zero point each, and with a third harmonic of the rotation [mag]: scene, times [h], nights, magnitudes."""
    generator = np.random.default_rng(7)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], rates)
    times = np.concatenate([24.0 * night + np.sort(generator.uniform(0, 6, 40)) for night in range(3)])
    nights = np.floor(times / 24).astype(int)
    exact = -2.5 * np.log10(fit.brightness(AXES, scene.solve().attitude(times), SUN, OBSERVER))
    harmonic = third * np.cos(3 * np.linalg.norm(rates) * times + 0.4)
    return scene, times, nights, np.array([17.3, 17.5, 16.9])[nights] + exact + harmonic + noise * generator.standard_normal(len(times))


def found(rates, noise, periods, third=0.0):
    _, times, nights, magnitudes = simulated(rates, noise, third)
    return fit.light_curve(AXES, times, magnitudes=magnitudes, sigma=noise, curves=nights, sun=SUN, observer=OBSERVER, periods=periods, starts=500)


def test_the_period_of_a_rotator_of_another_shape_is_secure():
    # A tumbling ellipsoid explains the third harmonic, and a body in simple rotation does.
    one = found([0, 0, 1.1], 0.003, (4, 9), third=0.03)
    assert one.simple_rotation.probability < 1e-3 and one.verdict.simple
    assert one.verdict.periods == "secure" and one.simple_rotation.period == pytest.approx(2 * np.pi / 1.1, rel=1e-3)
    assert one.verdict.mode != "secure" and "leaves no wobble above" in str(one.verdict)


def test_noise_that_hides_a_wobble_leaves_the_period_ambiguous():
    one = found([0, 0, 1.1], 0.05, (4, 9))
    assert one.simple_rotation.probability > 1e-3 and one.verdict.simple and one.verdict.periods == "ambiguous"


def test_a_period_that_is_seen_once_is_not_secure():
    # 18 h of nights and a period of 12.1 h.
    one = found([0, 0, 0.52], 0.002, (8, 16))
    assert one.verdict.simple and one.verdict.periods == "ambiguous"


def test_a_wobble_is_no_simple_rotation():
    one = found([0.12, 0.07, 1.1], 0.003, (4, 9))
    assert not one.verdict.simple


def test_the_series_takes_up_harmonics_of_the_rotation_and_no_others():
    scene, times, nights, magnitudes = simulated([0, 0, 1.1], 0.003, third=0.03)
    left = []
    for change in (0.0, 0.03 * np.cos(0.37 * times)):
        data = _observed.data_of((times - times[0], None), (None, magnitudes + change, 0.003), (SUN, OBSERVER), nights, None)
        first = scene.solve().scene_at(times[0])
        states = States(AXES[None], np.array(first.attitude)[None], np.array(first.angular_velocity)[None])
        curve = data.curve
        square = float(np.sum(curve.weights * (curve.brightness - curve.members @ (curve.members.T @ curve.brightness / curve.members.sum(axis=0))) ** 2))
        series = _other_shape.with_series(curve, states, square)
        assert series.parameters == 3 + 6 + 32 and float(curve.chi_squares(states)[0]) > 5000
        left.append(float(series.chi_squares[0]))
    # Of 120 points of unit variance the fitted part is gone.
    assert left[0] < 120 and left[1] > 1000
