"""Values of other packages in and out: SciPy's rotations, astropy's quantities and times, tables of pandas, data sets of xarray; the order of quaternions."""

import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

import andoyer

units = pytest.importorskip("astropy.units")
from astropy.time import Time  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

QUATERNION = np.array([0.1, -0.2, 0.3, 0.9273618495495703])
FIRST = np.roll(QUATERNION, 1)
RATES = [0.1, 0.2, 1.0]
MOMENTS = [[1.0, 1.5, 2.0], [1.0, 2.0, 2.5]]


def test_rotation_is_an_attitude_whatever_the_order_of_quaternions(body):
    expected = andoyer.Scene(body, QUATERNION, RATES)
    rotation = Rotation.from_quat(QUATERNION)
    assert andoyer.Scene(body, rotation, RATES) == expected
    assert andoyer.Scene(body, rotation, RATES, scalar_first=True) == expected
    stack = Rotation.from_quat([QUATERNION, [0, 0, 0, 1]])
    assert andoyer.Ensemble(MOMENTS, stack, RATES, scalar_first=True) == andoyer.Ensemble(MOMENTS, [QUATERNION, [0, 0, 0, 1]], RATES)


def test_quaternions_enter_with_the_scalar_first_where_that_is_said(body):
    scene = andoyer.Scene(body, FIRST, RATES, scalar_first=True)
    assert scene == andoyer.Scene(body, QUATERNION, RATES)
    assert np.array_equal(scene.attitude, andoyer.Scene(body, QUATERNION, RATES).attitude)
    rows = np.array([FIRST, [1.0, 0, 0, 0]])
    assert andoyer.Ensemble(MOMENTS, rows, RATES, scalar_first=True) == andoyer.Ensemble(MOMENTS, np.roll(rows, -1, axis=1), RATES)
    assert andoyer.Ensemble(MOMENTS, FIRST, RATES, scalar_first=True) == andoyer.Ensemble(MOMENTS, QUATERNION, RATES)


@pytest.mark.parametrize("times", [1.0, [0.0, 1.0, 2.0], np.arange(5000.0)], ids=["scalar", "few", "many"])
def test_quaternions_leave_with_the_scalar_first_where_that_is_said(body, times):
    for source in [andoyer.Scene(body, QUATERNION, RATES).solve(), andoyer.Ensemble(MOMENTS, QUATERNION, RATES)]:
        last = source.attitude(times)
        expected = np.roll(last, 1, axis=-1)
        assert np.array_equal(source.attitude(times, scalar_first=True), expected)
        samples = source.at(times, scalar_first=True)
        assert np.array_equal(samples.attitude, expected) and samples.scalar_first and not source.at(times).scalar_first
        assert np.array_equal(samples.angular_velocity, source.at(times).angular_velocity)
        out = np.empty(expected.shape)
        assert source.attitude(times, out=out, scalar_first=True) is out and np.array_equal(out, expected)
        assert pickle.loads(pickle.dumps(samples)).scalar_first


def test_scalar_first_is_a_keyword_alone(motion):
    with pytest.raises(TypeError):
        motion.attitude(0.0, None, True)
    with pytest.raises(TypeError):
        motion.at(0.0, True)


def test_quantities_are_taken_in_si_units(body):
    day = 86400.0
    rates = [0.0, 0.001, 360.0] * units.deg / units.day
    scene = andoyer.Scene(
        andoyer.Body([1.0, 1.5, 2.0] * units.g * units.km**2), QUATERNION, rates, epoch=2 * units.day, span=[0, 1] * units.h, tolerance=1 * units.mas
    )
    assert np.allclose(scene.body.moments, [1e3, 1.5e3, 2e3], rtol=1e-15)
    assert scene.angular_velocity[2] == pytest.approx(2 * math.pi / day, rel=1e-15)
    assert (scene.epoch, scene.span) == (2 * day, (0.0, 3600.0))
    assert scene.tolerance == pytest.approx(math.pi / 648e6, rel=1e-14)
    motion = scene.solve()
    assert np.array_equal(motion.attitude([2, 3] * units.day), motion.attitude([2 * day, 3 * day]))
    orbit = andoyer.Orbit(1 * units.deg / units.s, inclination=30 * units.deg, time_of_pericentre=1 * units.min)
    assert (orbit.mean_motion, orbit.time_of_pericentre) == (pytest.approx(math.pi / 180), 60.0)
    assert orbit.inclination == pytest.approx(math.pi / 6)
    ensemble = andoyer.Ensemble(MOMENTS * units.kg * units.m**2, QUATERNION, rates)
    assert np.array_equal(ensemble.attitude([1] * units.min), andoyer.Ensemble(MOMENTS, QUATERNION, rates.to_value("rad/s")).attitude([60.0]))


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda body: andoyer.Scene(body, QUATERNION, [1, 2, 3] * units.m), "angular_velocity must be in rad / s, or what converts to it: got m"),
        (lambda body: andoyer.Scene(body, QUATERNION, RATES, epoch=1 * units.m), "epoch must be in s, or what converts to it: got m"),
        (lambda body: andoyer.Scene(body, QUATERNION * units.m, RATES), "attitude must be in no unit, or what converts to it: got m"),
        (lambda body: andoyer.Scene(body, QUATERNION, RATES).solve().at([1] * units.kg), "times must be in s, or what converts to it: got kg"),
        (lambda body: andoyer.Body(Time(["2000-01-01"] * 3)), "moments must be no astropy Time"),
    ],
)
def test_quantity_of_another_kind_is_refused_by_name_and_unit(body, make, message):
    with pytest.raises(TypeError, match=message):
        make(body)


def test_epochs_of_astropy_are_tdb_seconds_since_j2000(body):
    motion = andoyer.Scene(body, QUATERNION, RATES, epoch=Time("2000-01-01T12:00:00", scale="tdb")).solve()
    epochs = Time(["2000-01-01T12:00:00", "2000-01-01T12:01:40"], scale="tdb")
    assert np.abs(motion.attitude(epochs) - motion.attitude([0.0, 100.0])).max() < 1e-11
    leap = Time(["2016-12-31T23:59:59", "2017-01-01T00:00:00"], scale="utc")
    motion = andoyer.Scene(body, QUATERNION, RATES, epoch=leap[0]).solve()
    apart = np.abs(motion.attitude(leap[1]) - motion.attitude(motion.scene.epoch + 2.0)).max()
    assert apart < 1e-6  # two seconds, with the leap second
    assert andoyer.Scene(body, QUATERNION, RATES, epoch=Time("J2001", scale="tdb")).epoch == pytest.approx(365.25 * 86400, abs=1e-4)


def test_samples_are_a_table_of_pandas(motion):
    pandas = pytest.importorskip("pandas")
    samples = motion.at([0.0, 1.0, 2.5])
    table = samples.to_pandas()
    assert list(table.columns) == ["qx", "qy", "qz", "qw", "wx", "wy", "wz"] and list(table.index) == [0.0, 1.0, 2.5] and table.index.name == "t"
    assert np.array_equal(table[["qx", "qy", "qz", "qw"]], samples.attitude) and np.array_equal(table[["wx", "wy", "wz"]], samples.angular_velocity)
    assert list(motion.at([0.0], scalar_first=True).to_pandas().columns)[:4] == ["qw", "qx", "qy", "qz"]
    assert len(motion.at(1.0).to_pandas()) == 1
    assert isinstance(pandas.Series([1.0]), pandas.Series) and np.array_equal(motion.attitude(pandas.Series([0.0, 1.0])), motion.attitude([0.0, 1.0]))


@pytest.mark.parametrize("times", [[0.0, 1.0, 2.0], [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]], 1.5], ids=["shared", "own", "scalar"])
def test_samples_of_an_ensemble_have_members_in_table_and_data_set(times):
    pytest.importorskip("pandas"), pytest.importorskip("xarray")
    samples = andoyer.Ensemble(MOMENTS, QUATERNION, RATES).at(times)
    table, data = samples.to_pandas(), samples.to_xarray()
    assert table.index.names == ["member", "t"] and np.array_equal(table.to_numpy()[:, :4], samples.attitude.reshape(-1, 4))
    each = np.broadcast_to(np.atleast_1d(samples.times), (2, np.size(samples.times) // (2 if np.ndim(times) == 2 else 1)))
    assert np.array_equal(table.index.get_level_values("t"), each.ravel())
    assert data.sizes["member"] == 2 and np.array_equal(data.attitude.values, samples.attitude)
    assert np.array_equal(data[("t" if np.ndim(times) == 2 else "time")].values, samples.times)


def test_samples_are_a_data_set_of_xarray(motion):
    pytest.importorskip("xarray")
    samples = motion.at([0.0, 1.0])
    data = samples.to_xarray()
    assert data.attitude.dims == ("time", "quaternion") and data.angular_velocity.dims == ("time", "axis")
    assert np.array_equal(data.attitude.sel(quaternion="w").values, samples.attitude[:, 3])
    assert np.array_equal(data.time.values, samples.times) and list(data.axis.values) == [1, 2, 3]
    assert list(motion.at(0.0, scalar_first=True).to_xarray()["quaternion"].values) == ["w", "x", "y", "z"]


@pytest.mark.parametrize("module", ["pandas", "xarray"])
def test_missing_package_is_an_import_error_that_names_the_package(motion, monkeypatch, module):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=f"pip install {module}$"):
        getattr(motion.at([0.0]), f"to_{module}")()


def test_no_other_package_is_imported_by_plain_numbers():
    code = """
import sys, numpy, andoyer
body = andoyer.Body(numpy.array([1.0, 1.5, 2.0]))
motion = andoyer.Scene(body, [0, 0, 0, 1], (0.1, 0.2, 1.0), epoch=1, orbit=None).solve()
motion.at(range(3)); motion.at(numpy.float32(1)); motion.attitude([1, 2])
sys.exit(bool({'scipy', 'astropy', 'pandas', 'xarray', 'andoyer.interop._foreign'} & set(sys.modules)))
"""
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_quantities_of_periods_and_orbits_are_taken_in_si_units(body):
    apophis = andoyer.Body([0.61, 0.965, 1.0])
    pole, phases = np.array([275.0, -85.0]) * units.deg, [90, 180] * units.deg
    scene = andoyer.Scene.from_periods(apophis, 27.38 * units.h, 263 * units.h, momentum_direction=pole, phases=phases)
    plain = andoyer.Scene.from_periods(apophis, 27.38 * 3600, 263 * 3600, momentum_direction=np.radians([275, -85]), phases=(0.25, 0.5))
    assert np.allclose(scene.attitude, plain.attitude, atol=1e-14) and np.allclose(scene.angular_velocity, plain.angular_velocity, rtol=1e-12)
    bare = {"momentum_direction": units.Quantity([0.0, 3.0, 4.0]), "phases": units.Quantity([0.25, 0.5])}
    assert andoyer.Scene.from_periods(apophis, 1, 9, **bare) == andoyer.Scene.from_periods(apophis, 1, 9, momentum_direction=[0, 3, 4], phases=(0.25, 0.5))
    orbit = andoyer.Orbit(1e-3, node_rate=-1 * units.deg / units.day, pericentre_rate=2 * units.deg / units.day, attraction=3.6e-3 / units.min**2)
    degree = math.radians(1) / 86400
    assert (orbit.node_rate, orbit.pericentre_rate) == (pytest.approx(-degree), pytest.approx(2 * degree))
    assert orbit.attraction == pytest.approx(1e-6)
    rate = 6e-2 * units.rad / units.min
    assert andoyer.Orbit(1e-3, attraction=rate**2).attraction == pytest.approx(1e-6)
    low = andoyer.Orbit.around_oblate(
        398600.4415 * units.km**3 / units.s**2, 6878.1363 * units.km, 0.001, 51.6 * units.deg, j2=1e-3, radius=6378.1363 * units.km
    )
    assert low.mean_motion == pytest.approx(
        andoyer.Orbit.around_oblate(3.986004415e14, 6878136.3, 0.001, math.radians(51.6), j2=1e-3, radius=6378136.3).mean_motion
    )
    rate = np.sqrt(398600.4415 * units.km**3 / units.s**2 / (7000 * units.km) ** 3)
    with pytest.raises(TypeError, match=r"mean_motion must be in rad / s.*; multiply by u\.rad, or by u\.cycle if it counts turns"):
        andoyer.Orbit(rate)
    assert andoyer.Orbit(rate * units.rad).mean_motion == pytest.approx(1.078e-3, rel=1e-3)
    with pytest.raises(TypeError, match="momentum_direction must be in rad, or what converts to it: got m"):
        andoyer.Scene.from_periods(apophis, 1, 9, momentum_direction=[1, 1] * units.m)
    with pytest.raises(TypeError, match="precession must be no astropy Time"):
        andoyer.Scene.from_periods(apophis, Time("2000-01-01"), 9)


def test_rates_in_hertz_are_refused_with_the_unit_that_says_turns(body):
    with pytest.raises(TypeError, match=r"angular_velocity must be in rad / s.*got Hz; multiply by u\.rad, or by u\.cycle if it counts turns"):
        andoyer.Scene(body, QUATERNION, [0.0, 0.0, 1.0] * units.Hz)
    with pytest.raises(TypeError, match=r"mean_motion.*multiply by u\.rad"):
        andoyer.Orbit(1 / units.day)
    with pytest.raises(TypeError, match=r"angular_velocity must be in rad / s, or what converts to it: got m$"):
        andoyer.Scene(body, QUATERNION, [0.0, 0.0, 1.0] * units.m)
    turning = andoyer.Scene(body, QUATERNION, [0.0, 0.0, 1.0] * units.cycle / units.s)
    assert turning.angular_velocity[2] == pytest.approx(2 * math.pi, rel=1e-15)
