"""Test that `plan.error_bound` covers the conversion of inertia tensors: free motions of random tensors against their closed form in 60 digits.

    make bounds                                              1000 tensors among other scenes, half a minute
    python tests/stress/tensors.py --tensors 200 --seed 1

Exit status 1 if an error is above its bound. The reference takes the tensor as given: its principal axes are found in 60 digits, then tests/reference/torque_free.py
has the motion about them. Times are 1 to 1e6, log-uniform, with rates of order one.
"""

import argparse
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))

import numpy as np
from mpmath import MPContext
from numpy.random import Generator
from numpy.typing import NDArray
from torque_free import TorqueFree

import andoyer

CONTEXT = MPContext()
CONTEXT.dps = 60
Matrix = NDArray[np.float64]


def _needle(random: Generator) -> list[float]:
    thin = float(10.0 ** -random.uniform(1, 8))
    return [thin, 1 - thin * random.uniform(0, 0.9), 1.0]


def _nearly_symmetric(random: Generator) -> list[float]:
    moment, apart = random.uniform(0.55, 1.5), float(10.0 ** -random.uniform(1, 15))
    return [moment, moment * (1 + apart), 1.0]


# Moments of a kind, and how many of ten tensors have it.
KINDS: dict[str, tuple[Callable[[Generator], list[float]], int]] = {
    "generic": (lambda r: list(r.uniform(0.55, 1, 3)), 4),
    "needle": (_needle, 3),
    "nearly symmetric": (_nearly_symmetric, 3),
}


def quaternion(axes: Matrix) -> list[object]:
    """The quaternion of a rotation matrix in 60 digits."""
    trace = axes[0, 0] + axes[1, 1] + axes[2, 2]
    squares = [1 + 2 * axes[i, i] - trace for i in range(3)] + [1 + trace]
    largest = max(range(4), key=lambda i: squares[i])
    skew = [axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]]
    if largest == 3:
        row = [*skew, squares[3]]
    else:
        row = [squares[i] if i == largest else axes[i, largest] + axes[largest, i] for i in range(3)] + [skew[largest]]
    norm = CONTEXT.sqrt(sum(x * x for x in row))
    return [x / norm for x in row]


def product(p: list, q: list) -> list:
    """The Hamilton product, scalars last."""
    (a, b, c, d), (e, f, g, h) = p, q
    return [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g]


def true_attitude(tensor: Matrix, rates: Matrix, time: float) -> list:
    """The attitude at a time, from the unit attitude at 0."""
    moments, axes = CONTEXT.eigsy(CONTEXT.matrix(tensor.tolist()))
    if CONTEXT.det(axes) < 0:
        axes = -axes
    about_axes = axes.T * CONTEXT.matrix(rates.tolist())
    start = quaternion(axes)
    attitude, _ = TorqueFree(list(moments), start, list(about_axes), digits=30).state(time)
    return product(attitude, [-start[0], -start[1], -start[2], start[3]])


def outcome(seed: int, number: int) -> tuple[str, float, float]:
    """Kind, error and bound of a tensor."""
    random = np.random.default_rng([seed, number])
    kind = [name for name, (_, share) in KINDS.items() for _ in range(share)][number % 10]
    axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
    tensor = (axes * KINDS[kind][0](random)) @ axes.T
    tensor = 0.5 * (tensor + tensor.T)
    rates, time = random.normal(size=3), float(10 ** random.uniform(0, 6))
    motion = andoyer.Scene(andoyer.Body.from_inertia(tensor), [0, 0, 0, 1], rates, span=(0, time), tolerance=1e-9).solve()
    x, y, z, w = true_attitude(tensor, rates, time)
    apart = product([-x, -y, -z, w], [CONTEXT.mpf(float(part)) for part in motion.attitude(time)])
    error = 2 * CONTEXT.asin(min(1, CONTEXT.sqrt(sum(part**2 for part in apart[:3]) / sum(part**2 for part in apart))))
    return kind, float(error), motion.plan.error_bound


def main() -> None:
    parser = argparse.ArgumentParser(description="Errors of free motions of tensors against their bounds.")
    parser.add_argument("--tensors", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=2026)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    found = [outcome(arguments.seed, number) for number in range(arguments.tensors)]
    print(f"{'kind':<18}{'tensors':>8}{'above':>7}   error / bound: {'median':>8}{'q90':>9}{'q99':>9}{'max':>9}")
    above = 0
    for kind in KINDS:
        ratios = np.array([error / bound for name, error, bound in found if name == kind])
        above += int(np.sum(ratios > 1))
        quantiles = "".join(f"{np.quantile(ratios, q):>9.2g}" for q in (0.5, 0.9, 0.99, 1))
        print(f"{kind:<18}{ratios.size:>8}{np.sum(ratios > 1):>7}                 {quantiles}")
    sys.exit(above > 0)


if __name__ == "__main__":
    main()
