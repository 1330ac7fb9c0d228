"""Derivatives of bodies from tensors, with twelve parameters, and fits of the tensor; derivatives next to a sphere and the middle axis."""

import copy
import pickle

import numpy as np
import pytest
from conftest import REPOSITORY
from scipy.optimize import approx_fprime
from scipy.spatial.transform import Rotation

import andoyer
from andoyer import Body, Ensemble, Orbit, Scene, fit
from andoyer.fit import _attitudes

ATTITUDE = [0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214]
TENSOR = np.array([[1.0, 0.12, -0.07], [0.12, 1.5, 0.05], [-0.07, 0.05, 2.0]])
TIMES = np.linspace(0, 40, 100)
TRUTH = Scene(Body.from_inertia(TENSOR), [0, 0, 0, 1], [0.3, 0.4, 1.0])
FREE = ("attitude", "angular_velocity", "inertia")


def reference(name, numbers):
    """The bodies of a file in multiple precision: numbers of the body, rates, time, derivatives of attitude and rates."""
    columns = numbers + 6 if numbers == 3 else 12
    for line in (REPOSITORY / "tests/data" / name).read_text(encoding="utf-8").splitlines():
        values = np.array(line.split(), dtype=float)
        body, rates, time, attitude, spin = np.split(values, np.cumsum([numbers, 3, 1, 3 * columns]))
        yield body, rates, time[0], attitude.reshape(3, columns), np.hstack([np.zeros((3, 3)), spin.reshape(3, columns - 3)])


def tensor(elements):
    a, b, c, p, q, r = elements
    return [[a, p, q], [p, b, r], [q, r, c]]


@pytest.mark.parametrize(("name", "numbers"), [("partials_moments.txt", 3), ("partials_tensors.txt", 6)])
def test_derivatives_are_those_in_multiple_precision(name, numbers):
    """The reference has twelve digits. Next to the middle axis those by the moments are as small as its distance: the largest entry, or 1, is the measure."""
    ways = {"closed": 0, "series": 0}
    for given, rates, time, attitude, spin in reference(name, numbers):
        body = Body(given) if numbers == 3 else Body.from_inertia(tensor(given))
        motion = Scene(body, ATTITUDE, rates).solve()
        partials = motion.partials(time)
        for found, expected in ((partials.attitude, attitude), (partials.angular_velocity, spin)):
            for block in (slice(0, 3), slice(3, 6), slice(6, None)):
                size = max(np.abs(expected[:, block]).max(), 1.0)
                assert np.abs(found[:, block] - expected[:, block]).max() <= 2e-11 * size, (given, rates, time)
        ways[motion.plan.partials] += 1
    assert ways["series"] >= 15 and ways["closed"] >= 30


def test_the_number_of_parameters_does_not_depend_on_the_elements_of_a_tensor():
    diagonal = Body.from_inertia(np.diag([1.0, 1.5, 2.0]))
    assert diagonal.has_tensor and not Body([1.0, 1.5, 2.0]).has_tensor
    for body in (diagonal, pickle.loads(pickle.dumps(diagonal)), copy.deepcopy(diagonal), eval(repr(diagonal), {"Body": Body})):
        assert body == Body([1.0, 1.5, 2.0])
        assert Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().partials([1.0, 2.0]).attitude.shape == (2, 3, 12)
    plain = pickle.loads(pickle.dumps(Body([1.0, 1.5, 2.0])))
    assert not plain.has_tensor and Scene(plain, [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().partials(1.0).attitude.shape == (3, 9)


def test_a_scene_file_keeps_the_twelve_parameters(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(Scene(Body.from_inertia(np.diag([1.0, 1.5, 2.0])), [0, 0, 0, 1], [0.1, 0.2, 1.0]).to_toml(), encoding="utf-8")
    assert Scene.from_toml(path).solve().partials(1.0).attitude.shape == (3, 12)


def test_the_plan_says_which_form_serves():
    def form(body, rates):
        return Scene(body, [0, 0, 0, 1], rates).solve().plan.partials

    assert form(Body([1, 1.5, 2]), [0.1, 0.2, 1.0]) == "closed"
    assert form(Body([1, 1 - 1.2e-16, 1]), [0.5, 0.3, 1.0]) == "series"
    assert form(Body([1, 1.5, 2]), [1e-14, 1.0, 0.0]) == "series"
    assert form(Body([1, 1, 1.5]), [0.3, 0.2, 1.0]) == "closed"
    assert form(Body.from_inertia(np.diag([1, 1, 1.5])), [0.3, 0.2, 1.0]) == "series"
    assert form(TRUTH.body, [0.3, 0.2, 1.0]) == "closed"


def test_members_of_an_ensemble_have_the_parameters_and_bits_of_their_motions():
    ensemble = Ensemble([[1, 1.5, 2], [1, 1 + 1e-12, 1 + 3e-12]], [0, 0, 0, 1], [0.1, 0.2, 1.0])
    partials = ensemble.partials([10.0, 20.0])
    for member, moments in enumerate(ensemble.moments):
        alone = Scene(Body(moments), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().partials([10.0, 20.0])
        assert partials.attitude.shape == (2, 2, 3, 9) and (partials.attitude[member] == alone.attitude).all()
    # The last member has no motion: the largest moment exceeds the sum of the others.
    tensors = [TENSOR, np.diag([1, 1.5, 2]), np.diag([1, 1, 3])]
    for orbit in (None, Orbit(1e-3, 0.1)):
        ensemble = Ensemble(tensors, [0, 0, 0, 1], [0.02, 0.03, 1.0], orbits=[orbit] * 3, span=(0, 50), errors="nan")
        partials = ensemble.partials([10.0, 20.0])
        assert partials.attitude.shape == partials.angular_velocity.shape == (3, 2, 3, 12)
        for member, tensor in enumerate(tensors[:2]):
            scene = Scene(Body.from_inertia(tensor), [0, 0, 0, 1], [0.02, 0.03, 1.0], orbit=orbit, span=(0, 50))
            alone = scene.solve().partials([10.0, 20.0])
            assert (partials.attitude[member] == alone.attitude).all() and (partials.angular_velocity[member] == alone.angular_velocity).all()
        assert np.isnan(partials.attitude[2]).all() and ensemble.partials(10.0).attitude.shape == (3, 3, 12)


def test_derivatives_under_a_torque_have_twelve_parameters_too():
    scene = Scene(TRUTH.body, [0, 0, 0, 1], [0.02, 0.03, 1.0], orbit=Orbit(1e-3, 0.1), span=(0, 50))
    found = scene.solve().partials([10.0, 50.0]).attitude
    free = Scene(TRUTH.body, [0, 0, 0, 1], [0.02, 0.03, 1.0]).solve().partials([10.0, 50.0]).attitude
    assert found.shape == (2, 3, 12) and np.abs(found - free).max() < 1e-3 * np.abs(free).max()


def test_a_guess_of_the_tensor_leads_to_the_answer():
    """A guess 1 to 2 % off in its diagonal: principal moments about fixed axes leave a reduced χ² far above 1."""
    guess = Scene(Body.from_inertia(TENSOR * (1 + np.diag([0.01, -0.02, 0.015])) + 0.02 * (np.ones((3, 3)) - np.eye(3))), [0, 0, 0, 1], [0.3, 0.4, 1.0])
    noise = Rotation.from_rotvec(1e-3 * np.random.default_rng(5).normal(size=(100, 3)))
    measured = (TRUTH.solve().rotation(TIMES) * noise).as_quat()
    poor = fit.attitudes(guess, TIMES, measured, sigma=1e-3)
    good = fit.attitudes(guess, TIMES, measured, sigma=1e-3, free=FREE)
    assert poor.reduced_chi_square > 50 and 0.75 < good.reduced_chi_square < 1.25
    assert good.parameters[6:] == ("I11", "I22", "I33", "I12", "I13", "I23") and good.degrees_of_freedom == 300 - 11
    assert np.isclose(np.trace(good.scene.body.inertia), np.trace(guess.body.inertia), rtol=1e-12)
    assert good.message == "The data do not determine a common factor of the inertia tensor."
    found = good.scene.body.inertia * np.trace(TENSOR) / np.trace(good.scene.body.inertia)
    assert np.abs(found - TENSOR).max() < 5e-3


def test_the_tensor_lies_within_the_covariance():
    """Twelve simulations: the sum of squares over the covariance is χ² with 11 degrees of freedom each; bounds are its quantiles 1e-4 and 1 − 1e-4."""
    generator = np.random.default_rng(7)
    squares = 0.0
    for _ in range(12):
        measured = (TRUTH.solve().rotation(TIMES) * Rotation.from_rotvec(0.01 * generator.normal(size=(100, 3)))).as_quat()
        found = fit.attitudes(TRUTH, TIMES, measured, sigma=0.01, free=FREE)
        turn = (Rotation.from_quat(list(found.scene.attitude)).inv() * Rotation.from_quat(list(TRUTH.attitude))).as_rotvec()
        change = (TENSOR - found.scene.body.inertia)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        lost = found.undetermined[0, 6:]
        change -= lost * (lost @ change)
        difference = np.concatenate([turn, TRUTH.angular_velocity - found.scene.angular_velocity, change])
        squares += difference @ np.linalg.pinv(found.covariance, rcond=1e-9) @ difference
    assert 80 < squares < 199


def test_derivatives_of_the_fit_are_those_of_differences():
    generator = np.random.default_rng(2)
    measured = (TRUTH.solve().rotation(TIMES[:20]) * Rotation.from_rotvec(0.05 * generator.normal(size=(20, 3)))).as_quat()
    for free in (FREE, ("attitude", "angular_velocity", "moments"), ("inertia",)):
        problem = _attitudes._Problem(TRUTH, TIMES[:20], measured, 0.1, free)
        step = generator.normal(scale=0.02, size=problem.basis.shape[1])
        differences = (approx_fprime(step, problem.whitened, 1e-6) + approx_fprime(step, problem.whitened, -1e-6)) / 2
        assert np.abs(problem.jacobian(step) - differences).max() < 1e-7 * np.abs(differences).max()


def test_draws_of_a_tensor_have_its_covariance():
    measured = (TRUTH.solve().rotation(TIMES) * Rotation.from_rotvec(1e-3 * np.random.default_rng(3).normal(size=(100, 3)))).as_quat()
    found = fit.attitudes(TRUTH, TIMES, measured, sigma=1e-3, free=FREE)
    states = found.ensemble(4000, rng=5)
    # The members are about their own principal axes. Energy and angular momentum do not depend on the axes: δL = R (δθ × Iω + δI ω + I δω), δ(2T) = ω·δI ω + 2 ω·I δω.
    body, rates = found.scene.body.inertia, np.array(found.scene.angular_velocity)
    x, y, z = rates
    by_tensor = np.array([[x, 0, 0, y, z, 0], [0, y, 0, x, 0, z], [0, 0, z, 0, x, y]])
    cross = np.cross(np.eye(3), body @ rates).T
    turn = Rotation.from_quat(list(found.scene.attitude))
    slopes = np.vstack([turn.as_matrix() @ np.hstack([cross, body, by_tensor]), np.hstack([np.zeros(3), 2 * rates @ body, rates @ by_tensor])])
    energies = np.sum(np.array(states.moments) * np.array(states.angular_velocities) ** 2, axis=1)
    draws = np.column_stack([states.angular_momentum(0.0), energies])
    expected = slopes @ found.covariance @ slopes.T
    deviations = np.sqrt(np.diag(expected))
    # 4000 draws: a correlation is known to 1/√4000, the bound is five times that.
    assert np.abs((np.cov(draws.T) - expected) / np.outer(deviations, deviations)).max() < 0.08
    assert np.abs(draws.mean(axis=0) - [*turn.apply(body @ rates), rates @ body @ rates]).max() < 0.1 * deviations.max()


@pytest.mark.parametrize(
    ("scene", "free", "message"),
    [
        (Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]), FREE, "free has 'inertia' for a body given by moments"),
        (TRUTH, ("inertia", "moments"), "free has 'moments' and 'inertia'"),
    ],
)
def test_a_tensor_that_the_body_does_not_have_is_refused(scene, free, message):
    with pytest.raises(andoyer.InputError, match=message) as error:
        fit.attitudes(scene, TIMES, TRUTH.solve().attitude(TIMES), sigma=0.01, free=free)
    assert error.value.argument == "free"
