"""The pages of documentation say nothing in Python that is not run. Sphinx runs the scripts of the gallery, and tests/site reads their pages."""

import re

import pytest
from conftest import REPOSITORY

pytest.importorskip("matplotlib")
SCRIPTS = sorted((REPOSITORY / "examples/gallery").glob("*.py"), key=lambda path: int(path.stem.split("_")[1]))
PAGES = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]


def test_there_are_the_twenty_of_them():
    assert [path.stem.split("_", 2)[2] for path in SCRIPTS] == [
        "earth_wobble",
        "eros_separatrix",
        "apophis",
        "box_satellite",
        "normal_form",
        "ensemble",
        "kernel",
        "libration_points",
        "periods",
        "toutatis_fit",
        "light_curve",
        "satellite_month",
        "librations",
        "nutation",
        "cassini",
        "methods",
        "locked",
        "dead_satellite",
        "flyby",
        "relaxation",
        "satellite_years",
        "yorp_cycles",
        "cubesats",
        "saturn_moons",
    ]


def test_the_table_of_the_readme_is_that_of_the_files(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "benches")
    import report

    written = report.summary(*map(report.read, ("bench", "work-precision", "stress")))
    assert f"{report.MARKS[0]}\n\n{written}\n\n{report.MARKS[1]}" in PAGES[0].read_text(encoding="utf-8")


def test_the_tables_of_the_page_of_speed_are_those_of_the_files(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "benches")
    import report

    page = (REPOSITORY / "docs/speed.md").read_text(encoding="utf-8")
    assert report.rivals_table(report.against_rivals()) in page
    assert report.at_equal_error(report.read("work-precision")) in page
    assert report.by_task(report.read("bench")) in (REPOSITORY / "benches/README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("given", "shown"),
    [("1.0e1", "10"), ("2.8e0", "2.8"), ("-1.5e+04", "-15,000"), ("3.0e-2", "0.030"), ("1.05e-3", "1.05e-3"), ("4e-08", "4e-8"), ("2 of 3", "2 of 3")],
)
def test_a_number_has_an_exponent_only_where_it_needs_one(monkeypatch, given, shown):
    monkeypatch.syspath_prepend(REPOSITORY / "docs/_ext")
    pytest.importorskip("docutils")
    pytest.importorskip("sphinx")
    import measured

    assert measured.plain(given) == shown


def test_record_writes_both_files(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "examples")
    import demo

    monkeypatch.setattr(demo, "ENSEMBLE", (100, 2))
    (tmp_path / "docs/data").mkdir(parents=True)
    demo.record([["a body", "short-axis", "closed", "0.1", "–", "3", "1e-16", "1e-15", "3.0"]], tmp_path)
    assert (tmp_path / "docs/data/scenes.csv").read_text().splitlines()[1] == "a body,short-axis,closed,0.1,–,3,1e-16,1e-15,3.0"
    assert (tmp_path / "docs/data/ensemble.csv").read_text().splitlines()[2].startswith("100,2,2,")


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_python_on_a_page_is_a_doctest(page):
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert all(block.startswith(">>> ") for block in blocks)
