"""Draws about several minima: the integral of a linear model, which is known, and two mirrored motions, which share the draws."""

from dataclasses import replace

import numpy as np
import pytest

from andoyer import Body, InputError, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer._quaternions import product
from andoyer.fit._draws import candidates

AXES = np.array([1.0, 0.7, 0.5])


class Linear:
    """Residuals A x + b."""

    duration = 1.0

    def __init__(self, matrix, constant):
        self.matrix, self.constant = matrix, constant

    def chi_squares(self, steps):
        return np.sum(self.derivatives(steps)[0] ** 2, axis=1)

    def derivatives(self, steps):
        return steps @ self.matrix.T + self.constant, np.repeat(self.matrix[None], len(steps), axis=0)


def test_weights_of_candidates_have_the_integral_of_the_likelihood_as_their_sum():
    generator = np.random.default_rng(5)
    matrix = generator.standard_normal((20, 3))
    constant = generator.standard_normal(20)
    constant -= matrix @ np.linalg.lstsq(matrix, constant, rcond=None)[0]
    found = candidates(Linear(matrix, constant), np.zeros((0, 3)), 100, generator)
    expected = 1.5 * np.log(2 * np.pi) - 0.5 * np.linalg.slogdet(matrix.T @ matrix)[1] - 0.5 * constant @ constant
    assert np.isclose(np.log(np.sum(np.exp(found.logarithms))), expected, atol=1e-9)


@pytest.fixture(scope="module")
def mirrored():
    """The fit of a tumbler whose Sun and observer stay in one plane, with the minimum turned by π about the normal beside it."""
    times = np.sort(np.random.default_rng(1).uniform(0, 20, 60))
    scene = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], [0.3, 0.2, 0.9])
    seen = {"sun": [1.0, 0.3, 0.0], "observer": [0.8, -0.3, 0.0], "sigma": 0.01}
    values = fit.brightness(AXES, scene.solve().attitude(times), seen["sun"], seen["observer"]) + 0.01 * np.random.default_rng(2).standard_normal(60)
    found = fit.light_curve(AXES, times, values, scene=scene, **seen)
    turned = product(np.array([[0.0, 0.0, 1.0, 0.0]]), np.array(found.scene.attitude)[None])[0]
    other = fit.light_curve(AXES, times, values, scene=Scene(scene.body, turned, found.scene.angular_velocity, epoch=times[0]), **seen)
    return replace(found, optima=(found.optima[0], other.optima[0]))


def test_mirrored_motions_share_the_draws(mirrored):
    assert abs(mirrored.optima[1].chi_square - mirrored.chi_square) < 1e-6
    drawn = mirrored.draws(1000, 1, optima=True)
    # Each half to the error of the two integrals, and a state is where its minimum is.
    assert abs(np.mean(drawn.optima) - 0.5) < 0.05
    poles = np.array([optimum.direction for optimum in mirrored.optima])
    momenta = np.asarray(drawn.states.angular_momentum(0.0))
    assert np.array_equal(np.argmax(momenta @ poles.T, axis=1), drawn.optima)
    assert not mirrored.draws(100, 1).optima.any()


def test_a_minimum_is_drawn_in_proportion_to_its_likelihood(mirrored):
    class Raised:
        """The same minimum with a χ² that is 2 more."""

        def __init__(self, model):
            self.duration, self._model = model.duration, model

        def chi_squares(self, steps):
            return self._model.chi_squares(steps) + 2.0

        def derivatives(self, steps):
            residuals, jacobian = self._model.derivatives(steps)
            more = np.full((len(steps), 1), np.sqrt(2.0))
            return np.concatenate([residuals, more], axis=1), np.concatenate([jacobian, np.zeros((len(steps), 1, jacobian.shape[2]))], axis=1)

    other = mirrored.optima[1].fit()
    raised = replace(other, _model=Raised(other._model), chi_square=other.chi_square + 2)
    optimum = replace(mirrored.optima[1], delta_chi_square=2.0, _made=lambda: raised)
    drawn = replace(mirrored, optima=(mirrored.optima[0], optimum)).draws(1000, 1, optima=True)
    # e⁻¹ : 1.
    assert abs(np.mean(drawn.optima) - 1 / (1 + np.e)) < 0.05


def test_optima_of_draws_must_be_true_or_false(mirrored):
    with pytest.raises(InputError, match="optima = 2: it must be True or False"):
        mirrored.draws(10, optima=2)
