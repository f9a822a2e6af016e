# SPDX-License-Identifier: MIT
"""A headless Chromium that opens pages and tells what happened in them.

It is spoken to through --remote-debugging-pipe: JSON messages, each ended by a
zero byte, on descriptors 3 (to the browser) and 4 (from it).
"""

import base64
import contextlib
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

from program import PATIENCE

CHROMIUM = shutil.which("chromium")


class Browser:
    """One tab. `events` collects what the browser reported."""

    def __init__(self, to_browser, from_browser):
        self.to_browser, self.from_browser = to_browser, from_browser
        self.rest = b""
        self.count = 0
        self.events = []
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target,
                                 flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.call(f"{domain}.enable")

    def receive(self, deadline):
        while b"\0" not in self.rest:
            if not select.select([self.from_browser], [], [],
                                 max(0, deadline - time.monotonic()))[0]:
                raise TimeoutError("the browser does not answer")
            part = os.read(self.from_browser, 1 << 16)
            if not part:
                raise EOFError("the browser ended")
            self.rest += part
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        """The answer to a command of the DevTools protocol."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to_browser, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def open(self, path, width, dark=False):
        """Opens a file in a window of that width and waits until it is there."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900,
                  deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.events.clear()
        self.call("Page.navigate", url=path.resolve().as_uri())
        deadline = time.monotonic() + PATIENCE
        while not self.seen("Page.loadEventFired"):
            self.events.append(self.receive(deadline))
        # Two frames later every canvas has its size.
        self.value("new Promise(done => requestAnimationFrame("
                   "() => requestAnimationFrame(() => done(1))))")

    def seen(self, method):
        return [event["params"] for event in self.events
                if event["method"] == method]

    def value(self, expression):
        """The value of a JavaScript expression in the page."""
        answer = self.call("Runtime.evaluate", expression=expression,
                           awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def complaints(self):
        """Errors and warnings of the page."""
        logged = [entry["entry"]["text"] for entry in self.seen("Log.entryAdded")]
        printed = [str(call["args"]) for call in
                   self.seen("Runtime.consoleAPICalled")]
        thrown = [each["exceptionDetails"]["text"] for each in
                  self.seen("Runtime.exceptionThrown")]
        return logged + printed + thrown

    def requests(self):
        """Addresses that were asked for, but data that the page itself holds."""
        urls = [each["request"]["url"] for each in
                self.seen("Network.requestWillBeSent")]
        return [url for url in urls if not url.startswith("data:")]

    def screenshot(self, file, top=0, height=None):
        """A PNG of the page, or of a part of it."""
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        picture = self.call("Page.captureScreenshot", captureBeyondViewport=True,
                            clip={"x": 0, "y": top, "width": size["width"],
                                  "height": height or size["height"] - top,
                                  "scale": 1})
        file.write_bytes(base64.b64decode(picture["data"]))

    def pdf(self, file):
        """The page as it is printed."""
        printed = self.call("Page.printToPDF", printBackground=False,
                            preferCSSPageSize=True)
        file.write_bytes(base64.b64decode(printed["data"]))


@contextlib.contextmanager
def browser():
    """A browser that ends with the block."""
    to_read, to_write = os.pipe()
    from_read, from_write = os.pipe()
    with tempfile.TemporaryDirectory(prefix="chromium ") as home:
        def place_pipes():
            # Away from 3 and 4 first, one of which may be what is moved.
            high = [os.dup2(end, 60 + k) for k, end in
                    enumerate([to_read, from_write])]
            for k, end in enumerate(high):
                os.dup2(end, 3 + k, inheritable=True)
        process = subprocess.Popen(
            [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu",
             "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--disable-component-update",
             f"--user-data-dir={home}", "--remote-debugging-pipe"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, close_fds=False,
            preexec_fn=place_pipes, env={**os.environ, "HOME": home})
        os.close(to_read)
        os.close(from_write)
        try:
            yield Browser(to_write, from_read)
        finally:
            process.kill()
            process.wait()
            os.close(to_write)
            os.close(from_read)
