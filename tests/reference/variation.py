"""Derivatives under gravity gradients by heyoka's variational equations in 80-bit reals: tests/data/variation.json.

The equations are Euler's with the torque Σ 3μ/r³ r̂ × I r̂ and q′ = q ω/2; the positions come from Kepler's equation. The parameters are the moments and, for each of up to two bodies, mean motion, eccentricity, time of
pericentre, inclination, node, argument of pericentre and attraction. A column of the initial attitude is a rotation vector about body axes, and so is a change of the attitude.

    python tests/reference/variation.py [--scenes 18] [--seed 1] [-o tests/data/variation.json]
    python tests/reference/variation.py --scenes 300 --compare          the library against them, by kind of scene

Needs heyoka 7 and NumPy; --compare needs the package.
"""

import argparse
import json
from pathlib import Path

import heyoka as hy
import numpy as np

REAL = np.longdouble
KINDS = ("generic", "middle axis", "separatrix", "nearly a sphere", "high eccentricity", "two bodies")
ROUNDINGS = (64, 128, 256)
"""Numbers of roundings on the way; each number is one sample of what rounding does."""
OUTPUT = Path(__file__).parents[1] / "data" / "variation.json"


def system(bodies):
    """The variational equations with respect to the state and all parameters."""
    x, y, z, w, p, q, r = hy.make_vars("x", "y", "z", "w", "p", "q", "r")
    a, b, c = moments = [hy.par[i] for i in range(3)]
    rates = [(b - c) / a * q * r, (c - a) / b * r * p, (a - b) / c * p * q]
    matrix = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    for body in range(bodies):
        n, e, passage, tilt, node, argument, attraction = [hy.par[3 + 7 * body + k] for k in range(7)]
        anomaly = hy.kepE(e, n * (hy.time - passage))
        along, across = hy.cos(anomaly) - e, hy.sqrt(1 - e * e) * hy.sin(anomaly)
        distance = 1 - e * hy.cos(anomaly)
        one = [hy.cos(argument) * along - hy.sin(argument) * across, hy.sin(argument) * along + hy.cos(argument) * across]
        flat = [one[0], hy.cos(tilt) * one[1], hy.sin(tilt) * one[1]]
        place = [
            hy.cos(node) * flat[0] - hy.sin(node) * flat[1],
            hy.sin(node) * flat[0] + hy.cos(node) * flat[1],
            flat[2],
        ]
        u = [sum(matrix[row][column] * place[row] for row in range(3)) / distance for column in range(3)]
        strength = 3 * attraction / distance**3
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            rates[i] = rates[i] + strength * (moments[k] - moments[j]) / moments[i] * u[j] * u[k]
    slopes = [
        0.5 * (w * p + y * r - z * q),
        0.5 * (w * q + z * p - x * r),
        0.5 * (w * r + x * q - y * p),
        -0.5 * (x * p + y * q + z * r),
        *rates,
    ]
    equations = hy.var_ode_sys(list(zip([x, y, z, w, p, q, r], slopes)), hy.var_args.vars | hy.var_args.params, order=1)
    # The steps keep errors below the tolerance times the largest of all derivatives: it is so small that the smallest column keeps its digits.
    return hy.taylor_adaptive(equations, np.zeros(7 * (1 + 7 + 3 + 7 * bodies), REAL), tol=REAL(1e-28), fp_type=REAL, compact_mode=True)


def derivatives(integrator, scene, time, roundings=0):
    """The derivatives of attitude and rates, (3, k) each. `roundings`: how many times state and derivatives are rounded to doubles on the way."""
    bodies = len(scene["orbits"])
    columns = 10 + 7 * bodies
    start = np.zeros((7, 1 + columns), REAL)
    start[:, 0] = [*scene["attitude"], *scene["angular_velocity"]]
    start[:4, 0] /= np.sqrt((start[:4, 0] ** 2).sum())
    start[:, 1:8] = np.eye(7)
    integrator.time = REAL(scene["epoch"])
    integrator.state[:] = np.concatenate([start[:, 0], start[:, 1:].ravel()])
    integrator.pars[:] = np.array([*scene["moments"], *np.ravel(scene["orbits"])], REAL)
    for share in np.arange(roundings) / max(roundings, 1):
        integrator.propagate_until(REAL(scene["epoch"] + share * (time - scene["epoch"])))
        integrator.state[:] = integrator.state.astype(float)
    integrator.propagate_until(REAL(time))
    state, rows = integrator.state[:7], integrator.state[7:].reshape(7, columns)

    def left(quaternion):
        """Twice the vector part of q⁻¹ δq."""
        x, y, z, w = quaternion
        return 2 * np.array([[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z]])

    # A rotation δθ of the start changes q by q [δθ, 0]/2.
    back = left(start[:4, 0]).T / 4
    whole = np.vstack([left(state[:4]) @ rows[:4], rows[4:]])
    return np.hstack([whole[:, :4] @ back, whole[:, 4:]])


def conditioned(integrator, scene):
    """The derivatives, and the largest change of each column of attitude and rates, relative to its largest derivative, by rounding on the way and by one unit in the last place of the orbits."""
    truth = derivatives(integrator, scene, scene["time"])
    moved = scene | {"orbits": (np.array(scene["orbits"]) * (1 + 2.0**-52)).tolist()}
    changed = [derivatives(integrator, scene, scene["time"], roundings) for roundings in ROUNDINGS] + [derivatives(integrator, moved, scene["time"])]
    changes = [relative(value - truth, truth) for value in changed]
    return truth, np.max(changes, axis=0)


def relative(difference, truth):
    """The largest entries of attitude and rates in each column, over the largest derivatives."""
    return np.abs(difference).reshape(2, 3, -1).max(axis=1) / np.abs(truth).reshape(2, 3, -1).max(axis=1)


def random_scene(random, kind):
    moments = np.sort(random.uniform(0.3, 1.0, 3))
    moments = moments / moments[2] if moments[:2].sum() > moments[2] else np.array([0.6, 0.8, 1.0])
    rates = random.normal(size=3)
    if kind == "nearly a sphere":
        moments = np.array([1.0, 1.0, 1.0]) + 10.0 ** random.uniform(-7, -2) * random.uniform(0.1, 1.0, 3)
    if kind == "middle axis":
        rates = np.array([1e-3, 1.0, -1e-3]) * random.normal(size=3)
    if kind == "separatrix":
        a, b, c = moments
        rates = np.array([np.sqrt((c - b) * c / ((b - a) * a)), random.normal(), 1.0]) * (1 + 1e-4 * random.normal(size=3))
    moments = random.permutation(moments) if kind in ("generic", "two bodies") else moments
    rates = rates / np.sqrt((rates**2).sum()) * 10.0 ** random.uniform(-1, 0.5)
    spin = np.sqrt((rates**2).sum())
    orbits = []
    for _ in range(2 if kind == "two bodies" else 1):
        motion = spin * 10.0 ** random.uniform(-2, 0)
        e = 1 - 10.0 ** random.uniform(-1.5, -0.5) if kind == "high eccentricity" else random.uniform(0, 0.6)
        angles = random.uniform(0, 2 * np.pi, 3)
        orbits.append([motion, e, random.uniform(-1, 1) / motion, angles[0] / 2, angles[1], angles[2], motion**2 * random.uniform(0.1, 1.0)])
    attitude = random.normal(size=4)
    turns = 10.0 ** random.uniform(0, 1.3) * random.choice([-1, 1])
    scene = {
        "kind": kind,
        "moments": moments.tolist(),
        "attitude": (attitude / np.sqrt((attitude**2).sum())).tolist(),
        "angular_velocity": rates.tolist(),
        "epoch": float(random.uniform(-1, 1)),
        "orbits": [[float(value) for value in orbit] for orbit in orbits],
    }
    return scene | {"time": float(scene["epoch"] + turns * 2 * np.pi / spin)}


def found(scene):
    import warnings

    import andoyer

    warnings.simplefilter("ignore")  # the tolerance has no effect on derivatives

    names = ("mean_motion", "eccentricity", "time_of_pericentre", "inclination", "node", "argument_of_pericentre", "attraction")
    orbits = [andoyer.Orbit(**dict(zip(names, orbit))) for orbit in scene["orbits"]]
    state = (scene["attitude"], scene["angular_velocity"])
    span = sorted((scene["epoch"], scene["time"]))
    motion = andoyer.Scene(andoyer.Body(scene["moments"]), *state, orbit=orbits, epoch=scene["epoch"], span=span, method="integrated", tolerance=1e-6).solve()
    groups = ["attitude", "angular_velocity", "moments"]
    for body in range(len(orbits)):
        groups += [("orbit", body), ("attraction", body)]
    partials = motion.partials(scene["time"], with_respect_to=groups)
    return np.vstack([partials.attitude, partials.angular_velocity])


def main(arguments):
    random = np.random.default_rng(arguments.seed)
    integrators = {bodies: system(bodies) for bodies in (1, 2)}
    scenes = []
    errors = {kind: [] for kind in KINDS}
    for index in range(arguments.scenes):
        scene = random_scene(random, KINDS[index % len(KINDS)])
        truth, change = conditioned(integrators[len(scene["orbits"])], scene)
        if arguments.compare:
            error = relative(found(scene) - truth, truth)
            errors[scene["kind"]].append([float(error.max()), float((error / (1e-11 + change)).max())])
        else:
            scene["derivatives"] = [[float(value) for value in row] for row in truth]
            scene["by_rounding"] = [[float(f"{value:.1e}") for value in row] for row in change]
            scenes.append(scene)
    if arguments.compare:
        print("| scenes | number | error: median | 90 % | largest | largest over 1e-11 + change by rounding |\n|---|---|---|---|---|---|")
        for kind, values in errors.items():
            size, share = np.array(values).T
            print(f"| {kind} | {len(size)} | {np.median(size):.1e} | {np.quantile(size, 0.9):.1e} | {size.max():.1e} | {share.max():.1f} |")
    else:
        arguments.output.write_text("[\n" + ",\n".join(json.dumps(scene) for scene in scenes) + "\n]\n")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=18)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--compare", action="store_true")
    parser.add_argument("-o", "--output", type=Path, default=OUTPUT)
    main(parser.parse_args())
