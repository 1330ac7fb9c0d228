"""Orbit ephemeris messages, versions 1 to 3, in both notations: what is read, what is said, what is refused with its line."""

import warnings
from fractions import Fraction

import numpy as np
import pytest

import andoyer
from andoyer.interop import read_oem
from andoyer.interop._oem import GM, _read

HEADER = """CCSDS_OEM_VERS = 2.0
COMMENT in the header
CREATION_DATE = 2026-01-01T00:00:00
ORIGINATOR = SOMEBODY

"""

METADATA = """META_START
COMMENT in the metadata
OBJECT_NAME = SATELLITE
OBJECT_ID = 2026-001A
CENTER_NAME = Earth
REF_FRAME = EME2000
TIME_SYSTEM = TDB
START_TIME = 2000-01-01T12:00:00
USEABLE_START_TIME = 2000-01-01T12:00:01
USEABLE_STOP_TIME = 2000-01-01T12:03:59
STOP_TIME = 2000-01-01T12:04:00
INTERPOLATION = HERMITE
INTERPOLATION_DEGREE = 7
META_STOP

COMMENT before the data
"""

MESSAGE = (
    HEADER
    + METADATA
    + """2000-01-01T12:00:00 7000 -1.5 0.25 -1e-3 7.5 0
COMMENT within the data
2000-001T12:02:00.5   6940.  +9.0E+2 .5   -0.97 7.4e0 0

2000-01-01T12:04:00.000 6767.1 1780 1 -1.93 7.25 0
"""
)

COVARIANCE = """
COVARIANCE_START
COMMENT in the covariances
EPOCH = 2000-01-01T12:00:00
COV_REF_FRAME = RTN
1
2 3
COVARIANCE_STOP
"""

SECOND = (
    METADATA.replace("12:00:00", "12:04:00")
    .replace("= 2000-01-01T12:04:00\nINT", "= 2000-01-01T12:06:00\nINT")
    .replace("12:00:01", "12:04:00")
    .replace("12:03:59", "12:06:00")
)
EDGE = MESSAGE + SECOND + "2000-01-01T12:04:00 6767.1 1780 1 -1.93 7.26 0.5\n2000-01-01T12:06:00 6500 2600 2 -2.8 6.95 0.5\n"

XML = """<?xml version="1.0" encoding="UTF-8"?>
<oem id="CCSDS_OEM_VERS" version="3.0">
<header><COMMENT>in the header</COMMENT><CLASSIFICATION>none</CLASSIFICATION><CREATION_DATE>2026-01-01T00:00:00</CREATION_DATE>
<ORIGINATOR>SOMEBODY</ORIGINATOR><MESSAGE_ID>1</MESSAGE_ID></header>
<body><segment><metadata><COMMENT>in the metadata</COMMENT><OBJECT_NAME>SATELLITE</OBJECT_NAME><OBJECT_ID>2026-001A</OBJECT_ID>
<CENTER_NAME>Earth</CENTER_NAME><REF_FRAME>EME2000</REF_FRAME><TIME_SYSTEM>TDB</TIME_SYSTEM>
<START_TIME>2000-01-01T12:00:00</START_TIME><STOP_TIME>2000-01-01T12:02:00.5</STOP_TIME></metadata>
<data><COMMENT>in the data</COMMENT>
<stateVector><EPOCH>2000-01-01T12:00:00</EPOCH>
<X units="km">7000</X><Y>-1.5</Y><Z>0.25</Z><X_DOT units="km/s">-1e-3</X_DOT><Y_DOT>7.5</Y_DOT><Z_DOT>0</Z_DOT></stateVector>
<stateVector><EPOCH>2000-001T12:02:00.5</EPOCH>
<X>6940.</X><Y>+9.0E+2</Y><Z>.5</Z><X_DOT>-0.97</X_DOT><Y_DOT>7.4e0</Y_DOT><Z_DOT>0</Z_DOT></stateVector>
<covarianceMatrix><EPOCH>2000-01-01T12:00:00</EPOCH><CX_X>1</CX_X></covarianceMatrix>
</data></segment></body></oem>
"""

TIMES = [0.0, 120.5, 240.0]
POSITIONS = [[7000, -1.5, 0.25], [6940, 900, 0.5], [6767.1, 1780, 1]]
VELOCITIES = [[-1e-3, 7.5, 0], [-0.97, 7.4, 0], [-1.93, 7.25, 0]]


def put(tmp_path, text, name="orbit.oem"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def same(read, count=3):
    assert (read.times == TIMES[:count]).all()
    assert (read.positions == POSITIONS[:count]).all()
    assert (read.velocities == VELOCITIES[:count]).all()


@pytest.mark.parametrize("version", ["1.0", "2.0", "3.0"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_states_and_metadata_of_each_version(tmp_path, version, end):
    text = MESSAGE.replace("VERS = 2.0", f"VERS = {version}").replace("\n", end)
    if version == "3.0":
        text = text.replace("ORIGINATOR", f"CLASSIFICATION = none{end}MESSAGE_ID = 1{end}ORIGINATOR")
    read = _read(put(tmp_path, text))
    same(read)
    assert read.warnings == []
    assert read.metadata["USEABLE_STOP_TIME"] == "2000-01-01T12:03:59"
    assert read.metadata["INTERPOLATION"] == "HERMITE"


def test_document_has_the_same_states_and_a_byte_order_mark_is_ignored(tmp_path):
    read = _read(put(tmp_path, b"\xef\xbb\xbf" + XML.encode(), "orbit.xml"))
    same(read, 2)
    assert read.warnings == ["line 13: covariances are not read"]
    combined = XML.replace("<oem", "<ndm><opm/><oem").replace("</oem>", "</oem></ndm>")
    same(_read(put(tmp_path, combined, "ndm.xml")), 2)


def test_last_line_without_an_end_and_any_blanks_are_read(tmp_path):
    same(_read(put(tmp_path, MESSAGE.rstrip("\n").replace(" = ", "  =\t"))))


def test_covariances_and_accelerations_are_left_out_and_said(tmp_path):
    text = MESSAGE.replace("7.5 0\n", "7.5 0 0 0 1e-3\n").replace("7.4e0 0\n", "7.4e0 0 0 0 1e-3\n").replace("7.25 0\n", "7.25 0 0 0 1e-3\n") + COVARIANCE
    path = put(tmp_path, text)
    same(_read(path))
    assert _read(path).warnings == ["line 22: accelerations are not read", "line 28: covariances are not read"]
    with pytest.warns(UserWarning, match="not read") as caught:
        read_oem(path)
    assert [str(one.message) for one in caught] == [f"{path}: line 22: accelerations are not read", f"{path}: line 28: covariances are not read"]
    assert {one.filename for one in caught} == {__file__}


def test_covariances_of_two_segments_are_said_once(tmp_path):
    first, second = EDGE.split("META_START\n")[1:]
    text = HEADER + "META_START\n" + first + COVARIANCE + "META_START\n" + second + COVARIANCE
    read = _read(put(tmp_path, text))
    assert len(read.times) == 5
    assert read.warnings == ["line 28: covariances are not read"]


def test_manoeuvre_is_an_edge_with_both_velocities(tmp_path):
    read = _read(put(tmp_path, EDGE))
    assert (read.times == [0, 120.5, 240, 240, 360]).all()
    assert (read.positions[2] == read.positions[3]).all()
    assert (read.velocities[2:4] == [[-1.93, 7.25, 0], [-1.93, 7.26, 0.5]]).all()
    same(_read(put(tmp_path, EDGE), 0))
    assert (_read(put(tmp_path, EDGE), 1).times == [240, 360]).all()


def test_two_names_of_one_frame_are_joined(tmp_path):
    assert len(_read(put(tmp_path, MESSAGE + EDGE[len(MESSAGE) :].replace("EME2000", "J2000"))).times) == 5


def test_metadata_repeated_within_the_data_make_no_segment(tmp_path):
    first, last = MESSAGE.rsplit("\n\n", 1)
    read = _read(put(tmp_path, first + "\n" + METADATA + last))
    same(read)
    assert read.warnings == []


def test_data_that_end_early_and_a_frame_of_date_are_said(tmp_path):
    text = MESSAGE.replace("STOP_TIME = 2000-01-01T12:04:00", "STOP_TIME = 2000-01-01T12:10:00").replace("EME2000", "TEME")
    assert _read(put(tmp_path, text)).warnings == [
        "line 6: the axes of REF_FRAME = TEME are those of each date, and turn by 50″ a year; they are taken as fixed",
        "line 26: the data end at 2000-01-01T12:04:00.000, before STOP_TIME = 2000-01-01T12:10:00: the message may be cut off",
    ]
    assert _read(put(tmp_path, MESSAGE.replace("EME2000", "TEME\nREF_FRAME_EPOCH = 2000-01-01T12:00:00"))).warnings == []


def test_utc_and_tdb_differ_by_what_the_naif_leap_seconds_kernel_gives(tmp_path):
    # SPICE, naif0012.tls: 2000-01-01T12:00:00 UTC is ET 64.1839273. Its series of TDB - TT has one term, an error of 3e-5 s.
    pytest.importorskip("astropy")
    assert abs(_read(put(tmp_path, MESSAGE.replace("= TDB", "= UTC"))).times - TIMES - 64.1839273).max() < 5e-5


@pytest.mark.parametrize("system, offset", [("TT", 0.0), ("TAI", 32.184), ("GPS", 51.184)])
def test_uniform_scales_differ_from_tt_by_constants(tmp_path, system, offset):
    # TT - TAI = 32.184 s; TAI - GPS = 19 s; TDB - TT is below 2 ms.
    pytest.importorskip("astropy")
    read = _read(put(tmp_path, MESSAGE.replace("= TDB", f"= {system}")))
    assert abs(read.times - TIMES - offset).max() < 2e-3


def test_leap_second_has_its_own_times(tmp_path):
    time = pytest.importorskip("astropy.time")
    epochs = ["2016-12-31T23:59:59.25Z", "2016-366T23:59:60.5", "2017-01-01T00:00:00.75"]
    text = MESSAGE.replace("= TDB", "= UTC").replace("START_TIME = 2000-01-01T12:00:0", "START_TIME = 2016-12-31T23:59:0")
    text = text.replace("STOP_TIME = 2000-01-01T12:04:00", "STOP_TIME = 2017-01-01T00:00:00.75").replace(
        "STOP_TIME = 2000-01-01T12:03:59", "STOP_TIME = 2017-01-01T00:00:00"
    )
    for old, new in zip(["2000-01-01T12:00:00 7", "2000-001T12:02:00.5", "2000-01-01T12:04:00.000"], [epochs[0] + " 7", *epochs[1:]]):
        assert old in text
        text = text.replace(old, new)
    path = put(tmp_path, text)
    assert abs(np.diff(_read(path, epoch=Fraction(536500868)).times) - 1.25).max() < 1e-9
    moments = time.Time([epoch.rstrip("Z").replace("2016-366", "2016-12-31") for epoch in epochs], scale="utc")
    epoch = time.Time("2017-01-01T00:00:00", scale="utc")
    orbit = read_oem(path, epoch=epoch)
    assert abs(np.asarray(orbit.times) - (moments.tdb - epoch.tdb).sec).max() < 1e-9


def test_orbit_is_that_of_the_center_seen_from_the_object(tmp_path):
    path = put(tmp_path, MESSAGE)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        orbit, kept = read_oem(path, epoch=100.0), read_oem(path, rotating="center", gm=4.0)
    assert (np.asarray(orbit.times) == np.array(TIMES) - 100).all()
    assert (np.asarray(orbit.positions) == -np.array(POSITIONS)).all()
    assert (np.asarray(orbit.velocities) == -np.array(VELOCITIES)).all()
    assert orbit.gm == GM["EARTH"]
    assert (np.asarray(kept.positions) == POSITIONS).all()
    assert (np.asarray(kept.velocities) == VELOCITIES).all()
    assert kept.gm == 4.0


def test_gm_of_a_quantity_is_in_km(tmp_path):
    units = pytest.importorskip("astropy.units")
    gm = read_oem(put(tmp_path, MESSAGE), gm=3.986e14 * units.m**3 / units.s**2).gm
    assert abs(gm / 3.986e5 - 1) < 1e-15


def test_barycenters_have_the_mass_of_their_system():
    # The four large moons of Jupiter have 5,959.9 + 3,202.7 + 9,887.8 + 7,179.3 km³/s² (Horizons); the masses of planet and system come from two solutions.
    assert abs(GM["EARTH"] + GM["MOON"] - GM["EARTH BARYCENTER"]) < 1e-8
    assert abs(GM["JUPITER BARYCENTER"] - GM["JUPITER"] - 26229.8) < 5


@pytest.mark.parametrize("name", ["Mars_Barycenter", "mars barycentre", "MARS  BARYCENTER"])
def test_names_of_centers_in_any_spelling(tmp_path, name):
    assert read_oem(put(tmp_path, MESSAGE.replace("= Earth", f"= {name}"))).gm == GM["MARS BARYCENTER"]


DIALECTS = {
    # Step [s], version, what the metadata and epochs look like, what stands before and after the rows, one row.
    "NASA, space station": (240, "2.0", "1998-067-A", "EME2000", "ms", "COMMENT MASS=450000.00\nCOMMENT ====\n", "", "{} {!r} {!r} {!r} {!r} {!r} {!r}"),
    "GMAT": (60, "1.0", "SatId", "EME2000", "ms", "\n", "", "{}  {:.16e}  {:.16e}  {:.16e}  {:.16e}  {:.16e}  {:.16e}"),
    "Orekit": (1800, "2.0", "2026-001A", "GCRF", "ns", "\n\n", "", "{}     {!r}       {!r}    {!r}     {!r}    {!r}    {!r}"),
    "STK, with accelerations": (
        10,
        "2.0",
        "0000-000A",
        "ICRF",
        "us",
        "",
        "",
        "{}   {:.16e}   {:.16e}   {:.16e}   {:.16e}   {:.16e}   {:.16e}  -1e-06  0e+00 1e-09",
    ),
    "figure of the standard": (3600, "3.0", "1996-062A", "EME2000", "ms", "COMMENT after a manoeuvre\n", COVARIANCE, "{} {!r} {!r} {!r} {!r} {!r} {!r}"),
    "ends of lines of Windows": (600, "3.0", "2026-001A", "J2000", "ms", "\r\n", "", "{} {!r} {!r} {!r} {!r} {!r} {!r}\r"),
}


@pytest.mark.parametrize("step, version, identifier, frame, digits, before, after, row", DIALECTS.values(), ids=DIALECTS)
def test_rows_of_other_programs_are_read_to_the_bit(tmp_path, step, version, identifier, frame, digits, before, after, row):
    times = step * np.arange(7)
    epochs = np.datetime_as_string(np.datetime64("2000-01-01T12:00:00") + times.astype("timedelta64[s]"), unit=digits)
    angles = 1.1e-3 * times
    states = np.column_stack([6800 * np.cos(angles), 6800 * np.sin(angles), 0.1 * times, -7.48 * np.sin(angles), 7.48 * np.cos(angles), 0.1 + 0 * times])
    text = HEADER.replace("2.0", version) + METADATA.replace("2026-001A", identifier).replace("EME2000", frame).replace("12:03:59", "12:00:02")
    text = text.replace("STOP_TIME = 2000-01-01T12:04:00", f"STOP_TIME = {epochs[-1]}") + before
    text += "\n".join(row.format(epoch, *map(float, state)) for epoch, state in zip(epochs, states)) + "\n" + after
    read = _read(put(tmp_path, text))
    assert (read.times == times).all()
    assert (np.hstack([read.positions, read.velocities]) == states).all()
    assert len(read.warnings) == row.endswith("1e-09") + bool(after)


REFUSED = {
    "empty": ("", "", "line 1: the file is empty"),
    "another file": ("OEM_VERS", "AEM_VERS", "line 1: an OEM must start with CCSDS_OEM_VERS: got CCSDS_AEM_VERS"),
    "version 4": ("= 2.0", "= 4.0", "line 1: CCSDS_OEM_VERS must be 1.0, 2.0 or 3.0: got '4.0'"),
    "keyword of version 3": ("ORIGINATOR", "MESSAGE_ID = 1\nORIGINATOR", r"line 4: MESSAGE_ID is no keyword of the header in version 2.0 \(it is in 3.0\)"),
    "unknown keyword": ("CENTER_NAME", "CENTRE", "line 10: CENTRE is no keyword of the metadata"),
    "twice": ("CENTER_NAME = Earth", "OBJECT_ID = X", "line 10: OBJECT_ID is given twice"),
    "without a value": ("= Earth", "=", "line 10: CENTER_NAME has no value"),
    "missing in the header": ("ORIGINATOR = SOMEBODY\n", "", "line 5, header: ORIGINATOR must be given"),
    "missing in the metadata": ("CENTER_NAME = Earth\n", "", "line 18, metadata: CENTER_NAME must be given"),
    "no metadata": (METADATA, "", "line 6: must be KEYWORD = value: got '2000-01-01T12:00:00 7000"),
    "metadata without an end": ("META_STOP\n", "", "line 21: must be KEYWORD = value: got '2000-01-01T12:00:00 7000"),
    "rotating frame": ("EME2000", "ITRF2014", "line 6: REF_FRAME must be inertial, one of ICRF, .*: got 'ITRF2014'"),
    "time system": ("= TDB", "= UT1", "line 6: TIME_SYSTEM must be TDB, .*: got 'UT1'"),
    "limit": ("USEABLE_STOP_TIME = 2000-01-01", "USEABLE_STOP_TIME = 2000-01-32", "line 6: USEABLE_STOP_TIME: an epoch must be a time of the calendar"),
    "no data": (MESSAGE[len(HEADER + METADATA) :], "", "line 6: a segment must have data"),
    "five numbers": ("-1e-3 7.5 0\n", "-1e-3 7.5\n", "line 22: a record of this type must have 6 numbers, X, .*: got 5"),
    "line cut off": (" 6767.1 1780 1 -1.93 7.25 0\n", " 6767.1 1780 1 -1.", "line 26: a record of this type must have 6 numbers, X, .*: got 4"),
    "acceleration in the second": ("7.4e0 0\n", "7.4e0 0 0 0 0\n", "line 24: a record of this type must have 6 numbers, X, .*: got 9"),
    "acceleration in the first": ("7.5 0\n", "7.5 0 0 0 0\n", "line 24: a record of this type must have 9 numbers, X, .*: got 6"),
    "no number": ("7000 -1.5", "7000 -1,5", "line 22: Y must be a finite number: got '-1,5'"),
    "not a number": ("7000 -1.5", "7000 NaN", "line 22: Y must be a finite number: got 'NaN'"),
    "too large a number": ("7000 -1.5", "7000 -1e999", "line 22: Y must be a finite number: got '-1e999'"),
    "epoch": ("12:02:00.5 ", "12:02:00,5 ", "line 24: an epoch must be like .*: got '2000-001T12:02:00,5'"),
    "day of the year": ("2000-001T", "2000-367T", "line 24: an epoch must be a time of the calendar: got '2000-367"),
    "leap second outside UTC": ("12:02:00.5 ", "12:02:60.5 ", "line 24: only a leap second of UTC is number 60 of its minute"),
    "Z outside UTC": ("12:02:00.5 ", "12:02:00.5Z ", "line 24: Z is UTC, but the time system is TDB"),
    "order": ("12:02:00.5 ", "12:00:00.0 ", "line 24: times must ascend"),
    "before the start": (
        "\nSTART_TIME = 2000-01-01T12:00:00",
        "\nSTART_TIME = 2000-01-01T12:01:00",
        "line 22: the data must begin at START_TIME = .*12:01:00: got .*12:00:00",
    ),
    "after the stop": (
        "\nSTOP_TIME = 2000-01-01T12:04:00",
        "\nSTOP_TIME = 2000-01-01T12:03:00",
        "line 26: the data must end at STOP_TIME = .*12:03:00: got .*12:04:00",
    ),
    "covariances without an end": (MESSAGE[-1:], COVARIANCE.replace("COVARIANCE_STOP", ""), "line 32: the message ends here, in the covariances"),
    "covariances and metadata": (MESSAGE[-1:], COVARIANCE.replace("COVARIANCE_STOP", "META_START"), "line 33: COVARIANCE_STOP must precede META_START"),
    "data after covariances": (MESSAGE[-1:], COVARIANCE + "2000-01-01T12:05:00 1 2 3 4 5 6", "line 34: META_START or the end must follow COVARIANCE_STOP"),
}


@pytest.mark.parametrize("old, new, message", REFUSED.values(), ids=REFUSED)
def test_damaged_message_is_refused_with_its_line(tmp_path, old, new, message):
    text = MESSAGE.removesuffix(old) + new if old == "\n" else MESSAGE.replace(old, new, 1) if old else new
    assert text != MESSAGE
    with pytest.raises(andoyer.FileError, match=message) as caught:
        read_oem(put(tmp_path, text))
    assert str(caught.value).startswith(f"{tmp_path / 'orbit.oem'}: line ")


APART = {
    "gap": ("12:04:00 6767.1", "12:04:10 6767.1", r"line 43: there is a gap between segments, from 2000-01-01T12:04:00.000 \(line 26\) to 2000-01-01T12:04:10"),
    "overlap": ("12:04:00", "12:03:50", "line 43: segments must not overlap: 2000-01-01T12:03:50 is before 2000-01-01T12:04:00.000 of line 26"),
    "object": ("= 2026-001A", "= 2026-001B", "line 27: OBJECT_ID must be that of the segment before, of line 6, 2026-001A: got 2026-001B"),
    "center": ("= Earth", "= Moon", "line 27: CENTER_NAME must be that of the segment before, of line 6, Earth: got Moon"),
    "frame": ("= EME2000", "= ICRF", "line 27: REF_FRAME must be that of the segment before, of line 6, EME2000: got ICRF"),
    "time system": ("= TDB", "= TT", "line 27: TIME_SYSTEM must be that of the segment before, of line 6, TDB: got TT"),
}


@pytest.mark.parametrize("old, new, message", APART.values(), ids=APART)
def test_segments_that_do_not_join_are_refused_unless_one_is_chosen(tmp_path, old, new, message):
    second = EDGE[len(MESSAGE) :]
    assert old in second
    path = put(tmp_path, MESSAGE + second.replace(old, new))
    if "TT" in new:
        pytest.importorskip("astropy")
    with pytest.raises(andoyer.FileError, match=message + ".*; segments=i reads one segment"):
        read_oem(path)
    same(_read(path, 0))
    assert len(_read(path, 1).times) == 2


XML_REFUSED = {
    "no XML": ("</data>", "", "line 14: must be XML: mismatched tag"),
    "another document": (XML, "<aem/>", "line 1: the document must be an oem, or an ndm with one in it: got aem"),
    "entities": ("<oem ", '<!DOCTYPE oem [<!ENTITY a "aaaa">]>\n<oem ', "line 2: a document type, and so an entity, is not read"),
    "no id": (' id="CCSDS_OEM_VERS"', "", 'line 2: oem must have the attribute id="CCSDS_OEM_VERS"'),
    "version": ('version="3.0"', 'version="2"', "line 2: CCSDS_OEM_VERS must be 1.0, 2.0 or 3.0: got '2'"),
    "no segment": ("segment", "part", "line 1: the message has no segment"),
    "unit": ('units="km"', 'units="m"', "line 10: X must be in km: got m"),
    "no epoch": ("<EPOCH>2000-01-01T12:00:00</EPOCH>\n", "\n", "line 9: stateVector must have an EPOCH"),
    "no velocity": ("<Z_DOT>0</Z_DOT>", "", "line 9: a record of this type must have X, .*: got X, Y, Z, X_DOT, Y_DOT"),
    "name twice": ("<Y>-1.5</Y>", "<Y>-1.5</Y><Y>1</Y>", "line 10: Y is given twice"),
    "no number": ("7000", "7 000", "line 9: X must be a finite number: got '7 000'"),
    "loose number": ("stateVector", "state", "line 9: data must have elements stateVector: got state"),
}


@pytest.mark.parametrize("old, new, message", XML_REFUSED.values(), ids=XML_REFUSED)
def test_damaged_document_is_refused_with_its_line(tmp_path, old, new, message):
    text = XML.replace(old, new)
    assert text != XML
    with pytest.raises(andoyer.FileError, match=message):
        read_oem(put(tmp_path, text, "orbit.xml"))


def test_bytes_that_are_no_text_are_refused_with_their_line(tmp_path):
    with pytest.raises(andoyer.FileError, match="line 2: must be text"):
        read_oem(put(tmp_path, MESSAGE.encode().replace(b"in the header", b"\xff\xfe")))


ARGUMENTS = {
    "segment 1 of one": ({"segments": 1}, "segments", r'segments must be "all", or from 0 to 0: got 1'),
    "segment -1": ({"segments": -1}, "segments", r'segments must be "all", or from 0 to 0: got -1'),
    "the rotating body": ({"rotating": "satellite"}, "rotating", 'rotating must be "object" or "center": got \'satellite\''),
    "gm of a satellite": ({"rotating": "center"}, "gm", r"gm must be given \[km³/s²\]: it is not known for OBJECT_NAME = SATELLITE"),
    "epoch": ({"epoch": float("nan")}, "epoch", "epoch must be a finite number of seconds, or an astropy Time: got nan"),
}


@pytest.mark.parametrize("given, argument, message", ARGUMENTS.values(), ids=ARGUMENTS)
def test_argument_that_cannot_be_is_named(tmp_path, given, argument, message):
    with pytest.raises(andoyer.InputError, match=message) as caught:
        read_oem(put(tmp_path, MESSAGE), **given)
    assert caught.value.argument == argument


def test_center_without_a_known_gm_is_refused_by_name(tmp_path):
    path = put(tmp_path, MESSAGE.replace("= Earth", "= 433 EROS"))
    with pytest.raises(andoyer.InputError, match="gm must be given .* CENTER_NAME = 433 EROS"):
        read_oem(path)
    assert read_oem(path, gm=4.463e-4).gm == 4.463e-4


def test_number_of_a_segment_is_whole(tmp_path):
    with pytest.raises(TypeError, match='segments must be "all" or the number of a segment: got 1.0'):
        read_oem(put(tmp_path, EDGE), segments=1.0)
