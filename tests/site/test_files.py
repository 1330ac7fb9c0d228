"""Checks of the files of the built site: every link has a target, and no page loads files from elsewhere. They need no browser; `make docs` builds the site."""

import re
import shutil
from urllib.parse import unquote

import pytest
from conftest import SITE

PAGES = sorted(path for path in SITE.rglob("*.html") if "rust" not in path.parts and "_static" not in path.parts)
PLACE = re.compile(r'href="([^"#?:]*)#([^"]+)"')


def test_the_site_is_built():
    assert {"index.html", "start.html", "theory.html", "architecture.html"} <= {path.name for path in PAGES}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(SITE)))
def test_every_link_within_the_site_leads_somewhere(page):
    text = page.read_text(encoding="utf-8")
    targets = re.findall(r'(?:href|src)="([^"#?:]+)(?:[#?][^"]*)?"', text)
    assert [target for target in targets if not page.parent.joinpath(target).exists()] == []


def test_every_place_in_a_page_that_a_link_names_exists():
    texts = {page.resolve(): page.read_text(encoding="utf-8") for page in PAGES}
    names = {page: set(re.findall(r'\b(?:id|name)="([^"]+)"', text)) for page, text in texts.items()}
    links = [
        (page, (page.parent / target).resolve() if target else page, unquote(place)) for page, text in texts.items() for target, place in PLACE.findall(text)
    ]
    assert len(links) > 1000
    assert [(page.name, target.name, place) for page, target, place in links if target in names and place not in names[target]] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(SITE)))
def test_page_fetches_nothing_from_elsewhere(page):
    text = page.read_text(encoding="utf-8")
    assert re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="(?:https?:)?//[^"]*"', text) == []


def test_a_card_of_the_gallery_says_one_sentence():
    said = re.findall(r'class="sphx-glr-thumbcontainer" tooltip="([^"]+)"', (SITE / "gallery/index.html").read_text(encoding="utf-8"))
    assert len(said) > 10
    assert [text for text in said if re.search(r"[.?!] [A-Z]", text)] == []


def test_numbers_and_short_cells_stay_in_one_piece():
    page = (SITE / "gravity-gradient.html").read_text(encoding="utf-8")
    assert '<span class="unbroken">1e-4</span>' in page
    assert re.search(r'<td class="unbroken"><p>[\d.]+e-\d+</p></td>', page)


def test_llms_txt_lists_every_page_with_its_headings():
    text = (SITE / "llms.txt").read_text(encoding="utf-8")
    lines = dict(re.findall(r"^- \[[^\]]+\]\(([^)]+)\)(?:: (.*))?$", text, re.MULTILINE))
    assert text.startswith("# andoyer\n\n> How a rigid body turns") and "\n## Use\n" in text
    others = {"index.html", "search.html", "genindex.html", "py-modindex.html"}
    pages = {str(page.relative_to(SITE)) for page in PAGES if page.parent.name not in ("pages", "playground")}
    assert pages - others == set(lines)
    assert lines["start.html"].split("; ")[:2] == ["An answer", "Its error"]


def test_the_table_of_what_is_verified_has_each_test_file_with_its_claim():
    page = (SITE / "verified.html").read_text(encoding="utf-8")
    rows = re.findall(r"<tr[^>]*>\s*<td.*?</tr>", page, re.DOTALL)
    cells = [[re.sub(r"<[^>]+>", "", cell).strip() for cell in re.findall(r"<td.*?>(.*?)</td>", row, re.DOTALL)] for row in rows]
    files = {cell[2]: cell for cell in cells}
    root = SITE.parents[1]
    assert {path.name for path in (root / "crates/py/tests").glob("test_*.py")} <= set(files)
    assert {path.name for path in (root / "tests/tests").glob("*.rs")} - set(files) == {"main.rs"}
    assert all(len(claim) > 20 and int(tests) > 0 for _, claim, _, tests in cells)
    assert files["oracle.rs"][1] == "P_n from the energy integral (theory §5), which knows nothing of Lie transforms."


def tables_of(page):
    """The names of the tables of figures on a page."""
    return [name for name in re.findall(r"```measured\n(.+)\n```", page.read_text(encoding="utf-8")) if name != "verified"]


MEASURED = [page for page in sorted((SITE.parents[1] / "docs").glob("*.md")) if tables_of(page)]


@pytest.mark.parametrize("page", MEASURED, ids=lambda page: page.stem)
def test_each_table_of_figures_says_date_and_commit(page):
    built = (SITE / f"{page.stem}.html").read_text(encoding="utf-8")
    assert len(re.findall(r"<p>Measured on \d{4}-\d\d-\d\d at commit [0-9a-f]{7,}\b", built)) == len(tables_of(page))


@pytest.fixture
def measured(monkeypatch):
    monkeypatch.syspath_prepend(SITE.parents[1] / "benches")
    monkeypatch.syspath_prepend(SITE.parents[1] / "docs" / "_ext")
    import measured

    return measured


def test_a_number_is_kept_in_one_piece_and_a_commit_is_no_number(monkeypatch):
    monkeypatch.syspath_prepend(SITE.parents[1] / "docs" / "_ext")
    import unbroken

    assert unbroken.NUMBER.split("below 1.05e-3 at 17f2e946") == ["below ", "1.05e-3", " at 17f2e946"]


def test_how_long_ago_a_commit_was(measured):
    assert measured.since("HEAD") == ", 0 commits ago"
    assert measured.since("0000000") == ""


def test_a_file_of_figures_without_an_origin_or_with_another_one_is_named(measured, monkeypatch, tmp_path):
    with pytest.raises(LookupError, match="none.csv has no row in provenance.csv"):
        measured.origins(["bench.csv", "none.csv"])
    data = shutil.copytree(measured.DATA, tmp_path / "data")
    (data / "bench.csv").write_text("task\n", encoding="utf-8")
    monkeypatch.setattr(measured, "DATA", data)
    with pytest.raises(LookupError, match="bench.csv is not the file that was measured on"):
        measured.origins(["bench.csv"])
