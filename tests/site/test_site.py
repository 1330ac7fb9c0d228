"""The built site in a real browser: no console errors, no external requests, equations and pictures drawn, no text outside its box."""

import pytest
from conftest import SITE

WIDTHS = (400, 1300)
PAGES = sorted(str(path.relative_to(SITE)) for path in SITE.rglob("*.html") if "rust" not in path.parts and "_static" not in path.parts)
SCRIPTS = sorted((SITE.parents[1] / "examples" / "gallery").glob("plot_*.py"))
WITH_EQUATIONS = {"theory.html": 12, "errata.html": 4}
WITH_PICTURES = {
    "index.html": 5,
    "nature.html": 2,
    "gravity-gradient.html": 2,
    "fits.html": 2,
    "gallery/index.html": len(SCRIPTS),
    "speed.html": 2,
    "series-or-closed.html": 1,
}

# Each page has an entry of the index for its words.
SOUGHT = {"libration": "locked.html", "YORP": "evolution.html", "light curve": "fits.html", "kernel": "files.html", "CubeSat": "satellite.html"}

BROKEN = "[...document.images].filter(image => !(image.complete && image.naturalWidth > 1)).map(image => image.src)"
# Code and output whose text is wider than its box.
OUTSIDE = """[...document.querySelectorAll('article pre')].filter(box => box.getClientRects().length && box.scrollWidth > box.clientWidth + 1)
    .map(box => box.textContent.slice(0, 80))"""
SIDEWAYS = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
EQUATIONS = """[...document.querySelectorAll('math')].map(math => {
    const box = math.getBoundingClientRect();
    return [box.width, box.height, math.querySelectorAll('merror').length, math.textContent];
})"""
# In a correctly drawn fraction the numerator is above the denominator.
FRACTIONS = """[...document.querySelectorAll('mfrac')].map(fraction => {
    const [above, below] = [...fraction.children].map(child => child.getBoundingClientRect());
    return above.bottom <= below.top + 1;
})"""
# Sphinx runs each script of the gallery once; its page has what the script wrote to both streams, warnings among them.
SAID = "[...document.querySelectorAll('.sphx-glr-script-out')].map(box => box.innerText)"
SHOWN = "[...new Set([...document.querySelectorAll('article img')].map(image => image.src).filter(src => src.includes('sphx_glr_')))]"


def test_a_console_error_a_missing_picture_and_a_line_outside_its_box_are_seen(visits):
    visit = visits(400)
    visit.open("start.html")
    assert visit.said == [] and visit.run(OUTSIDE) == []
    visit.run(
        """(() => { const image = new Image(); image.src = 'missing.png'; document.body.append(image); console.error('loud');
        const box = document.createElement('pre'); box.style.whiteSpace = 'pre'; box.style.overflow = 'auto'; box.textContent = 'x'.repeat(500);
        document.querySelector('article').append(box);
        return image.decode().catch(() => null); })()"""
    )
    assert visit.run(BROKEN) == [visit.address + "missing.png"]
    assert visit.run(OUTSIDE) == ["x" * 80]
    said = " ".join(text for _, text in visit.said)
    assert "loud" in said and "404" in said


@pytest.mark.parametrize("page", PAGES)
def test_page_loads_without_a_word_and_with_its_pictures(visits, page):
    visit = visits(1300)
    visit.open(page)
    assert visit.said == []
    assert visit.run(BROKEN) == []
    assert [url for url in visit.fetched if not url.startswith((visit.address, "data:"))] == []
    assert visit.run("document.querySelectorAll('article img').length") >= WITH_PICTURES.get(page, 0)


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("page", PAGES)
def test_no_line_of_code_or_output_runs_out_of_its_box(visits, page, width):
    visit = visits(width)
    visit.open(page)
    assert visit.run(OUTSIDE) == []
    assert visit.run(SIDEWAYS) <= 0


@pytest.mark.parametrize("page", PAGES)
def test_no_page_is_longer_than_twenty_windows(visits, page):
    visit = visits(1300)
    visit.open(page)
    assert visit.run("document.documentElement.scrollHeight") <= 20_000


@pytest.mark.parametrize("words, page", SOUGHT.items())
def test_search_finds_the_page_of_a_subject_first(visits, words, page):
    visit = visits(1300)
    visit.open(f"search.html?q={words.replace(' ', '+')}")
    visit.page.wait_for_selector(".search-summary")
    visit.page.wait_for_selector("#search-results li a")
    assert visit.run("document.querySelector('#search-results li a').getAttribute('href').split(/[?#]/)[0]") == page


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_script_of_the_gallery_says_something_without_a_warning_and_its_page_has_its_pictures(visits, script):
    visit = visits(1300)
    visit.open(f"gallery/{script.stem}.html")
    said = visit.run(SAID)
    assert any(said) and not [text for text in said if "Warning" in text]
    assert len(visit.run(SHOWN)) >= script.read_text(encoding="utf-8").count("plt.show()") > 0


def test_each_function_that_draws_has_its_picture(visits):
    from andoyer import plot

    visit = visits(1300)
    drawn = []
    for page in ("pictures.html", "pictures-orbits.html"):
        visit.open(page)
        drawn += visit.run("[...document.querySelectorAll('article img')].map(image => image.alt)")
    assert sorted(set(drawn)) == sorted(set(plot.__all__) - {"whole_turns", "page", "animate"})


@pytest.mark.parametrize("page", WITH_EQUATIONS)
def test_equations_are_drawn(visits, page):
    visit = visits(1300)
    visit.open(page)
    equations = visit.run(EQUATIONS)
    assert len(equations) >= WITH_EQUATIONS[page]
    for width, height, errors, text in equations:
        assert width > 5 and height > 5 and errors == 0 and not set("\\&") & set(text), text
    fractions = visit.run(FRACTIONS)
    assert len(fractions) > 5 and all(fractions)


@pytest.mark.parametrize("crate, count", [("andoyer_series", 1), ("andoyer_propagate", 4)])
def test_front_pages_of_the_crates_have_their_equations(visits, crate, count):
    visit = visits(1300)
    visit.open(f"rust/{crate}/index.html")
    assert [text for kind, text in visit.said if kind == "error"] == []
    equations = visit.run(EQUATIONS)
    assert len(equations) == count
    for width, height, errors, text in equations:
        assert width > 50 and height > 5 and errors == 0 and not set("\\&") & set(text), text
