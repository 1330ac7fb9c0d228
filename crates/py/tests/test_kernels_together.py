"""Kernels of any bodies and intervals, loaded together in any order: what SPICE reads of each is its motion within the error that it states."""

import multiprocessing
import os
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from test_kernel import CLOCK

import andoyer
from andoyer._quaternions import angle_between
from andoyer.cli import main
from andoyer.output import Kernel, write_ck, write_pck

spice = pytest.importorskip("spiceypy")

SETS = int(os.environ.get("ANDOYER_KERNEL_SETS", "200"))
"""Random sets; 200 take six seconds."""
YEAR = 365.25 * 86400
ROUNDING = 4e-15
UNIT = [0.1, -0.2, 0.3, 0.9273618495495703]


def solved(rates, moments=(1.0, 1.5, 2.0), **options):
    return andoyer.Scene(andoyer.Body(moments), UNIT, rates, **options).solve()


TUMBLER = solved([0.1, 0.2, 1.0])


def read(frame, times, against="J2000"):
    """Attitudes, as SPICE has them at ephemeris times."""
    quaternions = [spice.m2q(spice.pxform(against, frame, time)) for time in times]
    return np.array([[-x, -y, -z, w] for w, x, y, z in quaternions])


def worst(frame, motion, interval, zero=0.0, against="J2000", count=60):
    """The largest angle between SPICE and the motion in an interval of the motion's times."""
    times = np.concatenate([zero + np.random.default_rng(5).uniform(*interval, count), zero + np.array(interval)])
    return angle_between(read(frame, times, against), motion.attitude(times - zero)).max()


def test_two_intervals_of_one_body_do_not_disturb_each_other(tmp_path, furnished):
    intervals = [(0.0, 100.0), (100.0, 200.0)]
    written = [write_ck(tmp_path / f"{number}.bc", TUMBLER, interval) for number, interval in enumerate(intervals)]
    furnished(tmp_path / "0.bc", tmp_path / "1.bc")
    assert max(worst("ANDOYER_BODY", TUMBLER, interval) for interval in intervals) < max(each.error for each in written) + ROUNDING < 1.02e-8


def test_two_days_by_the_command_line_do_not_disturb_each_other(tmp_path, furnished):
    scene = andoyer.Scene(andoyer.Body([1, 1.5, 2]), UNIT, [1e-5, 2e-5, 6e-5])
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    for day in (0, 1):
        line = ["propagate", str(tmp_path / "scene.toml"), "-o", str(tmp_path / f"{day}.bc"), "--date", "2026-03-01", "--frame", "ECLIPJ2000"]
        assert main([*line, "--start", str(day * 86400), "--stop", str((day + 1) * 86400), "--interpolation-error", "1e-7"]) == 0
    furnished(tmp_path / "1.bc", tmp_path / "0.bc")
    zero = (datetime(2026, 3, 1) - datetime(2000, 1, 1, 12)).total_seconds()
    assert max(worst("ANDOYER_BODY", scene.solve(), (day * 86400.0, (day + 1) * 86400.0), zero, "ECLIPJ2000") for day in (0, 1)) < 1.001e-7


@pytest.mark.parametrize("codes", [(-123000, -123001), (None, None)], ids=["neighbouring codes", "no codes"])
def test_two_bodies_do_not_disturb_each_other(codes, tmp_path, furnished):
    motions = [TUMBLER, solved([0.3, 0.1, 0.8])]
    for name, code, motion in zip("AB", codes, motions):
        write_ck(tmp_path / f"{name}.bc", motion, (0.0, 50.0 if name == "A" else 70.0), Kernel(code, f"BODY_{name}"))
    furnished(tmp_path / "A.bc", tmp_path / "B.bc")
    assert max(worst(f"BODY_{name}", motion, (0.0, 50.0)) for name, motion in zip("AB", motions)) < 1.02e-8


def written(path, kind, motion, interval, kernel, error):
    """Writes a kernel, in this process or another one."""
    if kind == "ck":
        return write_ck(path, motion, interval, kernel, interpolation_error=error)
    return write_pck(
        path, motion, interval, body=kernel.instrument, body_frame=kernel.body_frame, frame=kernel.frame, date=kernel.date, interpolation_error=error
    )


def test_random_sets_of_kernels_are_right_in_any_order(tmp_path, furnished):
    random = np.random.default_rng(20261125)
    with multiprocessing.get_context("spawn").Pool(2) as others:
        for number in range(SETS):
            folder = tmp_path / str(number)
            folder.mkdir()
            bodies = []
            for body in range(random.integers(1, 4)):
                moments = np.sort(random.uniform(0.5, 1.0, 3))
                rates = random.normal(size=3) * 10 ** random.uniform(-5, 0)
                motion = andoyer.Scene(andoyer.Body(moments[random.permutation(3)]), UNIT, rates).solve()
                code = [None, int(-random.integers(1, 2_000_000)), 2_000_000 + int(random.integers(600, 99_999))][random.integers(3)]
                bodies.append((f"BODY_{number}_{body}", code, ["ck", "pck"][random.integers(2)], motion, np.linalg.norm(rates)))
            made = []
            for part in range(random.integers(2, 7)):
                name, code, kind, motion, rate = bodies[random.integers(len(bodies))]
                date = datetime(int(random.integers(1950, 2040)), 5, 6)
                begin = random.uniform(-200, 200) / rate
                interval = (begin, begin + 10 ** random.uniform(0, 2) / rate)
                frame = ["J2000", "ECLIPJ2000", "GALACTIC"][random.integers(3)]
                path = folder / f"{part}.{'bc' if kind == 'ck' else 'bpc'}"
                arguments = (path, kind, motion, interval, Kernel(code, name, frame, date=date), 10 ** random.uniform(-9, -5))
                result = others.apply(written, arguments) if random.integers(2) else written(*arguments)
                zero = (date - datetime(2000, 1, 1, 12)).total_seconds()
                made.append((path, name, motion, interval, zero, frame, result.error))
            furnished(*[made[place][0] for place in random.permutation(len(made))])
            # Dates are days apart or the same motion is written against another date; intervals that overlap with another content are looked at in none.
            for place, (_, name, motion, interval, zero, frame, error) in enumerate(made):
                ends = (zero + interval[0], zero + interval[1])
                others_of_name = [(z + i[0], z + i[1]) for other, (_, n, _, i, z, _, _) in enumerate(made) if n == name and other != place]
                if all(stop < ends[0] or start > ends[1] for start, stop in others_of_name):
                    assert worst(name, motion, interval, zero, frame, 20) < error + ROUNDING, (number, place)
            spice.kclear()


BEFORE = [(-YEAR * 1500, 2e-5), (-YEAR * 60, 2e-5), (-(2.0**30) - 2.0**20, 2e-5), (-YEAR * 8, 4e-7), (-(2.0**20), 4e-7), (-1000.0, 4e-10), (0.0, 4e-10)]


@pytest.mark.parametrize("zero, rounding", BEFORE)
def test_times_before_2000_are_those_of_the_clock_to_its_resolution(zero, rounding, tmp_path, furnished):
    """Intervals in each piece of the clock, and over the borders of the pieces."""
    zero = round(zero)
    kernel = Kernel(body_frame="BEFORE", date=datetime(2000, 1, 1, 12) + timedelta(seconds=zero))
    result = write_ck(tmp_path / "a.bc", TUMBLER, (-15.0, 15.0), kernel, interpolation_error=1e-9)
    furnished(tmp_path / "a.bc")
    assert worst("BEFORE", TUMBLER, (-15.0, 15.0), zero) < result.error + ROUNDING
    assert result.error < 1e-9 + 1.1 * rounding
    covered = spice.ckcov(str(tmp_path / "a.bc"), kernel.instrument, True, "INTERVAL", 0.0, "TDB")
    assert (covered[0], covered[-1]) == pytest.approx((zero - 15.0, zero + 15.0), abs=2 * rounding)


def test_every_inertial_frame_is_that_of_spice(tmp_path, furnished):
    for code in spice.bltfrm(1):
        frame, name = spice.frmnam(int(code)), f"AGAINST_{code}"
        write_ck(tmp_path / f"{code}.bc", TUMBLER, (0.0, 3.0), Kernel(body_frame=name, frame=frame))
        write_pck(tmp_path / f"{code}.bpc", TUMBLER, (0.0, 3.0), body_frame=f"{name}_PCK", frame=frame, interpolation_error=1e-11)
        furnished(tmp_path / f"{code}.bc", tmp_path / f"{code}.bpc")
        assert worst(name, TUMBLER, (0.0, 3.0), against=frame) < 1.01e-8 and worst(f"{name}_PCK", TUMBLER, (0.0, 3.0), against=frame) < 1.01e-11 + ROUNDING
    write_ck(tmp_path / "icrf.bc", TUMBLER, (0.0, 3.0), Kernel(body_frame="AGAINST_ICRF", frame="ICRF"))
    furnished(tmp_path / "icrf.bc")
    assert worst("AGAINST_ICRF", TUMBLER, (0.0, 3.0)) < 1.01e-8 and "ICRF is taken for J2000" in comments(tmp_path / "icrf.bc")


def comments(path):
    handle = spice.dafopr(str(path))
    _, lines, _ = spice.dafec(handle, 400, 100)
    spice.dafcls(handle)
    return "\n".join(lines)


@pytest.mark.parametrize(
    "kernel, center",
    [
        (Kernel(-123456, "A"), -123),
        (Kernel(-82, "A"), -82),
        (Kernel(2099942, "A"), 2099942),
        (Kernel(20099942, "A"), 20099942),
        (Kernel(-123456, "A", center=20099942), 20099942),
        (Kernel(), -999),
    ],
    ids=str,
)
def test_frame_has_its_centre(kernel, center, tmp_path, furnished):
    """A position with light time in the frame of the body needs the ephemeris of the centre."""
    write_ck(tmp_path / "a.bc", TUMBLER, (0.0, 90.0), kernel)
    furnished(tmp_path / "a.bc")
    assert spice.frinfo(spice.namfrm(kernel.body_frame))[0] == center
    states = np.array([[1e4 * time, 2e5, 3e5, 1e4, 0.0, 0.0] for time in (-1000.0, 0.0, 1000.0, 2000.0)])
    handle = spice.spkopn(str(tmp_path / "a.bsp"), "A", 0)
    for body, shift in ((center, 1.0), (10, 0.0)):
        spice.spkw08(handle, body, 0, "J2000", -1000.0, 2000.0, "A", 1, 4, shift * states, -1000.0, 1000.0)
    spice.spkcls(handle)
    spice.furnsh(str(tmp_path / "a.bsp"))
    seen, light = spice.spkpos("SUN", 40.0, kernel.body_frame, "LT", str(center))
    still, _ = spice.spkpos("SUN", 40.0, "J2000", "LT", str(center))
    assert light > 1 and seen == pytest.approx(TUMBLER.rotation(40.0).inv().apply(still), rel=1e-6)


ORBIT = andoyer.Orbit(1e-3, 0.1, inclination=0.5)
EARTH = andoyer.Scene(
    andoyer.Body.named("earth"), [0.203, 0.0, 0.0, 0.97917873], [0.0, 0.0, 7.292115e-5], orbit=andoyer.Orbit(1.99e-7, 0.0167), tolerance=1e-4, span=(0.0, 3e7)
)
OF_PCK = {
    "tumbler": (TUMBLER, (-20.0, 300.0), 1e-9),
    "long-axis tumbler": (solved([1.0, 0.1, 0.2]), (0.0, 300.0), 1e-10),
    "axis through the poles of the frames": (andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0.5, 0.5, 0.5, 0.5], [0, 0, 1.0]).solve(), (0.0, 50.0), 1e-10),
    "axis at the pole": (andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], [1e-9, 0, 1.0]).solve(), (0.0, 50.0), 1e-10),
    "satellite's orbit": (solved([0.01, 0.02, 1.0], orbit=ORBIT, tolerance=1e-3, span=(0.0, 300.0)), (0.0, 300.0), 1e-9),
    "precessing Earth": (EARTH.solve(), (0.0, 3e6), 1e-9),
    "at rest": (solved([0, 0, 0]), (0.0, 1e6), 1e-9),
}


@pytest.mark.parametrize("name", OF_PCK)
def test_pck_is_the_motion_within_its_error_and_so_is_the_ck(name, tmp_path, furnished):
    motion, interval, error = OF_PCK[name]
    result = write_pck(tmp_path / "a.bpc", motion, interval, body_frame="BY_PCK", interpolation_error=error)
    other = write_ck(tmp_path / "a.bc", motion, (interval[0], interval[0] + (interval[1] - interval[0]) / 30), Kernel(body_frame="BY_CK"))
    furnished(tmp_path / "a.bpc", tmp_path / "a.bc")
    assert worst("BY_PCK", motion, interval, count=1000) < result.error + ROUNDING
    times = np.linspace(interval[0], interval[0] + (interval[1] - interval[0]) / 30, 50)
    assert angle_between(read("BY_PCK", times), read("BY_CK", times)).max() < result.error + other.error + ROUNDING
    window = spice.pckcov(str(tmp_path / "a.bpc"), Kernel(body_frame="BY_PCK").instrument)
    assert list(window) == list(interval)
    # Angular velocities are derivatives of the polynomials.
    time = interval[0] + 0.3 * (interval[1] - interval[0])
    _, velocity = spice.xf2rav(spice.sxform("J2000", "BY_PCK", time))
    expected = motion.rotation(time).apply(motion.angular_velocity(time))
    assert velocity == pytest.approx(expected, abs=1e-4 * np.sqrt(error / 1e-9) * max(np.linalg.norm(expected), 1e-12))


def test_pck_is_read_without_spice_too(tmp_path):
    pck = pytest.importorskip("jplephem.pck")
    result = write_pck(tmp_path / "a.bpc", TUMBLER, (0.0, 300.0), body=2099942)
    with open(tmp_path / "a.bpc", "rb") as file:
        segment = pck.PCK(__import__("jplephem.daf").daf.DAF(file)).segments[0]
        assert (segment.body, segment.data_type) == (2099942, 2)
        times = np.random.default_rng(3).uniform(1, 299, 1000)
        angles = np.array([segment.compute(2451545.0, time / 86400, False) for time in times])
    from scipy.spatial.transform import Rotation

    against = Rotation.from_matrix(spice.pxform(spice.frmnam(segment.frame), "J2000", 0.0))
    attitude = (against * Rotation.from_euler("ZXZ", angles)).as_quat()
    assert angle_between(attitude, TUMBLER.attitude(times)).max() < result.error + ROUNDING


def test_binary_file_is_whole_for_spice(tmp_path, furnished):
    """Ten pieces of a day: comments, coverage, names of segments, and more summaries than fit a record."""
    path = tmp_path / "a.bc"
    write_ck(path, TUMBLER, (0.0, 6000.0), Kernel(segment="A NAME OF FORTY CHARACTERS 4567890123456", comments=("x" * 200,)), interpolation_error=1e-8)
    handle = spice.dafopr(str(path))
    spice.dafbfs(handle)
    names = []
    while spice.daffna():
        names.append(spice.dafgn(100))
    spice.dafcls(handle)
    assert len(names) > 26 and set(names) == {"A NAME OF FORTY CHARACTERS 4567890123456"}
    furnished(path)
    assert list(spice.ckcov(str(path), -999000, True, "INTERVAL", 0.0, "TDB")) == pytest.approx([0.0, 6000.0])
    assert "x" * 80 in comments(path) and spice.getfat(str(path)) == ("DAF", "CK")


# JAX warns of every fork once another test has imported it; the children do not use it.
@pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_threads_and_forked_children_write_beside_calls_of_spiceypy(tmp_path, furnished):
    write_ck(tmp_path / "a.bc", TUMBLER, (0.0, 100.0))
    furnished(tmp_path / "a.bc")
    kernel = (tmp_path / "a.bc").read_bytes()

    def write(number):
        write_ck(tmp_path / f"{number}.bc", TUMBLER, (0.0, 100.0))
        return (tmp_path / f"{number}.bc").read_bytes() == kernel

    with ThreadPoolExecutor(8) as threads:
        running = [threads.submit(write, number) for number in range(24)]
        while not all(each.done() for each in running):
            spice.pxform("J2000", "ANDOYER_BODY", 50.0)
        assert all(each.result() for each in running)
    with multiprocessing.get_context("fork").Pool(4) as children:
        assert all(children.map_async(forked, [(tmp_path / f"child{number}.bc", kernel) for number in range(12)]).get(60))


def forked(work):
    path, expected = work
    write_ck(path, TUMBLER, (0.0, 100.0))
    return path.read_bytes() == expected


STEPPED = CLOCK.replace("( 0.0 -1.0E8 1.0000001 )", "( 0.0 -7.0E8 1.0   3.584E11 7.0E8 1.00001 )")
"""A clock whose rate changes at 7e8 s."""


@pytest.mark.parametrize("rates", [[0, 0, 1e-3], [1e-4, 2e-4, 1e-3]], ids=["uniform", "tumbling"])
def test_clock_whose_rate_changes_is_followed(rates, tmp_path, furnished):
    """A record of type 2 over the change was 4.3e-3 rad off, with 1e-8 stated."""
    clock = tmp_path / "clock.tsc"
    clock.write_text(STEPPED, encoding="ascii")
    motion = solved(rates)
    interval = (7e8 - 1e5, 7e8 + 1e5)
    result = write_ck(tmp_path / "a.bc", motion, interval, Kernel(body_frame="CLOCKED", clock=clock, clock_id=-5), interpolation_error=1e-7)
    spice.furnsh(str(clock))
    furnished(tmp_path / "a.bc")
    assert worst("CLOCKED", motion, interval, count=2000) < result.error + ROUNDING < 1e-5
    with pytest.raises(andoyer.InputError, match="clock = .*: the text kernel beside .* has this name"):
        write_ck(tmp_path / "clock.bc", motion, interval, Kernel(clock=clock, clock_id=-5))
    assert clock.read_text(encoding="ascii") == STEPPED


def test_scene_with_a_calendar_epoch_keeps_its_digits(tmp_path, furnished):
    """Times past J2000 were taken for interpolation errors: 1e-8 rad was refused at 1 rad/s."""
    time = pytest.importorskip("astropy.time")
    epoch = time.Time("2026-04-13T21:00", scale="tdb")
    motion = andoyer.Scene(andoyer.Body([1, 1.5, 2]), UNIT, [0.1, 0.2, 1.0], epoch=epoch).solve()
    for write, name in ((write_ck, "a.bc"), (write_pck, "a.bpc")):
        result = write(tmp_path / name, motion, (epoch, epoch + time.TimeDelta(60, format="sec")), interpolation_error=1e-8)
        assert result.error < 1.5e-7


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes of Unix")
def test_pipe_stays_and_the_file_that_is_there_is_named(tmp_path):
    os.mkfifo(tmp_path / "a.bc")
    with pytest.raises(OSError, match="seek"):
        write_ck(tmp_path / "a.bc", TUMBLER, (0, 1))
    assert not (tmp_path / "a.bc").is_file() and (tmp_path / "a.bc").exists()
    (tmp_path / "b.tsc").write_text("old", encoding="ascii")
    with pytest.raises(FileExistsError) as caught:
        write_ck(tmp_path / "b.bc", TUMBLER, (0, 1), force=False)
    assert caught.value.filename == str(tmp_path / "b.tsc") and str(caught.value) == f"[Errno 17] File exists: '{tmp_path / 'b.tsc'}'"


def test_codes_of_many_names_differ():
    names = [f"ASTEROID_{number}" for number in range(4000)]
    assert len({Kernel(body_frame=name).instrument for name in names}) == len(names)


@pytest.mark.parametrize("name", ["r/a", "./r/a", "r/../r/a", "a"])
@pytest.mark.parametrize("there", [False, True])
def test_relative_path_is_the_file_that_it_names(name, there, tmp_path, monkeypatch):
    """The folder of a relative path was doubled: r/a.bc became r/r/a.bc."""
    monkeypatch.chdir(tmp_path)
    os.makedirs("r/r")
    for ending, write in ((".bc", write_ck), (".bpc", write_pck)):
        path = Path(name + ending)
        if there:
            path.write_text("old", encoding="ascii")
        write(path, TUMBLER, (0, 1))
        assert path.stat().st_size > 4000 and path.with_suffix(".tsc" if ending == ".bc" else ".tf").exists()
    os.symlink("real.bc", "r/link.bc")
    write_ck("r/link.bc", TUMBLER, (0, 1))
    assert Path("r/link.bc").is_symlink() and Path("r/real.bc").stat().st_size > 4000 and os.listdir("r/r") == []


def test_clock_of_a_frame_without_a_code_is_the_one_that_is_read(tmp_path, furnished):
    """The text kernel named another clock than the one whose ticks were written, for codes that are computed from the name."""
    clock = tmp_path / "clock_of_mission.tsc"
    clock.write_text(CLOCK.replace("_5 ", "_999 "), encoding="ascii")
    kernel = Kernel(body_frame="COMPUTED", clock=clock)
    write_ck(tmp_path / "a.bc", TUMBLER, (0.0, 10.0), kernel)
    spice.furnsh(str(clock))
    furnished(tmp_path / "a.bc")
    assert kernel.clock_code == -999 and worst("COMPUTED", TUMBLER, (0.0, 10.0)) < 1e-6
    assert Kernel(-123456, "A", clock=clock).clock_code == -123 and Kernel(-123456, "A").clock_code == -999
