"""Durations from a calendar epoch are added to it as astropy adds them; so are the ends of a span, the times of a fit and the interval of a C-kernel."""

import pickle
from datetime import datetime

import numpy as np
import pytest

import andoyer
from andoyer import fit
from andoyer.output import Heading, Kernel, write_aem, write_ck

units = pytest.importorskip("astropy.units")
from astropy.coordinates import EarthLocation  # noqa: E402
from astropy.time import Time, TimeDelta  # noqa: E402

QUATERNION = [0.1, -0.2, 0.3, 0.9273618495495703]
RATES = [0.1, 0.2, 1.0]
MOMENTS = [1.0, 1.5, 2.0]
CLOSE = 1e-10
"""A day in a double is good to 5e-12 s, and each of some conversions adds as much; the body turns with 1 rad/s."""


def solved(epoch, **options):
    return andoyer.Scene(andoyer.Body(MOMENTS), QUATERNION, RATES, epoch=epoch, **options).solve()


@pytest.mark.parametrize("scale", ["utc", "tai", "tt", "tdb"])
@pytest.mark.parametrize("of_duration", [None, "tai", "tt", "tdb", "tcb", "tcg"])
def test_duration_is_the_date_that_astropy_finds_by_adding_it(scale, of_duration):
    epoch = Time("2026-03-01T00:00:00", scale=scale)
    motion, duration = solved(epoch), TimeDelta([0.0, 10.0, 180 * 86400.0], format="sec", scale=of_duration)
    # Taken as TDB, 180 days from an epoch in UTC differed by 1.3e-3 rad.
    assert np.abs(motion.attitude(duration) - motion.attitude(epoch + duration)).max() < CLOSE
    assert np.array_equal(motion.attitude(duration[0]), motion.attitude(epoch))
    ensemble = andoyer.Ensemble([MOMENTS] * 2, QUATERNION, RATES, epochs=epoch + [0, 7] * units.day)
    each = [solved(epoch + days * units.day).attitude(duration) for days in (0, 7)]
    assert np.abs(ensemble.attitude(duration) - each).max() < CLOSE


def test_scale_of_an_epoch_is_kept_by_copies():
    place = EarthLocation.from_geodetic(10.0, 50.0)
    for epoch in (Time("2026-03-01T00:00:00", scale="utc"), Time("2026-03-01T00:00:00.1", scale="tt"), Time("2026-03-01", scale="utc", location=place)):
        motion, day = solved(epoch), TimeDelta(1 * units.day)
        again = pickle.loads(pickle.dumps(motion.scene))
        assert again == motion.scene and np.array_equal(again.solve().attitude(day), motion.attitude(day))
        assert np.abs(motion.attitude(day) - motion.attitude(epoch + day)).max() < CLOSE
    assert solved(epoch).scene.epoch == pytest.approx(((epoch.tdb.jd1 - 2451545) + epoch.tdb.jd2) * 86400, abs=1e-7, rel=0)


def test_duration_from_an_epoch_that_is_a_number_is_its_seconds():
    for scale in (None, "tai", "tdb", "tcb", "local"):
        assert np.array_equal(solved(50.0).attitude(TimeDelta(10.0, format="sec", scale=scale)), solved(50.0).attitude(60.0))


def test_durations_that_cannot_be_added_are_refused():
    motion = solved(Time("2026-03-01", scale="utc"))
    with pytest.raises(TypeError, match="times is a TimeDelta in the scale local, which cannot be added to an epoch in the scale utc"):
        motion.at(TimeDelta(1.0, format="sec", scale="local"))
    with pytest.raises(TypeError, match="times must hold values of one kind, here TimeDelta: one has the scale None, another tai"):
        motion.at([TimeDelta(1.0, format="sec"), TimeDelta(1.0, format="sec", scale="tai")])


@pytest.mark.parametrize("days", range(0, 24, 3))
def test_ends_of_a_span_can_be_evaluated(days):
    # The end of TimeDelta(1 d) was 86400 s of TDB, and the epoch + 1 d is 86400.0000133; the ends of two Times were rounded to 1e-7 s.
    epoch = Time("2026-03-01T00:00:00", scale="utc") + 1.2345 * days * units.day
    ends = TimeDelta([-0.3, 1] * units.day)
    orbit = andoyer.Orbit(1e-5, 0.1)
    for span in (ends, list(ends), (epoch + ends[0], epoch + ends[1]), epoch + ends):
        scene = andoyer.Scene(andoyer.Body(MOMENTS), QUATERNION, [1e-4, 2e-4, 1e-3], epoch=epoch, orbit=orbit, span=span, method="integrated", tolerance=1e-9)
        motion = scene.solve()
        assert np.abs(motion.attitude(ends) - motion.attitude(epoch + ends)).max() < CLOSE
        with pytest.raises(andoyer.RepresentationError, match="this is the part after the epoch"):
            motion.at(ends[1] + TimeDelta(1e-5, format="sec"))


def test_fits_take_durations_from_a_calendar_epoch():
    epoch = Time("2026-03-01T00:00:00", scale="utc")
    motion, times = solved(epoch), TimeDelta(np.linspace(0, 0.01, 40) * units.day)
    found = [fit.attitudes(motion.scene, when, motion.attitude(epoch + times), sigma=1e-9, free="angular_velocity") for when in (times, epoch + times)]
    assert np.abs(found[0].residuals).max() < 1e-8 and np.abs(found[1].residuals).max() < 1e-8
    seconds, start = fit._given.from_first("times", TimeDelta([0.0, 180.0], format="jd"), motion.scene)
    # TAI and TDB differ by up to 1.7 ms within half a year.
    expected = (epoch.tai + TimeDelta(180.0, format="jd")).tdb - epoch.tdb
    assert start is None and seconds[1] == pytest.approx(expected.sec, abs=1e-8, rel=0) and abs(seconds[1] - 180 * 86400) > 1e-4


def test_message_has_the_times_that_were_given(tmp_path):
    epoch = Time("2026-03-01T00:00:00", scale="utc")
    times = epoch + np.arange(0, 25) * units.hour
    path = tmp_path / "day.aem"
    for system, offset in {"UTC": 0, "TAI": 37}.items():
        write_aem(path, solved(epoch).at(times), Heading(time_system=system))
        lines = path.read_text().splitlines()
        epochs = [line.split()[0] for line in lines if line.startswith("2026-")]
        # 06:00:00 was written as 05:59:59.999999999998.
        assert epochs == [f"2026-03-{1 + hour // 24:02d}T{hour % 24:02d}:00:{offset:02d}.000000000000" for hour in range(25)]
        said = [line for line in lines if "Time 0" in line]
        assert said == ["COMMENT The times are the calendar times of the samples. Time 0 of the scene is 2000-01-01T12:00:00 TDB."]
    write_aem(path, solved(0.0).at([0.0, 1.0]), Heading(time_system="UTC", date=datetime(2026, 3, 1)))
    assert "COMMENT Time 0 of the scene is 2026-03-01T00:00:00 UTC; its unit of time is taken as the second." in path.read_text()


def test_kernel_of_an_interval_of_times(tmp_path):
    spice = pytest.importorskip("spiceypy")
    epoch = Time("2026-03-01T00:00:00", scale="utc")
    motion, ends = solved(epoch), epoch + [10, 70] * units.s
    path, begin = tmp_path / "dated.bc", ends[0].tdb
    seconds = ((begin.jd1 - 2451545) + begin.jd2) * 86400
    for interval in (ends, tuple(ends), TimeDelta([10, 70] * units.s)):
        write_ck(path, motion, interval, interpolation_error=1e-6)
        spice.furnsh([str(path), str(path.with_suffix(".tsc"))])
        try:
            matrix = spice.pxform("J2000", "ANDOYER_BODY", seconds + 30.0)
        finally:
            spice.kclear()
        # Seconds since J2000 in a double have 1.2e-7 s.
        assert np.abs(matrix - motion.rotation(ends[0] + 30 * units.s).as_matrix().T).max() < 2e-6
    with pytest.raises(
        andoyer.InputError, match="date must be 2000-01-01T12:00:00 TDB, the time 0 of a scene whose epoch is a Time: got 2026-03-01T00:00:00 UTC"
    ):
        write_ck(path, motion, ends, Kernel(date=datetime(2026, 3, 1), time_system="UTC"))
    with pytest.raises(andoyer.InputError, match="interval is a calendar time, and the epoch of the state is a number"):
        write_ck(path, solved(0.0), ends)
    with pytest.raises(andoyer.InputError, match="interval is a Quantity, and the epoch a calendar time"):
        write_ck(path, motion, [0, 60] * units.s)
    assert write_ck(path, solved(5.0), [0, 1] * units.min, interpolation_error=1e-5) == write_ck(path, solved(5.0), (0.0, 60.0), interpolation_error=1e-5)
