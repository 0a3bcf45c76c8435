# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the test and the measurements of the pages of `tactograph live`: Debian's Chromium without a screen and a
processor for graphics, by mouse and by keyboard."""
import base64
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from live_client import WebSocket

WAIT_S = 120  # until a test fails, not a time that is judged


class Browser:
    """Chromium, by the DevTools protocol."""

    def __init__(self, port, address):
        self.port, self.socket, self.number, self.console = port, WebSocket(port, address), 0, []
        for domain in ("Page", "Runtime", "Log", "Accessibility"):
            self.ask(domain + ".enable")

    def open(self, address):
        """A further page, in a window of its own: it is not behind this one."""
        target = self.ask("Target.createTarget", url=address, newWindow=True)["targetId"]
        return Browser(self.port, f"/devtools/page/{target}")

    def ask(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = self.socket.receive()
            if message.get("method") in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded", "Page.javascriptDialogOpening"):
                self.console.append(message["params"])
            if message.get("id") == self.number:
                assert "error" not in message, (method, message)
                return message["result"]

    def value(self, expression):
        result = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, (expression, result)
        return result["result"].get("value")

    def wait(self, expression):
        until = time.monotonic() + WAIT_S
        while not self.value(expression):
            assert time.monotonic() < until, (expression, self.value("document.body.innerText"), self.console)
            time.sleep(0.05)

    def text(self, name):
        return self.value(f"document.getElementById({json.dumps(name)}).textContent")

    def mouse(self, kind, x, y):
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=0 if kind == "mouseReleased" else 1, clickCount=1)

    def click(self, name):
        box = self.value(f"(() => {{ const e = document.getElementById({json.dumps(name)}); e.scrollIntoView({{block: 'center'}}); "
                         "const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        self.mouse("mousePressed", *box)
        self.mouse("mouseReleased", *box)

    def key(self, key, kinds=("rawKeyDown", "keyUp")):
        codes = {"ArrowRight": 39, "ArrowLeft": 37, "Home": 36, "End": 35, "Tab": 9, "Enter": 13, "Escape": 27, " ": 32, "ArrowUp": 38, "ArrowDown": 40,
                 "a": 65, "b": 66, "+": 187, "0": 48, "PageUp": 33, "PageDown": 34}
        for kind in kinds:
            text = {"Enter": "\r", " ": " "}.get(key) if kind == "rawKeyDown" else None
            self.ask("Input.dispatchKeyEvent", type="keyDown" if text else kind, key=key, windowsVirtualKeyCode=codes[key],
                     **({"text": text} if text else {}))

    def picture(self, path, width, dark):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=1050 if width > 700 else 2000, deviceScaleFactor=1, mobile=width < 700)
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        time.sleep(0.5)
        path.write_bytes(base64.b64decode(self.ask("Page.captureScreenshot", format="webp", quality=80)["data"]))


@contextlib.contextmanager
def browser(address):
    program = shutil.which("chromium")
    if program is None:
        print("skipped: no chromium")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="tacto-chromium-", ignore_cleanup_errors=True) as profile:
        flags = ["--headless", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
                 "--disable-component-update", "--disable-sync", "--remote-debugging-port=0", f"--user-data-dir={profile}", "--window-size=1300,1000"]
        if os.getuid() == 0:
            flags.append("--no-sandbox")
        process = subprocess.Popen([program, *flags, "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            until, printed = time.monotonic() + WAIT_S, pathlib.Path(profile, "DevToolsActivePort")
            while not printed.exists() or len(printed.read_text().split()) < 2:
                assert time.monotonic() < until and process.poll() is None, "chromium does not start"
                time.sleep(0.1)
            port, path = printed.read_text().split()
            root = WebSocket(int(port), path)
            target = root.ask(id=1, method="Target.getTargets")["result"]["targetInfos"]
            page = next(t["targetId"] for t in target if t["type"] == "page")
            chrome = Browser(int(port), f"/devtools/page/{page}")
            chrome.ask("Page.navigate", url=address)
            chrome.wait("document.readyState === 'complete' && document.querySelectorAll('#textures li').length > 0")
            yield chrome
        finally:
            process.terminate()
            process.wait()
