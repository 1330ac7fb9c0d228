"""Inner dissipation: elastic coefficients, power and relaxation times against values of an independent prototype, closed forms, an FFT and an integration without averages.

The figures are those of a prototype in Python: least squares for the displacements, SciPy's elliptic functions and 30 digits of mpmath agree with it to 1e-12 or better.
"""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import andoyer

SHAPES = {"mild": (1.0, 0.7, 0.5), "long": (1.0, 0.4, 0.35), "oblate": (1.0, 0.95, 0.6)}
# w23, w31, w12, then the rows 11, 12, 13, 22, 23, 33 of Q_d, for density and rigidity 1.
ELASTIC = {
    ("mild", 0.25): "0.00897531583354 0.0124448600616 0.0316699206334 "
    "0.0072052990326 -0.00443293886446 0.000812303471363 0.026060649826 0.0211701634107 0.0277553312332",
    ("mild", 0.5): "0.00895261950714 0.0124083584844 0.0316303627244 "
    "0.00434485740496 -0.00877304920184 -0.00423217777107 0.019206654999 0.0131494004681 0.0183258544345",
    ("long", 0.25): "0.000641971700665 0.00143011326947 0.00223437950038 "
    "0.000370176135727 -0.000641491400282 -0.000513054021818 0.0100031977343 0.00962848390397 0.00992146582209",
    ("oblate", 0.5): "0.0344984172297 0.0362111557164 0.107265048868 "
    "0.0246557610667 -0.0263328110899 0.00126912333056 0.030537832198 0.00826687486483 0.0384219544691",
}
# dℓ'/dt, and the power for Q = 1, for Maxwell with a time of 1, for Kelvin–Voigt with a time of 0.1.
POWERS = [
    ("mild", 0.25, "short-axis", 1e-6, 0.441128642082, 4.92096830827e-09, 1.11553952559e-08, 2.16656748887e-10),
    ("mild", 0.25, "short-axis", 0.3, 0.398189759107, 0.00173113841798, 0.00352404751357, 9.50095785567e-05),
    ("mild", 0.25, "short-axis", 0.9, 0.253402270905, 0.00485792487835, 0.0104308132869, 0.000260500773337),
    ("mild", 0.25, "long-axis", 1e-6, 0.912477009973, 1.01892347755e-07, 1.11665654301e-07, 9.22067079692e-09),
    ("mild", 0.25, "long-axis", 0.3, 0.778552417114, 0.0197111482317, 0.0247743925363, 0.00158907111348),
    ("mild", 0.25, "long-axis", 0.9, 0.375784583196, 0.0101650109126, 0.0209810022774, 0.000573834809997),
    ("long", 0.25, "short-axis", 0.9, 0.195667014291, 9.41720810038e-05, 0.000283732856865, 3.83915144353e-06),
    ("long", 0.25, "long-axis", 0.3, 2.58779006052, 0.0175399573007, 0.00676076254334, 0.00426884437657),
    ("oblate", 0.5, "short-axis", 0.3, 0.384587363122, 0.0120782046478, 0.0229510883373, 0.000711547585315),
    ("oblate", 0.5, "long-axis", 0.9, 0.133343024757, 0.0223578827216, 0.102964699115, 0.000600446843985),
]


def kelvin_voigt(time):
    return lambda f: f * time / (1 + (f * time) ** 2)


def dissipation(axes, poisson=0.25, **given):
    loss = given or {"quality": 1.0}
    return andoyer.Dissipation(andoyer.Body.ellipsoid(*axes), axes, andoyer.Material(density=1.0, rigidity=1.0, poisson=poisson, **loss))


def scene(axes, x, mode="short-axis", rate=1.0, complement=None):
    """The state with M/C = rate and sin² x of the largest angle, at that angle."""
    body = andoyer.Body.ellipsoid(*axes)
    small = math.sqrt(1 - x if complement is None else complement)
    g = np.array([0, math.sqrt(x), small] if mode == "short-axis" else [small, math.sqrt(x), 0])
    return andoyer.Scene(body, [0, 0, 0, 1], rate * body.moments.max() * g / body.moments)


@pytest.mark.parametrize(("shape", "poisson"), ELASTIC)
def test_elastic_coefficients_are_those_of_the_table(shape, poisson):
    expected = np.array([float(text) for text in ELASTIC[shape, poisson].split()])
    response = dissipation(SHAPES[shape], poisson).inertia_response
    assert_allclose(np.diag(response)[3:], expected[:3], rtol=1e-11)
    assert_allclose(response[:3, :3][np.triu_indices(3)] / 2, expected[3:], rtol=1e-10)
    assert_allclose(response, response.T, atol=1e-16)
    assert not response[:3, 3:].any() and not response[3:, :3].any()


def test_nearly_spherical_incompressible_body_has_the_coefficient_of_kelvin():
    response = dissipation((1.0, 1.0, 1.0 - 1e-9), 0.5).inertia_response
    assert_allclose(np.diag(response)[3:] * 57 / (4 * math.pi), 1, rtol=1e-8)


@pytest.mark.parametrize("row", POWERS)
def test_powers_are_those_of_the_table(row):
    shape, poisson, mode, x, rate, *expected = row
    axes = SHAPES[shape]
    losses = [{"quality": 1.0}, {"viscosity": 1.0}, {"loss": kelvin_voigt(0.1)}]
    state = scene(axes, x, mode)
    assert_allclose([dissipation(axes, poisson, **loss).power(state) for loss in losses], expected, rtol=1e-11)
    harmonics = dissipation(axes, poisson).harmonics(state.solve())
    assert_allclose([harmonic.frequency for harmonic in harmonics], rate * np.arange(1, len(harmonics) + 1), rtol=1e-11)
    assert_allclose([harmonic.power for harmonic in harmonics], [harmonic.frequency * harmonic.energy for harmonic in harmonics], rtol=1e-14)
    assert_allclose(sum(harmonic.power for harmonic in harmonics), expected[0], rtol=1e-11)


def test_power_has_fifteen_digits():
    """Thirty digits by mpmath, from the formulas of the coefficients on."""
    assert_allclose(dissipation(SHAPES["mild"]).power(scene(SHAPES["mild"], 0.3)), 0.0017311384179836151596, rtol=2e-15)


@pytest.mark.parametrize(("mode", "x", "expected"), [("short-axis", 0.3, 0.00172759905135), ("long-axis", 0.9, 0.0101493755962)])
def test_loss_of_shear_alone_is_that_of_the_table(mode, x, expected):
    state = scene(SHAPES["mild"], x, mode)
    assert_allclose(dissipation(SHAPES["mild"], quality=1.0, shear_only=True).power(state), expected, rtol=1e-11)


@pytest.mark.parametrize(("shape", "limit"), [("mild", 0.0729853604657), ("long", 0.00180502623140)])
@pytest.mark.parametrize("mode", ["short-axis", "long-axis"])
def test_loss_of_a_passage_tends_to_its_limit_from_both_modes(shape, limit, mode):
    """The error falls as 1/K²: K = 27 and 82."""
    errors = []
    for complement in (1e-22, 1e-70):
        made = dissipation(SHAPES[shape])
        state = scene(SHAPES[shape], 1.0, mode, complement=complement)
        rate = made.harmonics(state)[0].frequency
        errors.append(made.power(state) * math.pi / rate / limit - 1)
    assert -1.5e-3 < errors[0] < 0 and -1.6e-4 < errors[1] < 0


@pytest.mark.parametrize("h", [0.3, 0.6, 0.9])
@pytest.mark.parametrize("theta", [1e-3, 0.3, 0.8, 1.3])
def test_symmetric_top_has_its_closed_form(h, theta):
    for poisson in (0.25, 0.5):
        volume, e = 4 * math.pi / 3 * h, 4 / (1 + poisson)
        w13 = 8 * volume / 35 * h**4 / (1 + h * h) ** 2 * (2 + 7 * h * h + e) / (2 + 8 * h * h + e)
        w12 = 2 * volume / 35 * (5 + 4 * h * h + e * h**4) / (6 + 4 * h * h + e * h**4)
        along, across = math.cos(theta), 2 / (1 + h * h) * math.sin(theta)
        precession = along * (1 - h * h) / (1 + h * h)
        state = scene((1.0, 1.0, h), math.sin(theta) ** 2)
        quality = precession * across**2 * (w13 * along**2 + w12 * across**2 / 2)
        maxwell = across**2 * (w13 * along**2 + w12 * across**2 / 4)
        assert_allclose(dissipation((1.0, 1.0, h), poisson).power(state), quality, rtol=3e-14)
        assert_allclose(dissipation((1.0, 1.0, h), poisson, viscosity=1.0).power(state), maxwell, rtol=3e-14)


def random_axes(random):
    return np.sort(random.uniform(0.2, 1.0, 3))[::-1] + np.array([0.1, 0.05, 0.0])


def test_power_of_a_maxwell_body_has_the_closed_form_of_its_variances():
    """Equation (13): mean squares of sn dn, cn dn, sn cn and the variance of sn², by complete elliptic integrals."""
    special = pytest.importorskip("scipy.special")
    random = np.random.default_rng(1)
    for axes in (random_axes(random) for _ in range(20)):
        made = dissipation(axes, viscosity=1.0)
        moments, response = np.sort(made.moments), made.inertia_response
        for mode in ("short-axis", "long-axis"):
            order = [0, 1, 2] if mode == "short-axis" else [2, 1, 0]
            (a, b, c), momentum, x = moments[order], moments[2], random.uniform(0.5, 0.999)
            w23, w31, w12 = np.diag(response)[3:][order]
            ratio = a * (c - b) / (b * (c - a))
            q2 = 1 - x + x * (1 - ratio)
            k2 = x * (1 - ratio) / q2
            if k2 < 0.2:
                continue
            r = momentum**2 * x * np.array([-ratio / a**2, 1 / b**2, -(1 - ratio) / c**2])
            square = response[:3, :3][np.ix_(order, order)] / 2
            e = [
                w23 * (momentum**2 / (b * c)) ** 2 * x * q2,
                w31 * (momentum**2 / (c * a)) ** 2 * x * ratio * q2,
                w12 * (momentum**2 / (a * b)) ** 2 * x * x * ratio,
                r @ square @ r,
            ]
            e2 = (1 - special.ellipe(k2) / special.ellipkm1(1 - k2)) / k2
            e4 = (2 * (1 + k2) * e2 - 1) / (3 * k2)
            variances = [e2 - k2 * e4, 1 - (1 + k2) * e2 + k2 * e4, e2 - e4, e4 - e2**2]
            state = scene(axes, x, mode)
            assert_allclose(made.power(state), np.dot(e, variances), rtol=1e-11)


def test_harmonics_are_those_of_an_fft_of_the_motion():
    """The six products of rates of a solved motion at 512 times of one turn."""
    axes = SHAPES["mild"]
    made = dissipation(axes)
    for mode in ("short-axis", "long-axis"):
        motion = scene(axes, 0.6, mode).solve()
        harmonics = made.harmonics(motion)
        w = motion.angular_velocity(2 * math.pi / harmonics[0].frequency * np.arange(512) / 512).T
        products = np.array([w[0] ** 2, w[1] ** 2, w[2] ** 2, w[1] * w[2], w[2] * w[0], w[0] * w[1]])
        amplitudes = 2 / 512 * np.fft.rfft(products)[:, 1:-1]
        # W = 1/4 sum dI_ij w_i w_j: the squares once, the products twice.
        form = made.inertia_response / 4 * np.array([1, 1, 1, 2, 2, 2])
        peak = np.einsum("in,ij,jn->n", amplitudes.conj(), form, amplitudes).real
        count = len(harmonics)
        assert count < 100
        assert_allclose([harmonic.energy for harmonic in harmonics], peak[:count], rtol=1e-9, atol=1e-16 * peak[0])
        assert_allclose(made.power(motion), np.sum(peak * np.arange(1, 256)) * harmonics[0].frequency, rtol=2e-14)


def test_power_scales_with_momentum_density_size_and_rigidity():
    axes, x = SHAPES["mild"], 0.4
    for loss, power in (({"quality": 3.0}, 5), ({"viscosity": 3.0}, 4), ({"loss": kelvin_voigt(1e-6)}, 6)):
        made = dissipation(axes, **loss)
        assert_allclose(made.power(scene(axes, x, rate=2.0)) / made.power(scene(axes, x)), 2.0**power, rtol=1e-11)
    body = andoyer.Body.ellipsoid(*axes)
    small, large = (
        andoyer.Dissipation(body, radius, andoyer.Material(density=density, rigidity=rigidity, quality=2.0)).power(scene(axes, x))
        for radius, density, rigidity in ((1.0, 1.0, 1.0), (3.0, 5.0, 7.0))
    )
    assert_allclose(large / small, 3.0**7 * 5.0**2 / 7.0, rtol=1e-14)


def test_random_bodies_lose_energy_and_compression_has_a_part_of_it():
    random = np.random.default_rng(2)
    for axes in (random_axes(random) for _ in range(30)):
        poisson = random.uniform(0, 0.5)
        whole, shear = (dissipation(axes, poisson, quality=1.0, shear_only=only) for only in (False, True))
        assert np.linalg.eigvalsh(whole.inertia_response).min() > -1e-15
        for mode in ("short-axis", "long-axis"):
            state = scene(axes, random.uniform(0.01, 0.99), mode)
            assert 0.5 * whole.power(state) < shear.power(state) < whole.power(state)


def test_symmetric_ellipsoid_has_a_response_of_its_symmetry():
    """Q_11 + Q_22 - 2 Q_12 = w12 for R1 = R2, and w23 = w31."""
    for h in (0.1, 0.5, 0.99):
        response = dissipation((1.0, 1.0, h), 0.25).inertia_response
        square = response[:3, :3] / 2
        assert_allclose(square[0, 0] + square[1, 1] - 2 * square[0, 1], response[5, 5], rtol=1e-13)
        assert_allclose([response[3, 3], square[0, 0], square[0, 2]], [response[4, 4], square[1, 1], square[1, 2]], rtol=1e-13)


def test_order_and_tensor_of_the_body_do_not_matter():
    axes = SHAPES["mild"]
    expected = dissipation(axes).power(scene(axes, 0.4))
    moments = andoyer.Body.ellipsoid(*axes).moments
    rates = scene(axes, 0.4).angular_velocity
    material = andoyer.Material(density=1.0, rigidity=1.0, quality=1.0)
    order = [2, 0, 1]
    body = andoyer.Body(1e-7 * moments[order])
    mixed = andoyer.Dissipation(body, np.prod(axes) ** (1 / 3), material)
    assert_allclose(mixed.power(andoyer.Scene(body, [0, 0, 0, 1], rates[order])), expected, rtol=1e-13)
    assert_allclose(mixed.semi_axes, np.array(axes)[order], rtol=1e-14)
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    body = andoyer.Body.from_inertia(turn @ np.diag(moments) @ turn.T)
    tilted = andoyer.Dissipation(body, np.prod(axes) ** (1 / 3), material)
    assert_allclose(tilted.power(andoyer.Scene(body, [0, 0, 0, 1], turn @ rates)), expected, rtol=1e-12)


def test_deformable_body_without_an_average_loses_this_energy():
    """Liouville's equations of a Kelvin–Voigt body, G' = G × w, w = (I + dI)^-1 G, dI + t dI' = equilibrium: first order in the compliance."""
    integrate = pytest.importorskip("scipy.integrate")
    axes, lag, x = SHAPES["mild"], 0.3, 0.3
    errors = []
    for rigidity in (100.0, 400.0):
        body = andoyer.Body.ellipsoid(*axes, mass=4 * math.pi / 3 * np.prod(axes))
        made = andoyer.Dissipation(body, axes, andoyer.Material(density=1.0, rigidity=rigidity, poisson=0.5, loss=kelvin_voigt(lag)))
        response, state = made.inertia_response, scene(axes, x)
        moments, momentum = made.moments, made.moments[2]

        def tensor(d, moments=moments):
            return np.array([[moments[0] + d[0], d[5], d[4]], [d[5], moments[1] + d[1], d[3]], [d[4], d[3], moments[2] + d[2]]])

        def products(w):
            return np.array([w[0] ** 2, w[1] ** 2, w[2] ** 2, w[1] * w[2], w[2] * w[0], w[0] * w[1]])

        def flow(_, y, response=response):
            (x1, x2, x3), (w1, w2, w3) = y[:3], (w := np.linalg.solve(tensor(y[3:]), y[:3]))
            return np.concatenate([[x2 * w3 - x3 * w2, x3 * w1 - x1 * w3, x1 * w2 - x2 * w1], (response @ products(w) - y[3:]) / lag])

        def energy(y, inverse=np.linalg.pinv(response, rcond=1e-10)):
            # W = 1/4 dI:p with the products p that would hold dI in equilibrium.
            held = inverse @ y[3:]
            return 0.5 * y[:3] @ np.linalg.solve(tensor(y[3:]), y[:3]) + 0.25 * (y[3:] * np.array([1, 1, 1, 2, 2, 2])) @ held

        period = 2 * math.pi / made.harmonics(state)[0].frequency
        w = state.angular_velocity
        start = np.concatenate([momentum * np.array([0, math.sqrt(x), math.sqrt(1 - x)]), response @ products(w)])
        turns = np.array([1, 2]) * period
        y = integrate.solve_ivp(flow, (0, turns[1]), start, method="DOP853", rtol=1e-10, atol=1e-12 / rigidity, t_eval=turns).y
        errors.append((energy(y[:, 0]) - energy(y[:, 1])) / (turns[1] - turns[0]) / made.power(state) - 1)
    assert abs(errors[1]) < 1e-2 and 3 < errors[0] / errors[1] < 5, errors
