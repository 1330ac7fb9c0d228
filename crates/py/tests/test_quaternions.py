"""Quaternions of other packages, with the scalar first in memory or last: read by the names of their components, or refused, wherever an attitude is taken."""

from collections import namedtuple
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import andoyer
from andoyer import fit, output

TURN = Rotation.from_euler("ZYX", [0.3, -0.7, 1.1])
X, Y, Z, W = (float(part) for part in TURN.as_quat())
BODY, RATES = andoyer.Body([1.0, 1.5, 2.0]), [0.1, 0.2, 1.0]
ORBIT = andoyer.Orbit(1e-3)


class First(np.ndarray):
    """An array with the scalar first and named components, of one quaternion or many, as `quaternionic` and `ahrs` have it."""

    w, x, y, z = (property(lambda self, k=k: np.asarray(self)[..., k]) for k in range(4))


class Last(np.ndarray):
    """The same with the scalar last, as `pyrr` has it."""

    x, y, z, w = (property(lambda self, k=k: np.asarray(self)[..., k]) for k in range(4))


class OfOne(np.ndarray):
    """Components are those of a single quaternion; a stack of four has other numbers under these names."""

    w, x, y, z = (property(lambda self, k=k: np.asarray(self)[k]) for k in range(4))


class Unnamed(np.ndarray):
    """An order that cannot be seen from outside."""

    w = property(lambda self: float(np.asarray(self)[0]))


class Opaque:
    """A rotation whose components have other names."""

    r, ix, iy, iz = W, X, Y, Z


Tuple = namedtuple("Tuple", "w x y z")
Object = SimpleNamespace


def objects(*values):
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array


NAMED = {
    "array, scalar first": lambda: np.array([W, X, Y, Z]).view(First),
    "array, scalar last": lambda: np.array([X, Y, Z, W]).view(Last),
    "array of one": lambda: np.array([W, X, Y, Z]).view(OfOne),
    "named tuple": lambda: Tuple(W, X, Y, Z),
    "object": lambda: Object(w=W, x=X, y=Y, z=Z),
    "record": lambda: np.array((W, X, Y, Z), dtype=[(name, float) for name in "wxyz"]),
    "rotation": lambda: TURN,
}
STACKS = {
    "array": lambda: np.array([[W, X, Y, Z]] * 4).view(First),
    "list of arrays": lambda: [np.array([W, X, Y, Z]).view(First)] * 4,
    "list of tuples": lambda: [Tuple(W, X, Y, Z)] * 4,
    "list of rotations": lambda: [TURN] * 4,
    "array of objects": lambda: objects(*[Object(w=W, x=X, y=Y, z=Z)] * 4),
    "records": lambda: np.array([(W, X, Y, Z)] * 4, dtype=[(name, float) for name in "wxyz"]),
    "columns": lambda: pytest.importorskip("pandas").DataFrame({"qw": [W] * 4, "qx": X, "qy": Y, "qz": Z}),
    "labels": lambda: pytest.importorskip("xarray").DataArray([[W, X, Y, Z]] * 4, dims=["t", "q"], coords={"q": list("wxyz")}),
}
REFUSED = {
    "class without names": lambda: np.array([W, X, Y, Z]).view(Unnamed),
    "stack of a class of one": lambda: np.array([[W, X, Y, Z]] * 4).view(OfOne),
    "other names": Opaque,
    "list of other names": lambda: [Opaque()] * 4,
    "columns with other names": lambda: pytest.importorskip("pandas").DataFrame({"q0": [W] * 4, "q1": X, "q2": Y, "q3": Z}),
    "labels with other names": lambda: pytest.importorskip("xarray").DataArray([W, X, Y, Z], dims=["q"], coords={"q": ["q_w", "q_x", "q_y", "q_z"]}),
    "both kinds": lambda: [[X, Y, Z, W], np.array([W, X, Y, Z]).view(First)],
}


def apart(attitude):
    return float(np.max((TURN.inv() * Rotation.from_quat(attitude)).magnitude()))


def of_orbital(attitude, **options):
    """The attitude against the orbital frame."""
    inertial, frame = (
        Rotation.from_quat(andoyer.Scene.from_orbital(BODY, given, RATES, orbit=ORBIT, elements_of="rotating", **kept).attitude)
        for given, kept in ((attitude, options), ([0, 0, 0, 1], {}))
    )
    return (frame.inv() * inertial).as_quat()


ONE = {
    "Scene": lambda given, **options: andoyer.Scene(BODY, given, RATES, **options).attitude,
    "Ensemble": lambda given, **options: andoyer.Ensemble([BODY.moments] * 2, given, RATES, **options).attitudes,
    "from_orbital": of_orbital,
}


@pytest.mark.parametrize("take", ONE.values(), ids=ONE)
@pytest.mark.parametrize("made", NAMED.values(), ids=NAMED)
def test_one_quaternion_is_read_by_the_names_of_its_components(made, take):
    assert apart(take(made())) < 1e-12
    assert apart(take(made(), scalar_first=True)) < 1e-12


def fitted(measured):
    times = np.arange(4.0)
    still = andoyer.Scene(BODY, [X, Y, Z, W], [0, 0, 0])
    return fit.attitudes(still, times, measured, sigma=1e-3, free="attitude").residuals


@pytest.mark.parametrize("made", STACKS.values(), ids=STACKS)
def test_many_quaternions_are_read_by_the_names_of_their_components(made):
    assert apart(andoyer.Ensemble([BODY.moments] * 4, made(), RATES).attitudes) < 1e-12
    assert np.abs(fitted(made())).max() < 1e-9
    lit = ([3, 2, 1], [1, 0, 0], [0.6, 0.8, 0])
    expected = fit.brightness(lit[0], [[X, Y, Z, W]] * 4, *lit[1:])
    assert fit.brightness(lit[0], made(), *lit[1:]) == pytest.approx(expected, rel=1e-12)


def test_samples_of_another_origin_are_read_by_the_names_of_their_components():
    turns = np.array([[W, X, Y, Z]] * 2).view(First)
    given = SimpleNamespace(times=np.array([0.0, 1.0]), attitude=turns, angular_velocity=np.zeros((2, 3)), scalar_first=True)
    assert apart(output.rows.rows(given)[:, 1:5]) < 1e-12


def test_jax_reads_quaternions_by_the_names_of_their_components():
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    from andoyer.jax import attitude

    assert apart(np.asarray(attitude([1.0, 1.5, 2.0], NAMED["array, scalar first"](), RATES, 0.0))) < 1e-12


@pytest.mark.parametrize("made", REFUSED.values(), ids=REFUSED)
def test_quaternion_of_unknown_order_is_refused_with_the_remedy(made):
    for take in (*ONE.values(), fitted):
        with pytest.raises(TypeError, match=r"\[x, y, z, w\], scalar last, or \[w, x, y, z\]|values of one kind"):
            take(made())


def test_plain_arrays_and_lists_are_taken_as_they_are():
    for given in ([X, Y, Z, W], (X, Y, Z, W), np.array([X, Y, Z, W]), list(np.float32([X, Y, Z, W]))):
        assert apart(andoyer.Scene(BODY, given, RATES).attitude) < 1e-6


def test_results_are_not_written_into_an_array_with_the_scalar_first():
    motion = andoyer.Scene(BODY, [X, Y, Z, W], RATES).solve()
    with pytest.raises(TypeError, match="out must be an array of NumPy's own classes, not a First of"):
        motion.attitude([0.0], out=np.empty((1, 4)).view(First))
