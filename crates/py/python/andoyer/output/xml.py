"""Parser of the XML notation of an AEM (504.0-B-2, section 7) and of an OEM (502.0-B-3, section 8), by the standard library, without entities and document types.

It reads documents of all versions, and the messages of one kind in combined documents (`ndm`).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from andoyer.output.raw import Kind, RawMessage, RawSegment, Record, message_of

DEEPEST = 12
"""A message has its numbers eight elements deep; a document that goes deeper than this is none."""

ENCODINGS = ["UTF-8", "UTF-16", "US-ASCII", "ISO-8859-1"]
"""Those that the parser knows without looking for a codec."""

NAMES = {f"rotation{place}": place for place in (1, 2, 3)}
"""Version 1 has the angles and rates of a rotation in elements of one name."""


@dataclass
class Element:
    """An element: its name without a prefix, attributes, text, children, line."""

    name: str
    attributes: dict[str, str]
    line: int
    text: str = ""
    children: list["Element"] = field(default_factory=list)

    @property
    def where(self) -> str:
        """The position of the element, for messages."""
        return f"line {self.line}"

    def all(self, name: str) -> list["Element"]:
        """The children of that name."""
        return [child for child in self.children if child.name == name]

    def only(self, name: str) -> "Element":
        """The one child of that name."""
        found = self.all(name)
        if len(found) != 1:
            raise ValueError(f"{self.where}: {self.name} must have one element {name}: got {len(found)}")
        return found[0]


def parse_xml(data: bytes, kind: Kind) -> list[RawMessage]:
    """The messages of that kind in a document.

    Raises
    ------
    ValueError
        A text that is not XML; a document type, which may define entities; elements that the message does not have.
    """
    root = _tree(data)
    name = kind.name.lower()
    messages = [root] if root.name == name else root.all(name) if root.name == "ndm" else []
    if not messages:
        raise ValueError(f"{root.where}: the document must be an {name}, or an ndm with one in it: got {root.name}")
    return [_message(element, kind) for element in messages]


def _tree(data: bytes) -> Element:
    """The document as a tree of elements."""
    parser = expat.ParserCreate()
    top = Element("", {}, 0)
    path = [top]

    def start(name: str, attributes: dict[str, str]) -> None:
        if len(path) > DEEPEST:
            raise ValueError(f"line {parser.CurrentLineNumber}: elements must be at most {DEEPEST} deep")
        path.append(Element(name.rpartition(":")[2], attributes, parser.CurrentLineNumber))
        path[-2].children.append(path[-1])

    def end(_name: str) -> None:
        path.pop()

    def text(piece: str) -> None:
        path[-1].text += piece

    def refuse(*_: object) -> None:
        raise ValueError(f"line {parser.CurrentLineNumber}: a document type, and so an entity, is not read")

    def declared(_version: str, encoding: str | None, _standalone: int) -> None:
        if encoding is not None and encoding.upper() not in ENCODINGS:
            raise ValueError(f"line {parser.CurrentLineNumber}: the encoding must be {', '.join(ENCODINGS)}: got {encoding!r}")

    parser.XmlDeclHandler = declared
    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, text
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    parser.buffer_text = True
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ValueError(f"line {error.lineno}: must be XML: {expat.ErrorString(error.code)}") from error
    return top.children[0]


def _message(element: Element, kind: Kind) -> RawMessage:
    if element.attributes.get("id") != kind.keyword:
        raise ValueError(f'{element.where}: {element.name} must have the attribute id="{kind.keyword}"')
    message = message_of(kind, element.attributes.get("version", ""), element.where)
    header = element.only("header")
    for child in header.children:
        if child.name != "COMMENT":
            message.put(message.header, child.name, _value(child), child.where)
    message.complete(message.header, f"{header.where}, header")
    for segment in element.only("body").all("segment"):
        _segment(message, segment)
    return message


def _segment(message: RawMessage, element: Element) -> None:
    segment = RawSegment(element.where)
    metadata = element.only("metadata")
    for child in metadata.children:
        if child.name == "COMMENT":
            segment.comments.append(_value(child))
        else:
            message.put(segment.metadata, child.name, _value(child), child.where)
    message.complete(segment.metadata, f"{metadata.where}, metadata")
    for child in element.only("data").children:
        if child.name == "COMMENT":
            segment.comments.append(_value(child))
        elif child.name == "covarianceMatrix" and not message.kind.marked:
            segment.covariances.append(child.where)
        else:
            segment.records.append(_record(_state(child, message.kind), message.kind))
    message.segments.append(segment)


def _state(child: Element, kind: Kind) -> Element:
    """The element with the values of a record."""
    if child.name == kind.state and (len(child.children) == 1 or not kind.marked):
        return child.children[0] if kind.marked else child
    raise ValueError(f"{child.where}: data must have elements {kind.state}{' with one element in each' if kind.marked else ''}: got {child.name}")


def _record(state: Element, kind: Kind) -> Record:
    values: dict[str, str] = {}
    for name, leaf in _leaves(state, ""):
        if name in values:
            raise ValueError(f"{leaf.where}: {name} is given twice")
        values[name] = _value(leaf)
        unit = leaf.attributes.get("units", "")
        if unit and unit.lower() != kind.units.get(name, unit.lower()):
            raise ValueError(f"{leaf.where}: {name} must be in {kind.units[name]}: got {unit}")
    if "EPOCH" not in values:
        raise ValueError(f"{state.where}: {state.name} must have an EPOCH")
    return Record(state.where, values.pop("EPOCH"), values)


def _leaves(element: Element, group: str) -> Iterator[tuple[str, Element]]:
    """Name and element of those without children; those of version 1 of an AEM by the names of version 2."""
    for child in element.children:
        if child.children:
            yield from _leaves(child, child.name)
        elif child.name in NAMES:
            yield f"{'RATE' if group == 'rotationRates' else 'ANGLE'}_{NAMES[child.name]}", child
        elif child.name != "COMMENT":
            yield child.name, child


def _value(element: Element) -> str:
    if element.children:
        raise ValueError(f"{element.where}: {element.name} must have a value, not elements")
    return " ".join(element.text.split())
