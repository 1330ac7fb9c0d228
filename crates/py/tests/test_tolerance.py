"""A tolerance that is not met: warned of once, with both numbers, by a scene, an ensemble and the command line."""

import pickle
import subprocess
import sys
import warnings

import numpy as np
import pytest

import andoyer

LEVEL = [0, 0, 0, 1]
SUN = andoyer.Orbit(1e-2, 0.1)
DISTURBED = andoyer.Body([1, 1.02, 1.05])


def disturbed(**options):
    return andoyer.Scene(DISTURBED, LEVEL, [0, 0.01, 1], orbit=SUN, **options)


def shown(bound):
    """The number as the message has it."""
    digits, power = f"{bound:.1e}".split("e")
    return f"{digits}e{int(power)} rad"


def test_missed_tolerance_warns_once_at_solve_with_both_numbers():
    scene = disturbed(tolerance=1e-12, span=(0, 1e5))
    with pytest.warns(andoyer.ToleranceWarning) as caught:
        motion = scene.solve()
    [warning] = caught
    assert motion.plan.error_bound > 1e-12 and not motion.plan.meets_tolerance and motion.plan.tolerance == 1e-12
    for said in [shown(motion.plan.error_bound), "1e-12 rad", "over the span"]:
        assert said in str(warning.message)
    assert warning.filename == __file__ and issubclass(andoyer.ToleranceWarning, UserWarning)
    assert motion.plan.missed_tolerance == str(warning.message)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        motion.at([0.0, 1.0])
        pickle.loads(pickle.dumps(motion))


@pytest.mark.parametrize("tolerance", [1e-3, 1e-12, 1e-14, 1e-18])
def test_free_motion_meets_its_tolerance_without_a_span_however_small(body, tolerance):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for rates in [[0.1, 0.2, 1.0], [1.0, 0.1, 0.1], [0, 0, 1], [0, 1, 0], [0, 0, 0]]:
            assert andoyer.Scene(body, LEVEL, rates, tolerance=tolerance).solve().plan.meets_tolerance


def test_tolerance_that_is_met_does_not_warn_and_one_below_the_bound_does():
    with pytest.warns(andoyer.ToleranceWarning):
        bound = disturbed(span=(0, 1e5)).solve().plan.error_bound
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert disturbed(span=(0, 1e5), tolerance=2 * bound).solve().plan.meets_tolerance


def test_ensemble_warns_once_with_the_number_of_members_and_the_worst():
    rates = [[0, 0.01, 1], [0, 0.3, 1], [0, 0.02, 1], [0, 0, 1]]
    ensemble = andoyer.Ensemble(DISTURBED.moments, LEVEL, rates, orbits=[SUN, SUN, SUN, None], span=(0, 1e5))
    bounds = [plan.error_bound for plan in ensemble.plans]
    for call in (ensemble.at, ensemble.attitude):
        with pytest.warns(andoyer.ToleranceWarning) as caught:
            call([0.0, 1.0])
        [warning] = caught
        assert f"3 of 4 members miss the tolerance, the worst is member {np.argmax(bounds)}: " in str(warning.message)
        assert shown(max(bounds)) in str(warning.message)
    # A member has its plan; 32 warnings for 40 members said no more.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert [motion.plan.meets_tolerance for motion in ensemble] == [bound <= 1e-12 for bound in bounds]
        assert ensemble[0].plan.missed_tolerance is not None


SCENE = """\
tolerance = 1e-12
span = [0.0, 1e5]
[body]
moments = [1.0, 1.02, 1.05]
[state]
attitude = [0.0, 0.0, 0.0, 1.0]
angular_velocity = [0.0, 0.01, 1.0]
[orbit]
mean_motion = 1e-2
"""


def run(folder, *arguments):
    return subprocess.run([sys.executable, "-m", "andoyer", *arguments], capture_output=True, text=True, cwd=folder)


@pytest.mark.parametrize("command", [["plan", "scene.toml"], ["propagate", "scene.toml", "-o", "out.csv", "--samples", "9", "--stop", "9", "--force"]])
def test_command_says_so_in_one_line_and_fails_only_when_strict(tmp_path, command):
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    done = run(tmp_path, *command)
    [line] = done.stderr.splitlines()
    assert done.returncode == 0 and line.startswith("andoyer: warning: the error bound of the attitude, ") and "1e-12 rad" in line
    strict = run(tmp_path, *command, "--strict")
    assert strict.returncode == 3 and strict.stderr == done.stderr
    (tmp_path / "scene.toml").write_text(SCENE.partition("[orbit]")[0], encoding="utf-8")
    met = run(tmp_path, *command, "--strict")
    assert met.returncode == 0 and met.stderr == ""


def test_files_that_have_comments_say_so_too(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    for ending in ("aem", "npz", "parquet"):
        assert run(tmp_path, "propagate", "scene.toml", "-o", f"out.{ending}", "--samples", "9", "--stop", "9").returncode == 0
    assert "COMMENT the error bound of the attitude, " in (tmp_path / "out.aem").read_text(encoding="ascii")
    kernel = pytest.importorskip("spiceypy")
    assert run(tmp_path, "propagate", "scene.toml", "-o", "out.bc", "--stop", "9", "--interpolation-error", "1e-5").returncode == 0
    handle = kernel.dafopr(str(tmp_path / "out.bc"))
    _, lines, _ = kernel.dafec(handle, 200, 200)
    kernel.dafcls(handle)
    assert "".join(lines).count("exceeds the tolerance, 1e-12 rad") == 1  # lines of 80
    assert "exceeds the tolerance, 1e-12 rad" in str(np.load(tmp_path / "out.npz")["remark"])
    assert b"exceeds the tolerance, 1e-12 rad" in parquet.read_schema(tmp_path / "out.parquet").metadata[b"remark"]
