"""Derivatives of random bodies in multiple precision: the reference of `tests/tests/partials_of_random_bodies.rs`.

The first file has 300 bodies given by moments: 200 with random moments and rates, and 100 of which 25 each are within 1e-16 to 1e-6 of a sphere, of A = B, of B = C and of rotation about the middle
axis. Every third body next to A = B or B = C rotates almost across its axis of symmetry, where its polhode is slow. The second file has 48 bodies given by inertia tensors, of the same kinds, and
steady rotations. Each body has one time before or after the epoch, up to 1e5 rotations, for tensors and about the middle axis up to 30.

The method is that of partials.py. For a tensor the principal axes of the displaced tensor come from mpmath's `eigsy`. There are twelve parameters: attitude, angular velocity, and I11, I22,
I33, I12, I13, I23, where a change of I12 is one of I21 too.

A line has the moments or the six elements of the tensor, the rates and the time, as exact doubles, then the derivatives of the attitude (three rows) and those of the rates (three rows, without
the columns of the attitude, which are 0), with twelve digits. The initial attitude is that of partials.py.

    python random_partials.py ../data/partials_moments.txt ../data/partials_tensors.txt      writes the files in some minutes
"""

import random
import sys

from mpmath import MPContext
from partials import DIGITS, STEP, partials, rotation_vector
from torque_free import GUARD_DIGITS, TorqueFree, _conjugate, _product

ATTITUDE = [0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214]
ELEMENTS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
LIMITS = ["sphere", "A = B", "B = C", "middle axis"]


def direction(generator):
    """A random vector of norm 0.7 to 1.4."""
    vector = [generator.gauss(0, 1) for _ in range(3)]
    size = generator.uniform(0.7, 1.4) / sum(x * x for x in vector) ** 0.5
    return [size * x for x in vector]


def body(generator, limit, index):
    """Moments in any order and rates of a body within 1e-16 to 1e-6 of a limit, or of any body."""
    near = 10 ** generator.uniform(-16, -6)
    rates = direction(generator)
    if limit == "sphere":
        moments = [1.0, 1 + near * generator.uniform(-1, 1), 1 + near]
    elif limit == "A = B":
        moments = [1.0, 1 + near, generator.uniform(1.05, 1.95)]
        rates[2] *= near**0.5 if index % 3 == 0 else 1
    elif limit == "B = C":
        moments = [generator.uniform(0.1, 0.95), 1.0, 1 + near]
        rates[0] *= near**0.5 if index % 3 == 0 else 1
    else:
        a, b = sorted(generator.uniform(0.1, 1) for _ in range(2))
        moments = [a, b, generator.uniform(max(b, 0.7 * (a + b)), a + b)]
        if limit == "middle axis":
            rates = [near * rates[0], rates[1] / abs(rates[1]), near * rates[2]]
    order = generator.sample(range(3), 3)
    return [moments[i] for i in order], [rates[i] for i in order]


def time(generator, limit):
    """A time of either sign. About the middle axis derivatives grow exponentially, and there are at most some passages."""
    return generator.choice([-1, 1]) * 10 ** generator.uniform(0, 2.3 if limit == "middle axis" else 5.8)


def time_of_tensor(generator):
    """A shorter time: the principal moments are rounded, and products of inertia below 1e-12 are neglected."""
    return generator.choice([-1, 1]) * 10 ** generator.uniform(0, 2.3)


def principal(cx, tensor):
    """Principal moments, axes as columns of a proper rotation, and the quaternion from principal to user components."""
    moments, axes = cx.eigsy(cx.matrix(tensor))
    if cx.det(axes) < 0:
        axes[:, 2] = -axes[:, 2]
    trace = axes[0, 0] + axes[1, 1] + axes[2, 2]
    squares = [1 + 2 * axes[i, i] - trace for i in range(3)] + [1 + trace]
    big = max(range(4), key=lambda i: squares[i])
    skew = [axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]]
    turn = [*skew, squares[3]] if big == 3 else [squares[big] if j == big else axes[j, big] + axes[big, j] for j in range(3)] + [skew[big]]
    norm = cx.sqrt(sum(x * x for x in turn))
    return list(moments), axes, [x / norm for x in turn]


def tensor_partials(elements, rates, t):
    """Rows of attitude's and rates' derivatives, [3][12] each, of a body with a tensor."""
    cx = MPContext()
    cx.dps = DIGITS + GUARD_DIGITS
    step = cx.mpf(STEP)

    def state(index, change):
        turned, moved, given = [cx.mpf(x) for x in ATTITUDE], [cx.mpf(x) for x in rates], [cx.mpf(x) for x in elements]
        if index < 3:
            turned = _product(turned, [*(change / 2 if i == index else cx.mpf(0) for i in range(3)), cx.mpf(1)])
        elif index < 6:
            moved[index - 3] += change
        else:
            given[index - 6] += change
        tensor = [[None] * 3 for _ in range(3)]
        for (row, column), value in zip(ELEMENTS, given):
            tensor[row][column] = tensor[column][row] = value
        moments, axes, turn = principal(cx, tensor)
        sorted_rates = [sum(axes[i, j] * moved[i] for i in range(3)) for j in range(3)]
        attitude, found = TorqueFree(moments, _product(turned, turn), sorted_rates, digits=DIGITS).state(t)
        return _product(attitude, _conjugate(turn)), [sum(axes[i, j] * found[j] for j in range(3)) for i in range(3)]

    tables = [[[None] * 12 for _ in range(3)] for _ in range(2)]
    for index in range(12):
        (q0, w0), (q1, w1) = state(index, -step), state(index, step)
        turned = rotation_vector(cx, q0, q1)
        for row in range(3):
            tables[0][row][index] = float(turned[row] / (2 * step))
            tables[1][row][index] = float((w1[row] - w0[row]) / (2 * step))
    return tables


def line(numbers, t, tables):
    """A line of the file."""
    attitude, rates = tables
    derivatives = [x for row in attitude for x in row] + [x for row in rates for x in row[3:]]
    return " ".join([repr(float(x)) for x in (*numbers, t)] + [f"{x:.11e}" for x in derivatives]) + "\n"


def tensors(generator):
    """Elements of tensors and rates: 24 of random bodies, 4 next to each limit about turned axes, 8 about their own axes or in steady rotation."""
    for limit in [None] * 24 + [limit for limit in LIMITS for _ in range(4)]:
        moments, rates = body(generator, limit, 1)
        cx = MPContext()
        quaternion = [*direction(generator), 0.5]
        norm = sum(x * x for x in quaternion)
        x, y, z, w = quaternion
        turn = [
            [1 - 2 * (y * y + z * z) / norm, 2 * (x * y - z * w) / norm, 2 * (x * z + y * w) / norm],
            [2 * (x * y + z * w) / norm, 1 - 2 * (x * x + z * z) / norm, 2 * (y * z - x * w) / norm],
            [2 * (x * z - y * w) / norm, 2 * (y * z + x * w) / norm, 1 - 2 * (x * x + y * y) / norm],
        ]
        tensor = [[float(sum(turn[i][k] * cx.mpf(moments[k]) * turn[j][k] for k in range(3))) for j in range(3)] for i in range(3)]
        yield [tensor[i][j] for i, j in ELEMENTS], [sum(turn[i][k] * rates[k] for k in range(3)) for i in range(3)], time_of_tensor(generator)
    for moments, rates in [
        ([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]),
        ([1.0, 1.0, 1.5], [0.3, 0.2, 1.0]),
        ([1.5, 1.0, 1.5], [0.3, 0.2, 1.0]),
        ([1.0, 1.0, 1.0], [0.5, 0.3, 1.0]),
        ([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]),
        ([1.0, 1.5, 2.0], [0.0, -1.0, 0.0]),
        ([1.0, 1.0, 1.5], [0.0, 0.0, 1.0]),
        ([1.0, 1.0, 1.5], [0.6, 0.8, 0.0]),
    ]:
        yield [*moments, 0.0, 0.0, 0.0], rates, time_of_tensor(generator)


def main(by_moments, by_tensors):
    generator = random.Random(31)
    with open(by_moments, "w", encoding="utf-8") as file:
        for limit in [None] * 200 + [limit for limit in LIMITS for _ in range(25)]:
            (moments, rates), t = body(generator, limit, generator.randrange(3)), time(generator, limit)
            file.write(line((*moments, *rates), t, partials(moments, ATTITUDE, rates, [t])[0]))
    with open(by_tensors, "w", encoding="utf-8") as file:
        for elements, rates, t in tensors(random.Random(12)):
            file.write(line((*elements, *rates), t, tensor_partials(elements, rates, t)))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(f"usage: python {sys.argv[0]} MOMENTS.txt TENSORS.txt")
    main(*sys.argv[1:])
