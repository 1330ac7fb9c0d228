"""Ensembles: members under a torque are solved once, with the bits of their scenes; members by inertia tensors."""

import pickle

import numpy as np
import pytest

import andoyer
from andoyer import Body, Ensemble, Scene

LEVEL = [0.0, 0.0, 0.0, 1.0]
SUN = andoyer.Orbit(2e-3, 0.1)
SPAN = (0, 1e3)
# By theory, by integration (about the middle axis), by theory, and by integration (from rest).
RATES = [[0, 0.01, 1], [0, 1, 0.001], [0, 0.02, 1.1], [0, 0, 0]]
TIMES = [0.0, 500.0, 1000.0]


def apart(one, other):
    """Largest angle between attitudes with the same sign."""
    return 2 * np.linalg.norm(np.subtract(one, other), axis=-1).max()


def test_a_second_call_has_the_bits_of_the_first_and_of_the_scene():
    ensemble = Ensemble([1, 1.02, 1.05], LEVEL, RATES, orbits=SUN, span=SPAN, tolerance=1e-6)
    motions = [Scene(Body([1, 1.02, 1.05]), LEVEL, rates, orbit=SUN, span=SPAN, tolerance=1e-6).solve() for rates in RATES]
    assert [motion.plan.method for motion in motions] == ["closed", "integrated", "closed", "integrated"]
    first, plans = ensemble.attitude(TIMES), ensemble.plans
    for _ in range(2):
        assert np.array_equal(ensemble.attitude(TIMES), first) and ensemble.plans == plans and ensemble.errors == {}
        for index, motion in enumerate(motions):
            assert np.array_equal(first[index], motion.attitude(TIMES)) and ensemble.plans[index] == motion.plan
            assert np.array_equal(ensemble.at(TIMES).angular_velocity[index], motion.angular_velocity(TIMES))
        assert np.array_equal(ensemble[1].attitude(TIMES), first[1])
        assert np.array_equal(ensemble[1:].attitude(TIMES), first[1:])
    again = pickle.loads(pickle.dumps(ensemble))
    assert again == ensemble and np.array_equal(again.attitude(TIMES), first)


def test_a_refused_member_is_refused_each_time():
    ensemble = Ensemble([1, 1.02, 1.05], LEVEL, RATES[:2], orbits=SUN, tolerance=1.0, errors="nan")  # nothing is integrated without a span
    texts = {str(ensemble.errors[1]) for _ in range(2)} | {str(ensemble.at(0.0).errors[1])}
    assert len(texts) == 1 and texts.pop().startswith("member 1: ")
    assert np.isnan(ensemble.attitude(0.0)).all(axis=1).tolist() == [False, True]


def tensors(number):
    """Tensors of bodies about axes that are not principal ones."""
    generator = np.random.default_rng(31)
    axes = np.linalg.qr(generator.normal(size=(number, 3, 3)))[0]
    return np.einsum("kij,kj,klj->kil", axes, np.sort(generator.uniform(0.6, 1.0, (number, 3))), axes)


def symmetric(number):
    return 0.5 * (tensors(number) + tensors(number).transpose(0, 2, 1))


@pytest.mark.parametrize("orbits", [None, SUN])
@pytest.mark.parametrize("number", [1, 3, 40])
def test_members_by_tensors_are_their_scenes(number, orbits):
    given, generator = symmetric(number), np.random.default_rng(1)
    spins = generator.normal(size=(number, 3))
    ensemble = Ensemble(given, LEVEL, spins, orbits=orbits, span=(0, 30), tolerance=1e-6)
    bodies = [Body.from_inertia(tensor) for tensor in given]
    motions = [Scene(body, LEVEL, rate, orbit=orbits, span=(0, 30), tolerance=1e-6).solve() for body, rate in zip(bodies, spins, strict=True)]
    samples = ensemble.at([0.0, 30.0])
    for index, motion in enumerate(motions):
        assert np.array_equal(samples.attitude[index], motion.attitude([0.0, 30.0]))
        assert np.array_equal(samples.angular_velocity[index], motion.angular_velocity([0.0, 30.0]))
    assert np.array_equal(ensemble.inertia, given) and np.array_equal(ensemble.moments, [body.moments for body in bodies])
    assert not ensemble.inertia.flags.writeable
    again = pickle.loads(pickle.dumps(ensemble))
    assert again == ensemble == ensemble[:] and again != Ensemble(ensemble.moments, LEVEL, spins, orbits=orbits, span=(0, 30), tolerance=1e-6)
    assert np.array_equal(again[::-1].attitude(30.0), ensemble.attitude(30.0)[::-1])
    assert ensemble[number - 1].scene == motions[-1].scene


def test_three_rows_of_three_numbers_are_the_moments_of_three_members():
    moments = [[0.5, 0.7, 0.9], [0.6, 0.7, 0.9], [0.7, 0.7, 0.9]]
    ensemble = Ensemble(moments, LEVEL, [0.1, 0.2, 1])
    assert len(ensemble) == 3 and np.array_equal(ensemble.moments, moments)
    assert np.array_equal(ensemble.inertia, [np.diag(row) for row in moments])


def test_one_tensor_for_other_members_is_refused_with_the_shape_of_tensors():
    tensor = symmetric(1)[0]
    message = r"^moments has shape \(3, 3\), the principal moments of 3 members, but there are 5 members: .* Body\.from_inertia, have the shape \(m, 3, 3\)$"
    with pytest.raises(andoyer.InputError, match=message) as caught:
        Ensemble(tensor, [LEVEL] * 5, [0.1, 0.2, 1])
    assert caught.value.argument == "moments" and caught.value.value == (3, 3)
    assert len(Ensemble(np.broadcast_to(tensor, (5, 3, 3)), [LEVEL] * 5, [0.1, 0.2, 1])) == 5


@pytest.mark.parametrize("shape", [(6,), (2, 2), (4, 4), (2, 3, 2), (1, 2, 3, 3)])
def test_another_shape_is_refused_with_all_that_fit(shape):
    with pytest.raises(andoyer.InputError, match=r"or \(m, 3, 3\) for tensors as of Body\.from_inertia$"):
        Ensemble(np.ones(shape), LEVEL, [[0.1, 0.2, 1]])


def test_a_bad_tensor_is_named_or_nan():
    given = symmetric(3)
    given[1, 0, 1] += 0.1
    with pytest.raises(andoyer.InputError, match=r"^member 1: .*(0, 1|\[0\]\[1\])") as caught:
        Ensemble(given, LEVEL, [[0.1, 0.2, 1]] * 3)
    assert caught.value.index == 1
    ensemble = Ensemble(given, LEVEL, [[0.1, 0.2, 1]] * 3, errors="nan")
    assert np.isnan(ensemble.attitude(1.0)).any(axis=1).tolist() == np.isnan(ensemble.moments).any(axis=1).tolist() == [False, True, False]
    assert list(ensemble.errors) == [1]


def test_the_method_is_that_of_all_members():
    ensemble = Ensemble([1, 1.02, 1.05], LEVEL, RATES, orbits=[SUN, None, SUN, SUN], span=SPAN, tolerance=1e-6, method="integrated")
    assert [plan.method for plan in ensemble.plans] == ["integrated"] * 4 and ensemble.method == "integrated"
    assert 'method="integrated"' in repr(ensemble) and "method" not in repr(Ensemble([1, 1.02, 1.05], LEVEL, RATES))
    assert ensemble[1:][0].plan.method == "integrated"
    again = pickle.loads(pickle.dumps(ensemble))
    assert again == ensemble and np.array_equal(again.attitude(TIMES), ensemble.attitude(TIMES))
    assert ensemble != Ensemble([1, 1.02, 1.05], LEVEL, RATES, orbits=[SUN, None, SUN, SUN], span=SPAN, tolerance=1e-6)
    for rates, attitude in zip(RATES, ensemble.attitude(TIMES), strict=True):
        free = Scene(Body([1, 1.02, 1.05]), LEVEL, rates, span=SPAN, tolerance=1e-6, method="integrated").solve()
        assert rates != RATES[1] or apart(attitude, free.attitude(TIMES)) < 1e-6
    with pytest.raises(andoyer.InputError, match="method"):
        Ensemble([1, 1.02, 1.05], LEVEL, RATES, method="euler")
    with pytest.raises(andoyer.Error, match="span"):
        _ = Ensemble([1, 1.02, 1.05], LEVEL, RATES, method="integrated").plans
