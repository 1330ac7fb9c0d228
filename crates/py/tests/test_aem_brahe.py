"""Attitude messages against the reader and writer of brahe, for the nine attitude types of version 2."""

import numpy as np
import pytest

import andoyer
from andoyer import output
from andoyer.output import Heading
from andoyer.output.attitude_types import FIELDS, VERSION_2, columns_of

brahe = pytest.importorskip("brahe")
from brahe.ccsds import AEM  # noqa: E402

ATTITUDE = [0.1, -0.2, 0.3, 0.9273618495495703]
TRIAXIAL = andoyer.Scene(andoyer.Body([1.0, 1.5, 2.0]), ATTITUDE, [0.1, 0.2, 1.0]).solve()
SYMMETRIC = andoyer.Scene(andoyer.Body([1.0, 1.0, 1.5]), ATTITUDE, [0.3, 0.2, 1.0]).solve()
STEADY = andoyer.Scene(andoyer.Body([1.0, 1.0, 1.5]), ATTITUDE, [0.0, 0.0, -0.7]).solve()
MOTIONS = {
    "QUATERNION": TRIAXIAL,
    "QUATERNION/DERIVATIVE": TRIAXIAL,
    "QUATERNION/ANGVEL": TRIAXIAL,
    "SPIN": STEADY,
    "SPIN/NUTATION": SYMMETRIC,
    "SPIN/NUTATION_MOM": SYMMETRIC,
}
EULER = ["EULER_ANGLE", "EULER_ANGLE/DERIVATIVE", "EULER_ANGLE/ANGVEL"]
TIMES = np.linspace(0, 20, 9)


def numbers(state):
    """The numbers of a data line as brahe reads it, in radians, in the sequence of the standard."""
    x = state
    parts = {
        "QUATERNION": lambda: [],
        "QUATERNION/DERIVATIVE": lambda: [*np.asarray(x.derivative)[1:], x.derivative[0]],
        "QUATERNION/ANGVEL": lambda: x.angular_velocity,
        "SPIN": lambda: [],
        "SPIN/NUTATION": lambda: [x.nutation, x.nutation_period, x.nutation_phase],
        "SPIN/NUTATION_MOM": lambda: [x.momentum_alpha, x.momentum_delta, x.nutation_vel],
    }
    if x.attitude_type.startswith("QUATERNION"):
        first = [x.quaternion.x, x.quaternion.y, x.quaternion.z, x.quaternion.w]
    else:
        first = [x.spin_alpha, x.spin_delta, x.spin_angle, x.spin_angle_vel]
    return [*first, *parts[x.attitude_type]()]


def test_the_nine_types_are_those_of_the_standard():
    assert sorted([*MOTIONS, *EULER]) == sorted(VERSION_2)


@pytest.mark.parametrize("name", MOTIONS)
def test_brahe_reads_what_is_written_and_its_message_is_read_back(tmp_path, name):
    motion = MOTIONS[name]
    samples = motion.at(TIMES)
    heading = Heading(attitude_type=name, frame="EME2000", time_system="UTC", interpolation=("LAGRANGE", 3))
    output.write_aem(tmp_path / "own.aem", samples, heading, body=motion.scene.body)
    message = AEM.from_file(str(tmp_path / "own.aem"))
    (segment,) = message.segments
    assert (segment.attitude_type, segment.interpolation_method, segment.interpolation_degree) == (name, "LAGRANGE", 3)
    expected = columns_of(name, samples.attitude, samples.angular_velocity, motion.scene.body)
    in_degrees = [not column.startswith("Q") and column != "NUTATION_PER" for column in FIELDS[name]]
    expected = np.where(in_degrees, np.radians(expected), expected)
    found = np.array([numbers(state) for state in segment.states])
    # brahe normalizes a quaternion and may turn its sign.
    if name.startswith("QUATERNION"):
        found[:, :4] *= np.sign(np.sum(found[:, :4] * expected[:, :4], axis=1))[:, None]
    assert np.abs(found - expected).max() <= 2e-14
    message.to_file(str(tmp_path / "brahe.aem"), "KVN")
    (again,) = output.read_aem_segments(tmp_path / "brahe.aem")
    assert again.heading.attitude_type == name and again.heading.interpolation == ("LAGRANGE", 3)
    own = output.read_aem(tmp_path / "own.aem")
    assert np.abs(again.samples.times - own.times).max() <= 1e-6
    assert np.abs(np.abs(np.sum(again.samples.attitude * own.attitude, axis=1)) - 1).max() <= 1e-12
    assert np.allclose(again.samples.angular_velocity, own.angular_velocity, atol=1e-10, equal_nan=True)


@pytest.mark.parametrize("name", EULER)
@pytest.mark.parametrize("sequence", ["XYZ", "ZXZ", "ZYX"])
def test_angles_have_the_attitude_that_brahe_gives_them(tmp_path, name, sequence):
    random = np.random.default_rng(3)
    rows = [np.concatenate([random.uniform(10, 80, size=3), random.uniform(-5, 5, size=len(FIELDS[name]) - 3)]) for _ in range(4)]
    data = "\n".join(f"2020-03-01T00:00:{10 * k:02d} " + " ".join(f"{x:.12f}" for x in row) for k, row in enumerate(rows))
    frame = "ANGVEL_FRAME = SC_BODY_1\n" if name.endswith("ANGVEL") else ""
    text = (
        "CCSDS_AEM_VERS = 2.0\nCREATION_DATE = 2020-01-01T00:00:00\nORIGINATOR = TEST\nMETA_START\nOBJECT_NAME = A\nOBJECT_ID = 2020-001A\n"
        "REF_FRAME_A = EME2000\nREF_FRAME_B = SC_BODY_1\nTIME_SYSTEM = UTC\nSTART_TIME = 2020-03-01T00:00:00\nSTOP_TIME = 2020-03-01T00:00:30\n"
        f"ATTITUDE_TYPE = {name}\nEULER_ROT_SEQ = {sequence}\n{frame}META_STOP\nDATA_START\n{data}\nDATA_STOP\n"
    )
    path = tmp_path / "angles.aem"
    path.write_text(text, encoding="utf-8")
    samples = output.read_aem(path)
    (trajectory,) = AEM.from_file(str(path)).to_attitude_trajectories()
    for k in range(4):
        q = trajectory.quaternion(brahe.Epoch.from_datetime(2020, 3, 1, 0, 0, 10.0 * k, 0.0, brahe.TimeSystem.UTC))
        # The attitude of the body relative to the frame has the same numbers in both programs.
        assert abs(abs(np.dot([q.x, q.y, q.z, q.w], samples.attitude[k])) - 1) <= 1e-12, (k, q, samples.attitude[k])
