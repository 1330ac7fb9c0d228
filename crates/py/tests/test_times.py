"""Calendar times: differences from the epoch in two doubles, durations, lists; what has no scale or a mask is refused."""

import copy
import datetime
import pickle

import numpy as np
import pytest

import andoyer

units = pytest.importorskip("astropy.units")
from astropy.time import Time, TimeDelta  # noqa: E402

QUATERNION = [0.1, -0.2, 0.3, 0.9273618495495703]
RATES = [0.1, 0.2, 1.0]
MOMENTS = [[1.0, 1.5, 2.0], [1.0, 2.0, 2.5]]
EPOCH = Time("2026-03-01T00:00:00", scale="tdb")


@pytest.fixture(scope="module")
def dated(body):
    return andoyer.Scene(body, QUATERNION, RATES, epoch=EPOCH).solve()


@pytest.fixture(scope="module")
def free(body):
    return andoyer.Scene(body, QUATERNION, RATES).solve()


def test_differences_from_the_epoch_keep_their_digits(dated, free):
    # A double holds seconds since J2000 to 1e-7 s alone, where the attitude would be off by 1e-7 rad.
    seconds = np.array([1e-9, 1e-3, 0.123456789, 1.0, 12345.678901234])
    samples = dated.at(EPOCH + TimeDelta(seconds, format="sec"))
    assert np.abs(samples.attitude - free.attitude(seconds)).max() < 1e-11  # a day in a double is good to 2e-11 s
    assert np.abs(dated.attitude(EPOCH) - QUATERNION).max() < 1e-15


def test_state_of_a_calendar_epoch_is_that_of_its_number_too(dated):
    assert dated.scene.epoch == pytest.approx((EPOCH.tdb - Time("J2000", scale="tdb")).sec, abs=1e-6)
    assert np.abs(dated.attitude(dated.scene.epoch) - QUATERNION).max() < 1e-15


@pytest.mark.parametrize("scale", [None, "tdb"])
def test_duration_is_a_duration_from_the_epoch(dated, free, scale):
    duration = TimeDelta([0.0, 10.0, 1e5], format="sec", scale=scale)
    for motion in (dated, free):
        assert np.abs(motion.attitude(duration) - free.attitude([0.0, 10.0, 1e5])).max() < 1e-10
    assert andoyer.Scene(free.scene.body, QUATERNION, RATES, epoch=duration[1]).epoch == 10.0
    late = andoyer.Scene(free.scene.body, QUATERNION, RATES, epoch=50.0).solve()
    assert np.array_equal(late.attitude(duration[1]), late.attitude(60.0))


def test_samples_give_the_times_back_that_they_were_asked_for(dated):
    for times in (EPOCH + [0, 1, 2] * units.s, EPOCH, TimeDelta([1, 2] * units.s)):
        samples = dated.at(times)
        assert type(samples.times) is type(times) and samples.times.shape == times.shape and np.all(samples.times == times)
        again = pickle.loads(pickle.dumps(samples))
        assert np.all(again.times == times) and np.array_equal(again.attitude, samples.attitude)
    assert repr(dated.at(EPOCH)) == "<Samples at a scalar time>"


def test_lists_of_times_and_quantities_are_arrays_of_them(dated, free):
    listed = [EPOCH, EPOCH + 1 * units.s]
    assert np.array_equal(dated.attitude(listed), dated.attitude(Time(listed)))
    assert np.all(dated.at(listed).times == Time(listed))
    assert np.array_equal(free.attitude([1 * units.min, 2 * units.min]), free.attitude([60.0, 120.0]))
    assert np.array_equal(dated.attitude([TimeDelta(1, format="sec")]), dated.attitude(TimeDelta([1], format="sec")))


def test_span_may_be_two_times_or_two_durations(body):
    expected = andoyer.Scene(body, QUATERNION, RATES, epoch=EPOCH, span=(EPOCH, EPOCH + 1 * units.day))
    assert expected.span[0] == expected.epoch and expected.span[1] - expected.span[0] == pytest.approx(86400, abs=1e-6)
    assert andoyer.Scene(body, QUATERNION, RATES, epoch=EPOCH, span=TimeDelta([0, 1] * units.day)) == expected
    assert andoyer.Scene(body, QUATERNION, RATES, span=(0 * units.s, 1 * units.h)).span == (0.0, 3600.0)


@pytest.mark.parametrize("argument", ["times", "span"])
def test_calendar_time_of_a_state_without_a_calendar_is_an_error(body, free, argument):
    with pytest.raises(andoyer.InputError, match=f"{argument} is a calendar time, and the epoch of the state is a number: give the epoch as a Time too"):
        if argument == "times":
            free.at(EPOCH)
        else:
            andoyer.Scene(body, QUATERNION, RATES, span=(EPOCH, EPOCH))
    with pytest.raises(andoyer.InputError, match="times is a calendar time"):
        andoyer.Ensemble(MOMENTS, QUATERNION, RATES).at([EPOCH])


def test_quantity_of_a_state_with_a_calendar_epoch_is_an_error(dated):
    with pytest.raises(andoyer.InputError, match="times is a Quantity, and the epoch a calendar time: give a Time, or a TimeDelta"):
        dated.at([1, 2] * units.s)


@pytest.mark.parametrize(
    "value",
    [
        datetime.datetime(2026, 3, 1),
        datetime.date(2026, 3, 1),
        datetime.timedelta(1),
        np.datetime64("2026-03-01"),
        np.timedelta64(1, "s"),
        np.array(["2026-03-01"], dtype="M8[s]"),
        [datetime.datetime(2026, 3, 1)] * 2,
        [np.datetime64("2026-03-01")],
    ],
    ids=repr,
)
def test_dates_without_a_scale_are_refused_in_one_sentence(body, free, dated, value):
    said = r"has no time scale: give a Time or TimeDelta of astropy, such as astropy\.time\.Time\(value, scale=\"utc\"\)$"
    for motion in (free, dated):
        with pytest.raises(TypeError, match="^times: an? .*" + said):
            motion.at(value)
    if np.ndim(value) == 0:
        with pytest.raises(TypeError, match="^epoch: an? .*" + said):
            andoyer.Scene(body, QUATERNION, RATES, epoch=value)


@pytest.mark.parametrize(
    "value",
    [
        np.ma.array([0.0, 1.0], mask=[False, True]),
        np.ma.array([0.0, 1.0]),
        Time(["2026-03-01", "2026-03-02"]),
    ],
    ids=["masked", "no entry masked", "time"],
)
def test_masked_arrays_are_an_error(dated, value):
    if isinstance(value, Time):
        value = copy.deepcopy(value)
        value[1] = np.ma.masked
    with pytest.raises(TypeError, match="times is a masked array: give the entries that count"):
        dated.at(value)


def test_lists_of_mixed_kinds_are_refused_by_name(dated):
    with pytest.raises(TypeError, match="times must hold values of one kind, here Time: "):
        dated.at([EPOCH, 1.0])


def test_ensembles_have_epochs_one_for_all_or_one_for_each():
    alone = [andoyer.Scene(andoyer.Body(moments), QUATERNION, RATES, epoch=epoch).solve() for moments, epoch in zip(MOMENTS, [3.0, -7.0])]
    ensemble = andoyer.Ensemble(MOMENTS, QUATERNION, RATES, epochs=[3.0, -7.0])
    assert np.array_equal(ensemble.attitude([0.0, 50.0]), [motion.attitude([0.0, 50.0]) for motion in alone])
    assert list(ensemble.epochs) == [3.0, -7.0] and [motion.scene.epoch for motion in ensemble] == [3.0, -7.0]
    assert pickle.loads(pickle.dumps(ensemble)) == ensemble and ensemble[1:].epochs == -7.0
    one = andoyer.Ensemble(MOMENTS, QUATERNION, RATES, epochs=3.0)
    assert one.epochs == 3.0 and np.array_equal(one.attitude([50.0])[0], alone[0].attitude([50.0]))
    assert andoyer.Ensemble(MOMENTS, QUATERNION, RATES, epochs=[0.0, 0.0]) == andoyer.Ensemble(MOMENTS, QUATERNION, RATES)
    assert one != andoyer.Ensemble(MOMENTS, QUATERNION, RATES)
    with pytest.raises(andoyer.InputError, match="epochs has 3 entries: it must have 2"):
        andoyer.Ensemble(MOMENTS, QUATERNION, RATES, epochs=[1, 2, 3])
    with pytest.raises(andoyer.InputError, match="member 1: epoch = NaN") as caught:
        andoyer.Ensemble(MOMENTS, QUATERNION, RATES, epochs=[1.0, np.nan])
    assert caught.value.index == 1


def test_ensembles_have_calendar_epochs(free):
    epochs = EPOCH + [0, 100] * units.s
    ensemble = andoyer.Ensemble([MOMENTS[0]] * 2, QUATERNION, RATES, epochs=epochs)
    samples = ensemble.at(EPOCH + [100, 200, 300] * units.s)
    assert samples.attitude.shape == (2, 3, 4) and samples.times.shape == (3,)
    assert np.abs(samples.attitude - free.attitude(np.array([100.0, 200, 300, 0, 100, 200])).reshape(2, 3, 4)).max() < 1e-11
    assert ensemble.attitude(EPOCH).shape == (2, 4)
    own = ensemble.at(epochs.reshape(2, 1) + [0, 5] * units.s)
    assert np.abs(own.attitude - free.attitude([0.0, 5.0])).max() < 1e-11
    assert np.abs(ensemble.at(TimeDelta([5], format="sec")).attitude - free.attitude([5.0])).max() < 1e-11
    assert np.abs(ensemble[1].attitude(epochs[1]) - QUATERNION).max() < 1e-15
    again = pickle.loads(pickle.dumps(ensemble))
    assert again == ensemble and np.array_equal(again.attitude(EPOCH), ensemble.attitude(EPOCH))
    assert np.array_equal(ensemble[1:].attitude(EPOCH)[0], ensemble.attitude(EPOCH)[1])


def test_scenes_with_calendar_epochs_are_copied_compared_and_hashed(dated):
    again = pickle.loads(pickle.dumps(dated.scene))
    assert again == dated.scene and hash(again) == hash(dated.scene)
    assert np.array_equal(again.solve().attitude(EPOCH), dated.attitude(EPOCH))
    assert dated.scene != andoyer.Scene(dated.scene.body, QUATERNION, RATES, epoch=EPOCH + 1e-9 * units.s)


def test_samples_at_calendar_times_are_tables(dated):
    pytest.importorskip("pandas"), pytest.importorskip("xarray")
    samples = dated.at(EPOCH + [0, 1] * units.s)
    assert samples.to_pandas().index[1] == samples.times[1].datetime and samples.to_xarray().sizes["time"] == 2
