"""The contents of an AEM as texts, the same for both notations, with the keywords of each version."""

from dataclasses import dataclass, field

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


@dataclass
class Record:
    """One data line: its position, its epoch, its values by position (KVN) or by name (XML)."""

    where: str
    epoch: str
    values: list[str] | dict[str, str]


@dataclass
class RawSegment:
    """A segment: its start, metadata, comments and records."""

    where: str
    metadata: dict[str, str] = field(default_factory=dict)
    comments: list[str] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)


@dataclass
class RawMessage:
    """A message: version, header, segments."""

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
        known = HEADER_OF if given is self.header else METADATA_OF
        if key not in known[self.version]:
            others = [version for version, keys in known.items() if key in keys]
            raise ValueError(
                f"{where}: {key} is no keyword of {'the header' if given is self.header else 'the metadata'} in version {self.version}"
                + "".join(f" (it is in {version})" for version in others)
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
        known = HEADER_OF if given is self.header else METADATA_OF
        missing = [key for key, needed in known[self.version].items() if needed and key not in given]
        if missing:
            raise ValueError(f"{where}: {', '.join(missing)} must be given")


def version_of(text: str, where: str) -> str:
    """The version of a message, 1.0 or 2.0.

    Raises
    ------
    ValueError
        Another version.
    """
    if text not in HEADER_OF:
        raise ValueError(f"{where}: CCSDS_AEM_VERS must be 1.0 or 2.0: got {text!r}")
    return text
