"""Input that is no error but surely a mistake, and output where letters are few."""

import os
import subprocess
import sys
import warnings

import pytest

import andoyer
from andoyer import Body, Ensemble, Orbit, Scene
from andoyer.cli import main


@pytest.mark.parametrize("element", ["inclination", "node", "argument_of_pericentre"])
def test_angle_beyond_a_turn_warns_and_is_taken(element):
    with pytest.warns(UserWarning, match=rf"orbit\.{element} = 23\.4 is more than a whole turn: angles are in radians"):
        orbit = Orbit(1e-3, 0.1, **{element: 23.4})
    assert getattr(orbit, element) == 23.4


def test_angles_within_a_turn_do_not_warn():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Orbit(1e-3, 0.1, inclination=3.1, node=-6.28, argument_of_pericentre=6.28)


def test_phase_beyond_a_turn_warns_and_is_taken():
    body = Body([0.61, 0.965, 1.0])
    with pytest.warns(UserWarning, match=r"phases\[1\] = 152\.0 is more than a whole turn: phases are in turns") as caught:
        scene = Scene.from_periods(body, 27.38, 263.0, phases=[14, 152])
    assert len(caught) == 2 and scene.solve().plan.mode == "short-axis"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Scene.from_periods(body, 27.38, 263.0, phases=[-1.0, 1.0])


@pytest.mark.parametrize(
    ("argument", "value", "unit"),
    [
        ("directions", (246.8, -1.0), "radians"),
        ("directions", [(246.8, -1.0)] * 2 + [(4.3, -1.0)], "radians"),
        ("phases", (14, 152), "turns"),
        ("phases", [(133.0, 0.1)] * 3, "turns"),
    ],
)
def test_clones_whose_angles_are_mostly_beyond_a_turn_are_doubted(argument, value, unit):
    given = {"directions": (4.3, -1.0), "phases": (0.1, 0.2)}
    with pytest.warns(UserWarning, match=rf"^{argument}: most are more than a whole turn: (angles|phases) are in {unit}"):
        Ensemble.from_periods(Body([0.729, 0.947, 1.0]), [27.4] * 3, 265.0, "short-axis", **given | {argument: value})
    # Draws about an angle within a turn may be beyond it.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn = {"directions": [(6.2, -1.0), (6.3, -1.0), (6.1, -1.0)], "phases": [(0.9, 0.1), (1.05, 0.1), (0.8, 0.1)]}
        Ensemble.from_periods(Body([0.729, 0.947, 1.0]), [27.4] * 3, 265.0, "short-axis", **drawn)


ABOUT = {"orbit": Orbit(1e-3), "elements_of": "rotating"}


@pytest.mark.parametrize(
    ("name", "make"),
    [
        (r"attitude\[0\]", lambda: Scene.from_orbital(Body([1.5, 2, 1]), [10, -3, 5], [0, 0, 0], **ABOUT)),
        (r"attitudes\[1\]\[0\]", lambda: Ensemble.from_orbital(Body([1.5, 2, 1]), [[1, -3, 5], [10, -3, 5]], [0, 0, 0], **ABOUT)),
        (r"andoyer\[1\]", lambda: Scene.from_andoyer(Body([1, 1.5, 2]), [0.1, 10, 0.3, 0.5, 1.0, 0.9])),
        (r"phases\[0\]", lambda: Scene.locked(Body([1, 1.02, 1.05]), Orbit(1e-3), amplitudes=(0.01, 0, 0), phases=(10, 0, 0))),
    ],
)
def test_angles_of_a_state_beyond_a_turn_warn_once_and_are_taken(name, make):
    with pytest.warns(UserWarning, match=rf"^{name} = 10\.0 is more than a whole turn: angles are in radians") as caught:
        make()
    assert len(caught) == 1


def test_scene_file_in_degrees_warns_from_python_and_from_the_shell(tmp_path, capsys):
    path = tmp_path / "degrees.toml"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        orbit = Orbit(1e-3, 0.1, inclination=10.0)
    path.write_text(Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0, 1], orbit=orbit, span=(0, 100)).to_toml(), encoding="utf-8")
    with pytest.warns(UserWarning, match="orbit.inclination = 10.0"):
        Scene.from_toml(path)
    assert main(["plan", str(path)]) == 0
    said = capsys.readouterr().err.splitlines()
    assert [line for line in said if "orbit.inclination" in line] == [
        f"andoyer: warning: {path}: orbit.inclination = 10.0 is more than a whole turn: angles are in radians, not in degrees"
    ]


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_plan_is_printed_on_a_terminal_of_few_letters(encoding):
    code = """
import andoyer
for rates in [[0.1, 0.2, 1.0], [0.0, 1.0, 1e-3], [0.0, 1.0, 0.0]]:
    print(andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], rates).solve().plan)
"""
    environment = os.environ | {"PYTHONIOENCODING": f"{encoding}:strict"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, env=environment)
    assert done.returncode == 0, done.stderr.decode()
    assert done.stdout.decode("ascii").count("mode          ") == 3


def test_ensemble_is_iterated_member_by_member():
    ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [[0.1, 0.2, 1], [1, 0.2, 0.1]])
    assert [motion.plan.mode for motion in ensemble] == ["short-axis", "long-axis"]
    members = iter(ensemble)
    assert iter(members) is members and next(members).scene == ensemble[0].scene
    assert [motion.scene == ensemble[1].scene for motion in members] == [True]


def test_negative_actions_are_refused():
    form = andoyer.normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")])
    with pytest.raises(andoyer.InputError, match="actions = -1"):
        form.frequency_map([-1.0])
    assert form.frequency_map([0.0]).tolist() == [1.0]


def test_decimals_without_a_digit_before_the_point_are_read():
    assert andoyer.normalize(".5*q**2 + .5*p^2 + .1*q^3", 2, [("q", "p")]) == andoyer.normalize("0.5*q**2 + 0.5*p^2 + 0.1*q^3", 2, [("q", "p")])


@pytest.mark.parametrize("write", [andoyer.output.write_csv, andoyer.output.write_npz, andoyer.output.write_aem])
def test_writer_of_samples_says_what_it_needs(write, tmp_path):
    """A motion was an AttributeError."""
    motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    with pytest.raises(TypeError, match=r"samples must be Samples, such as motion.at\(times\): got <Motion"):
        write(tmp_path / "a.csv", motion)
    andoyer.output.write_csv(tmp_path / "a.csv", motion.at([0.0, 1.0]))
    write(tmp_path / "b.aem", andoyer.output.read_table(tmp_path / "a.csv"))
