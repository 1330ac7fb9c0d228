"""Code of one motion from Python and from the command line. What it computes, in four languages: tests/tests/motion_code.rs."""

import numpy as np
import pytest

import andoyer
from andoyer.cli import main

LANGUAGES = {"c": ".c", "rust": ".rs", "python": ".py", "javascript": ".js"}
DISTURBED = {"orbit": andoyer.Orbit(1e-3, 0.1), "tolerance": 1e-3, "span": (0.0, 1e3)}


@pytest.fixture
def scene_file(scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "wobble.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    return path


def test_function_in_python_is_the_motion_at_times_of_its_scene(motion):
    namespace = {}
    exec(motion.to_code("python"), namespace)
    times = motion.scene.epoch + np.array([0.0, 1e-3, -1e3, 1e9])
    for time in times.tolist():
        attitude, rates = namespace["rotation"](time)
        assert attitude == pytest.approx(motion.attitude(time), abs=3e-15)
        assert rates == pytest.approx(motion.angular_velocity(time), abs=3e-15)
    with pytest.raises(ValueError, match="time must be within"):
        namespace["rotation"](float("nan"))


def test_calendar_epoch_counts_in_seconds_of_tdb_since_j2000(body):
    time = pytest.importorskip("astropy.time").Time
    epoch = time("2026-01-01T00:00:00", scale="tdb")
    motion = andoyer.Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=epoch).solve()
    namespace = {}
    exec(motion.to_code("python"), namespace)
    later = time("2026-01-01T00:01:00", scale="tdb")
    seconds = (later - time("2000-01-01T12:00:00", scale="tdb")).to_value("s")
    # A minute in days, as astropy has it, is 2e-13 s short.
    assert namespace["rotation"](round(seconds))[0] == pytest.approx(motion.attitude(later), abs=2e-13)


@pytest.mark.parametrize("language", LANGUAGES)
def test_command_writes_what_the_method_returns(scene_file, tmp_path, language, capfd):
    expected = andoyer.Scene.from_toml(scene_file).solve().to_code(language)
    path = tmp_path / f"rotation{LANGUAGES[language]}"
    assert main(["code", str(scene_file), "-o", str(path)]) == 0
    assert path.read_text(encoding="ascii") == expected
    assert main(["code", str(scene_file), "-o", str(tmp_path / "rotation.txt"), "--language", language]) == 0
    assert (tmp_path / "rotation.txt").read_text(encoding="ascii") == expected
    capfd.readouterr()
    assert main(["code", str(scene_file), "--language", language]) == 0
    assert capfd.readouterr().out == expected


REFUSED = {
    "an ending that says no language": (
        ["-o", "rotation.txt"],
        "argument -o/--output: rotation.txt: the name must end in .c, .rs, .py, .js, or --language must be given",
    ),
    "an ending of another language": (
        ["-o", "rotation.c", "--language", "rust"],
        "argument --language: rust does not go with the name rotation.c, which says c",
    ),
}


@pytest.mark.parametrize("arguments, message", REFUSED.values(), ids=REFUSED)
def test_command_refuses_in_one_line(scene_file, arguments, message, capfd):
    assert main(["code", str(scene_file), *arguments]) == 2
    assert capfd.readouterr().err == f"andoyer: error: {message}\n"


@pytest.mark.parametrize(
    "rates, options, motion", [([1e-9, 1.0, 1e-9], {}, "a passage along the separatrix"), ([0.01, 0.02, 1.0], DISTURBED, "a motion under a torque")]
)
def test_motion_without_code_is_an_error_that_says_what_has(body, rates, options, motion, tmp_path, capfd):
    scene = andoyer.Scene(body, [0, 0, 0, 1], rates, **options)
    with pytest.raises(andoyer.RepresentationError, match=motion) as caught:
        scene.solve().to_code()
    assert (caught.value.argument, caught.value.value) == ("motion", motion)
    assert "torque-free wobbles" in str(caught.value) or "torque-free wobble" in str(caught.value.bound)
    path = tmp_path / "scene.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    assert main(["code", str(path), "-o", str(tmp_path / "x.c")]) == 2
    [line] = capfd.readouterr().err.splitlines()
    assert line.startswith(f"andoyer: error: {path}: ") and motion in line and not (tmp_path / "x.c").exists()


def test_language_that_there_is_not_is_an_error_of_the_argument(motion):
    with pytest.raises(andoyer.InputError, match="fortran") as caught:
        motion.to_code("fortran")
    assert (caught.value.argument, caught.value.value) == ("language", "fortran")
