"""Attitude and angular velocity of a free rigid body as JAX functions, which JAX differentiates by the closed form of theory §12.

`attitude`, `angular_velocity` and `state` work under ``jax.jit``, ``jax.vmap``, ``jax.jvp``, ``jax.vjp``, ``jax.jacfwd``, ``jax.jacrev`` and ``jax.grad``. The values come from `Motion` and
`Ensemble`, which JAX calls on the host. Derivatives with respect to the moments and the state are those of `Motion.partials`; they are first derivatives, and a second one is an error.
Derivatives with respect to the times follow from q′ = ½ q ⊗ (ω, 0) and Euler's equations, to any order.

The module needs JAX, which ``pip install jax`` installs, with 64-bit numbers: ``jax.config.update("jax_enable_x64", True)``. `import andoyer` does not import it.
"""

from typing import Any

import numpy as np

from andoyer._core import Body, Ensemble, InputError, Motion, RepresentationError, Scene, TheoryError
from andoyer._extra import extra
from andoyer._quaternions import Array, conjugate, product
from andoyer.interop._attitudes import quaternions

jax: Any = extra("jax", "andoyer.jax")
jnp: Any = extra("jax.numpy", "andoyer.jax")
SymbolicZero: Any = extra("jax.custom_derivatives", "andoyer.jax").SymbolicZero

__all__ = ["angular_velocity", "attitude", "state"]

ROWS = {"moments": 3, "attitude": 4, "angular_velocity": 3}
"""The length of the last axis of each argument of a body."""


def attitude(moments: Any, attitude: Any, angular_velocity: Any, times: Any) -> Any:
    """Evaluates attitudes of free rigid bodies: unit quaternions [x, y, z, w] that rotate body components into inertial ones (theory §8, derivatives §12).

    Leading axes are broadcast, as by NumPy's generalized functions: ``(..., 3), (..., 4), (..., 3), (..., n) -> (..., n, 4)``.

    The initial attitude q0 is divided by its norm, and the derivative is that of the normalized quaternion. Only the part of a tangent of q0 that is perpendicular to q0 has an effect. A gradient with
    respect to q0 is perpendicular to q0, and a tangent of the result is perpendicular to the result.

    Parameters
    ----------
    moments : array_like, shape (..., 3)
        Principal moments of inertia about body axes 1, 2, 3, as for `Body`.
    attitude : array_like, shape (..., 4)
        Unit quaternion [x, y, z, w] at time 0, body to inertial, of norm 1 within 1e-6.
    angular_velocity : array_like, shape (..., 3)
        Angular velocity at time 0 in body components, in rad per unit of time.
    times : array_like, shape (..., n) or ()
        Times since the given state. For a scalar the result has no axis of times.

    Returns
    -------
    jax.Array, shape (..., n, 4)
        Unit quaternions, float64.

    Raises
    ------
    InputError
        An argument of a wrong shape or with complex numbers; a member that is not a body or not a state. Under ``jit`` and ``vmap`` the values are only known when the function runs, and the
        error is JAX's ``JaxRuntimeError`` with this message in its text.
    RepresentationError
        64-bit numbers are disabled in JAX.
    TheoryError
        Derivatives on the separatrix, where they do not exist, and second derivatives with respect to the moments or the state.

    Examples
    --------
    The gradient of the last component, cos ½ωt for rotation about axis 3, with respect to the angular velocity is −½t sin ½ωt:

    >>> import jax
    >>> jax.config.update("jax_enable_x64", True)
    >>> from andoyer.jax import attitude
    >>> def last(rates):
    ...     return attitude([1.0, 1.5, 2.0], [0.0, 0.0, 0.0, 1.0], rates, 2.0)[3]
    >>> jax.grad(last)(jax.numpy.array([0.0, 0.0, 1.0])).round(6).tolist()
    [0.0, 0.0, -0.841471]
    """
    return state(moments, attitude, angular_velocity, times)[0]


def angular_velocity(moments: Any, attitude: Any, angular_velocity: Any, times: Any) -> Any:
    """Evaluates angular velocities of free rigid bodies in body components, in rad per unit of time (theory §8, derivatives §12).

    Parameters
    ----------
    moments, attitude, angular_velocity, times : array_like
        As for `attitude`. The result does not depend on the attitude.

    Returns
    -------
    jax.Array, shape (..., n, 3)
        Angular velocities, float64.

    Raises
    ------
    InputError, RepresentationError, TheoryError
        As for `attitude`.

    Examples
    --------
    The derivative with respect to time is that of Euler's equations, A ω1′ = (B − C) ω2 ω3:

    >>> import jax
    >>> jax.config.update("jax_enable_x64", True)
    >>> from andoyer.jax import angular_velocity
    >>> def first(time):
    ...     return angular_velocity([1.0, 1.5, 2.0], [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0], time)[0]
    >>> round(float(jax.grad(first)(0.0)), 12)
    -0.1
    """
    return state(moments, attitude, angular_velocity, times)[1]


def state(moments: Any, attitude: Any, angular_velocity: Any, times: Any) -> tuple[Any, Any]:
    """Evaluates attitudes and angular velocities of free rigid bodies in one pass (theory §8, derivatives §12).

    Parameters
    ----------
    moments, attitude, angular_velocity, times : array_like
        As for `attitude`.

    Returns
    -------
    tuple of jax.Array
        Unit quaternions, shape (..., n, 4), and angular velocities in body components, shape (..., n, 3).

    Raises
    ------
    InputError, RepresentationError, TheoryError
        As for `attitude`.

    Examples
    --------
    >>> import jax
    >>> jax.config.update("jax_enable_x64", True)
    >>> from andoyer.jax import state
    >>> attitudes, rates = state([[1.0, 1.5, 2.0], [1.0, 1.0, 1.0]], [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0], [0.0, 10.0, 20.0])
    >>> attitudes.shape, rates.shape
    ((2, 3, 4), (2, 3, 3))
    >>> [round(float(rate), 12) for rate in rates[1, 2]]
    [0.1, 0.2, 1.0]
    """
    if jnp.result_type(float) != np.float64:
        raise RepresentationError('andoyer.jax needs 64-bit numbers: call jax.config.update("jax_enable_x64", True) first')
    given = {"moments": moments, "attitude": quaternions("attitude", attitude)[0], "angular_velocity": angular_velocity}
    vectors = [_numbers(argument, value) for argument, value in given.items()]
    at = _numbers("times", times)
    for vector, (argument, length) in zip(vectors, ROWS.items(), strict=True):
        if vector.shape[-1:] != (length,):
            raise _refusal(argument, f"an array of shape {vector.shape}", f"of shape (..., {length})")
    scalar = at.ndim == 0
    attitudes, rates = _state(*_aligned([*vectors, at[None] if scalar else at]))
    return (attitudes[..., 0, :], rates[..., 0, :]) if scalar else (attitudes, rates)


def _numbers(argument: str, value: Any) -> Any:
    """Real numbers as float64."""
    try:
        array = jnp.asarray(value)
    except (TypeError, ValueError):
        raise _refusal(argument, repr(value), "real numbers") from None
    if not any(jnp.issubdtype(array.dtype, kind) for kind in (jnp.floating, jnp.integer)):
        raise _refusal(argument, str(array.dtype), "real numbers")
    return array.astype(np.float64)


def _aligned(arrays: Any) -> Any:
    """The arrays with equally many leading axes, which broadcast. An axis that ``vmap`` adds before them then belongs to the same axis of all."""
    for index, (argument, array) in enumerate(zip((*ROWS, "times"), arrays, strict=True)):
        try:
            leading = np.broadcast_shapes(*(other.shape[:-1] for other in arrays[: index + 1]))
        except ValueError:
            raise _refusal(argument, f"an array of shape {array.shape}", "of leading axes that broadcast with those of the arguments before it") from None
    return [array.reshape((1,) * (len(leading) + 1 - array.ndim) + array.shape) for array in arrays]


def _refusal(argument: str, value: Any, bound: str) -> InputError:
    error = InputError(f"{argument} is {value}: it must be {bound}")
    error.argument, error.value, error.bound = argument, value, bound
    return error


def _primal(moments: Any, attitude: Any, rates: Any, times: Any) -> Any:
    return _on_the_host(_evaluated, ((4,), (3,)), (moments, attitude, rates, times))


def _derivatives(moments: Any, attitude: Any, rates: Any, times: Any) -> Any:
    return _on_the_host(_differentiated, ((3, 9), (3, 9)), (moments, attitude, rates, times))


def _no_second_derivative(_primals: Any, _tangents: Any) -> Any:
    raise TheoryError("andoyer.jax has first derivatives with respect to moments, attitude and angular velocity: second derivatives do not exist here")


def _tangent(primals: Any, tangents: Any) -> Any:
    """The state and its tangent. The derivatives are constants here, so that the tangent is linear in the tangents and JAX can transpose it."""
    moments, attitude, _, _ = primals
    attitudes, rates = _state(*primals)
    turn, change = jnp.zeros_like(rates), jnp.zeros_like(rates)
    of_body = [None if isinstance(tangent, SymbolicZero) else tangent for tangent in tangents]
    of_times = of_body.pop()
    if any(tangent is not None for tangent in of_body):
        of_moments, of_attitude, of_rates = of_body
        by_attitude, by_rates = _partials(*primals)
        first = None if of_attitude is None else 2 * product(conjugate(attitude), of_attitude, jnp)[..., :3] / jnp.sum(attitude**2, axis=-1, keepdims=True)
        for tangent, start in ((first, 0), (of_rates, 3), (of_moments, 6)):
            if tangent is not None:
                turn = turn + jnp.einsum("...nip,...p->...ni", by_attitude[..., start : start + 3], tangent)
                change = change + jnp.einsum("...nip,...p->...ni", by_rates[..., start : start + 3], tangent)
    if of_times is not None:
        inertia = moments[..., None, :]
        turn = turn + rates * of_times[..., None]
        change = change + jnp.cross(inertia * rates, rates) / inertia * of_times[..., None]
    of_quaternion = product(attitudes, jnp.concatenate([0.5 * turn, jnp.zeros_like(turn[..., :1])], axis=-1), jnp)
    return (attitudes, rates), (of_quaternion, change)


_state: Any = jax.custom_jvp(_primal)
_state.defjvp(_tangent, symbolic_zeros=True)
_partials: Any = jax.custom_jvp(_derivatives)
_partials.defjvp(_no_second_derivative)


def _on_the_host(function: Any, rows: Any, arrays: Any) -> Any:
    """Call a function of NumPy arrays: at once where the values are known, so that its errors have their own types, otherwise when the traced program runs."""
    if not any(isinstance(array, jax.core.Tracer) for array in arrays):
        return tuple(jnp.asarray(value) for value in function(*map(np.asarray, arrays)))
    leading = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
    shapes = tuple(jax.ShapeDtypeStruct((*leading, arrays[-1].shape[-1], *row), np.float64) for row in rows)
    return jax.pure_callback(lambda *values: function(*map(np.asarray, values)), shapes, *arrays, vmap_method="expand_dims")


def _evaluated(*arrays: Array) -> tuple[Array, Array]:
    solved, times, shape = _solved(*arrays)
    samples = solved.at(times)
    return samples.attitude.reshape(*shape, 4), samples.angular_velocity.reshape(*shape, 3)


def _differentiated(*arrays: Array) -> tuple[Array, Array]:
    solved, times, shape = _solved(*arrays)
    partials = solved.partials(times)
    return partials.attitude.reshape(*shape, 3, 9), partials.angular_velocity.reshape(*shape, 3, 9)


def _solved(*arrays: Array) -> tuple[Motion | Ensemble, Array, tuple[int, ...]]:
    """The motion of one body or those of many, the times as it takes them, and the shape of its samples."""
    *vectors, times = arrays
    bodies = np.broadcast_shapes(*(vector.shape[:-1] for vector in vectors))
    shape = (*np.broadcast_shapes(bodies, times.shape[:-1]), times.shape[-1])
    if np.prod(bodies, dtype=int) == 1:
        moments, attitude, rates = (vector.reshape(-1) for vector in vectors)
        return Scene(Body(moments), attitude, rates).solve(), times.reshape(-1), shape
    members = [np.broadcast_to(vector, (*shape[:-1], vector.shape[-1])).reshape(-1, vector.shape[-1]) for vector in vectors]
    of_all = np.prod(times.shape[:-1], dtype=int) == 1
    return Ensemble(*members), times.reshape(-1) if of_all else np.broadcast_to(times, shape).reshape(-1, shape[-1]), shape
