"""A large error of an averaged motion is said: by `evolve` where the shape's polynomials alone make it, by the plan in any case, and by the command in one line."""

import warnings

import numpy as np
import pytest
from polhodes import MOMENTS, SOURCE, separatrix, state

from andoyer import Body, Scene, ToleranceWarning, Torque
from andoyer.cli import main

CORNERS = np.array([[1.2, 1, 1], [1, -1.1, -1], [-1, 1, -1.3], [-1, -0.8, 1.5]])
SIDES = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]


def lit(degree, source=SOURCE, **options):
    """A tumbler with the light on a tetrahedron, of which polynomials of a low degree leave out much."""
    light = Torque.from_facets(CORNERS - CORNERS.mean(axis=0), SIDES, pressure=1e-4, source=source, degree=degree)
    start = state(2, 1, 0.1 * separatrix(2), np.array([0.3, -0.4, 0.85]))
    return Scene(Body(MOMENTS), *start, torques=[light], **options), light


def length(evolution):
    """The way of the angular momentum over its size at the epoch."""
    momentum = evolution.at(np.linspace(*evolution.reached, 4001)).momentum
    return np.linalg.norm(np.diff(momentum, axis=0), axis=1).sum() / np.linalg.norm(momentum[0])


def test_a_truncation_that_moves_the_momentum_by_a_tenth_is_said_by_evolve():
    scene, light = lit(2)
    rate = np.linalg.norm(scene.drift().momentum) / np.linalg.norm([0.3, -0.4, 0.85])
    span = 0.1 / light.truncation / rate
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        short = scene.evolve((0, 0.3 * span))
    assert light.truncation * length(short) < 0.1
    with pytest.warns(ToleranceWarning, match="of its size at the epoch, above 0.1; the polynomials of its shapes leave out") as caught:
        long = scene.evolve((0, 4 * span))
    assert light.truncation * length(long) > 0.1
    [warning] = caught
    assert warning.filename == __file__
    error = float(str(warning.message).split("may reach ")[1].split(" of")[0])
    assert error == pytest.approx(light.truncation * length(long), rel=0.3)  # chords of the steps


def test_the_plan_says_so_of_its_whole_bound():
    # A polynomial leaves nothing out: what is large is of second order.
    torque = Torque.polynomial(["2e-2*s1*s2 + 1e-2*s3", "-1e-2*s1^2", "1.5e-2*s2"], sources={"s": SOURCE})
    start = state(2, 1, 0.1 * separatrix(2), np.array([0.3, -0.4, 0.85]))
    scene = Scene(Body(MOMENTS), *start, torques=[torque])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        evolution = scene.evolve((0, 500))
        assert scene.evolve((0, 0.1)).plan.large_error is None
    with pytest.warns(ToleranceWarning, match="above 0.1$") as caught:
        plan = evolution.plan
    assert plan.error_bound > 0.1
    assert plan.large_error == str(caught[0].message)


def test_the_command_says_so_in_one_line(tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(lit(2, span=(0, 1e5))[0].to_toml(), encoding="utf-8")
    assert main(["evolve", str(path), "-o", str(tmp_path / "years.csv"), "--samples", "3"]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if "warning" in line]
    assert len(lines) == 1
    assert lines[0].startswith("andoyer: warning: the error of the angular momentum may reach ")
