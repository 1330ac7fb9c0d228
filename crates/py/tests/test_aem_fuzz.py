"""Any bytes are read as a message or raise an error that names the file. The bytes are texts close to messages, and arbitrary texts."""

import numpy as np
import pytest

pytest.importorskip("hypothesis")

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_aem import MESSAGE, XML

from andoyer.output import read_aem_segments
from andoyer.output.attitude_types import FIELDS, VERSION_1

pytest.importorskip("astropy")

BOUNDED = settings(max_examples=300, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
PIECES = [
    *MESSAGE.split(),
    "META_START",
    "META_STOP",
    "COMMENT x",
    "Z",
    "=",
    "\r",
    "\t",
    "\0",
    "é",
    "1e400",
    "-0",
    "nan",
    "9" * 40,
    "T",
    "XYZ",
    "UTC",
    "FIRST",
    "B2A",
    "\n",
]
NUMBERS = st.one_of(st.floats(allow_nan=True, allow_infinity=True).map(repr), st.integers().map(str), st.sampled_from(["1", "0", "0.5", "-1e-300", "1_0", "٣"]))
EPOCHS = st.one_of(
    st.datetimes().map(lambda date: date.isoformat()),
    st.from_regex(r"[0-9]{4}-[0-9]{2,3}(-[0-9]{2})?T[0-9]{2}:[0-9]{2}:[0-9]{2}(\.[0-9]{0,40})?Z?", fullmatch=True),
)


def read(path, data):
    """The segments, whose samples are what samples are, or None for a message that is refused in one line."""
    path.write_bytes(data)
    try:
        segments = read_aem_segments(path)
    except ValueError as error:
        assert str(error).startswith(f"{path}: line ")
        return None
    for segment in segments:
        samples = segment.samples
        assert np.isfinite(samples.times).all() and np.all(np.diff(samples.times) >= 0)
        assert np.abs(np.linalg.norm(samples.attitude, axis=1) - 1).max() < 1e-14
        assert samples.angular_velocity.shape == (len(samples), 3)
        assert np.isfinite(samples.angular_velocity).all() or np.isnan(samples.angular_velocity).all()
    return segments


@BOUNDED
@given(data=st.binary(max_size=400))
def test_bytes_are_refused_in_one_line(tmp_path, data):
    assert read(tmp_path / "x.aem", data) is None


@BOUNDED
@given(changes=st.lists(st.tuples(st.integers(0, len(MESSAGE)), st.integers(0, 60), st.sampled_from(PIECES)), min_size=1, max_size=4))
def test_message_with_pieces_changed_is_a_message_or_refused(tmp_path, changes):
    text = MESSAGE
    for place, removed, piece in changes:
        text = text[:place] + piece + text[place + removed :]
    read(tmp_path / "x.aem", text.encode())


@BOUNDED
@given(
    changes=st.lists(
        st.tuples(
            st.integers(0, len(XML)),
            st.integers(0, 60),
            st.sampled_from([*PIECES, "<", ">", "/>", "<QC>", "</QC>", "&amp;", "&a;", "<!DOCTYPE a>", "<![CDATA[", "]]>"]),
        ),
        min_size=1,
        max_size=4,
    )
)
def test_document_with_pieces_changed_is_a_message_or_refused(tmp_path, changes):
    text = XML
    for place, removed, piece in changes:
        text = text[:place] + piece + text[place + removed :]
    read(tmp_path / "x.xml", text.encode())


@BOUNDED
@given(
    name=st.sampled_from(sorted(FIELDS)),
    system=st.sampled_from(["UTC", "TAI", "TDB", "TCB", "UT1"]),
    lines=st.lists(st.tuples(EPOCHS, st.lists(NUMBERS, max_size=9)), max_size=4),
    data=st.data(),
)
def test_records_of_any_type_are_read_or_refused(tmp_path, name, system, lines, data):
    if data.draw(st.booleans()):  # as many numbers as the type has
        lines = [(epoch, data.draw(st.lists(NUMBERS, min_size=len(FIELDS[name]), max_size=len(FIELDS[name])))) for epoch, _ in lines]
    text = MESSAGE.replace("QUATERNION/ANGVEL", name).replace("= TDB", f"= {system}").replace("INTERPOLATION", "EULER_ROT_SEQ = ZXZ\nINTERPOLATION", 1)
    if name in VERSION_1 and data.draw(st.booleans()):
        text = (
            text.replace("= 2.0", "= 1.0")
            .replace("MESSAGE_ID = 1\n", "")
            .replace("ANGVEL_FRAME = SC_BODY_1\n", "QUATERNION_TYPE = FIRST\nATTITUDE_DIR = B2A\n")
        )
    text = text[: text.index("2000-01-01T12:00:00 0")] + "".join(f"{epoch} {' '.join(numbers)}\n" for epoch, numbers in lines) + "DATA_STOP\n"
    read(tmp_path / "x.aem", text.encode())


def test_message_that_is_whole_is_read(tmp_path):
    assert len(read(tmp_path / "x.aem", MESSAGE.encode())) == len(read(tmp_path / "x.xml", XML.encode())) == 1
