"""Fits of light curves: a known answer from starts that know nothing of it, in either mode; derivatives; what is refused."""

from dataclasses import replace

import numpy as np
import pytest

import andoyer
from andoyer import Body, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer._quaternions import angle_between, product
from andoyer.fit import _curve, _light_curve, _observed, _search

AXES = np.array([1.0, 0.7, 0.5])
SPAN, NOISE = 6.0, 0.02
RATES = {"short-axis": [0.8, 1.2, 4.5], "long-axis": [5.5, 0.9, 0.6]}


def observed(mode, points=100, seed=1):
    """A hundred points over some six precession periods, Sun and observer moving: scene, times, directions, brightnesses and their σ."""
    generator = np.random.default_rng(seed)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], RATES[mode])
    assert scene.solve().plan.mode == mode
    times = np.sort(generator.uniform(0, SPAN, points))
    sun, observer = (np.stack([np.cos(angle), np.sin(angle), height + 0 * angle], axis=1) for angle, height in ((0.7 + 0.14 * times, 0.0), (-0.1 * times, 0.1)))
    exact = fit.brightness(AXES, scene.solve().attitude(times), sun, observer)
    sigma = NOISE * exact.mean()
    return scene, times, sun, observer, exact + sigma * generator.standard_normal(points), sigma


def off(scene, truth, times):
    """The largest angle between two motions, but for half turns of the body."""
    attitudes, others = scene.solve().attitude(times), truth.solve().attitude(times)
    return min(angle_between(attitudes, product(others, turn[None])).max() for turn in _light_curve.HALF_TURNS)


@pytest.mark.parametrize("mode", RATES)
def test_known_answer_is_found_from_ten_thousand_starts_that_do_not_know_it(mode):
    truth, times, sun, observer, values, sigma = observed(mode)
    found = fit.light_curve(AXES, times, values, sun=sun, observer=observer, sigma=sigma, periods=(0.6, 2.0), starts=10_000)
    deviation = np.sqrt(np.diag(found.covariance)[:3].max())
    assert off(found.scene, truth, times) < 6 * deviation < 0.3
    assert found.optima[0].mode == mode and found.optima[0].chi_square == found.chi_square
    # χ² with 93 degrees of freedom: quantiles 1e-4 and 1 − 1e-4.
    assert found.degrees_of_freedom == 93 and 49 < found.chi_square < 152
    # Sun and observer are near one plane: the motion turned by π about its normal fits nearly as well.
    assert found.message.startswith("2 other minima lie within Δχ² = 25 of the best") and "2 with the same periods" in found.message
    chi_squares = [optimum.chi_square for optimum in found.optima]
    assert chi_squares == sorted(chi_squares)
    wrong = [optimum for optimum in found.optima if optimum.mode != mode]
    assert wrong and wrong[0].chi_square > 10 * found.chi_square


def test_calendar_times_give_the_fit_of_their_seconds_with_a_calendar_epoch():
    astropy_time, units = pytest.importorskip("astropy.time"), pytest.importorskip("astropy.units")
    truth, times, sun, observer, values, sigma = observed("short-axis")
    guess = Scene(Body.ellipsoid(*AXES), truth.attitude, np.array(truth.angular_velocity) * 1.005, epoch=times[0])
    given = {"sun": sun, "observer": observer, "sigma": sigma}
    expected = fit.light_curve(AXES, times, values, scene=guess, **given)
    epoch = astropy_time.Time("2024-04-13T21:46:00", scale="utc")
    calendar = epoch + (times - times[0]) * units.s
    same = Scene(Body.ellipsoid(*AXES), truth.attitude, np.array(truth.angular_velocity) * 1.005, epoch=epoch)
    found = fit.light_curve(AXES, calendar, values, scene=same, **given)
    # The seconds differ by 1e-11 and the fits by what the last steps leave: a ten-thousandth of the standard deviation.
    deviations = np.sqrt(np.diag(expected.covariance))
    assert np.all(np.abs(np.subtract(found.scene.angular_velocity, expected.scene.angular_velocity)) < 1e-4 * deviations[3:6])
    assert found.scene.epoch == same.epoch
    shown = found.scene.solve().attitude(calendar[-1])
    assert angle_between(shown, expected.scene.solve().attitude(times[-1])) < 1e-4 * deviations.max()
    for other, periods in ((times * units.s, [0.01, 0.0334] * units.min), (list(calendar), (0.6, 2.0))):
        drawn = fit.light_curve(AXES, other, values, periods=periods, starts=40, **given)
        assert np.isfinite(drawn.chi_square)


def test_fit_of_the_shape_from_a_state_nearby_and_of_two_curves():
    truth, times, sun, observer, values, sigma = observed("short-axis")
    curves = (times > SPAN / 2).astype(int)
    scales = np.where(curves, 3.0, 0.5)
    guess = Scene(Body.ellipsoid(1, 0.75, 0.52), truth.attitude, np.array(truth.angular_velocity) * 1.005)
    found = fit.light_curve([1, 0.75, 0.52], times, values * scales, sun=sun, observer=observer, sigma=sigma * scales, curves=curves, shape=True, scene=guess)
    assert found.parameters[-2:] == ("b/a", "c/a") and found.degrees_of_freedom == 90 and 45 < found.chi_square < 150
    ratios, deviations = found.semi_axes[1:] / found.semi_axes[0], np.sqrt(np.diag(found.covariance)[-2:])
    assert np.all(np.abs(ratios - AXES[1:]) < 5 * deviations) and np.all(deviations < 0.03)
    states = found.ensemble(200, rng=1)
    assert len(states) == 200 and np.ptp(states.moments[:, 0]) > 0
    assert states.attitude(times).shape == (200, 100, 4)


def test_states_drawn_from_a_fit_predict_an_attitude_with_its_spread():
    truth, times, sun, observer, values, sigma = observed("short-axis")
    found = fit.light_curve(AXES, times, values, sun=sun, observer=observer, sigma=sigma, scene=truth)
    drawn = found.ensemble(2000, rng=2).attitude(SPAN)
    apart = angle_between(drawn, found.scene.solve().attitude(SPAN)[None])
    partials = found.scene.solve().partials(SPAN).attitude[:, :6]
    expected = np.sqrt(np.trace(partials @ found.covariance @ partials.T))
    # To first order; 2000 draws know a standard deviation to 2 %.
    assert np.isclose(np.sqrt(np.mean(apart**2)), expected, rtol=0.08)


@pytest.mark.parametrize("shape", [False, True])
@pytest.mark.parametrize("scattering", ["geometric", "lommel-seeliger"])
def test_derivatives_of_the_projected_residuals_give_the_gradient_of_chi_square(scattering, shape):
    """Kaufman's derivatives drop a part that is orthogonal to the residuals' gradient: that of χ² is exact."""
    truth, times, sun, observer, values, sigma = observed("long-axis", points=30)
    units = [vectors / np.linalg.norm(vectors, axis=1, keepdims=True) for vectors in (sun, observer)]
    members = (np.arange(30)[:, None] % 2 == np.arange(2)).astype(float)
    curve = _curve.Curve(times, values, np.full(30, sigma**-2.0), units[0].T, units[1].T, members, scattering, shape)
    states = _curve.States(np.tile([1.0, 0.68, 0.52], (1, 1)), np.array(truth.attitude)[None], np.array([[5.4, 0.92, 0.61]]))
    normal = curve.normal_equations(states)
    for place in range(6 + 2 * shape):
        step = np.zeros((1, 6 + 2 * shape))
        step[0, place] = 1e-5
        up, down = (curve.chi_squares(curve.moved(states, sign * step)) for sign in (1, -1))
        # χ² falls along the gradient of the residuals' model: dχ²/ds = −2 Jᵀr.
        assert np.isclose((up - down) / 2e-5, -2 * normal.gradient[0, place], rtol=1e-5, atol=1e-5 * np.abs(normal.gradient).max())


def test_normal_equations_are_those_of_the_state_and_the_factor_without_the_factor():
    """JᵀJ of the projected problem is the Schur complement of the full one, whose derivatives are differences here."""
    truth, times, sun, observer, values, sigma = observed("short-axis", points=30)
    curve = replace(_observed.data_of((times, None), (values, None, sigma), (sun, observer), None, None).curve, shape=True)
    state = _light_curve._state_of(truth, AXES, times[0])

    def model(step):
        axes, attitudes, rates = curve.moved(state, step[None])
        motion = Scene(Body.ellipsoid(*axes[0]), attitudes[0], rates[0], epoch=times[0]).solve()
        return fit.brightness(axes[0], motion.attitude(times), sun, observer) / sigma

    base = model(np.zeros(8))
    factor = base @ (values / sigma) / (base @ base)
    slopes = factor * np.stack([(model(1e-5 * axis) - model(-1e-5 * axis)) / 2e-5 for axis in np.eye(8)])
    expected = slopes @ slopes.T - np.outer(slopes @ base, slopes @ base) / (base @ base)
    found = curve.normal_equations(state).matrix[0]
    scale = np.sqrt(np.diag(expected))
    assert np.abs((found - expected) / np.outer(scale, scale)).max() < 1e-6


def test_both_modes_are_kept_however_bad_one_is():
    states = _search.random_states(AXES, (0.8, 1.6), 400, np.random.default_rng(1))
    short = _search.short_axis(_search.moments_of_ellipsoid(states.axes), states.rates)
    chi_squares = np.where(short, 1.0, 100.0) + np.arange(400) / 1e3
    kept = _search.best(_search.Population(states, chi_squares), 60)
    assert np.sum(kept.chi_squares > 50) == np.sum(kept.chi_squares < 50) == 30
    assert sorted(kept.chi_squares) == sorted([*np.sort(chi_squares[short])[:30], *np.sort(chi_squares[~short])[:30]])


def test_random_states_have_the_periods_and_both_modes():
    states = _search.random_states(AXES, (0.8, 1.6), 400, np.random.default_rng(1))
    modes, periods = [], []
    for axes, attitude, rates in zip(*states):
        motion = Scene(Body.ellipsoid(*axes), attitude, rates).solve()
        modes.append(motion.plan.mode)
        periods.append(motion.periods["extremal-axis"].precession)
    assert modes.count("short-axis") == modes.count("long-axis") == 200
    assert 0.8 <= min(periods) < 0.83 and 1.5 < max(periods) <= 1.6


def test_durations_count_from_the_epoch_of_the_scene():
    astropy_time = pytest.importorskip("astropy.time")
    truth, times, sun, observer, values, sigma = observed("short-axis")
    guess = Scene(Body.ellipsoid(*AXES), truth.attitude, truth.angular_velocity, epoch=100.0)
    since = astropy_time.TimeDelta(times - times[0], format="sec")
    given = {"sun": sun, "observer": observer, "sigma": sigma, "scene": guess}
    found = fit.light_curve(AXES, since, values, **given)
    # With the epoch 0, or with the first duration as the epoch, the motion at the same durations would be another one.
    assert found.scene.epoch == 100.0
    model = fit.brightness(AXES, found.scene.solve().attitude(since), sun, observer)
    factor = np.sum(values * model / sigma**2) / np.sum((model / sigma) ** 2)
    assert np.sum(((values - factor * model) / sigma) ** 2) == pytest.approx(found.chi_square, rel=1e-6)
    with pytest.raises(andoyer.InputError) as error:
        fit.light_curve(AXES, since + astropy_time.TimeDelta(1, format="sec"), values, **given)
    assert error.value.argument == "times"


@pytest.mark.parametrize(
    ("changed", "argument"),
    [
        ({"axes": [1, 1, -1]}, "axes"),
        ({"times": [[0.0]]}, "times"),
        ({"brightness": [1.0, 2.0]}, "brightness"),
        ({"brightness": np.zeros(100)}, "brightness"),
        ({"sigma": 0.0}, "sigma"),
        ({"sun": np.zeros((100, 3))}, "sun"),
        ({"observer": np.ones((7, 3))}, "observer"),
        ({"periods": None}, "periods"),
        ({"periods": (2.0, 1.0)}, "periods"),
        ({"periods": (0.0, 1.0)}, "periods"),
        ({"curves": [0, 1]}, "curves"),
        ({"starts": 0}, "starts"),
        ({"scattering": "hapke"}, "scattering"),
        ({"shape": "yes"}, "shape"),
        ({"delta_chi_square": -1.0}, "delta_chi_square"),
        ({"delta_chi_square": np.nan}, "delta_chi_square"),
        ({"rng": -1}, "rng"),
        ({"scene": 5}, "scene"),
        ({"scene": Scene(Body.ellipsoid(*AXES), [0, 0, 0, 1], [0, 0, 0])}, "scene"),
        ({"times": np.arange(6.0), "brightness": np.ones(6), "sun": [1, 0, 0], "observer": [1, 0, 0]}, "times"),
    ],
)
def test_bad_input_is_an_error_that_names_it(changed, argument):
    _, times, sun, observer, values, sigma = observed("short-axis")
    given = {
        "axes": AXES,
        "times": times,
        "brightness": np.abs(values),
        "sun": sun,
        "observer": observer,
        "sigma": sigma,
        "periods": (0.6, 2.0),
        "starts": 10,
    } | changed
    with pytest.raises(andoyer.InputError) as error:
        fit.light_curve(given.pop("axes"), given.pop("times"), given.pop("brightness"), **given)
    assert error.value.argument == argument
