"""Animated pages of motions in a headless Chromium: no console message, no request, the attitude of the library, and a moving picture."""

import numpy as np
import pytest

import andoyer
from andoyer import plot
from andoyer._quaternions import angle_between

BODY = andoyer.Body([1.0, 1.5, 2.0])
ORBIT = andoyer.Orbit(1e-3, 0.1, inclination=0.5)


def solved(rates, body=BODY, **options):
    return andoyer.Scene(body, [0.1, -0.2, 0.3, 0.9273618495495703], rates, **options).solve()


MOTIONS = {
    "short-axis": solved([0.1, 0.2, 1.0], name="</script><b>& a name"),
    "long-axis": solved([1.0, 0.1, 0.2], epoch=100.0),
    "beside the separatrix": solved([0.01, 1.0, 0.01]),
    "left-handed": solved([0.3, 1.0, 0.1], andoyer.Body([1.0, 2.0, 1.5])),
    "oblate": solved([0.1, 0.2, 1.0], andoyer.Body([1, 1, 2])),
    "gravity gradient": solved([0.01, 0.02, 1.0], orbit=ORBIT, tolerance=1e-3, span=(0.0, 1000.0)),
    "tensor": solved([0.3, 0.5, 1.0], andoyer.Body.from_inertia([[1.4, 0.2, -0.1], [0.2, 1.6, 0.15], [-0.1, 0.15, 1.2]])),
    "principal-axis": solved([0.0, 0.0, 1.0]),
    "at rest": solved([0.0, 0.0, 0.0]),
    "passage": solved([1e-9, 1.0, 1e-9]),
}
TABLES = ["gravity gradient", "passage"]
"""Motions that have no code."""


class Window:
    """A page of a motion, with its console messages and its requests."""

    def __init__(self, browser, path, scheme="light"):
        self.page = browser.new_page(viewport={"width": 1000, "height": 700}, color_scheme=scheme)
        self.said, self.fetched = [], []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.fetched.append(request.url))
        self.page.goto(path.as_uri(), wait_until="load")

    def run(self, script):
        return self.page.evaluate(script)


@pytest.fixture
def opened(browser, tmp_path):
    windows = []

    def open_page(motion, **options):
        path = tmp_path / "page.html"
        error = plot.page(motion, path, **options)
        windows.append(Window(browser, path))
        return windows[-1], path, error

    yield open_page
    for window in windows:
        window.page.close()


@pytest.mark.parametrize("name", MOTIONS)
def test_page_has_the_attitude_of_the_library(opened, name):
    motion = MOTIONS[name]
    window, path, error = opened(motion)
    start, stop = window.run("[data.start, data.stop]")
    times = start + (stop - start) * np.array([0.0, 0.3, 0.71234, 1.0])
    values = np.array([window.run(f"andoyer.evaluate({time!r})") for time in times.tolist()])
    angle = angle_between(values[:, :4], motion.attitude(times)).max()
    if name in TABLES:
        # The error was found at three times between two nodes; the largest error may be between these times.
        assert angle < 1.2 * error + 1e-14 < 1e-8
        assert values[:, 4:] == pytest.approx(motion.angular_velocity(times), abs=1e-4)
    else:
        assert angle <= error < 1e-12
        assert values[:, 4:] == pytest.approx(motion.angular_velocity(times), rel=1e-12, abs=1e-12)
    assert window.said == [] and window.fetched == [path.as_uri()]
    assert window.run("document.querySelectorAll('b, script').length") == 3  # the name of the scene must not become an element


@pytest.mark.parametrize("name", ["short-axis", "long-axis", "beside the separatrix", "left-handed", "tensor", "gravity gradient"])
def test_page_has_the_andoyer_variables_of_the_library(opened, name):
    motion = MOTIONS[name]
    window, _, _ = opened(motion)
    start, stop = window.run("[data.start, data.stop]")
    for time in (start, start + 0.37 * (stop - start)):
        lambda_, mu, nu, node, size, short = motion.andoyer(time)
        shown = window.run(f"andoyer.variables({time!r})")
        bound = 1e-5 if name in TABLES else 1e-12
        for angle, expected in (("lambda", lambda_), ("mu", mu), ("nu", nu)):
            assert abs(np.angle(np.exp(1j * (shown[angle] - expected)))) < bound
        assert [shown["Lambda"], shown["M"], shown["N"]] == pytest.approx([node, size, short], rel=bound, abs=bound)
        assert np.cos(shown["J"]) == pytest.approx(short / size, abs=bound)


def test_page_shows_body_axes_momentum_curves_controls_and_numbers(opened):
    motion = MOTIONS["short-axis"]
    window, _, _ = opened(motion)
    said = window.page.inner_text("#lines").split("\n")
    assert [line.strip() for line in said if line.strip()][-6:] == [
        *[f"body axis {k}" for k in (1, 2, 3)],
        "angular momentum M",
        "angular velocity ω; herpolhode",
        "polhode",
    ]
    assert window.run("Object.keys(cells)") == ["t", "J", "λ", "μ", "ν", "Λ/M", "N/M", "ω₁", "ω₂", "ω₃"]
    window.run("andoyer.show(data.start + 2)")
    lambda_, mu, nu, _node, size, short = motion.andoyer(2.0)
    expected = {"J": np.arccos(short / size), "λ": lambda_ % (2 * np.pi), "μ": mu % (2 * np.pi), "ν": nu % (2 * np.pi)}
    assert window.run("Object.fromEntries(['J', 'λ', 'μ', 'ν'].map(name => [name, cells[name].textContent]))") == {
        name: f"{np.degrees(angle):.4f}°" for name, angle in expected.items()
    }
    assert window.run("[body.faces.length > 100, polhode.length, herpolhode(data.start + 2).length]") == [True, 501, 121]
    assert window.run("[...speed.options].map(option => option.value)") == ["10", "30", "60", "120", "300"]
    window.page.select_option("#speed", "10")
    window.page.click("#play")
    # The policy of the page forbids what `wait_for_function` does.
    for _ in range(100):
        window.page.wait_for_timeout(100)
        if window.run("time") > 2.5:
            break
    assert window.run("[playing, time > 2.5]") == [True, True]
    window.page.fill("#time", str(motion.scene.epoch + 3))
    assert window.run("[playing, time]") == [False, 3] and window.said == []


def test_picture_moves_with_time_and_the_slider_shows_it(opened):
    window, _, _ = opened(MOTIONS["short-axis"])
    pictures = []
    for part in (0.1, 0.2, 0.1):
        window.run(f"andoyer.show(data.start + {part} * (data.stop - data.start))")
        pictures.append(window.page.screenshot(clip={"x": 0, "y": 60, "width": 700, "height": 560}))
    assert pictures[0] == pictures[2] != pictures[1]
    assert window.page.inner_text("#play") == "play"
    assert float(window.run("slider.value")) == pytest.approx(window.run("data.start + 0.1 * (data.stop - data.start)"))
    window.page.click("#play")
    window.page.wait_for_function("time > data.start + 0.1 * (data.stop - data.start)")
    assert window.said == []


def test_drag_turns_the_view_and_a_button_resets_it(opened):
    window, _, _ = opened(MOTIONS["short-axis"])
    window.run("andoyer.show(data.start)")
    before = window.page.screenshot()
    window.page.mouse.move(300, 300)
    window.page.mouse.down()
    window.page.mouse.move(420, 340, steps=3)
    window.page.mouse.up()
    assert window.page.screenshot() != before and window.run("view.yaw") != window.run("home.yaw")
    window.page.click("#view")
    assert window.run("[view.yaw, view.pitch]") == window.run("[home.yaw, home.pitch]") and window.said == []


def test_mesh_is_drawn_in_the_place_of_the_ellipsoid(opened):
    vertices = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    window, _, _ = opened(MOTIONS["short-axis"], mesh=(vertices, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]), interval=(0.0, 10.0))
    assert window.run("body.faces.length") == 4 and window.run("data.stop") == 10
    # From outside, two or three faces are visible and drawn.
    assert window.said == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [400, 1300])
def test_nothing_is_wider_than_the_window(browser, tmp_path, width, scheme):
    path = tmp_path / "page.html"
    plot.page(MOTIONS["short-axis"], path)
    window = Window(browser, path, scheme)
    window.page.set_viewport_size({"width": width, "height": 800})
    assert window.run("document.documentElement.scrollWidth") <= width
    box = window.run("(({width, height}) => [width, height])(canvas.getBoundingClientRect())")
    assert min(box) > 200 and window.said == []
    window.page.close()
