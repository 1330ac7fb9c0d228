"""`andoyer evolve` and `andoyer.plot.evolution`."""

import numpy as np
import pytest

import andoyer
from andoyer.cli import main

PLATES = {"normals": [[0.2, 0.1, 1], [1, 0.3, -0.2]], "areas": [2, 1], "centroids": [[1, 0.2, 0.1], [-0.3, 1, 0.2]]}


@pytest.fixture
def scene():
    light = andoyer.Torque.panels(**PLATES, specular=0.3, pressure=1e-6, source=andoyer.Orbit(1e-7, 0.1))
    return andoyer.Scene(andoyer.Body([0.5, 0.75, 1]), [0, 0, 0, 1], [0.35, 0.2, 0.9], torques=[light], span=(0, 1e5))


def test_a_table_has_the_numbers_of_the_evolution(scene, tmp_path, capsys):
    source, target = tmp_path / "scene.toml", tmp_path / "years.csv"
    source.write_text(scene.to_toml(), encoding="utf-8")
    assert main(["evolve", str(source), "-o", str(target), "--samples", "11"]) == 0
    names, *rows = target.read_text().splitlines()
    assert names == "t,Gx,Gy,Gz,spin_period,obliquity,excess"
    table = np.array([[float(value) for value in row.split(",")] for row in rows])
    states = scene.evolve().at(np.linspace(0, 1e5, 11))
    assert np.array_equal(table[:, 1:4], states.momentum)
    assert np.array_equal(table[:, 4:], np.column_stack([states.spin_period, states.obliquity, states.excess]))
    assert main(["evolve", str(source), "-o", str(target)]) == 2
    assert "--force replaces it" in capsys.readouterr().err
    assert main(["evolve", str(source), "-o", "-", "--samples", "2", "--stop", "10"]) == 0
    assert capsys.readouterr().out.count("\n") == 3


def test_bad_requests_are_one_line(scene, tmp_path, capsys):
    source = tmp_path / "scene.toml"
    source.write_text(scene.to_toml(), encoding="utf-8")
    assert main(["evolve", str(source), "-o", "years.txt"]) == 2
    assert main(["evolve", str(source), "-o", str(tmp_path / "a.csv"), "--start", "1e12"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2
    assert "the name must end in .csv" in lines[0]
    assert "span" in lines[1]


def test_pictures(scene, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from andoyer import plot

    evolution = scene.evolve()
    figure = plot.evolution(evolution, time_unit="s")
    period, obliquity, excess = figure.axes
    states = evolution.at(np.linspace(0, 1e5, 1000))
    assert np.array_equal(period.lines[0].get_ydata(), states.spin_period)
    assert np.array_equal(obliquity.lines[0].get_ydata(), np.degrees(states.obliquity))
    assert np.array_equal(excess.lines[0].get_ydata(), states.excess / (1 / 0.75 - 1))
    assert (period.get_ylabel(), excess.get_xlabel()) == ("spin period [s]", "time [s]")
    source, target = tmp_path / "scene.toml", tmp_path / "years.png"
    source.write_text(scene.to_toml(), encoding="utf-8")
    assert main(["evolve", str(source), "-o", str(target)]) == 0
    assert target.stat().st_size > 10000
    matplotlib.pyplot.close("all")
