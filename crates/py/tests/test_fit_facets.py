"""Fits of light curves with `shape="facets"`: bodies that are no ellipsoids, whose brightness is summed here; derivatives; what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from andoyer import Body, InputError, Scene

pytest.importorskip("scipy")
from andoyer import fit
from andoyer.fit import _facets, _observed
from andoyer.fit._curve import States

SIDES = np.array([1.0, 0.7, 0.5])
BODY = Body.ellipsoid(*SIDES)
SPAN, SIGMA = 40.0, 0.03


CORNERS = np.array([(x, y, z) for x in (1, -1) for y in (1, -1) for z in (1, -1)]) / np.sqrt(3)
NORMALS = np.concatenate([np.eye(3), -np.eye(3), CORNERS])
AREAS = np.concatenate([0.6 * np.tile(np.prod(SIDES) / SIDES, 2), np.full(8, 0.2)])


def cut_box(attitudes, sun, observer):
    """Brightness of a box without its corners after Lommel and Seeliger: the sum over its 14 sides, directions inertial, shape (n, 3)."""
    x, y, z, w = attitudes.T
    axes = [
        [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
        [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
        [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
    ]
    lit, seen = (np.maximum(np.einsum("ijn,nj->ni", axes, direction) @ NORMALS.T, 0) for direction in (sun, observer))
    return lit * seen / np.maximum(lit + seen, 1e-300) @ AREAS


def observed(rates, points=240):
    """Magnitudes of the cut box in three curves with zero points of their own: scene, times, and the arguments of a fit."""
    generator = np.random.default_rng(3)
    scene = Scene(BODY, [0.1, -0.5, 0.3, np.sqrt(0.65)], rates)
    times = np.sort(generator.uniform(0, SPAN, points))
    sun, observer = (
        np.stack([np.cos(angle), np.sin(angle), height + 0 * angle], axis=1) / np.hypot(1, height)
        for angle, height in ((0.6 + 0.01 * times, 0.2), (-0.01 * times, 0.1))
    )
    curves = (3 * times / (SPAN + 1)).astype(int)
    magnitudes = 15 - 2.5 * np.log10(cut_box(scene.solve().attitude(times), sun, observer)) + 0.3 * curves + SIGMA * generator.standard_normal(points)
    return scene, times, {"magnitudes": magnitudes, "sigma": SIGMA, "curves": curves, "sun": sun, "observer": observer}


TUMBLING = [0.4, 0.5, 1.7]


def test_a_box_that_tumbles_is_fitted():
    truth, times, given = observed(TUMBLING)
    start = Scene(BODY, truth.attitude, np.multiply(TUMBLING, 1.0005))
    ellipsoid, found = (fit.light_curve(SIDES, times, **given, shape=shape, scene=start) for shape in (True, "facets"))
    assert ellipsoid.reduced_chi_square > 5 > 3.3 > found.reduced_chi_square
    periods, expected = (np.array(scene.solve().periods["extremal-axis"]) for scene in (found.scene, truth))
    # In turns over the data, of which the verdict counts half a one as another pair.
    assert np.all(np.abs(1 / periods - 1 / expected) * SPAN < 0.15)
    # The zero points of the curves are 0.3 mag apart.
    assert np.abs(np.diff(found.zero_points.magnitudes) - 0.3).max() < 0.03
    assert np.std(found.residuals) < 1.5 * SIGMA
    normals, areas = found.facets
    assert normals.shape == (42, 3) and abs(areas.sum() - 1) < 0.1 and np.abs(areas @ normals).max() < 0.05
    nearby = fit.light_curve(SIDES, times, **given, shape="facets", scene=truth).facets.areas
    assert np.allclose(areas, nearby, atol=5e-3)


def test_a_box_in_simple_rotation_has_its_period():
    truth, times, given = observed([0, 0, 1.7])
    start = Scene(BODY, truth.attitude, [0, 0, 1.702])
    ellipsoid, found = (fit.light_curve(SIDES, times, **given, shape=shape, mode="principal-axis", scene=start) for shape in (True, "facets"))
    assert ellipsoid.reduced_chi_square > 5 > 2.5 > found.reduced_chi_square
    deviation = np.sqrt(found.covariance[3, 3])
    assert abs(np.linalg.norm(found.scene.angular_velocity) - 1.7) < 5 * deviation < 1e-2


def test_intensities_are_fitted_as_magnitudes():
    truth, times, given = observed(TUMBLING)
    magnitudes = fit.light_curve(SIDES, times, **given, shape="facets", scene=truth)
    bright = 10 ** (-0.4 * (given.pop("magnitudes") - 25))
    given["sigma"] = bright * SIGMA * np.log(10) / 2.5
    intensities = fit.light_curve(SIDES, times, bright, **given, shape="facets", scene=truth)
    assert abs(intensities.chi_square - magnitudes.chi_square) < 1e-6 * magnitudes.chi_square
    assert np.allclose(intensities.model(), 10 ** (-0.4 * (magnitudes.model() - 25)), rtol=1e-6)
    assert np.allclose(intensities.residuals, bright - intensities.model())
    # Between the data as at them.
    first = given["curves"] == 0
    assert np.allclose(magnitudes.model(times[first], curve=0), magnitudes.model()[first], atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_derivatives_are_those_of_chi_square(seed, monkeypatch):
    # With the parts solved to the end the gradient is exact.
    monkeypatch.setattr(_facets, "ROUNDS", 20)
    truth, times, given = observed(TUMBLING)
    data = _observed.data_of((times, None), (None, given["magnitudes"], SIGMA), (given["sun"], given["observer"]), given["curves"], None)
    curve = _facets.with_facets(replace(data.curve, shape=True))
    generator = np.random.default_rng(seed)
    state = States(SIDES[None] * 1.05, np.array([truth.attitude]), np.array([TUMBLING]))
    state = curve.moved(state, 1e-3 * generator.standard_normal((1, 8)))
    residuals, jacobian = (array[0] for array in curve.residuals(state))
    step = 1e-6 * np.eye(8)
    many = States(*(np.repeat(array, 8, axis=0) for array in state))
    differences = (curve.chi_squares(curve.moved(many, step)) - curve.chi_squares(curve.moved(many, -step))) / 4e-6
    assert residuals @ residuals == pytest.approx(curve.chi_squares(state)[0], rel=1e-12)
    assert np.abs(-jacobian @ residuals - differences).max() < 1e-2 * np.abs(differences).max()


def test_a_fitted_rotation_stays_about_the_axis_of_greatest_inertia():
    # The best ellipsoid without this bound is longer along the axis of rotation than across it.
    axes, generator = np.array([1.0, 0.55, 0.62]), np.random.default_rng(5)
    times = np.sort(generator.uniform(0, 10, 60))
    turn = np.stack([0 * times, 0 * times, np.sin(times), np.cos(times)], axis=1)
    sun, observer = np.array([1.0, 0.2, 0.3]), np.array([0.8, -0.3, 0.1])
    bright = 100 * fit.brightness(axes, turn, sun, observer)
    start = Scene(Body.ellipsoid(1, 0.6, 0.58), [0, 0, 0, 1], [0, 0, 2.0])
    found = fit.light_curve([1, 0.6, 0.58], times, bright, sun=sun, observer=observer, sigma=0.01 * bright, shape=True, mode="principal-axis", scene=start)
    assert found.semi_axes[2] <= found.semi_axes.min()
    assert found.scene.body.moments[2] == max(found.scene.body.moments)
    # The minimum is on the bound, where no normal distribution is about it.
    with pytest.warns(UserWarning, match="effective size"):
        drawn = found.draws(100, rng=1)
    assert np.all(drawn.states.moments[:, 2] >= drawn.states.moments.max(axis=1)) and np.isfinite(drawn.delta_chi_square).all()


def test_blas_has_one_thread_while_facets_are_solved_for(monkeypatch):
    controller = pytest.importorskip("threadpoolctl").ThreadpoolController()
    truth, times, given = observed(TUMBLING)
    seen, of = [], _facets.Facets._of

    def noted(curve, *states):
        seen.append({library["num_threads"] for library in controller.info() if library["user_api"] == "blas"})
        return of(curve, *states)

    monkeypatch.setattr(_facets.Facets, "_of", noted)
    with controller.limit(limits=2, user_api="blas"):
        before = {library["num_threads"] for library in controller.info() if library["user_api"] == "blas"}
        found = fit.light_curve(SIDES, times, **given, shape="facets", scene=truth)
        during = len(seen)
        found.draws(3, rng=1)
        after = {library["num_threads"] for library in controller.info() if library["user_api"] == "blas"}
    if before != {2}:
        pytest.skip(f"a BLAS whose threads are not set: {before}")
    assert during and len(seen) > during and all(threads == {1} for threads in seen) and after == {2}


def test_fits_that_overlap_leave_the_threads_of_blas_as_they_were():
    controller = pytest.importorskip("threadpoolctl").ThreadpoolController()

    def threads():
        return {library["num_threads"] for library in controller.info() if library["user_api"] == "blas"}

    limit = _facets._ONE_THREAD
    with controller.limit(limits=2, user_api="blas"):
        before = threads()
        limit.__enter__()
        limit.__enter__()
        inside = threads()
        limit.__exit__()
        still = threads()
        limit.__exit__()
        after = threads()
    if before != {2}:
        pytest.skip(f"a BLAS whose threads are not set: {before}")
    assert inside == still == {1} and after == {2}


def test_other_shapes_and_laws_are_refused():
    truth, times, given = observed(TUMBLING)
    bright = np.full(len(times), 1.0)
    bright[7] = 0.2
    faint = {key: given[key] for key in ("curves", "sun", "observer")}
    with pytest.raises(InputError, match=r"brightness\[7\] is 6.67 times its sigma: .* it must be 10 times") as refused:
        fit.light_curve(SIDES, times, bright, sigma=0.03, **faint, shape="facets", scene=truth)
    assert refused.value.argument == "brightness[7]"
    with pytest.raises(InputError, match=r"shape = 'box': it must be True, False or 'facets'"):
        fit.light_curve(SIDES, times, **given, shape="box", scene=truth)
    with pytest.raises(InputError, match=r"'facets' needs the scattering 'lommel-seeliger', not 'geometric'") as refused:
        fit.light_curve(SIDES, times, **given, shape="facets", scattering="geometric", scene=truth)
    assert refused.value.argument == "shape"
    assert fit.light_curve(SIDES, times, **given, scene=truth).facets is None
