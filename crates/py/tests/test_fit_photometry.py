"""Light curves as observers have them: magnitudes with unknown zero points, light time, simple rotation, the verdict."""

import pickle

import numpy as np
import pytest

import andoyer
from andoyer import Body, InputError, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer._quaternions import angle_between

AXES = np.array([1.0, 0.7, 0.5])
SUN, OBSERVER = np.array([1.0, 0.3, 0.1]), np.array([0.8, -0.3, 0.05])
ZERO = np.array([17.3, 17.5, 16.9])


def observed(rates, noise=0.01, seed=1, directions=(SUN, OBSERVER)):
    """Three nights of magnitudes, each with a zero point of its own: scene, times, nights, magnitudes."""
    generator = np.random.default_rng(seed)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], rates)
    times = np.concatenate([24.0 * night + np.sort(generator.uniform(0, 6, 40)) for night in range(3)])
    nights = np.floor(times / 24).astype(int)
    exact = ZERO[nights] - 2.5 * np.log10(fit.brightness(AXES, scene.solve().attitude(times), *directions))
    return scene, times, nights, exact + noise * generator.standard_normal(len(times))


def fitted(times, nights, magnitudes, **options):
    given = {"sun": SUN, "observer": OBSERVER, "sigma": 0.01, "curves": nights}
    return fit.light_curve(AXES, times, magnitudes=magnitudes, **given | options)


def start(scene, times):
    """The true state at the first time."""
    return scene.solve().scene_at(times[0])


def test_zero_points_come_back_with_their_errors():
    scene, times, nights, magnitudes = observed([0.3, 0.2, 0.9])
    found = fitted(times, nights, magnitudes, scene=start(scene, times))
    pulls = (found.zero_points.magnitudes - ZERO) / found.zero_points.sigma
    assert np.abs(pulls).max() < 4 and 0.001 < found.zero_points.sigma.max() < 0.02 and found.zero_points.curves.tolist() == [0, 1, 2]
    assert found.residuals.std() == pytest.approx(0.01, rel=0.2) and np.abs(magnitudes - found.model() - found.residuals).max() < 0.01
    intensities = fit.light_curve(
        AXES,
        times,
        10 ** (-0.4 * magnitudes),
        sun=SUN,
        observer=OBSERVER,
        sigma=10 ** (-0.4 * magnitudes) * 0.01 * 0.4 * np.log(10),
        curves=nights,
        scene=start(scene, times),
    )
    # Weights of intensities go with the measured ones: 1.5σ² of bias in ln brightness, which differences of magnitudes have not.
    bias = 1.5 * 0.01**2 * 0.4 * np.log(10)
    assert 0 < (intensities.zero_points.magnitudes - found.zero_points.magnitudes).mean() < 2 * bias
    assert angle_between(intensities.scene.attitude, found.scene.attitude) < 1e-2


def test_magnitudes_of_large_errors_have_no_bias():
    generator = np.random.default_rng(4)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], [0.3, 0.2, 0.9])
    times = np.concatenate([24.0 * night + np.arange(0, 6, 0.02) for night in range(4)])
    exact = 17.3 - 2.5 * np.log10(fit.brightness(AXES, scene.solve().attitude(times), SUN, OBSERVER))
    found = fit.light_curve(AXES, times, magnitudes=exact + 0.2 * generator.standard_normal(len(times)), sigma=0.2, sun=SUN, observer=OBSERVER, scene=scene)
    # Weights by the measured intensities shift the mean by 0.055.
    assert abs(found.residuals.mean()) < 1e-6 and abs(found.zero_points.magnitudes[0] - 17.3) < 4 * found.zero_points.sigma[0] < 0.2


def test_errors_of_zero_points_are_those_of_many_fits():
    found = []
    for seed in range(25):
        scene, times, nights, magnitudes = observed([0.3, 0.2, 0.9], seed=seed)
        one = fitted(times, nights, magnitudes, scene=start(scene, times))
        found.append((one.zero_points.magnitudes - ZERO) / one.zero_points.sigma)
    # The mean of 25 pulls and their width: three standard deviations of each.
    assert np.abs(np.mean(found, axis=0)).max() < 0.6 and np.all(np.abs(np.std(found, axis=0) - 1) < 0.45)


def test_the_model_is_seen_at_other_times():
    scene, times, nights, magnitudes = observed([0.3, 0.2, 0.9])
    found = fitted(times, nights, magnitudes, scene=start(scene, times))
    other = np.linspace(1, 50, 30)
    exact = ZERO[0] - 2.5 * np.log10(fit.brightness(AXES, scene.solve().attitude(other), SUN, OBSERVER))
    assert np.abs(found.model(other) - exact).max() < 0.05
    assert np.abs(found.model(other, curve=2) - exact - ZERO[2] + ZERO[0]).max() < 0.05
    with pytest.raises(InputError, match="curve"):
        found.model(other, curve=7)
    moving = np.tile(SUN, (len(times), 1))
    with pytest.raises(InputError, match="sun must be given for times outside the data"):
        fitted(times, nights, magnitudes, scene=start(scene, times), sun=moving).model([1e4])
    assert found.model([1e3], sun=SUN, observer=OBSERVER).shape == (1,)


def test_light_time_is_taken_off():
    units, time = pytest.importorskip("astropy.units"), pytest.importorskip("astropy.time")
    scene, times, nights, magnitudes = observed([0.3, 0.2, 0.9])
    distances = 1.0 + 0.01 * times
    light = distances * 149597870.7 / 299792.458
    first = start(scene, times)
    guess = Scene(first.body, first.attitude, np.array(first.angular_velocity) / 3600)
    date = time.Time("2026-11-28T00:00:00", scale="utc")
    at = date + (times * 3600 - times[0] * 3600 + light) * units.s
    dated = Scene(guess.body, guess.attitude, guess.angular_velocity, epoch=date)
    found = fitted(at, nights, magnitudes, scene=dated, distances=distances)
    plain = fitted(3600 * (times - times[0]), nights, magnitudes, scene=guess)
    # The light left at the second midnight less the light time of the first point.
    assert abs((found.scene.__getnewargs_ex__()[1]["epoch"] - date).to_value("s")) < 1e-6
    assert np.abs(found.scene.angular_velocity - plain.scene.angular_velocity).max() < 1e-9 * np.abs(plain.scene.angular_velocity).max() * 1e3
    assert abs(found.chi_square - plain.chi_square) < 1e-3 * plain.chi_square
    with pytest.raises(InputError, match="distances .*times as a Time or a Quantity"):
        fitted(times, nights, magnitudes, scene=guess, distances=1.0)
    with pytest.raises(InputError, match="distances"):
        fitted(at, nights, magnitudes, scene=dated, distances=-1.0)


def test_simple_rotation_is_fitted_as_such():
    scene, times, nights, magnitudes = observed([0, 0, 1.1])
    found = fit.light_curve(
        AXES, times, magnitudes=magnitudes, sigma=0.01, curves=nights, sun=SUN, observer=OBSERVER, periods=(4, 9), starts=4000, mode="principal-axis"
    )
    best = found.optima[0]
    assert best.mode == "principal-axis" and best.periods.rotation == np.inf and found.verdict.periods == "secure"
    deviation = best.periods.precession * np.sqrt(found.covariance[3, 3]) / np.linalg.norm(best.scene.angular_velocity)
    assert abs(best.periods.precession - 2 * np.pi / 1.1) < 4 * deviation < 0.02
    assert found.parameters == ("θ1", "θ2", "θ3", "ω") and found.covariance.shape == (4, 4) and found.units[3] == "rad per unit of time"
    assert (
        repr(found).startswith("Fit(principal-axis, P=5.71")
        and 80 < found.chi_square < 160
        and "period" in str(found)
        and "P_ψ" not in str(found).splitlines()[3]
    )
    momentum = scene.solve().angular_momentum(0.0)
    angles = [
        np.degrees(np.arccos(np.clip(optimum.direction @ momentum / np.linalg.norm(momentum), -1, 1)))
        for optimum in found.optima
        if optimum.delta_chi_square < 25
    ]
    assert min(angles) < 45  # the longitude is known to 19° from one geometry


def test_every_tumbling_fit_says_by_how_much_it_beats_simple_rotation():
    _, times, nights, magnitudes = observed([0.3, 0.2, 0.9])
    options = {"sun": SUN, "observer": OBSERVER, "sigma": 0.01, "curves": nights, "periods": (4, 9), "starts": 2000}
    found = fit.light_curve(AXES, times, magnitudes=magnitudes, **options)
    assert found.simple_rotation.delta_chi_square > 1000 and found.simple_rotation.probability < 1e-6
    assert "simple rotation with" in str(found.verdict) and found.verdict.mode in ("secure", "ambiguous")
    assert found.simple_rotation.fit().chi_square == pytest.approx(found.chi_square + found.simple_rotation.delta_chi_square)
    rival = found.optima[1]
    assert rival.fit().chi_square == pytest.approx(rival.chi_square) and rival.delta_chi_square == pytest.approx(rival.chi_square - found.chi_square)
    assert rival.pole.shape == (2,) and np.allclose([np.cos(rival.pole[1]) * np.cos(rival.pole[0]), np.sin(rival.pole[1])], rival.direction[[0, 2]])
    again = pickle.loads(pickle.dumps(found))
    assert again.verdict == found.verdict and again.optima[1].fit().chi_square == pytest.approx(rival.chi_square)
    # A steady rotator: two more parameters gain no more than noise does.
    _, times, nights, magnitudes = observed([0, 0, 1.1], seed=2)
    steady = fit.light_curve(AXES, times, magnitudes=magnitudes, **options)
    assert steady.simple_rotation.probability > 1e-3 and steady.verdict.mode != "secure"
    assert steady.simple_rotation.period == pytest.approx(2 * np.pi / 1.1, rel=1e-3)


def test_a_tumbling_motion_fits_no_worse_than_a_simple_rotation():
    _, times, nights, magnitudes = observed([0, 0, 1.1], seed=3)
    found = fit.light_curve(AXES, times, magnitudes=magnitudes, sigma=0.01, curves=nights, sun=SUN, observer=OBSERVER, periods=(4, 9), starts=1)
    assert found.simple_rotation.delta_chi_square > -1e-3 and found.reduced_chi_square < 1.5
    assert found.verdict.mode != "secure"


def test_a_pole_that_the_fit_does_not_determine_is_not_secure():
    # At opposition, in one geometry, a turn about the line of sight changes nothing.
    _, times, nights, magnitudes = observed([0, 0, 1.1], noise=0.01, directions=(OBSERVER, OBSERVER))
    found = fit.light_curve(
        AXES, times, magnitudes=magnitudes, sigma=0.01, curves=nights, sun=OBSERVER, observer=OBSERVER, periods=(5.6, 5.8), starts=2000, mode="principal-axis"
    )
    assert "not determined" in str(found).split("pole longitude")[1].splitlines()[0]
    assert found.verdict.pole == "not determined"
    alone = found.optima[0].fit()
    assert len(alone.optima) == 1 and alone.verdict.pole == "not determined"


def test_errors_are_scaled_on_request():
    scene, times, nights, magnitudes = observed([0.3, 0.2, 0.9], noise=0.03)
    plain, scaled = (fitted(times, nights, magnitudes, scene=start(scene, times), scale_errors=on) for on in (False, True))
    assert plain.reduced_chi_square > 5 and "The fit is bad" in plain.message
    assert np.allclose(scaled.covariance, plain.reduced_chi_square * plain.covariance)
    assert np.allclose(scaled.zero_points.sigma, np.sqrt(plain.reduced_chi_square) * plain.zero_points.sigma)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"magnitudes": None}, "magnitudes and brightness: give one of the two"),
        ({"brightness": np.ones(120)}, "magnitudes and brightness: give one of the two"),
        ({"magnitudes": np.full(120, 99.99)}, r"magnitudes\[0\] = 99.99"),
        ({"magnitudes": np.full(120, np.nan)}, "magnitudes"),
        ({"magnitudes": np.ones(7)}, "magnitudes has shape"),
        ({"mode": "short-axis"}, "mode = 'short-axis'"),
        ({"scale_errors": 1}, "scale_errors = 1"),
        ({"sigma": 0.0}, "sigma"),
    ],
)
def test_bad_photometry_is_named(options, message):
    scene, times, nights, magnitudes = observed([0.3, 0.2, 0.9])
    with pytest.raises(andoyer.InputError, match=message):
        fitted(times, nights, **{"magnitudes": magnitudes, "scene": start(scene, times)} | options)
