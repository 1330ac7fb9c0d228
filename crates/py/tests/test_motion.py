"""Motions: shapes of times and results, `out`, what they conserve, plans, periods, and the reference solutions."""

import math
import re

import numpy as np
import pytest
from conftest import REFERENCE
from torque_free import TorqueFree

import andoyer
from andoyer import Body, Scene

METHODS = {"attitude": 4, "angular_velocity": 3, "angular_momentum": 3, "andoyer": 6}


@pytest.mark.parametrize("method, columns", METHODS.items())
def test_results_have_the_shape_of_the_times_and_one_more_axis(motion, method, columns):
    evaluate = getattr(motion, method)
    for times, shape in [([0.0, 1.0, 2.0], (3,)), ([5], (1,)), ([], (0,)), (np.empty(0), (0,)), (1.5, ()), (2, ()), (np.array(2), ())]:
        result = evaluate(times)
        assert result.shape == (*shape, columns)
        assert result.dtype == np.float64 and result.flags.c_contiguous and result.flags.writeable


@pytest.mark.parametrize("method", METHODS)
def test_all_kinds_of_times_give_the_same_bits(motion, method):
    evaluate = getattr(motion, method)
    times = np.arange(12.0)
    expected = evaluate(times)
    readonly = times.copy()
    readonly.flags.writeable = False
    unaligned = np.frombuffer(b"\0" + times.tobytes(), dtype=np.uint8)[1:].view(np.float64)
    kinds = [range(12), times.tolist(), times.astype(int), times.astype(np.float32), times.astype(">f8"), np.repeat(times, 3)[::3]]
    for kind in [*kinds, times[::-1].copy()[::-1], readonly, unaligned]:
        assert np.array_equal(evaluate(kind), expected)
    assert np.array_equal([evaluate(t) for t in times], expected)


def test_samples_are_those_of_the_two_methods(motion):
    times = np.linspace(-50, 50, 101)
    samples = motion.at(times)
    assert len(samples) == 101
    assert np.array_equal(samples.attitude, motion.attitude(times))
    assert np.array_equal(samples.angular_velocity, motion.angular_velocity(times))
    assert np.array_equal(samples.times, times) and samples.times is not times
    assert repr(samples) == "<Samples at 101 times>"


def test_samples_at_a_scalar_time_lack_the_leading_axis(motion):
    samples = motion.at(3)
    assert samples.times.shape == () and samples.attitude.shape == (4,) and samples.angular_velocity.shape == (3,)
    with pytest.raises(TypeError, match="len"):
        len(samples)


def test_motion_starts_from_its_scene(motion, scene):
    samples = motion.at(scene.epoch)
    assert np.abs(samples.attitude - scene.attitude).max() < 2e-15  # the plan's rounding
    assert np.abs(samples.angular_velocity - scene.angular_velocity).max() < 4e-15


BAD_TIMES = {
    "too far": ([0.0, 1.0, 2.0, 1e18], andoyer.RepresentationError, r"times\[3\] = 1e18"),
    "NaN": ([0.0, math.nan, 1.0], andoyer.InputError, r"times\[1\] = NaN"),
    "infinite": ([0.0, 0.0, math.inf], andoyer.InputError, r"times\[2\] = inf"),
    "scalar NaN": (math.nan, andoyer.InputError, r"times\[0\]"),
    "two axes": ([[0.0, 1.0]], andoyer.InputError, r"times has shape \(1, 2\)"),
    "ragged": ([[0.0], [1.0, 2.0]], andoyer.InputError, "times"),
    "text": ("now", TypeError, "times"),
    "none": (None, TypeError, "times"),
    "complex": ([1j], TypeError, "times"),
    "boolean": ([True], TypeError, "times"),
    "date": (np.array(["2026-01-01"], dtype="datetime64[s]"), TypeError, "times"),
}


@pytest.mark.parametrize("method", [*METHODS, "at", "rotation"])
@pytest.mark.parametrize("times, error, message", BAD_TIMES.values(), ids=BAD_TIMES)
def test_bad_times_are_refused(motion, method, times, error, message):
    with pytest.raises(error, match=message):
        getattr(motion, method)(times)


@pytest.mark.parametrize("method, columns", [("attitude", 4), ("angular_velocity", 3)])
def test_out_receives_the_result_itself(motion, method, columns):
    evaluate = getattr(motion, method)
    for times in [[0.0, 1.0], 1.0, []]:
        out = np.full((*np.shape(times), columns), np.nan)
        assert evaluate(times, out=out) is out
        assert np.array_equal(out, evaluate(times))
    rows = np.zeros((5, columns))
    evaluate([1.0, 2.0], rows[1:3])
    assert np.array_equal(rows[1:3], evaluate([1.0, 2.0])) and not rows[[0, 3, 4]].any()


def read_only():
    array = np.empty((2, 4))
    array.flags.writeable = False
    return array


BAD_OUTS = {
    "other length": (np.empty((3, 4)), andoyer.InputError, r"\(3, 4\): it must be \(2, 4\)"),
    "other width": (np.empty((2, 3)), andoyer.InputError, r"\(2, 3\)"),
    "flat": (np.empty(8), andoyer.InputError, r"\(8,\)"),
    "Fortran order": (np.empty((2, 4), order="F"), andoyer.InputError, "C-contiguous"),
    "strided": (np.empty((4, 4))[::2], andoyer.InputError, "C-contiguous"),
    "single precision": (np.empty((2, 4), np.float32), TypeError, "float64"),
    "other byte order": (np.empty((2, 4), ">f8"), TypeError, "float64"),
    "list": ([[0.0] * 4] * 2, TypeError, "list"),
    "read-only": (read_only(), TypeError, "read-only"),
    "unaligned": (np.empty(65, np.uint8)[1:].view(np.float64).reshape(2, 4), (TypeError, andoyer.InputError), "aligned"),
}


@pytest.mark.parametrize("method", ["auto", "integrated"])
def test_a_time_beyond_the_span_leaves_the_output_of_a_motion_under_a_torque_as_it_was(method):
    scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0.01, 1], orbit=andoyer.Orbit(2e-3, 0.1), span=(0, 1e3), tolerance=1e-4, method=method)
    motion, times = scene.solve(), np.append(np.linspace(0, 1e3, 2999), 1e300)
    assert motion.plan.method == ("closed" if method == "auto" else method)
    out = np.full((3000, 4), 7.0)
    with pytest.raises(andoyer.RepresentationError, match=r"times\[2999\]"):
        motion.attitude(times, out=out)
    assert (out == 7.0).all()


@pytest.mark.parametrize("out, error, message", BAD_OUTS.values(), ids=BAD_OUTS)
def test_bad_out_is_refused(motion, out, error, message):
    with pytest.raises(error, match=message):
        motion.attitude([0.0, 1.0], out=out)


def test_out_that_shares_memory_with_the_times_is_refused(motion):
    memory = np.zeros((3, 4))
    with pytest.raises(andoyer.Error, match="out shares memory"):
        motion.attitude(memory.reshape(-1)[:3], out=memory)


def test_angular_momentum_and_energy_are_constant(motion, body):
    times = np.linspace(0, 1e4, 500)
    samples = motion.at(times)
    momentum = body.moments * samples.angular_velocity
    inertial = motion.rotation(times).apply(momentum)
    # Rounding of the rates and of the attitude, a few 1e-15 each, times |G| = 2.
    assert np.abs(inertial - motion.angular_momentum(times)).max() < 4e-14
    energy = (momentum * samples.angular_velocity).sum(axis=1)
    assert np.ptp(energy) < 4e-14


def test_rotation_is_scipys(motion):
    assert motion.rotation([0.0, 1.0, 2.0]).as_quat().shape == (3, 4)
    assert motion.rotation(1.0).single


def test_andoyer_variables_give_the_attitude_back(motion):
    from scipy.spatial.transform import Rotation

    times = np.linspace(0, 30, 40)
    node, mu, nu, vertical, total, axial = motion.andoyer(times).T
    angles = np.column_stack([node, np.arccos(vertical / total), mu, np.arccos(axial / total), nu])
    rebuilt = Rotation.identity(len(times))
    for axis, angle in zip("zxzxz", angles.T, strict=True):
        rebuilt = rebuilt * Rotation.from_euler(axis, angle[:, None])
    # The arccosine of cos J ≈ 0.99 loses a digit.
    assert (rebuilt.inv() * motion.rotation(times)).magnitude().max() < 1e-13


@pytest.mark.parametrize("method", ["series", "closed"])
def test_plan_says_what_is_evaluated(scene, method):
    motion = Scene(scene.body, scene.attitude, scene.angular_velocity, method=method).solve()
    plan = motion.plan
    assert (plan.mode, plan.method) == ("short-axis", method)
    assert (plan.order > 0) == (method == "series") and plan.harmonics > 0 and 0 < plan.error_bound < 1e-12 and 0 < plan.separatrix_ratio < 0.1
    assert all(isinstance(reason, str) for reason in plan.skipped)
    assert "short-axis" in str(plan) and "order" in str(plan)
    # Two digits are printed.
    assert float(re.search(r"error bound +(\S+) rad", str(plan))[1]) == pytest.approx(plan.error_bound, rel=0.05)
    assert repr(plan).startswith(f"Plan(mode='short-axis', method='{method}', order=")
    assert motion.scene.solve().plan == plan


MODES = {
    "axisymmetric": ([1, 1, 1.5], [0.1, 0, 1]),
    "spherical": ([1, 1, 1], [0.1, 0, 1]),
    "principal-axis": ([1, 1.5, 2], [0, 0, 1]),
    "at-rest": ([1, 1.5, 2], [0, 0, 0]),
    "short-axis": ([1, 1.5, 2], [0.1, 0, 1]),
}


@pytest.mark.parametrize("mode", MODES)
def test_mode_is_that_of_the_motion(mode):
    moments, rates = MODES[mode]
    assert Scene(Body(moments), [0, 0, 0, 1], rates).solve().plan.mode == mode


def test_periods_follow_from_the_frequencies(motion):
    anomaly, longitude = motion.frequencies
    assert motion.frequencies.anomaly == anomaly > 0 and motion.frequencies.longitude == longitude > 0
    assert list(motion.periods) == ["long-axis", "short-axis", "extremal-axis"]
    long_axis, short_axis, extremal_axis = motion.periods.values()
    assert motion.plan.mode == "short-axis" and extremal_axis == short_axis
    assert long_axis == pytest.approx((math.tau / longitude, math.tau / anomaly), rel=1e-15)
    assert short_axis == pytest.approx((math.tau / (longitude + anomaly), math.tau / anomaly), rel=1e-15)
    assert short_axis.precession == short_axis[0] and short_axis.rotation == short_axis[1]


def angle(attitude, reference):
    """Angle between two attitudes without cancellation, in rad."""
    difference = min(np.linalg.norm(attitude - reference), np.linalg.norm(attitude + reference))
    return 4 * math.asin(min(difference / 2, 1))


def solved(case):
    return Scene(Body(case["moments"]), case["attitude0_xyzw"], case["angular_velocity0"], tolerance=1e-12).solve()


WOBBLING = [case for case in REFERENCE if case["mode"] == "SAM"]
NEAR = [case for case in REFERENCE if case["name"].startswith("near-separatrix")]


@pytest.mark.parametrize("case", REFERENCE, ids=lambda case: case["name"])
def test_reference_solution_is_met(case):
    states = case["states"]
    assert max(state["t"] for state in states) > (1e9 if case["name"] != "axis-2" else 600)
    samples = solved(case).at([state["t"] for state in states])
    for state, attitude, rates in zip(states, samples.attitude, samples.angular_velocity, strict=True):
        bound = 1e-12
        assert angle(attitude, np.array(state["attitude_xyzw"], dtype=float)) < bound
        assert np.abs(rates - np.array(state["angular_velocity"], dtype=float)).max() < bound


@pytest.mark.parametrize("case", WOBBLING, ids=lambda case: case["name"])
def test_frequencies_and_periods_are_those_of_the_closed_form(case):
    motion = solved(case)
    # Of axis 3 about the angular momentum, and of the body about axis 3: μ and ν for N > 0.
    reference = TorqueFree(case["moments"], case["attitude0_xyzw"], case["angular_velocity0"])
    precession, roll = reference.mean_rates()
    assert precession > 0 > roll
    assert motion.frequencies.anomaly == pytest.approx(float(-roll), rel=1e-13)
    assert motion.frequencies.longitude == pytest.approx(float(precession + roll), rel=1e-13)
    turn = 2 * reference.context.pi
    long_axis, short_axis = motion.periods["long-axis"], motion.periods["short-axis"]
    assert long_axis == pytest.approx((float(turn / (precession + roll)), float(-turn / roll)), rel=1e-13)
    assert short_axis == pytest.approx((float(turn / precession), float(-turn / roll)), rel=1e-13)


@pytest.mark.parametrize("case", WOBBLING, ids=lambda case: case["name"])
def test_andoyer_angles_advance_with_the_frequencies(case):
    motion = solved(case)
    anomaly, longitude = motion.frequencies
    sense = 1 if case["angular_velocity0"][2] > 0 else -1
    # A period of the polhode, over which the periodic parts of μ and ν return; eighty samples a turn to unwrap them.
    span = math.tau / anomaly
    times = np.linspace(0, span, 1 + math.ceil(80 * span * (longitude + anomaly) / math.tau))
    mu, nu = (np.unwrap(angle) for angle in motion.andoyer(times)[:, 1:3].T)
    assert sense * motion.andoyer(0.0)[5] > 0
    # Rounding of the attitude, 2.5e-15 rad at either end, turns the node of a tilt J by that over sin J.
    momentum = np.multiply(case["moments"], case["angular_velocity0"])
    error = 1e-11 + 5e-15 * np.linalg.norm(momentum) / np.hypot(*momentum[:2])
    assert mu[-1] - mu[0] == pytest.approx((longitude + anomaly) * span, abs=error)
    assert nu[-1] - nu[0] == pytest.approx(-sense * anomaly * span, abs=error)


@pytest.mark.parametrize("case", NEAR, ids=lambda case: case["name"])
def test_the_series_refuses_what_is_too_near_the_separatrix(case):
    scene = Scene(Body(case["moments"]), case["attitude0_xyzw"], case["angular_velocity0"], method="series")
    with pytest.raises(andoyer.TheoryError, match="too near the separatrix"):
        scene.solve()


def test_long_axis_mode_has_the_periods_of_every_convention():
    case = next(case for case in REFERENCE if case["name"] == "long-axis")
    motion = solved(case)
    assert (motion.plan.mode, motion.plan.method) == ("long-axis", "closed")
    reference = TorqueFree(case["moments"], case["attitude0_xyzw"], case["angular_velocity0"])
    precession, roll = (abs(float(rate)) for rate in reference.mean_rates())
    # The long axis precesses and the body rolls about it.
    assert motion.periods["long-axis"] == pytest.approx((math.tau / precession, math.tau / roll), rel=1e-13)
    assert motion.periods["extremal-axis"] == motion.periods["long-axis"]
    assert motion.periods["short-axis"].rotation == motion.periods["long-axis"].rotation
