"""Write data/orders.json: four motions over twenty rotations, for the error of the series by order (theory §7).

    python make_orders.py > ../data/orders.json

Body, J at nu = 0.3, mu = 0.7, M = 1, and 161 epochs each; states by torque_free.py.
"""

import json
import math

import torque_free

CASES = [
    ("nearly spherical", [1.0, 1.01, 1.05], 0.05),
    ("triaxial", [1.0, 1.5, 2.0], 0.3),
    ("needle", [17.09, 71.79, 74.49], 0.05),
    ("triaxial, large wobble", [1.0, 1.5, 2.0], 0.7),
]
NU, MU, ROTATIONS, EPOCHS = 0.3, 0.7, 20, 161


def case(name, moments, tilt):
    momentum = [math.sin(tilt) * math.sin(NU), math.sin(tilt) * math.cos(NU), math.cos(tilt)]
    rates = [g / i for g, i in zip(momentum, moments)]
    # Rz(mu) Rx(J) Rz(nu)
    half_sum, half_difference = (MU + NU) / 2, (MU - NU) / 2
    attitude = [
        math.sin(tilt / 2) * math.cos(half_difference),
        math.sin(tilt / 2) * math.sin(half_difference),
        math.cos(tilt / 2) * math.sin(half_sum),
        math.cos(tilt / 2) * math.cos(half_sum),
    ]
    period = 2 * math.pi / math.sqrt(sum(w * w for w in rates))
    times = [ROTATIONS * period * k / (EPOCHS - 1) for k in range(EPOCHS)]
    attitudes, velocities = torque_free.solve(moments, attitude, rates, times, digits=25)
    return {
        "name": name,
        "moments": moments,
        "attitude0_xyzw": attitude,
        "angular_velocity0": rates,
        "states": [
            {"t": t, "attitude_xyzw": [float(x) for x in q], "angular_velocity": [float(x) for x in w]} for t, q, w in zip(times, attitudes, velocities)
        ],
    }


print(json.dumps([case(*arguments) for arguments in CASES], indent=None, separators=(",", ":")))
