"""Ctrl-C: every long call ends within a second of the signal, the interpreter goes on, and no file is left half written.

A call would last half a minute of one core or more; the deadline is five seconds of processor, since other programs may keep the machine busy. The child sets its own
handler: a parent may have told it to ignore the signal.
"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import andoyer

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to a child there")

DEADLINE = 5.0

START = """
import signal, sys, time
import numpy as np
import andoyer
signal.signal(signal.SIGINT, signal.default_int_handler)
body, level, sun = andoyer.Body([1, 1.02, 1.05]), [0, 0, 0, 1], andoyer.Orbit(2e-3, 0.1)
few = np.zeros((400_000, 3)) + [0, 0.01, 1]
"""

AGAIN = """
def work():
    while True:
        once()
print("started", flush=True)
try:
    work()
except KeyboardInterrupt:
    assert andoyer.Scene(body, level, [0, 0, 1]).solve().attitude([0.0, 1.0]).shape == (2, 4)
    print("interrupted", flush=True)
"""


def used(process):
    """Seconds of processor that a running process has used."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def interrupted(code, cwd=None):
    """Runs `code` in a child, interrupts it after half a second: what it printed, its status, seconds of processor from the signal to the end (without /proc of the clock)."""
    counted = Path("/proc/self/stat").exists()
    before = sum(os.times()[2:4])
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=cwd)
    try:
        assert child.stdout.readline() == "started\n", child.stderr.read()
        time.sleep(0.5)
        assert child.poll() is None, child.stderr.read()
        sent, spent = time.monotonic(), used(child.pid) if counted else 0.0
        child.send_signal(signal.SIGINT)
        printed, errors = child.communicate(timeout=60)
        seconds = sum(os.times()[2:4]) - before - spent if counted else time.monotonic() - sent
        return printed + errors, child.returncode, seconds
    finally:
        child.kill()


# One call each, that would last half a minute on one core of a fast machine.
CALLS = {
    "ensemble under an orbit": "andoyer.Ensemble(body.moments, level, few, orbits=sun, span=(0, 1e5)).attitude([0.0])",
    "plans of an ensemble under an orbit": "andoyer.Ensemble(body.moments, level, few, orbits=sun, span=(0, 1e5)).plans",
    "derivatives of an ensemble under an orbit": "andoyer.Ensemble(body.moments, level, few[:8000], orbits=sun, span=(0, 1e5)).partials(0.0)",
    "members at many times": "andoyer.Ensemble(body.moments, level, few[:2], orbits=sun, span=(0, 1e5)).at(np.linspace(0, 1e5, 6_000_000))",
    "integration": "andoyer.Scene(body, level, [0, 0.1, 1], orbit=andoyer.Orbit(0.5), span=(0, 4e6), method='integrated').solve()",
    "verification": "andoyer.Scene(body, level, [0, 0.1, 1], orbit=sun, span=(0, 4e6)).solve().verify((0, 4e6))",
}


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_ends_a_call_and_leaves_the_interpreter_usable(call):
    code = START + "import warnings; warnings.simplefilter('ignore')\n" + f"def once(): {CALLS[call]}\n" + AGAIN
    printed, status, seconds = interrupted(code)
    assert printed == "interrupted\n" and status == 0
    assert seconds < DEADLINE


@pytest.mark.parametrize("method", ["at", "attitude", "angular_velocity", "angular_momentum", "andoyer", "partials"])
def test_ctrl_c_ends_the_evaluation_of_a_motion(method):
    code = START + "import warnings; warnings.simplefilter('ignore')\n"
    number = 200_000 if method == "partials" else 6_000_000
    code += "motion = andoyer.Scene(body, level, [0, 0.01, 1], orbit=sun, span=(0, 1e5)).solve()\n"
    code += f"times = np.linspace(0, 1e5, {number})\n"
    code += f"def once(): motion.{method}(times)\n" + AGAIN
    printed, status, seconds = interrupted(code)
    assert printed == "interrupted\n" and status == 0
    assert seconds < DEADLINE


# Solved before; the derivatives at one time last ten seconds.
FAR = {
    "averaged": "andoyer.Scene(body, level, [0.02, 0.01, 1], orbit=andoyer.Orbit(1e-3, 0.1)).solve(), 1e8",
    "integrated": "andoyer.Scene(body, level, [0, 0.1, 1], orbit=andoyer.Orbit(0.5), span=(0, 3e5), method='integrated').solve(), 3e5",
}


@pytest.mark.parametrize("kind", FAR)
def test_ctrl_c_ends_derivatives_far_from_the_epoch(kind):
    code = START + "import warnings; warnings.simplefilter('ignore')\n" + f"motion, far = {FAR[kind]}\n"
    code += "def once(): motion.partials(far, with_respect_to=['attitude', 'angular_velocity', 'moments', 'orbit', 'attraction'])\n" + AGAIN
    printed, status, seconds = interrupted(code)
    assert printed == "interrupted\n" and status == 0
    assert seconds < DEADLINE


# The command that writes a file of each ending.
WRITERS = {
    "csv": ["propagate", "--samples", "2000"],
    "npz": ["propagate", "--samples", "2000"],
    "parquet": ["propagate", "--samples", "2000"],
    "aem": ["propagate", "--samples", "2000"],
    "html": ["plot"],
    "svg": ["plot"],
    "c": ["code"],
    "rs": ["code"],
    "py": ["code"],
    "js": ["code"],
}


@pytest.mark.parametrize("ending", WRITERS)
def test_ctrl_c_leaves_no_partial_file_and_the_old_one_as_it_was(tmp_path, ending):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    scene = andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1])
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    (tmp_path / f"out.{ending}").write_text("old", encoding="utf-8")
    command, *options = WRITERS[ending]
    # Writing does not end: the last step waits, when the new file is complete beside the old one.
    code = f"""
import signal, sys, time
import os
import andoyer.cli
signal.signal(signal.SIGINT, signal.default_int_handler)
def slow(source, target):
    assert os.path.getsize(source) > 100 and os.path.basename(target) == "out.{ending}"
    print("started", flush=True)
    time.sleep(60)
os.replace = slow
sys.exit(andoyer.cli.main([{command!r}, "scene.toml", "-o", "out.{ending}", *{options!r}, "--force"]))
"""
    printed, status, seconds = interrupted(code, tmp_path)
    assert status == 130 and printed.endswith("andoyer: interrupted\n") and seconds < DEADLINE
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"out.{ending}", "scene.toml"]
    assert (tmp_path / f"out.{ending}").read_text(encoding="utf-8") == "old"


def test_long_calls_give_the_bits_of_short_ones(body):
    motion = andoyer.Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    times = np.cumsum(np.random.default_rng(1).exponential(1.0, 600_000))  # above the length from which a thread of its own computes
    parts = np.concatenate([motion.attitude(part) for part in np.split(times, 6)])
    assert np.array_equal(motion.attitude(times), parts)


def test_errors_of_long_calls_are_those_of_short_ones(motion):
    times = np.zeros(600_000)
    times[599_999] = np.nan
    with pytest.raises(andoyer.InputError, match=r"times\[599999\] = NaN"):
        motion.attitude(times)
