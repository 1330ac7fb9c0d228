"""The playground in a headless Chromium: presets, flips at the time of the elliptic integral, attitudes of the installed library, address, code, keys, sizes. `make playground` builds it."""

import functools
import gzip
import http.server
import math
import subprocess
import sys
import threading
from fractions import Fraction

import numpy as np
import pytest
from conftest import SITE, Quiet

import andoyer
from andoyer._quaternions import angle_between

FOLDER = SITE.parent / "playground" / "playground"
pytestmark = pytest.mark.skipif(not (FOLDER / "andoyer_playground_bg.wasm").exists(), reason="make playground builds it")

MOST_BYTES = 1_200_000
"""Of all files of the page, gzipped."""

ULP = 2.0**-52
PRESETS = ["flip", "apophis", "boom", "moon"]
FREE = {"flip": 4, "apophis": 4}
"""The largest difference between components of the attitude here and there, in units of 2^-52; motions under a torque are held to their error bounds."""


@pytest.fixture(scope="module")
def root():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=FOLDER.parent))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@pytest.fixture
def opened(browser, root):
    """Opens the playground; at the end it must have said nothing and fetched nothing from elsewhere."""
    windows = []

    def visit(address="", width=1300, height=1000):
        context = browser.new_context(viewport={"width": width, "height": height})
        page = context.new_page()
        said, fetched = [], []
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: fetched.append(request.url))
        page.goto(f"{root}playground/index.html{address}", wait_until="load")
        page.evaluate("playground.ready.then(() => true)")
        windows.append((context, said, fetched))
        return page

    yield visit
    for context, said, fetched in windows:
        assert said == []
        assert [url for url in fetched if not url.startswith((root, "about:", "data:"))] == []
        context.close()


def native(page, folder):
    """The motion of the scene of the page, by the installed library."""
    path = folder / "scene.toml"
    path.write_text(page.evaluate("playground.scene()"), encoding="utf-8")
    return andoyer.Scene.from_toml(path).solve()


def press(page, preset):
    page.click(f"[data-preset={preset}]")
    assert page.get_attribute(f"[data-preset={preset}]", "aria-pressed") == "true"
    assert page.is_hidden("#problem")


def test_page_is_small():
    sizes = {path.name: len(gzip.compress(path.read_bytes(), 9)) for path in FOLDER.iterdir()}
    print(f"\ngzipped: {sum(sizes.values()):,} bytes, of which WebAssembly {sizes['andoyer_playground_bg.wasm']:,}")
    assert sum(sizes.values()) < MOST_BYTES


def first_flip(moments, rates):
    """When ω₂ vanishes for the first time, if ω₁ is 0 at first: K(k)/p, with the arithmetic-geometric mean. Nothing is rounded before 1 − k²."""
    a, b, c = map(Fraction, moments)
    momenta = [Fraction(moment) * Fraction(rate) for moment, rate in zip(moments, rates, strict=True)]
    energy = sum(momentum * Fraction(rate) for momentum, rate in zip(momenta, rates, strict=True))
    square = sum(momentum**2 for momentum in momenta)
    speed = math.sqrt((c - b) * (square - energy * a) / (a * b * c))
    x, y = 1.0, math.sqrt(1 - (b - a) * (energy * c - square) / ((c - b) * (square - energy * a)))
    for _ in range(8):
        x, y = (x + y) / 2, math.sqrt(x * y)
    return math.pi / (2 * x) / speed


def test_body_flips_when_the_elliptic_integral_says(opened, tmp_path):
    page = opened()
    press(page, "flip")
    found = page.evaluate(
        """() => { let [low, high] = [0, 10]; for (let k = 0; k < 60; k++) { const middle = (low + high) / 2; if (playground.evaluate(middle)[5] > 0) low = middle; else high = middle; }
        return low; }"""
    )
    rotation = native(page, tmp_path).periods["long-axis"].rotation
    expected = first_flip([0.5, 0.75, 1.0], [0.0, 5.0, 0.005])
    print(f"\nfirst flip: page {found!r}, elliptic integral {expected!r}, a quarter of P_psi {rotation / 4!r}")
    assert found == pytest.approx(rotation / 4, rel=1e-13)
    assert found == pytest.approx(expected, rel=1e-13)
    signs = page.evaluate(f"[0, 1, 2, 3, 4].map(flips => Math.sign(playground.evaluate(flips * {rotation / 2})[5]))")
    assert signs == [1, -1, 1, -1, 1]


@pytest.mark.parametrize("preset", PRESETS)
def test_preset_has_the_attitudes_of_the_library(opened, tmp_path, preset):
    page = opened()
    press(page, preset)
    motion = native(page, tmp_path)
    start, stop = page.evaluate("[playground.data().start, playground.data().stop]")
    times = np.linspace(start, stop, 1000)
    here = np.array(page.evaluate("times => [...playground.solved().attitudes(Float64Array.from(times))]", times.tolist())).reshape(-1, 4)
    there = motion.attitude(times)
    ulps = np.abs(here - there).max() / ULP
    angle = angle_between(here, there).max()
    print(
        f"\n{preset}: {motion.plan.method}, {(here == there).all(axis=1).mean():.1%} of 1,000 attitudes to the bit, at most {ulps:.0f} ulp, {angle:.1e} rad, bound {motion.plan.error_bound:.1e} rad"
    )
    assert page.evaluate("[playground.solved().mode(), playground.solved().method()]") == [motion.plan.mode, motion.plan.method]
    assert page.evaluate("playground.solved().error_bound()") == pytest.approx(motion.plan.error_bound, rel=0.5)
    assert ulps <= FREE[preset] if preset in FREE else angle <= 2 * motion.plan.error_bound
    assert page.evaluate("[...document.querySelectorAll('#plan tr')].slice(0, 2).map(row => row.textContent)") == [
        f"mode{motion.plan.mode}",
        f"method{motion.plan.method}",
    ]


def test_whole_catalogue_is_shown(opened):
    page = opened()
    names = page.evaluate("[...document.getElementById('catalogue').options].map(option => option.value).slice(1)")
    assert names == andoyer.Body.catalogue()
    for name in names:
        page.select_option("#catalogue", name)
        assert page.is_hidden("#problem")
        assert page.inner_text("#note").startswith(name)


def test_address_holds_the_scene(opened):
    page = opened()
    press(page, "moon")
    page.evaluate("playground.change('rates', 0, 0.001)")
    page.wait_for_timeout(600)
    scene = page.evaluate("playground.scene()")
    again = opened(page.evaluate("location.hash"))
    assert again.evaluate("playground.scene()") == scene
    assert again.evaluate("playground.data().unit") == "d"


def test_refused_scene_says_why_and_leaves_the_last_motion(opened):
    page = opened()
    page.click("summary")
    page.fill("#text", "[body]\nmoments = [1.0, 2.0, 3.5]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]")
    assert "the largest must not exceed" in page.inner_text("#problem")
    assert page.evaluate("playground.solved().mode()") == "short-axis"
    press(page, "apophis")
    cut = opened("#%5Bbody%5D%0Amoments%20%3D%20%5B1.0%5D%")
    assert cut.is_visible("#problem") and cut.evaluate("playground.solved().mode()") == "short-axis"


@pytest.mark.parametrize("preset", PRESETS)
def test_copied_python_runs_and_prints_the_attitudes_of_the_page(opened, tmp_path, preset):
    page = opened()
    press(page, preset)
    ran = subprocess.run([sys.executable, "-c", page.evaluate("playground.code('python')")], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stderr
    last = [float(part) for part in ran.stdout.strip().rsplit("[", 1)[1].strip("]").split()]
    assert last == pytest.approx(page.evaluate("playground.evaluate(playground.data().stop).slice(0, 4)"), abs=1e-7)


def test_keys_alone_choose_a_scene_turn_a_slider_and_copy(opened):
    page = opened()
    page.focus("[data-preset=boom]")
    page.keyboard.press("Enter")
    assert page.evaluate("playground.scene()").startswith('name = "Boom satellite"')
    page.focus("#rates-1")
    before = page.evaluate("playground.solved().state()[5]")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("playground.solved().state()[5]") != before
    page.focus("[data-code=rust]")
    page.keyboard.press("Enter")
    assert "Scene::parse_toml" in page.inner_text("#code")


@pytest.mark.parametrize("width", [400, 1300])
def test_page_is_as_wide_as_its_window(opened, width):
    page = opened(width=width)
    page.wait_for_timeout(500)
    assert page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth") == 0
    assert page.evaluate("document.getElementById('view').contentDocument.documentElement.scrollWidth - document.getElementById('view').clientWidth") == 0


def test_frames_a_second_while_a_slider_moves(opened):
    page = opened()
    page.wait_for_timeout(1000)
    frames, cost = page.evaluate(
        """() => new Promise(done => { let count = 0; const start = performance.now();
        const step = () => { playground.change('rates', 2, 0.005 + 0.01 * count); if (++count < 60) requestAnimationFrame(step); else done([1000 * count / (performance.now() - start), 1e6 * playground.measure()]); };
        requestAnimationFrame(step); })"""
    )
    print(f"\n10,000 samples solved, computed and drawn anew in each frame: {frames:.0f} frames a second, {cost:.0f} ns a sample")
    assert page.evaluate("playground.solved().state()[6]") == pytest.approx(0.595)
