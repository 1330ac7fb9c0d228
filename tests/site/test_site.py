"""The built site in a real browser: no console errors, nothing fetched from elsewhere, equations drawn, pictures there. `make docs-test` builds it first."""

import functools
import http.server
import re
import threading
from pathlib import Path

import pytest

from browser import CHROMEDRIVER, Browser

SITE = Path(__file__).resolve().parents[2] / "target" / "site"
PAGES = sorted(str(path.relative_to(SITE)) for path in SITE.rglob("*.html") if "rust" not in path.parts and "_static" not in path.parts)
WITH_EQUATIONS = {"theory.html": 12, "errata.html": 4}
WITH_PICTURES = {"gallery/index.html": 6, "speed.html": 2, "series-or-closed.html": 1} | {
    page: 1 for page in PAGES if page.startswith("gallery/plot_")
}

pytestmark = pytest.mark.skipif(CHROMEDRIVER is None or not PAGES, reason="needs chromedriver and a built site: make docs-test")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def address():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SITE))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@pytest.fixture(scope="module")
def browser():
    browser = Browser()
    yield browser
    browser.close()


def test_a_console_error_and_a_missing_picture_would_be_seen(browser, address):
    assert browser.open(address + "start.html") == []
    browser.run("const image = new Image(); image.src = 'missing.png'; document.body.append(image); console.error('loud'); return image.decode().catch(() => null)")
    assert browser.run(BROKEN) == [address + "missing.png"]
    messages = " ".join(entry["message"] for entry in browser.said())
    assert "loud" in messages and "404" in messages


BROKEN = "return [...document.images].filter(image => !(image.complete && image.naturalWidth > 1)).map(image => image.src)"
ELSEWHERE = "return performance.getEntriesByType('resource').map(entry => entry.name).filter(name => !name.startsWith(location.origin) && !name.startsWith('data:'))"
EQUATIONS = """return [...document.querySelectorAll('math')].map(math => {
    const box = math.getBoundingClientRect();
    return [box.width, box.height, math.querySelectorAll('merror').length, math.textContent];
})"""
# A fraction that is drawn as one has its numerator above its denominator.
FRACTIONS = """return [...document.querySelectorAll('mfrac')].map(fraction => {
    const [above, below] = [...fraction.children].map(child => child.getBoundingClientRect());
    return above.bottom <= below.top + 1;
})"""


@pytest.mark.parametrize("page", PAGES)
def test_page_loads_without_a_word_and_with_its_pictures(browser, address, page):
    assert [entry["message"] for entry in browser.open(address + page)] == []
    browser.run("for (const image of document.images) image.loading = 'eager'")
    browser.run("return Promise.all([...document.images].map(image => image.decode().catch(() => null))).then(() => true)")
    assert browser.run(BROKEN) == []
    assert browser.run(ELSEWHERE) == []
    assert browser.run("return document.querySelectorAll('article img').length") >= WITH_PICTURES.get(page, 0)


@pytest.mark.parametrize("page", WITH_EQUATIONS)
def test_equations_are_drawn(browser, address, page):
    browser.open(address + page)
    equations = browser.run(EQUATIONS)
    assert len(equations) >= WITH_EQUATIONS[page]
    for width, height, errors, text in equations:
        assert width > 5 and height > 5 and errors == 0 and not set("\\&") & set(text), text
    fractions = browser.run(FRACTIONS)
    assert len(fractions) > 5 and all(fractions)


@pytest.mark.parametrize("crate, count", [("andoyer_series", 1), ("andoyer_propagate", 4)])
def test_front_pages_of_the_crates_have_their_equations(browser, address, crate, count):
    # rustdoc's own preloading is warned of.
    assert [entry for entry in browser.open(f"{address}rust/{crate}/index.html") if entry["level"] == "SEVERE"] == []
    equations = browser.run(EQUATIONS)
    assert len(equations) == count
    for width, height, errors, text in equations:
        assert width > 50 and height > 5 and errors == 0 and not set("\\&") & set(text), text


def test_every_link_within_the_site_leads_somewhere():
    for page in PAGES:
        text = (SITE / page).read_text(encoding="utf-8")
        for target in re.findall(r'href="([^"#?:]+)(?:#[^"]*)?"', text):
            assert (SITE / page).parent.joinpath(target).exists(), f"{page}: {target}"


def test_pages_fetch_nothing_from_elsewhere():
    for page in PAGES:
        text = (SITE / page).read_text(encoding="utf-8")
        assert not re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="https?://[^"]*"', text), page
