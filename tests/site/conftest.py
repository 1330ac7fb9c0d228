"""The built site, a server for it on the loopback interface, and a headless Chromium, controlled by Playwright."""

import functools
import http.server
import os
import shutil
import threading
from pathlib import Path

import pytest

SITE = Path(__file__).resolve().parents[2] / "target" / "site"
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
# Without these options Chromium asks for updates, and a machine without a network reports errors.
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking", "--disable-component-update", "--disable-sync"]


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture(scope="session")
def address():
    """The address of the site on this machine."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SITE))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@pytest.fixture(scope="session")
def browser():
    """The browser of this machine. If CI is set, a missing browser is a failure."""
    if CHROMIUM is None and not os.environ.get("CI"):
        pytest.skip("no Chromium on this machine: the pages are not opened")
    assert CHROMIUM is not None, "CI needs Chromium: apt-get install chromium"
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


class Visit:
    """One page of the site in a window of a given width, with its console messages and its requests."""

    def __init__(self, page, address):
        self.page, self.address = page, address
        self.said, self.fetched = [], []
        page.on("console", lambda message: self.said.append((message.type, message.text)))
        page.on("pageerror", lambda error: self.said.append(("error", str(error))))
        page.on("requestfinished", lambda request: self.fetched.append(request.url))
        page.on("requestfailed", self.failed)

    def failed(self, request):
        """Note a request that failed. One that the browser gave up because the page was left (a favicon, say) is no fault of the next page."""
        if request.failure != "net::ERR_ABORTED":
            self.said.append(("error", f"failed: {request.url}: {request.failure}"))

    def open(self, path):
        """Load a page of the site, with all its pictures."""
        self.said.clear(), self.fetched.clear()
        self.page.goto(self.address + path, wait_until="load")
        self.page.evaluate("for (const image of document.images) image.loading = 'eager'")
        self.page.evaluate("Promise.all([...document.images].map(image => image.decode().catch(() => null))).then(() => true)")

    def run(self, script):
        """The value of an expression in JavaScript."""
        return self.page.evaluate(script)


@pytest.fixture(scope="session")
def visits(browser, address):
    """A window for each requested width, opened once."""
    windows = {}

    def at(width):
        if width not in windows:
            windows[width] = Visit(browser.new_page(viewport={"width": width, "height": 1000}), address)
        return windows[width]

    return at
