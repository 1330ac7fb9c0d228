"""Tables of orbits with velocities, samples from arrays, tables without rates."""

import warnings

import numpy as np
import pytest

import andoyer
from andoyer import Body, InputError, Orbit, Samples, Scene, TabulatedOrbit, output

RATE = 2 * np.pi / 5700
ORBIT = Orbit(RATE, eccentricity=0.01, inclination=1.1, node=0.3, argument_of_pericentre=0.2, semi_major_axis=6900e3)
GM = RATE**2 * 6900e3**3
BODY = Body([1.0, 1.05, 1.1])
STATE = ([0.0, 0.0, 0.0, 1.0], [0.001, -0.003, 0.01])


def rows(times, orbit=ORBIT, step=1e-3):
    """Positions and velocities of an orbit."""
    places = np.array([orbit.position(time) for time in times])
    ahead = np.array([[orbit.position(time + k * step) for time in times] for k in (-2, -1, 1, 2)])
    return places, (ahead[0] - 8 * ahead[1] + 8 * ahead[2] - ahead[3]) / (12 * step)


def kepler(time, orbit=ORBIT):
    """Position and velocity by Kepler's equation, of which the library has no part."""
    e, n, a = orbit.eccentricity, orbit.mean_motion, 6900e3
    anomaly = n * (time - orbit.time_of_pericentre)
    eccentric = anomaly
    for _ in range(50):
        eccentric -= (eccentric - e * np.sin(eccentric) - anomaly) / (1 - e * np.cos(eccentric))
    rate = n / (1 - e * np.cos(eccentric))
    b = np.sqrt(1 - e * e)
    plane = np.array([[a * (np.cos(eccentric) - e), a * b * np.sin(eccentric), 0], [-a * rate * np.sin(eccentric), a * b * rate * np.cos(eccentric), 0]])

    def about(axis, angle):
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) if axis == 3 else np.array([[1, 0, 0], [0, c, -s], [0, s, c]])

    return plane @ (about(3, orbit.node) @ about(1, orbit.inclination) @ about(3, orbit.argument_of_pericentre)).T


def table(step, last=90_000.0, velocities=True):
    times = np.arange(-4800.0, last, step)
    states = np.array([kepler(time) for time in times])
    return TabulatedOrbit(times, states[:, 0], GM, velocities=states[:, 1] if velocities else None)


def angle(one, other):
    return 2 * np.arcsin(np.minimum(1, np.minimum(np.linalg.norm(one - other, axis=-1), np.linalg.norm(one + other, axis=-1)) / 2))


def test_rows_of_240_s_with_velocities_give_the_attitude_to_1e_8():
    times = np.linspace(0, 86400, 200)
    options = {"span": (0, 86400), "tolerance": 1e-8}
    truth = Scene(BODY, *STATE, orbit=ORBIT, method="integrated", **options | {"tolerance": 1e-11}).solve().attitude(times)
    motion = Scene(BODY, *STATE, orbit=table(240.0), **options).solve()
    error = angle(motion.attitude(times), truth).max()
    assert error < motion.plan.error_bound < 1e-8
    with pytest.warns(andoyer.ToleranceWarning, match="interpolation"):
        without = Scene(BODY, *STATE, orbit=table(240.0, velocities=False), **options).solve()
    assert angle(without.attitude(times), truth).max() > 20 * error


@pytest.mark.parametrize("step", [60.0, 420.0, 900.0])
def test_the_bound_is_above_the_error_of_any_step(step):
    times = np.linspace(-3000, 40000, 100)
    truth = Scene(BODY, *STATE, orbit=ORBIT, method="integrated", span=(-3000, 40000), tolerance=1e-11).solve().attitude(times)
    motion = Scene(BODY, *STATE, orbit=table(step), span=(-3000, 40000), tolerance=0.1).solve()
    assert angle(motion.attitude(times), truth).max() < motion.plan.error_bound


def test_no_polynomial_passes_the_edge_of_two_segments():
    edge, last = 9600.0, 20_000.0
    place, velocity = kepler(edge)
    after = Orbit.from_state(place, 1.02 * velocity, GM, edge)
    times = np.arange(-4800.0, edge + 1, 240.0)
    later = np.arange(edge, last + 2400, 240.0)
    before, moved = np.array([kepler(time) for time in times]), rows(later, after, 1.0)
    joined = TabulatedOrbit(np.concatenate([times, later]), np.concatenate([before[:, 0], moved[0]]), GM, velocities=np.concatenate([before[:, 1], moved[1]]))
    first = Scene(BODY, *STATE, orbit=ORBIT, method="integrated", span=(0, edge)).solve()
    second = Scene(BODY, first.attitude(edge), first.angular_velocity(edge), epoch=edge, orbit=after, method="integrated", span=(edge, last)).solve()
    motion = Scene(BODY, *STATE, orbit=joined, span=(0, last), tolerance=1e-6).solve()
    assert angle(motion.attitude(last), second.attitude(last)) < motion.plan.error_bound < 1e-6
    back = Scene(BODY, second.attitude(last), second.angular_velocity(last), epoch=last, orbit=joined, span=(0, last), tolerance=1e-6).solve()
    assert angle(back.attitude(0.0), first.attitude(0.0)) < back.plan.error_bound
    smooth = TabulatedOrbit(np.concatenate([times[:-1], later]), np.concatenate([before[:-1, 0], moved[0]]), GM)
    with pytest.warns(andoyer.ToleranceWarning):
        assert Scene(BODY, *STATE, orbit=smooth, span=(0, last), tolerance=1e-6).solve().plan.error_bound > 1e-5


def test_a_table_with_velocities_is_copied_and_read():
    import pickle

    given = table(600.0, 9000.0)
    assert pickle.loads(pickle.dumps(given)) == given and given != table(600.0, 9000.0, velocities=False)
    assert given.velocities.shape == (len(given.times), 3) and table(600.0, 9000.0, velocities=False).velocities is None
    scene = Scene(BODY, *STATE, orbit=given, span=(0, 3000), tolerance=1e-3)
    assert "velocities" in scene.to_toml() and repr(given).startswith("<TabulatedOrbit")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t, p, v: (t, p, v[:-1]), "velocities"),
        (lambda t, p, v: (t, p, np.where(np.arange(len(t))[:, None] == 3, np.nan, v)), r"velocities\[3\]"),
        (lambda t, p, v: (np.sort(t)[::-1], p, v), r"times\[1\]"),
        (lambda t, p, v: (t[:1], p[:1], v[:1]), "times"),
        (lambda t, p, v: (np.where(np.arange(len(t)) == 9, t[8], t), p, v), "times"),
    ],
)
def test_a_wrong_row_is_named(change, message):
    times = np.arange(0.0, 2400.0, 240.0)
    states = np.array([kepler(time) for time in times])
    times, places, velocities = change(times, states[:, 0], states[:, 1])
    with pytest.raises(InputError, match=message):
        TabulatedOrbit(times, places, GM, velocities=velocities)


def test_samples_come_from_arrays():
    motion = Scene(BODY, *STATE).solve()
    times = np.linspace(0, 5000, 50)
    samples = Samples.from_arrays(times, motion.attitude(times), motion.angular_velocity(times))
    assert np.array_equal(samples.attitude, motion.attitude(times)) and np.array_equal(samples.times, times)
    first = Samples.from_arrays(times, np.roll(motion.attitude(times), 1, axis=1), scalar_first=True)
    assert np.array_equal(first.attitude, samples.attitude) and np.isnan(first.angular_velocity).all()


@pytest.mark.parametrize(("factor", "said"), [(180 / np.pi, "57.3 times as fast as"), (1 / 60, "60 times slower than"), (1.0, None), (2.0, None)])
def test_rates_in_another_unit_than_the_attitudes_turn_are_doubted(factor, said):
    motion = Scene(Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    times = np.linspace(0, 50, 501)
    given = times, motion.attitude(times), factor * motion.angular_velocity(times)
    if said:
        with pytest.warns(UserWarning, match=rf"^angular_velocity turns {said} attitudes do between times: are rates in rad"):
            Samples.from_arrays(*given)
        return
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Samples.from_arrays(*given)
        # Steps of more than a radian, and attitudes without rates, say nothing.
        coarse = np.linspace(0, 50, 11)
        Samples.from_arrays(coarse, motion.attitude(coarse), 57.3 * motion.angular_velocity(coarse))
        Samples.from_arrays(coarse, motion.attitude(coarse))


def test_samples_from_arrays_are_written_and_read(tmp_path):
    motion = Scene(BODY, *STATE).solve()
    times = np.linspace(0, 500, 50)
    samples = Samples.from_arrays(times, motion.attitude(times))
    assert output.write_ck(tmp_path / "x.bc", samples, kernel=output.Kernel(body_frame="TESTB")).records == 50
    output.write_aem(tmp_path / "x.aem", samples, output.Heading(attitude_type="QUATERNION"))
    assert np.abs(output.read_aem(tmp_path / "x.aem").attitude - samples.attitude).max() < 1e-15
    for name, write in (("x.csv", output.write_csv), ("x.npz", output.write_npz), ("x.parquet", output.write_parquet)):
        if name.endswith("parquet"):
            pytest.importorskip("pyarrow")
        write(tmp_path / name, samples)
        read = output.read_table(tmp_path / name).samples
        assert np.array_equal(read.attitude, samples.attitude) and np.isnan(read.angular_velocity).all()


def test_a_table_needs_no_columns_of_rates(tmp_path):
    (tmp_path / "q.csv").write_text("t,qx,qy,qz,qw\n0,0,0,0,1\n1,0,0,0.6,0.8\n")
    samples = output.read_table(tmp_path / "q.csv").samples
    assert samples.attitude[1].tolist() == [0, 0, 0.6, 0.8] and np.isnan(samples.angular_velocity).all()
    (tmp_path / "part.csv").write_text("t,qx,qy,qz,qw,wx,wy\n0,0,0,0,1,0,0\n")
    with pytest.raises(andoyer.FileError, match="wz missing"):
        output.read_table(tmp_path / "part.csv")
    (tmp_path / "nan.csv").write_text("t,qx,qy,qz,qw,wx,wy,wz\n0,0,0,0,1,nan,0,0\n")
    with pytest.raises(andoyer.FileError, match="row 1"):
        output.read_table(tmp_path / "nan.csv")
    np.savez(tmp_path / "q.npz", times=[0.0, 1.0], attitude=[[0, 0, 0, 1.0]] * 2)
    assert np.isnan(output.read_table(tmp_path / "q.npz").samples.angular_velocity).all()


def test_samples_from_arrays_have_dates():
    time = pytest.importorskip("astropy.time")
    epoch = time.Time("2026-11-28T00:00:00", scale="utc")
    dated = Samples.from_arrays([0.0, 10.0], [[0, 0, 0, 1]] * 2, epoch=epoch)
    assert abs((dated.times - epoch).to_value("s") - [0, 10]).max() < 1e-9
    given = Samples.from_arrays(epoch + [0, 10] * (time.TimeDelta(1, format="sec")), [[0, 0, 0, 1]] * 2)
    assert len(given.times) == 2 and given.times.scale == "utc"
    with pytest.raises(InputError, match="epoch"):
        Samples.from_arrays(given.times, [[0, 0, 0, 1]] * 2, epoch=epoch)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (([0, 1], [[0, 0, 0, 1]]), InputError, "attitudes must have the shape"),
        (([0, 0], [[0, 0, 0, 1]] * 2), InputError, r"times\[1\]"),
        (([], np.zeros((0, 4))), InputError, "times"),
        (([0, np.inf], [[0, 0, 0, 1]] * 2), InputError, r"times\[1\]"),
        (([0, 1], [[0, 0, 0, 1], [0, 0, 0, 1.1]]), InputError, r"attitudes\[1\]"),
        (([0, 1], [[0, 0, 0, 1], [0, 0, np.nan, 1]]), InputError, r"attitudes\[1, 2\]"),
        (([0, 1], [[0, 0, 0, 1]] * 2, [[0, 0, 1]]), InputError, "angular_velocity"),
        (([0, 1], [[0, 0, 0, 1]] * 2, [[0, 0, 1], [np.nan, 0, 0]]), InputError, r"angular_velocity\[1, 0\]"),
        ((["a", "b"], [[0, 0, 0, 1]] * 2), TypeError, "times"),
    ],
)
def test_a_wrong_array_is_named(arguments, error, message):
    with pytest.raises(error, match=message):
        Samples.from_arrays(*arguments)


def test_a_wrong_unit_of_samples_is_refused():
    units = pytest.importorskip("astropy.units")
    with pytest.raises(TypeError, match="angular_velocity must be in rad / s"):
        Samples.from_arrays([0, 1], [[0, 0, 0, 1]] * 2, np.zeros((2, 3)) * units.m)
    rates = Samples.from_arrays([0, 1] * units.min, [[0, 0, 0, 1]] * 2, np.full((2, 3), 180.0) * units.deg / units.s)
    assert rates.times.tolist() == [0, 60] and np.allclose(rates.angular_velocity, np.pi)
