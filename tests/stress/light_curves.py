"""States drawn from fits of simulated light curves, against the known answers: the mean Δχ² of the draws, and the distribution of pulls.

    python tests/stress/light_curves.py [--curves 50] [--draws 1000] [--noise 0.02] [--shape]

Each curve has an ellipsoid 1 : 0.7 : 0.5 with precession periods of 0.25 to 0.8 days, in the short-axis and the long-axis mode alternately, at 12 random times in each of 20 nights. The fit begins at the true
state, so that its minimum is next to it. The mean Δχ² of exact draws is near the number of parameters. A pull is the true value of a parameter, less the mean of the draws, over their standard
deviation: over many curves its mean is 0 and its standard deviation 1. The column "covariance" is the mean Δχ² of draws from the normal distribution of the covariance. The command fails if
the mean Δχ² over all curves differs from the number of parameters by more than 10 %, or if a mean or a standard deviation of the pulls differs by more than four of its standard errors.
"""

import argparse
import sys
import warnings

import numpy as np

from andoyer import Body, Scene, fit
from andoyer.fit._search import random_states
from andoyer.fit._steps import root

AXES, NIGHTS, POINTS, DEGREE = np.array([1.0, 0.7, 0.5]), 20, 12, np.pi / 180


def simulated(seed, noise):
    """A scene, times [days], directions, brightnesses and their standard deviation."""
    generator = np.random.default_rng(seed)
    state = random_states(AXES, (0.25, 0.8), 2, generator).part(slice(seed % 2, seed % 2 + 1))
    scene = Scene(Body.ellipsoid(*AXES), state.attitudes[0], state.rates[0])
    times = np.sort(np.concatenate([night + generator.uniform(0, 0.3, POINTS) for night in range(NIGHTS)]))
    times -= times[0]
    sun = np.stack([np.cos(DEGREE * times), np.sin(DEGREE * times), 0 * times], axis=1)
    observer = np.stack([np.cos(0.5 + 2.5 * DEGREE * times), np.sin(0.5 + 2.5 * DEGREE * times), 0.1 + 0.01 * times], axis=1)
    exact = fit.brightness(AXES, scene.solve().attitude(times), sun, observer)
    sigma = noise * exact.mean()
    return scene, times, {"sun": sun, "observer": observer, "sigma": sigma}, exact + sigma * generator.standard_normal(len(times))


def of_covariance(found, count, seed):
    """The mean Δχ² of draws from the covariance."""
    square_root = root(found.covariance, found._steps)
    steps = np.random.default_rng(seed).standard_normal((count, len(square_root))) @ square_root.T
    return float(np.mean(found._model.chi_squares(steps)) - found.chi_square)


def parameters(states, scene):
    """Rotation vectors from the attitude of a scene, angular velocities, and logarithms of the ratios of moments, shape (n, 8)."""
    turns = (scene.solve().rotation(scene.epoch).inv() * states.rotation(scene.epoch)).as_rotvec()
    moments = np.log(np.asarray(states.moments))
    return np.concatenate([turns, states.angular_velocities, moments[:, :2] - moments[:, 2:]], axis=1)


def compared(seed, arguments):
    """Mean Δχ² of draws from the covariance and from the fit, effective size, and pulls."""
    scene, times, seen, measured = simulated(seed, arguments.noise)
    found = fit.light_curve(AXES, times, measured, scene=scene, shape=arguments.shape, **seen)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # the effective size is printed
        drawn = found.draws(arguments.draws, seed)
    values = parameters(drawn.states, scene)[:, : 8 if arguments.shape else 6]
    truth = np.concatenate([np.zeros(3), scene.angular_velocity, np.log(scene.body.moments[:2] / scene.body.moments[2])])[: values.shape[1]]
    pulls = (truth - values.mean(axis=0)) / values.std(axis=0)
    return found, of_covariance(found, arguments.draws, seed), drawn, pulls


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--curves", type=int, default=50)
    parser.add_argument("--draws", type=int, default=1000)
    parser.add_argument("--noise", type=float, default=0.02)
    parser.add_argument("--shape", action="store_true", help="fit the axis ratios too")
    arguments = parser.parse_args()
    expected = 8 if arguments.shape else 6
    means, normal, sizes, pulls = [], [], [], []
    for seed in range(arguments.curves):
        found, of_normal, drawn, pull = compared(seed, arguments)
        means.append(drawn.delta_chi_square.mean())
        normal.append(of_normal)
        sizes.append(drawn.effective_size / arguments.draws)
        pulls.append(pull)
        print(
            f"{seed:3}  {found._steps.origin.solve().plan.mode:10}  covariance {of_normal:7.1f}  draws {means[-1]:5.2f}  effective size {sizes[-1]:.0%}",
            flush=True,
        )
    pulls = np.array(pulls)
    count = pulls.size / expected  # pulls of one curve depend on each other
    mean, spread = float(pulls.mean()), float(pulls.std())
    print(
        f"mean Δχ² of {expected} parameters: {np.mean(means):.2f} (of single curves {min(means):.2f} to {max(means):.2f}); from the covariance {np.mean(normal):.1f} ({min(normal):.1f} to {max(normal):.1f})"
    )
    print(f"effective size: median {np.median(sizes):.0%}, least {min(sizes):.0%}")
    print(
        f"pulls: mean {mean:.3f}, standard deviation {spread:.3f}; within 1: {np.mean(np.abs(pulls) < 1):.1%} (68.3 %), within 2: {np.mean(np.abs(pulls) < 2):.1%} (95.4 %)"
    )
    print("standard deviation of each parameter's pulls:", " ".join(f"{value:.2f}" for value in pulls.std(axis=0)))
    right = abs(np.mean(means) / expected - 1) < 0.1 and abs(mean) < 4 / np.sqrt(count) and abs(spread - 1) < 4 / np.sqrt(2 * count)
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
