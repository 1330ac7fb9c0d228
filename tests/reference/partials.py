"""Derivatives of torque-free attitude and rates by differences of a solution in multiple precision. They are the reference of `tests/tests/partials.rs`.

The solution is that of torque_free.py. The nine parameters are a rotation of the initial attitude about body axes, the initial angular velocity, and the moments. Each derivative is a central
difference with a step of 1e-25. Its error, the square of the step times the square of the phase, is 1e-28 of the derivative after 1e9 rotations. A change of attitude is
the rotation vector, in body components, from one attitude to the other.

    python partials.py ../data/partials.json      writes the file
"""

import json
import sys

from torque_free import TorqueFree, _conjugate, _product

DIGITS = 80
STEP = "1e-25"
TURN = 6.283185307179586

CASES = {
    # name: (moments, angular velocity, times)
    "short-axis": ([1.0, 1.5, 2.0], [0.1, 0.2, 1.0], [0.0, 0.7, 13.1, 1000.3, 1e9 * TURN]),
    "short-axis-large": ([1.0, 1.5, 2.1], [0.5, 0.6, 1.0], [0.7, 13.1, 1000.3, -1e9 * TURN]),
    "long-axis": ([1.0, 3.0836, 3.235], [1.3, 0.2, 0.3], [0.7, 13.1, 1000.3, 1e9 * TURN]),
    "retrograde": ([2.0, 1.0, 1.5], [-1.0, 0.1, 0.2], [0.7, 13.1, 1000.3]),
    "left-handed": ([1.5, 1.0, 2.0], [0.3, -0.2, -1.1], [0.7, 13.1, 1000.3]),
    "long-axis-turned-over": ([3.235, 1.0, 3.0836], [0.2, -1.3, 0.3], [0.7, 13.1, 1000.3]),
    "needle": ([17.09, 71.79, 74.49], [0.02, 0.01, 1.0], [0.7, 13.1, 1000.3, 1e9 * TURN]),
    "wobble-1e-6": ([1.0, 1.5, 2.0], [1e-6, -2e-6, 1.0], [0.7, 13.1, 1000.3]),
    "wobble-1e-12": ([1.0, 1.5, 2.0], [1e-12, 1e-12, 1.0], [0.7, 13.1, 1000.3]),
    "wobble-2e-5": ([1.0, 1.5, 2.0], [2e-5, -2e-5, 1.0], [0.7, 13.1, 1000.3, 1e6]),
    "oblate": ([1.0, 1.0, 1.5], [0.3, 0.2, 1.0], [0.7, 13.1, 1000.3, 1e9 * TURN]),
    "prolate": ([1.0, 2.0, 2.0], [1.0, 0.4, -0.2], [0.7, 13.1, 1000.3]),
    "nearly-oblate": ([1.0, 1.0 + 1e-11, 1.5], [0.3, 0.2, 1.0], [0.7, 13.1, 1000.3]),
    "nearly-prolate": ([1.0, 2.0, 2.0 + 1e-11], [1.0, 0.4, -0.2], [0.7, 13.1, 1000.3]),
    "nearly-spherical": ([1.0, 1.0 + 1e-9, 1.0 + 3e-9], [0.5, 0.3, 1.0], [0.7, 13.1, 1000.3]),
    "sphere": ([1.0, 1.0, 1.0], [0.5, 0.3, 1.0], [0.7, 13.1, 1000.3]),
    "axis-3": ([1.0, 1.5, 2.0], [0.0, 0.0, 1.0], [0.7, 13.1, 1000.3, 1e9 * TURN]),
    "axis-1": ([1.0, 1.5, 2.0], [-1.0, 0.0, 0.0], [0.7, 13.1, 1000.3]),
    "axis-2": ([1.0, 1.5, 2.0], [0.0, 1.0, 0.0], [0.7, 13.1]),
    "oblate-axis": ([1.0, 1.0, 1.5], [0.0, 0.0, -1.0], [0.7, 13.1, 1000.3]),
    "oblate-across": ([1.0, 1.0, 1.5], [0.3, 1.0, 0.0], [0.7, 13.1]),
    "separatrix-1e-1": ([1.0, 1.5, 2.0], None, [0.7, 13.1, 100.3]),
    "separatrix-1e-2": ([1.0, 1.5, 2.0], None, [0.7, 13.1, 100.3]),
    "separatrix-1e-4": ([1.0, 1.5, 2.0], None, [0.7, 13.1, 100.3]),
    "separatrix-1e-6": ([1.0, 1.5, 2.0], None, [0.7, 13.1, 100.3]),
    "separatrix-long-1e-3": ([1.0, 1.5, 2.0], None, [0.7, 13.1, 100.3]),
}


def rates_beside_the_separatrix(moments, distance, long_axis):
    """Rates near the separatrix and not on an axis: C (C-B) w3² = A (B-A) w1² (1 ± distance²)."""
    a, b, c = moments
    w1 = 0.6
    w3 = w1 * (a * (b - a) / (c * (c - b))) ** 0.5 * (1 - distance**2 if long_axis else 1 + distance**2) ** 0.5
    return [w1, 0.4, w3]


def rotation_vector(cx, start, end):
    """Twice the vector part of the unit quaternion that leads from one attitude to a neighbouring one, body components."""
    x, y, z, w = _product(_conjugate(start), end)
    sign = 1 if w > 0 else -1
    return [2 * sign * c for c in (x, y, z)]


def partials(moments, attitude, rates, times):
    """Rows of attitude's and rates' derivatives, [3][9] each, at every time."""
    cx = TorqueFree(moments, attitude, rates if any(rates) else [1, 0, 0], digits=DIGITS).context
    step = cx.mpf(STEP)

    def states(changes):
        parameters = [cx.mpf(x) for x in (*moments, *rates)]
        turned = [cx.mpf(x) for x in attitude]
        for index, change in changes:
            if index < 3:
                vector = [cx.mpf(0)] * 3
                vector[index] = change / 2
                turned = _product(turned, [*vector, cx.mpf(1)])
            elif index < 6:
                parameters[index] += change
            else:
                parameters[index - 6] += change
        motion = TorqueFree(parameters[:3], turned, parameters[3:], digits=DIGITS)
        return [motion.state(t) for t in times]

    tables = [[[[None] * 9 for _ in range(3)] for _ in range(2)] for _ in times]
    for index in range(9):
        below, above = states([(index, -step)]), states([(index, step)])
        for table, (q0, w0), (q1, w1) in zip(tables, below, above):
            turned = rotation_vector(cx, q0, q1)
            for row in range(3):
                table[0][row][index] = float(turned[row] / (2 * step))
                table[1][row][index] = float((w1[row] - w0[row]) / (2 * step))
    return tables


def main(path):
    attitude = [0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214]
    cases = []
    for name, (moments, rates, times) in CASES.items():
        if rates is None:
            rates = rates_beside_the_separatrix(moments, float(name.rsplit("-", 2)[-2] + "-" + name.rsplit("-", 1)[-1]), "long" in name)
        print(name, rates, flush=True)
        states = [{"t": t, "attitude": a, "angular_velocity": w} for t, (a, w) in zip(times, partials(moments, attitude, rates, times))]
        cases.append({"name": name, "moments": moments, "attitude0_xyzw": attitude, "angular_velocity0": rates, "states": states})
    with open(path, "w", encoding="utf-8") as file:
        json.dump(cases, file, indent=0)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: python {sys.argv[0]} FILE.json")
    main(sys.argv[1])
