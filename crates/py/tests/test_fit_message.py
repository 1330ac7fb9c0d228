"""What a fit says of itself: bad fits, rival minima, equal moments, magnitudes; draws by the true χ²; `print`, `repr` and `help`."""

import inspect
import pickle
import sys
import warnings
from dataclasses import replace

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer import Body, Scene, TabulatedOrbit, output, plot

pytest.importorskip("scipy")
from scipy.spatial.transform import Rotation

from andoyer import fit
from andoyer.fit import _light_curve, _observed, _search
from andoyer.fit._message import composed, rivals
from andoyer.fit._optimum import Optimum, aliases

sys.path.insert(0, str(REPOSITORY / "tests/stress"))
import light_curves

AXES = np.array([1.0, 0.7, 0.5])
RATES = {"short-axis": [0.8, 1.2, 4.5], "long-axis": [5.5, 0.9, 0.6]}
TIMES = np.linspace(0, 50, 100)
TRUTH = Scene(Body([1.0, 1.5, 2.0]), [0.1, -0.2, 0.3, np.sqrt(0.86)], [0.1, 0.2, 1.0])


def seen(times, height):
    """Directions to Sun and observer, the first in the plane of axes 1 and 2, the second above it."""
    sun, observer = (np.stack([np.cos(angle), np.sin(angle), up + 0 * angle], axis=1) for angle, up in ((0.7 + 0.14 * times, 0.0), (-0.1 * times, height)))
    return {"sun": sun, "observer": observer}


def observed(mode, noise=0.02, height=0.1, points=100, seed=1):
    """A light curve over some six precession periods: scene, times, brightnesses, directions and σ."""
    generator = np.random.default_rng(seed)
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], RATES[mode])
    times = np.sort(generator.uniform(0, 6.0, points))
    given = seen(times, height)
    exact = fit.brightness(AXES, scene.solve().attitude(times), **given)
    sigma = noise * exact.mean()
    return scene, times, exact + sigma * generator.standard_normal(points), given | {"sigma": sigma}


def noisy(scene, generator, sigma=0.01):
    return scene.solve().rotation(TIMES) * Rotation.from_rotvec(sigma * generator.standard_normal((len(TIMES), 3)))


def curve_of(times, values, given):
    """The data of a fit."""
    return _observed.data_of((times, None), (values, None, given["sigma"]), (given["sun"], given["observer"]), None, None).curve


def test_bad_fit_is_called_bad_with_what_to_try():
    """Attitudes of another motion, and a light curve of other axes: the reduced χ² is far above 1."""
    found = fit.attitudes(TRUTH, TIMES, noisy(TRUTH, np.random.default_rng(1), sigma=0.05), sigma=0.01)
    assert found.reduced_chi_square > 15
    assert found.message.startswith(f"The fit is bad: its reduced χ² is {found.reduced_chi_square:.3g}, and noise of this sigma gives at most 1.44.")
    assert "determine every" not in found.message and "a first state nearer to the data" in found.message
    truth, times, values, given = observed("short-axis")
    with pytest.warns(UserWarning, match=r"the brightnesses lie between .*, and the fit is bad: if they are magnitudes"):
        found = fit.light_curve([1.0, 0.9, 0.8], times, values, scene=truth, **given)
    assert found.message.startswith("The fit is bad: its reduced χ² is ") and "shape=True" in found.message


def test_limit_of_a_good_fit_is_the_quantile_of_chi_square():
    """292 degrees of freedom: noise exceeds 1.444 times as many with the probability 1e-6."""
    assert composed(1.443 * 292, 292, "Try.", None) == "The data determine every free parameter."
    assert composed(1.445 * 292, 292, "Try.", None).endswith("Its uncertainties are too small. Try.")
    assert composed(0.0, 0, "Try.", "The data do not determine a.") == "The data do not determine a."


def test_reflected_motion_is_a_start_and_a_rival_minimum():
    """Sun and observer in one plane: the motion turned by π about its normal has the same brightness, and χ² to rounding."""
    truth, times, values, given = observed("short-axis", height=0.0)
    curve = curve_of(times, values, given)
    state = _light_curve._state_of(truth, AXES, times[0])
    one = _light_curve._polished(curve, _search.Population(state, curve.chi_squares(state)))
    found = _light_curve._with_others(curve, one)
    assert len(one.chi_squares) == 1 and abs(found.chi_squares[1] - found.chi_squares[0]) < 1e-6
    assert list(found.chi_squares) == sorted(found.chi_squares)
    best, mirrored = (Scene(Body.ellipsoid(*AXES), found.states.attitudes[place], found.states.rates[place], epoch=times[0]) for place in range(2))
    turned = Rotation.from_rotvec([0, 0, np.pi]) * best.solve().rotation(times)
    symmetric = [(turned * Rotation.from_quat(turn)).inv() * mirrored.solve().rotation(times) for turn in _light_curve.HALF_TURNS]
    assert min(difference.magnitude().max() for difference in symmetric) < 1e-4


def test_search_names_the_mirrored_motion():
    _, times, values, given = observed("short-axis", height=0.0)
    found = fit.light_curve(AXES, times, values, periods=(0.6, 2.0), starts=2000, **given)
    assert "with the same periods, such as a mirrored motion (Δχ² from 0.0)" in found.message
    assert all(alias.delta_chi_square > 25 for alias in found.aliases)


def test_reflections_keep_the_brightness_in_one_plane():
    _, times, _, given = observed("long-axis", height=0.0)
    units = [vectors / np.linalg.norm(vectors, axis=1, keepdims=True) for vectors in (given["sun"], given["observer"])]
    curve = curve_of(times, np.ones(len(times)), {"sun": units[0], "observer": units[1], "sigma": 0.1})
    state = _search.random_states(AXES, (0.6, 2.0), 1, np.random.default_rng(3))
    mirrored = _search.reflections(curve, state)
    seen_by = [curve._seen(part, curve._ensemble(part).attitude(curve.times)) for part in (state, *(mirrored.part([place]) for place in range(3)))]
    brightness = [andoyer.fit._scattering.with_derivatives(*view, "lommel-seeliger", derivatives=False).value for view in seen_by]
    apart = [np.abs(value - brightness[0]).max() for value in brightness[1:]]
    assert min(apart) < 1e-8 and sorted(apart)[1] > 1e-3


def test_ellipsoid_with_its_axes_in_another_order_is_the_same_minimum():
    truth, times, values, given = observed("short-axis")
    curve = replace(curve_of(times, values, given), shape=True)
    state = _light_curve._state_of(truth, AXES, times[0])
    cycle = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])  # columns: the new axes in the old ones
    attitude = (Rotation.from_quat(state.attitudes[0]) * Rotation.from_matrix(cycle)).as_quat()
    other = type(state)(state.axes @ cycle, attitude[None], state.rates @ cycle)
    both = type(state)(*(np.concatenate(arrays) for arrays in zip(state, other)))
    chi_squares = curve.chi_squares(both)
    assert chi_squares[0] == pytest.approx(chi_squares[1], rel=1e-9)
    assert len(_light_curve._distinct(curve, _search.Population(both, chi_squares)).chi_squares) == 1


def test_aliases_are_pairs_of_periods_that_differ_by_half_a_turn_over_the_data():
    def optimum(rate, chi_square):
        return Optimum(Scene(TRUTH.body, TRUTH.attitude, np.array(TRUTH.angular_velocity) * rate), "short-axis", chi_square, chi_square - 100.0, None)

    precession = optimum(1.0, 0.0).periods.precession
    duration = 50 * precession  # half a turn is a hundredth of the frequency
    optima = [optimum(1.0, 100.0), optimum(1.009, 101.0), optimum(1.011, 103.0), optimum(0.98, 104.0), optimum(1.012, 105.0), optimum(1.5, 126.0)]
    found = aliases(optima, duration)
    assert [alias.delta_chi_square for alias in found] == [3.0, 4.0, 26.0]
    assert found[0].scene == optima[2].scene and found[0].periods.precession == pytest.approx(precession / 1.011)
    said = rivals(optima, duration)
    assert said.startswith(f"4 other minima lie within Δχ² = 25 of the best (P_φ {precession:.6g}, ")
    assert "(Δχ² 3.0); " in said and "(Δχ² 4.0); 2 with one of these pairs" in said and "26" not in said
    assert rivals(optima[:1], duration) is None and repr(found[0]).startswith("Alias(P_φ=")


def test_equal_moments_are_named():
    """A body of revolution: the difference of its equal moments is 0 within its uncertainty. With three moments apart nothing is named."""
    for moments, named in (([1.0, 1.0, 2.0], ["I1 and I2"]), ([1.0, 2.0, 2.0], ["I2 and I3"]), ([1.0, 1.5, 2.0], [])):
        scene = Scene(Body(moments), [0, 0, 0, 1], [0.5, 0.6, 0.7])
        said = fit.attitudes(scene, TIMES, noisy(scene, np.random.default_rng(2)), sigma=0.01).message
        assert ("the difference of the moments" in said) == bool(named) and all(pair in said for pair in named)
        assert said.count(" and ") == len(named)


def test_brightness_does_not_show_the_rotation_of_an_ellipsoid_of_revolution_about_its_axis():
    axes = [1.0, 1.0, 0.5]
    scene = Scene(Body.ellipsoid(*axes), [0.1, -0.5, 0.3, np.sqrt(0.65)], [3.0, 4.0, 6.0])
    times = np.linspace(0, 6, 100)
    exact = fit.brightness(axes, scene.solve().attitude(times), **seen(times, 0.1))
    found = fit.light_curve(axes, times, exact, scene=scene, sigma=0.02, **seen(times, 0.1))
    assert found.message == "The data do not determine the rotation of the body axes about axis 3, about which the body is symmetric."


def test_rotation_about_an_axis_leaves_the_moments_near_their_first_values():
    """The data do not show the moments. With seeds 0, 2 and 5 the search went to ratios of 100,000 to 700,000 before."""
    scene = Scene(Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [0, 0, 1.0])
    for seed in (0, 2, 5):
        found = fit.attitudes(Scene(Body([1.0, 1.0, 2.0]), [0, 0, 0, 1], [0, 0, 1.0]), TIMES, noisy(scene, np.random.default_rng(seed)), sigma=0.01)
        assert found.scene.body.moments.min() > 0.3 and found.scene.body.moments.max() < 4
        assert found.message.startswith("The data do not determine ") and found.reduced_chi_square < 1.3


@pytest.mark.parametrize("magnitude", [8.0, 15.0])
def test_magnitudes_given_as_intensities_warn(magnitude):
    truth, times, values, given = observed("short-axis")
    magnitudes = magnitude - 2.5 * np.log10(values)
    with pytest.warns(UserWarning, match=r"the brightnesses lie between .* give them as magnitudes="):
        fit.light_curve(AXES, times, magnitudes, scene=truth, **(given | {"sigma": 0.02}))
    with pytest.raises(andoyer.InputError, match="magnitudes go to magnitudes=") as error:
        fit.light_curve(AXES, times, magnitudes - magnitude - 3, scene=truth, **given)
    assert error.value.argument == "brightness" and error.value.value < 0


def test_intensities_do_not_warn():
    truth, times, values, given = observed("short-axis")
    # The last ones lie between 3 and 30, as magnitudes do, and the fit is good.
    for unit in (1.0, 1e-3, 1e4, 3.1 / values.min()):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            fit.light_curve(AXES, times, unit * values, scene=truth, **(given | {"sigma": unit * given["sigma"]}))


@pytest.mark.parametrize("seed", [0, 1])
def test_draws_have_the_chi_square_of_their_parameters_where_those_of_the_covariance_do_not(seed):
    """Twenty nights, of either mode. E[Δχ²] is near 6; its standard error for 600 draws is √(12/600) = 0.14, and the bound of 10 % is 0.6. The command makes it with 50 curves."""
    truth, times, given, values = light_curves.simulated(seed, 0.02)
    found = fit.light_curve(AXES, times, values, scene=truth, **given)
    assert light_curves.of_covariance(found, 600, seed) > 9
    drawn = found.draws(600, rng=1)
    assert abs(drawn.delta_chi_square.mean() - 6) < 0.6
    assert 550 < drawn.effective_size <= 600
    # Δχ² is that of the states in the ensemble.
    brightness = np.array([fit.brightness(AXES, attitude, given["sun"], given["observer"]) for attitude in drawn.states[:5].attitude(times)])
    factors = brightness @ values / np.sum(brightness**2, axis=1)
    chi_squares = np.sum((values - factors[:, None] * brightness) ** 2, axis=1) / given["sigma"] ** 2
    assert np.allclose(chi_squares - found.chi_square, drawn.delta_chi_square[:5], atol=1e-4)
    assert drawn.states == found.ensemble(600, rng=1) and drawn.states != found.ensemble(600, rng=2)


def test_pulls_of_simulated_curves_are_normal():
    """Twelve curves, six parameters each: the sum of the squared pulls is near χ² with 72 degrees of freedom; bounds are its quantiles 1e-4 and 1 − 1e-4."""
    squares = 0.0
    for seed in range(12):
        truth, times, values, given = observed("short-axis", noise=0.05, points=60, seed=seed)
        found = fit.light_curve(AXES, times, values, scene=truth, **given)
        states = found.draws(300, rng=seed).states
        turns = (truth.solve().rotation(times[0]).inv() * states.rotation(times[0])).as_rotvec()
        there = np.concatenate([turns, states.at([times[0]]).angular_velocity[:, 0] - truth.solve().angular_velocity(times[0])], axis=1)
        squares += there.mean(axis=0) @ np.linalg.solve(np.cov(there.T), there.mean(axis=0))
    assert 35 < squares < 124


def test_newton_draws_and_weighted_draws_of_attitudes_agree(monkeypatch):
    """The eight determined parameters of a tensor body: both ways have the mean Δχ² 8, to four standard errors √(16/400)."""
    turn = Rotation.from_rotvec([0.3, 0.2, 0.5]).as_matrix()
    scene = Scene(Body.from_inertia(turn @ np.diag([1.0, 1.5, 2.0]) @ turn.T), [0, 0, 0, 1], [0.1, 0.2, 1.0])
    found = fit.attitudes(scene, TIMES, noisy(scene, np.random.default_rng(4)), sigma=0.01)
    weighted = found.draws(400, rng=1)
    monkeypatch.setattr("andoyer.fit._draws.SPARE", 1)  # its effective size is below the number of draws
    solved = found.draws(400, rng=1)
    for drawn in (weighted, solved):
        assert abs(drawn.delta_chi_square.mean() - 8) < 0.8 and drawn.effective_size > 395
    assert weighted.states != solved.states


def test_draws_say_that_their_effective_size_is_small(monkeypatch):
    truth, times, given, values = light_curves.simulated(1, 0.02)
    found = fit.light_curve(AXES, times, values, scene=truth, **given)
    monkeypatch.setattr("andoyer.fit._draws.ITERATIONS", 2)  # a part of the candidates is not solved for: the effective size is 122
    monkeypatch.setattr("andoyer.fit._result.LITTLE", 0.9)
    with pytest.warns(UserWarning, match=r"the 200 draws have the effective size \d+"):
        drawn = found.draws(200, rng=1)
    assert len(drawn.states) == 200 and drawn.effective_size < 180


@pytest.mark.parametrize("n", [-1, 2.5, "3", True])
def test_number_of_draws_is_a_whole_number(n):
    found = fit.attitudes(TRUTH, TIMES, noisy(TRUTH, np.random.default_rng(1)), sigma=0.01)
    with pytest.raises(andoyer.InputError, match="it must be a whole number, 0 or more") as error:
        found.ensemble(n)
    assert error.value.argument == "n" and len(found.ensemble(0)) == 0
    with pytest.raises(andoyer.InputError, match="rng"):
        found.ensemble(1, rng=-1)


def test_draws_with_a_table_of_positions_are_refused():
    table = TabulatedOrbit(
        np.linspace(-10, 60, 200), 100 * np.stack([np.cos(np.linspace(-1, 6, 200)), np.sin(np.linspace(-1, 6, 200)), np.zeros(200)], axis=1), 1.0
    )
    scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], orbit=table, span=(0, 50), tolerance=1e-8)
    times = TIMES[:10]
    found = fit.attitudes(scene, times, scene.solve().attitude(times), sigma=0.01, free="attitude")
    with pytest.raises(andoyer.InputError, match="an Ensemble takes one Orbit at most"):
        found.ensemble(3)
    assert "P_φ" in str(found)


def test_summary_has_each_quantity_with_its_deviation():
    """Deviations against the spread of 4,000 draws, which know it to 1.1 %; the differences are to first order."""
    found = fit.attitudes(TRUTH, TIMES, noisy(TRUTH, np.random.default_rng(1)), sigma=0.01)
    text = str(found)
    rows = {line[:17].strip(): line[17:].strip() for line in text.splitlines()[1:-1]}
    assert len(text) < 1500 and text.splitlines()[-1] == found.message
    assert list(rows) == ["reduced χ²", "mode", "P_φ", "P_ψ", "pole longitude", "pole latitude", "phase μ", "phase ν", "moment I1", "moment I2", "moment I3"]
    states = found.ensemble(4000, rng=1)
    periods, momentum, andoyer_variables = states.periods["extremal-axis"], states.angular_momentum([0.0])[:, 0], states.andoyer([0.0])[:, 0]
    drawn = {
        "P_φ": periods.precession,
        "P_ψ": periods.rotation,
        "pole longitude": np.degrees(np.arctan2(momentum[:, 1], momentum[:, 0])),
        "pole latitude": np.degrees(np.arcsin(momentum[:, 2] / np.linalg.norm(momentum, axis=1))),
        "phase μ": np.degrees(andoyer_variables[:, 1]),
        "phase ν": np.degrees(andoyer_variables[:, 2]),
        "moment I2": states.moments[:, 1],
    }
    for name, values in drawn.items():
        value, _, deviation = rows[name].rstrip("°").partition(" ± ")
        assert float(deviation) == pytest.approx(values.std(), rel=0.12), name  # two digits of the printed one
        assert (float(value) - values.mean() + 180) % 360 - 180 == pytest.approx(0, abs=0.2 * values.std()), name


def test_summary_says_what_is_held_and_what_is_not_determined():
    scene = Scene(Body.ellipsoid(*AXES), [0, 0, 0, 1], [0.1, 0.2, 1.0])
    text = str(fit.attitudes(scene, TIMES, scene.solve().attitude(TIMES), sigma=0.01, free="attitude"))
    assert text.count("(held)") == 6  # the moments, both periods and ν, which do not depend on the attitude
    still = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 0])
    assert "P_φ             none" in str(fit.attitudes(still, TIMES, still.solve().attitude(TIMES), sigma=0.01))
    sphere = Scene(Body.ellipsoid(1, 1, 1), [0, 0, 0, 1], [0.1, 0.2, 1.0])
    given = seen(TIMES, 0.1)
    found = fit.light_curve([1, 1, 1], TIMES, fit.brightness([1, 1, 1], sphere.solve().attitude(TIMES), **given), scene=sphere, sigma=0.1, **given)
    assert "pole longitude  not determined" in str(found) and "P_φ             not determined" in str(found)


def test_representations_are_one_line_and_fits_can_be_pickled():
    truth, times, values, given = observed("short-axis")
    found = fit.light_curve(AXES, times, values, scene=truth, **given)
    for record in (found, found.optima[0]):
        assert "\n" not in repr(record) and len(repr(record)) < 150
    assert repr(found).startswith("Fit(short-axis, P_φ=") and len(str(found)) < 1500
    again = pickle.loads(pickle.dumps(found))
    assert str(again) == str(found) and again.ensemble(5, rng=1) == found.ensemble(5, rng=1)


@pytest.mark.parametrize("module", [fit, plot, output])
def test_signatures_in_help_are_short(module):
    """They had the whole of numpy's ArrayLike, up to 2,101 characters, and all fields of the default heading."""
    for name in getattr(module, "__all__", dir(module)):
        value = getattr(module, name)
        if callable(value) and getattr(value, "__module__", "").startswith("andoyer"):
            signature = str(inspect.signature(value))
            assert len(signature) < 520 and "numpy._typing" not in signature, name
    assert "= Heading()" in str(inspect.signature(output.write_aem)) and "= Kernel()" in str(inspect.signature(output.write_ck))
    assert repr(output.Heading(name="A")) == "Heading(name='A')"
