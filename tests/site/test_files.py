"""Checks of the files of the built site: every link has a target, and no page loads files from elsewhere. They need no browser; `make docs` builds the site."""

import re

import pytest
from conftest import SITE

PAGES = sorted(path for path in SITE.rglob("*.html") if "rust" not in path.parts and "_static" not in path.parts)


def test_the_site_is_built():
    assert {"index.html", "start.html", "theory.html", "architecture.html"} <= {path.name for path in PAGES}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(SITE)))
def test_every_link_within_the_site_leads_somewhere(page):
    text = page.read_text(encoding="utf-8")
    targets = re.findall(r'(?:href|src)="([^"#?:]+)(?:[#?][^"]*)?"', text)
    assert [target for target in targets if not page.parent.joinpath(target).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(SITE)))
def test_page_fetches_nothing_from_elsewhere(page):
    text = page.read_text(encoding="utf-8")
    assert re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="(?:https?:)?//[^"]*"', text) == []
