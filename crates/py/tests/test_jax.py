"""JAX functions: values of the motion, derivatives against those of an integration written in JAX, transformations, errors."""

import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip("jax")

import jax
import jax.numpy as jnp

import andoyer
from andoyer.jax import angular_velocity, attitude, state

jax.config.update("jax_enable_x64", True)

MOMENTS = jnp.array([1.0, 1.5, 2.0])
ATTITUDE = jnp.array([0.5, -0.1, 0.7, 0.5])
RATES = {"short-axis": jnp.array([0.3, 0.2, 1.0]), "long-axis": jnp.array([1.0, 0.2, 0.3])}
TIMES = jnp.array([0.0, 2.5, 5.0, 10.0])
STEPS = 2000
# The error of a step of RK4 is at most 1/120 of (rate × 1/200)⁵, that of a derivative up to 40 times as large after ten rotations: 2000 × 5e-14 × 40 / 10.
BOUND = 1e-9


def case(mode, moments=MOMENTS):
    return moments, ATTITUDE, RATES[mode], TIMES


def slope(moments, y):
    (x, v, z, w), rates = y[:4], y[4:]
    quaternion = 0.5 * jnp.array([[w, -z, v], [z, w, -x], [-v, x, w], [-x, -v, -z]]) @ rates
    return jnp.concatenate([quaternion, jnp.cross(moments * rates, rates) / moments])


def integrated(moments, attitude, rates, time):
    """Attitude and angular velocity at a time, by the classical method of Runge and Kutta with equal steps."""
    step = time / STEPS

    def advanced(y, _):
        a = slope(moments, y)
        b = slope(moments, y + step / 2 * a)
        c = slope(moments, y + step / 2 * b)
        d = slope(moments, y + step * c)
        return y + step / 6 * (a + 2 * b + 2 * c + d), None

    start = jnp.concatenate([attitude / jnp.linalg.norm(attitude), rates])
    return jax.lax.scan(advanced, start, length=STEPS)[0]


reference = jax.jit(jax.vmap(integrated, (None, None, None, 0)))
jacobians = jax.jit(jax.jacfwd(reference, argnums=(0, 1, 2, 3)))


def both(*arguments):
    return jnp.concatenate(state(*arguments), axis=-1)


@pytest.mark.parametrize("mode", RATES)
@pytest.mark.parametrize("moments", [MOMENTS, MOMENTS[::-1]], ids=["ascending", "descending"])
def test_values_and_derivatives_are_those_of_an_integration(mode, moments):
    arguments = case(mode, moments)
    expected = reference(*arguments)
    found = both(*arguments)
    sign = jnp.sign(jnp.sum(found[:, :4] * expected[:, :4], axis=1))[:, None]
    signs = jnp.concatenate([jnp.repeat(sign, 4, axis=1), jnp.ones((len(TIMES), 3))], axis=1)
    assert np.abs(found * signs - expected).max() < BOUND
    theirs_by_argument = jacobians(*arguments)
    for differentiate in (jax.jacfwd, jax.jacrev):
        for ours, theirs in zip(differentiate(both, argnums=(0, 1, 2, 3))(*arguments), theirs_by_argument, strict=True):
            assert ours.shape == theirs.shape and np.abs(theirs).max() > 0.1
            assert np.abs(ours * signs[..., None] - theirs).max() < BOUND * max(1, np.abs(theirs).max())


def test_values_are_the_bits_of_the_motion():
    moments, start, rates, times = map(np.asarray, case("short-axis"))
    samples = andoyer.Scene(andoyer.Body(moments), start, rates).solve().at(times)
    for found in (state(moments, start, rates, times), jax.jit(state)(moments, start, rates, times)):
        assert (np.asarray(found[0]) == samples.attitude).all() and (np.asarray(found[1]) == samples.angular_velocity).all()
        assert found[0].dtype == found[1].dtype == np.float64
    assert (attitude(*case("short-axis")) == samples.attitude).all() and (angular_velocity(*case("short-axis")) == samples.angular_velocity).all()


def test_gradient_of_a_loss_is_that_of_the_integration_with_and_without_jit():
    measured = reference(*case("short-axis"))[:, :4]

    def loss(model, moments, rates):
        found = model(moments, ATTITUDE, rates, TIMES)[:, :4]
        return jnp.sum(1 - jnp.sum(found * measured, axis=-1) ** 2)

    guess = MOMENTS * jnp.array([1.0, 1.01, 0.98]), RATES["short-axis"] * 1.02
    expected = jax.grad(loss, argnums=(1, 2))(reference, *guess)
    plain, compiled = (transform(jax.grad(lambda *given: loss(both, *given), argnums=(0, 1)))(*guess) for transform in (lambda function: function, jax.jit))
    for ours, again, theirs in zip(plain, compiled, expected, strict=True):
        assert np.abs(theirs).max() > 0.1
        assert np.abs(ours - theirs).max() < BOUND * 10 and np.abs(again - theirs).max() < BOUND * 10


def test_gradient_with_respect_to_the_attitude_is_perpendicular_to_it_and_that_of_the_normalized_one():
    def last(start):
        return attitude(MOMENTS, start, RATES["short-axis"], 3.0)[3]

    longer = ATTITUDE * (1 + 5e-7)
    gradient, scaled = jax.grad(last)(ATTITUDE), jax.grad(last)(longer)
    assert abs(gradient @ ATTITUDE) < 1e-15 and np.abs(gradient).max() > 0.1
    assert np.abs(scaled * (1 + 5e-7) - gradient).max() < 1e-15
    assert jax.jvp(last, (ATTITUDE,), (ATTITUDE,))[1] == pytest.approx(0, abs=1e-15)


def test_derivatives_with_respect_to_time_are_those_of_the_equations_of_motion_to_second_order():
    moments, start, rates, _ = case("long-axis")

    def along(time):
        return both(moments, start, rates, time)

    first = jax.jacfwd(along)
    assert np.abs(first(5.0) - slope(moments, along(5.0))).max() < 1e-14
    expected = jax.jvp(lambda y: slope(moments, y), (along(5.0),), (first(5.0),))[1]
    assert np.abs(jax.jacfwd(first)(5.0) - expected).max() < 1e-14
    assert np.abs(jax.jacrev(first)(5.0) - expected).max() < 1e-14


@pytest.mark.parametrize("compiled", [False, True])
def test_vmap_gives_what_each_body_gives(compiled):
    moments, rates = jnp.stack([MOMENTS, MOMENTS[::-1], jnp.ones(3)]), jnp.stack([*RATES.values(), jnp.array([0.1, 0.2, 0.3])])
    own = jnp.stack([TIMES, TIMES + 1, TIMES * 2])
    each = [both(moments[k], ATTITUDE, rates[k], TIMES) for k in range(3)]
    mapped = jax.vmap(both, (0, None, 0, None))
    found = (jax.jit(mapped) if compiled else mapped)(moments, ATTITUDE, rates, TIMES)
    assert (found == jnp.stack(each)).all()
    assert (both(moments, ATTITUDE, rates, TIMES) == found).all()
    with_times = jnp.stack([both(moments[k], ATTITUDE, rates[k], own[k]) for k in range(3)])
    assert (jax.vmap(both, (0, None, 0, 0))(moments, ATTITUDE, rates, own) == with_times).all()
    assert (both(moments, ATTITUDE, rates, own) == with_times).all()
    grid = jax.vmap(jax.vmap(both, (None, None, 0, None)), (0, None, None, None))(moments, ATTITUDE, rates, TIMES)
    assert (grid == both(moments[:, None], ATTITUDE, rates, TIMES)).all() and grid.shape == (3, 3, 4, 7)
    assert (jax.vmap(both, (None, None, None, 0))(MOMENTS, ATTITUDE, rates[0], TIMES) == each[0]).all()


def test_vmap_over_an_axis_of_arguments_with_unequal_leading_axes_keeps_the_axes_apart():
    moments = jnp.stack([MOMENTS, MOMENTS[::-1]])
    own = jnp.stack([TIMES, TIMES + 1, TIMES * 2])
    found = jax.vmap(both, (0, None, None, None))(moments, ATTITUDE, RATES["short-axis"], own)
    assert found.shape == (2, 3, 4, 7)
    assert (found[1] == both(moments[1], ATTITUDE, RATES["short-axis"], own)).all()


def test_derivatives_of_many_bodies_are_those_of_each():
    moments, rates = jnp.stack([MOMENTS, MOMENTS[::-1]]), jnp.stack(list(RATES.values()))

    def jacobian(moments, rates):
        return jax.jacrev(both, argnums=(0, 1, 2, 3))(moments, ATTITUDE, rates, TIMES)

    mapped = jax.jit(jax.vmap(jacobian))(moments, rates)
    for k in range(2):
        for found, expected in zip(mapped, jacobian(moments[k], rates[k]), strict=True):
            assert np.abs(found[k] - expected).max() <= 1e-14 * max(1, np.abs(expected).max())
    total = jax.grad(lambda moments: both(moments, ATTITUDE, rates, TIMES)[..., 2].sum())(moments)
    expected = jnp.stack([jax.grad(lambda one, k=k: both(one, ATTITUDE, rates[k], TIMES)[..., 2].sum())(moments[k]) for k in range(2)])
    assert np.abs(total - expected).max() < 1e-13 * np.abs(expected).max()


def test_shapes_follow_the_arguments():
    assert attitude(MOMENTS, ATTITUDE, [0.1, 0.2, 1], 3).shape == (4,)
    assert angular_velocity(MOMENTS, ATTITUDE, [0.1, 0.2, 1], [3]).shape == (1, 3)
    assert attitude(MOMENTS, ATTITUDE, RATES["short-axis"], jnp.zeros(0)).shape == (0, 4)
    assert attitude(jnp.ones((0, 3)), ATTITUDE, RATES["short-axis"], TIMES).shape == (0, 4, 4)


@pytest.mark.parametrize(
    "argument, value, message",
    [
        ("moments", [1.0, 1.5, 3.0], "the largest must not exceed the sum of the other two"),
        ("moments", [1.0, 1.5], r"an array of shape \(2,\): it must be of shape \(..., 3\)"),
        ("moments", "a tensor", "it must be real numbers"),
        ("attitude", [0.0, 0.0, 0.0, 2.0], "norm within 1e-6 of 1"),
        ("angular_velocity", np.ones((3, 4)), r"it must be of shape \(..., 3\)"),
        ("times", [1j], "it must be real numbers"),
        ("times", np.nan, "finite"),
    ],
)
def test_errors_name_the_argument(argument, value, message):
    arguments = dict(zip(("moments", "attitude", "angular_velocity", "times"), case("short-axis"), strict=True))
    with pytest.raises(andoyer.InputError, match=message) as caught:
        attitude(**arguments | {argument: value})
    assert caught.value.argument == argument


def test_leading_axes_that_do_not_broadcast_are_an_error():
    with pytest.raises(andoyer.InputError, match=r"times is an array of shape \(3, 4\)"):
        attitude(jnp.ones((2, 3)), ATTITUDE, RATES["short-axis"], jnp.ones((3, 4)))


def test_error_of_a_compiled_function_says_what_is_wrong():
    with pytest.raises(jax.errors.JaxRuntimeError, match="the largest must not exceed the sum of the other two"):
        jax.jit(attitude)(jnp.array([1.0, 1.5, 3.0]), *case("short-axis")[1:])


def test_no_derivatives_on_the_separatrix():
    falling = jnp.array([3.0, 4.0, 6.0]), ATTITUDE, jnp.array([2.0, 0.5, 1.0]), TIMES
    assert jnp.isfinite(attitude(*falling)).all()
    with pytest.raises(andoyer.TheoryError, match="frequencies have no derivatives"):
        jax.jacfwd(attitude, argnums=2)(*falling)


def test_second_derivatives_with_respect_to_the_state_are_an_error():
    with pytest.raises(andoyer.TheoryError, match="first derivatives"):
        jax.hessian(lambda rates: attitude(MOMENTS, ATTITUDE, rates, 1.0)[3])(RATES["short-axis"])


def test_numbers_of_32_bits_are_an_error():
    code = "import andoyer\ntry: andoyer.jax.attitude([1, 1, 1], [0, 0, 0, 1], [0, 0, 1], 1)\nexcept andoyer.RepresentationError as error: print(error)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0 and 'jax.config.update("jax_enable_x64", True)' in done.stdout, done.stdout + done.stderr


def test_without_jax_the_error_names_the_extra():
    code = "import sys; sys.modules['jax'] = None\nimport andoyer\ntry: andoyer.jax\nexcept ImportError as error: print(error)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "andoyer.jax needs jax, which is not installed: pip install jax\n", done.stdout + done.stderr


def test_import_of_the_package_does_not_import_jax():
    done = subprocess.run([sys.executable, "-c", "import sys, andoyer; sys.exit('jax' in sys.modules)"], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
