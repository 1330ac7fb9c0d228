"""States that steps lead to, as an `Ensemble` about principal axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from andoyer._core import Ensemble, Orbit
from andoyer._quaternions import Array, conjugate, product
from andoyer._refusal import refusal
from andoyer.fit._steps import Steps


def are_bodies(steps: Steps, rows: Array) -> NDArray[np.bool_]:
    """Whether a body has the moments of each row of steps: they are positive, and none exceeds the sum of the two others."""
    moments = steps.moments(rows)
    valid: NDArray[np.bool_] = (2 * moments.max(axis=1) <= moments.sum(axis=1)) & (moments.min(axis=1) > 0)
    return valid


def members(steps: Steps, rows: Array, *, threads: int | None = None, errors: Literal["raise", "nan"] = "raise") -> Ensemble:
    """The states that rows of steps lead to, shape (m, k): see `members_of`."""
    return members_of([(steps, rows)], threads=threads, errors=errors)


def members_of(parts: Sequence[tuple[Steps, Array]], *, threads: int | None = None, errors: Literal["raise", "nan"] = "raise") -> Ensemble:
    """The states that rows of steps from one scene or several lead to, shapes (m, k), about principal axes, with the options of the first scene.

    Raises
    ------
    InputError
        A scene with several disturbing bodies or a `TabulatedOrbit`.
    """
    scene = parts[0][0].origin
    orbit = scene.orbit
    if not (orbit is None or isinstance(orbit, Orbit)):
        raise refusal("scene", type(orbit).__name__, "Orbit", "has several disturbing bodies or a table of positions: an Ensemble takes one Orbit at most")
    _, options = scene.__getnewargs_ex__()
    shared = {"epochs": options.get("epoch", 0.0), "orbits": orbit, "tolerance": scene.tolerance, "span": scene.span}
    moments, attitudes, rates = (np.concatenate(arrays) for arrays in zip(*(_about_principal_axes(*part) for part in parts)))
    return Ensemble(moments, attitudes, rates, threads=threads, errors=errors, **shared)


def _about_principal_axes(steps: Steps, rows: Array) -> tuple[Array, Array, Array]:
    """Principal moments, attitudes and angular velocities."""
    moments, attitudes, rates = steps.states(rows)
    return moments, product(attitudes, _turns(steps, rows)), np.einsum("mi,mij->mj", rates, steps.principal_axes(rows))


def about_body_axes(steps: Steps, rows: Array, attitudes: Array) -> Array:
    """Attitudes of the body axes, from those of the principal axes of `members`, shape (m, n, 4)."""
    return product(attitudes, np.broadcast_to(conjugate(_turns(steps, rows))[:, None], attitudes.shape))


def _turns(steps: Steps, rows: Array) -> Array:
    """The quaternions of the principal axes in the body axes, shape (m, 4)."""
    axes = steps.principal_axes(rows)
    if np.all(axes == np.eye(3)):
        return np.broadcast_to(np.array([0.0, 0.0, 0.0, 1.0]), (len(rows), 4))
    from scipy.spatial.transform import Rotation

    turns: Array = Rotation.from_matrix(np.array(axes)).as_quat()
    return turns
