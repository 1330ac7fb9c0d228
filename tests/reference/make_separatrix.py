"""Write data/separatrix.json: motions close to the separatrix, on both sides of it, down to 1 − m = 2e-14.

    python make_separatrix.py > ../data/separatrix.json

The body [81, 225, 240] with the rates [5, 1, 9] is exactly on the separatrix: 240·15·9² = 81·144·5². In the file the largest rate is 9 (1 ± 2^−k), in three orders of the axes and with
both signs. The motions have up to 1e9 rotations and come from torque_free.py in 40 digits.
"""

import json

import mpmath
import torque_free

MOMENTS, RATES, ATTITUDE = [81.0, 225.0, 240.0], [5.0, 1.0, 9.0], [0.1, -0.5, 0.1, 0.7]
ORDERS = [(0, 1, 2), (1, 2, 0), (2, 1, 0)]
POWERS = [6, 12, 16, 20, 30, 38, 46]
TIMES = [0.0, 0.5, 7.0, 100.0, 12345.0, 1e6, 6.5e8]


def case(number, power, side):
    rates = [*RATES[:2], RATES[2] * (1 + side * 2.0**-power)]
    axes, sense = ORDERS[number % len(ORDERS)], (-1) ** number
    moments, rates = ([array[axis] for axis in axes] for array in (MOMENTS, rates))
    rates[number % 3] *= sense
    norm = sum(x * x for x in ATTITUDE) ** 0.5
    attitude = [x / norm for x in ATTITUDE]
    motion = torque_free.TorqueFree(moments, attitude, rates)
    states = [(t, *motion.state(t)) for t in TIMES]
    text = lambda row: [mpmath.nstr(x, 32) for x in row]  # noqa: E731
    return {
        "name": f"{motion.mode}-2^-{power}",
        "one_minus_m": mpmath.nstr(motion.complement, 20),
        "moments": moments,
        "attitude0_xyzw": attitude,
        "angular_velocity0": rates,
        "states": [{"t": t, "attitude_xyzw": text(q), "angular_velocity": text(w)} for t, q, w in states],
    }


cases = [(power, side) for power in POWERS for side in (1, -1)]
print(json.dumps([case(number, *each) for number, each in enumerate(cases)], indent=1))
