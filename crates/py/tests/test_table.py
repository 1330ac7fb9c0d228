"""Tables that are read back: numbers, scene, units, calendar times, whatever the order of the columns is."""

import json

import numpy as np
import pytest

import andoyer
from andoyer import output
from andoyer.output import read_table

TIMES = np.linspace(-3.5, 7.25, 44)


@pytest.mark.parametrize("ending", ["csv", "npz", "parquet"])
@pytest.mark.parametrize("scalar_first", [False, True])
def test_table_is_read_back_to_the_same_bits(motion, tmp_path, ending, scalar_first):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    samples = motion.at(TIMES, scalar_first=scalar_first)
    path = tmp_path / f"out.{ending}"
    getattr(output, f"write_{ending}")(path, samples)
    table = read_table(path)
    expected = motion.at(TIMES)
    assert np.array_equal(table.samples.times, TIMES) and table.scene is None
    assert np.array_equal(table.samples.attitude, expected.attitude) and not table.samples.scalar_first
    assert np.array_equal(table.samples.angular_velocity, expected.angular_velocity)


def test_csv_keeps_a_scene_and_a_remark_behind_its_table(motion, tmp_path):
    path, bare = tmp_path / "out.csv", tmp_path / "bare.csv"
    output.write_csv(path, motion.at(TIMES), scene=motion.scene, remark="misses # the tolerance")
    output.write_csv(bare, motion.at(TIMES))
    text = path.read_text(encoding="utf-8")
    assert text.startswith(bare.read_text(encoding="utf-8")) and '# remark: "misses # the tolerance"' in text.splitlines()
    table = read_table(path)
    assert table.scene == motion.scene and np.array_equal(table.samples.attitude, motion.at(TIMES).attitude)


@pytest.mark.parametrize("ending", ["npz", "parquet"])
def test_scene_and_units_are_kept(motion, tmp_path, ending):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    path = tmp_path / f"out.{ending}"
    getattr(output, f"write_{ending}")(path, motion.at(TIMES), scene=motion.scene)
    table = read_table(path)
    assert table.scene == motion.scene
    assert table.units == {"t": "unit of time of the scene", "qx": "1", "qy": "1", "qz": "1", "qw": "1"} | dict.fromkeys(
        ["wx", "wy", "wz"], "rad per unit of time of the scene"
    )


@pytest.mark.parametrize("ending", ["npz", "parquet"])
@pytest.mark.parametrize("scale", ["utc", "tai", "tdb"])
def test_calendar_times_come_back_as_they_were_given(body, tmp_path, ending, scale):
    time = pytest.importorskip("astropy.time")
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    epoch = time.Time("2017-01-01T00:00:00", scale=scale)
    motion = andoyer.Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=epoch).solve()
    times = epoch + time.TimeDelta(np.linspace(0, 0.001, 9), format="jd")
    samples = motion.at(times)
    path = tmp_path / f"out.{ending}"
    getattr(output, f"write_{ending}")(path, samples)
    table = read_table(path)
    back = table.samples.times
    assert back.scale == scale and np.array_equal(back.jd1, times.jd1) and np.array_equal(back.jd2, times.jd2)
    assert table.units["t"] == "s" and table.units["wx"] == "rad/s"
    assert np.array_equal(table.samples.attitude, samples.attitude)


def test_columns_are_found_by_their_names(motion, tmp_path):
    samples = motion.at(TIMES)
    columns = dict(zip(["t", "qx", "qy", "qz", "qw", "wx", "wy", "wz"], np.column_stack([TIMES, samples.attitude, samples.angular_velocity]).T)) | {
        "other": TIMES
    }
    names = ["wz", "qw", "other", "qx", "qy", "t", "qz", "wx", "wy"]
    path = tmp_path / "turned.csv"
    np.savetxt(path, np.column_stack([columns[name] for name in names]), fmt="%.17g", delimiter=",", header=",".join(names), comments="")
    assert np.array_equal(read_table(path).samples.attitude, samples.attitude)
    parquet = pytest.importorskip("pyarrow.parquet")
    import pyarrow

    parquet.write_table(pyarrow.table({name: columns[name] for name in names}), tmp_path / "turned.parquet")
    assert np.array_equal(read_table(tmp_path / "turned.parquet").samples.angular_velocity, samples.angular_velocity)


REFUSED = {
    "no such ending": ("x.txt", b"", r"the name must end in \.csv, \.npz, \.parquet"),
    "no table": ("x.csv", b"t,qx\n1,two\n", "must be a table in CSV"),
    "missing columns": ("x.csv", b"t,qx\n1,2\n", "must have the columns t,.*: qy, qz, qw missing"),
    "ragged": ("x.csv", b"t,qx,qy\n1,2\n", "as many numbers in a line as names in the first: 2 and 3"),
    "not finite": (
        "x.csv",
        b"t,qx,qy,qz,qw,wx,wy,wz\n0,0,0,0,1,0,0,0\n1,0,0,0,nan,0,0,0\n",
        "must hold finite numbers, or NaN for all rates of a row: row 2 does not",
    ),
    "no archive": ("x.npz", b"PK\x03\x04 and more", "must be an NPZ"),
    "no parquet": ("x.parquet", b"PAR1", "must be a Parquet table|pyarrow"),
}


@pytest.mark.parametrize("name, data, message", REFUSED.values(), ids=REFUSED)
def test_file_that_is_no_table_is_refused_with_its_name(tmp_path, name, data, message):
    if name.endswith("parquet"):
        pytest.importorskip("pyarrow")
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(ValueError, match=message) as caught:
        read_table(path)
    assert str(path) in str(caught.value)


def test_archive_of_objects_is_not_loaded(tmp_path):
    path = tmp_path / "x.npz"
    np.savez(path, times=np.array([object()], dtype=object), attitude=np.zeros((1, 4)), angular_velocity=np.zeros((1, 3)))
    with pytest.raises(ValueError, match="must be an NPZ"):
        read_table(path)


def test_samples_of_an_ensemble_are_refused(tmp_path):
    samples = andoyer.Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [0.1, 0.2, 1.0]).at([0.0, 10.0])
    with pytest.raises(ValueError, match="samples must be of one motion: got <Samples of 2 members"):
        output.write_csv(tmp_path / "x.csv", samples)


def test_one_sample_at_a_scalar_time_is_a_table_of_one_row(motion, tmp_path):
    output.write_npz(tmp_path / "x.npz", motion.at(1.0))
    table = read_table(tmp_path / "x.npz")
    assert table.samples.attitude.shape == (1, 4) and json.dumps(table.units)
