"""Compare librations with the integration and with heyoka: run time against error, by span.

    python benches/rivals/libration.py [--orbits 100 1000 10000 100000] [--output docs/data/libration-rivals.csv]

Each scene is solved and sampled at 200 times over the span. Settings are tolerances. The reference is heyoka in extended precision (80 bits,
tolerance 1e-19) up to 10,000 orbits; beyond that it is the integration of andoyer at a tolerance of 1e-11, whose rows then have no error. Times are CPU seconds, the least of three rounds. heyoka's time excludes its compilation. "first" is the first libration of
a process, "next" that of another state of a body and orbit whose normal forms are kept.
"""

import argparse
import math
import os
import subprocess
import sys
import time
import warnings
from pathlib import Path

os.environ["RAYON_NUM_THREADS"] = "1"

import heyoka as hy
import numpy as np
from integration import Reference, apart, equations, parameters, rotation
from written import write

import andoyer

SAMPLES = 200
ROUNDS = 3
LONGEST = 2.0
"""A measurement above so many seconds is not repeated."""
EXTENDED = 10_000
"""Orbits up to which the reference is in extended precision."""
# Moments, eccentricity, rotations an orbit, angle in longitude [deg].
CASES = {
    "circle, 1 deg": ([0.55, 0.8, 1.0], 0.0, 1.0, 1.0),
    "Moon, 1 deg": ([0.99948, 0.999772, 1.0], 0.0549, 1.0, 1.0),
    "Mercury, 0.1 deg": ([0.9997, 0.999918, 1.0], 0.20563, 1.5, 0.1),
}
TOLERANCES = {"libration": (1e-3, 1e-5, 1e-7, 1e-9), "integrated": (1e-6, 1e-9, 1e-11), "heyoka": (1e-9, 1e-12, 1e-15)}


def scene_of(case, orbits, **options):
    moments, eccentricity, resonance, degrees = CASES[case]
    attitude = rotation([0.0, 0.0, 1.0], math.radians(degrees))
    span = (0, 2 * math.pi * orbits)
    return andoyer.Scene(andoyer.Body(moments), attitude, [0, 0, resonance], orbit=andoyer.Orbit(1.0, eccentricity), span=span, **options)


def seconds(work):
    """The least CPU time of some rounds, and the result."""
    least = math.inf
    for _ in range(ROUNDS):
        clock = time.process_time()
        result = work()
        least = min(least, time.process_time() - clock)
        if least > LONGEST:
            break
    return least, result


def first(case, orbits, setting):
    """The CPU time of the first libration of this process."""
    scene, times = scene_of(case, orbits, method="libration", tolerance=float(setting)), np.linspace(0, 2 * math.pi * orbits, SAMPLES)
    clock = time.process_time()
    scene.solve().attitude(times)
    return time.process_time() - clock


def alone(case, orbits, setting):
    """The same in processes of their own, the least of some."""
    command = [sys.executable, __file__, "--first", case, str(orbits), setting]
    return min(float(subprocess.run(command, capture_output=True, text=True, check=True).stdout) for _ in range(ROUNDS))


def engines(case, orbits, times):
    """Name, setting, and the work that gives attitudes."""
    for tolerance in TOLERANCES["libration"]:
        asked = {"method": "libration", "tolerance": tolerance}
        yield "first", f"{tolerance:.0e}", lambda asked=asked: scene_of(case, orbits, **asked).solve().attitude(times)
        kept = scene_of(case, orbits, **asked)
        yield "next", f"{tolerance:.0e}", lambda kept=kept: kept.solve().attitude(times)
    for tolerance in TOLERANCES["integrated"]:
        scene = scene_of(case, orbits, method="integrated", tolerance=tolerance)
        yield "integrated", f"{tolerance:.0e}", lambda scene=scene: scene.solve().attitude(times)
    scene = scene_of(case, orbits)
    numbers, bodies = parameters(scene)
    start = np.concatenate([scene.attitude, scene.angular_velocity])
    for tolerance in TOLERANCES["heyoka"]:
        integrator = hy.taylor_adaptive(equations(bodies, lambda k: hy.expression(float(numbers[k]))), start, tol=tolerance)

        def by_heyoka(integrator=integrator):
            integrator.time = 0.0
            integrator.state[:] = start
            return integrator.propagate_grid(times)[-1][:, :4]

        yield "heyoka", f"{tolerance:.0e}", by_heyoka


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--orbits", type=int, nargs="+", default=[100, 1000, 10_000, 100_000])
    options.add_argument("--output", type=Path)
    options.add_argument("--first", nargs=3, metavar=("CASE", "ORBITS", "TOLERANCE"), help="the CPU time of one first libration")
    asked = options.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    if asked.first:
        case, orbits, setting = asked.first
        print(first(case, int(orbits), setting))
        return 0
    reference, rows = Reference(), []
    for case in CASES:
        for orbits in asked.orbits:
            times = np.linspace(0, 2 * math.pi * orbits, SAMPLES)
            if orbits <= EXTENDED:
                exact = reference(scene_of(case, orbits), times)[:, :4]
            else:
                exact = scene_of(case, orbits, method="integrated", tolerance=1e-11).solve().attitude(times)
            for engine, setting, work in engines(case, orbits, times):
                try:
                    least, found = seconds(work)
                    if engine == "first":
                        least = alone(case, orbits, setting)
                except andoyer.Error as error:
                    print(f"{case:18s} {orbits:7d} orbits  {engine:10s} {setting:8s} {error}", flush=True)
                    continue
                itself = engine == "integrated" and orbits > EXTENDED
                error = math.nan if itself else apart(found, exact).max()
                print(f"{case:18s} {orbits:7d} orbits  {engine:10s} {setting:8s} error {error:.1e} rad  {1e3 * least:10.2f} ms", flush=True)
                rows.append([case, orbits, engine, setting, None if itself else f"{error:.2e}", f"{least:.5g}"])
    write(asked.output, ["case", "orbits", "engine", "setting", "error", "seconds"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
