"""Compare Motion.partials with heyoka's variational equations, in one run: derivatives of attitude and rates.

heyoka integrates Euler's equations and q′ = q ω/2 with their first-order variational equations in the seven initial values and the three moments, 70 derivatives a sample. andoyer computes 54 derivatives;
those of the attitude are rotation vectors. Times are uniform over a hundred rotations. CPU time of one core is measured, and each derivative of andoyer is compared with that of heyoka. heyoka's compilation is not
counted; its integration is counted.

    python benches/rivals/partials.py [--samples 20001]
"""

import argparse
import os

os.environ["RAYON_NUM_THREADS"] = "1"  # before andoyer starts its threads

import heyoka
import numpy as np
from propagators import cpu

import andoyer

TOLERANCE = 1e-12
SCENES = {
    "short-axis": ([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]),
    "long-axis": ([1.0, 3.0836, 3.235], [1.3, 0.2, 0.3]),
    "needle": ([0.2294, 0.9638, 1.0], [0.05, 0.02, 1.0]),
}
ATTITUDE = [0.0, 0.0, 0.0, 1.0]


def equations():
    """Attitude [x, y, z, w] and rates; the moments are parameters."""
    x, y, z, w, p, q, r = states = heyoka.make_vars("x", "y", "z", "w", "p", "q", "r")
    a, b, c = (heyoka.par[i] for i in range(3))
    slopes = [
        0.5 * (w * p + y * r - z * q),
        0.5 * (w * q + z * p - x * r),
        0.5 * (w * r + x * q - y * p),
        -0.5 * (x * p + y * q + z * r),
        (b - c) / a * q * r,
        (c - a) / b * r * p,
        (a - b) / c * p * q,
    ]
    return list(zip(states, slopes))


def rival(moments, rates):
    system = heyoka.var_ode_sys(equations(), heyoka.var_args.vars | heyoka.var_args.params, order=1)
    # The state, then its derivatives row by row: by initial values and by moments.
    start = np.zeros(77)
    start[:7] = [*ATTITUDE, *rates]
    start[7:].reshape(7, 10)[:, :7] = np.eye(7)
    integrator = heyoka.taylor_adaptive(system, start, pars=moments, tol=TOLERANCE)
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


def main(samples):
    print("| scene | heyoka [ns a sample] | Motion.partials | ratio | largest difference, relative |")
    print("|---|---|---|---|---|")
    for name, (moments, rates) in SCENES.items():
        motion = andoyer.Scene(andoyer.Body(moments), ATTITUDE, rates).solve()
        times = np.linspace(0, 100 * 2 * np.pi / motion.frequencies.longitude, samples)
        integrator, start = rival(moments, rates)
        theirs, states = cpu(lambda integrator=integrator, start=start, times=times: run(integrator, start, times))
        ours, partials = cpu(lambda motion=motion, times=times: motion.partials(times))
        differences = [
            np.abs(mine - other).max() / np.abs(other).max() for mine, other in zip((partials.attitude, partials.angular_velocity), by_rotation_vectors(states))
        ]
        nanoseconds = [seconds / samples * 1e9 for seconds in (theirs, ours)]
        print(f"| {name} | {nanoseconds[0]:.0f} | {nanoseconds[1]:.0f} | {theirs / ours:.1f} | {max(differences):.0e} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=20_001)
    main(parser.parse_args().samples)
