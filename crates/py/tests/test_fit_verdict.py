"""Verdicts on simple rotation: bodies of another shape, noise that hides a wobble, periods seen once. Brightnesses are ellipsoids with added harmonics, so the answers are known."""

from dataclasses import replace

import numpy as np
import pytest

from andoyer import Body, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer.fit import _light_curve, _observed, _other_shape, _verdict
from andoyer.fit._curve import States
from andoyer.fit._search import Population

AXES = np.array([1.0, 0.7, 0.5])
SUN, OBSERVER = np.array([1.0, 0.3, 0.1]), np.array([0.8, -0.3, 0.05])


def observed(rates, noise, harmonic=None):
    """Three nights of 40 magnitudes, with a harmonic [mag] of the times: the true scene, times [h], nights, magnitudes, and the fit of simple rotation next to the truth."""
    generator = np.random.default_rng(7)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], rates)
    times = np.concatenate([24.0 * night + np.sort(generator.uniform(0, 6, 40)) for night in range(3)])
    times -= times[0]
    nights = np.floor((times + 1) / 24).astype(int)
    magnitudes = -2.5 * np.log10(fit.brightness(AXES, scene.solve().attitude(times), SUN, OBSERVER)) + noise * generator.standard_normal(len(times))
    if harmonic is not None:
        magnitudes += harmonic(times)
    given = {"magnitudes": magnitudes, "sigma": noise, "sun": SUN, "observer": OBSERVER, "curves": nights, "scene": scene}
    return scene, times, nights, magnitudes, fit.light_curve(AXES, times, mode="principal-axis", **given)


def states_of(optimum):
    return States(AXES[None], np.array(optimum.scene.attitude)[None], np.array(optimum.scene.angular_velocity)[None])


def evidence(rates, noise, harmonic=None, tumbling=1.0):
    """Of these nights: the simple rotation next to the truth, and a tumbling motion with a part of its χ²."""
    scene, times, nights, magnitudes, simple = observed(rates, noise, harmonic)
    curve = _observed.data_of((times, None), (None, magnitudes, noise), (SUN, OBSERVER), nights, None).curve
    optimum = simple.optima[0]
    states = states_of(optimum)
    means = curve.members @ (curve.members.T @ curve.brightness / curve.members.sum(axis=0))
    constant = float(np.sum(curve.weights * (curve.brightness - means) ** 2))
    return _verdict.Evidence(
        optima=[replace(optimum, mode="short-axis", chi_square=tumbling * optimum.chi_square, scene=scene)],
        residuals=simple.residuals / noise,
        curves=nights,
        degrees=120 - 3 - 6,
        duration=float(times[-1]),
        reached=5,
        simple=simple.optima,
        other_shapes=_other_shape.other_shapes(curve, states, constant),
        observed=float(sum(np.ptp(times[nights == night]) for night in range(3))),
        series=np.inf,
        constant=constant,
        undetermined=frozenset(),
        unit=" h",
    )


def third(times):
    return 0.03 * np.cos(3 * 1.1 * times + 0.4)


def test_the_period_of_a_rotator_of_another_shape_is_secure():
    # The ellipsoid leaves 7 times the noise, and a tumbling one that were to leave half of it is no reason to doubt the rotation.
    known = evidence([0, 0, 1.1], 0.003, third, tumbling=0.5)
    verdict = _verdict.judge(known)
    assert known.simple[0].chi_square > 2000 and _verdict.simple_rotation(known).probability < 1e-3
    assert verdict.simple and verdict.periods == "secure" and verdict.mode != "secure" and "leaves no wobble above" in str(verdict)
    assert known.simple[0].periods.precession == pytest.approx(2 * np.pi / 1.1, rel=2e-3)


def test_the_verdict_of_a_fit_has_the_series_beside_its_simple_rotation():
    _, times, nights, magnitudes, simple = observed([0, 0, 1.1], 0.003, third)
    data = _observed.data_of((times, None), (None, magnitudes, 0.003), (SUN, OBSERVER), nights, None)
    states = states_of(simple.optima[0])
    spun = replace(data, curve=replace(data.curve, spin=2))
    alone = _light_curve.Found(Population(states, np.array([simple.chi_square])), 5)
    tumbling = _light_curve.Found(Population(states._replace(rates=states.rates + 1e-3), np.array([0.5 * simple.chi_square])), 5)
    verdict = _light_curve._result(data, tumbling, _light_curve.Hypothesis(spun, alone, np.inf), np.inf, False).verdict
    assert verdict.simple and verdict.periods == "secure" and "leaves no wobble above" in str(verdict)


def test_another_frequency_is_a_wobble():
    known = evidence([0, 0, 1.1], 0.003, lambda times: 0.03 * np.cos(0.37 * times), tumbling=0.5)
    assert _verdict.judge(known).periods != "secure" and not _verdict.rotation(known).established


def test_noise_that_hides_a_wobble_leaves_the_period_ambiguous():
    quiet, noisy = (_verdict.judge(evidence([0, 0, 1.1], noise)) for noise in (0.003, 0.03))
    assert quiet.simple and quiet.periods == "secure"
    assert noisy.simple and noisy.periods == "ambiguous"


def test_a_period_that_is_seen_once_is_not_secure():
    # 18 h of nights, and a period of 12.1 h or of 6.3 h.
    slow, fast = (_verdict.judge(evidence([0, 0, rate], 0.002)) for rate in (0.52, 1.0))
    assert slow.simple and slow.periods == "ambiguous" and fast.periods == "secure"


def test_few_points_say_nothing_of_a_wobble():
    known = evidence([0, 0, 1.1], 0.003)
    others = known.other_shapes
    assert _verdict.rotation(known).established
    assert not _verdict.rotation(replace(known, other_shapes=others._replace(parameters=61))).established


def test_the_series_is_that_of_least_squares():
    known = evidence([0, 0, 1.1], 0.003, third)
    assert known.other_shapes.parameters == 3 + 6 + 32
    # Of 120 points of unit variance the fitted part is gone.
    assert 30 < known.other_shapes.chi_squares[0] < 120 < known.simple[0].chi_square / 10
