"""Compare the integrated method with heyoka's integration of the same equations, in nine regimes.

    python benches/rivals/integration.py [--scenes 30] [--seed 1] [--tolerance 1e-10] [--no-cost] [--output docs/data/rivals-integration.csv]
    python benches/rivals/integration.py --batch [--output docs/data/rivals-batch.csv]

Random scenes of each regime: slow, synchronous, 3:2, fast, two bodies, precessing, eccentric (up to 0.95), near the separatrix, long axis. The reference is heyoka in extended precision (80 bits, tolerance
1e-19) with the same doubles. The table has the largest error, the number of errors above the error bound, the number of errors above the tolerance if `Plan.meets_tolerance` is True, the quantiles of bound / error, and the least
ratio of the bound without its floor of 1e-14 and an error above 2e-14.

Cost: CPU seconds for set-up and 200 samples of one scene in each regime. andoyer's time includes its error bound. heyoka's time excludes its compilation (constants are in the equations), which
is in the last column. "At tolerance": heyoka at the largest tolerance of a grid whose error is within the requested tolerance. "At error": the same for andoyer's own error, or heyoka's smallest
tolerance. The engines take turns. A ratio, heyoka / andoyer, is the median of the ratios of the rounds of one run.

`--batch`: ensembles of 64 members (rates that differ by 1e-3) in the regimes with one fixed orbit, on one thread, against heyoka's batch mode with eight lanes at equal error, and
against as many scenes one after another.
"""

import argparse
import math
import os
import sys
import time
import warnings
from pathlib import Path
from statistics import median

os.environ["RAYON_NUM_THREADS"] = "1"

import heyoka as hy
import numpy as np
from written import write

import andoyer

SAMPLES = 200
FLOOR = 1e-14  # rounding errors of the evaluation in the error bound [rad]
ORBIT_PARAMETERS = 9  # mean motion, e, mean anomaly at 0, node and its rate, argument and its rate, inclination, attraction
GRID = [1e-8, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 2.2e-16, 1e-17]


def equations(bodies, number):
    """The full equations; `number(k)` is parameter k: the three moments, then nine for each body."""
    x, y, z, w, p, q, r = hy.make_vars(*"xyzwpqr")
    a, b, c = (number(k) for k in range(3))
    torque = [0.0, 0.0, 0.0]
    for body in range(bodies):
        n, e, anomaly, node, node_rate, argument, argument_rate, inclination, attraction = (
            number(3 + ORBIT_PARAMETERS * body + k) for k in range(ORBIT_PARAMETERS)
        )
        eccentric = hy.kepE(e, anomaly + n * hy.time)
        inverse = 1.0 / (1.0 - e * hy.cos(eccentric))
        along, across = (hy.cos(eccentric) - e) * inverse, (1.0 - e * e) ** 0.5 * hy.sin(eccentric) * inverse
        turn = argument + argument_rate * hy.time
        first = along * hy.cos(turn) - across * hy.sin(turn)
        second = along * hy.sin(turn) + across * hy.cos(turn)
        level, height = second * hy.cos(inclination), second * hy.sin(inclination)
        turn = node + node_rate * hy.time
        i, j, k = first * hy.cos(turn) - level * hy.sin(turn), first * hy.sin(turn) + level * hy.cos(turn), height
        s1 = (1 - 2 * (y * y + z * z)) * i + 2 * (x * y + z * w) * j + 2 * (x * z - y * w) * k
        s2 = 2 * (x * y - z * w) * i + (1 - 2 * (x * x + z * z)) * j + 2 * (y * z + x * w) * k
        s3 = 2 * (x * z + y * w) * i + 2 * (y * z - x * w) * j + (1 - 2 * (x * x + y * y)) * k
        strength = 3.0 * attraction * inverse * inverse * inverse
        torque = [torque[0] + strength * s2 * s3, torque[1] + strength * s3 * s1, torque[2] + strength * s1 * s2]
    return [
        (x, 0.5 * (w * p + y * r - z * q)),
        (y, 0.5 * (w * q + z * p - x * r)),
        (z, 0.5 * (w * r + x * q - y * p)),
        (w, -0.5 * (x * p + y * q + z * r)),
        (p, (c - b) / a * (torque[0] - q * r)),
        (q, (a - c) / b * (torque[1] - r * p)),
        (r, (b - a) / c * (torque[2] - p * q)),
    ]


def parameters(scene):
    orbits = scene.orbit if isinstance(scene.orbit, tuple) else (scene.orbit,)
    numbers = list(scene.body.moments)
    for o in orbits:
        # The elements are doubles of time 0: the pericentre of every scene is passed then.
        numbers += [o.mean_motion, o.eccentricity, 0.0, o.node, o.node_rate, o.argument_of_pericentre, o.pericentre_rate, o.inclination, o.attraction]
    return numbers, len(orbits)


class Reference:
    """heyoka in extended precision, one integrator for each number of bodies."""

    def __init__(self):
        self.integrators = {}

    def __call__(self, scene, times):
        numbers, bodies = parameters(scene)
        if bodies not in self.integrators:
            state = np.zeros(7, np.longdouble)
            state[3] = 1.0
            self.integrators[bodies] = hy.taylor_adaptive(
                equations(bodies, lambda k: hy.par[k]),
                state,
                tol=np.longdouble(1e-19),
                fp_type=np.longdouble,
                pars=np.zeros(3 + ORBIT_PARAMETERS * bodies, np.longdouble),
            )
        integrator = self.integrators[bodies]
        integrator.pars[:] = np.array(numbers, np.longdouble)
        integrator.time = np.longdouble(0)
        integrator.state[:] = np.concatenate([scene.attitude, scene.angular_velocity]).astype(np.longdouble)
        return integrator.propagate_grid(np.array(times, np.longdouble))[-1].astype(float)


def apart(one, other):
    """Angles between attitudes."""
    x, y, z, w = np.moveaxis(one, -1, 0)
    a, b, c, d = np.moveaxis(other, -1, 0)
    vector = np.stack([w * a - d * x - (y * c - z * b), w * b - d * y - (z * a - x * c), w * c - d * z - (x * b - y * a)])
    return 2 * np.arctan2(np.linalg.norm(vector, axis=0), np.abs(w * d + x * a + y * b + z * c))


def rotation(axis, angle):
    return [*(math.sin(angle / 2) * np.array(axis)), math.cos(angle / 2)]


def drawn(regime, random):
    """Moments, attitude, rates, orbits, span of a random scene; the mean motion of the first orbit is 1."""
    largest = 1.0
    middle = random.uniform(0.55, 0.999)
    least = random.uniform(max(1 - middle + 0.01, 0.1), middle)
    moments = np.array([least, middle, largest])
    attitude = random.normal(size=4)
    attitude /= np.linalg.norm(attitude)
    direction = random.normal(size=3)
    direction /= np.linalg.norm(direction)
    e, span = random.uniform(0, 0.3), 2 * math.pi * random.uniform(1.5, 4)
    orbit = {"inclination": random.uniform(0, math.pi), "node": random.uniform(0, 6), "argument_of_pericentre": random.uniform(0, 6)}
    orbits = []
    match regime:
        case "slow":
            rates = direction * 10 ** random.uniform(-4, -0.3)
        case "synchronous" | "3:2":
            moments = np.array([1 - random.uniform(0.01, 0.2), 1 - random.uniform(1e-3, 0.009), 1.0])
            orbit = {}
            attitude = rotation([0.6, 0.8, 0.0], random.uniform(0, 0.1))
            rates = np.array([0.05, -0.03, 1.0 if regime == "synchronous" else 1.5]) * (1 + random.uniform(-0.02, 0.02, 3))
            e, span = random.uniform(0, 0.1) if regime == "synchronous" else 0.2, 2 * math.pi * 20
        case "fast":
            rates, span = direction * 10 ** random.uniform(1, 2.3), 2 * math.pi * random.uniform(1, 4)
        case "two bodies":
            rates = direction * 10 ** random.uniform(0.3, 1.5)
            orbits = [
                andoyer.Orbit(random.uniform(0.1, 3), random.uniform(0, 0.5), attraction=random.uniform(0.1, 2), node=1.0, inclination=random.uniform(0, 3))
            ]
        case "precessing":
            rates = direction * 10 ** random.uniform(0.3, 1.5)
            orbit |= {"node_rate": random.uniform(-0.2, 0.2), "pericentre_rate": random.uniform(-0.2, 0.2)}
        case "eccentric":
            rates, e = direction * 10 ** random.uniform(0.5, 2), 1 - 10 ** random.uniform(-1.3, -0.3)
        case "separatrix":
            # Momentum near the middle axis.
            rates = 20 * np.array([random.normal() * 1e-2, 1.0, random.normal() * 1e-2])
            span = 2 * math.pi * 1.5
        case "long axis":
            rates = 10 ** random.uniform(0.5, 2) * np.array([1.0, random.normal() * 0.1, random.normal() * 0.1])
    orbits = [andoyer.Orbit(1.0, e, **orbit), *orbits]
    return moments, attitude, rates, orbits, span


REGIMES = ["slow", "synchronous", "3:2", "fast", "two bodies", "precessing", "eccentric", "separatrix", "long axis"]


def scene_of(regime, random, tolerance, method="integrated"):
    moments, attitude, rates, orbits, span = drawn(regime, random)
    orbit = orbits[0] if len(orbits) == 1 else orbits
    return andoyer.Scene(andoyer.Body(moments), attitude, rates, orbit=orbit, span=(0, span), tolerance=tolerance, method=method)


def cost(scene, times, exact, rounds=7):
    """Median ratios heyoka / andoyer with heyoka at the loosest tolerance of a grid whose error is within the tolerance, and within andoyer's own error; CPU seconds of andoyer; seconds of
    a compilation."""
    numbers, bodies = parameters(scene)
    start = np.concatenate([scene.attitude, scene.angular_velocity])
    ours = apart(scene.solve().attitude(times), exact[:, :4]).max()
    engines, compiled = {}, 0.0
    for tolerance in GRID:
        clock = time.perf_counter()
        integrator = hy.taylor_adaptive(equations(bodies, lambda k: hy.expression(float(numbers[k]))), start, tol=tolerance)
        compiled = max(compiled, time.perf_counter() - clock)

        def by_heyoka(integrator=integrator):
            integrator.time = 0.0
            integrator.state[:] = start
            return integrator.propagate_grid(times)[-1]

        error = apart(by_heyoka()[:, :4], exact[:, :4]).max()
        for name, bound in ("tolerance", scene.tolerance), ("error", ours):
            if name not in engines and (error <= bound or tolerance == GRID[-1]):
                engines[name] = by_heyoka
        if len(engines) == 2:
            break

    engines["andoyer"] = lambda: scene.solve().at(times)
    seconds = {name: [] for name in engines}
    for _ in range(rounds):
        for name, engine in engines.items():
            clock, runs = time.process_time(), 0
            while time.process_time() - clock < 0.03:
                engine()
                runs += 1
            seconds[name].append((time.process_time() - clock) / runs)
    ratios = [median(np.array(seconds[name]) / seconds["andoyer"]) for name in ("tolerance", "error")]
    return *ratios, median(seconds["andoyer"]), compiled


def batch(regime, tolerance, rounds=5):
    """Median ratios of the times of heyoka's batch mode and of single scenes to that of an ensemble, the largest error of eight members, heyoka's tolerance, and seconds of a member."""
    random = np.random.default_rng([7, REGIMES.index(regime)])
    members, lanes = 64, 8
    scene = scene_of(regime, random, tolerance)
    while not scene.solve().plan.meets_tolerance:
        scene = scene_of(regime, random, tolerance)
    numbers, bodies = parameters(scene)
    rates = scene.angular_velocity * (1 + 1e-3 * random.normal(size=(members, 3)))
    attitudes = np.repeat(scene.attitude[None], members, axis=0)
    times = np.linspace(0, scene.span[1], SAMPLES)

    def ensemble():
        return andoyer.Ensemble(
            np.repeat(scene.body.moments[None], members, axis=0),
            attitudes,
            rates,
            orbits=scene.orbit,
            tolerance=tolerance,
            span=scene.span,
            method="integrated",
            threads=1,
        )

    reference = Reference()
    some = [andoyer.Scene(scene.body, scene.attitude, rate, orbit=scene.orbit, span=scene.span, tolerance=tolerance) for rate in rates[:lanes]]
    exact = np.stack([reference(one, times)[:, :4] for one in some])
    ours = apart(ensemble().attitude(times)[:lanes], exact).max()
    grid = np.repeat(times[:, None], lanes, axis=1)
    for allowed in GRID:
        start = np.concatenate([attitudes[:lanes].T, rates[:lanes].T])
        integrator = hy.taylor_adaptive_batch(equations(bodies, lambda k: hy.expression(float(numbers[k]))), start.copy(), tol=allowed)

        def group(first, integrator=integrator):
            integrator.set_time(0.0)
            integrator.state[:] = np.concatenate([attitudes[first : first + lanes].T, rates[first : first + lanes].T])
            return integrator.propagate_grid(grid)[1]

        if apart(np.moveaxis(group(0)[:, :4], 2, 0), exact).max() <= ours:
            break
    engines = {
        "heyoka": lambda: [group(first) for first in range(0, members, lanes)],
        "andoyer": lambda: ensemble().attitude(times),
        "alone": lambda: [
            andoyer.Scene(scene.body, scene.attitude, rate, orbit=scene.orbit, span=scene.span, tolerance=tolerance, method="integrated")
            .solve()
            .attitude(times)
            for rate in rates
        ],
    }
    seconds = {name: [] for name in engines}
    for _ in range(rounds):
        for name, engine in engines.items():
            clock = time.process_time()
            engine()
            seconds[name].append(time.process_time() - clock)
    ratios = [median(np.array(seconds[name]) / seconds["andoyer"]) for name in ("heyoka", "alone")]
    return *ratios, ours, allowed, median(seconds["andoyer"]) / members


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--scenes", type=int, default=30)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--tolerance", type=float, default=1e-10)
    options.add_argument("--no-cost", action="store_true")
    options.add_argument("--batch", action="store_true")
    options.add_argument("--output", type=Path)
    asked = options.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    if asked.batch:
        print(f"{'regime':<13}{'heyoka batch':>13}{'alone':>7}{'error':>9}{'heyoka at':>11}{'us a member':>13}")
        rows = []
        for regime in REGIMES:
            if regime not in ("two bodies", "precessing"):
                ratio, alone, error, allowed, seconds = batch(regime, asked.tolerance)
                print(f"{regime:<13}{ratio:>13.2f}{alone:>7.2f}{error:>9.1e}{allowed:>11.0e}{1e6 * seconds:>13.0f}", flush=True)
                rows.append([regime, f"{ratio:.2f}", f"{alone:.2f}", f"{error:.1e}", f"{allowed:.0e}", f"{1e6 * seconds:.0f}"])
        write(asked.output, ["regime", "ratio", "alone", "error", "heyoka_tolerance", "us_a_member"], rows)
        return
    reference, lines, rows, bad = Reference(), [], [], 0
    lines.append(f"tolerance {asked.tolerance:g}, {asked.scenes} scenes a regime, heyoka {hy.__version__}, andoyer {andoyer.__version__}")
    lines.append(
        f"{'regime':<13}{'worst error':>12}{'its bound':>11}{'beyond bound':>14}{'beyond tolerance':>18}{'missed':>8}{'refused':>9}  {'bound/error q5, q50, q95':>26}{'least':>9}  {'at tolerance':>11}{'at error':>13}{'ms':>9}{'compiled, s':>12}"
    )
    for regime in REGIMES:
        random = np.random.default_rng([asked.seed, REGIMES.index(regime)])
        errors, bounds, beyond, missed, refused, priced = [], [], 0, 0, 0, ""
        for index in range(asked.scenes):
            scene = scene_of(regime, random, asked.tolerance)
            times = np.linspace(0, scene.span[1], SAMPLES)
            try:
                motion = scene.solve()
            except andoyer.TheoryError:
                refused += 1
                continue
            exact = reference(scene, times)
            error = apart(motion.attitude(times), exact[:, :4]).max()
            errors.append(error)
            bounds.append(motion.plan.error_bound)
            missed += not motion.plan.meets_tolerance
            beyond += motion.plan.meets_tolerance and error > asked.tolerance
            if error > motion.plan.error_bound:
                print(f"beyond the bound: {regime} {index}: {error:.2e} and {motion.plan.error_bound:.2e}", file=sys.stderr)
            if not priced and not asked.no_cost and motion.plan.meets_tolerance:
                at_tolerance, at_error, seconds, compiled = cost(scene, times, exact)
                rows.append([regime, *(f"{number:.3g}" for number in (at_tolerance, at_error, seconds * 1e3, compiled))])
                priced = f"{at_tolerance:>13.2f}{at_error:>13.2f}{seconds * 1e3:>9.2f}{compiled:>12.1f}"
        errors, bounds = np.array(errors), np.array(bounds)
        outside = int((errors > bounds).sum())
        bad += outside + beyond
        worst = int(errors.argmax())
        quantiles = ", ".join(f"{q:.0f}" for q in np.quantile(bounds / np.maximum(errors, 1e-17), [0.05, 0.5, 0.95]))
        clear = errors > 2 * FLOOR
        least = f"{((bounds - FLOOR)[clear] / errors[clear]).min():.1f}" if clear.any() else "-"
        lines.append(
            f"{regime:<13}{errors[worst]:>12.1e}{bounds[worst]:>11.1e}{outside:>14}{beyond:>18}{missed:>8}{refused:>9}  {quantiles:>26}{least:>9}  {priced}"
        )
    text = "\n".join(lines)
    print(text)
    write(asked.output, ["regime", "ratio_at_tolerance", "ratio_at_error", "milliseconds", "compilation_s"], rows)
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()
