"""Objects between threads, processes and copies; the interpreter lock; Ctrl-C."""

import copy
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import andoyer

pytestmark = pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")


def test_eight_threads_evaluate_one_motion_to_the_same_bits(motion):
    times = np.linspace(-1e5, 1e5, 20_000)
    expected = motion.attitude(times)
    with ThreadPoolExecutor(8) as pool:
        for result in pool.map(lambda _: motion.attitude(times), range(32)):
            assert np.array_equal(result, expected)


def test_threads_normalize_to_the_same_form():
    with ThreadPoolExecutor(4) as pool:
        forms = list(pool.map(lambda _: andoyer.NormalForm(8).to_json(), range(8)))
    assert len(set(forms)) == 1


def stamps_inside(work):
    """Runs `work` beside a thread that notes the time every millisecond: how many notes fall well inside the call, and how long it took."""
    stamps, stop = [], threading.Event()

    def note():
        while not stop.wait(0.001):
            stamps.append(time.perf_counter())

    thread = threading.Thread(target=note)
    thread.start()
    start = time.perf_counter()
    work()
    end = time.perf_counter()
    stop.set()
    thread.join()
    margin = 0.1 * (end - start)
    return sum(start + margin < stamp < end - margin for stamp in stamps), end - start


def long_call(make):
    """A call of `make(size)` that takes 0.3 s at least: a fast machine must not turn the test into noise."""
    size = 1
    while True:
        work = make(size)
        start = time.perf_counter()
        work()
        if time.perf_counter() - start > 0.3:
            return work
        size *= 2


def test_other_threads_run_while_a_motion_is_evaluated(motion):
    times = np.linspace(0, 1e5, 1_000_000)
    inside, _ = stamps_inside(long_call(lambda size: lambda: motion.attitude(np.tile(times, size))))
    assert inside >= 5  # none if the lock were held: the call is one bytecode


@pytest.mark.parametrize("method", ["at", "attitude"])
def test_other_threads_run_while_an_ensemble_is_evaluated(body, method):
    def make(size):
        ensemble = andoyer.Ensemble(body.moments, [[0, 0, 0, 1]] * 4000 * size, [0.1, 0.2, 1.0], threads=1)
        return lambda: getattr(ensemble, method)([0.0, 1.0])

    inside, _ = stamps_inside(long_call(make))
    assert inside >= 5


def test_other_threads_run_while_a_normal_form_is_computed():
    inside, _ = stamps_inside(long_call(lambda size: lambda: andoyer.NormalForm(16 + 2 * size)))
    assert inside >= 5


def test_array_in_use_by_another_thread_is_refused_or_untouched(motion):
    out, times = np.empty((200_000, 4)), np.linspace(0, 1, 200_000)
    expected = motion.attitude(times)

    def evaluate(_):
        try:
            return motion.attitude(times, out=out) is out
        except andoyer.Error as error:
            assert "in use" in str(error)
            return False

    with ThreadPoolExecutor(4) as pool:
        assert any(pool.map(evaluate, range(16)))
    assert np.array_equal(out, expected)


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_pickle_gives_equal_objects(body, scene, motion, protocol):
    def again(value):
        return pickle.loads(pickle.dumps(value, protocol))

    for value in [body, andoyer.Body.named("eros"), scene, andoyer.NormalForm(5)]:
        assert again(value) == value
    times = np.linspace(0, 100, 7)
    assert np.array_equal(again(motion).attitude(times), motion.attitude(times))
    samples = again(motion.at(times))
    assert np.array_equal(samples.times, times) and np.array_equal(samples.attitude, motion.attitude(times))
    assert again(motion.frequencies) == motion.frequencies and again(motion.periods) == motion.periods


def plans():
    body, rates = andoyer.Body([1, 1.02, 1.05]), [0.01, 0.02, 1.0]
    near = andoyer.Scene(andoyer.Body([1, 2, 3]), [0, 0, 0, 1], [0, 1, 1e-3])
    under_torque = andoyer.Scene(body, [0, 0, 0, 1], rates, orbit=andoyer.Orbit(1e-3, 0.1), tolerance=1e-9, span=(0, 1e4))
    scenes = [andoyer.Scene(body, [0, 0, 0, 1], rates, method="series", order=2), near, under_torque, andoyer.Scene(body, [0, 0, 0, 1], [0, 0, 0])]
    return [scene.solve().plan for scene in scenes] + andoyer.Ensemble([[1, 1.5, 2]], [[0, 0, 0, 1]], [[0.1, 0.2, 1]]).plans


@pytest.mark.parametrize("plan", plans(), ids=lambda plan: plan.mode)
def test_plans_are_pickled_to_the_last_bit(plan):
    again = pickle.loads(pickle.dumps(plan))
    assert again == plan and str(again) == str(plan) and repr(again) == repr(plan)
    assert (again.error_bound, again.separatrix_ratio, again.skipped) == (plan.error_bound, plan.separatrix_ratio, plan.skipped)
    assert copy.copy(plan) is plan and copy.deepcopy(plan) is plan


def test_exceptions_are_pickled_as_themselves():
    with pytest.raises(andoyer.InputError) as caught:
        andoyer.Body([0, 1, 1])
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is andoyer.InputError and str(again) == str(caught.value)


def test_copies_of_what_is_frozen_are_itself(body, scene, motion):
    for value in [body, scene, motion, andoyer.NormalForm(2)]:
        assert copy.copy(value) is value and copy.deepcopy(value) is value


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to a child there")
def test_ctrl_c_stops_a_normal_form():
    # Order 300 would take minutes.
    # A shell that starts this in the background lets its children ignore SIGINT; Python then installs no handler of its own.
    own = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    code = f"{own}; import andoyer; print('started', flush=True); andoyer.NormalForm(300)"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert child.stdout.readline() == "started\n"
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=30)
    finally:
        child.kill()
    assert child.returncode != 0 and "KeyboardInterrupt" in errors


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timer that interrupts")
@pytest.mark.parametrize("what", ["form", "normalize", "direct", "latex", "code", "map"])
def test_ctrl_c_ends_long_series_within_a_second(what):
    four = [(name, name.upper()) for name in "wxyz"]
    squares = "(w^2 + W^2)/2 + (2*x^2 + X^2)/2 + (7*y^2 + Y^2)/2 + (11*z^2 + Z^2)/2"
    h = f"{squares} + 0.3*w^2*x + 0.2*w*x*y - 0.25*y^3 + 0.1*x^2*W*Y + z*w*x + z^3"
    resonant = andoyer.normalize("(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3", 12, [("x", "X"), ("y", "Y")], resonances=[(1, -1)]) if what == "map" else None
    form = andoyer.NormalForm(50)
    work = {
        "form": lambda: andoyer.NormalForm(400),
        "normalize": lambda: andoyer.normalize(h, 14, four),
        "direct": lambda: form.direct("u", 1),
        "latex": lambda: form.to_latex("direct"),
        "code": lambda: form.to_code("c"),
        "map": lambda: resonant.actions(np.full((10**6, 4), 0.1)),
    }[what]

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.5)
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            work()
        assert time.monotonic() - start < 1.5
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
