"""A fault of this package is an `Error` like others, that programs can catch, and not PyO3's `PanicException`."""

import pytest

import andoyer
from andoyer import _core


def test_a_panic_is_an_internal_error_that_says_so(capfd):
    with pytest.raises(andoyer.InternalError, match="^a fault of this package, please report it: index 7$") as caught:
        _core._panic("index 7")
    assert isinstance(caught.value, andoyer.Error)
    assert "index 7" in capfd.readouterr().err
    assert "_panic" not in andoyer.__all__
