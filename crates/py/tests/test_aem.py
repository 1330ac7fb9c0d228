"""Attitude ephemeris messages, written and read back: every type, both versions and notations."""

import itertools
from dataclasses import replace
from datetime import datetime
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

import andoyer
from andoyer._quaternions import angle_between, product, rotate
from andoyer.output import Heading, read_aem, read_aem_segments, write_aem
from andoyer.output.attitude_types import FIELDS, FROM_SAMPLES, VERSION_1, attitudes_of, columns_of
from andoyer.output.calendar import count, parse, tdb, written

ATTITUDE = [0.1, -0.2, 0.3, 0.9273618495495703]
TRIAXIAL = andoyer.Scene(andoyer.Body([1.0, 1.5, 2.0]), ATTITUDE, [0.1, 0.2, 1.0]).solve()
SYMMETRIC = andoyer.Scene(andoyer.Body([1.0, 1.0, 1.5]), ATTITUDE, [0.3, 0.2, 1.0]).solve()
PROLATE = andoyer.Scene(andoyer.Body([1.5, 1.5, 0.7]), ATTITUDE, [0.3, -0.2, -1.0]).solve()
STEADY = andoyer.Scene(andoyer.Body([1.0, 1.0, 1.5]), ATTITUDE, [0.0, 0.0, -0.7]).solve()
OF_TYPE = {"SPIN": STEADY, "SPIN/NUTATION": SYMMETRIC, "SPIN/NUTATION_MOM": PROLATE}
TIMES = np.linspace(-5, 20, 51)

MESSAGE = """CCSDS_AEM_VERS = 2.0
COMMENT in the header
CREATION_DATE = 2026-01-01T00:00:00
ORIGINATOR = SOMEBODY
MESSAGE_ID = 1
META_START
COMMENT in the metadata
OBJECT_NAME = BODY
OBJECT_ID = 2026-001A
CENTER_NAME = EARTH
REF_FRAME_A = EME2000
REF_FRAME_B = SC_BODY_1
TIME_SYSTEM = TDB
START_TIME = 2000-01-01T12:00:00
STOP_TIME = 2000-01-01T12:00:10
ATTITUDE_TYPE = QUATERNION/ANGVEL
ANGVEL_FRAME = SC_BODY_1
INTERPOLATION_METHOD = LINEAR
INTERPOLATION_DEGREE = 1
META_STOP

DATA_START
COMMENT in the data
2000-01-01T12:00:00 0 0 0.6 0.8 1 2 3
2000-001T12:00:10.5   0.5 0.5 0.5 0.5   -1.e0 +.5E+1 0
DATA_STOP
"""

XML = """<?xml version="1.0" encoding="UTF-8"?>
<aem id="CCSDS_AEM_VERS" version="2.0">
<header><COMMENT>in the header</COMMENT><CREATION_DATE>2026-01-01T00:00:00</CREATION_DATE><ORIGINATOR>SOMEBODY</ORIGINATOR></header>
<body><segment><metadata><COMMENT>in the metadata</COMMENT><OBJECT_NAME>BODY</OBJECT_NAME><OBJECT_ID>2026-001A</OBJECT_ID>
<REF_FRAME_A>EME2000</REF_FRAME_A><REF_FRAME_B>SC_BODY_1</REF_FRAME_B><TIME_SYSTEM>TDB</TIME_SYSTEM>
<START_TIME>2000-01-01T12:00:00</START_TIME><STOP_TIME>2000-01-01T12:00:10</STOP_TIME>
<ATTITUDE_TYPE>QUATERNION/ANGVEL</ATTITUDE_TYPE><ANGVEL_FRAME>SC_BODY_1</ANGVEL_FRAME></metadata>
<data><COMMENT>in the data</COMMENT>
<attitudeState><quaternionAngVel><EPOCH>2000-01-01T12:00:00</EPOCH>
<quaternion><QC>0.8</QC><Q1>0</Q1><Q2>0</Q2><Q3>0.6</Q3></quaternion>
<angVel><ANGVEL_X units="deg/s">1</ANGVEL_X><ANGVEL_Y>2</ANGVEL_Y><ANGVEL_Z>3</ANGVEL_Z></angVel></quaternionAngVel></attitudeState>
</data></segment></body></aem>
"""


def put(tmp_path, text, name="message.aem"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


@pytest.mark.parametrize("system", ["TDB", "UTC"])
@pytest.mark.parametrize("version, name", [(2, name) for name in FROM_SAMPLES] + [(1, name) for name in FROM_SAMPLES if name in VERSION_1])
def test_what_is_written_is_read_back(tmp_path, version, name, system):
    if system == "UTC":
        pytest.importorskip("astropy")
    motion = OF_TYPE.get(name, TRIAXIAL)
    date = datetime(2016, 12, 31, 23, 59, 50)  # ten seconds and a leap second before the new year
    heading = Heading(
        "BODY", "ICRF", date, system, "2026-001A", "ME", "SUN", attitude_type=name, version=version, interpolation=("HERMITE", 3), comments=("a line",)
    )
    path = tmp_path / "message.aem"
    write_aem(path, motion.at(TIMES), heading, body=motion.scene.body)
    [segment] = read_aem_segments(path, date=date)
    assert replace(segment.heading, comments=("a line",)) == heading and segment.heading.comments[2] == "a line"
    assert np.array_equal(segment.samples.times, TIMES)
    # Sixteen digits of degrees up to 360, three of them.
    assert angle_between(segment.samples.attitude, motion.attitude(TIMES)).max() < 2e-14
    if name == "QUATERNION":
        assert np.isnan(segment.samples.angular_velocity).all()
    else:
        assert segment.samples.angular_velocity == pytest.approx(motion.angular_velocity(TIMES), abs=2e-14)


def test_spin_with_nutation_of_the_standard_has_the_attitudes_of_annex_f5():
    table = np.array([[0.0, 80.0, 45.0, 1.0, 0.0, 70.0, 0.01]])
    attitude, rates = attitudes_of("SPIN/NUTATION_MOM", table, "")
    assert attitude[0] == pytest.approx([0.0805, 0.0334, 0.9204, 0.3812], abs=5e-5)
    # 300 s later: about the momentum by 3°, then about axis 3 by 300°.
    momentum = np.radians(70.0)
    axis = np.array([np.cos(momentum), 0.0, np.sin(momentum)])
    turned, about = np.radians([3.0 / 2, 300.0 / 2])
    later = product(np.append(np.sin(turned) * axis, np.cos(turned)), product(attitude[0], np.array([0, 0, np.sin(about), np.cos(about)])))
    assert later * np.sign(later[3]) == pytest.approx([0.0584, 0.0650, 0.6263, 0.7747], abs=5e-5)
    assert rotate(attitude[0], np.array([0, 0, 1.0])) == pytest.approx([0.1736, 0, 0.9848], abs=5e-5)
    # The rates are those of these two turns.
    assert rotate(attitude[0], rates[0]) == pytest.approx(np.radians(0.01) * axis + np.radians(1.0) * np.array([0.1736, 0, 0.9848]), abs=2e-6)


@pytest.mark.parametrize("name", ["SPIN/NUTATION", "SPIN/NUTATION_MOM"])
@pytest.mark.parametrize("motion", [SYMMETRIC, PROLATE])
def test_nutation_that_is_written_propagates_the_free_motion(name, motion):
    samples = motion.at([0.0, 7.0])
    table = columns_of(name, samples.attitude, samples.angular_velocity, motion.scene.body)
    if name == "SPIN/NUTATION_MOM":
        alpha, delta, turn = np.radians(table[0, 4:])
        axis = np.array([np.cos(delta) * np.cos(alpha), np.cos(delta) * np.sin(alpha), np.sin(delta)])
    else:
        nutation, phase, turn = np.radians(table[0, 4]), np.radians(table[0, 6]), 2 * np.pi / table[0, 5]
        axis = rotate(samples.attitude[0], np.array([np.sin(nutation) * np.cos(phase), -np.sin(nutation) * np.sin(phase), np.cos(nutation)]))
    spin = np.radians(table[0, 3]) * 7 / 2
    about_momentum = np.append(np.sin(turn * 3.5) * axis, np.cos(turn * 3.5))
    later = product(about_momentum, product(samples.attitude[0], np.array([0, 0, np.sin(spin), np.cos(spin)])))
    assert angle_between(later, samples.attitude[1]) < 1e-13


def test_nutation_is_for_a_tensor_whose_symmetry_axis_is_the_third():
    samples = SYMMETRIC.at([0.0])
    tensor = np.diag([1.0, 1.0, 1.5])
    same = columns_of("SPIN/NUTATION_MOM", samples.attitude, samples.angular_velocity, andoyer.Body.from_inertia(tensor))
    assert same == pytest.approx(columns_of("SPIN/NUTATION_MOM", samples.attitude, samples.angular_velocity, SYMMETRIC.scene.body), rel=1e-14)
    with pytest.raises(ValueError, match="equal moments about axes 1 and 2: its inertia tensor is"):
        columns_of("SPIN/NUTATION_MOM", samples.attitude, samples.angular_velocity, andoyer.Body.from_inertia(np.diag([1.5, 1.0, 1.0])))


@pytest.mark.parametrize("sequence", ["".join(axes) for axes in itertools.product("XYZ", repeat=3) if axes[0] != axes[1] != axes[2]])
def test_angles_of_any_sequence_are_those_of_scipy_and_their_rates_the_derivative(sequence):
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation
    angles = np.array([[25.0, 40.0, -130.0]])
    speeds = np.array([[3.0, -2.0, 5.0]])
    attitude, rates = attitudes_of("EULER_ANGLE/DERIVATIVE", np.column_stack([angles, speeds]), sequence)
    assert angle_between(attitude[0], rotation.from_euler(sequence, angles[0], degrees=True).as_quat()) < 1e-15
    step = 1e-4
    before, after = (rotation.from_euler(sequence, (angles + sign * step * speeds)[0], degrees=True) for sign in (-1, 1))
    # In components of the body; the central difference errs by the square of the step.
    assert (before.inv() * after).as_rotvec() / (2 * step) == pytest.approx(rates[0], abs=1e-8)


def test_both_notations_say_the_same(tmp_path):
    [kvn] = read_aem_segments(put(tmp_path, MESSAGE))
    [xml] = read_aem_segments(put(tmp_path, XML, "message.xml"))
    assert replace(xml.heading, center="EARTH", interpolation=("LINEAR", 1)) == kvn.heading
    assert kvn.heading == Heading(
        "BODY",
        "EME2000",
        object_id="2026-001A",
        originator="SOMEBODY",
        center="EARTH",
        attitude_type="QUATERNION/ANGVEL",
        interpolation=("LINEAR", 1),
        comments=("in the metadata", "in the data"),
    )
    for samples in (kvn.samples, xml.samples):
        assert samples.attitude[0].tolist() == [0, 0, 0.6, 0.8] and samples.times[0] == 0
        assert samples.angular_velocity[0] == pytest.approx(np.radians([1, 2, 3]), rel=1e-15)
    assert kvn.samples.times.tolist() == [0, 10.5]
    assert kvn.samples.angular_velocity[1] == pytest.approx(np.radians([-1, 5, 0]), rel=1e-15)


@pytest.mark.parametrize("end", ["\r", "\r\n", "\n\r"])
def test_lines_end_in_any_way_that_the_standard_has(tmp_path, end):
    assert read_aem(put(tmp_path, MESSAGE.replace("\n", end))).times.tolist() == [0, 10.5]


def test_angular_velocity_in_frame_a_is_turned_into_that_of_the_body(tmp_path):
    samples = read_aem(put(tmp_path, MESSAGE.replace("ANGVEL_FRAME = SC_BODY_1", "ANGVEL_FRAME = EME2000")))
    assert rotate(samples.attitude[0], samples.angular_velocity[0]) == pytest.approx(np.radians([1, 2, 3]))


def test_message_from_the_body_to_the_frame_is_turned_round(tmp_path):
    swapped = MESSAGE.replace("REF_FRAME_A = EME2000", "REF_FRAME_A = SC_BODY_1").replace("REF_FRAME_B = SC_BODY_1", "REF_FRAME_B = EME2000")
    [segment] = read_aem_segments(put(tmp_path, swapped))
    assert (segment.heading.frame, segment.heading.body_frame) == ("EME2000", "SC_BODY_1")
    assert segment.samples.attitude[0].tolist() == [0, 0, -0.6, 0.8]
    # ANGVEL is of frame B against A, which is the body here.
    assert segment.samples.angular_velocity[0] == pytest.approx(-np.radians([1, 2, 3]))


def version_1(direction, order, numbers, name="QUATERNION"):
    text = MESSAGE.replace("= 2.0", "= 1.0").replace("MESSAGE_ID = 1\n", "").replace("QUATERNION/ANGVEL", name)
    text = text.replace("ANGVEL_FRAME = SC_BODY_1\n", f"QUATERNION_TYPE = {order}\n").replace("TIME_SYSTEM", f"ATTITUDE_DIR = {direction}\nTIME_SYSTEM")
    return text[: text.index("2000-01-01T12:00:00 0")] + f"2000-01-01T12:00:00 {numbers}\nDATA_STOP\n"


def test_version_1_says_its_direction_and_where_the_scalar_is(tmp_path):
    for direction, order, numbers in itertools.product(["A2B", "B2A"], ["FIRST", "LAST"], ["0.8 0 0 0.6"]):
        expected = np.array([0, 0, 0.6, 0.8] if order == "FIRST" else [0.8, 0, 0, 0.6]) * ([1, 1, 1, 1] if direction == "A2B" else [-1, -1, -1, 1])
        assert read_aem(put(tmp_path, version_1(direction, order, numbers))).attitude[0] == pytest.approx(expected)


def test_derivatives_of_version_1_give_the_rates_in_both_orders(tmp_path):
    sample = TRIAXIAL.at([0.0])
    row = columns_of("QUATERNION/DERIVATIVE", sample.attitude, sample.angular_velocity)[0]
    first = np.concatenate([np.roll(row[:4], 1), np.roll(row[4:], 1)])
    for order, numbers in (("LAST", row), ("FIRST", first)):
        text = version_1("A2B", order, " ".join(map(repr, map(float, numbers))), "QUATERNION/DERIVATIVE")
        assert read_aem(put(tmp_path, text)).angular_velocity[0] == pytest.approx([0.1, 0.2, 1.0], abs=1e-15)


def test_rates_of_version_1_are_not_guessed(tmp_path):
    samples = read_aem(put(tmp_path, version_1("A2B", "LAST", "0 0 0.6 0.8 1 2 3", "QUATERNION/RATE")))
    assert samples.attitude[0].tolist() == [0, 0, 0.6, 0.8] and np.isnan(samples.angular_velocity).all()


def test_one_of_several_segments_is_chosen_by_its_number(tmp_path):
    segment = MESSAGE[MESSAGE.index("META_START") :]
    path = put(tmp_path, MESSAGE + segment.replace("0 0 0.6 0.8", "0 0 -0.6 0.8"))
    with pytest.raises(ValueError, match="segment must be given, from 0 to 1: the message has 2"):
        read_aem(path)
    assert read_aem(path, 1).attitude[0].tolist() == [0, 0, -0.6, 0.8]
    for number in (2, -1):
        with pytest.raises(ValueError, match=f"segment must be from 0 to 1: got {number}"):
            read_aem(path, number)


def test_combined_document_is_read_for_the_messages_in_it(tmp_path):
    body = XML.partition("?>")[2]
    path = put(tmp_path, f'<ndm xmlns:ndm="urn"><apm/>{body}{body}</ndm>'.replace("<aem", "<ndm:aem").replace("</aem", "</ndm:aem"))
    assert len(read_aem_segments(path)) == 2


def test_leap_second_is_counted_and_written(tmp_path):
    pytest.importorskip("astropy")
    before, within, after = "2016-12-31T23:59:59", "2016-12-31T23:59:60.5Z", "2017-001T00:00:00Z"
    counts = [parse(text, "UTC") for text in (before, within, after)]
    assert [float(moment - counts[0]) for moment in counts] == [0, 1.5, 2]
    assert [written(moment, "UTC") for moment in counts] == [
        "2016-12-31T23:59:59.000000000000",
        "2016-12-31T23:59:60.500000000000",
        "2017-01-01T00:00:00.000000000000",
    ]
    for text in ("2016-12-30T23:59:60", "2017-12-31T23:59:60", "2016-12-31T22:59:60"):
        with pytest.raises(ValueError, match="only a leap second of UTC"):
            parse(text, "UTC")
    with pytest.raises(ValueError, match="only a leap second of UTC"):
        parse("2016-12-31T23:59:60", "TAI")


@pytest.mark.parametrize("system", ["UTC", "TAI", "TT", "GPS", "TCB", "TCG", "TDB"])
def test_times_are_tdb_since_j2000_as_astropy_has_them(system):
    time = pytest.importorskip("astropy.time")
    text = "2017-03-04T05:06:07.25"
    if system == "GPS":
        moment = time.Time(text, scale="tai") + 19 * pytest.importorskip("astropy.units").s
    else:
        moment = time.Time(text, scale=system.lower())
    expected = ((moment.tdb.jd1 - 2451545) + moment.tdb.jd2) * 86400
    assert tdb([parse(text, system)], system)[0] == pytest.approx(expected, abs=2e-7, rel=0)


def test_every_second_of_a_leap_year_is_written_as_it_is_read():
    for system, day in itertools.product(["TDB", "UTC"], ["2000-02-29", "2016-12-31", "1972-06-30"]):
        if system == "UTC":
            pytest.importorskip("astropy")
        zero = parse(f"{day}T23:59:58.000000000001", system)
        texts = [written(zero + Fraction(step, 4), system) for step in range(16)]
        assert [parse(text, system) for text in texts] == [zero + Fraction(step, 4) for step in range(16)]
        assert sorted(texts) == texts
    assert count(datetime(2000, 1, 1, 12), "TT") == 0


def test_samples_without_rates_are_written_as_quaternions_alone(tmp_path):
    write_aem(tmp_path / "a.aem", TRIAXIAL.at(TIMES), Heading(attitude_type="QUATERNION"))
    [segment] = read_aem_segments(tmp_path / "a.aem")
    with pytest.raises(ValueError, match="without angular velocities QUATERNION can be written"):
        write_aem(tmp_path / "b.aem", segment.samples)
    write_aem(tmp_path / "b.aem", segment.samples, segment.heading)
    assert angle_between(read_aem(tmp_path / "b.aem").attitude, segment.samples.attitude).max() < 1e-15
    assert set(FIELDS) >= set(FROM_SAMPLES)


def test_scalar_first_samples_are_written_scalar_last(tmp_path):
    write_aem(tmp_path / "a.aem", TRIAXIAL.at(TIMES, scalar_first=True))
    assert angle_between(read_aem(tmp_path / "a.aem").attitude, TRIAXIAL.attitude(TIMES)).max() < 1e-15


@pytest.mark.parametrize("system", ["TDB", "TT", "TAI", "GPS", "UTC"])
def test_calendar_times_of_samples_are_the_epochs(tmp_path, system):
    time = pytest.importorskip("astropy.time")
    times = time.Time(["2016-12-31T23:59:58.25", "2016-12-31T23:59:60.25", "2017-01-01T00:00:01.25"], scale="utc")
    samples = TRIAXIAL.at([0.0, 2.0, 4.0])
    given = SimpleNamespace(times=times, attitude=samples.attitude, angular_velocity=samples.angular_velocity, scalar_first=False)
    path = tmp_path / "message.aem"
    write_aem(path, given, Heading(time_system=system, date=datetime(1999, 1, 1)))  # a date of time 0, which such times do not have
    epochs = [line.split()[0] for line in path.read_text().splitlines() if line.startswith("201") and " " in line]
    shown = {"TDB": times.tdb, "TT": times.tt, "TAI": times.tai, "GPS": times.tai - time.TimeDelta(19, format="sec"), "UTC": times}[system]
    shown.precision = 9
    # A Julian date in two doubles has 1e-11 s.
    assert [float(parse(epoch, system) - parse(str(text), system)) for epoch, text in zip(epochs, shown.isot, strict=True)] == pytest.approx(
        [0, 0, 0], abs=1e-9
    )
