"""Torques of degree 3 and 4 against the harmonics of bodies of point masses, integrated by SciPy."""

import pickle

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.integrate import solve_ivp

import andoyer

NAMES = [f"{kind}{n}{m}" for n in (2, 3, 4) for m in range(n + 1) for kind in "CS" if kind == "C" or m]


def associated(n, m, z):
    """P_nm(z) without the phase of Condon and Shortley, from derivatives of the Legendre polynomial."""
    return (1 - z * z) ** (m / 2) * legendre.legval(z, legendre.legder(legendre.legmul([1], [0] * n + [1]), m))


def coefficients(masses, places, radius):
    """Unnormalized coefficients of point masses (their definition as integrals over the body)."""
    found = {}
    distance = np.linalg.norm(places, axis=1)
    z, longitude = places[:, 2] / distance, np.arctan2(places[:, 1], places[:, 0])
    for n in (2, 3, 4):
        for m in range(n + 1):
            factor = (1 if m == 0 else 2) * np.prod([1.0 / k for k in range(n - m + 1, n + m + 1)])
            weights = factor * masses / masses.sum() * (distance / radius) ** n * associated(n, m, z)
            found[f"C{n}{m}"] = (weights * np.cos(m * longitude)).sum()
            if m:
                found[f"S{n}{m}"] = (weights * np.sin(m * longitude)).sum()
    return found


def torque_of(degree, masses, places, u, distance, gm):
    """The torque of one degree on point masses, from the expansion of 1/|r − x| in Legendre polynomials."""
    size = np.linalg.norm(places, axis=1)
    cosines = places @ u / size
    slope = legendre.legval(cosines, legendre.legder([0] * degree + [1]))
    # Force on a mass, across its position: gm m size^(n−1) P_n′ u / r^(n+1).
    force = (gm * masses * size ** (degree - 1) * slope / distance ** (degree + 1))[:, None] * u
    return np.cross(places, force).sum(axis=0)


def lump(seed):
    rng = np.random.default_rng(seed)
    places, masses = rng.normal(size=(12, 3)) * [1.3, 1.0, 0.7], rng.uniform(0.5, 2, size=12)
    places -= (masses[:, None] * places).sum(axis=0) / masses.sum()
    tensor = (masses[:, None, None] * ((places**2).sum(axis=1)[:, None, None] * np.eye(3) - places[:, :, None] * places[:, None, :])).sum(axis=0)
    return masses, places, 0.5 * (tensor + tensor.T)


@pytest.mark.parametrize("seed", range(4))
def test_a_body_of_point_masses_moves_as_its_harmonics_say(seed):
    masses, places, tensor = lump(seed)
    radius = 1.7
    field = coefficients(masses, places, radius)
    body = andoyer.Body.from_inertia(
        tensor,
        gravity=andoyer.Gravity(
            {n: c for n, c in field.items() if n[1] != "2"}, radius, inertia_factor=np.linalg.eigvalsh(tensor)[2] / masses.sum() / radius**2
        ),
    )
    semi_major_axis, mean_motion, e = 9.0, 0.05, 0.2
    orbit = andoyer.Orbit(mean_motion, e, semi_major_axis=semi_major_axis, inclination=0.4, node=0.3, argument_of_pericentre=1.0)
    gm = mean_motion**2 * semi_major_axis**3
    start, rates, span = np.array([0.1, -0.3, 0.2, 0.9]), np.array([0.2, -0.1, 0.3]), 60.0
    start /= np.linalg.norm(start)
    inverse = np.linalg.inv(tensor)

    def slope(t, y):
        x, y_, z, w = y[:4]
        q = np.array([[w, -z, y_], [z, w, -x], [-y_, x, w], [-x, -y_, -z]])
        place = orbit.position(t)
        distance = np.linalg.norm(place)
        matrix = andoyer_matrix(y[:4])
        u = matrix.T @ (place / distance)
        torque = sum(torque_of(n, masses, places, u, distance, gm) for n in (2, 3, 4))
        return np.concatenate([0.5 * q @ y[4:], inverse @ (torque - np.cross(y[4:], tensor @ y[4:]))])

    exact = solve_ivp(slope, (0, span), np.concatenate([start, rates]), method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    scene = andoyer.Scene(body, start, rates, orbit=orbit, span=(0, span), tolerance=1e-11)
    motion = scene.solve()
    assert motion.plan.method == "integrated"
    found = motion.attitude(span)
    error = 2 * min(np.linalg.norm(found - s * exact[:4] / np.linalg.norm(exact[:4])) for s in (1, -1))
    assert error < 2e-10
    assert not motion.verify().refuted
    # Without the field the attitude is another one.
    bare = andoyer.Scene(andoyer.Body.from_inertia(tensor), start, rates, orbit=orbit, span=(0, span)).solve().attitude(span)
    assert 2 * min(np.linalg.norm(found - s * bare) for s in (1, -1)) > 1e-4


def andoyer_matrix(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_the_ellipsoid_has_the_coefficients_of_its_quadrature():
    a, b, c, radius = 1.5, 1.2, 0.8, 1.1
    nodes, weights = legendre.leggauss(12)
    z = nodes[:, None]
    longitude = 2 * np.pi * (np.arange(24) + 0.5) / 24
    sphere = np.stack(np.broadcast_arrays(np.sqrt(1 - z * z) * np.cos(longitude), np.sqrt(1 - z * z) * np.sin(longitude), z), axis=-1).reshape(-1, 3)
    # Density 1: dm = abc s² ds dΩ, and a harmonic of degree n has s^(n+2).
    solid = np.repeat(weights, 24) * 2 * np.pi / 24
    found = dict.fromkeys(NAMES, 0.0)
    for n in (2, 4):
        shell = coefficients(solid, sphere * [a, b, c], radius)
        found |= {name: value * 3 / (n + 3) for name, value in shell.items() if name[1] == str(n)}
    for name, value in andoyer.Gravity.ellipsoid(a, b, c, radius=radius).coefficients.items():
        assert value == pytest.approx(found[name], rel=1e-12), name
    body = andoyer.Body(andoyer.Body.ellipsoid(a, b, c).moments, gravity=andoyer.Gravity.ellipsoid(a, b, c))  # no warning
    assert body.gravity.inertia_factor == pytest.approx((a * a + b * b) / 5 / (a * b * c) ** (2 / 3))


def test_coefficients_of_degree_two_are_compared_and_give_the_inertia_factor():
    moments = [1.0, 1.2, 1.5]
    zonal, sectoral = -(1.5 - 1.1) / 4.0, 0.2 / 16.0  # M R² = 4
    body = andoyer.Body(moments, gravity=andoyer.Gravity({"C20": zonal, "C22": sectoral, "C30": 1e-3}, 1.0))
    assert body.gravity.inertia_factor is None
    with pytest.warns(UserWarning, match=r"gravity: C22 = 2.00000e-2, but the moments and the inertia factor give 1.25000e-2"):
        andoyer.Body(moments, gravity=andoyer.Gravity({"C20": zonal, "C22": 0.02}, 1.0))
    with pytest.raises(andoyer.InputError, match="inertia_factor"):
        andoyer.Body(moments, gravity=andoyer.Gravity({"C30": 1e-3}, 1.0))


@pytest.mark.parametrize(
    ("coefficients", "radius", "name"),
    [({"C50": 1.0}, 1.0, "C50"), ({"C30": np.nan}, 1.0, "C30"), ({"C30": 1.0}, 0.0, "radius"), ({"C30": 1.0}, np.inf, "radius")],
)
def test_bad_fields_are_refused(coefficients, radius, name):
    with pytest.raises(andoyer.InputError, match=name):
        andoyer.Gravity(coefficients, radius)


def test_a_sphere_with_a_field_is_verified_and_no_libration():
    field = andoyer.Gravity({"C31": 0.02, "C30": 0.1}, 3.0, inertia_factor=0.4)
    assert field == pickle.loads(pickle.dumps(field)) == andoyer.Gravity({"C30": 0.1, "C31": 0.02}, 3.0, inertia_factor=0.4)
    orbit = andoyer.Orbit(0.02, 0.1, semi_major_axis=10.0, inclination=1.0)
    motion = andoyer.Scene(andoyer.Body([1, 1, 1], gravity=field), [0, 0, 0, 1], [0.3, -0.2, 0.5], orbit=orbit, span=(0, 20), tolerance=1e-11).solve()
    assert not motion.verify().refuted
    with pytest.raises(andoyer.TheoryError, match="gravity field"):
        andoyer.Scene(
            andoyer.Body([1, 1.4, 2], gravity=field),
            [0, 0, 0, 1],
            [0, 0, 1.001],
            orbit=andoyer.Orbit(1.0, semi_major_axis=10.0),
            span=(0, 20),
            method="libration",
        ).solve()


def test_an_orbit_without_a_length_is_refused_and_files_and_pickles_keep_the_field(tmp_path):
    field = andoyer.Gravity({"C30": -8.5e-6, "S31": 4.1e-6}, 1738.0, inertia_factor=0.393)
    body = andoyer.Body([0.99937, 0.9996, 1.0], gravity=field)
    state = ([0, 0, 0, 1], [0, 0, 2.66e-6])
    with pytest.raises(andoyer.InputError, match="semi_major_axis"):
        andoyer.Scene(body, *state, orbit=andoyer.Orbit(2.66e-6, 0.05), span=(0, 1e6)).solve()
    scene = andoyer.Scene(body, *state, orbit=andoyer.Orbit(2.66e-6, 0.05, semi_major_axis=384400.0), span=(0, 1e6), tolerance=1e-9)
    (tmp_path / "moon.toml").write_text(scene.to_toml())
    assert andoyer.Scene.from_toml(tmp_path / "moon.toml") == scene == pickle.loads(pickle.dumps(scene))
    assert eval(repr(body), {"Body": andoyer.Body, "Gravity": andoyer.Gravity}) == body
    members = andoyer.Ensemble.from_scenes([scene, scene])
    assert np.array_equal(members.at([1e6]).attitude[1], scene.solve().at([1e6]).attitude)


def test_a_field_of_zeros_is_none():
    body = andoyer.Body([0.4, 0.41, 0.42], gravity=andoyer.Gravity({"C30": 0.0, "C44": 0.0}, 1.0, inertia_factor=0.4))
    scene = andoyer.Scene(body, [0, 0, 0, 1], [0.0, 0.01, 1.0], orbit=andoyer.Orbit(2e-3, 0.1), tolerance=1e-6, span=(0, 1e3))
    alone = andoyer.Scene(andoyer.Body([0.4, 0.41, 0.42]), [0, 0, 0, 1], [0.0, 0.01, 1.0], orbit=andoyer.Orbit(2e-3, 0.1), tolerance=1e-6, span=(0, 1e3))
    assert scene.solve().plan.method == alone.solve().plan.method == "closed"
    assert (scene.solve().attitude(500.0) == alone.solve().attitude(500.0)).all()
