"""Brightness of an ellipsoid in sunlight, in closed form, with its derivatives.

With Q = diag(1/a², 1/b², 1/c²), s towards the Sun and e towards the observer, both about body axes,

    x = sᵀQs   y = eᵀQe   z = sᵀQe   S² = x + y + 2z   d² = xy − z²

and the two laws of scattering, both of albedo 1 and solid angle 1, are

    geometric          (π/2) abc [√y + z/√x]                        the visible illuminated surface as the observer sees it, projected
    lommel-seeliger    (π/2) abc { [√x (y+z) + √y (x+z)]/S² − (d²/S³) ln[(√x S + x + z)(√y S + y + z)/d²] }

The first is that of Connelly and Ostro (Geometriae Dedicata 17, 1984), the integral of µ over the surface that is lit and seen; the second is the integral of µµ0/(µ + µ0)
(Muinonen and Lumme, A&A 584, A23, 2015), written without their angles. Tests compare both with sums over a triangulated ellipsoid.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from andoyer._quaternions import Array, conjugate, rotate
from andoyer._refusal import refusal
from andoyer.fit._given import finite, moderate, unit_quaternions
from andoyer.interop import _attitudes

TINY = 1e-300


class Law(NamedTuple):
    """A brightness and its derivatives with respect to x, y and z."""

    value: Array
    by_x: Array
    by_y: Array
    by_z: Array


def geometric(x: Array, y: Array, z: Array) -> Law:
    """√y + z/√x."""
    root = np.sqrt(x)
    over = 1 / root
    ratio = z * over
    seen = np.sqrt(y)
    return Law(seen + ratio, -ratio / (2 * x), 0.5 / seen, over)


def lommel_seeliger(x: Array, y: Array, z: Array) -> Law:
    """[√x (y+z) + √y (x+z)]/S² − (d²/S³) L."""
    p, q = np.sqrt(x), np.sqrt(y)
    xz, yz = x + z, y + z
    square = xz + yz
    root = np.sqrt(square)
    over = 1 / square
    surface = np.maximum(x * y - z * z, TINY)
    first, second = p * root + xz, q * root + yz
    logarithm = np.log(first * second / surface)
    cubed = over / root
    loss = surface * cubed * logarithm
    gain = (p * yz + q * xz) * over
    # Derivatives of S² are (1, 1, 2), of d² (y, x, −2z); those of ln d² take the factor d² away.
    by_square = -gain * over + 1.5 * loss * over - 0.5 * surface * cubed / root * (p / first + q / second)
    by_surface = cubed * (1 - logarithm)
    of_first, of_second = surface * cubed / first, surface * cubed / second
    by_x = (yz / (2 * p) + q) * over - of_first * (root / (2 * p) + 1)
    by_y = (xz / (2 * q) + p) * over - of_second * (root / (2 * q) + 1)
    by_z = (p + q) * over - of_first - of_second
    return Law(gain - loss, by_x + by_square + y * by_surface, by_y + by_square + x * by_surface, by_z + 2 * by_square - 2 * z * by_surface)


LAWS: dict[str, Callable[[Array, Array, Array], Law]] = {"geometric": geometric, "lommel-seeliger": lommel_seeliger}


class Brightness(NamedTuple):
    """Brightnesses with their derivatives."""

    value: Array
    by_turn: Array
    """With respect to a small rotation of the attitude about body axes, in a leading axis of three."""
    by_shape: Array
    """With respect to the logarithms of b/a and c/a, at given moments, in a leading axis of two."""


def brightness(axes: ArrayLike, attitudes: ArrayLike, sun: ArrayLike, observer: ArrayLike, *, scattering: str = "lommel-seeliger") -> Array:
    """Brightness of an ellipsoid in sunlight, for albedo and solar flux 1.

    Parameters
    ----------
    axes : array_like, shape (3,)
        Semi-axes along body axes 1, 2, 3.
    attitudes : array_like, shape (…, 4)
        Unit quaternions [x, y, z, w], body to inertial.
    sun, observer : array_like, shape (3,) or (…, 3)
        Directions from the body to the Sun and the observer, inertial components, of any length.
    scattering : {"lommel-seeliger", "geometric"}, optional
        Integrals over the lit and visible surface of µµ0/(µ + µ0) (Muinonen and Lumme 2015), or of µ: its projected area.

    Returns
    -------
    ndarray, shape (…,)
        Brightnesses, in the square of the unit of the axes.

    Raises
    ------
    InputError
        Semi-axes that are not from 1e-40 to 1e40, quaternions whose norm is not 1, shapes that do not fit, a direction of length 0, Sun and observer on opposite sides, an unknown law.

    Examples
    --------
    A sphere at full phase, whose projected area is π:

    >>> from andoyer.fit import brightness
    >>> float(brightness([1, 1, 1], [0, 0, 0, 1], [1, 0, 0], [1, 0, 0], scattering="geometric").round(12))
    3.14159265359
    """
    semi_axes = axes_of(axes)
    to_sun, to_observer = unit_vectors(sun, observer)
    formula = law(scattering)
    given = finite("attitudes", _attitudes.quaternions("attitudes", attitudes)[0])
    if given.shape[-1:] != (4,):
        raise refusal("attitudes", given.shape, "(…, 4)", f"has shape {given.shape}: it must be (…, 4)")
    turn = conjugate(unit_quaternions("attitudes", given.reshape(-1, 4), given.size // 4).reshape(given.shape))
    for argument, vectors in (("sun", to_sun), ("observer", to_observer)):
        if turn.ndim > 1 and vectors.ndim > 1 and vectors.shape[:-1] != turn.shape[:-1]:
            allowed = (*turn.shape[:-1], 3)
            raise refusal(argument, vectors.shape, allowed, f"has shape {vectors.shape}: it must be (3,) or, as the attitudes have, {allowed}")
    # Scaled: squares of large axes would be infinite, of small ones 0.
    largest = float(semi_axes.max())
    semi_axes = semi_axes / largest
    lit = forms(semi_axes, np.moveaxis(rotate(turn, to_sun), -1, 0), np.moveaxis(rotate(turn, to_observer), -1, 0))
    return largest * largest * size(semi_axes) * formula(*lit).value


THINNEST = 1e-6
"""Least ratio of two semi-axes; beyond it d² cancels."""


def axes_of(axes: ArrayLike) -> Array:
    """Semi-axes."""
    given = moderate("axes", axes, (3,))
    ratio = float(given.min() / given.max())
    if not ratio >= THINNEST:
        raise refusal("axes", ratio, THINNEST, f"have the ratio {ratio} of the smallest to the largest: it must be {THINNEST} at least")
    return given


def law(scattering: str) -> Callable[[Array, Array, Array], Law]:
    """The law of this name."""
    if not isinstance(scattering, str) or scattering not in LAWS:
        raise refusal("scattering", scattering, ", ".join(LAWS), f"= {scattering!r}: it must be of {', '.join(LAWS)}")
    return LAWS[scattering]


FARTHEST = -0.9998
"""Cosine of the phase angle 178.9°, beyond which nearly nothing of the lit surface is seen and subtractions cancel."""


def unit_vectors(sun: ArrayLike, observer: ArrayLike) -> tuple[Array, Array]:
    """Unit vectors."""
    units = []
    for argument, value in (("sun", sun), ("observer", observer)):
        vector = finite(argument, value)
        if vector.shape[-1:] != (3,):
            raise refusal(argument, vector.shape, "(3,) or (n, 3)", f"has shape {vector.shape}: it must be (3,) or (n, 3)")
        # Scaled first: squares of large components would be infinite, of small ones 0.
        largest = np.max(np.abs(vector), axis=-1, keepdims=True)
        if not np.all(largest > 0):
            raise refusal(argument, 0.0, "above 0", "has a direction of length 0")
        scaled = vector / largest
        units.append(scaled / np.linalg.norm(scaled, axis=-1, keepdims=True))
    if units[0].ndim > 1 and units[1].ndim > 1 and units[0].shape != units[1].shape:
        raise refusal("observer", units[1].shape, units[0].shape, f"has shape {units[1].shape}: it must be (3,) or as sun has, {units[0].shape}")
    cosine = float(np.min(np.sum(units[0] * units[1], axis=-1)))
    if cosine < FARTHEST:
        raise refusal("sun", cosine, FARTHEST, f"is opposite to the observer: the cosine of the phase angle is {cosine:.6f} and must be {FARTHEST} at least")
    return units[0], units[1]


def size(axes: Array) -> float:
    """(π/2) abc."""
    return float(np.pi / 2 * np.prod(axes))


def forms(axes: Array, sun: Array, observer: Array) -> tuple[Array, Array, Array]:
    """x, y, z of directions about body axes, whose components are the leading axis."""
    weights = [1 / axis**2 for axis in axes]
    x = sum(weight * s * s for weight, s in zip(weights, sun))
    y = sum(weight * e * e for weight, e in zip(weights, observer))
    z = sum(weight * s * e for weight, s, e in zip(weights, sun, observer))
    return x, y, z


def with_derivatives(axes: Array, sun: Array, observer: Array, scattering: str, *, derivatives: bool = True, shape: bool = False) -> Brightness:
    """Brightnesses of directions about body axes, components in the leading axis, divided by (π/2) a³; `axes` too may have further axes."""
    lit = [axis**-2 for axis in axes]
    sun_weighted = [weight * s for weight, s in zip(lit, sun)]
    observer_weighted = [weight * e for weight, e in zip(lit, observer)]
    x, y, z = (sum(a * b for a, b in zip(*pair)) for pair in ((sun_weighted, sun), (observer_weighted, observer), (sun_weighted, observer)))
    found = LAWS[scattering](x, y, z)
    scale = axes[1] * axes[2] / axes[0] ** 2
    value = scale * found.value
    if not derivatives:
        return Brightness(value, np.zeros((0, *value.shape)), np.zeros((0, *value.shape)))
    # Under R → R exp([θ]×) a direction about body axes turns by s × θ: dx = 2 θ·(Qs × s), dz = θ·(Qs × e + Qe × s).
    along_sun = [2 * found.by_x * s + found.by_z * e for s, e in zip(sun, observer)]
    along_observer = [2 * found.by_y * e + found.by_z * s for s, e in zip(sun, observer)]
    by_turn = np.stack(
        [
            scale
            * (
                sun_weighted[i] * along_sun[j]
                - sun_weighted[j] * along_sun[i]
                + observer_weighted[i] * along_observer[j]
                - observer_weighted[j] * along_observer[i]
            )
            for i, j in ((1, 2), (2, 0), (0, 1))
        ]
    )
    if not shape:
        return Brightness(value, by_turn, np.zeros((0, *value.shape)))
    by_shape = [
        value
        - 2 * scale * (found.by_x * sun_weighted[k] * sun[k] + found.by_y * observer_weighted[k] * observer[k] + found.by_z * sun_weighted[k] * observer[k])
        for k in (1, 2)
    ]
    return Brightness(value, by_turn, np.stack(by_shape))
