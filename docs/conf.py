"""The documentation site: `make docs` builds it, every warning is an error, and the network is not used."""

import sys
from pathlib import Path

import matplotlib

import andoyer

DOCS = Path(__file__).parent
sys.path[:0] = [str(DOCS / "_ext"), str(DOCS.parent / "benches")]
matplotlib.use("Agg")

project = "andoyer"
author = copyright = "The andoyer developers"
version = release = andoyer.__version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "matplotlib.sphinxext.plot_directive",
    "equations",
    "cards",
    "llms",
    "measured",
    "unbroken",
]
exclude_patterns = ["_ext", "playground", "requirements.txt", "gallery/*.ipynb", "gallery/*.py", "**/sg_execution_times.rst", "sg_execution_times.rst"]
default_role = "py:obj"

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_fence_as_directive = ["equation", "math", "measured"]
myst_heading_anchors = 3

html_theme = "furo"
html_title = "andoyer"
html_math_renderer = "mathml"
html_static_path = ["_static"]
html_favicon = "_static/favicon.svg"
html_logo = html_favicon
html_css_files = ["site.css"]
PLAYGROUND = DOCS.parent / "target" / "playground"
if PLAYGROUND.exists():
    tags.add("playground")  # noqa: F821  # Sphinx defines it
    html_extra_path = [str(PLAYGROUND)]
html_show_sourcelink = False
html_copy_source = False

autodoc_member_order = "groupwise"
autodoc_typehints = "none"
autodoc_mock_imports = ["jax"]
napoleon_google_docstring = False
napoleon_use_rtype = False

plot_include_source = True
plot_html_show_source_link = False
plot_html_show_formats = False
plot_formats = [("png", 110)]

sphinx_gallery_conf = {
    "examples_dirs": "../examples/gallery",
    "gallery_dirs": "gallery",
    "within_subsection_order": "cards.ByNumber",
    "filename_pattern": "/plot_",
    "image_scrapers": ("matplotlib",),
    "abort_on_example_error": True,
    "only_warn_on_example_error": False,
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "remove_config_comments": True,
    "matplotlib_animations": False,
    "default_thumb_file": None,
    "thumbnail_size": (800, 560),
}


def setup(app):
    """Keep the docstrings of attributes unchanged, because napoleon interprets the text before a colon as a type."""
    kept = {}

    def keep(_app, what, name, _obj, _options, lines):
        if what in ("attribute", "property"):
            kept[name] = list(lines)

    def restore(_app, _what, name, _obj, _options, lines):
        if name in kept:
            lines[:] = kept.pop(name)

    app.connect("autodoc-process-docstring", keep, priority=400)
    app.connect("autodoc-process-docstring", restore, priority=600)
