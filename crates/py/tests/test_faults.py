"""A fault of this package is an `Error` like others, that programs can catch, and not PyO3's `PanicException`."""

from pathlib import Path

import pytest

import andoyer
from andoyer import _core

SOURCES = Path(__file__).parents[1] / "src"


def test_a_panic_is_an_internal_error_that_says_so(capfd):
    with pytest.raises(andoyer.InternalError, match="^a fault of this package, please report it: index 7$") as caught:
        _core._panic("index 7")
    assert isinstance(caught.value, andoyer.Error)
    assert "index 7" in capfd.readouterr().err
    assert "_panic" not in andoyer.__all__


def test_everything_that_computes_without_the_lock_does_so_where_panics_are_caught():
    users = [path.name for path in sorted(SOURCES.glob("*.rs")) if ".detach(" in path.read_text(encoding="utf-8")]
    assert users == ["birkhoff.rs", "computing.rs"]  # the first for its text, which cannot fail
