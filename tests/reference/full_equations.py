"""Rotation under several disturbing bodies by SciPy's DOP853, an independent check of the integrated method.

It integrates Euler's equations with the torque 3 μ/ρ^3 r × (I r) of each body and the kinematics of the quaternion; r is the unit vector to the disturbing body in body components, μ = G m/a^3, and ρ is the distance in
units of a. The relative tolerance is 1e-13. Orbits have the attributes of andoyer.Orbit. It needs numpy and scipy.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp


def place(orbit, time):
    """Position in units of the semi-major axis, inertial components."""
    since = time - orbit.time_of_pericentre
    e, mean = orbit.eccentricity, math.remainder(orbit.mean_motion * since, 2 * math.pi)
    anomaly = math.copysign(math.pi, mean) if e > 0.5 else mean + e * math.sin(mean)
    for _ in range(100):
        step = (anomaly - e * math.sin(anomaly) - mean) / (1 - e * math.cos(anomaly))
        anomaly -= step
        if abs(step) < 1e-15:
            break
    along, across = math.cos(anomaly) - e, math.sqrt(1 - e * e) * math.sin(anomaly)
    argument = orbit.argument_of_pericentre + orbit.pericentre_rate * since
    x, y = along * math.cos(argument) - across * math.sin(argument), along * math.sin(argument) + across * math.cos(argument)
    node, tilt = orbit.node + orbit.node_rate * since, orbit.inclination
    return np.array(
        [
            x * math.cos(node) - y * math.cos(tilt) * math.sin(node),
            x * math.sin(node) + y * math.cos(tilt) * math.cos(node),
            y * math.sin(tilt),
        ]
    )


def states(scene, times, places=()):
    """Attitudes (n, 4) and body rates (n, 3) at times that ascend or descend from the epoch; `places`: functions of time that give (position, gm), instead of the scene's orbits."""
    orbits = scene.orbit if isinstance(scene.orbit, tuple) else (scene.orbit,)
    bodies = list(places) or [lambda time, orbit=orbit: (place(orbit, time), orbit.attraction) for orbit in orbits if orbit is not None]
    moments = np.asarray(scene.body.moments)

    def slope(time, state):
        (x, y, z, w), rates = state[:4], state[4:]
        matrix = np.array(
            [
                [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
            ]
        )
        torque = -np.cross(rates, moments * rates)
        for body in bodies:
            position, strength = body(time)
            direction = matrix.T @ position
            torque = torque + 3 * strength / np.linalg.norm(position) ** 5 * np.cross(direction, moments * direction)
        p, q, r = rates
        turning = 0.5 * np.array([w * p + y * r - z * q, w * q + z * p - x * r, w * r + x * q - y * p, -x * p - y * q - z * r])
        return np.concatenate([turning, torque / moments])

    start = np.concatenate([scene.attitude, scene.angular_velocity])
    solution = solve_ivp(slope, (scene.epoch, float(times[-1])), start, "DOP853", t_eval=times, rtol=1e-13, atol=1e-16)
    attitude = solution.y[:4].T
    return attitude / np.linalg.norm(attitude, axis=1, keepdims=True), solution.y[4:].T
