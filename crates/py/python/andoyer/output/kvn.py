"""Parser of the keyword = value notation of an AEM (504.0-B-2, section 6) and of an OEM (502.0-B-3, section 7)."""

import re

from andoyer.output.raw import Kind, RawMessage, RawSegment, Record, message_of

LINE_END = re.compile(r"\r\n|\n\r|\r|\n")
ASSIGNMENT = re.compile(r"([A-Z][A-Z0-9_]*)\s*=\s*(.*)", re.ASCII)


def parse_kvn(text: str, kind: Kind) -> RawMessage:
    """Parse the message of that kind in a text.

    Raises
    ------
    ValueError
        A line that the standard does not allow, with its number.
    """
    lines = [(number, line.strip()) for number, line in enumerate(LINE_END.split(text), 1) if line.strip()]
    if not lines:
        raise ValueError("line 1: the file is empty")
    key, value = _assignment(*lines[0])
    if key != kind.keyword:
        raise ValueError(f"line {lines[0][0]}: an {kind.name} must start with {kind.keyword}: got {key}")
    message = message_of(kind, value, f"line {lines[0][0]}")
    state: _State = _Header(message)
    for number, line in lines[1:]:
        state = state.take(number, line)
    state.end(lines[-1][0])
    return message


class _State:
    """A part of the message. It takes a line and returns the part of the next line."""

    def __init__(self, message: RawMessage):
        self.message = message

    def take(self, number: int, line: str) -> "_State":
        """The state after a line."""
        raise NotImplementedError

    def end(self, number: int) -> None:
        """The file ends after line `number`. This is an error, except after a complete segment."""
        raise ValueError(f"line {number}: the message ends here, in {self.named}")

    named = ""


class _Header(_State):
    named = "the header"

    def take(self, number: int, line: str) -> _State:
        if line == "META_START":
            self.message.complete(self.message.header, f"line {number}, header")
            return _Metadata(self.message, number)
        if not _is_comment(line):
            self.message.put(self.message.header, *_assignment(number, line), f"line {number}")
        return self


class _Metadata(_State):
    named = "the metadata"

    def __init__(self, message: RawMessage, number: int):
        super().__init__(message)
        self.segment = RawSegment(f"line {number}")
        message.segments.append(self.segment)

    def take(self, number: int, line: str) -> _State:
        if line == "META_STOP":
            self.message.complete(self.segment.metadata, f"line {number}, metadata")
            return _Before(self.message) if self.message.kind.marked else _Ephemeris(self.message)
        if _is_comment(line):
            self.segment.comments.append(line[len("COMMENT") :].strip())
        else:
            self.message.put(self.segment.metadata, *_assignment(number, line), f"line {number}")
        return self


class _Before(_State):
    named = "a segment without data"

    def take(self, number: int, line: str) -> _State:
        if line != "DATA_START":
            raise ValueError(f"line {number}: DATA_START must follow META_STOP: got {line[:40]!r}")
        return _Data(self.message)


class _Data(_State):
    named = "the data"

    def take(self, number: int, line: str) -> _State:
        if line == "DATA_STOP":
            return _After(self.message, line)
        self.record(number, line)
        return self

    def record(self, number: int, line: str) -> None:
        """Add a record or a comment to the segment."""
        segment = self.message.segments[-1]
        if _is_comment(line):
            segment.comments.append(line[len("COMMENT") :].strip())
        else:
            epoch, *values = line.split()
            segment.records.append(Record(f"line {number}", epoch, values))


class _Ephemeris(_Data):
    """The data of an OEM. The next segment, covariances or the end may follow each record."""

    def take(self, number: int, line: str) -> _State:
        if line == "META_START":
            return _Metadata(self.message, number)
        if line == "COVARIANCE_START":
            self.message.segments[-1].covariances.append(f"line {number}")
            return _Covariances(self.message)
        self.record(number, line)
        return self

    def end(self, number: int) -> None:
        pass


class _Covariances(_State):
    named = "the covariances"

    def take(self, number: int, line: str) -> _State:
        if line in ("META_START", "COVARIANCE_START"):
            raise ValueError(f"line {number}: COVARIANCE_STOP must precede {line}")
        return _After(self.message, line) if line == "COVARIANCE_STOP" else self


class _After(_State):
    """After the line `last` of a segment."""

    def __init__(self, message: RawMessage, last: str):
        super().__init__(message)
        self.last = last

    def take(self, number: int, line: str) -> _State:
        if line != "META_START":
            raise ValueError(f"line {number}: META_START or the end must follow {self.last}: got {line[:40]!r}")
        return _Metadata(self.message, number)

    def end(self, number: int) -> None:
        pass


def _is_comment(line: str) -> bool:
    return line == "COMMENT" or line.startswith("COMMENT ")


def _assignment(number: int, line: str) -> tuple[str, str]:
    match = ASSIGNMENT.fullmatch(line)
    if match is None:
        raise ValueError(f"line {number}: must be KEYWORD = value: got {line[:40]!r}")
    return match[1], " ".join(match[2].split())
