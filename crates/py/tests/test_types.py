"""The stub held against the run time by mypy's own check, and the examples type-checked as a user would."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy")

from conftest import REPOSITORY

# Packages without types of their own; dask's and distributed's functions are untyped.
SETTINGS = """
[mypy]
strict = true
[mypy-erfa.*,spiceypy.*,pyarrow.*,scipy.*,matplotlib.*,mpmath.*,pandas.*,sympy.*,xarray.*,gravity_gradient,torque_free]
ignore_missing_imports = true
[mypy-cluster]
disallow_untyped_calls = false
"""
EXAMPLES = sorted(path for folder in ("examples", "examples/gallery") for path in (REPOSITORY / folder).glob("*.py"))


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    """One cache for all runs: NumPy's types are read once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MYPY_CACHE_DIR", str(tmp_path_factory.mktemp("mypy")))
        yield


def run(folder, *arguments):
    (folder / "mypy.ini").write_text(SETTINGS, encoding="utf-8")
    environment = os.environ | {"MYPYPATH": ""}
    return subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=folder, env=environment)


def test_stub_is_what_the_module_is(tmp_path):
    # PyO3's classes pickle by methods that no stub lists.
    allowed = tmp_path / "allowed"
    allowed.write_text(
        r"andoyer\._core\.\w+\._restored"
        + "\n"
        + r"andoyer\._core\.\w+\.__reduce__"
        + "\n"
        + r"andoyer\._core\.__all__"
        + "\n"
        + r"andoyer\._core\._panic"
        + "\n",
        encoding="utf-8",
    )
    done = run(
        tmp_path, "mypy.stubtest", "andoyer._core", "--concise", "--allowlist", str(allowed), "--ignore-unused-allowlist", "--mypy-config-file", "mypy.ini"
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_stub_that_is_wrong_would_be_seen(tmp_path):
    module = tmp_path / "wrong.py"
    module.write_text("def f(x): return x\n", encoding="utf-8")
    module.with_suffix(".pyi").write_text("def f(y: int) -> int: ...\n", encoding="utf-8")
    assert run(tmp_path, "mypy.stubtest", "wrong", "--concise").returncode == 1


def test_examples_are_clean_by_the_strict_rules(tmp_path):
    done = run(tmp_path, "mypy", "--config-file", "mypy.ini", *map(str, EXAMPLES))
    assert done.returncode == 0, done.stdout + done.stderr


def test_example_that_is_wrong_would_be_seen(tmp_path):
    script = Path(tmp_path / "wrong.py")
    script.write_text("import andoyer\nandoyer.Body.named(1).moments.nothing\n", encoding="utf-8")
    done = run(tmp_path, "mypy", "--config-file", "mypy.ini", str(script))
    assert done.returncode == 1 and done.stdout.count("error:") == 2


def test_package_is_clean_by_the_strict_rules(tmp_path):
    done = run(tmp_path, "mypy", "--config-file", "mypy.ini", "-p", "andoyer")
    assert done.returncode == 0, done.stdout + done.stderr
