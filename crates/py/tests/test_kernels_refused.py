"""Kernels that are refused, before anything is written: names, codes, frames, intervals and errors that SPICE or its clock cannot have."""

from datetime import datetime

import pytest
from test_kernels_together import TUMBLER, spice

import andoyer
from andoyer.output import Kernel, write_ck, write_pck


def test_error_below_the_rounding_of_the_times_is_refused(tmp_path):
    for write, name in ((write_ck, "a.bc"), (write_pck, "a.bpc")):
        with pytest.raises(andoyer.InputError, match="interpolation_error must be above the rounding error of this motion"):
            write(tmp_path / name, TUMBLER, (1e9, 1e9 + 30.0), interpolation_error=1e-12)
    assert list(tmp_path.iterdir()) == []


def test_interval_that_the_clock_does_not_hold_is_refused(tmp_path):
    with pytest.raises(andoyer.InputError, match="interval must be from .* the times of the clock; give a clock kernel"):
        write_ck(tmp_path / "a.bc", TUMBLER, (-8e10, -7.99e10))
    assert list(tmp_path.iterdir()) == []


WRONG = {
    "long": {"body_frame": "A" * 27},
    "lower case": {"body_frame": "tumbler"},
    "blank": {"body_frame": "MY BODY"},
    "quote": {"body_frame": "MY'BODY"},
    "empty": {"body_frame": ""},
    "not ASCII": {"body_frame": "KÖRPER"},
    "digit first": {"body_frame": "1BODY"},
    "inertial": {"body_frame": "J2000"},
    "rotating": {"body_frame": "IAU_MARS"},
    "of the Earth": {"body_frame": "ITRF93"},
    "code 0": {"instrument": 0},
    "planet": {"instrument": 399},
    "frame of SPICE": {"instrument": 10013},
    "rotating frame": {"frame": "IAU_EARTH"},
    "lower-case frame": {"frame": "j2000"},
    "long segment": {"segment": "x" * 41},
    "blank segment": {"segment": "  "},
    "clock": {"clock_id": 5},
}


@pytest.mark.parametrize("given", WRONG.values(), ids=WRONG)
def test_name_or_code_that_spice_cannot_use_is_refused_before_anything_is_written(given, tmp_path):
    (key, value), *_ = given.items()
    with pytest.raises(andoyer.InputError, match=f"^{key} must be ") as caught:
        write_ck(tmp_path / "a.bc", TUMBLER, (0.0, 1.0), Kernel(**given))
    assert caught.value.argument == key and str(value) in str(caught.value.value)
    assert list(tmp_path.iterdir()) == []


def test_every_frame_and_code_of_spice_itself_is_refused(tmp_path):
    for number in spice.bltfrm(-1):
        name, (_, kind, code) = spice.frmnam(int(number)), spice.frinfo(int(number))
        plain = name.replace("-", "_") == name and name[0].isalpha()
        with pytest.raises(andoyer.InputError, match="SPICE has not taken" if plain else "capital letters"):
            write_ck(tmp_path / "a.bc", TUMBLER, (0.0, 1.0), Kernel(body_frame=name))
        if kind == 2:
            with pytest.raises(andoyer.InputError):
                write_pck(tmp_path / "a.bpc", TUMBLER, (0.0, 1.0), body=int(code))
    assert list(tmp_path.iterdir()) == []


def test_intervals_and_codes_that_no_kernel_has_are_typed_errors(tmp_path):
    with pytest.raises(andoyer.InputError, match="interval must be two finite times"):
        write_pck(tmp_path / "a.bpc", TUMBLER, (0, 1e-8), date=datetime(2026, 1, 1))
    for interval in ((0.0,), (0.0, 1.0, 2.0), None, "now"):
        with pytest.raises(andoyer.InputError, match="interval"):
            write_ck(tmp_path / "a.bc", TUMBLER, interval)
    for write, name in ((write_ck, "a.bc"), (write_pck, "a.bpc")):
        with pytest.raises(andoyer.InputError, match="interpolation_error must be so large that at most"):
            write(tmp_path / name, TUMBLER, (0, 9e11))
    for given in ({"instrument": -3_000_000_000}, {"center": 2**40}, {"clock_id": 1.5}):
        with pytest.raises(andoyer.InputError, match="must be a whole number of 32 bits"):
            Kernel(**given)
    with pytest.raises(andoyer.InputError, match="body must be negative or at least 1000000") as caught:
        write_pck(tmp_path / "a.bpc", TUMBLER, (0, 1), body=399)
    assert caught.value.argument == "body"
    with pytest.raises(andoyer.InputError, match="path must be without the ending"):
        write_ck(tmp_path / "a.tsc", TUMBLER, (0, 1))
    assert list(tmp_path.iterdir()) == []
