"""Files of samples that other programs read: Parquet, and the attitude ephemeris message read back by the standard's own formulas."""

import subprocess
import sys
from datetime import datetime
from fractions import Fraction

import numpy as np
import pytest

import andoyer
from andoyer.cli import main
from andoyer.output import COLUMNS, CONVENTION
from andoyer.output.calendar import count, written

TIMES = ["--start", "-3.5", "--stop", "7.25", "--samples", "44"]
MANDATORY = ["OBJECT_NAME", "OBJECT_ID", "REF_FRAME_A", "REF_FRAME_B", "TIME_SYSTEM", "START_TIME", "STOP_TIME", "ATTITUDE_TYPE"]
OPTIONAL = ["CENTER_NAME", "USEABLE_START_TIME", "USEABLE_STOP_TIME", "EULER_ROT_SEQ", "ANGVEL_FRAME", "INTERPOLATION_METHOD", "INTERPOLATION_DEGREE"]


@pytest.fixture
def scene_file(scene, tmp_path):
    path = tmp_path / "wobble.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    return path


@pytest.fixture
def message(scene_file, tmp_path):
    """Metadata, epochs as texts, and numbers of an AEM with every option."""
    output = tmp_path / "out.aem"
    options = ["--date", "2026-06-30T23:59:59.5", "--time-system", "TT", "--frame", "EME2000"]
    assert main(["propagate", str(scene_file), "-o", str(output), *TIMES, *options]) == 0
    lines = output.read_text(encoding="ascii").splitlines()
    header, metadata, data = (
        lines[: lines.index("META_START")],
        lines[lines.index("META_START") + 1 : lines.index("META_STOP")],
        lines[lines.index("META_STOP") + 1 :],
    )
    assert header[0] == "CCSDS_AEM_VERS = 2.0" and [line.split(" = ")[0] for line in header[1:]] == ["CREATION_DATE", "ORIGINATOR"]
    assert data[0] == "DATA_START" and data[-1] == "DATA_STOP" and max(map(len, lines)) <= 254
    pairs = [line.split(" = ", 1) for line in metadata if not line.startswith("COMMENT ")]
    rows = [line.split(" ") for line in data[1:-1]]
    return dict(pairs), [key for key, _ in pairs], [row[0] for row in rows], np.array([row[1:] for row in rows], dtype=float)


def test_metadata_has_the_keys_of_version_2_in_their_order_and_no_other(message):
    values, keys, epochs, _ = message
    order = [*MANDATORY[:2], "CENTER_NAME", *MANDATORY[2:6], *OPTIONAL[1:3], *MANDATORY[6:], *OPTIONAL[3:]]
    assert set(MANDATORY) <= set(keys) and keys == [key for key in order if key in keys]
    assert (values["REF_FRAME_A"], values["TIME_SYSTEM"], values["OBJECT_NAME"]) == ("EME2000", "TT", "WOBBLE")
    assert (values["ATTITUDE_TYPE"], values["ANGVEL_FRAME"]) == ("QUATERNION/ANGVEL", values["REF_FRAME_B"])
    assert (values["START_TIME"], values["STOP_TIME"]) == (epochs[0], epochs[-1]) == ("2026-06-30T23:59:56.000000000000", "2026-07-01T00:00:06.750000000000")


def test_matrix_of_the_standard_takes_inertial_components_to_body_components(message, motion):
    _, _, _, rows = message
    q1, q2, q3, qc = rows[:, :4].T
    # 504.0-B-2, annex F2.1: X_B = M_BA X_A.
    matrix = np.array([
        [q1**2 - q2**2 - q3**2 + qc**2, 2 * (q1 * q2 + q3 * qc), 2 * (q1 * q3 - q2 * qc)],
        [2 * (q1 * q2 - q3 * qc), -(q1**2) + q2**2 - q3**2 + qc**2, 2 * (q2 * q3 + q1 * qc)],
        [2 * (q1 * q3 + q2 * qc), 2 * (q2 * q3 - q1 * qc), -(q1**2) - q2**2 + q3**2 + qc**2],
    ])  # fmt: skip
    times = np.linspace(-3.5, 7.25, 44)
    body_to_inertial = motion.rotation(times).as_matrix()
    assert np.abs(np.moveaxis(matrix, 2, 0) - np.swapaxes(body_to_inertial, 1, 2)).max() < 1e-14
    # 16 digits: half a unit of the last.
    assert np.abs(rows[:, 4:] - np.degrees(motion.angular_velocity(times))).max() < 1e-13


def test_epochs_are_exact_to_their_last_decimal(message):
    _, _, epochs, _ = message
    date = datetime(2026, 6, 30, 23, 59, 59)
    for text, time in zip(epochs, np.linspace(-3.5, 7.25, 44), strict=True):
        whole, decimals = text.split(".")
        since = Fraction((datetime.fromisoformat(whole) - date).total_seconds()) + Fraction(int(decimals), 10**12)
        assert abs(since - Fraction(1, 2) - Fraction(time)) <= Fraction(1, 2 * 10**12)
    assert written(count(datetime(2000, 1, 1), "TDB") - Fraction(1, 10**12), "TDB") == "1999-12-31T23:59:59.999999999999"
    assert written(count(datetime(2000, 2, 28), "TDB") + 86400, "TDB") == "2000-02-29T00:00:00.000000000000"


def test_what_was_not_given_of_a_message_is_said(scene_file, tmp_path, capfd):
    assert main(["propagate", str(scene_file), "-o", str(tmp_path / "out.aem"), *TIMES]) == 0
    assert "time 0 is 2000-01-01T12:00:00 TDB, the inertial frame INERTIAL; --date and --frame" in capfd.readouterr().err


def test_message_is_in_the_characters_that_the_standard_has(tmp_path):
    scene = andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], [-0.0, 0, 1], name="Δ body,\nsecond line" + 300 * "x")
    path, output = tmp_path / "named.toml", tmp_path / "out.aem"
    path.write_text(scene.to_toml(), encoding="utf-8")
    assert main(["propagate", str(path), "-o", str(output), "--samples", "2"]) == 0
    lines = output.read_text(encoding="ascii").splitlines()
    assert any(line.startswith("OBJECT_NAME = ? BODY, SECOND LINEXXX") for line in lines)
    assert max(map(len, lines)) <= 254 and " -0.0" not in output.read_text()


def test_parquet_holds_the_motion_to_the_last_bit(scene_file, motion, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    output = tmp_path / "out.parquet"
    assert main(["propagate", str(scene_file), "-o", str(output), *TIMES]) == 0
    table = parquet.read_table(output)
    samples = motion.at(np.linspace(-3.5, 7.25, 44))
    expected = np.column_stack([samples.times, samples.attitude, samples.angular_velocity])
    assert table.column_names == COLUMNS.split(",") and table.schema.metadata[b"convention"].decode() == CONVENTION
    assert andoyer.output.read_table(output).scene == motion.scene
    assert np.array_equal(np.column_stack([column.to_numpy() for column in table.columns]), expected)


@pytest.mark.parametrize("module, arguments", [("pyarrow", ["propagate", "-o", "out.parquet"]), ("matplotlib", ["plot", "-o", "out.png"])])
def test_missing_package_is_one_line_that_names_the_package(scene_file, tmp_path, module, arguments):
    code = f"import sys; sys.modules[{module!r}] = None; from andoyer.cli import main; sys.exit(main({[*arguments, str(scene_file)]!r}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and done.stdout == ""
    assert f"needs {module}, which is not installed: pip install {module}\n" in done.stderr
