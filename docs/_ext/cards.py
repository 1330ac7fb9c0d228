"""Sphinx extension: the gallery by the numbers in the names of its files, plot_2 before plot_10, with one sentence below each picture."""

import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

SAID = re.compile(r'(?<=tooltip=")(.+?[.?!:])(?= [A-Z]|").*?(?=")')
"""The first sentence of what a script says of itself, and the others."""


class ByNumber:
    """A key of sorting for sphinx-gallery."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __call__(self, name: str) -> int:
        return int(Path(name).stem.split("_")[1])


def one_sentence(_app: Sphinx, document: nodes.document) -> None:
    """Keep the first sentence of each card; the style sheet shows it."""
    for card in list(document.findall(nodes.raw)):
        if "sphx-glr-thumbcontainer" in card.astext():
            card.replace_self(nodes.raw("", SAID.sub(r"\1", card.astext()), format="html"))


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", one_sentence)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
