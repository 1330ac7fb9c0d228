"""The contents of an attitude or orbit ephemeris message (AEM, OEM) as texts, the same for both notations, with the keywords of each version."""

from dataclasses import dataclass, field
from typing import TypeAlias

Keywords: TypeAlias = dict[str, bool]

HEADER = {"CREATION_DATE": True, "ORIGINATOR": True}
METADATA = {
    "OBJECT_NAME": True,
    "OBJECT_ID": True,
    "CENTER_NAME": False,
    "REF_FRAME_A": True,
    "REF_FRAME_B": True,
    "TIME_SYSTEM": True,
    "START_TIME": True,
    "USEABLE_START_TIME": False,
    "USEABLE_STOP_TIME": False,
    "STOP_TIME": True,
    "ATTITUDE_TYPE": True,
    "EULER_ROT_SEQ": False,
    "INTERPOLATION_METHOD": False,
    "INTERPOLATION_DEGREE": False,
}
"""Keywords of both versions, and whether they must be given (504.0-B-2, tables 4-2 and 4-3)."""

HEADER_OF = {"1.0": HEADER, "2.0": HEADER | {"CLASSIFICATION": False, "MESSAGE_ID": False}}
METADATA_OF = {
    "1.0": METADATA | {"ATTITUDE_DIR": True, "QUATERNION_TYPE": False, "RATE_FRAME": False},
    "2.0": METADATA | {"ANGVEL_FRAME": False},
}

METADATA_OF_ORBIT = {
    "OBJECT_NAME": True,
    "OBJECT_ID": True,
    "CENTER_NAME": True,
    "REF_FRAME": True,
    "TIME_SYSTEM": True,
    "START_TIME": True,
    "USEABLE_START_TIME": False,
    "USEABLE_STOP_TIME": False,
    "STOP_TIME": True,
    "INTERPOLATION": False,
    "INTERPOLATION_DEGREE": False,
}
"""Keywords of all versions of an OEM, and whether they must be given (502.0-B-3, tables 5-2 and 5-3)."""


@dataclass(frozen=True)
class Kind:
    """What differs between the messages: names, keywords by version, the form of the data."""

    name: str
    header: dict[str, Keywords]
    metadata: dict[str, Keywords]
    state: str
    """The XML element of a record."""
    marked: bool
    """Data stand between DATA_START and DATA_STOP, and in XML in an element within `state`; otherwise they follow META_STOP, and covariances may follow them."""
    units: dict[str, str] = field(default_factory=dict)
    """The unit of each value in XML, where one may be stated."""

    @property
    def keyword(self) -> str:
        """The first keyword, that of the version."""
        return f"CCSDS_{self.name}_VERS"


AEM = Kind("AEM", HEADER_OF, METADATA_OF, "attitudeState", True)
OEM = Kind(
    "OEM",
    {"1.0": HEADER, "2.0": HEADER, "3.0": HEADER_OF["2.0"]},
    {"1.0": METADATA_OF_ORBIT} | dict.fromkeys(("2.0", "3.0"), METADATA_OF_ORBIT | {"REF_FRAME_EPOCH": False}),
    "stateVector",
    False,
    {name + dots: unit for dots, unit in {"": "km", "_DOT": "km/s", "_DDOT": "km/s**2"}.items() for name in "XYZ"},
)


@dataclass
class Record:
    """One data line: its position, its epoch, its values by position (KVN) or by name (XML)."""

    where: str
    epoch: str
    values: list[str] | dict[str, str]


@dataclass
class RawSegment:
    """A segment: its start, metadata, comments, records, and where its covariances are."""

    where: str
    metadata: dict[str, str] = field(default_factory=dict)
    comments: list[str] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)
    covariances: list[str] = field(default_factory=list)


@dataclass
class RawMessage:
    """A message: its kind, version, header, segments."""

    kind: Kind
    version: str
    header: dict[str, str] = field(default_factory=dict)
    segments: list[RawSegment] = field(default_factory=list)

    def put(self, given: dict[str, str], key: str, value: str, where: str) -> None:
        """Add a keyword of the header or of the metadata. It must be new and belong to the version.

        Raises
        ------
        ValueError
            The keyword is unknown, repeated or without a value.
        """
        known = self._known(given)
        if key not in known[self.version]:
            others = [version for version, keys in known.items() if key in keys]
            raise ValueError(
                f"{where}: {key} is no keyword of {'the header' if given is self.header else 'the metadata'} in version {self.version}"
                + (f" (it is in {', '.join(others)})" if others else "")
            )
        if key in given:
            raise ValueError(f"{where}: {key} is given twice")
        if not value:
            raise ValueError(f"{where}: {key} has no value")
        given[key] = value

    def complete(self, given: dict[str, str], where: str) -> None:
        """Check that nothing is missing.

        Raises
        ------
        ValueError
            A mandatory keyword is missing.
        """
        known = self._known(given)
        missing = [key for key, needed in known[self.version].items() if needed and key not in given]
        if missing:
            raise ValueError(f"{where}: {', '.join(missing)} must be given")

    def _known(self, given: dict[str, str]) -> dict[str, Keywords]:
        return self.kind.header if given is self.header else self.kind.metadata


def message_of(kind: Kind, version: str, where: str) -> RawMessage:
    """A message of that version without contents.

    Raises
    ------
    ValueError
        Another version.
    """
    if version not in kind.header:
        *others, last = kind.header
        raise ValueError(f"{where}: {kind.keyword} must be {', '.join(others)} or {last}: got {version!r}")
    return RawMessage(kind, version)
