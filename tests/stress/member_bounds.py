"""Test that the error bounds of integrated members of ensembles are bounds, and how tight they are.

    python tests/stress/member_bounds.py                                          10,000 members
    python tests/stress/member_bounds.py --members 1000 --seed 2 --tolerance 1e-8

Exit status 1 if an error is above its bound.

Members of ten regimes: different bodies, states and rates under one fixed orbit for each 50 members. Their errors are the largest differences at 24 times from a second integration at the tolerance 1e-15. An error counts if it
is above the bound of that integration and above 2e-14 rad, twice the floor of the bounds. Quantiles and the least value are of bound / error. Of members whose attitude is unknown at the end of the span only the number is printed. At tolerances below 1e-8 the
errors are those of rounding in both integrations: benches/rivals/integration.py compares these with heyoka in 80-bit reals.
"""

import argparse
import sys
import warnings
from collections.abc import Callable

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

import andoyer

Array = NDArray[np.float64]

warnings.simplefilter("ignore", andoyer.ToleranceWarning)

TOGETHER = 50  # members of an ensemble
TIMES = 24
FINEST = 1e-15
CLEAR = 2e-14  # [rad]
HALF_TURN = 3.1415  # [rad]


def directions(random: Generator, count: int) -> Array:
    """Unit vectors, shape (count, 3)."""
    drawn = random.normal(size=(count, 3))
    return drawn / np.linalg.norm(drawn, axis=1)[:, None]


def sizes(random: Generator, count: int, least: float, most: float) -> Array:
    """10^x with x uniform, shape (count, 1)."""
    return 10 ** random.uniform(least, most, size=(count, 1))


def bodies(random: Generator, count: int) -> Array:
    """Moments of any shape, shape (count, 3)."""
    middle = random.uniform(0.55, 0.999, count)
    least = random.uniform(np.maximum(1 - middle + 0.01, 0.1), middle)
    return np.stack([least, middle, np.ones(count)], axis=1)


def nearly_spherical(random: Generator, count: int) -> Array:
    return np.sort(1 - sizes(random, count, -6, -2) * random.uniform(0, 1, (count, 3)), axis=1)


def along(axis: int, spread: float) -> Callable[[Generator, int], Array]:
    """Directions next to a body axis."""
    return lambda random, count: np.eye(3)[axis] + spread * random.normal(size=(count, 3))


# Of each regime: moments, directions of the rates, decades of their size in mean motions, decades of 1 − e, orbits in the span.
REGIMES = {
    "slow": (bodies, directions, (-4, -0.3), (-0.2, -0.01), (1.5, 4)),
    "locked": (bodies, along(2, 0.02), (-0.02, 0.02), (-0.05, -0.001), (5, 20)),
    "3:2": (bodies, along(2, 0.02), (0.17, 0.18), (-0.1, -0.09), (5, 20)),
    "chaotic": (bodies, along(2, 0.3), (-0.2, 0.3), (-0.4, -0.1), (2, 6)),
    "middling": (bodies, directions, (0.0, 1.0), (-0.2, -0.01), (1.5, 4)),
    "fast": (bodies, directions, (1, 1.8), (-0.2, -0.01), (1, 3)),
    "eccentric": (bodies, directions, (0.5, 1.5), (-1.3, -0.3), (1.5, 3)),
    "flyby": (bodies, directions, (0.5, 2.0), (-2.0, -1.3), (0.9, 1.1)),
    "separatrix": (bodies, along(1, 1e-2), (1.2, 1.4), (-0.2, -0.01), (1, 1.5)),
    "nearly spherical": (nearly_spherical, directions, (0, 1.5), (-0.3, -0.01), (1.5, 4)),
}


def members(regime: str, random: Generator, count: int) -> Callable[[float], andoyer.Ensemble]:
    """An ensemble of a regime, as a function of the tolerance."""
    shapes, towards, rates, shape, orbits = REGIMES[regime]
    eccentricity = float(1 - 10 ** random.uniform(*shape))
    inclination, node, argument, time = random.uniform(0, 3, 4)
    orbit = andoyer.Orbit(1.0, eccentricity, inclination=inclination, node=node, argument_of_pericentre=argument, time_of_pericentre=time)
    moments, attitudes = shapes(random, count), random.normal(size=(count, 4))
    attitudes /= np.linalg.norm(attitudes, axis=1)[:, None]
    spins = towards(random, count) * sizes(random, count, *rates)
    span = (0.0, 2 * np.pi * float(random.uniform(*orbits)))

    def ensemble(tolerance: float) -> andoyer.Ensemble:
        return andoyer.Ensemble(moments, attitudes, spins, orbit=orbit, tolerance=tolerance, span=span, method="integrated", errors="nan")

    return ensemble


def angles(one: Array, other: Array) -> Array:
    """Angles between attitudes, from the differences of their quaternions."""
    apart = np.minimum(np.linalg.norm(one - other, axis=-1), np.linalg.norm(one + other, axis=-1))
    return 4 * np.arcsin(0.5 * np.minimum(apart, 2.0))


def compared(regime: str, seed: int, count: int, tolerance: float) -> tuple[Array, int]:
    """Bound over error of the members whose errors count, and how many are unknown at the end of the span."""
    random, ratios, unknown = np.random.default_rng([seed, list(REGIMES).index(regime)]), [], 0
    for first in range(0, count, TOGETHER):
        ensemble = members(regime, random, min(TOGETHER, count - first))
        tested, reference = ensemble(tolerance), ensemble(FINEST)
        times = np.linspace(*tested.span, TIMES)
        errors = angles(tested.attitude(times), reference.attitude(times)).max(axis=1)
        bounds, others = (np.array([plan.error_bound for plan in each.plans]) for each in (tested, reference))
        known = (bounds < HALF_TURN) & (others < HALF_TURN)
        unknown += int(np.sum(~known))
        assert np.isfinite(errors[known]).all(), f"{regime}: a member of a known attitude is not finite"
        counted = known & (errors > np.maximum(others, CLEAR))
        ratios.append(bounds[counted] / errors[counted])
    return np.concatenate(ratios), unknown


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--members", type=int, default=10_000)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--tolerance", type=float, default=1e-6)
    asked = options.parse_args()
    print(
        f"{asked.members} members, tolerance {asked.tolerance:g}, seed {asked.seed}\n{'regime':<18}{'counted':>8}{'unknown':>8}{'above':>7}{'5 %':>8}{'50 %':>8}{'95 %':>8}{'least':>8}"
    )
    all_ratios = []
    for regime in REGIMES:
        ratios, unknown = compared(regime, asked.seed, asked.members // len(REGIMES), asked.tolerance)
        all_ratios.append(ratios)
        if len(ratios):
            quantiles = "".join(f"{value:>8.1f}" for value in [*np.quantile(ratios, [0.05, 0.5, 0.95]), ratios.min()])
            print(f"{regime:<18}{len(ratios):>8}{unknown:>8}{int(np.sum(ratios < 1)):>7}{quantiles}", flush=True)
    ratios = np.concatenate(all_ratios)
    quantiles = "".join(f"{value:>8.1f}" for value in [*np.quantile(ratios, [0.05, 0.5, 0.95]), ratios.min()])
    print(f"{'all':<18}{len(ratios):>8}{'':>8}{int(np.sum(ratios < 1)):>7}{quantiles}")
    sys.exit(bool(np.any(ratios < 1)))


if __name__ == "__main__":
    main()
