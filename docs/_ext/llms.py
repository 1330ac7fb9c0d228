"""Sphinx extension: llms.txt in the site, which lists the pages in the order of the contents, each with its headings."""

from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment


def headings(env: BuildEnvironment, page: str) -> list[str]:
    """The headings of the second level of a page."""
    titles = [item for item in env.tocs[page].children if isinstance(item, nodes.list_item)]
    inner = [item for title in titles for part in title.children if isinstance(part, nodes.bullet_list) for item in part.children]
    return [item.next_node(nodes.reference).astext() for item in inner if isinstance(item, nodes.list_item) and item.next_node(nodes.reference)]


def line(env: BuildEnvironment, page: str) -> str:
    """A page with its headings."""
    below = "; ".join(headings(env, page))
    return f"- [{env.titles[page].astext()}]({page}.html)" + (f": {below}" if below else "")


def written(env: BuildEnvironment, root: str) -> str:
    """The text of llms.txt, from the lists of contents of the first page."""
    first = env.get_doctree(root)
    parts = [f"# {env.titles[root].astext()}", f"> {first.next_node(nodes.paragraph).astext()}"]
    for contents in first.findall(addnodes.toctree):
        pages = [page for _, entry in contents["entries"] if entry in env.titles for page in (entry, *env.toctree_includes.get(entry, []))]
        parts += [f"## {contents['caption']}", "\n".join(line(env, page) for page in pages)]
    return "\n\n".join(parts) + "\n"


def write(app: Sphinx, problem: Exception | None) -> None:
    if problem is None and app.builder.name == "html":
        (Path(app.outdir) / "llms.txt").write_text(written(app.env, app.config.root_doc), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("build-finished", write)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
