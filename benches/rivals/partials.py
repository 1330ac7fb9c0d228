"""Compare Motion.partials with heyoka's variational equations, in one run: derivatives of attitude and rates.

heyoka integrates Euler's equations and q′ = q ω/2 with their first-order variational equations in the seven initial values and the three moments, 70 derivatives a sample. andoyer computes 54 derivatives;
those of the attitude are rotation vectors. Times are uniform over a hundred rotations; under a torque, an orbit with n = 0.02 and e = 0.3, there are 201 of them, and both integrate. CPU time of one core is measured,
and each derivative of andoyer is compared with that of heyoka. heyoka's compilation is not counted; its integration is counted.

    python benches/rivals/partials.py [--samples 20001] [--output docs/data/rivals-partials.csv]
"""

import argparse
import os
import warnings
from pathlib import Path

os.environ["RAYON_NUM_THREADS"] = "1"  # before andoyer starts its threads

import heyoka
import integration
import numpy as np
from propagators import cpu
from written import write

import andoyer

TOLERANCE = 1e-12
# Moments, rates, and the arguments of an orbit.
SCENES = {
    "short-axis": ([1.0, 1.5, 2.0], [0.1, 0.2, 1.0], ()),
    "long-axis": ([1.0, 3.0836, 3.235], [1.3, 0.2, 0.3], ()),
    "needle": ([0.2294, 0.9638, 1.0], [0.05, 0.02, 1.0], ()),
    "under a torque": ([0.5, 0.75, 1.0], [0.2, 0.3, 1.1], (0.02, 0.3)),
}
FEWER = 201
COLUMNS = "scene samples heyoka_ns ours_ns ratio difference"
ATTITUDE = [0.0, 0.0, 0.0, 1.0]


def equations(scene):
    """Euler's equations and q′ = q ω/2 with the torque of a scene's orbit, if it has one. The moments are parameters."""
    if not scene.orbit:
        return integration.equations(0, lambda k: heyoka.par[k])
    numbers, bodies = integration.parameters(scene)
    return integration.equations(bodies, lambda k: heyoka.par[k] if k < 3 else heyoka.expression(float(numbers[k])))


def rival(scene):
    system = heyoka.var_ode_sys(equations(scene), heyoka.var_args.vars | heyoka.var_args.params, order=1)
    # The state, then its derivatives row by row: by initial values and by moments.
    start = np.zeros(77)
    start[:7] = [*scene.attitude, *scene.angular_velocity]
    start[7:].reshape(7, 10)[:, :7] = np.eye(7)
    integrator = heyoka.taylor_adaptive(system, start, pars=scene.body.moments, tol=TOLERANCE)
    return integrator, start


def run(integrator, start, times):
    integrator.time = 0.0
    integrator.state[:] = start
    return integrator.propagate_grid(times)[5]


def by_rotation_vectors(states):
    """The columns of Motion.partials from the derivatives of heyoka: attitude and rates, (n, 3, 9) each."""
    quaternions, derivatives = states[:, :4], states[:, 7:].reshape(-1, 7, 10)
    x, y, z, w = quaternions.T
    # Twice the vector part of q⁻¹ dq.
    rows = 2 * np.stack([[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z]]).transpose(2, 0, 1)
    # At the start a rotation δθ changes q = [0, 0, 0, 1] by δθ/2.
    turned = np.einsum("nij,njk->nik", rows, derivatives[:, :4])
    columns = [0.5 * turned[:, :, :3], turned[:, :, 4:7], turned[:, :, 7:]]
    changed = [0.5 * derivatives[:, 4:, :3], derivatives[:, 4:, 4:7], derivatives[:, 4:, 7:]]
    return np.concatenate(columns, axis=2), np.concatenate(changed, axis=2)


def main(options):
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)  # derivatives do not depend on it
    rows = []
    print("| scene | samples | heyoka [ns a sample] | Motion.partials | ratio | largest difference, relative |")
    print("|---|---|---|---|---|---|")
    for name, (moments, rates, orbit) in SCENES.items():
        body = andoyer.Body(moments)
        length = 100 * 2 * np.pi / andoyer.Scene(body, ATTITUDE, rates).solve().frequencies.longitude
        times = np.linspace(0, length, FEWER if orbit else options.samples)
        asked = {"orbit": andoyer.Orbit(*orbit), "span": (0, length), "method": "integrated"} if orbit else {}
        scene = andoyer.Scene(body, ATTITUDE, rates, **asked)
        motion = scene.solve()
        integrator, start = rival(scene)
        theirs, states = cpu(lambda integrator=integrator, start=start, times=times: run(integrator, start, times))
        ours, partials = cpu(lambda motion=motion, times=times: motion.partials(times))
        differences = [
            np.abs(mine - other).max() / np.abs(other).max() for mine, other in zip((partials.attitude, partials.angular_velocity), by_rotation_vectors(states))
        ]
        nanoseconds = [f"{seconds / len(times) * 1e9:.0f}" for seconds in (theirs, ours)]
        rows.append([name, len(times), *nanoseconds, f"{theirs / ours:.1f}", f"{max(differences):.0e}"])
        print("| " + " | ".join(map(str, rows[-1])) + " |", flush=True)
    write(options.output, COLUMNS.split(), rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=20_001)
    parser.add_argument("--output", type=Path)
    main(parser.parse_args())
