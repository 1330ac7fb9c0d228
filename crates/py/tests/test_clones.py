"""Clones drawn from published values with their covariance."""

import numpy as np
import pytest

from andoyer import Body, Ensemble, InputError, fit

BODY = Body([0.729, 0.947, 1.0])
PUBLISHED = {"precession": 27.45, "rotation": 265.7, "longitude": 4.3, "latitude": -0.6, "rotation_phase": 0.3, "precession_phase": 0.6, "moment_2": 0.947}
DEVIATIONS = np.array([0.07, 6.0, 0.02, 0.03, 0.01, 0.02, 1e-3])


def covariance():
    """A correlation of each pair, from a product of a drawn matrix with its transpose."""
    root = np.random.default_rng(3).normal(size=(7, 9))
    matrix = root @ root.T
    scale = DEVIATIONS / np.sqrt(np.diag(matrix))
    return matrix * np.outer(scale, scale)


def test_twenty_thousand_draws_have_the_mean_and_the_covariance_given():
    given, count = covariance(), 20_000
    clones = fit.clones(BODY, PUBLISHED, given, count, rng=1)
    assert len(clones) == count and not clones.errors
    periods = clones.periods["extremal-axis"]
    x, y, z = clones.angular_momentum(0.0).T
    pole = [np.arctan2(y, x) % (2 * np.pi), np.arcsin(z / np.linalg.norm([x, y, z], axis=0))]
    columns = np.stack([periods.precession, periods.rotation, *pole, clones.moments[:, 1]])
    chosen = [0, 1, 2, 3, 6]
    means, errors = np.array(list(PUBLISHED.values()))[chosen], DEVIATIONS[chosen]
    # Five standard errors: those of a mean are σ/√n, those of a covariance at most σσ′√(2/n).
    assert np.all(np.abs(columns.mean(axis=1) - means) < 5 * errors / np.sqrt(count))
    assert np.all(np.abs(np.cov(columns) - given[np.ix_(chosen, chosen)]) < 5 * np.outer(errors, errors) * np.sqrt(2 / count))


def test_a_draw_is_the_scene_of_its_values_and_has_its_phases():
    drawn = np.array(list(PUBLISHED.values())) + np.random.default_rng(4).standard_normal((3, 7)) @ np.linalg.cholesky(covariance()).T
    clones = fit.clones(BODY, PUBLISHED, covariance(), 3, rng=4, epoch=5.0, tolerance=1e-9)
    moments = np.repeat(BODY.moments[None], 3, axis=0)
    moments[:, 1] = drawn[:, 6]
    across = np.cos(drawn[:, 3])
    directions = np.stack([across * np.cos(drawn[:, 2]), across * np.sin(drawn[:, 2]), np.sin(drawn[:, 3])], axis=1)
    same = Ensemble.from_periods(moments, drawn[:, 0], drawn[:, 1], "short-axis", directions, phases=drawn[:, 4:6], epoch=5.0, tolerance=1e-9, errors="nan")
    assert clones == same and clones.tolerance == 1e-9


def test_draws_that_no_body_can_have_are_refused_as_a_whole_and_counted():
    wide = np.diag([0.07, 150.0]) ** 2
    clones = fit.clones(BODY, {"precession": 27.45, "rotation": 265.7}, wide, 400, rng=2)
    precession, rotation = (np.array([27.45, 265.7]) + [0.07, 150.0] * np.random.default_rng(2).standard_normal((400, 2))).T
    ratio = rotation / precession  # of a short-axis mode: above that of small amplitudes
    refused = np.isnan(clones.attitude(0.0)[:, 0])
    assert sorted(clones.errors) == np.flatnonzero(refused).tolist()
    assert 50 < refused.sum() < 350 and ratio[refused].max() < ratio[~refused].min()
    assert {type(error) for error in clones.errors.values()} == {InputError}


@pytest.mark.parametrize(
    ("change", "argument", "message"),
    [
        ({"covariance": np.eye(3)}, "covariance", r"has shape \(3, 3\): it must be \(2, 2\)"),
        ({"covariance": [1.0, 2.0]}, "covariance", r"has shape \(2,\)"),
        ({"covariance": [[1.0, 0.5], [0.4, 1.0]]}, "covariance", "not symmetric"),
        ({"covariance": [[1.0, 1.0], [1.0, 1.0]]}, "covariance", "eigenvalues above 0"),
        ({"covariance": [[1.0, 2.0], [2.0, 1.0]]}, "covariance", "the eigenvalue -1"),
        ({"covariance": [[1.0, 0.0], [0.0, 0.0]]}, "covariance", "eigenvalues above 0"),
        ({"covariance": [[1.0, np.nan], [np.nan, 1.0]]}, "covariance", "finite"),
        ({"published": {"precession": 27.0, "rotation": np.inf}}, "published", "finite"),
        ({"published": {"precession": 27.0, "period": 3.0}}, "published", "has 'period'"),
        ({"published": {"precession": 27.0, "longitude": 3.0}}, "published", "no 'rotation'"),
        ({"published": {"precession": 27.0, "rotation": 265.0, "latitude": 0.1}}, "published", "no 'longitude'"),
        ({"published": {"precession": [1.0, 2.0], "rotation": [2.0, 3.0]}}, "published", "not a number"),
        ({"published": {"precession": 27.0, "rotation": 265.0, "longitude": 1.0, "latitude": -59.0}, "covariance": np.eye(4)}, "published", "latitude = -59"),
        ({"n": -1}, "n", "0 or more"),
        ({"rng": "seed"}, "rng", "Generator"),
    ],
)
def test_bad_input_is_refused(change, argument, message):
    arguments = {"body": BODY, "published": {"precession": 27.45, "rotation": 265.7}, "covariance": np.eye(2), "n": 3} | change
    with pytest.raises(InputError, match=message) as caught:
        fit.clones(**arguments)
    assert caught.value.argument == argument


def test_a_pole_is_given_once_and_moments_are_about_principal_axes():
    with pytest.raises(InputError, match="give one of them"):
        fit.clones(BODY, PUBLISHED, covariance(), 3, directions=[0, 0, 1])
    turned = Body.from_inertia([[1.0, 0.1, 0.0], [0.1, 1.2, 0.0], [0.0, 0.0, 1.5]])
    with pytest.raises(InputError, match="axes of its own") as caught:
        fit.clones(turned, PUBLISHED, covariance(), 3)
    assert caught.value.argument == "body"


def test_degrees_are_doubted_and_other_types_are_refused():
    published = {"precession": 27.45, "rotation": 265.7, "longitude": 246.0, "latitude": -1.0}
    with pytest.warns(UserWarning, match="published longitude = 246 is more than a whole turn"):
        fit.clones(BODY, published, np.eye(4), 1, rng=1)
    with pytest.warns(UserWarning, match="covariance: longitude has a standard deviation of 14, more than half a turn: angles are in radians"):
        fit.clones(BODY, published | {"longitude": 4.3}, np.diag([0.07, 6.0, 14.0, 0.12]) ** 2, 1, rng=1)
    for change in ({"body": [1, 2, 2.5]}, {"published": None}, {"errors": "raise"}):
        with pytest.raises(TypeError, match=next(iter(change))):
            fit.clones(**{"body": BODY, "published": published, "covariance": np.eye(4), "n": 1} | change)
