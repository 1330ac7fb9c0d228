"""Forked processes: after large parallel work in the parent, the same work ends in a child with the same bits, whatever started the child.

The threads of a parent do not exist in its child. A child that waits for them would never end: an alarm ends it after LIMIT seconds, and the test fails.
Work ends within a second or two; two threads are asked for so that a machine with one core has a pool too.
"""

import os
import subprocess
import sys

import pytest

LIMIT = 120

WORK = """
import hashlib, multiprocessing, os, signal, sys, threading, time, warnings
import numpy as np
import andoyer
warnings.simplefilter("ignore")  # that of Python 3.12 about a fork with threads among them

generator = np.random.default_rng(1)
rates = generator.normal(size=(3000, 3))
body, level, sun = andoyer.Body([1, 1.02, 1.05]), [0, 0, 0, 1], andoyer.Orbit(2e-3, 0.1)
free = andoyer.Scene(body, level, [0.1, 0.2, 1]).solve()
disturbed = andoyer.Scene(body, level, [0, 0.01, 1], orbit=sun, span=(0, 1e5), tolerance=1e-6).solve()
hamiltonian = "(p^2+q^2)/2 + (s^2+r^2)*0.7071 + (u^2+v^2)*0.5177 + 0.3*q^2*r - r^3/3 + q*v^2 + v^3 + q*r*v"

def members(threads=None, number=3000):
    return andoyer.Ensemble(body.moments, level, rates[:number], threads=threads).at([0.0, 1.0]).attitude

def under_an_orbit():
    slow = np.array([0, 0.01, 1.0]) + 1e-3 * rates[:40]
    return andoyer.Ensemble(body.moments, level, slow, orbits=sun, span=(0, 1e5), tolerance=1e-6).attitude([0.0, 1e5])

def normal_form():
    pairs = [("q", "p"), ("r", "s"), ("v", "u")]
    return np.frombuffer(str(andoyer.normalize(hamiltonian, 8, variables=pairs, exact=False)).encode(), dtype=np.uint8)

def fit():
    times = np.linspace(0.0, 100.0, 2100)
    return andoyer.fit.attitudes(free.scene, times, free.attitude(times), sigma=1e-3, free="angular_velocity").scene.angular_velocity

CALLS = {
    "members": members,
    "members by one thread": lambda: members(1),
    "members by two threads": lambda: members(2),
    "members under an orbit": under_an_orbit,
    "free motion": lambda: free.at(np.linspace(0, 1e4, 1_000_000)).attitude,
    "motion under a torque": lambda: disturbed.at(np.linspace(0, 1e5, 100_000)).attitude,
    "derivatives": lambda: free.partials(np.linspace(0, 1e3, 10_000)).attitude,
    "normal form": normal_form,
    "fit": fit,
}

def digest(name):
    return hashlib.sha256(np.ascontiguousarray(CALLS[name]()).tobytes()).hexdigest()

def threads():
    return len(os.listdir("/proc/self/task"))

def limited():
    signal.alarm(%d)

def in_a_child(task):
    '''What a task returns in a child by fork: a text.'''
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        limited()
        os.write(writing, task().encode())
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        text = pipe.read()
    status = os.waitpid(child, 0)[1]
    assert status == 0, f"the child ended with status {status}"
    return text
""" % (LIMIT // 3)  # noqa: UP031 - the text has braces


def run(folder, code, *arguments):
    """The output of a script, which must end with status 0 within the limit."""
    script = folder / "script.py"
    script.write_text(WORK + code, encoding="utf-8")
    environment = os.environ | {"RAYON_NUM_THREADS": "2"}
    done = subprocess.run(
        [sys.executable, str(script), *arguments], capture_output=True, text=True, check=False, env=environment, timeout=LIMIT, stdin=subprocess.DEVNULL
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


by_fork = pytest.mark.skipif(sys.platform != "linux", reason="forks are tested where they are the way of multiprocessing")

FORKED = """
before = threads()
expected = digest(sys.argv[1])
pool = threads() >= before + 2
# The pool of the first child does not exist in its own child, and the parent's is as it was.
first = in_a_child(lambda: digest(sys.argv[1]) + " " + in_a_child(lambda: digest(sys.argv[1])))
print(pool, first == f"{expected} {expected}", digest(sys.argv[1]) == expected)
"""

NAMES = [
    "members",
    "members by one thread",
    "members by two threads",
    "members under an orbit",
    "free motion",
    "motion under a torque",
    "derivatives",
    "normal form",
    "fit",
]


@by_fork
@pytest.mark.parametrize("name", NAMES)
def test_a_child_computes_the_bits_of_its_parent(tmp_path, name):
    pool, children, parent = run(tmp_path, FORKED, name)[0].split()
    assert (children, parent) == ("True", "True")
    # The parent had a pool, so that the child had one to wait for. That of a number of threads ends with the call.
    assert pool == "True" or name in ("members by one thread", "members by two threads")


ONE = """
before = threads()
members(1), members(1, 100)
for _ in range(1000):  # a thread that watches for Ctrl-C may need a moment to end
    if threads() == before:
        break
    time.sleep(0.01)
print(before, threads())
"""


@by_fork
def test_one_thread_starts_no_pool(tmp_path):
    before, after = run(tmp_path, ONE)[0].split()
    assert before == after


WHILE_ANOTHER_THREAD_COMPUTES = """
stop = threading.Event()
def background():
    other = andoyer.Scene(andoyer.Body([1, 1.5, 2]), level, [0.1, 0.2, 1]).solve()
    times = np.linspace(0, 1e4, 300_000)
    while not stop.is_set():
        other.at(times)
expected = digest("members")
thread = threading.Thread(target=background)
thread.start()
found = [in_a_child(lambda: digest("members")) for _ in range(20)]
stop.set()
thread.join()
print(set(found) == {expected})
"""


@by_fork
def test_a_fork_while_another_thread_computes(tmp_path):
    assert run(tmp_path, WHILE_ANOTHER_THREAD_COMPUTES) == ["True"]


MULTIPROCESSING = """
if __name__ == "__main__":
    expected = {name: digest(name) for name in CALLS if name != "fit"}  # which takes seconds
    with multiprocessing.get_context(sys.argv[1]).Pool(2, initializer=limited) as processes:
        assert processes.map_async(digest, [*expected] * 2).get(timeout=%d) == [*expected.values()] * 2
    print("done")
""" % (LIMIT // 2)  # noqa: UP031


@pytest.mark.skipif(sys.platform == "win32", reason="no alarm there")
@pytest.mark.parametrize("method", ["fork", "forkserver", "spawn"])
def test_pools_of_processes(tmp_path, method):
    if method == "fork" and sys.platform != "linux":
        pytest.skip("forks are tested where they are the way of multiprocessing")
    assert run(tmp_path, MULTIPROCESSING, method) == ["done"]


DASK = """
if __name__ == "__main__":
    import dask, distributed
    expected = {name: digest(name) for name in CALLS if name != "fit"}  # which takes seconds
    dask.config.set({"distributed.worker.multiprocessing-method": sys.argv[1]})
    with distributed.LocalCluster(n_workers=2, threads_per_worker=2, dashboard_address=None, local_directory=sys.argv[2]) as cluster:
        with distributed.Client(cluster) as client:
            found = client.gather(client.map(digest, [*expected] * 2, pure=False), errors="raise")
    assert found == [*expected.values()] * 2
    print("done")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no alarm there")
@pytest.mark.parametrize("method", ["fork", "forkserver", "spawn"])
def test_process_workers_of_dask(tmp_path, method):
    pytest.importorskip("distributed")
    if method == "fork" and sys.platform != "linux":
        pytest.skip("forks are tested where they are the way of multiprocessing")
    assert run(tmp_path, DASK, method, str(tmp_path)) == ["done"]
