"""The page that turns without a browser: what is in it, what is refused, and its evaluator run by node; and the film."""

import json
import os
import re
import shutil
import subprocess

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer._quaternions import angle_between, product, rotate
from andoyer.cli import main
from andoyer.output.page import MOST_NODES, NODES, evaluator, page

BODY = andoyer.Body([1.0, 1.5, 2.0])
DISTURBED = {"orbit": andoyer.Orbit(1e-3, 0.1, inclination=0.5), "tolerance": 1e-3, "span": (0.0, 1000.0)}
NODE = shutil.which("node")
assert NODE or not os.environ.get("CI"), "CI needs node: apt-get install nodejs"
needs_node = pytest.mark.skipif(NODE is None, reason="no node on this machine")


def solved(rates, body=BODY, **options):
    return andoyer.Scene(body, [0.1, -0.2, 0.3, 0.9273618495495703], rates, **options).solve()


def evaluated(source, times, folder):
    """The rows of the evaluator, by node."""
    program = folder / "evaluator.js"
    program.write_text(f'"use strict";\n{source}\nconsole.log(JSON.stringify({json.dumps(times.tolist())}.map(evaluate)))', encoding="utf-8")
    done = subprocess.run(["node", program], capture_output=True, text=True, check=True)
    return np.array(json.loads(done.stdout))


@needs_node
@pytest.mark.parametrize("rates", [[0.1, 0.2, 1.0], [1.0, 0.1, 0.2], [0.0, 0.0, 0.0]])
def test_evaluator_is_the_code_of_the_motion_within_its_error(rates, tmp_path):
    motion = solved(rates)
    source, error = evaluator(motion, -5.0, 60.0)
    assert motion.to_code("javascript") in source
    times = np.random.default_rng(1).uniform(-5, 60, 1000)
    values = evaluated(source, times, tmp_path)
    assert angle_between(values[:, :4], motion.attitude(times)).max() <= error < 1e-13
    assert values[:, 4:] == pytest.approx(motion.angular_velocity(times), rel=1e-13, abs=1e-13)


@needs_node
@pytest.mark.parametrize("rates, options", [([0.01, 0.02, 1.0], DISTURBED), ([1e-9, 1.0, 1e-9], {})])
def test_motion_without_code_is_a_table_within_its_error(rates, options, tmp_path):
    motion = solved(rates, **options)
    source, error = evaluator(motion, 0.0, 60.0)
    assert source.startswith("const TABLE")
    times = np.random.default_rng(1).uniform(0, 60, 1000)
    values = evaluated(source, times, tmp_path)
    # The error was found at three places between each two nodes; the largest may lie beside them.
    assert angle_between(values[:, :4], motion.attitude(times)).max() <= 1.2 * error + 1e-14 < 1e-8
    assert values[:, 4:] == pytest.approx(motion.angular_velocity(times), abs=1e-4)


def test_error_of_a_table_is_of_fourth_order_in_its_step(monkeypatch):
    motion = solved([0.3, 0.4, 1.0], **DISTURBED)
    _, fine = evaluator(motion, 0.0, 60.0)
    monkeypatch.setattr(andoyer.output.page, "NODES", NODES // 2)
    _, coarse = evaluator(motion, 0.0, 60.0)
    assert coarse / fine == pytest.approx(16, rel=0.05)


def test_page_fetches_nothing_and_no_name_ends_its_elements(tmp_path):
    path = tmp_path / "page.html"
    page(solved([0.1, 0.2, 1.0], name="</script><script>alert(1)</script>"), path)
    text = path.read_text(encoding="utf-8")
    assert text.count("<script") == text.count("</script>") == 3
    assert "default-src 'none'" in text and not re.search(r"(src|href)=.(?!data:)", text) and "@" not in re.sub(r"@media", "", text.split("<body>")[0])
    data = json.loads(re.search(r'application/json">(.*?)</script>', text)[1])
    assert data["moments"] == [1.0, 1.5, 2.0] and data["rotations"] <= 60.001


def test_default_is_three_periods_of_the_polhode_and_sixty_rotations_at_most(tmp_path):
    for rates, body in (([0.1, 0.2, 1.0], BODY), ([1e-5, 0, 1.0], andoyer.Body([1, 1.001, 1.003]))):
        motion = solved(rates, body)
        page(motion, tmp_path / "page.html")
        data = json.loads(re.search(r'application/json">(.*?)</script>', (tmp_path / "page.html").read_text(encoding="utf-8"))[1])
        expected = min(3 * motion.periods["long-axis"].rotation, 60 * 2 * np.pi / np.linalg.norm(rates))
        assert data["stop"] - data["start"] == pytest.approx(expected, rel=1e-6)


def test_interval_of_code_has_no_bound_and_that_of_a_table_has(tmp_path):
    assert page(solved([0.1, 0.2, 1.0]), tmp_path / "page.html", interval=(0.0, 1e6)) < 1e-13
    assert (tmp_path / "page.html").stat().st_size < 50_000
    with pytest.raises(ValueError, match=rf"interval must have at most {MOST_NODES // NODES} rotations: got 1.59"):
        page(solved([0.01, 0.02, 1.0], **DISTURBED), tmp_path / "other.html", interval=(0.0, 1e6))
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]


REFUSED = {
    "no length": ({"interval": (1.0, 1.0)}, "interval must be two finite times"),
    "not finite": ({"interval": (0.0, float("inf"))}, "interval must be two finite times"),
    "flat vertices": ({"mesh": ([[0, 0]], [[0, 0, 0]])}, r"finite vertices of shape \(n, 3\): got \(1, 2\)"),
    "vertex that is not there": ({"mesh": ([[0, 0, 0]], [[0, 0, 1]])}, "whole numbers from 0 to 0"),
    "faces of floats": ({"mesh": ([[0, 0, 0]], [[0.0, 0.0, 0.0]])}, "whole numbers from 0 to 0"),
}


@pytest.mark.parametrize("options, message", REFUSED.values(), ids=REFUSED)
def test_page_that_cannot_be_is_refused_and_not_written(options, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        page(solved([0.1, 0.2, 1.0]), tmp_path / "page.html", **options)
    assert list(tmp_path.iterdir()) == []


def test_command_writes_the_page_and_keeps_the_one_that_is_there(tmp_path, capfd):
    path = tmp_path / "eros.html"
    line = ["plot", str(REPOSITORY / "examples/scenes/eros.toml"), "-o", str(path)]
    assert main(line) == 0 and path.stat().st_size > 10_000
    assert main(line) == 2 and "File exists; --force replaces it" in capfd.readouterr().err
    assert main([*line, "--force"]) == 0
    (tmp_path / "x.aem").write_text("")
    assert main(["plot", str(tmp_path / "x.aem"), "-o", str(tmp_path / "y.html")]) == 2
    assert "a page is of a scene, not of a file of attitudes" in capfd.readouterr().err


def test_film_shows_the_axes_of_the_body_with_the_momentum_upwards():
    pytest.importorskip("matplotlib").use("Agg")
    from andoyer import plot

    motion = solved([0.1, 0.2, 1.0])
    times = np.linspace(0, 5, 7)
    film = plot.animate(motion, times)
    axes = film._fig.axes[0]
    film._func(3)
    momentum = motion.angular_momentum(times[3])
    for number, line in enumerate(axes.lines[1:4]):
        tip = np.array(line.get_data_3d())[:, 1]
        expected = rotate(motion.attitude(times[3]), np.eye(3)[number]) @ momentum / np.linalg.norm(momentum)
        assert np.linalg.norm(tip) == pytest.approx(1) and tip[2] == pytest.approx(expected, abs=1e-12)
    assert axes.texts[0].get_text() == "t = 2.5"
    film._draw_was_started = True


def test_page_of_a_satellite_has_its_orbital_frame(tmp_path):
    given = {"elements_of": "rotating", "frame": "lvlh"}
    orbit = andoyer.Orbit(1e-3, 0.1, inclination=0.5)
    motion = andoyer.Scene.from_orbital(BODY, [0.3, 0.2, 0.1], [0, 0, 0], orbit=orbit, **given, span=(0, 20000), tolerance=1e-8, method="integrated").solve()
    page(motion, tmp_path / "satellite.html", elements_of="rotating")
    text = (tmp_path / "satellite.html").read_text(encoding="utf-8")
    data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)[1])
    assert (data["start"], data["stop"]) == (0, 20000)
    frames = np.array(data["orbit"]["frames"])
    # Between nodes as the page has it: the attitude of the frame, turned onto that of the body.
    times = np.random.default_rng(1).uniform(0, 20000, 200)
    places = times / 20000 * (len(frames) - 1)
    lower = np.minimum(places.astype(int), len(frames) - 2)
    mixed = frames[lower] + (places - lower)[:, None] * (frames[lower + 1] - frames[lower])
    mixed /= np.linalg.norm(mixed, axis=1, keepdims=True)
    assert angle_between(product(mixed, motion.orbital(times, **given).attitude), motion.attitude(times)).max() < 1e-4
    page(motion, tmp_path / "plain.html")
    assert '"frames":' not in (tmp_path / "plain.html").read_text(encoding="utf-8")
    with pytest.raises(andoyer.InputError, match="elements_of"):
        page(motion, tmp_path / "bad.html", elements_of="satellite")
    assert not (tmp_path / "bad.html").exists()
