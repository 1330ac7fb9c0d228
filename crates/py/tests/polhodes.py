"""States on polhodes and random torques for the tests of averages."""

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import ellipj, ellipk

MOMENTS = np.array([0.5, 0.75, 1.0])
SOURCE = np.array([0.6, 0.0, 0.8])
FAMILIES = [(2, 1), (2, -1), (0, 1), (0, -1)]


def rotation_to(k, g):
    """A rotation that takes the body vector g to the inertial vector k."""
    first = np.cross(g, [0.3, 0.5, -0.4])
    first /= np.linalg.norm(first)
    across = np.cross(k, [0.1, -0.6, 0.2])
    across /= np.linalg.norm(across)
    return np.column_stack([across, np.cross(k, across), k]) @ np.column_stack([first, np.cross(g, first), g]).T


def quaternion(matrix):
    return Rotation.from_matrix(matrix).as_quat()


def separatrix(axis):
    a, b, c = MOMENTS
    return c / b - 1 if axis == 2 else 1 - a / b


def polhode(axis, sign, excess, phases):
    """g on the polhode of ξ at phases ℓ′, by SciPy's elliptic functions (theory page, section 2)."""
    alpha = MOMENTS[2] / MOMENTS - 1 if axis == 2 else 1 - MOMENTS[0] / MOMENTS
    a, b = alpha[2 - axis], alpha[1]
    m = excess * (a - b) / (b * (a - excess))
    sn, cn, dn, _ = ellipj(2 * ellipk(m) * phases / np.pi, m)
    g = np.empty((len(phases), 3))
    g[:, 2 - axis], g[:, 1], g[:, axis] = np.sqrt(excess / a) * cn, sign * np.sqrt(excess / b) * sn, sign * np.sqrt(1 - excess / a) * dn
    return g, alpha


def random_texts(degree, seed, size):
    """Polynomials with all monomials in the direction up to a degree, and some with rates, as texts and as a function."""
    rng = np.random.default_rng(seed)
    powers = [(i, j, k) for i in range(degree + 1) for j in range(degree + 1 - i) for k in range(degree + 1 - i - j)]
    names = ["s1", "s2", "s3"]
    factors = [(power, "1") for power in powers] + [((0, 1, 0), "w1"), ((1, 0, 1), "w3"), ((0, 0, 0), "w2")]
    coefficients = size * rng.normal(size=(3, len(factors))) / len(factors) ** 0.5

    def text(row):
        return " + ".join(f"({c!r})*{'*'.join(f'{n}^{e}' for n, e in zip(names, p))}*{w}" for c, (p, w) in zip(row.tolist(), factors))

    def value(u, w):
        rates = {"1": 1.0, "w1": w[..., 0], "w2": w[..., 1], "w3": w[..., 2]}
        terms = np.array([u[..., 0] ** p[0] * u[..., 1] ** p[1] * u[..., 2] ** p[2] * rates[r] for p, r in factors])
        return np.moveaxis(np.tensordot(coefficients, terms, 1), 0, -1)

    return [text(row) for row in coefficients], value


def state(axis, sign, excess, momentum, phase=0.7):
    """Attitude and rates on a polhode."""
    size = np.linalg.norm(momentum)
    g = polhode(axis, sign, excess, np.array([phase]))[0][0]
    return quaternion(rotation_to(momentum / size, g)), size * g / MOMENTS
