"""Brightness of an ellipsoid in closed form against sums over its surface, and the derivatives against differences."""

import numpy as np
import pytest

import andoyer
from andoyer import fit
from andoyer.fit import _scattering

LEVEL = [0.0, 0.0, 0.0, 1.0]
SPHERE = [1.0, 1.0, 1.0]


def triangulated(axes, cells=300):
    """Centres' normals and areas of two triangles a cell of a grid in height and longitude, and their unit normals."""
    height, longitude = np.linspace(-1, 1, cells + 1), np.linspace(0, 2 * np.pi, 2 * cells + 1)
    polar = np.sin(np.pi / 2 * height)
    z, angle = np.meshgrid(polar, longitude, indexing="ij")
    ring = np.sqrt(np.maximum(1 - z * z, 0))
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=-1) * axes
    corners = [points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]]
    vectors = [np.cross(corners[1] - corners[0], corners[2] - corners[0]), np.cross(corners[2] - corners[0], corners[3] - corners[0])]
    normals = np.concatenate([vector.reshape(-1, 3) for vector in vectors]) / 2
    areas = np.linalg.norm(normals, axis=1)
    return normals[areas > 0] / areas[areas > 0, None], areas[areas > 0]


def summed(axes, sun, observer, scattering):
    normals, areas = triangulated(axes)
    lit, seen = normals @ sun, normals @ observer
    both = (lit > 0) & (seen > 0)
    lit, seen, areas = lit[both], seen[both], areas[both]
    return float(np.sum(areas * (seen if scattering == "geometric" else lit * seen / (lit + seen))))


def unit(generator):
    vector = generator.normal(size=3)
    return vector / np.linalg.norm(vector)


@pytest.mark.parametrize("scattering", ["geometric", "lommel-seeliger"])
def test_closed_form_is_the_sum_over_the_surface(scattering):
    """360,000 triangles of a side of 0.01: facets at terminator and limb are counted or not, up to 1e-3 of the whole for "geometric", less where the law vanishes there."""
    generator = np.random.default_rng(1)
    for _ in range(12):
        axes, sun, observer = generator.uniform(0.3, 1.0, 3), unit(generator), unit(generator)
        exact = float(fit.brightness(axes, LEVEL, sun, observer, scattering=scattering))
        full = float(fit.brightness(axes, LEVEL, observer, observer, scattering=scattering))
        assert abs(exact - summed(axes, sun, observer, scattering)) < (1.5e-3 if scattering == "geometric" else 1e-4) * full


def test_sphere_has_the_phase_functions_of_the_textbooks():
    """π(1 + cos α)/2; and (π/2)[1 − sin(α/2) tan(α/2) ln cot(α/4)] (Lommel and Seeliger)."""
    for phase in np.radians([1e-6, 1.0, 40.0, 90.0, 150.0, 175.0]):
        sun = [np.cos(phase), np.sin(phase), 0.0]
        geometric = fit.brightness(SPHERE, LEVEL, sun, [1, 0, 0], scattering="geometric")
        assert np.isclose(geometric, np.pi * (1 + np.cos(phase)) / 2, rtol=1e-12)
        seeliger = 1 - np.sin(phase / 2) * np.tan(phase / 2) * np.log(1 / np.tan(phase / 4))
        assert np.isclose(fit.brightness(SPHERE, LEVEL, sun, [1, 0, 0]), np.pi / 2 * seeliger, rtol=1e-8)


def test_full_phase_has_no_singularity():
    directions = np.array([[0.6, 0.8, 0.0]])
    near = directions + np.array([1e-9, -1e-9, 1e-9])
    for scattering in _scattering.LAWS:
        at = fit.brightness([1, 0.8, 0.5], LEVEL, directions, directions, scattering=scattering)
        assert np.isfinite(at).all() and np.allclose(at, fit.brightness([1, 0.8, 0.5], LEVEL, directions, near, scattering=scattering), rtol=1e-8)
        turned = _scattering.with_derivatives(np.array([1, 0.8, 0.5]), directions[0], directions[0], scattering, shape=True)
        assert np.isfinite(turned.by_turn).all() and np.isfinite(turned.by_shape).all()


@pytest.mark.parametrize("scattering", ["geometric", "lommel-seeliger"])
def test_derivatives_are_those_of_differences(scattering):
    generator = np.random.default_rng(2)
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation
    for _ in range(10):
        axes, sun, observer = np.append(1.0, generator.uniform(0.3, 0.9, 2)), unit(generator), unit(generator)
        start = rotation.random(rng=generator)

        def value(turn, shape, axes=axes, start=start, sun=sun, observer=observer):
            attitude = (start * rotation.from_rotvec(turn)).as_quat()
            return fit.brightness(axes * np.exp([0, *shape]), attitude, sun, observer, scattering=scattering) / (np.pi / 2)

        found = _scattering.with_derivatives(axes, start.inv().apply(sun), start.inv().apply(observer), scattering, shape=True)
        step, still = 1e-5, np.zeros(3)
        by_turn = [(value(step * axis, still[:2]) - value(-step * axis, still[:2])) / (2 * step) for axis in np.eye(3)]
        by_shape = [(value(still, step * axis) - value(still, -step * axis)) / (2 * step) for axis in np.eye(2)]
        # Truncation 1e-10 of the third derivative, rounding 1e-16/1e-5.
        assert np.allclose(found.by_turn, by_turn, atol=1e-8) and np.allclose(found.by_shape, by_shape, atol=1e-8)


def test_brightness_does_not_depend_on_the_lengths_of_directions_and_has_the_square_of_the_unit_of_the_axes():
    axes, sun, observer = np.array([1, 0.8, 0.5]), np.array([1.0, 0.2, 0.0]), [1, 0, 0.3]
    expected = fit.brightness(axes, LEVEL, sun, observer)
    for scale in (1e-200, 1e200):
        assert np.isclose(fit.brightness(axes, LEVEL, scale * sun, observer), expected, rtol=1e-14)
    assert np.isclose(fit.brightness(1e-30 * axes, LEVEL, sun, observer), 1e-60 * expected, rtol=1e-13, atol=0)


@pytest.mark.parametrize(
    ("changed", "argument"),
    [
        ({"axes": [1, 0, 1]}, "axes"),
        ({"axes": [1, 1]}, "axes"),
        ({"sun": [0, 0, 0]}, "sun"),
        ({"sun": [-1, 0, 0]}, "sun"),
        ({"observer": [1, 0]}, "observer"),
        ({"observer": [np.nan, 0, 1]}, "observer"),
        ({"scattering": "lambert"}, "scattering"),
        ({"scattering": ["lambert"]}, "scattering"),
        ({"axes": [1e-7, 1, 1]}, "axes"),
        ({"attitudes": [0, 0, 0, 2]}, "attitudes"),
        ({"attitudes": [LEVEL] * 2, "sun": [[1, 0, 0]] * 3}, "sun"),
    ],
)
def test_bad_input_is_an_error_that_names_it(changed, argument):
    given = {"axes": SPHERE, "attitudes": LEVEL, "sun": [1, 0, 0], "observer": [1, 0, 0]} | changed
    with pytest.raises(andoyer.InputError, match=argument) as error:
        fit.brightness(**given)
    assert error.value.argument == argument
