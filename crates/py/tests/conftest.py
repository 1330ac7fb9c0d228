"""Fixtures: a wobbling body, the repository, the reference solutions and what computes them."""

import json
import sys
from pathlib import Path

import pytest

import andoyer

REPOSITORY = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(REPOSITORY / "tests" / "reference"))
REFERENCE = json.loads((REPOSITORY / "tests/data/torque_free.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def body():
    return andoyer.Body([1.0, 1.5, 2.0])


@pytest.fixture(scope="session")
def scene(body):
    return andoyer.Scene(body, [0.1, -0.2, 0.3, 0.9273618495495703], [0.1, 0.2, 1.0], epoch=2.0, name="wobble")


@pytest.fixture(scope="session")
def motion(scene):
    return scene.solve()
