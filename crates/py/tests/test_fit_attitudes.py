"""Fits of attitudes: the known answer within the covariance, derivatives against differences, what data do not determine, what is refused."""

import numpy as np
import pytest

import andoyer
from andoyer import Body, Orbit, Scene

pytest.importorskip("scipy")
from scipy.optimize import approx_fprime
from scipy.spatial.transform import Rotation

from andoyer import fit
from andoyer.fit import _attitudes, _rotations

TIMES = np.linspace(0, 50, 100)
TRUTH = Scene(Body([1.0, 1.5, 2.0]), [0.1, -0.2, 0.3, np.sqrt(0.86)], [0.1, 0.2, 1.0])
TURN = Rotation.from_rotvec([0.3, 0.2, 0.5]).as_matrix()
TILTED = Scene(Body.from_inertia(TURN @ np.diag([1.0, 1.5, 2.0]) @ TURN.T), [0, 0, 0, 1], [0.1, 0.2, 1.0])


def noisy(scene, covariances, generator, times=TIMES):
    errors = np.einsum("nij,nj->ni", np.linalg.cholesky(covariances), generator.standard_normal((len(times), 3)))
    return scene.solve().rotation(times) * Rotation.from_rotvec(errors)


def off(found, truth):
    """The parameters of the truth from those that were found, with the moments of the truth in the same unit."""
    moments = truth.body.moments * np.cbrt(np.prod(found.scene.body.moments) / np.prod(truth.body.moments))
    turn = Rotation.from_quat([found.scene.attitude, truth.attitude])
    turn = turn[0].inv() * turn[1]
    return np.concatenate([turn.as_rotvec(), truth.angular_velocity - found.scene.angular_velocity, moments - found.scene.body.moments])


@pytest.mark.parametrize("truth", [TRUTH, TILTED], ids=["principal axes", "tensor"])
def test_known_answers_lie_within_the_covariance(truth):
    """Twelve simulations: the sum of squares over the covariance is χ² with 8 degrees of freedom each; bounds are its quantiles 1e-4 and 1 − 1e-4."""
    generator = np.random.default_rng(1)
    covariances = np.broadcast_to(np.diag([1e-4, 4e-4, 2.5e-5]) + 2e-5, (len(TIMES), 3, 3))
    squares, chi_squares = 0.0, 0.0
    for _ in range(12):
        found = fit.attitudes(truth, TIMES, noisy(truth, covariances, generator), sigma=covariances)
        difference = off(found, truth)
        squares += difference @ np.linalg.pinv(found.covariance, rcond=1e-9) @ difference
        chi_squares += found.chi_square
        assert found.degrees_of_freedom == 292
    assert 52 < squares < 152
    assert 12 * 292 - 330 < chi_squares < 12 * 292 + 330


def test_covariance_is_the_inverse_of_the_information():
    """The information from differences of motions: central, with a step of 1e-6."""
    sigma, step = 0.01, 1e-6
    found = fit.attitudes(TRUTH, TIMES, TRUTH.solve().attitude(TIMES), sigma=sigma, free=("attitude", "angular_velocity"))

    def attitudes(change):
        attitude = Rotation.from_quat(list(found.scene.attitude)) * Rotation.from_rotvec(change[:3])
        return Scene(found.scene.body, attitude, found.scene.angular_velocity + change[3:]).solve().rotation(TIMES)

    slopes = [(attitudes(-step * axis).inv() * attitudes(step * axis)).as_rotvec().ravel() / (2 * step * sigma) for axis in np.eye(6)]
    assert np.allclose(found.covariance @ (np.array(slopes) @ np.transpose(slopes)), np.eye(6), atol=1e-5)


def test_poor_guess_leads_to_the_answer():
    """Rates 20 % off and moments 7 %: at the last time a turn and more away, so the search must take the data in one after the other."""
    guess = Scene(Body([1.0, 1.4, 2.1]), Rotation.from_quat(list(TRUTH.attitude)) * Rotation.from_rotvec([0.05, -0.1, 0.1]), [0.12, 0.18, 1.01])
    found = fit.attitudes(guess, TIMES[::-1], TRUTH.solve().attitude(TIMES[::-1]), sigma=0.02)
    assert np.allclose(off(found, TRUTH), 0, atol=1e-9) and found.chi_square < 1e-12
    assert np.isclose(np.prod(found.scene.body.moments), np.prod([1.0, 1.4, 2.1]), rtol=1e-12)


@pytest.mark.parametrize("scene", [TRUTH, TILTED], ids=["principal axes", "tensor"])
def test_derivatives_are_those_of_differences(scene):
    generator = np.random.default_rng(2)
    covariances = np.broadcast_to(np.diag([1e-2, 4e-2, 2e-2]) + 5e-3, (20, 3, 3))
    problem = _attitudes._Problem(scene, TIMES[:20], noisy(scene, covariances, generator, TIMES[:20]), covariances, ("attitude", "angular_velocity", "moments"))
    step = generator.normal(scale=0.02, size=8)
    differences = (approx_fprime(step, problem.whitened, 1e-6) - approx_fprime(step, problem.whitened, -1e-6)) / 2 + approx_fprime(
        step, problem.whitened, -1e-6
    )
    exact = problem.jacobian(step)
    # Central differences with a step of 1e-6: rounding 1e-15/1e-6 of the largest derivative.
    assert np.abs(exact - differences).max() < 1e-7 * np.abs(exact).max()


def test_rotation_vectors_have_the_derivatives_of_the_group():
    generator = np.random.default_rng(3)
    for size in (1e-6, 1e-3, 1.0, 3.1):
        vector = generator.normal(size=3)
        vector *= size / np.linalg.norm(vector)
        assert np.allclose(_rotations.logarithm(_rotations.exponential(vector)), vector, rtol=1e-12, atol=1e-15)
        right, left = _rotations.right_jacobian(vector), _rotations.inverse_left_jacobian(vector)
        # The left Jacobian is the transpose of the right one.
        assert np.allclose(right.T @ left, np.eye(3), atol=2e-11)
        change = 1e-6 * generator.normal(size=3)
        turned = (Rotation.from_rotvec(vector).inv() * Rotation.from_rotvec(vector + change)).as_rotvec()
        assert np.allclose(right @ change, turned, atol=1e-11)


@pytest.mark.parametrize(
    ("moments", "rates", "said"),
    [
        ([1, 1.5, 2], [0.1, 0.2, 1.0], "a common factor of the moments"),
        (
            [1, 1, 1],
            [0.1, 0.2, 1.0],
            "a common factor of the moments, nor the difference of the moments I1 and I2 (0 ± 0.077 %), I2 and I3 (0 ± 0.035 %), I1 and I3 (0 ± 0.069 %)",
        ),
        ([1, 1.5, 2], [0, 0, 1.0], "the moments"),
        ([1, 1.5, 2], [0, 0, 0], "the moments"),
    ],
    ids=["any", "sphere", "principal axis", "at rest"],
)
def test_message_names_what_attitudes_do_not_determine(moments, rates, said):
    scene = Scene(Body(moments), [0, 0, 0, 1], rates)
    found = fit.attitudes(scene, TIMES, scene.solve().attitude(TIMES), sigma=0.01)
    assert found.message == f"The data do not determine {said}."
    assert found.undetermined.shape == ({"the moments": 3}.get(said, 1), 9)


def test_what_is_determined_badly_is_named_too():
    """Arcs of a sixtieth of a rotation, which say nothing of the moments, and of a third of one, which say something of one ratio."""
    said = [fit.attitudes(TRUTH, times, TRUTH.solve().attitude(times), sigma=0.01).message for times in (TIMES[:5] / 20, TIMES[:5])]
    assert said[0] == "The data do not determine the moments."
    assert said[1].startswith("The data do not determine a common factor of the moments, nor the combination +0.")
    names = fit.attitudes(TRUTH, TIMES, TRUTH.solve().attitude(TIMES), sigma=0.01, free=("attitude", "angular_velocity"))
    assert names.message == "The data determine every free parameter." and names.parameters == ("θ1", "θ2", "θ3", "ω1", "ω2", "ω3")
    assert names.scene.body == TRUTH.body


def test_fit_under_an_orbit_keeps_the_orbit():
    scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0.01, 0.02, 1.0], orbit=Orbit(2e-3, 0.1), span=(0, 100), tolerance=1e-9)
    guess = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0.011, 0.02, 1.001], orbit=Orbit(2e-3, 0.1), span=(0, 100), tolerance=1e-9)
    found = fit.attitudes(guess, TIMES, scene.solve().attitude(TIMES), sigma=0.01, free=("attitude", "angular_velocity"))
    assert np.allclose(found.scene.angular_velocity, [0.01, 0.02, 1.0], atol=1e-8) and found.scene.orbit == scene.orbit


def test_calendar_times_are_taken():
    time = pytest.importorskip("astropy.time")
    epoch = time.Time("1992-12-02T21:40:00", scale="tdb")
    times = epoch + time.TimeDelta(TIMES, format="sec")
    scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=epoch)
    guess = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.001], epoch=epoch)
    found = fit.attitudes(guess, times, scene.solve().attitude(times), sigma=0.01)
    assert np.allclose(found.scene.angular_velocity, [0.1, 0.2, 1.0], atol=1e-9)
    assert found.ensemble(3, rng=1).attitude(times).shape == (3, 100, 4)


@pytest.mark.parametrize("truth", [TRUTH, TILTED], ids=["principal axes", "tensor"])
def test_draws_have_the_covariance(truth):
    covariances = np.broadcast_to(1e-4 * np.eye(3), (len(TIMES), 3, 3))
    found = fit.attitudes(truth, TIMES, noisy(truth, covariances, np.random.default_rng(4)), sigma=0.01)
    states = found.ensemble(4000, rng=5)
    axes = Rotation.from_matrix(found.scene.body.principal_axes)
    turns = Rotation.from_quat(list(found.scene.attitude)).inv() * Rotation.from_quat(np.array(states.attitudes)) * axes.inv()
    rates = axes.apply(np.array(states.angular_velocities)) - found.scene.angular_velocity
    draws = np.concatenate([turns.as_rotvec(), rates, states.moments - found.scene.body.moments], axis=1)
    deviations = np.sqrt(np.diag(found.covariance))
    # 4000 draws: a correlation is known to 1/√4000, the bound is five times that.
    assert np.abs(np.cov(draws.T) - found.covariance).max() < 0.08 * deviations.max() ** 2
    assert np.abs((np.cov(draws.T) - found.covariance) / np.outer(deviations, deviations)).max() < 0.08
    assert states == found.ensemble(4000, rng=5) and states != found.ensemble(4000, rng=6)


QUATERNIONS = TRUTH.solve().attitude(TIMES)


def test_times_are_those_that_a_motion_takes():
    """Quantities and durations from an epoch other than 0, lists of them, and durations from a calendar epoch."""
    units, time = pytest.importorskip("astropy.units"), pytest.importorskip("astropy.time")
    calendar = time.Time("1992-12-02T21:40:00", scale="utc")
    since = time.TimeDelta(TIMES, format="sec")
    listed = [second * units.s for second in TIMES + 100.0]
    cases = [(100.0, (TIMES + 100.0) * units.s), (100.0, listed), (100.0, since), (calendar, since), (calendar, [calendar + part for part in since])]
    for epoch, times in cases:
        truth = Scene(TRUTH.body, TRUTH.attitude, TRUTH.angular_velocity, epoch=epoch)
        guess = Scene(TRUTH.body, TRUTH.attitude, 1.01 * np.array(TRUTH.angular_velocity), epoch=epoch)
        found = fit.attitudes(guess, times, truth.solve().attitude(times), sigma=0.01, free=("attitude", "angular_velocity"))
        assert np.abs(found.scene.angular_velocity - TRUTH.angular_velocity).max() < 1e-10


@pytest.mark.parametrize(
    ("changed", "argument", "message"),
    [
        ({"attitudes": QUATERNIONS[:2], "times": TIMES[:2]}, "attitudes", "6 numbers for 8 parameters"),
        ({"attitudes": 0.9 * QUATERNIONS}, "attitudes", r"\[\d+\] has norm 0.9: a unit quaternion"),
        ({"attitudes": QUATERNIONS[:, :3]}, "attitudes", r"has shape \(100, 3\): it must be \(100, 4\)"),
        ({"attitudes": QUATERNIONS[:50]}, "attitudes", r"has shape \(50, 4\)"),
        ({"attitudes": np.where(QUATERNIONS > 0.9, np.nan, QUATERNIONS)}, "attitudes", "must be finite"),
        ({"sigma": 0.0}, "sigma", "must be above 0"),
        ({"sigma": -1.0}, "sigma", "must be above 0"),
        ({"sigma": np.ones(99)}, "sigma", r"has shape \(99,\)"),
        ({"sigma": np.zeros((100, 3, 3))}, "sigma", "eigenvalues above 0"),
        ({"sigma": np.triu(np.ones((100, 3, 3)))}, "sigma", "not symmetric"),
        ({"free": ("attitude", "inertia")}, "free", "'inertia'"),
        ({"free": ()}, "free", "is empty"),
        ({"times": np.append(TIMES[:-1], np.nan)}, "times", "99"),
    ],
)
def test_bad_input_is_an_error_that_names_it(changed, argument, message):
    given = {"times": TIMES, "attitudes": QUATERNIONS, "sigma": 0.01} | changed
    with pytest.raises(andoyer.InputError, match=message) as error:
        fit.attitudes(TRUTH, **given)
    assert error.value.argument == argument


def test_pictures_are_drawn():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = fit.attitudes(TRUTH, TIMES, QUATERNIONS, sigma=0.01)
    assert len(found.corner().axes) == 81
    assert [line.get_label() for line in found.residual_picture().lines[:3]] == ["about axis 1", "about axis 2", "about axis 3"]
    matplotlib.pyplot.close("all")
