"""Rotation under a body on a nearly radial orbit past its pericentre: a reference that shares nothing with the library.

The independent variable is x with E = 2 pi k + beta sinh x, beta = sqrt(2 (1 - e)), in which the torque is smooth at any eccentricity: rho = 1 - e cos E is
nearly (1 - e) cosh^2 x. Euler's equations and the kinematics of the quaternion are integrated in x by Gragg's, Bulirsch's and Stoer's extrapolation of order
16 in 80-bit reals, all cases at once. No time near the pericentre is a difference of large times, and no step can miss the torque. It needs numpy on a machine
whose long double has 64 bits of mantissa.

    python tests/reference/pericentres.py > tests/data/pericentres.json         writes the file; takes some minutes
    python tests/reference/pericentres.py tests/data/pericentres.json           compares the file with steps of 0.6 times the length
"""

import json
import sys

import numpy as np

LONG = np.longdouble
PI = LONG("3.14159265358979323846264338327950288")
SUBSTEPS = [2, 4, 6, 8, 10, 12, 14, 16]
LONGEST_TURN, LONGEST_STEP = 0.5, 0.2


def anomaly(mean, e):
    """E of Kepler's equation for |M| <= pi, by Newton's steps from above: (1 - e) E + e (E - sin E) has no cancellation and is convex."""
    E, target = PI, abs(mean)
    for _ in range(300):
        half = np.sin(E / 2)
        step = ((1 - e) * E + e * excess(E) - target) / ((1 - e) + 2 * e * half * half)
        E -= step
        if abs(step) <= 1e-19 * E:
            break
    return np.sign(mean) * E


def excess(E):
    """E - sin E."""
    if E > 1:
        return E - np.sin(E)
    term, total = E, LONG(0)
    for k in range(1, 15):
        term *= -E * E / (2 * k * (2 * k + 1))
        total -= term
    return total


def segments(case):
    """[(k, x from, x to)] between the epoch and the end."""
    e, n = LONG(case["eccentricity"]), LONG(case["mean_motion"])
    beta = np.sqrt(2 * (1 - e))
    means = [n * (LONG(time) - LONG(case["time_of_pericentre"])) for time in (case["epoch"], case["end"])]
    turns = [int(np.rint(mean / (2 * PI))) for mean in means]
    ends = [np.arcsinh(anomaly(mean - 2 * PI * turn, e) / beta) for mean, turn in zip(means, turns)]
    far = np.arcsinh(PI / beta)
    if turns[0] == turns[1]:
        return [(ends[0], ends[1])]
    sign = 1 if turns[1] > turns[0] else -1
    whole = abs(turns[1] - turns[0]) - 1
    return [(ends[0], sign * far), *[(-sign * far, sign * far)] * whole, (-sign * far, ends[1])]


class Cases:
    def __init__(self, cases):
        def column(name):
            return np.array([case[name] for case in cases], dtype=LONG)

        self.e, self.n, self.fraction = column("eccentricity"), column("mean_motion"), column("mass_fraction")
        self.beta = np.sqrt(2 * (1 - self.e))
        self.root = np.sqrt((1 - self.e) * (1 + self.e))
        self.moments = np.array([case["moments"] for case in cases], dtype=LONG).T
        i, o, w = column("inclination"), column("node"), column("argument_of_pericentre")
        ci, si, co, so, cw, sw = np.cos(i), np.sin(i), np.cos(o), np.sin(o), np.cos(w), np.sin(w)
        self.axes = np.array([[co * cw - so * sw * ci, so * cw + co * sw * ci, sw * si], [-co * sw - so * cw * ci, -so * sw + co * cw * ci, cw * si]])
        attitude = np.array([case["attitude"] for case in cases], dtype=LONG).T
        self.state = np.concatenate([attitude / np.sqrt((attitude**2).sum(0)), np.array([case["angular_velocity"] for case in cases], dtype=LONG).T])

    def slope(self, x, state):
        half = np.sin(self.beta * np.sinh(x) / 2)
        cosine = np.cos(self.beta * np.sinh(x) / 2)
        distance = (1 - self.e) + 2 * self.e * half * half
        along, across = (1 - self.e) - 2 * half * half, self.root * 2 * half * cosine
        (i, j, k) = (along * self.axes[0] + across * self.axes[1]) / distance
        pace = distance / self.n * self.beta * np.cosh(x)
        force = 3 * self.n**2 * self.fraction / distance**3
        x, y, z, w, p, q, r = state
        a, b, c = self.moments
        s = i * (1 - 2 * (y * y + z * z)) + j * 2 * (x * y + w * z) + k * 2 * (x * z - w * y)
        t = i * 2 * (x * y - w * z) + j * (1 - 2 * (x * x + z * z)) + k * 2 * (y * z + w * x)
        u = i * 2 * (x * z + w * y) + j * 2 * (y * z - w * x) + k * (1 - 2 * (x * x + y * y))
        rates = [
            (w * p + y * r - z * q) / 2,
            (w * q + z * p - x * r) / 2,
            (w * r + x * q - y * p) / 2,
            -(x * p + y * q + z * r) / 2,
            (c - b) * (force * t * u - q * r) / a,
            (a - c) * (force * u * s - r * p) / b,
            (b - a) * (force * s * t - p * q) / c,
        ]
        return pace * np.array(rates)

    def step(self, x, length):
        table = []
        for count in SUBSTEPS:
            h = length / count
            before, now = self.state, self.state + h * self.slope(x, self.state)
            for i in range(1, count):
                before, now = now, before + 2 * h * self.slope(x + i * h, now)
            row = [(now + before + h * self.slope(x + length, now)) / 2]
            for j, last in enumerate(table[-1] if table else []):
                ratio = (LONG(count) / SUBSTEPS[len(table) - 1 - j]) ** 2
                row.append(row[j] + (row[j] - last) / (ratio - 1))
            table.append(row)
        self.state = table[-1][-1]
        self.state[:4] /= np.sqrt((self.state[:4] ** 2).sum(0))

    def pace(self, x):
        half = np.sin(self.beta * np.sinh(x) / 2)
        return ((1 - self.e) + 2 * self.e * half * half) / self.n * self.beta * np.cosh(x)


def solved(cases, scale=1.0):
    """The states at the ends; `scale` shortens the steps, to see the error."""
    motion = Cases(cases)
    ways = [segments(case) for case in cases]
    place = [0] * len(cases)
    x = np.array([way[0][0] for way in ways])
    while True:
        target = np.array([way[at][1] for way, at in zip(ways, place)])
        spin = np.sqrt((motion.state[4:] ** 2).sum(0))
        limit = np.minimum(LONG(LONGEST_STEP), LONGEST_TURN / (motion.pace(x) * spin)) * LONG(scale)
        # A step must not lengthen the turn much where the pace grows.
        there = x + np.sign(target - x) * np.minimum(limit, abs(target - x))
        limit = np.minimum(limit, LONGEST_TURN * LONG(scale) / (motion.pace(there) * spin))
        left = target - x
        length = np.where(abs(left) <= limit, left, np.sign(left) * limit)
        motion.step(x, length)
        x = np.where(abs(left) <= limit, target, x + length)
        for i, way in enumerate(ways):
            if x[i] == way[place[i]][1] and place[i] + 1 < len(way):
                place[i] += 1
                x[i] = way[place[i]][0]
        if all(at + 1 == len(way) for at, way in zip(place, ways)) and (x == [way[-1][1] for way in ways]).all():
            return motion.state.T


def chosen(count):
    """Random scenes at 1 - e from 1e-12 to 0.1, whose pericentre turns the body by 1e-6 to 1 of its rate."""
    random = np.random.default_rng(31)
    cases = []
    while len(cases) < count:
        one_minus_e = 10 ** random.uniform(-12, -1)
        e = 1 - one_minus_e
        root = np.sqrt((1 - e) * (1 + e))
        nearest = root**3 / 3
        n = 10 ** random.uniform(-2.2, 0)
        kick = 10 ** random.uniform(-6, 0)
        fraction = min(1.0, kick * nearest / n)
        middle = random.uniform(0.55, 0.99)
        moments = [random.uniform(1.02 - middle, middle - 0.02), middle, 1.0]
        attitude, rates = random.normal(size=4), random.normal(size=3)
        direction = random.choice([1, -1])
        before, after = random.choice([0.0, 1e-9, 1e-4, 0.3, 1.0]), random.uniform(0.05, 3)
        before = 0.0 if before == 0 else before * random.uniform(0.3, 3)
        pericentre = random.uniform(-200, 200)
        epoch, end = pericentre - direction * before / n, pericentre + direction * after / n
        if len(cases) % 5 == 4:
            end = epoch + direction * 2 * np.pi / n * random.uniform(1, 1.6)
        cases.append(
            {
                "moments": moments,
                "attitude": list(attitude / np.linalg.norm(attitude)),
                "angular_velocity": list(rates / np.linalg.norm(rates)),
                "mean_motion": n,
                "eccentricity": e,
                "time_of_pericentre": pericentre,
                "inclination": random.uniform(0, np.pi),
                "node": random.uniform(0, 6),
                "argument_of_pericentre": random.uniform(0, 6),
                "mass_fraction": fraction,
                "epoch": epoch,
                "end": end,
            }
        )
    return cases


def written():
    """The cases with the states at their ends."""
    cases = chosen(100)
    for case, state in zip(cases, solved(cases)):
        case["end_attitude"] = [float(value) for value in state[:4]]
        case["end_angular_velocity"] = [float(value) for value in state[4:]]
    return cases


if __name__ == "__main__":
    if len(sys.argv) == 1:
        print(json.dumps(written()).replace("}, {", "},\n{"))
        sys.exit()
    with open(sys.argv[1], encoding="utf-8") as file:
        kept = json.load(file)
    again = solved(kept, 0.6)[:, :4].astype(float)
    worst = max(2 * min(abs(one - case["end_attitude"]).max(), abs(one + case["end_attitude"]).max()) for one, case in zip(again, kept))
    print(f"largest difference of the attitude: {worst:.1e} rad")
    sys.exit(worst > 1e-12)
