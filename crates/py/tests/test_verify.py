"""`Motion.verify`: the measured error of a motion beside its error bound."""

import copy
import pickle
import re

import numpy as np
import pytest

import andoyer
from andoyer.cli import main

ATTITUDE = [0, 0, 0, 1]
RATES = [0.2, 0.3, 1.1]
SUN = andoyer.Orbit(2e-3, 0.2, inclination=0.4)


def scene(**options):
    return andoyer.Scene(andoyer.Body([0.5, 0.75, 1.0]), ATTITUDE, RATES, **{"orbit": SUN, "span": (0, 1000), "tolerance": 1e-7} | options)


@pytest.fixture(scope="module")
def disturbed():
    return scene().solve()


@pytest.fixture(scope="module")
def verification(disturbed):
    return disturbed.verify()


def angles(one, other):
    """Angles between attitudes, by the norm of the vector part of conj(one) * other."""
    vector = one[:, 3:] * other[:, :3] - other[:, 3:] * one[:, :3] - np.cross(one[:, :3], other[:, :3])
    return 2 * np.arcsin(np.linalg.norm(vector, axis=1))


def test_errors_are_those_against_the_integrated_method(disturbed, verification):
    assert verification.times == pytest.approx(np.linspace(0, 1000, 64), rel=1e-15)
    exact = scene(method="integrated", tolerance=1e-10).solve()
    expected = angles(disturbed.attitude(verification.times), exact.attitude(verification.times))
    assert np.abs(verification.errors - expected).max() < 2 * verification.integration_bound
    assert verification.error == verification.errors.max() > 10 * verification.integration_bound


def test_verification_says_that_the_bound_holds(disturbed, verification):
    assert verification.holds and not verification.refuted
    assert verification.error_bound == disturbed.plan.error_bound
    assert verification.error + verification.integration_bound <= verification.error_bound
    assert str(verification).startswith("the largest error at 64 times from 0 to 1000 is ") and str(verification).endswith(" rad, holds")
    assert repr(verification).startswith("<Verification at 64 times: error ") and repr(verification).endswith(": holds>")


def with_bound(verification, bound):
    """The same verification of a motion with another error bound."""
    restore, (text,) = verification.__reduce__()
    return restore(re.sub(r"(?m)^error_bound = .*$", f"error_bound = {bound!r}", text))


def test_bound_that_is_too_small_is_refuted(verification):
    wrong = with_bound(verification, 0.5 * verification.error)
    assert wrong.refuted and not wrong.holds
    assert str(wrong).endswith(" rad, is exceeded") and repr(wrong).endswith(": refuted>")


def test_copies_and_pickles_are_equal_and_arrays_read_only(verification):
    assert pickle.loads(pickle.dumps(verification)) == verification
    assert copy.copy(verification) is verification and copy.deepcopy(verification) is verification
    for array in (verification.times, verification.errors):
        assert array.dtype == np.float64 and not array.flags.writeable
    with pytest.raises(AttributeError):
        verification.error = 0.0


@pytest.mark.parametrize(
    "options",
    [
        {"orbit": None, "method": "series"},
        {"orbit": [SUN, andoyer.Orbit(3e-3)], "tolerance": 1e-5},
        {"orbit": andoyer.Orbit(2e-3, 0.2, inclination=0.4, node_rate=1e-5), "tolerance": 1e-5},
        {"span": (-1000, -500)},
        {"span": (500, 1000), "epoch": 100.0},
        {"method": "integrated", "tolerance": 1e-5},
    ],
)
def test_bounds_hold_for_other_scenes(options):
    motion = scene(**options).solve()
    verification = motion.verify()
    assert verification.holds, str(verification)
    assert (verification.times[0], verification.times[-1]) == motion.scene.span


def test_verification_under_a_table_is_of_its_motion():
    times = np.linspace(-10, 1010, 1000)
    table = andoyer.TabulatedOrbit(times, circle(times), 400.0)
    motion = scene(orbit=table).solve()
    verification = motion.verify()
    assert motion.plan.method == "integrated" and verification.error > 0 and not verification.refuted
    with pytest.raises(andoyer.InputError, match=r"span = \[0, 1020\]: it must be within \[0, 1000\]"):
        motion.verify((0, 1020))


def circle(times):
    return np.column_stack([100 * np.cos(0.02 * times), 100 * np.sin(0.02 * times), 0 * times])


def test_body_about_user_axes_and_a_date_as_epoch():
    astropy = pytest.importorskip("astropy.time")
    epoch = astropy.Time("2026-01-01", scale="tdb")
    body = andoyer.Body.from_inertia([[0.8, 0.1, 0.05], [0.1, 0.7, -0.1], [0.05, -0.1, 1.0]])
    hour = astropy.TimeDelta(3600.0, format="sec")
    motion = andoyer.Scene(
        body, ATTITUDE, [1e-4, 0, 1e-2], epoch=epoch, orbit=andoyer.Orbit(2e-5, 0.2), span=(epoch, epoch + 24 * hour), tolerance=1e-7
    ).solve()
    verification = motion.verify([epoch, epoch + hour], samples=3)
    assert verification.holds and np.array_equal(verification.times, motion.scene.epoch + np.array([0.0, 1800.0, 3600.0]))


@pytest.mark.parametrize(
    "arguments, argument, value, bound",
    [
        ({"samples": 1}, "samples", 1, (2, 1_000_000)),
        ({"samples": 1_000_001}, "samples", 1_000_001, (2, 1_000_000)),
        ({"samples": -1}, "samples", -1, (2, 1_000_000)),
        ({"span": (10, 0)}, "span", (10.0, 0.0), "finite with start <= stop"),
        ({"span": (0, np.inf)}, "span", (0.0, np.inf), "finite with start <= stop"),
        ({"span": (0, 1001)}, "span", (0.0, 1001.0), (0.0, 1000.0)),
        ({"tolerance": 0.0}, "tolerance", 0.0, "positive and finite"),
        ({"tolerance": -1e-9}, "tolerance", -1e-9, "positive and finite"),
    ],
)
def test_bad_input_is_an_input_error_with_its_facts(disturbed, arguments, argument, value, bound):
    with pytest.raises(andoyer.InputError, match=f"^{argument} = ") as caught:
        disturbed.verify(**arguments)
    assert (caught.value.argument, caught.value.value, caught.value.bound) == (argument, value, bound)


@pytest.mark.parametrize("arguments", [{"samples": 2.5}, {"samples": True}, {"tolerance": "small"}, {"span": 3.0}])
def test_wrong_types_are_refused(disturbed, arguments):
    with pytest.raises((TypeError, andoyer.InputError), match=next(iter(arguments))):
        disturbed.verify(**arguments)


def test_tolerance_that_is_not_a_number_is_refused(disturbed):
    with pytest.raises(andoyer.InputError, match="^tolerance = NaN: it must be positive and finite"):
        disturbed.verify(tolerance=float("nan"))


def test_more_than_a_minute_needs_a_span():
    motion = scene(orbit=None, span=None).solve()
    with pytest.raises(andoyer.InputError, match=r"^span: none is given to verify, .* takes about 28 hours") as caught:
        motion.verify()
    assert caught.value.argument == "span" and caught.value.value > 1e5 and caught.value.bound == 60.0
    assert "\nverify        needs a span: about 28 hours (2.5e10 steps) over 1e9 rotations (no span given)" in str(motion.plan)
    assert not motion.verify((0, 100)).refuted


def run(tmp_path, capsys, scene, *options):
    path = tmp_path / "scene.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    status = main(["plan", str(path), *options])
    return status, *capsys.readouterr()


def test_plan_verifies_on_request(tmp_path, capsys):
    status, printed, errors = run(tmp_path, capsys, scene())
    assert (status, errors) == (0, "") and "\nverify        takes about " in f"\n{printed}" and "verified" not in printed
    status, printed, errors = run(tmp_path, capsys, scene(), "--verify", "--strict")
    assert (status, errors) == (0, "")
    assert printed.splitlines()[-1] == f"verified      {scene().solve().verify()}"
    _, printed, _ = run(tmp_path, capsys, scene(), "--verify", "--stop", "10")
    assert " at 64 times from 0 to 10 is " in printed.splitlines()[-1]


def test_plan_refuses_a_long_verification_and_times_without_one(tmp_path, capsys):
    status, _, errors = run(tmp_path, capsys, scene(orbit=None, span=None), "--verify")
    assert status == 2 and errors.startswith("andoyer: error: span: none is given to verify") and errors.count("\n") == 1
    status, printed, errors = run(tmp_path, capsys, scene(), "--stop", "10")
    assert (status, printed, errors) == (2, "", "andoyer: error: argument --stop: goes with --verify alone\n")


def test_strict_plan_of_a_refuted_bound_has_the_status_of_a_missed_tolerance(tmp_path, capsys, monkeypatch, verification):
    wrong = with_bound(verification, 0.5 * verification.error)

    class Wrong:
        plan, scene, periods = scene().solve().plan, scene(), {}
        energy_ratio = elliptic_parameter = 1.0

        def verify(self, span):
            return wrong

    monkeypatch.setattr("andoyer.cli._printing.solved", lambda path: Wrong())
    assert run(tmp_path, capsys, scene(), "--verify")[0] == 0
    status, printed, _ = run(tmp_path, capsys, scene(), "--verify", "--strict")
    assert status == 3 and printed.splitlines()[-1].endswith("is exceeded")
