"""Sphinx extension: mathematics as MathML. Browsers draw MathML without a script, a font or a server.

LaTeX is converted by latex2mathml while the pages are built. The tests execute the blocks marked `equation` (`printed`). LaTeX that cannot be converted is a warning.
"""

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from printed import display
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

logger = logging.getLogger(__name__)
OUTSIDE = re.compile(r"\[([^\]]*)\]\(\.\./([^)]*)\)")


class Equation(SphinxDirective):
    """A block of equations in the notation that the tests read."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        try:
            text = display(list(self.content))
        except (IndexError, ValueError) as error:
            raise self.error(f"equation: {error}") from error
        block = nodes.math_block(text, text, nowrap=True, number=None, label=None)
        self.set_source_info(block)
        return [block]


def mathml(node: nodes.Element, kind: str) -> str:
    """A node as MathML. LaTeX that is not converted would keep its backslash, which is detected."""
    text = node.astext().replace("{aligned}", "{align*}")
    result = convert(text, display=kind)
    if "\\" in result or "<mi>&</mi>" in result:
        logger.warning("LaTeX that is not understood: %s", text, location=node)
    return result


def inline(self: Any, node: nodes.Element) -> None:
    self.body.append(mathml(node, "inline"))
    raise nodes.SkipNode


def block(self: Any, node: nodes.Element) -> None:
    self.body.append(f'<div class="math">{mathml(node, "block")}</div>\n')
    raise nodes.SkipNode


def without_links_outside(app: Sphinx, docname: str, source: list[str]) -> None:
    """Replace links to files outside docs/ by the names of the files; these links work in the repository but not on the site."""
    if app.env.doc2path(docname).suffix == ".md":
        source[0] = OUTSIDE.sub(r"\1 (`\2`)", source[0])


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_directive("equation", Equation)
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    app.connect("source-read", without_links_outside)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
