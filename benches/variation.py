"""Measure what the variation of the free motion's elements would cost beside the integration of the full equations.

    python benches/variation.py [--rotations 32]

Between two epochs the state at the epoch, y, changes by dy/dt = P(t)^-1 (0, torque / I), where P(t) are the derivatives of attitude and rates with respect to y (`Motion.partials`). An arc of one
or more rotations has Gauss-Legendre nodes, at which attitude and derivatives are evaluated once, about y at the start of the arc. Picard's iteration then moves y: it evaluates only the torque
again. The next arc starts from the exact free motion of the new y.

The table has, by the strength of the torque 3 (n/spin)^2: the error bound of the theory at a tolerance of 1e-12, the bound and the processor time a rotation of the integration, the smallest
error of the variation of elements and the number of nodes a rotation with which its error is below 1e-12, with its processor time a rotation: nodes times (attitude + partials), as measured in this
run, and two set-ups an arc. The torques in NumPy are not counted.
"""

import argparse
import math
import time
import warnings

import numpy as np

import andoyer

MOMENTS = np.array([0.5, 0.8, 1.0])
BODY = andoyer.Body(MOMENTS)
ATTITUDE = np.array([0.1, -0.2, 0.3, math.sqrt(0.86)])
TURN = 2 * math.pi


def product(one, other):
    vectors = one[..., 3:] * other[..., :3] + other[..., 3:] * one[..., :3] + np.cross(one[..., :3], other[..., :3])
    return np.concatenate([vectors, one[..., 3:] * other[..., 3:] - (one[..., :3] * other[..., :3]).sum(-1, keepdims=True)], -1)


def rotation(vector):
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate([0.5 * np.sinc(angle / TURN) * vector, np.cos(angle / 2)], -1)


def apart(one, other):
    return 2 * np.linalg.norm(product(one * [-1, -1, -1, 1], other)[..., :3])


def torque(attitudes, times, rate):
    """3 n^2 s x I s with s the direction of the disturbing body, on a circle inclined by acos 0.8, in body axes."""
    place = np.stack([np.cos(rate * times), 0.8 * np.sin(rate * times), 0.6 * np.sin(rate * times), 0 * times], -1)
    s = product(product(attitudes * [-1, -1, -1, 1], place), attitudes)[..., :3]
    return 3 * rate**2 * np.cross(s, MOMENTS * s)


def quadrature(count):
    """Nodes and weights on (0, 1), and the matrix that integrates from 0 to each node."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    integrals = [np.polynomial.legendre.Legendre.basis(k).integ(lbnd=-1)(nodes) / 2 for k in range(count)]
    matrix = np.stack(integrals, 1) @ np.linalg.inv(np.polynomial.legendre.legvander(nodes, count - 1))
    return (nodes + 1) / 2, weights / 2, matrix


def varied(rates, rate, arc, count, rotations):
    """The attitude after some rotations, by arcs of some rotations, and the largest number of iterations."""
    nodes, weights, matrix = quadrature(count)
    attitude, start, length, most = ATTITUDE, 0.0, arc * TURN, 0
    for _ in range(rotations // arc):
        motion = andoyer.Scene(BODY, attitude, rates, tolerance=1e-15).solve()
        free, partials = motion.attitude(nodes * length), motion.partials(nodes * length)
        turning = partials.attitude[:, :, :6]
        inverse = np.linalg.inv(np.concatenate([turning, partials.angular_velocity[:, :, :6]], 1))[:, :, 3:]
        change, end, last = np.zeros((count, 6)), np.zeros(6), np.inf
        for iteration in range(1, 12):
            moved = product(free, rotation(np.einsum("nij,nj->ni", turning, change)))
            slopes = np.einsum("nij,nj->ni", inverse, torque(moved, start + nodes * length, rate) / MOMENTS)
            last, end, change = end, weights @ slopes * length, matrix @ slopes * length
            most = max(most, iteration)
            if np.abs(end - last).max() < 2e-15:
                break
        attitude, rates = product(attitude, rotation(end[:3])), rates + end[3:]
        sample = andoyer.Scene(BODY, attitude, rates, tolerance=1e-15).solve().at([length])
        attitude, rates, start = sample.attitude[0], sample.angular_velocity[0], start + length
    return attitude, most


def seconds(task, repeats=7):
    """Median processor time."""
    taken = []
    for _ in range(repeats):
        clock, runs = time.process_time(), 0
        while time.process_time() - clock < 0.03:
            task()
            runs += 1
        taken.append((time.process_time() - clock) / runs)
    return float(np.median(taken))


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--rotations", type=int, default=32)
    rotations = options.parse_args().rotations
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    print("J     strength  theory   integration: bound, us a rotation   elements: smallest error, nodes a rotation, iterations, us a rotation")
    for tilt, rates in ((0.1, [0.1, 0.1, 1.0]), (0.5, [0.6, 0.5, 0.9])):
        rates = np.array(rates) / np.linalg.norm(rates)
        free = andoyer.Scene(BODY, ATTITUDE, rates, tolerance=1e-15)
        motion, times = free.solve(), np.linspace(0, 30, 2000)
        node = seconds(lambda motion=motion, times=times: (motion.attitude(times), motion.partials(times))) / len(times)
        setup = seconds(lambda free=free: free.solve())
        for strength in 10.0 ** -np.arange(3, 10):
            rate = math.sqrt(strength / 3)
            asked = {"orbit": andoyer.Orbit(rate, 0.0, inclination=math.acos(0.8)), "span": (0, rotations * TURN), "tolerance": 1e-12}
            full = andoyer.Scene(BODY, ATTITUDE, rates, method="integrated", **asked)
            integrated = full.solve()
            exact = andoyer.Scene(BODY, ATTITUDE, rates, method="integrated", **asked | {"tolerance": 1e-14}).solve().attitude([rotations * TURN])[0]
            theory = andoyer.Scene(BODY, ATTITUDE, rates, method="closed", **asked).solve().plan.error_bound
            smallest, best = np.inf, None
            for arc in (1, 4, 16):
                for each in (8, 10, 12, 16, 24):
                    if each * arc > 260:
                        break
                    found, iterations = varied(rates, rate, arc, each * arc, rotations)
                    smallest = min(smallest, apart(exact, found))
                    if apart(exact, found) < 1e-12:
                        price = each * node + 2 * setup / arc
                        best = min(best or (price, each, iterations), (price, each, iterations))
                        break
            price = "-" if best is None else f"{best[1]}, {best[2]}, {best[0] * 1e6:.1f}"
            print(
                f"{tilt:<6}{strength:<10.0e}{theory:<9.1e}{integrated.plan.error_bound:.1e}, {seconds(full.solve, 3) / rotations * 1e6:<25.1f}{smallest:.1e}, {price}",
                flush=True,
            )
        print(f"attitude and partials {node * 1e9:.0f} ns, set-up {setup * 1e6:.1f} us")


if __name__ == "__main__":
    main()
