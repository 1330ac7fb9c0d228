"""The scripts of the gallery run as they are printed; the pages of documentation say nothing in Python that is not run."""

import os
import re
import subprocess
import sys

import pytest

from conftest import REPOSITORY

pytest.importorskip("matplotlib")
SCRIPTS = sorted((REPOSITORY / "examples/gallery").glob("*.py"))
PAGES = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]


def test_there_are_the_six_of_them():
    assert [path.stem[7:] for path in SCRIPTS] == ["earth_wobble", "eros_separatrix", "apophis", "box_satellite", "normal_form", "ensemble"]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_script_runs_and_says_something(script, tmp_path):
    environment = os.environ | {"MPLBACKEND": "Agg", "PYTHONWARNINGS": "ignore:FigureCanvasAgg:UserWarning"}
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.returncode == 0 and done.stdout, done.stderr
    assert "Warning" not in done.stderr.replace("UserWarning: FigureCanvasAgg", "")


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_python_on_a_page_is_a_doctest(page):
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert all(block.startswith(">>> ") for block in blocks)
