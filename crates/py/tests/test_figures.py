"""The figures of docs/data are those of one run: what `make report` refuses."""

import shutil

import pytest
from conftest import REPOSITORY


@pytest.fixture
def figures(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "benches")
    import figures

    return figures


@pytest.fixture
def data(tmp_path, figures):
    return shutil.copytree(figures.DATA, tmp_path / "data")


def test_figures_are_of_one_run(figures):
    assert figures.faults() == []


def test_every_target_has_its_files(figures):
    named = {name for names in figures.TARGETS.values() for name in names}
    assert named == {path.name for path in figures.DATA.glob("*.csv")} - {figures.PROVENANCE.name}


def replaced(file, old, new):
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_an_emptied_cell_is_found(figures, data):
    replaced(data / "ensemble.csv", "100000,", ",")
    assert figures.faults(data)[0] == "ensemble.csv, line 2: bodies is empty"
    assert "ensemble.csv is not the file that was measured on" in figures.faults(data)[1]


@pytest.mark.parametrize("column", ["processor", "commit", "compiler"])
def test_two_runs_are_found(figures, data, column):
    value = figures.provenance(data)["stress.csv"][column]
    replaced(data / figures.PROVENANCE.name, value, "another")
    assert figures.faults(data) == [f"the figures have several values of {column}: {', '.join(sorted(['another', value]))}"]


def test_changes_that_are_not_committed_are_found(figures, data):
    commit = figures.provenance(data)["stress.csv"]["commit"]
    file = data / figures.PROVENANCE.name
    file.write_text(file.read_text(encoding="utf-8").replace(commit, f"{commit}-dirty"), encoding="utf-8")
    assert f"bench.csv was measured with changes that are not committed: {commit}-dirty" in figures.faults(data)


def test_a_file_without_origin_and_one_that_is_gone_are_found(figures, data):
    (data / "ensemble.csv").rename(data / "more.csv")
    assert figures.faults(data) == ["more.csv has no row in provenance.csv: run `make figures`", "ensemble.csv is not there"]


def test_a_source_that_was_touched_is_found(figures, data, tmp_path):
    sources = shutil.copytree(REPOSITORY / "crates", tmp_path / "crates", ignore=shutil.ignore_patterns("__pycache__", "*.so", "target", ".*")).parent
    before = figures.sources(sources)
    assert before == figures.sources()
    file = sources / "crates/propagate/src/lib.rs"
    replaced(file, "\n", "\n// a comment\n")
    assert figures.sources(sources) == before
    replaced(file, "pub mod", "pub(crate) mod")
    rows = figures.provenance(data)
    after = figures.sources(sources)
    assert after != before
    assert len([fault for fault in figures.faults(data, after) if "other sources than those of today" in fault]) == len(rows)


def test_the_page_has_the_lines_that_are_run_with_heyoka(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "benches" / "rivals")
    import coming_from

    assert "heyoka.taylor_adaptive(" in coming_from.lines()
