"""Torques of shapes: light on facets and plates, tables on the sphere, against sums over the facets in NumPy."""

import copy
import pickle

import numpy as np
import pytest

from andoyer import Body, FileError, InputError, Orbit, Scene, Torque

P = 4.56e-6


def sphere_of(n):
    """Unit vectors spread evenly, by the golden angle."""
    k = np.arange(n) + 0.5
    z, angle = 1 - 2 * k / n, np.pi * (1 + 5**0.5) * k
    return np.column_stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z])


def facet_torque(u, normals, areas, centroids, specular, diffuse, emission=1.0):
    """Sum over facets of x × F, F = −P A μ ((1−ρs) u + (2 ρs μ + ⅔(ρd + ε ρa)) n)."""
    mu = np.maximum(0, u @ normals.T)[:, :, None]
    lambert = 2 / 3 * (diffuse + emission * (1 - specular - diffuse))
    force = -P * areas[:, None] * mu * ((1 - specular) * u[:, None] + (2 * specular * mu + lambert) * normals)
    return np.cross(centroids, force).sum(axis=1)


def polyhedron():
    """A tetrahedron and its facets; no symmetry."""
    corners = np.array([[1.2, 1, 1], [1, -1.1, -1], [-1, 1, -1.3], [-1, -0.8, 1.5]])
    corners -= corners.mean(axis=0)
    sides = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    a, b, c = (corners[sides[:, i]] for i in range(3))
    doubled = np.cross(b - a, c - a)
    areas = np.linalg.norm(doubled, axis=1) / 2
    return corners, sides, doubled / 2 / areas[:, None], areas, (a + b + c) / 3


def test_polynomials_are_the_torque_but_for_the_truncation():
    corners, sides, normals, areas, centroids = polyhedron()
    u = sphere_of(4000)
    truth = facet_torque(u, normals, areas, centroids, 0.3, 0.2, 0.5)
    size, left = np.sqrt((truth**2).sum(axis=1).mean()), []
    for degree in (2, 4, 6, 8):
        torque = Torque.from_facets(corners, sides, specular=0.3, diffuse=0.2, emission=0.5, pressure=P, source=[1, 0, 0], degree=degree)
        assert torque.degree == degree
        difference = np.sqrt(((torque.value(u) - truth) ** 2).sum(axis=1).mean())
        assert difference == pytest.approx(torque.truncation * size, rel=0.02)
        left.append(torque.truncation)
    assert left == sorted(left, reverse=True)
    assert left[-1] < 0.1


def test_absorbed_light_on_a_closed_body_has_only_odd_degrees():
    corners, sides, *_ = polyhedron()
    u = sphere_of(50)
    absorbed = Torque.from_facets(corners, sides, emission=0, pressure=P, source=[1, 0, 0])
    assert np.abs(absorbed.value(u) + absorbed.value(-u)).max() < 1e-13 * np.abs(absorbed.value(u)).max()
    scattered = Torque.from_facets(corners, sides, pressure=P, source=[1, 0, 0])
    assert np.abs(scattered.value(u) + scattered.value(-u)).max() > 1e-3 * np.abs(scattered.value(u)).max()


def test_a_cube_and_a_plate_at_its_centre_have_no_torque():
    normals = np.vstack([np.eye(3), -np.eye(3)])
    cube = Torque.panels(normals, np.ones(6), normals / 2, specular=0.3, diffuse=0.1, pressure=P, source=[1, 0, 0])
    plate = Torque.panels([[0, 0, 1]], [2.0], [[0, 0, 0]], specular=0.3, pressure=P, source=[1, 0, 0])
    for torque in (cube, plate):
        assert np.abs(torque.value(sphere_of(50))).max() < 1e-13 * P
        assert torque.truncation == 0


def test_two_sides_are_two_plates():
    u = sphere_of(50)
    plate = ([[0.3, 0, 1]], [2.0], [[0.5, 0.2, 0]])
    both = Torque.panels(*plate, two_sided=True, specular=0.2, pressure=P, source=[1, 0, 0])
    sides = Torque.panels([[0.3, 0, 1], [-0.3, 0, -1]], [2.0] * 2, [[0.5, 0.2, 0]] * 2, specular=[0.2, 0.2], pressure=P, source=[1, 0, 0])
    assert np.allclose(both.value(u), sides.value(u), rtol=0, atol=1e-16)


def test_a_table_and_harmonics_are_the_same_torque():
    inertia = np.array([1.0, 2.0, 3.0])
    table = Torque.sphere(lambda u: np.cross(u, u * inertia), source=[1, 0, 0], degree=2)
    assert table.truncation < 1e-14
    # u1 u2, u2 u3, u1 u3 are the harmonics (2, −2), (2, −1), (2, 1) over √(15/4π).
    coefficients = np.zeros((3, 9))
    scale = np.sqrt(4 * np.pi / 15)
    coefficients[0, 5], coefficients[1, 7], coefficients[2, 4] = scale, -2 * scale, scale
    harmonics = Torque.sphere(coefficients, source=[1, 0, 0], degree=2)
    u = sphere_of(50)
    expected = np.cross(u, u * inertia)
    assert np.abs(table.value(u) - expected).max() < 1e-14
    assert np.abs(harmonics.value(u) - expected).max() < 1e-14


def test_the_integration_takes_it_with_its_distance():
    corners, sides, *_ = polyhedron()
    body = Body([1.0, 1.5, 2.0])
    rates, final = [0.1, 0.2, 1.0], []
    for source, keywords in (([1, 0, 0], {}), (Orbit(1e-9, semi_major_axis=2.0), {"at": 4.0})):
        torque = Torque.from_facets(corners, sides, pressure=1e-6, source=source, degree=4, **keywords)
        scene = Scene(body, [0, 0, 0, 1], rates, torques=[torque], span=(0, 10), tolerance=1e-13)
        final.append(scene.solve().angular_momentum(10.0) - scene.solve().angular_momentum(0.0))
    assert np.allclose(final[1], 4 * final[0], rtol=1e-4)  # (at/r)² = 4, and second order in the torque
    assert np.linalg.norm(final[0]) > 1e-7


def test_obj_files(tmp_path):
    corners, sides, *_ = polyhedron()
    path = tmp_path / "body.obj"
    lines = [
        "# a body",
        *(f"v {x!r} {y!r} {z!r}" for x, y, z in (corners / 1000).tolist()),
        "vn 0 0 1",
        *(f"f {a + 1}//1 {b + 1} {c - 4}" for a, b, c in sides.tolist()),
    ]
    path.write_text("\n".join(lines))
    read = Torque.from_facets(path, pressure=P, source=[1, 0, 0], scale=1000)
    given = Torque.from_facets(corners, sides, pressure=P, source=[1, 0, 0])
    u = sphere_of(20)
    assert np.allclose(read.value(u), given.value(u), rtol=1e-12, atol=0)
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4")
    with pytest.raises(FileError, match="line 4: 4 is no vertex"):
        Torque.from_facets(str(path), pressure=P, source=[1, 0, 0])
    with pytest.raises(FileError, match=r"absent\.obj"):
        Torque.from_facets(tmp_path / "absent.obj", pressure=P, source=[1, 0, 0])


def test_it_is_a_value(tmp_path):
    corners, sides, *_ = polyhedron()
    torque = Torque.from_facets(corners, sides, pressure=P, source=Orbit(2e-7, 0.1), at=0.9)
    again = pickle.loads(pickle.dumps(torque))
    assert again == torque
    assert hash(again) == hash(torque)
    assert again.truncation == torque.truncation > 0
    assert copy.copy(torque) is torque
    assert repr(torque).startswith("<Torque, polynomials of degree 8, truncation")
    scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 1], torques=[torque], span=(0, 1))
    path = tmp_path / "scene.toml"
    path.write_text(scene.to_toml())
    assert Scene.from_toml(path) == scene


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"specular": 1.2}, "specular = 1.2"),
        ({"specular": 0.7, "diffuse": 0.5}, "specular \\+ diffuse = 1.2"),
        ({"pressure": 0.0}, "pressure = 0"),
        ({"degree": 9}, "degree = 9"),
        ({"degree": 0}, "degree = 0"),
        ({"at": 1.0}, "a direction, which has no distance"),
        ({"source": Orbit(1e-7, semi_major_axis=1.5e11)}, "reference_distances"),
        ({"source": [0, 0, 0]}, "a finite vector other than 0"),
    ],
)
def test_bad_light_is_refused(change, match):
    corners, sides, *_ = polyhedron()
    keywords = {"pressure": P, "source": [1, 0, 0], **change}
    with pytest.raises(InputError, match=match):
        Torque.from_facets(corners, sides, **keywords)


def test_bad_shapes_are_refused():
    corners, sides, *_ = polyhedron()
    keywords = {"pressure": P, "source": [1, 0, 0]}
    with pytest.raises(InputError, match="counter-clockwise"):
        Torque.from_facets(corners, sides[:, ::-1], **keywords)
    with pytest.raises(InputError, match="below the number of vertices, 4"):
        Torque.from_facets(corners, [[0, 1, 4]], **keywords)
    with pytest.raises(InputError, match="whole numbers"):
        Torque.from_facets(corners, [[0, 1, 2.5]], **keywords)
    with pytest.raises(InputError, match="at least one facet"):
        Torque.panels(np.zeros((0, 3)), [], np.zeros((0, 3)), **keywords)
    with pytest.raises(InputError, match="normals"):
        Torque.panels([[0, 0, 0]], [1.0], [[1, 0, 0]], **keywords)
    with pytest.raises(InputError, match="finite at every direction"):
        Torque.sphere(lambda u: u * np.nan, source=[1, 0, 0])
    with pytest.raises(TypeError, match="OBJ file"):
        Torque.from_facets(3.0, **keywords)
    with pytest.raises(InputError, match="one source"):
        Torque.polynomial(["w1", "0", "0"]).value([1, 0, 0])
