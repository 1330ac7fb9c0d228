"""Torques whose strength is a function of the distance, against powers, quadratures and closed forms."""

import pickle

import numpy as np
import pytest
from polhodes import MOMENTS, separatrix, state
from scipy.integrate import quad

from andoyer import Body, Error, InputError, Orbit, Scene, TabulatedOrbit, Torque

BODY = Body(MOMENTS)
START = state(2, 1, 0.2 * separatrix(2), np.array([0.3, -0.4, 0.85]))
ORBIT = Orbit(2e-7, 0.641, inclination=0.4, argument_of_pericentre=0.7, semi_major_axis=3.463)


def water(r):
    """Sublimation of water (Marsden, Sekanina and Yeomans 1973, with the constants of JPL's small-body database), r in au."""
    return 0.111262 * (r / 2.808) ** -2.15 * (1 + (r / 2.808) ** 5.093) ** -4.6142


def jet(u):
    return 1e-7 * np.maximum(0, u @ [0.6, 0.0, 0.8])[:, None] * [0.2, 0.3, -0.1]


def even(u):
    """A torque that is the same for all directions."""
    return np.broadcast_to([1e-7, 2e-7, 3e-7], u.shape)


def drift(torque, average="orbit", **options):
    found = Scene(BODY, *START, torques=torque, **options).drift(average=average)
    return np.append(found.momentum, found.excess)


def mean_over_time(law, e, size):
    """⟨law(r)⟩, with dM = (1 − e cos E) dE."""
    return quad(lambda x: law(size * (1 - e * np.cos(x))) * (1 - e * np.cos(x)), 0, np.pi, epsabs=0, epsrel=1e-12, limit=400)[0] / np.pi


@pytest.mark.parametrize("power", [0, 2, 3])
@pytest.mark.parametrize("average", ["orbit", "spin"])
def test_an_inverse_power_is_that_power(power, average):
    law = Torque.sphere(jet, source=ORBIT, at=1.2, law=lambda r: 7.0 * r ** -float(power), degree=4)
    plain = Torque.sphere(jet, source=ORBIT, at=1.2, power=power, degree=4)
    assert law.truncation == pytest.approx(plain.truncation, rel=1e-12)
    expected = drift(plain, average)
    assert np.abs(drift(law, average) - expected).max() < 2e-14 * np.abs(expected).max()


@pytest.mark.parametrize(("e", "size"), [(0.0, 2.0), (0.641, 3.463), (0.967, 17.83)])
def test_the_mean_of_a_law_is_its_quadrature(e, size):
    law = Torque.sphere(even, source=Orbit(2e-7, e, semi_major_axis=size), at=1.0, law=water, degree=1)
    assert law.truncation < 1e-11
    ratio = mean_over_time(water, e, size) / water(1.0)
    expected = ratio * drift(Torque.constant([1e-7, 2e-7, 3e-7]), "spin")
    assert np.abs(drift(law) - expected).max() < 1e-10 * np.abs(expected).max()


def test_the_mean_of_a_jet_is_that_of_its_places():
    found = drift(Torque.sphere(jet, source=ORBIT, at=1.0, law=water))
    alone = Torque.sphere(jet, source=ORBIT, power=0.0)
    eccentric = 2 * np.pi * (np.arange(96) + 0.5) / 96
    epochs = (eccentric - 0.641 * np.sin(eccentric)) / 2e-7
    weights = [(1 - 0.641 * np.cos(x)) * water(3.463 * (1 - 0.641 * np.cos(x))) / water(1.0) / 96 for x in eccentric]
    rates = [weight * drift(alone, "spin", epoch=epoch) for weight, epoch in zip(weights, epochs)]
    expected = np.sum(rates, axis=0)
    assert np.abs(found - expected).max() < 1e-10 * np.abs(expected).max()


def test_a_law_is_integrated():
    # About axis 3 with T₃ = T f(r)/f(1): ω₃ = ω₀ + T/C ∫ f/f(1) dt, dt = (1 − e cos E) dE/n.
    n, e, size = 1e-2, 0.641, 3.463
    orbit = Orbit(n, e, semi_major_axis=size)
    torque = Torque.sphere(lambda u: np.broadcast_to([0, 0, 1e-2], u.shape), source=orbit, at=1.0, law=water, degree=1)
    span = np.pi / n
    motion = Scene(BODY, [0, 0, 0, 1], [0, 0, 1.0], torques=torque, span=(0, span), tolerance=1e-9).solve()
    assert motion.plan.method == "integrated"
    assert motion.plan.error_bound < 1e-9
    gain = 1e-2 / MOMENTS[2] * mean_over_time(water, e, size) / water(1.0) * span
    assert gain > 1e-2
    assert motion.angular_velocity(span)[2] == pytest.approx(1 + gain, rel=0, abs=1e-12)
    # A jet, by a law and by a power.
    both = [Torque.sphere(lambda u: 1e4 * jet(u), source=orbit, at=2.0, degree=4, **fall) for fall in ({"power": 3}, {"law": lambda r: r**-3.0})]
    motions = [Scene(BODY, *START, torques=torque, span=(0, 200), tolerance=1e-10).solve() for torque in both]
    power, law = (motion.attitude(200.0) for motion in motions)
    assert np.abs(power - law).max() < 1e-12


def test_tables_and_hyperbolas_have_laws():
    alone = drift(Torque.constant([1e-7, 2e-7, 3e-7]), "spin")
    times = np.linspace(0, 2 * np.pi / 2e-7, 400)
    gm = ORBIT.mean_motion**2 * ORBIT.semi_major_axis**3
    table = TabulatedOrbit(times, np.array([ORBIT.position(time) for time in times]), gm)
    hyperbola = Orbit.from_state([0, 1.3, 0], [-1.3e-6, 0, 0], 1e-12, 0.0)
    assert hyperbola.eccentricity > 1
    for source, epochs in ((table, [0.0, 1e6, 1.2e7]), (hyperbola, [0.0, 1e6, 1e7])):
        torque = Torque.sphere(even, source=source, at=1.0, law=water, degree=1)
        for epoch in epochs:
            r = np.linalg.norm(source.position(epoch))
            expected = water(r) / water(1.0) * alone
            assert np.abs(drift(torque, "spin", epoch=epoch) - expected).max() < 1e-11 * np.abs(alone).max()


def test_what_a_series_leaves_out_is_said():
    # The third derivative jumps.
    def law(r):
        return 1 / r**2 + 0.1 * np.maximum(0, 1 / r - 0.4) ** 3

    torque = Torque.sphere(even, source=ORBIT, at=1.0, law=law, degree=1)
    assert 1e-11 < torque.truncation < 1e-6
    expected = mean_over_time(law, 0.641, 3.463) / law(1.0) * drift(Torque.constant([1e-7, 2e-7, 3e-7]), "spin")
    assert np.abs(drift(torque) - expected).max() < 10 * torque.truncation * np.abs(expected).max()


def test_a_law_is_called_once_and_kept():
    calls = []

    def law(r):
        calls.append(r)
        return water(r)

    torque = Torque.sphere(jet, source=ORBIT, at=1.0, law=law)
    assert len(calls) == 1
    assert calls[0].ndim == 1
    assert calls[0].min() == 1.0  # `at`, which is nearer than the pericentre
    assert np.sort(calls[0])[1] == pytest.approx(3.463 * 0.359, rel=1e-3)
    assert calls[0].max() == pytest.approx(3.463 * 1.641, rel=1e-3)
    assert repr(torque).startswith("<Torque, polynomials of degree 8, a law of the distance, truncation")
    copy = pickle.loads(pickle.dumps(torque))
    assert copy == torque
    assert hash(copy) == hash(torque)
    assert (drift(copy) == drift(torque)).all()
    assert torque != Torque.sphere(jet, source=ORBIT, at=1.0, power=1)


def test_the_series_reaches_every_place_of_a_table_and_a_coarse_one_is_refused():
    orbit = Orbit(0.05, 0.6, inclination=0.3, semi_major_axis=1.0)

    def torque(rows):
        times = np.linspace(-150, 300, rows)
        return Torque.sphere(strong, source=TabulatedOrbit(times, [orbit.position(t) for t in times], 0.05**2), at=0.4, law=lambda r: r**-4.0, degree=1)

    def strong(u):
        return 1e5 * even(u)

    scene = Scene(BODY, [0, 0, 0, 1], [10, 20, 100], torques=torque(900), span=(-60, 60))
    momenta = scene.evolve(average="spin", tolerance=1e-9).at(np.linspace(-60, 60, 41)).momentum
    exact = Scene(BODY, [0, 0, 0, 1], [10, 20, 100], torques=Torque.sphere(strong, source=orbit, at=0.4, power=4, degree=1), span=(-60, 60))
    expected = exact.evolve(average="spin", tolerance=1e-9).at(np.linspace(-60, 60, 41)).momentum
    assert np.abs(momenta - expected).max() < 1e-3 * np.abs(expected - expected[20]).max()
    coarse = Scene(BODY, [0, 0, 0, 1], [10, 20, 100], torques=torque(12), span=(-60, 60))
    for call in (lambda: coarse.evolve(average="spin"), lambda: coarse.drift(average="spin"), coarse.solve):
        with pytest.raises(Error, match="leaves the distance unknown"):
            call()


def test_a_scene_file_has_the_series(tmp_path):
    scene = Scene(BODY, *START, torques=Torque.sphere(jet, source=ORBIT, at=1.0, law=water))
    file = tmp_path / "comet.toml"
    file.write_text(scene.to_toml(), encoding="utf-8")
    assert "[torque.source.law]" in scene.to_toml()
    assert Scene.from_toml(file) == scene
    text = scene.to_toml()
    for good, bad in (("power = 1.0", "power = 2.0"), ("coefficients = [", "coefficients = [nan, "), ("eccentricity = 0.641", "eccentricity = 0.7")):
        assert good in text
        file.write_text(text.replace(good, bad), encoding="utf-8")
        with pytest.raises(Error, match="law"):
            Scene.from_toml(file)


def broken(r):
    raise ZeroDivisionError("the law itself")


@pytest.mark.parametrize(
    ("law", "said"),
    [
        (lambda r: np.where(r > 2, np.nan, r), r"law = NaN: it must be finite and at least 0"),
        (lambda r: 2 - r, r"law = -.*at least 0"),
        (lambda r: np.where(r == 1.0, 0.0, r), r"above 0 at the distance of the torque"),
        (lambda r: np.where(r > 2, 1.0, 2.0), r"leaves out .*smooth"),
        (lambda r: r[:3], r"law"),
        (lambda r: np.full(r.shape, np.inf), r"law = inf"),
    ],
)
def test_bad_values_of_a_law_are_refused(law, said):
    with pytest.raises(InputError, match=said) as refused:
        Torque.sphere(jet, source=ORBIT, at=1.0, law=law)
    assert refused.value.argument == "law"


def test_bad_laws_are_refused():
    with pytest.raises(ZeroDivisionError, match="the law itself"):
        Torque.sphere(jet, source=ORBIT, at=1.0, law=broken)
    with pytest.raises(TypeError, match="callable of distances"):
        Torque.sphere(jet, source=ORBIT, at=1.0, law=2.0)
    with pytest.raises(InputError, match="absent beside a law"):
        Torque.sphere(jet, source=ORBIT, at=1.0, law=water, power=2)
    with pytest.raises(InputError, match="the source has no distance"):
        Torque.sphere(jet, source=[1, 0, 0], law=water)
    for at in (None, 0.0, -1.0, np.nan, np.inf):
        with pytest.raises(InputError):
            Torque.sphere(jet, source=ORBIT, at=at, law=water)
