"""Fixtures: a wobbling body, the repository, the reference solutions and what computes them."""

import json
import os
import sys
from pathlib import Path

import pytest

import andoyer

REPOSITORY = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(REPOSITORY / "tests" / "reference"))
REFERENCE = json.loads((REPOSITORY / "tests/data/torque_free.json").read_text(encoding="utf-8"))


def _refused(report):
    """The same report, failed if it skips for want of a package where none may be missing: with CI set."""
    if report.skipped and os.environ.get("CI") and "could not import" in str(report.longrepr):
        report.outcome, report.longrepr = "failed", f"with CI set every optional package must be there: {report.longrepr[2]}"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    return _refused((yield))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    return _refused((yield))


@pytest.fixture(scope="session")
def body():
    return andoyer.Body([1.0, 1.5, 2.0])


@pytest.fixture(scope="session")
def scene(body):
    return andoyer.Scene(body, [0.1, -0.2, 0.3, 0.9273618495495703], [0.1, 0.2, 1.0], epoch=2.0, name="wobble")


@pytest.fixture(scope="session")
def motion(scene):
    return scene.solve()


@pytest.fixture
def furnished():
    """Loads kernels of SPICE with their text kernels, and leaves none."""
    spice = pytest.importorskip("spiceypy")

    def load(*paths):
        for path in map(Path, paths):
            spice.furnsh(str(path))
            spice.furnsh(str(path.with_suffix(".tsc" if path.suffix == ".bc" else ".tf")))

    yield load
    spice.kclear()
