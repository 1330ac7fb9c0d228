"""Every kind of bad input: the class of its error, the argument, the value and the bound, all of which the message names."""

import copy
import math
import pickle

import numpy as np
import pytest

import andoyer
from andoyer import Body, Ensemble, FileError, InputError, NormalForm, Orbit, RepresentationError, Scene, TheoryError, normalize

INF, NAN = math.inf, math.nan
UNIT, RATES = [0, 0, 0, 1], [0.1, 0.2, 1.0]
BODY, PAIR = Body([1.0, 1.5, 2.0]), [("x", "X")]
OSCILLATOR, PLANE = "(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y", [("x", "X"), ("y", "Y")]


def scene(**options):
    return Scene(BODY, options.pop("attitude", UNIT), options.pop("rates", RATES), **options)


def motion():
    return scene().solve()


def round_body(orbit, rates):
    return Scene(Body([1, 1.02, 1.05]), UNIT, rates, orbit=orbit).solve()


def members(**options):
    return Ensemble(options.pop("moments", [[1, 1.5, 2]] * 2), UNIT, RATES, **options)


def oscillator():
    return normalize(OSCILLATOR, 2, PLANE, resonances=[(1, -1)])


# Call, class, argument, value, bound.
BAD = {
    "moment": (lambda: Body([1, -1, 1]), InputError, "moments", -1.0, "positive and finite"),
    "moments of no body": (lambda: Body([1, 2, 3.5]), InputError, "moments", (1.0, 2.0, 3.5), "the largest at most the sum of the other two"),
    "three rows of moments": (lambda: Body(np.eye(3)), InputError, "moments", (3, 3), "(3,)"),
    "two moments": (lambda: Body([1, 2]), InputError, "moments", (2,), "(3,)"),
    "tensor without symmetry": (
        lambda: Body.from_inertia([[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]),
        InputError,
        "tensor",
        0.1,
        "finite and symmetric to 1e-12 of its largest entry",
    ),
    "tensor of no body": (lambda: Body.from_inertia(np.diag([1, 1, -1])), InputError, "tensor", (1.0, 1.0, -1.0), "positive principal moments"),
    "semi-axis": (lambda: Body.ellipsoid(1, 0, 1), InputError, "b", 0.0, "positive and finite"),
    "name of a body": (lambda: Body.named("vulcan"), InputError, "name", "vulcan", ", ".join(Body.catalogue())),
    "attitude": (lambda: scene(attitude=[0, 0, 0, 2]), InputError, "attitude", (0.0, 0.0, 0.0, 2.0), "finite with a norm within 1e-6 of 1"),
    "rate": (lambda: scene(rates=[0, INF, 0]), InputError, "angular_velocity", INF, "finite"),
    "epoch": (lambda: scene(epoch=-INF), InputError, "epoch", -INF, "finite"),
    "tolerance": (lambda: scene(tolerance=0.0), InputError, "tolerance", 0.0, "positive and finite"),
    "span": (lambda: scene(span=(1, 0)), InputError, "span", (1.0, 0.0), "finite with start <= stop"),
    "span of one number": (lambda: scene(span=100), InputError, "span", 100.0, "(2,)"),
    "method": (lambda: scene(method="magic"), InputError, "method", "magic", "auto, series, closed, integrated, libration"),
    "averaging": (lambda: scene(averaging="moon"), InputError, "averaging", "moon", "auto, orbit, spin"),
    "level": (lambda: scene(level="moon"), InputError, "level", "moon", "auto, paper, moving, full, second-order"),
    "negative order": (lambda: scene(order=-1), InputError, "order", -1, (0, 60)),
    "half an order": (lambda: scene(order=2.5), InputError, "order", 2.5, (0, 60)),
    "high order": (lambda: scene(order=61), RepresentationError, "order", 61, 60),
    "huge order": (lambda: scene(order=10**30), RepresentationError, "order", 10**30, (0, 60)),
    "units": (lambda: scene(rates=[0, 0, 1e-320]).solve(), RepresentationError, "moments and angular_velocity", -1021, (-1021, 1021)),
    "element of an orbit": (lambda: Orbit(1.0, 1.0), InputError, "eccentricity", 1.0, "0 or more, other than 1 and at most 1e50"),
    "mode": (lambda: Scene.from_periods(BODY, 1, 2, mode="tumbling"), InputError, "mode", "tumbling", "short-axis, long-axis"),
    "convention": (lambda: Scene.from_periods(BODY, 1, 2, convention="mine"), InputError, "convention", "mine", "extremal-axis, long-axis, short-axis"),
    "period": (lambda: Scene.from_periods(BODY, -1, 2), InputError, "precession", -1.0, "positive and finite"),
    "direction": (
        lambda: Scene.from_periods(BODY, 1, 2, momentum_direction=[0, 0, 0]),
        InputError,
        "momentum_direction",
        (0.0, 0.0, 0.0),
        "finite and not 0",
    ),
    "latitude": (
        lambda: Scene.from_periods(BODY, 1, 2, momentum_direction=[1.0, 3.0]),
        InputError,
        "momentum_direction",
        (1.0, 3.0),
        "a latitude from -pi/2 to pi/2",
    ),
    "Andoyer momentum": (lambda: Scene.from_andoyer(BODY, [0, 0, 0, 3.0, 2.5, 0]), InputError, "andoyer", 3.0, "at most M = 2.5 in magnitude"),
    "Andoyer variable": (lambda: Scene.from_andoyer(BODY, [0, 0, 0, 0, NAN, 0]), InputError, "andoyer", NAN, "finite"),
    "NaN among times": (lambda: motion().at([0, NAN]), InputError, "times", NAN, ...),
    "far time": (lambda: motion().at(1e18), RepresentationError, "times", 1e18, ...),
    "shape of times": (lambda: motion().at([[0.0]]), InputError, "times", (1, 1), "() or (n,)"),
    "shape of out": (lambda: motion().attitude([0.0], out=np.empty((2, 4))), InputError, "out", (2, 4), "(1, 4)"),
    "strided out": (lambda: motion().attitude([0.0], out=np.empty((1, 8))[:, ::2]), InputError, "out", "strided", "C-contiguous"),
    "series on the separatrix": (lambda: Scene(Body([3, 5, 6]), UNIT, [1, 0.5, 1], method="series").solve(), TheoryError, "method", "series", "closed"),
    "series near the separatrix": (lambda: scene(rates=[1e-4, 1, 1e-4], method="series").solve(), TheoryError, "tolerance", 1e-12, ...),
    "spin resonance": (lambda: round_body(Orbit(0.038348, inclination=0.5, mass_fraction=3e-2), [0, 0.01, 1]), TheoryError, "orbit", ..., ...),
    "torque": (lambda: round_body(Orbit(0.9), [0, 0, 1]), TheoryError, "orbit", ..., ...),
    "rest": (lambda: round_body(Orbit(1e-3), [0, 0, 0]), TheoryError, "orbit", "at-rest", "a body that rotates"),
    "no averaged theory": (lambda: round_body(Orbit(1e-3), [0, 1, 1e-3]), TheoryError, "orbit", ..., 0.9),
    "member": (lambda: members(moments=[[1, 1.5, 2], [1, 1, 2.5]]), InputError, "moments", (1.0, 1.0, 2.5), "the largest at most the sum of the other two"),
    "what becomes of members": (lambda: members(errors="ignore"), InputError, "errors", "ignore", "raise, nan"),
    "no threads": (lambda: members(threads=0), InputError, "threads", 0, "it must be from 1 to 1024"),
    "half a thread": (lambda: members(threads=2.5), InputError, "threads", 2.5, (1, 1024)),
    "no axis of members": (lambda: Ensemble([1, 1.5, 2], UNIT, RATES), InputError, "moments", "one row", "(m, 3)"),
    "missing file": (lambda: Scene.from_toml("absent.toml"), FileError, "file", "absent.toml", "a file that can be read"),
    "memory": (lambda: NormalForm(2000), RepresentationError, "order", 2000, "8 GiB of memory"),
    "exponents of an order": (lambda: NormalForm(16382), RepresentationError, "order", 16382, 16381),
    "order not computed": (lambda: NormalForm(2).triaxiality_polynomial(3), InputError, "n", 3, (0, 2)),
    "generator not computed": (lambda: NormalForm(2).generator(0), InputError, "m", 0, (1, 2)),
    "variable": (lambda: NormalForm(2).direct("x", 1), InputError, "name", "x", '"u", "U", "y"'),
    "part": (lambda: NormalForm(2).to_latex("lagrangian"), InputError, "what", "lagrangian", ...),
    "language": (lambda: NormalForm(2).to_code("fortran"), InputError, "language", "fortran", ...),
    "beta": (lambda: andoyer.separatrix_action(2.0), InputError, "beta", 2.0, (0.0, 1.0)),
    "no JSON": (lambda: NormalForm.from_json("{"), FileError, "text", "line 1 column 1", "EOF while parsing an object"),
    "format": (lambda: NormalForm.from_json('{"format": "x", "version": 7}'), FileError, "text", "x version 7", "andoyer-normal-form version 1"),
    "coefficient": (
        lambda: NormalForm.from_json(NormalForm(2).to_json().replace('[[2,"-1/2"]]', '[[2,"-3/4"]]')),
        FileError,
        "text",
        "-3/4",
        "-1/2",
    ),
    "text of a polynomial": (lambda: normalize("x^2 +", 2, PAIR), InputError, "hamiltonian", 5, "a polynomial"),
    "unknown name": (lambda: normalize("x^2 + z^2", 2, PAIR), InputError, "hamiltonian", "z", "a variable or parameter"),
    "linear term": (lambda: normalize("x + x^2 + X^2", 2, PAIR), InputError, "hamiltonian", "x", "no linear term"),
    "coefficient not finite": (lambda: normalize({(2, 0): NAN}, 2, PAIR), InputError, "hamiltonian", NAN, "finite"),
    "nine variables": (lambda: normalize("1", 2, [(f"q{k}", f"p{k}") for k in range(5)]), InputError, "variables", 10, 8),
    "zero frequency": (lambda: normalize("x^2 + X^2 + Y^2", 2, PLANE), TheoryError, "hamiltonian", "(y, Y)", "no frequency 0"),
    "Jordan block": (lambda: normalize("x*X + y*Y + x*Y", 2, PLANE), TheoryError, "hamiltonian", ..., "no Jordan block"),
    "irrational frequency": (
        lambda: normalize("x^2 + X^2/4 + x^2", 2, PAIR, exact=True),
        RepresentationError,
        "hamiltonian",
        "2",
        "the square of a rational number, or floats",
    ),
    "small divisor": (lambda: normalize(OSCILLATOR, 2, PLANE), TheoryError, "resonances", 0.0, 1e-6),
    "no resonance": (lambda: normalize(OSCILLATOR, 2, PLANE, resonances=[(2, -1)]), InputError, "resonances", (2, -1), 1e-6),
    "no vector": (lambda: normalize(OSCILLATOR, 2, PLANE, resonances=[(0, 0)]), InputError, "resonances", (0, 0), ...),
    "resonant terms": (lambda: oscillator().in_actions(), TheoryError, None, ..., "a function of the actions alone"),
    "divisor": (lambda: normalize(OSCILLATOR, 2, PLANE, smallest_divisor=2.0), InputError, "smallest_divisor", 2.0, (0.0, 1.0)),
    "keep": (lambda: normalize(OSCILLATOR, 2, PLANE, keep="all"), InputError, "keep", "all", "hyperbolic"),
    "parameters": (lambda: oscillator().to_normal([0, 0, 0, 0], {"z": 1}), InputError, "parameters", "z", ""),
    "length of states": (lambda: oscillator().to_normal([0, 0]), InputError, "states", (2,), "(4,) or (m, 4)"),
}


def same(one, other):
    return other is ... or one == other or (one != one and other != other)


@pytest.mark.parametrize("call, kind, argument, value, bound", BAD.values(), ids=BAD)
def test_bad_input_has_its_class_argument_value_and_bound(call, kind, argument, value, bound):
    with pytest.raises(andoyer.Error) as caught:
        call()
    error = caught.value
    assert type(error) is kind
    assert error.argument == argument and same(error.value, value) and same(error.bound, bound), (error.argument, error.value, error.bound)
    assert error.value is not None and error.bound is not None
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is kind and (str(again), again.argument, again.bound) == (str(error), error.argument, error.bound)
    assert copy.copy(error).argument == error.argument


KEYS = {
    "value": ("moments = [1, 1.5, 2]", "moments = [1, 2, 3.5]", "body.moments", (1.0, 2.0, 3.5), "the largest at most the sum of the other two"),
    "type": ("moments = [1, 1.5, 2]", 'moments = "ceres"', "body.moments", "ceres", "an array of length 3"),
    "unknown key": ("[state]", "[state]\ncolour = 1", "state.colour", 1, "one of attitude, angular_velocity, frame, elements_of, relative, sequence, of"),
    "missing key": ("angular_velocity = [0, 0, 1]", "", "state.angular_velocity", None, "present"),
    "no TOML": ("[state]", "[state", "line 3", "[state", "TOML"),
}


@pytest.mark.parametrize("line, wrong, key, value, bound", KEYS.values(), ids=KEYS)
def test_a_scene_file_has_the_key_its_value_and_the_bound(tmp_path, line, wrong, key, value, bound):
    path = tmp_path / "scene.toml"
    path.write_text("[body]\nmoments = [1, 1.5, 2]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]\n".replace(line, wrong), encoding="utf-8")
    with pytest.raises(FileError) as caught:
        Scene.from_toml(path)
    assert (caught.value.argument, caught.value.value, caught.value.bound) == (key, value, bound)


def test_the_error_of_a_member_has_its_index_and_that_of_a_single_body_none():
    with pytest.raises(InputError) as caught:
        members(moments=[[1, 1.5, 2], [1, 1, 2.5]])
    assert caught.value.index == 1
    with pytest.raises(InputError) as caught:
        Body([1, 1, 2.5])
    assert not hasattr(caught.value, "index")


def test_an_error_that_python_raises_has_the_attributes_too():
    error = andoyer.Error("what")
    assert (error.argument, error.value, error.bound) == (None, None, None)
