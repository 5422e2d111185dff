"""A real browser without a window, spoken to by the DevTools protocol: loads pages, runs scripts, takes pictures."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

from websockets.sync.client import connect

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = (
    "--headless=new", "--remote-debugging-port=0", "--no-sandbox", "--disable-gpu", "--no-first-run", "--mute-audio",
    "--disable-extensions", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--force-color-profile=srgb", "--disable-background-timer-throttling",
)  # fmt: skip


def find_chromium() -> str | None:
    """Return where a Chromium is, if this machine has one."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


class Chromium:
    """A browser for as long as this context lasts."""

    def __init__(self, program: str) -> None:
        self._home = tempfile.TemporaryDirectory(prefix="lobula-chromium-")
        self._process = subprocess.Popen(
            [program, *FLAGS, f"--user-data-dir={self._home.name}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            port, path = _eventually(self._address, 60)
            self._socket = connect(f"ws://127.0.0.1:{port}{path}", max_size=None, compression=None).__enter__()
        except BaseException:
            self._process.kill()
            raise
        self._number = 0

    def __enter__(self) -> Chromium:
        return self

    def __exit__(self, *error: object) -> None:
        self._socket.close()
        self._process.terminate()
        self._process.wait(20)
        for _ in range(20):  # its helpers may still be writing there
            try:
                self._home.cleanup()
                return
            except OSError:
                time.sleep(0.2)

    def page(self, width: int = 1280, height: int = 800, *, dark: bool = False, mobile: bool = False) -> Page:
        """Open a tab of its own, with cookies of its own."""
        context = self.call("Target.createBrowserContext")["browserContextId"]
        target = self.call("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = Page(self, session, context)
        for domain in ("Page", "Runtime", "Log", "Network"):
            page.call(f"{domain}.enable")
        page.look(width, height, dark=dark, mobile=mobile)
        return page

    def call(self, method: str, session: str | None = None, notes: list[dict[str, Any]] | None = None, **params: Any):
        """Send one command, return its result; what the tab reports meanwhile is added to ``notes``."""
        self._number += 1
        command = {"id": self._number, "method": method, "params": params}
        self._socket.send(json.dumps(command if session is None else command | {"sessionId": session}))
        while True:
            answer = json.loads(self._socket.recv(60))
            if answer.get("id") == self._number:
                assert "error" not in answer, (method, answer["error"])
                return answer["result"]
            if notes is not None and answer.get("sessionId") == session:
                notes.append(answer)

    def _address(self) -> list[str] | None:
        file = Path(self._home.name, "DevToolsActivePort")
        lines = file.read_text().split() if file.exists() else []
        return lines if len(lines) == 2 else None


class Page:
    """One tab."""

    def __init__(self, browser: Chromium, session: str, context: str) -> None:
        self._browser = browser
        self._session = session
        self._context = context
        self._notes: list[dict[str, Any]] = []

    def call(self, method: str, **params: Any) -> Any:
        return self._browser.call(method, self._session, self._notes, **params)

    def look(self, width: int, height: int, *, dark: bool = False, mobile: bool = False) -> None:
        """Set size and theme."""
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if mobile else 1,
            mobile=mobile,
        )  # fmt: skip
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def open(self, url: str) -> None:
        self.call("Page.navigate", url=url)
        self.until("document.readyState === 'complete' && location.href !== 'about:blank'")

    def js(self, expression: str) -> Any:
        """Return the value of an expression; promises are waited for."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, result["exceptionDetails"]
        return result["result"].get("value")

    def until(self, expression: str, timeout_s: float = 120.0) -> None:
        """Wait until an expression is true; one that fails, as while the page is loaded anew, is not yet."""
        careful = f"(() => {{ try {{ return !!({expression}) }} catch {{ return false }} }})()"
        _eventually(lambda: self.js(careful), timeout_s, expression)

    def click(self, selector: str) -> None:
        self.js(f"document.querySelector({selector!r}).click()")

    def press(self, key: str) -> None:
        text = {"text": key} if len(key) == 1 else {}
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, **(text if kind == "keyDown" else {}))

    def mouse(self, kind: str, x: float, y: float, buttons: int = 0) -> None:
        self.call(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, buttons=buttons, button="left" if buttons else "none",
            clickCount=1 if kind != "mouseMoved" else 0,
        )  # fmt: skip

    def screenshot(self, path: Path, whole: bool = False) -> Path:
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        path.write_bytes(base64.b64decode(data))
        return path

    def complaints(self) -> list[str]:
        """What the browser's console has been told: errors, warnings, exceptions."""
        self.js("0")
        found = []
        for note in self._notes:
            params = note.get("params", {})
            if note["method"] == "Runtime.exceptionThrown":
                found.append(str(params["exceptionDetails"].get("exception", params["exceptionDetails"])))
            elif note["method"] == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
                found.append(str(params["args"]))
            elif note["method"] == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
                found.append(f"{params['entry']['text']} {params['entry'].get('url', '')}")
        return found

    def close(self) -> None:
        self._browser.call("Target.disposeBrowserContext", browserContextId=self._context)


def _eventually(ask: Any, timeout_s: float, what: object = "") -> Any:
    deadline_s = time.monotonic() + timeout_s
    while True:
        answer = ask()
        if answer:
            return answer
        assert time.monotonic() < deadline_s, f"waited {timeout_s:g} s in vain: {what}"
        time.sleep(0.05)
