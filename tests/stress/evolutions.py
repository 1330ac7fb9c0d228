"""Measure how well `Evolution.plan.error_bound` predicts the error of averaged motions, on random scenes against the integration of the full equations.

    python tests/stress/evolutions.py                           200 scenes, five minutes of one core
    python tests/stress/evolutions.py --scenes 20 --seed 7

A scene has a triaxial body, a state in either mode with ξ/ξ_sep from 0.01 to 0.9, and a torque of all monomials of degree 1 to 4 with a root mean square ε from 3e-5 to 5e-3 of M times the rate; its source is a direction, or on a slow orbit
with e = 0 or 0.2. Over 0.1/ε the full equations are integrated to 1e-9 rad, the mean of their last state is found by `evolve` over no time, and its angular momentum is compared. Exit status 1 if fewer than 80 % of the scenes have a prediction within a factor of 3.
"""

import argparse
import sys
import warnings

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

import andoyer

Array = NDArray[np.float64]


def torque(random: Generator, size: float, degree: int, source: object, power: int) -> andoyer.Torque:
    """All monomials up to the degree with normal coefficients, scaled to a root mean square on the sphere."""
    powers = [(a, b, c) for a in range(degree + 1) for b in range(degree + 1 - a) for c in range(degree + 1 - a - b)]
    coefficients = random.normal(size=(3, len(powers)))
    u = random.normal(size=(3, 4000))
    u /= np.sqrt((u * u).sum(axis=0))
    values = coefficients @ np.array([u[0] ** a * u[1] ** b * u[2] ** c for a, b, c in powers])
    coefficients *= size / np.sqrt((values**2).sum(axis=0).mean())
    texts = [" + ".join(f"({c!r})*s1^{i}*s2^{j}*s3^{k}" for c, (i, j, k) in zip(row, powers, strict=True)) for row in coefficients.tolist()]
    return andoyer.Torque.polynomial(texts, sources={"s": source}, distance_powers={"s": power} if power else None)


def moments_and_mode(random: Generator) -> tuple[Array, bool]:
    """Sorted moments with C = 1 that differ by 0.03 or more, and whether the mode is the short-axis one."""
    while True:
        moments = np.sort(np.append(random.uniform(0.3, 1, 2), 1.0))
        if moments[0] + moments[1] > 1.02 and np.diff(moments).min() > 0.03:
            return moments, bool(random.random() < 0.5)


def rates_at(moments: Array, short: bool, share: float, sense: int) -> Array:
    """The rates of M = 1 with the middle axis across that of the mode, for ξ/ξ_sep = share."""
    g = np.zeros(3)
    g[1], g[2 if short else 0] = np.sqrt(share), sense * np.sqrt(1 - share)
    return g / moments


def tumbler(random: Generator) -> tuple[andoyer.Body, Array, Array]:
    """A body with C = M = 1, and a state on a random place of its polhode."""
    moments, short = moments_and_mode(random)
    rates = rates_at(moments, short, 10 ** random.uniform(-2, -0.05), random.choice([-1, 1]))
    attitude = random.normal(size=4)
    body = andoyer.Body(moments)
    state = andoyer.Scene(body, attitude / np.linalg.norm(attitude), rates).solve().at(random.uniform(0, 1000))
    return body, state.attitude, state.angular_velocity


def prediction(seed: int) -> float | None:
    """The predicted error over the true one; None for a scene that is refused or ends early."""
    random = np.random.default_rng(seed)
    body, attitude, rates = tumbler(random)
    size, degree, kind = float(10 ** random.uniform(-4.5, -2.3)), int(random.integers(1, 5)), int(random.integers(3))
    source = [0.6, 0, 0.8] if kind == 0 else andoyer.Orbit(2e-4, 0.2 * (kind - 1), inclination=0.5)
    torques = [torque(random, size, degree, source, 2 if kind else 0)]
    span = 0.1 / size
    scene = andoyer.Scene(body, attitude, rates, torques=torques, span=(0, span), tolerance=1e-9)
    try:
        evolution = scene.evolve(average="spin")
        if evolution.end.reason != "span":
            return None
        end = scene.solve().scene_at(span)
        mean = andoyer.Scene(body, end.attitude, end.angular_velocity, epoch=span, torques=torques).evolve((span, span), average="spin").at(span)
    except andoyer.TheoryError:
        return None
    averaged = evolution.at(span).momentum
    return float(evolution.plan.error_bound / (np.linalg.norm(mean.momentum - averaged) / np.linalg.norm(averaged)))


def main() -> None:
    """Draw scenes, print the quantiles of predicted over true errors."""
    parser = argparse.ArgumentParser(description="The error estimate of averaged motions on random scenes.")
    parser.add_argument("--scenes", type=int, default=200, help="number of scenes (200)")
    parser.add_argument("--seed", type=int, default=0, help="first seed (0)")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    found: list[float] = []
    seed = arguments.seed
    while len(found) < arguments.scenes:
        ratio = prediction(seed)
        seed += 1
        if ratio is not None:
            found.append(ratio)
    ratios = np.array(found)
    low, median, high = np.quantile(ratios, [0.05, 0.5, 0.95])
    within = ((ratios > 1 / 3) & (ratios < 3)).mean()
    print(
        f"{len(ratios)} scenes: predicted over true error {low:.2f}, {median:.2f}, {high:.2f} (5, 50, 95 %), least {ratios.min():.2f}, most {ratios.max():.1f}"
    )
    print(f"within a factor of 3: {within:.1%}, below one half: {(ratios < 0.5).sum()}")
    sys.exit(bool(within < 0.8))


if __name__ == "__main__":
    main()
