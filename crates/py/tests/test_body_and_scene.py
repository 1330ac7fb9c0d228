"""Bodies and scenes: what they hold, what they refuse, and that they can be written and read back."""

import math
import os
from fractions import Fraction

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer import Body, Scene

ATTITUDE, RATES = [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0]
NAN, INF = math.nan, math.inf


def test_constants_of_the_body_are_those_of_the_sorted_moments():
    body = Body((2, 1, 1.5))  # C/A − 1 = 1, C/B − 1 = 1/3
    assert body.moments.tolist() == [2.0, 1.0, 1.5]
    constants = [body.alpha, body.beta, body.gamma, body.omega]
    assert constants == pytest.approx([2 / 3, 1 / 2, 1 / math.sqrt(3), math.sqrt(3)], rel=4e-16)


def test_catalogue_knows_its_bodies_in_any_case():
    assert "Ceres" in Body.catalogue()
    assert Body.named("ceres") == Body.named("CERES")
    assert Body.named("ceres").name == "Ceres"
    for name in Body.catalogue():
        assert "read" in Body.source(name) or "derived" in Body.source(name)
        assert not [word for word in ("recalled", "memory") if word in Body.source(name)]
    for lookup in [Body.named, Body.source]:
        with pytest.raises(andoyer.InputError, match='"vulcan".*Ceres'):
            lookup("vulcan")


@pytest.mark.parametrize("misspelt, known", [("ceers", "Ceres"), ("toutatos", "Toutatis"), ("Aphopis", "Apophis"), ("hyperyon", "Hyperion")])
def test_misspelt_name_is_answered_with_the_nearest_one(misspelt, known):
    with pytest.raises(andoyer.InputError, match=f'did you mean "{known}"'):
        Body.named(misspelt)
    with pytest.raises(andoyer.InputError, match="^(?!.*did you mean)"):
        Body.named("vulcan")


def test_quaternion_that_is_not_normalized_is_told_how_and_reminded_of_the_order(body):
    with pytest.raises(andoyer.InputError, match=r"it is 2\); to normalize it, divide it by its norm; .*scalar_first=True"):
        Scene(body, [0, 0, 0, 2], RATES)
    with pytest.raises(andoyer.InputError, match=r"it is 0\)$"):
        Scene(body, [0, 0, 0, 0], RATES)


@pytest.mark.parametrize("name", ["earth", "ceres", "vesta", "eros", "apophis"])
def test_catalogue_and_scene_of_a_body_have_the_same_moments(name):
    scene = Scene.from_toml(REPOSITORY / f"examples/scenes/{name}.toml")
    assert scene.body.moments.tolist() == Body.named(name).moments.tolist()


def test_repr_can_be_pasted_back(scene):
    names = vars(andoyer)
    for body in [Body([0.1, 0.2, 0.25]), Body([1e-300, 2e-300, 2e-300], name='it\'s "é"')]:
        assert eval(repr(body), dict(names)) == body
    assert eval(repr(scene), dict(names)) == scene
    other = Scene(scene.body, scene.attitude, RATES, order=3, span=[0, 5], method="series", source="a 'book'")
    assert eval(repr(other), dict(names)) == other != scene


def test_equal_things_have_equal_hashes(scene):
    assert Body([1, 2, 2]) == Body(np.array([1.0, 2.0, 2.0])) and hash(Body([1, 2, 2])) == hash(Body((1.0, 2, 2)))
    assert Body([1, 2, 2]) != Body([2, 1, 2]) != "Body"
    same = Scene(scene.body, scene.attitude, scene.angular_velocity, epoch=2.0, name="wobble")
    assert same == scene and hash(same) == hash(scene)
    assert Scene(scene.body, scene.attitude, RATES) != scene


def test_scene_holds_what_it_was_given(body):
    scene = Scene(body, ATTITUDE, RATES)
    assert (scene.epoch, scene.tolerance, scene.method, scene.order, scene.span, scene.name) == (0, 1e-12, "auto", None, None, None)
    scene = Scene(body, ATTITUDE, RATES, epoch=3, tolerance=1e-9, method="series", order=np.int64(4), span=(0, 9), name="n", source="s")
    assert (scene.epoch, scene.tolerance, scene.method, scene.order, scene.span) == (3.0, 1e-9, "series", 4, (0.0, 9.0))
    assert (scene.body, scene.name, scene.source) == (body, "n", "s")
    assert scene.solve().scene == scene and scene.solve().plan.order == 4


@pytest.mark.parametrize("kind", [list, tuple, np.array, lambda x: np.array(x, dtype=">f4"), lambda x: np.repeat(x, 2)[::2]])
def test_anything_like_an_array_is_an_attitude(body, kind):
    assert Scene(body, kind([0, 0, 1, 0]), kind([0, 0, 1])).attitude.tolist() == [0, 0, 1, 0]


def test_fractions_and_other_numbers_are_numbers(body):
    assert Scene(body, ATTITUDE, [Fraction(1, 4), 0, 1]).angular_velocity.tolist() == [0.25, 0, 1]


def test_attitude_near_unit_norm_is_normalized_and_read_only(body):
    attitude = Scene(body, [0, 0, 0.6000001, 0.8], RATES).attitude
    assert np.linalg.norm(attitude) == pytest.approx(1, abs=3e-16)
    with pytest.raises(ValueError, match="read-only"):
        attitude[0] = 1.0


@pytest.mark.parametrize("moments", [[0, 1, 1], [1, -1, 1], [1, NAN, 1], [1, 1, INF], [1, 1, 2.1], [1e-101, 1, 1]])
def test_moments_that_no_body_has_are_refused(moments):
    with pytest.raises(andoyer.InputError, match="moments"):
        Body(moments)


BAD_SCENES = {
    "zero attitude": (andoyer.InputError, {"attitude": [0, 0, 0, 0]}),
    "NaN attitude": (andoyer.InputError, {"attitude": [NAN, 0, 0, 1]}),
    "infinite attitude": (andoyer.InputError, {"attitude": [INF, 0, 0, 1]}),
    "long attitude": (andoyer.InputError, {"attitude": [0, 0, 0, 1.1]}),
    "NaN rate": (andoyer.InputError, {"angular_velocity": [0, NAN, 1]}),
    "infinite rate": (andoyer.InputError, {"angular_velocity": [0, 0, -INF]}),
    "NaN epoch": (andoyer.InputError, {"epoch": NAN}),
    "zero tolerance": (andoyer.InputError, {"tolerance": 0}),
    "negative tolerance": (andoyer.InputError, {"tolerance": -1e-9}),
    "NaN tolerance": (andoyer.InputError, {"tolerance": NAN}),
    "infinite tolerance": (andoyer.InputError, {"tolerance": INF}),
    "unknown method": (andoyer.InputError, {"method": "magic"}),
    "negative order": (andoyer.InputError, {"order": -1}),
    "high order": (andoyer.RepresentationError, {"order": 61}),
    "huge order": (andoyer.RepresentationError, {"order": 10**30}),
    "half an order": (andoyer.InputError, {"order": 2.5}),
    "backward span": (andoyer.InputError, {"span": (1, 0)}),
    "infinite span": (andoyer.InputError, {"span": (0, INF)}),
    "span of three": (andoyer.InputError, {"span": (0, 1, 2)}),
    "attitude of three": (andoyer.InputError, {"attitude": [0, 0, 1]}),
    "matrix of attitudes": (andoyer.InputError, {"attitude": [[0, 0, 0, 1]]}),
    "ragged attitude": (andoyer.InputError, {"attitude": [[0, 0], 0, 1, 0]}),
    "scalar rate": (andoyer.InputError, {"angular_velocity": 1.0}),
    "empty rates": (andoyer.InputError, {"angular_velocity": []}),
    "text attitude": (TypeError, {"attitude": "up"}),
    "texts in attitude": (TypeError, {"attitude": ["0", "0", "0", "1"]}),
    "no attitude": (TypeError, {"attitude": None}),
    "complex rate": (TypeError, {"angular_velocity": [1j, 0, 1]}),
    "objects as rates": (TypeError, {"angular_velocity": [object(), 0, 1]}),
    "tuple for body": (TypeError, {"body": (1, 2, 2)}),
    "text tolerance": (TypeError, {"tolerance": "1e-9"}),
    "boolean tolerance": (TypeError, {"tolerance": True}),
    "no tolerance": (TypeError, {"tolerance": None}),
    "list of tolerances": (TypeError, {"tolerance": [1e-9]}),
    "text epoch": (TypeError, {"epoch": "now"}),
    "date as epoch": (TypeError, {"epoch": np.datetime64("2026-01-01")}),
    "boolean order": (TypeError, {"order": True}),
    "number as method": (TypeError, {"method": 1}),
    "number as name": (TypeError, {"name": 1}),
}


@pytest.mark.parametrize("error, arguments", BAD_SCENES.values(), ids=BAD_SCENES)
def test_bad_scene_is_refused_and_the_argument_named(body, error, arguments):
    good = {"body": body, "attitude": ATTITUDE, "angular_velocity": RATES}
    with pytest.raises(error, match=next(iter(arguments))):
        Scene(**good | arguments)


WRONG_KINDS = {
    "list for body": ({"body": [1, 2, 3]}, "body must be an andoyer.Body: got list; use Body([A, B, C])"),
    "text tolerance": ({"tolerance": "1e-9"}, "tolerance must be a real number: got '1e-9'"),
    "text epoch": ({"epoch": "now"}, "epoch must be a real number: got 'now'"),
    "boolean order": ({"order": True}, "order must be a whole number, not bool"),
}


@pytest.mark.parametrize("arguments, message", WRONG_KINDS.values(), ids=WRONG_KINDS)
def test_message_itself_names_the_argument_of_the_wrong_kind(body, arguments, message):
    with pytest.raises(TypeError) as caught:
        Scene(**{"body": body, "attitude": ATTITUDE, "angular_velocity": RATES} | arguments)
    assert str(caught.value) == message  # pytest's `match` would read PyO3's note as well


def test_scalars_that_are_numbers_are_taken(body):
    given = Scene(body, ATTITUDE, RATES, epoch=np.array(3), tolerance=Fraction(1, 1024))
    assert (given.epoch, given.tolerance) == (3.0, 2.0**-10)


def test_momentum_without_a_double_is_a_units_error():
    scene = Scene(Body([1e-200, 1.5e-200, 2e-200]), ATTITUDE, [1e-200, 0, 1e-199])
    with pytest.raises(andoyer.RepresentationError, match="momentum.*units"):
        scene.solve()


def test_shape_error_has_both_shapes(body):
    with pytest.raises(andoyer.InputError, match=r"attitude has shape \(2, 4\): it must be \(4,\)"):
        Scene(body, np.zeros((2, 4)), RATES)


def test_unknown_method_is_refused(body):
    with pytest.raises(andoyer.InputError, match='"taylor"'):
        Scene(body, ATTITUDE, RATES, method="taylor")
    assert Scene(body, ATTITUDE, RATES, method="closed").method == "closed"


def test_scene_survives_a_file(scene, tmp_path):
    path = tmp_path / "scene.toml"
    generator = np.random.default_rng(7)
    for _ in range(200):
        attitude = generator.normal(size=4)
        given = Scene(
            Body(1 + generator.random(3), name="b"),
            attitude / np.linalg.norm(attitude),
            generator.normal(size=3) * 10.0 ** generator.integers(-12, 12),
            epoch=generator.normal(),
            span=(-1 / 3, 1e9 / 7),
            name="é",
        )
        path.write_text(given.to_toml(), encoding="utf-8")
        assert Scene.from_toml(path) == given
    assert Scene.from_toml(str(path)) == Scene.from_toml(os.fspath(path)) == given


BAD_FILES = {
    "unknown key": ("colour = 1", "colour"),
    "bad tolerance": ("tolerance = 0", "tolerance"),
    "bad order": ("order = 61", "order.*60"),
    "no TOML": ("tolerance = = 1", "line 1"),
}


@pytest.mark.parametrize("line, message", BAD_FILES.values(), ids=BAD_FILES)
def test_bad_scene_file_is_named_with_key_and_bound(scene, tmp_path, line, message):
    path = tmp_path / "bad.toml"
    lines = [old for old in scene.to_toml().splitlines() if old.split(" ")[0] != line.split(" ")[0]]
    path.write_text("\n".join([line, *lines]), encoding="utf-8")
    with pytest.raises(andoyer.FileError, match=rf"bad\.toml.*{message}"):
        Scene.from_toml(path)


def test_missing_scene_file_is_a_scene_file_error(tmp_path):
    with pytest.raises(andoyer.FileError, match="absent.toml"):
        Scene.from_toml(tmp_path / "absent.toml")
    with pytest.raises(TypeError):
        Scene.from_toml(3)


def test_name_given_as_moments_points_at_the_catalogue():
    with pytest.raises(TypeError, match=r"""got "eros"; a body of the catalogue is Body\.named\("eros"\)"""):
        Body("eros")
