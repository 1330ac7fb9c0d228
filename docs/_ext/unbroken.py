"""Sphinx extension: numbers such as 1.05e-3, and the short cells of tables, are not broken into two lines."""

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

NUMBER = re.compile(r"((?<!\w)[−-]?\d[\d.,]*e[−-]?\d+(?!\w))")
SHORT = 16
"""A cell with so many characters is not broken."""


def unbroken(_app: Sphinx, document: nodes.document) -> None:
    """Give the class `unbroken` to short cells, and to numbers with an exponent in running text."""
    for entry in document.findall(nodes.entry):
        if len(entry.astext()) <= SHORT:
            entry["classes"].append("unbroken")
    for text in list(document.findall(nodes.Text)):
        parent = text.parent
        whole = isinstance(parent, nodes.paragraph) and "unbroken" not in parent.parent.get("classes", [])
        if whole and NUMBER.search(text):
            parts = [nodes.inline(part, part, classes=["unbroken"]) if NUMBER.fullmatch(part) else nodes.Text(part) for part in NUMBER.split(text) if part]
            parent.replace(text, parts)


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", unbroken)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
