"""Periods, energies, momenta, Andoyer variables, rotations and derivatives of ensembles: the bits of the members' own motions."""

import numpy as np
import pytest
from test_ensemble import MEMBERS, random_members, single

import andoyer
from andoyer import Ensemble, Motion, Orbit, Partials

TIMES = [-10.0, 0.0, 3.5, 1e6]
CONVENTIONS = ["long-axis", "short-axis", "extremal-axis"]


@pytest.fixture(scope="module")
def members():
    return random_members()


@pytest.mark.parametrize("threads", [None, 1, 3])
def test_values_are_those_of_single_motions_for_any_number_of_threads(members, threads):
    ensemble = Ensemble(*members, threads=threads)
    momenta, variables = ensemble.angular_momentum(TIMES), ensemble.andoyer(TIMES)
    partials, periods, ratios = ensemble.partials(TIMES), ensemble.periods, ensemble.energy_ratio
    assert momenta.shape == (MEMBERS, 4, 3) and variables.shape == (MEMBERS, 4, 6) and ratios.shape == (MEMBERS,)
    assert partials.attitude.shape == partials.angular_velocity.shape == (MEMBERS, 4, 3, 9)
    assert list(periods) == CONVENTIONS and periods["long-axis"].rotation.shape == (MEMBERS,)
    for k in range(MEMBERS):
        motion = single(members, k)
        assert np.array_equal(momenta[k], motion.angular_momentum(TIMES)) and np.array_equal(variables[k], motion.andoyer(TIMES))
        alone = motion.partials(TIMES)
        assert np.array_equal(partials.attitude[k], alone.attitude) and np.array_equal(partials.angular_velocity[k], alone.angular_velocity)
        assert ratios[k] == motion.energy_ratio
        for convention in CONVENTIONS:
            assert motion.periods[convention] == (periods[convention].precession[k], periods[convention].rotation[k])


def test_members_may_have_their_own_times_and_epochs(members):
    epochs = np.linspace(-5, 5, MEMBERS)
    ensemble = Ensemble(*members, epochs=epochs)
    times = np.linspace(-100, 100, 3 * MEMBERS).reshape(MEMBERS, 3)
    partials, momenta, variables = ensemble.partials(times), ensemble.angular_momentum(times), ensemble.andoyer(times)
    assert np.array_equal(partials.times, times)
    for k in range(0, MEMBERS, 9):
        motion = single(members, k, epoch=epochs[k])
        assert np.array_equal(partials.attitude[k], motion.partials(times[k]).attitude)
        assert np.array_equal(momenta[k], motion.angular_momentum(times[k])) and np.array_equal(variables[k], motion.andoyer(times[k]))


def test_members_under_an_orbit_have_their_momenta_and_derivatives():
    orbit = Orbit(2e-3, 0.1)
    moments, level, rates = [1, 1.02, 1.05], [0, 0, 0, 1], np.array([[0.01, 0, 1], [0, 0.02, 1]])
    options = {"tolerance": 1e-6, "span": (0, 1e4)}
    ensemble = Ensemble(moments, level, rates, orbits=orbit, **options)
    for k in range(2):
        motion = andoyer.Scene(andoyer.Body(moments), level, rates[k], orbit=orbit, **options).solve()
        assert np.array_equal(ensemble.angular_momentum([0, 1e3])[k], motion.angular_momentum([0, 1e3]))
        assert np.array_equal(ensemble.partials([0, 1e3]).attitude[k], motion.partials([0, 1e3]).attitude)
    assert np.ptp(ensemble.angular_momentum([0, 1e3])[0], axis=0).max() > 1e-6


def test_scalar_times_have_no_axis_and_partials_say_of_what_they_are(members):
    ensemble = Ensemble(*members)
    partials = ensemble.partials(3.5)
    assert partials.attitude.shape == (MEMBERS, 3, 9) and partials.times.shape == () and len(partials) == MEMBERS
    assert repr(partials) == f"<Partials of {MEMBERS} members at a scalar time>"
    assert repr(ensemble.partials(TIMES)) == f"<Partials of {MEMBERS} members at 4 times>"
    assert repr(ensemble.partials(np.zeros((MEMBERS, 2)))) == f"<Partials of {MEMBERS} members at 2 times each>"
    assert isinstance(partials, Partials) and len(ensemble[0].partials(TIMES)) == 4
    assert ensemble.angular_momentum(0.0).shape == (MEMBERS, 3) and ensemble.andoyer(0.0).shape == (MEMBERS, 6)


def test_rotations_are_those_of_the_attitudes(members):
    pytest.importorskip("scipy")
    ensemble = Ensemble(*members)
    assert np.allclose(ensemble.rotation(3.5).as_matrix(), [motion.rotation(3.5).as_matrix() for motion in ensemble], atol=1e-15)
    many = ensemble.rotation(TIMES)
    assert many.shape == (MEMBERS, 4) and np.allclose(many.as_quat(), ensemble.attitude(TIMES), atol=1e-15)


def test_members_without_a_motion_are_nan(members):
    moments = members[0].copy()
    moments[7] = [1, 1, 2.5]
    ensemble = Ensemble(moments, *members[1:], errors="nan")
    for values in (
        ensemble.periods["long-axis"].precession,
        ensemble.energy_ratio,
        ensemble.angular_momentum(TIMES),
        ensemble.andoyer(TIMES),
        ensemble.partials(TIMES).attitude,
    ):
        assert np.isnan(values[7]).all() and np.isfinite(values[:7]).all() and np.isfinite(values[8:]).all()


def test_errors_name_the_first_bad_member():
    # 2TB = M² without rounding for the moments 3, 4, 6 and the rates 2, 0, 1.
    ensemble = Ensemble([3, 4, 6], [0, 0, 0, 1], [[0.1, 0.2, 1.0], [2.0, 0.0, 1.0]], tolerance=1e-3, span=(0, 10))
    assert ensemble.plans[1].mode == "separatrix"
    with pytest.raises(andoyer.TheoryError, match="member 1") as error:
        ensemble.partials(1.0)
    assert error.value.index == 1
    with pytest.raises(andoyer.RepresentationError, match="member 0"):
        ensemble.andoyer([0.0, 1e300])


def test_iteration_gives_motions(members):
    ensemble = Ensemble(*members)[:3]
    assert [type(motion) for motion in ensemble] == [Motion] * 3
    assert [motion.energy_ratio for motion in ensemble] == ensemble.energy_ratio.tolist()


SERVED = {
    "integrated": {"method": "integrated", "orbits": andoyer.Orbit(2e-3, 0.1), "span": (0.0, 50.0), "tolerance": 1e-9},
    "averaged": {"orbits": andoyer.Orbit(2e-3, 0.1), "tolerance": 1.0},
    "free": {},
}


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
@pytest.mark.parametrize("options", SERVED.values(), ids=SERVED)
@pytest.mark.parametrize("own", [False, True], ids=["shared times", "own times"])
def test_time_that_a_motion_does_not_serve_is_nan_alone(options, own):
    """With errors="nan" one such time made all rows of the ensemble NaN."""
    members = ([1.0, 1.02, 1.05], [0, 0, 0, 1], [[0, 0.01, 1.0], [0.02, 0.01, 0.9]])
    ensemble = Ensemble(*members, errors="nan", **options)
    times = np.linspace(0.0, 40.0, 9)
    good = np.stack([times, times + 1.0]) if own else times
    bad = np.array(good)
    bad[..., 3] = 1e300
    bad[(0, 7) if own else 7] = -1e300
    lost = np.broadcast_to(np.abs(bad) > 1e200, (2, 9))
    samples, expected = ensemble.at(bad), ensemble.at(good)
    for found, right in ((samples.attitude, expected.attitude), (samples.angular_velocity, expected.angular_velocity)):
        assert np.isnan(found[lost]).all() and np.abs(found[~lost] - right[~lost]).max() < 1e-12
    assert np.array_equal(np.isnan(ensemble.angular_momentum(bad)).all(axis=-1), lost)
    assert np.array_equal(np.isnan(ensemble.partials(bad).attitude).all(axis=(-1, -2)), lost)
    assert list(samples.errors) == [0, 1] and not expected.errors
    assert "1e300" in str(samples.errors[1])


def test_progress_counts_the_members_to_the_last_and_may_stop_the_evaluation():
    ensemble = andoyer.Ensemble(
        [1, 1.02, 1.05], [0, 0, 0, 1], np.linspace(1.0, 1.1, 40)[:, None] * [0, 0.01, 1], orbits=andoyer.Orbit(2e-3), method="integrated", span=(0, 1e3)
    )
    told = []
    samples = ensemble.at([0.0, 1e3], progress=lambda done, of: told.append((done, of)))
    assert told[-1] == (40, 40) and told == sorted(set(told))
    assert np.array_equal(samples.attitude, ensemble.at([0.0, 1e3]).attitude)

    def stop(done, of):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ensemble.at([0.0], progress=stop)
    with pytest.raises(TypeError, match="callable"):
        ensemble.at([0.0], progress=3)
