"""A headless Chromium driven by the WebDriver protocol (W3C), which is JSON over HTTP on the loopback: no package is needed for it."""

import base64
import json
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

CHROMEDRIVER = shutil.which("chromedriver")
FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--disable-dev-shm-usage", "--window-size=1280,2000",
]  # fmt: skip


class Browser:
    """One window. Close it: it is a process with a folder of its own."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.driver = subprocess.Popen([CHROMEDRIVER, f"--port={self.port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.session = ""
        options = {"args": [*FLAGS, f"--user-data-dir={self.folder.name}"]}
        wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        deadline = time.monotonic() + 60
        while not self.session:
            try:
                self.session = "/session/" + self._post("/session", {"capabilities": {"alwaysMatch": wanted}})["sessionId"]
            except urllib.error.URLError as error:
                if isinstance(error, urllib.error.HTTPError) or time.monotonic() > deadline:
                    self.close()
                    raise
                time.sleep(0.1)

    def _post(self, path, body, method="POST"):
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", json.dumps(body).encode(), method=method)
        with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def open(self, url):
        """Load a page; what the console said of it."""
        self._post(self.session + "/url", {"url": url})
        return self.said()

    def said(self):
        """What the console said since it was last asked."""
        return self._post(self.session + "/se/log", {"type": "browser"})

    def run(self, script):
        """What the body of a function in JavaScript returns."""
        return self._post(self.session + "/execute/sync", {"script": script, "args": []})

    def picture(self, path):
        """The window as PNG."""
        request = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        with request.open(f"http://127.0.0.1:{self.port}{self.session}/screenshot", timeout=60) as answer:
            Path(path).write_bytes(base64.b64decode(json.load(answer)["value"]))

    def close(self):
        """End the browser, then its driver."""
        if self.session:
            self._post(self.session, {}, "DELETE")
        self.driver.terminate()
        self.driver.wait(timeout=30)
        self.folder.cleanup()
