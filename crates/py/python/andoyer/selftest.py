"""`python -m andoyer.selftest` checks the installed wheel against known answers, in under a second. It needs only NumPy.

Exit status 0 if all checks hold; otherwise 1, with a line for each check that fails.
"""

import math
import pickle
import sys
import threading
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import numpy.typing

import andoyer

BODY = [1.0, 1.5, 2.0]
QUARTER = math.sqrt(0.5)
THREADED = sys.platform != "emscripten"
"""Pyodide has no threads."""


def polynomials() -> bool:
    """P_4 of theory §4, and exact JSON there and back."""
    form = andoyer.NormalForm(6)
    return form.triaxiality_polynomial(4) == {2: Fraction(-3, 4), 4: Fraction(-9, 32)} and andoyer.NormalForm.from_json(form.to_json()) == form


def pendulum() -> bool:
    """The pendulum's frequency falls as I/8 and 3 I²/256 (H = p²/2 − cos q)."""
    form = andoyer.normalize("(p^2 + q^2)/2 - q^4/24 + q^6/720", 4, variables=[("q", "p")])
    return form.in_actions() == {(1,): Fraction(1), (2,): Fraction(-1, 16), (3,): Fraction(-1, 256)}


def uniform() -> bool:
    """Rotation about an axis, a quarter turn."""
    motion = andoyer.Scene(andoyer.Body(BODY), [0, 0, 0, 1], [0, 0, 1]).solve()
    return bool(np.abs(motion.attitude(math.pi / 2) - [0, 0, QUARTER, QUARTER]).max() < 1e-15)


def conserved() -> bool:
    """Energy and inertial angular momentum are conserved in both modes, over 9e8 rotations."""
    for rates in ([0.1, 0.2, 1.0], [1.0, 0.2, 0.1]):
        motion = andoyer.Scene(andoyer.Body(BODY), [0, 0, 0, 1], rates).solve()
        samples = motion.at(np.array([0.0, 1.0, 1e3, 1e6, 6e9]))
        energy = samples.angular_velocity**2 @ np.array(BODY)
        momentum = rotated(samples.attitude, samples.angular_velocity * BODY)
        if np.abs(energy / energy[0] - 1).max() > 1e-13 or np.abs(momentum - momentum[0]).max() > 1e-13:
            return False
    return True


def methods() -> bool:
    """The series and the closed form give the same attitude."""
    first, second = (
        andoyer.Scene(andoyer.Body(BODY), [0, 0, 0, 1], [0.05, 0.1, 1.0], method=method).solve().attitude(np.linspace(0, 100, 50))
        for method in ("series", "closed")
    )
    return bool(np.abs(first - second).max() < 2e-12)


def torque() -> bool:
    """The averaged precession of a pole under a gravity gradient (theory §9)."""
    orbit = andoyer.Orbit(1e-4, inclination=0.5)
    motion = andoyer.Scene(andoyer.Body(BODY), [0, 0, 0, 1], [0, 0, 1.0], orbit=orbit, tolerance=1e-6, span=(0, 1e6)).solve()
    year = 2 * math.pi / 1e-4
    start, end = motion.angular_momentum([0.0, 10 * year])
    expected = 1.5e-8 * (2 - 1.25) / 2 * math.cos(0.5) * math.sin(0.5) * 10 * year
    return bool(abs(math.hypot(*(end - start)) / np.linalg.norm(start) / expected - 1) < 0.01)


def shared() -> bool:
    """An ensemble gives the same bits as its members, for any number of threads and after pickling."""
    moments = np.array([BODY, [1.0, 2.0, 2.5], [1.0, 1.0, 1.9]])
    ensemble = andoyer.Ensemble(moments, [0, 0, 0, 1], [0.1, 0.2, 1.0], threads=1 + THREADED)
    times = np.linspace(0, 10, 7)
    alone = [andoyer.Scene(andoyer.Body(row), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().attitude(times) for row in moments]
    return np.array_equal(pickle.loads(pickle.dumps(ensemble)).attitude(times), alone)


def threads() -> bool:
    """One motion evaluated by four threads at once."""
    motion = andoyer.Scene(andoyer.Body(BODY), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    times = np.linspace(0, 1e4, 20_000)
    expected, found = motion.attitude(times), []
    workers = [threading.Thread(target=lambda: found.append(motion.attitude(times))) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return len(found) == 4 and all(np.array_equal(one, expected) for one in found)


def refused() -> bool:
    """Invalid input raises an error that names the argument."""
    try:
        andoyer.Body([1.0, 1.0, 2.5])
    except andoyer.InputError as error:
        return "moments" in str(error)
    return False


CHECKS: list[Callable[[], bool]] = [polynomials, pendulum, uniform, conserved, methods, torque, shared, refused] + [threads] * THREADED


def rotated(quaternions: np.typing.NDArray[np.float64], vectors: np.typing.NDArray[np.float64]) -> np.typing.NDArray[np.float64]:
    """Vectors turned by quaternions [x, y, z, w], row by row."""
    axis, scalar = quaternions[:, :3], quaternions[:, 3:]
    twice = 2 * np.cross(axis, vectors)
    turned: np.typing.NDArray[np.float64] = vectors + scalar * twice + np.cross(axis, twice)
    return turned


def main() -> int:
    """Run every check; return the exit status."""
    failed = 0
    for check in CHECKS:
        said = (check.__doc__ or "").rstrip(".")
        try:
            problem = "" if check() else "does not hold"
        except Exception as error:  # any exception of a broken wheel is a failed check
            problem = f"{type(error).__name__}: {error}"
        failed += bool(problem)
        print(f"{'FAILED' if problem else 'ok':7} {said}{': ' if problem else ''}{problem}")
    print(f"andoyer {andoyer.__version__}, Python {sys.version.split()[0]}, NumPy {np.__version__}: {len(CHECKS) - failed} of {len(CHECKS)} hold")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
