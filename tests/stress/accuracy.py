"""Compare one random scene with its enclosure, and check its invariants, which need no reference.

Errors are differences between doubles and balls of 40 digits: the angle between attitudes [rad], and the differences of the rates w_i in units of M/I_i. The tested code does not enforce
the invariants by construction.
"""

import sys
from pathlib import Path

import numpy as np
from regimes import case

import andoyer

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))

import enclosures

# Error budget. An attitude is a product of two quaternions whose four numbers are sums of up to some ten harmonics, each rounded to 2^-53 of the sum: at most 4 · 12 · 1.1e-16,
# doubled as an angle. A rate is one such sum; near the separatrix the terms are larger than the sum. The energy is quadratic in the rates; time reversal compares two motions.
BUDGETS = {
    "attitude": 1e-14,
    "rates": 1e-14,
    "attitude / bound": 1.0,
    "energy": 2e-14,
    "|M|": 1e-14,
    "inertial M": 2e-14,
    "norm": 1e-15,
    "time reversal": 2e-14,
    "powers of two": 0.0,
    "ensemble": 0.0,
    "group": 1.0,
}
TOLERANCE = 1e-15
# Relative rounding of a state that starts a new motion, and of the quaternion.
STATE_ROUNDING = 2e-15


def angle(p, q, low=0.0):
    """The angles [rad] between attitudes (n, 4); the second attitude is q + low. Small angles are accurate."""
    sign = np.sign(np.sum(p * q, axis=-1, keepdims=True))
    difference = (sign * p - q) - low
    return 2 * np.linalg.norm(difference, axis=-1)


def span(one, unit=1.0):
    """The interval from the first to the last of the epoch and the times."""
    return min(one.epoch, *one.times) * unit, max(one.epoch, *one.times) * unit


def truth(one):
    """Attitudes and rates as sums of two doubles: ((n, 4), (n, 4)), ((n, 3), (n, 3))."""
    rows = enclosures.solve(one.moments, one.attitude, one.rates, one.times, one.epoch)
    parts = [np.array([[enclosures.split(x) for x in row] for row in table]) for table in rows]
    return [(part[..., 0], part[..., 1]) for part in parts]


def measured(seed, number):
    """(regime, {check: value}, case) of one scene: errors over the times, invariants over more of them."""
    one = case(seed, number)
    body = andoyer.Body(one.moments)
    # The error bound holds over the span, so the span must contain the times.
    motion = andoyer.Scene(body, one.attitude, one.rates, epoch=one.epoch, tolerance=TOLERANCE, span=span(one)).solve()
    samples = motion.at(one.times)
    found = {}
    try:
        (attitude, attitude_low), (rates, rates_low) = truth(one)
    except ValueError:  # exactly on the separatrix there is no reference, only invariants
        pass
    else:
        found["attitude"] = float(angle(samples.attitude, attitude, attitude_low).max())
        # For each axis in units of M/I, since a needle rotates fastest about its thin axis.
        momentum = np.linalg.norm(np.multiply(one.moments, one.rates) / max(one.moments)) or 1.0
        apart = np.abs((samples.angular_velocity - rates) - rates_low) * one.moments / max(one.moments)
        found["rates"] = float(np.max(apart) / momentum)
        found["attitude / bound"] = found["attitude"] / motion.plan.error_bound
    found |= invariants(one, body, motion, samples)
    for name, value in found.items():
        if not np.isfinite(value):
            found[name] = np.inf
    return one.regime, found, number


def of_block(seed, numbers):
    """The results of `measured` for many scenes. Scenes with epoch 0 are also evaluated as members of one ensemble and must have the same bits."""
    found = [measured(seed, number) for number in numbers]
    members = [one for one in (case(seed, number) for number in numbers) if one.epoch == 0.0]
    fields = zip(*((one.moments, one.attitude, one.rates) for one in members))
    many = andoyer.Ensemble(*fields, tolerance=TOLERANCE, threads=1).at([one.times for one in members])
    for k, one in enumerate(members):
        alone = andoyer.Scene(andoyer.Body(one.moments), one.attitude, one.rates, tolerance=TOLERANCE).solve().at(one.times)
        same = np.array_equal(many.attitude[k], alone.attitude) and np.array_equal(many.angular_velocity[k], alone.angular_velocity)
        found.append((one.regime, {"ensemble": 0.0 if same else np.inf}, numbers[0]))
    return found


def invariants(one, body, motion, samples):
    """Violations of the conservation laws and symmetries of the equations of motion."""
    moments = np.array(one.moments) / max(one.moments)
    rates = samples.angular_velocity / np.max(np.abs(one.rates)) if np.any(one.rates) else samples.angular_velocity
    first = np.array(one.rates) / (np.max(np.abs(one.rates)) or 1.0)
    found = {}
    energy, start = np.sum(moments * rates**2, axis=1), np.sum(moments * first**2)
    found["energy"] = float(np.max(np.abs(energy / start - 1)))
    momentum, before = moments * rates, moments * first
    size = np.linalg.norm(before)
    found["|M|"] = float(np.max(np.abs(np.linalg.norm(momentum, axis=1) / size - 1)))
    quaternion = np.array(one.attitude) / np.linalg.norm(one.attitude)
    fixed = rotated(quaternion[None], before[None])
    found["inertial M"] = float(np.max(np.linalg.norm(rotated(samples.attitude, momentum) - fixed, axis=1)) / size)
    found["norm"] = float(np.max(np.abs(np.linalg.norm(samples.attitude, axis=1) - 1)))
    # q(−t), −ω(−t) solve the equations too.
    back = andoyer.Scene(body, one.attitude, [-x for x in one.rates], epoch=-one.epoch, tolerance=TOLERANCE).solve()
    found["time reversal"] = float(angle(back.attitude([-t for t in one.times]), samples.attitude).max())
    found["powers of two"] = powers_of_two(one, samples)
    if 0.0 < motion.plan.separatrix_ratio < 0.9:
        found["group"] = group(one, body, motion, samples)
    return found


def powers_of_two(one, samples):
    """The scene with moments times 2^37 and time times 2^-9, which must have the same bits if no number becomes a denormal."""
    if min(abs(x) for x in (*one.rates, *one.times) if x) < 1e-290:
        return 0.0
    body = andoyer.Body([x * 2.0**37 for x in one.moments])
    scene = andoyer.Scene(body, one.attitude, [x * 2.0**9 for x in one.rates], epoch=one.epoch * 2.0**-9, tolerance=TOLERANCE, span=span(one, 2.0**-9))
    other = scene.solve().at([t * 2.0**-9 for t in one.times])
    return float(max(np.max(np.abs(other.attitude - samples.attitude)), np.max(np.abs(other.angular_velocity * 2.0**-9 - samples.angular_velocity))))


def group(one, body, motion, samples):
    """Error of the state at t1 + t2 from a new scene that starts from the state at t1, in units of the effect of rounding that state."""
    middle, end = one.times[1], one.times[2]
    state = motion.at([middle])
    again = andoyer.Scene(body, state.attitude[0], state.angular_velocity[0], epoch=middle, tolerance=TOLERANCE).solve()
    apart = angle(again.attitude([end]), samples.attitude[2:3])[0]
    # The relative change of the frequencies is that of the state; near the separatrix it is that of 1−m divided by 1−m (σ/σ_sep is below 0.9 here).
    phase = abs(end - middle) * np.max(np.abs(one.rates))
    near = 1 / (1 - motion.plan.separatrix_ratio) ** 2
    spread = max(one.moments) / min(one.moments)
    return float(apart / (STATE_ROUNDING * (1 + phase) * near * spread))


def rotated(quaternions, vectors):
    """Vectors rotated by quaternions [x, y, z, w]."""
    axis, scalar = quaternions[:, :3], quaternions[:, 3:]
    across = 2 * np.cross(axis, vectors)
    return vectors + scalar * across + np.cross(axis, across)
