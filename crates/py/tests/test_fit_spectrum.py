"""Starts from the spectrum: the series against a least-squares solution of NumPy, frequencies of the starts, a known answer with one random start."""

import numpy as np
import pytest

from andoyer import Body, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer.fit import _curve, _observed, _spectrum

AXES = np.array([1.0, 0.7, 0.5])
SUN, OBSERVER = np.array([1.0, 0.3, 0.1]), np.array([0.8, -0.3, 0.05])


def nights(rates, count=8, noise=0.01):
    """Magnitudes of nights with a zero point each: scene, times [h], nights, magnitudes."""
    generator = np.random.default_rng(4)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], rates)
    times = np.concatenate([24.0 * night + np.sort(generator.uniform(0, 7, 40)) for night in range(count)])
    curves = np.floor(times / 24).astype(int)
    exact = generator.standard_normal(count)[curves] - 2.5 * np.log10(fit.brightness(AXES, scene.solve().attitude(times), SUN, OBSERVER))
    return scene, times, curves, exact + noise * generator.standard_normal(len(times))


def curve_of(times, curves, magnitudes, sigma):
    return _observed.data_of((times, None), (None, magnitudes, sigma), (SUN, OBSERVER), curves, None).curve


def test_series_are_those_of_least_squares():
    _, times, curves, magnitudes = nights([0.3, 0.2, 0.9], count=3)
    sigma = np.linspace(0.01, 0.02, len(times))
    curve = curve_of(times, curves, magnitudes, sigma)
    pairs = np.array([[20, 31], [33, 9]])
    found = _spectrum.left(curve, pairs, _spectrum.TERMS, amplitude=1e9)
    step = 1 / (_spectrum.FINE * np.ptp(times))
    for pair, chi_square in zip(pairs, found):
        angles = 2 * np.pi * step * np.outer(times - times[0], _spectrum.TERMS @ pair)
        columns = np.concatenate([np.cos(angles), np.sin(angles), curves[:, None] == np.arange(3)], axis=1) / sigma[:, None]
        data = -0.4 * np.log(10) * magnitudes / sigma
        left = data - columns @ np.linalg.lstsq(columns, data, rcond=None)[0]
        assert chi_square == pytest.approx(left @ left * (1 / (0.4 * np.log(10))) ** 2, rel=1e-6)


def test_starts_have_the_frequencies_that_were_asked_for():
    shapes = _spectrum.Shapes.around(AXES, 0.0, np.random.default_rng(1))
    pairs = np.array([[0.2, 0.03], [0.2, 0.06], [0.1, 0.02], [0.1, 0.04]])
    states = shapes.starts(pairs, np.random.default_rng(2))
    for pair, attitude, rates in zip(pairs, states.attitudes, states.rates):
        periods = Scene(Body.ellipsoid(*AXES), attitude, rates).solve().periods["extremal-axis"]
        assert np.allclose(1 / np.array(periods), pair, rtol=1e-3)


@pytest.mark.parametrize("most", [_spectrum.MOST, 0])
def test_the_true_pair_is_a_candidate(most, monkeypatch):
    """From the whole grid, and from the strongest frequencies alone."""
    monkeypatch.setattr(_spectrum, "MOST", most)
    scene, times, curves, magnitudes = nights([0.3, 0.2, 0.9])
    curve = curve_of(times, curves, magnitudes, 0.01)
    shapes = _spectrum.Shapes.around(AXES, 0.0, np.random.default_rng(1))
    pairs = _spectrum.pairs_of(curve, shapes, (4.0, 12.0), 64)
    true = 1 / np.array(scene.solve().periods["extremal-axis"])
    assert np.min(np.max(np.abs(pairs - true), axis=1)) * np.ptp(times) < 0.5


def test_a_tumbler_of_a_week_is_found_from_its_spectrum():
    scene, times, curves, magnitudes = nights([0.3, 0.2, 0.9])
    found = fit.light_curve(AXES, times, magnitudes=magnitudes, sigma=0.01, curves=curves, sun=SUN, observer=OBSERVER, periods=(4, 12), starts=1)
    assert np.allclose(1 / np.array(found.optima[0].periods), 1 / np.array(scene.solve().periods["extremal-axis"]), atol=0.1 / np.ptp(times))
    assert found.reduced_chi_square < 1.3 and found.verdict.periods == "secure" and not found.verdict.simple


def test_series_of_one_period_shows_a_simple_rotation():
    _, times, curves, magnitudes = nights([0.0, 0.0, 1.1])
    steady = _spectrum.of_one_period(curve_of(times, curves, magnitudes, 0.01), (4.0, 12.0))
    _, times, curves, magnitudes = nights([0.3, 0.2, 0.9])
    assert steady < 2 * len(times) < 10 * len(times) < _spectrum.of_one_period(curve_of(times, curves, magnitudes, 0.01), (4.0, 12.0))


def test_curves_of_one_time_have_no_spectrum():
    curve = curve_of(np.zeros(5), None, np.arange(5.0), 0.01)
    shapes = _spectrum.Shapes.around(AXES, 0.0, np.random.default_rng(1))
    assert _spectrum.pairs_of(curve, shapes, (4.0, 12.0), 8).shape == (0, 2) and _spectrum.of_one_period(curve, (4.0, 12.0)) == np.inf
    assert isinstance(_spectrum.from_spectrum(curve, AXES, (4.0, 12.0), np.random.default_rng(1)).states, _curve.States)
