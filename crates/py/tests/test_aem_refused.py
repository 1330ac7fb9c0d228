"""Attitude ephemeris messages that are refused: each with the line, and why."""

from datetime import datetime

import pytest
from test_aem import MESSAGE, TIMES, TRIAXIAL, XML, put

from andoyer.output import Heading, read_aem, write_aem

REFUSED = {
    "empty": ("", "", "line 1: the file is empty"),
    "another file": ("CCSDS_AEM_VERS", "CCSDS_OEM_VERS", "line 1: an AEM must start with CCSDS_AEM_VERS: got CCSDS_OEM_VERS"),
    "version 3": ("= 2.0", "= 3.0", "line 1: CCSDS_AEM_VERS must be 1.0 or 2.0: got '3.0'"),
    "keyword of the other version": (
        "TIME_SYSTEM",
        "ATTITUDE_DIR = A2B\nTIME_SYSTEM",
        "line 13: ATTITUDE_DIR is no keyword of the metadata in version 2.0 .it is in 1.0.",
    ),
    "unknown keyword": ("CENTER_NAME", "CENTRE", "line 10: CENTRE is no keyword of the metadata"),
    "in the header": ("MESSAGE_ID", "TIME_SYSTEM", "line 5: TIME_SYSTEM is no keyword of the header"),
    "twice": ("CENTER_NAME = EARTH", "OBJECT_ID = X", "line 10: OBJECT_ID is given twice"),
    "without a value": ("= EARTH", "=", "line 10: CENTER_NAME has no value"),
    "no assignment": ("CENTER_NAME = EARTH", "EARTH", "line 10: must be KEYWORD = value: got 'EARTH'"),
    "missing in the header": ("ORIGINATOR = SOMEBODY\n", "", "line 5, header: ORIGINATOR must be given"),
    "missing in the metadata": ("TIME_SYSTEM = TDB\n", "", "metadata: TIME_SYSTEM must be given"),
    "no frame of rates": ("ANGVEL_FRAME = SC_BODY_1\n", "", "line 6: ANGVEL_FRAME must be REF_FRAME_A or REF_FRAME_B: got None"),
    "third frame of rates": ("ANGVEL_FRAME = SC_BODY_1", "ANGVEL_FRAME = ICRF", "line 6: ANGVEL_FRAME must be REF_FRAME_A or REF_FRAME_B: got 'ICRF'"),
    "type": ("QUATERNION/ANGVEL", "MATRIX", "line 6: ATTITUDE_TYPE must be QUATERNION, .*: got 'MATRIX'"),
    "type of version 1": ("QUATERNION/ANGVEL", "QUATERNION/RATE", "line 6: ATTITUDE_TYPE must be .*: got 'QUATERNION/RATE'"),
    "time system": ("= TDB", "= MET", "line 6: TIME_SYSTEM must be TDB, .*: got 'MET'"),
    "no sequence": ("QUATERNION/ANGVEL", "EULER_ANGLE/ANGVEL", "line 6: EULER_ROT_SEQ must be three axes|line 24: a record"),
    "interpolation": ("= LINEAR", "= SPLINE", "line 6: INTERPOLATION_METHOD must be LINEAR, HERMITE, LAGRANGE: got 'SPLINE'"),
    "degree": ("DEGREE = 1", "DEGREE = one", "line 6: INTERPOLATION_DEGREE must be a whole number: got 'one'"),
    "no data": ("DATA_START", "DATA", "line 22: DATA_START must follow META_STOP: got 'DATA'"),
    "two metadata": ("DATA_START", "META_START", "line 22: DATA_START must follow META_STOP: got 'META_START'"),
    "cut off": ("DATA_STOP\n", "", "line 25: the message ends here, in the data"),
    "no records": (MESSAGE[MESSAGE.index("2000-01-01T12:00:00 0") : MESSAGE.index("DATA_STOP")], "", "line 6: a segment must have data"),
    "after the data": ("DATA_STOP", "DATA_STOP\nCOMMENT late", "line 27: META_START or the end must follow DATA_STOP"),
    "seven numbers": (" 1 2 3\n", " 1 2\n", "line 24: a record of this type must have 7 numbers, Q1, .*: got 6"),
    "keyword in the data": ("COMMENT in the data", "CENTER_NAME = X", "line 23: a record of this type must have 7 numbers"),
    "no number": ("0 0 0.6", "0 zero 0.6", "line 24: Q2 must be a finite number: got 'zero'"),
    "not a number": ("0 0 0.6", "0 nan 0.6", "line 24: Q2 must be a finite number: got 'nan'"),
    "too large a number": ("1 2 3", "1 2 1e999", "line 24: ANGVEL_Z must be a finite number: got '1e999'"),
    "norm": ("0 0 0.6", "0 0 0.7", "line 6: a quaternion must have a norm within 0.001 of 1: record 1 has 1.06301"),
    "rates that overflow": (
        "QUATERNION/ANGVEL\nANGVEL_FRAME = SC_BODY_1\nINTERPOLATION_METHOD = LINEAR\nINTERPOLATION_DEGREE = 1\nMETA_STOP\n\nDATA_START\nCOMMENT in the data\n2000-01-01T12:00:00 0 0 0.6 0.8 1 2 3\n2000-001T12:00:10.5   0.5 0.5 0.5 0.5   -1.e0 +.5E+1 0",
        "QUATERNION/DERIVATIVE\nMETA_STOP\nDATA_START\n2000-01-01T12:00:00 0.6 0 0 0.8 1e308 1e308 1e308 -1e308",
        "line 6: angular velocities must be finite",
    ),
    "epoch": ("T12:00:10.5", "T12:00:10,5", "line 25: an epoch must be like .*: got '2000-001T12:00:10,5'"),
    "month": ("2000-01-01T12:00:00 ", "2000-13-01T12:00:00 ", "line 24: an epoch must be a time of the calendar: got '2000-13"),
    "day of the year": ("2000-001T", "2000-367T", "line 25: an epoch must be a time of the calendar: got '2000-367"),
    "hour": ("T12:00:10.5", "T24:00:10.5", "line 25: an epoch must be a time of the calendar"),
    "Z outside UTC": ("T12:00:10.5", "T12:00:10.5Z", "line 25: Z is UTC, but the time system is TDB"),
    "order": ("2000-001T12:00:10.5", "2000-001T12:00:00", "line 25: times must ascend"),
}


@pytest.mark.parametrize("old, new, message", REFUSED.values(), ids=REFUSED)
def test_what_the_standard_does_not_have_is_refused_with_its_line(tmp_path, old, new, message):
    text = MESSAGE.replace(old, new, 1) if old else new
    assert text != MESSAGE
    with pytest.raises(ValueError, match=message) as caught:
        read_aem(put(tmp_path, text))
    assert str(caught.value).startswith(f"{tmp_path / 'message.aem'}: ")


XML_REFUSED = {
    "no XML": ("</data>", "", "line 12: must be XML: mismatched tag"),
    "another document": (XML, "<oem/>", "line 1: the document must be an aem, or an ndm with one in it: got oem"),
    "entities": ("<aem ", '<!DOCTYPE aem [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>\n<aem ', "line 2: a document type, and so an entity, is not read"),
    "file": ("<aem ", '<!DOCTYPE aem SYSTEM "file:///etc/passwd">\n<aem ', "line 2: a document type, and so an entity, is not read"),
    "encoding": ('"UTF-8"', '"hex"', "line 1: the encoding must be UTF-8, .*: got 'hex'"),
    "no id": (' id="CCSDS_AEM_VERS"', "", 'line 2: aem must have the attribute id="CCSDS_AEM_VERS"'),
    "depth": ("<QC>", "<a><a><a><a><a><a><a>", "line 10: elements must be at most 12 deep"),
    "no metadata": ("metadata", "meta", "line 4: segment must have one element metadata: got 0"),
    "value with elements": ("<OBJECT_ID>2026-001A", "<OBJECT_ID><b/>2026-001A", "line 4: OBJECT_ID must have a value, not elements"),
    "name twice": ("<QC>0.8</QC>", "<QC>0.8</QC><QC>0.8</QC>", "line 10: QC is given twice"),
    "another type": ("<QC>0.8</QC>", "<ANGLE_1>0.8</ANGLE_1>", "line 9: a record of this type must have Q1, .*: got ANGLE_1"),
    "no epoch": ("<EPOCH>2000-01-01T12:00:00</EPOCH>", "", "line 9: quaternionAngVel must have an EPOCH"),
    "loose number": ("<attitudeState>", "<state/><attitudeState>", "line 9: data must have elements attitudeState"),
}


@pytest.mark.parametrize("old, new, message", XML_REFUSED.values(), ids=XML_REFUSED)
def test_document_that_is_no_message_is_refused_with_its_line(tmp_path, old, new, message):
    text = XML.replace(old, new)
    assert text != XML
    with pytest.raises(ValueError, match=message):
        read_aem(put(tmp_path, text, "message.xml"))


def test_bytes_that_are_no_text_are_refused_with_their_line(tmp_path):
    with pytest.raises(ValueError, match="line 2: must be text"):
        read_aem(put(tmp_path, MESSAGE.encode().replace(b"in the header", b"\xff\xfe")))


UNWRITABLE = {
    "type": (Heading(attitude_type="EULER_ANGLE"), "attitude_type must be one of QUATERNION, .*: got 'EULER_ANGLE'"),
    "version": (Heading(version=3), "version must be 1 or 2: got 3"),
    "interpolation": (Heading(interpolation=("HERMITE", 51)), r"interpolation must be .* of degree 1 to 50.*\('HERMITE', 51\)"),
    "no body": (Heading(attitude_type="SPIN/NUTATION"), "equal moments about axes 1 and 2: no body was given"),
    "leap seconds": (Heading(date=datetime(1970, 1, 1), time_system="UTC"), "whole leap seconds from 1972-01-01 on"),
}


@pytest.mark.parametrize("heading, message", UNWRITABLE.values(), ids=UNWRITABLE)
def test_message_that_the_standard_does_not_have_is_not_written(tmp_path, heading, message):
    with pytest.raises(ValueError, match=message):
        write_aem(tmp_path / "message.aem", TRIAXIAL.at(TIMES), heading)
    assert list(tmp_path.iterdir()) == []
