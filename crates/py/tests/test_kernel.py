"""C-kernels: what SPICE reads of them is the motion within the angle that was asked for, of every kind of motion."""

import itertools
from datetime import datetime

import numpy as np
import pytest

import andoyer
from andoyer._quaternions import angle_between, rotate
from andoyer.cli import main
from andoyer.output import Kernel, write_ck

spice = pytest.importorskip("spiceypy")

BODY = andoyer.Body([1.0, 1.5, 2.0])


def solved(rates, body=BODY, **options):
    return andoyer.Scene(body, [0.1, -0.2, 0.3, 0.9273618495495703], rates, **options).solve()


ORBIT = andoyer.Orbit(1e-3, 0.1, inclination=0.5)
MOTIONS = {
    "short-axis": (solved([0.1, 0.2, 1.0]), (-10.0, 20.0)),
    "long-axis": (solved([1.0, 0.1, 0.2]), (0.0, 30.0)),
    "near the separatrix": (solved([1e-5, 1.0, 1e-5]), (0.0, 100.0)),
    "gravity gradient": (solved([0.01, 0.02, 1.0], orbit=ORBIT, tolerance=1e-3, span=(0.0, 100.0)), (0.0, 40.0)),
    "one rotation a day": (solved([1e-6, 2e-6, 7.3e-5]), (0.0, 3e6)),
}
UNIFORM = {
    "about the short axis": (solved([0.0, 0.0, 1.0]), (0.0, 1e6)),
    "sphere": (solved([0.1, 0.2, 1.0], andoyer.Body([1, 1, 1])), (0.0, 100.0)),
    "at rest": (solved([0.0, 0.0, 0.0]), (0.0, 100.0)),
}
ERRORS = {"one rotation a day": 1e-6}


@pytest.fixture
def loaded():
    """Loads kernels, and leaves none."""
    yield lambda *paths: [spice.furnsh(str(path)) for path in paths]
    spice.kclear()


def read(times, kernel=Kernel()):
    """Attitudes and angular velocities in body components, as SPICE has them at ephemeris times."""
    attitude, rates = [], []
    for time in times:
        matrix, velocity, _ = spice.ckgpav(kernel.instrument, spice.sce2c(kernel.clock_code, time), 0.0, kernel.frame)
        w, x, y, z = spice.m2q(matrix)
        attitude.append([-x, -y, -z, w])
        rates.append(matrix @ velocity)
    return np.array(attitude), np.array(rates)


@pytest.mark.parametrize("name", MOTIONS | UNIFORM)
def test_spice_reads_the_motion_within_the_angle_that_was_asked_for(name, tmp_path, loaded):
    motion, interval = (MOTIONS | UNIFORM)[name]
    error = ERRORS.get(name, 1e-8)
    path = tmp_path / "motion.bc"
    written = write_ck(path, motion, interval, interpolation_error=error)
    assert written.type == (2 if name in UNIFORM else 3)
    loaded(path, path.with_suffix(".tsc"))
    times = np.concatenate([np.random.default_rng(1).uniform(*interval, 500), interval])
    attitude, rates = read(times)
    worst = angle_between(attitude, motion.attitude(times)).max()
    # SPICE and the motion round too, by 1e-15 rad each; a uniform rotation has nothing else.
    assert worst < written.error + 4e-15 and error <= written.error < 1.5 * error
    assert name in UNIFORM or worst > error / 4
    # Angular velocities are interpolated linearly: a change of direction by the error, at most at the fastest of the rates.
    expected = motion.angular_velocity(times)
    assert np.abs(rates - expected).max() <= 10 * error * np.abs(expected).max()


@pytest.mark.parametrize("name", MOTIONS)
def test_records_are_the_fewest_to_four_percent(name, tmp_path):
    motion, interval = MOTIONS[name]
    error = 1e-6
    # The integral of √(α/8ε), α by Euler's equations and, under a torque, by differences.
    times = np.linspace(*interval, 100_001)
    rates = motion.angular_velocity(times)
    acceleration = np.linalg.norm(np.gradient(rates, times, axis=0), axis=1)
    fewest = np.trapezoid(np.sqrt(acceleration / (8 * error)), times)
    count = write_ck(tmp_path / "motion.bc", motion, interval, interpolation_error=error).records - 1
    assert fewest < 1.001 * count
    # A window of 32 rotations has a whole number of intervals, so each may have one more; none is longer than a quarter of a turn.
    turns = np.trapezoid(np.linalg.norm(rates, axis=1), times) / (np.pi / 2)
    assert count < 1.04 * fewest + turns + turns / 128 + 2


def test_error_of_an_interval_is_its_square_times_the_acceleration_over_eight():
    motion, _ = MOTIONS["short-axis"]
    width = 1e-3
    attitude, middle = motion.attitude([3.0, 3.0 + width]), motion.attitude(3.0 + width / 2)
    from andoyer._quaternions import between

    error = angle_between(between(attitude[:1], attitude[1:], 0.5), middle[None])[0]
    rates = motion.angular_velocity([3.0, 3.0 + width])
    acceleration = np.linalg.norm(rates[1] - rates[0]) / width
    assert error == pytest.approx(width**2 * acceleration / 8, rel=1e-3)


def test_frame_of_the_text_kernel_takes_inertial_components_to_those_of_the_body(tmp_path, loaded):
    motion, interval = MOTIONS["short-axis"]
    kernel = Kernel(instrument=-123456, body_frame="TUMBLER", frame="ECLIPJ2000", clock_id=-77)
    path = tmp_path / "motion.bc"
    write_ck(path, motion, interval, kernel)
    loaded(path, path.with_suffix(".tsc"))
    assert np.abs(spice.pxform("ECLIPJ2000", "TUMBLER", 12.5) - motion.rotation(12.5).as_matrix().T).max() < 1e-8
    assert spice.ckcov(str(path), -123456, False, "INTERVAL", 0.0, "TDB")[:] == pytest.approx(interval, abs=1e-9)


def test_date_of_time_0_moves_the_times(tmp_path, loaded):
    pytest.importorskip("astropy")
    from astropy.time import Time

    motion, interval = MOTIONS["short-axis"]
    path = tmp_path / "motion.bc"
    kernel = Kernel(date=datetime(2026, 4, 13), time_system="UTC")
    write_ck(path, motion, interval, kernel)
    loaded(path, path.with_suffix(".tsc"))
    moment = Time("2026-04-13", scale="utc").tdb
    zero = ((moment.jd1 - 2451545) + moment.jd2) * 86400
    times = zero + np.linspace(-9, 19, 100)
    attitude, _ = read(times)
    # The seconds since J2000 are rounded to 1e-7 s, and the kernel has the motion at these times.
    assert angle_between(attitude, motion.attitude(times - zero)).max() < 1e-8 + 4e-15


def test_windows_make_segments_without_a_gap(tmp_path, loaded):
    motion = MOTIONS["short-axis"][0]
    path = tmp_path / "motion.bc"
    written = write_ck(path, motion, (0.0, 1000.0), interpolation_error=1e-8)
    loaded(path, path.with_suffix(".tsc"))
    handle = spice.dafopr(str(path))
    spice.dafbfs(handle)
    segments = []
    while spice.daffna():
        segments.append(spice.dafus(spice.dafgs(), 2, 6)[0])
    spice.dafcls(handle)
    assert len(segments) > 2 and (segments[0][0], segments[-1][1]) == (spice.sce2c(-999, 0.0), spice.sce2c(-999, 1000.0))
    assert all(before[1] == after[0] for before, after in itertools.pairwise(segments))
    times = np.linspace(0, 1000, 400)
    assert angle_between(read(times)[0], motion.attitude(times)).max() < written.error and written.records > 1_000_000


def test_clock_that_is_given_counts_its_own_ticks(tmp_path, loaded):
    clock = tmp_path / "clock.tsc"
    clock.write_text(CLOCK, encoding="ascii")
    motion, interval = MOTIONS["short-axis"]
    kernel = Kernel(clock=clock, clock_id=-5)
    path = tmp_path / "motion.bc"
    write_ck(path, motion, interval, kernel)
    assert "SCLK01" not in path.with_suffix(".tsc").read_text() and spice.ktotal("ALL") == 0
    loaded(clock, path, path.with_suffix(".tsc"))
    times = np.random.default_rng(2).uniform(*interval, 500)
    assert spice.sce2c(-5, 0.0) > 1e8
    attitude, _ = read(times, kernel)
    # A tick of this clock is 4 ms, and its count has 1e-16 of 2.5e10.
    assert angle_between(attitude, motion.attitude(times)).max() < 1e-8 + 2e-7


CLOCK = r"""KPL/SCLK
\begindata
SCLK_KERNEL_ID = ( @2020-01-01 )
SCLK_DATA_TYPE_5 = ( 1 )
SCLK01_TIME_SYSTEM_5 = ( 1 )
SCLK01_N_FIELDS_5 = ( 2 )
SCLK01_MODULI_5 = ( 10000000000 256 )
SCLK01_OFFSETS_5 = ( 0 0 )
SCLK01_OUTPUT_DELIM_5 = ( 1 )
SCLK_PARTITION_START_5 = ( 0.0 )
SCLK_PARTITION_END_5 = ( 2.56E12 )
SCLK01_COEFFICIENTS_5 = ( 0.0 -1.0E8 1.0000001 )
\begintext
"""


def test_comments_say_scene_and_bounds(tmp_path):
    motion = solved([0.1, 0.2, 1.0], name="Δ wobble")
    path = tmp_path / "motion.bc"
    write_ck(path, motion, (0.0, 10.0), Kernel(comments=("One more line",)), interpolation_error=1e-5)
    handle = spice.dafopr(str(path))
    _, lines, _ = spice.dafec(handle, 200, 100)
    spice.dafcls(handle)
    text = "\n".join(lines)
    assert "Attitude of ? wobble" in text and "One more line" in text and "moments = [1.0, 1.5, 2.0]" in text
    assert f"Error bound of the motion: {motion.plan.error_bound:.2e}".replace("e-0", "e-") in text.replace("e-0", "e-")
    assert "of SPICE's interpolation: 1e-5 rad." in text


def test_clock_in_tdt_needs_no_leap_seconds(tmp_path, loaded):
    """Most clocks of missions have this time system. The ticks are those that SPICE has with the leapseconds kernel of NAIF."""
    clock = tmp_path / "clock.tsc"
    clock.write_text(CLOCK.replace("TIME_SYSTEM_5 = ( 1 )", "TIME_SYSTEM_5 = ( 2 )"), encoding="ascii")
    motion, interval = MOTIONS["one rotation a day"]
    kernel, path = Kernel(clock=clock, clock_id=-5), tmp_path / "motion.bc"
    written = write_ck(path, motion, interval, kernel, interpolation_error=1e-6)
    assert spice.ktotal("ALL") == 0 and not spice.expool("DELTET/K")
    leap = tmp_path / "leap.tls"  # constants of naif0012.tls
    values = "DELTET/DELTA_T_A = 32.184\nDELTET/K = 1.657D-3\nDELTET/EB = 1.671D-2\nDELTET/M = ( 6.239996D0 1.99096871D-7 )\n"
    leap.write_text(f"KPL/LSK\n\\begindata\n{values}\\begintext\n", encoding="ascii")
    loaded(leap, clock, path, path.with_suffix(".tsc"))
    times = np.random.default_rng(3).uniform(*interval, 100)
    assert angle_between(read(times, kernel)[0], motion.attitude(times)).max() < written.error + 1e-9
    write_ck(tmp_path / "again.bc", motion, interval, kernel, interpolation_error=1e-6)
    assert spice.gdpool("DELTET/K", 0, 1)[0] == 1.657e-3  # those of the user stay


@pytest.mark.parametrize("first", [2.57e10, 2.5344e10], ids=["back by a week", "back by three weeks"])
def test_clock_that_goes_back_is_refused_where_it_does(first, tmp_path):
    """The advice was another interpolation error, which cannot help."""
    clock = tmp_path / "clock.tsc"
    clock.write_text(CLOCK.replace("( 0.0 -1.0E8 1.0000001 )", f"( 0.0 -1.0E8 1.0   {first:.8E} 1.0E6 1.0 )"), encoding="ascii")
    motion, kernel = solved([0, 0, 1e-3]), Kernel(clock=clock, clock_id=-5)
    with pytest.raises(
        andoyer.InputError, match="interval must be on one side of the jump of the clock.*the clock jumps by .* ticks, from (999999.9|1000000.0)"
    ):
        write_ck(tmp_path / "motion.bc", motion, (9e5, 1.1e6), kernel, interpolation_error=1e-5)
    write_ck(tmp_path / "before.bc", motion, (9e5, 9.9e5), kernel, interpolation_error=1e-5)
    write_ck(tmp_path / "after.bc", motion, (1.01e6, 1.1e6), kernel, interpolation_error=1e-5)


BAD = {
    "no length": ((1.0, 1.0), {}, "interval must be two finite times"),
    "not finite": ((0.0, float("nan")), {}, "interval must be two finite times"),
    "too small an error": ((0.0, 1.0), {"interpolation_error": 1e-14}, "at least 1e-13 rad: got 1e-14"),
    "too many records": ((0.0, 1e9), {"interpolation_error": 1e-12}, r"at most 50000000 records are needed; .* needs about \d+ records over this interval"),
    "records that the clock does not tell apart": (
        (0.0, 1e-3),
        {"kernel": Kernel(date=datetime(9000, 1, 1)), "interpolation_error": 1e-13},
        "so chosen that the clock tells the records apart",
    ),
    "unknown frame": ((0.0, 1.0), {"kernel": Kernel(frame="NOWHERE")}, "frame must be an inertial frame that SPICE knows.*NOWHERE"),
}


@pytest.mark.parametrize("interval, options, message", BAD.values(), ids=BAD)
def test_kernel_that_cannot_be_written_is_refused_and_leaves_no_file(interval, options, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        write_ck(tmp_path / "motion.bc", MOTIONS["short-axis"][0], interval, **options)
    assert list(tmp_path.iterdir()) == []


def test_what_spice_says_is_an_error_of_the_system(tmp_path):
    with pytest.raises(OSError, match="SPICE"):
        write_ck(tmp_path / "motion.bc", MOTIONS["short-axis"][0], (0.0, 1.0), Kernel(clock=tmp_path / "absent.tsc"))
    assert list(tmp_path.iterdir()) == []
    assert not spice.failed()


def test_command_writes_the_kernel(scene, motion, tmp_path, loaded, capfd):
    path, kernel = tmp_path / "wobble.toml", tmp_path / "wobble.bc"
    path.write_text(scene.to_toml(), encoding="utf-8")
    line = ["propagate", str(path), "-o", str(kernel), "--start", "0", "--stop", "20", "--interpolation-error", "1e-6"]
    assert main(line) == 0
    assert "time 0 is 2000-01-01T12:00:00 TDB, the inertial frame J2000" in capfd.readouterr().err
    loaded(kernel, tmp_path / "wobble.tsc")
    times = np.linspace(0, 20, 500)
    assert angle_between(read(times)[0], motion.attitude(times)).max() < 1e-6
    assert main(line) == 2
    assert f"{kernel}: File exists; --force replaces it" in capfd.readouterr().err
    kernel.unlink()
    assert main(line) == 2
    assert "wobble.tsc: File exists" in capfd.readouterr().err
    assert main([*line, "--force"]) == 0


def test_angular_velocities_are_inertial_ones_in_the_kernel(tmp_path, loaded):
    motion, interval = MOTIONS["short-axis"]
    path = tmp_path / "motion.bc"
    write_ck(path, motion, interval, interpolation_error=1e-6)
    loaded(path, path.with_suffix(".tsc"))
    _, velocity, _ = spice.ckgpav(-999000, spice.sce2c(-999, interval[0]), 0.0, "J2000")
    samples = motion.at(interval[0])
    assert velocity == pytest.approx(rotate(samples.attitude, samples.angular_velocity), abs=1e-14)
