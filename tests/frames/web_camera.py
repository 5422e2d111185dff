"""A web camera that does what a test says: an HTTP server on loopback that gives JPEG after JPEG."""

from __future__ import annotations

import contextlib
import http.server
import socket
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .clips import image_bytes

RATE_HZ = 25.0


class WebCamera:
    """Gives ``image(n)`` as its n-th picture, at ``RATE_HZ`` from when somebody looks.

    ``mode`` is what it does next: ``run``; ``freeze`` on one picture; be ``silent`` and keep the connection; ``refuse``
    whoever connects, after it cut off whoever was; ``end`` a stream as soon as it began.
    """

    def __init__(self, image: Callable[[int], NDArray[np.uint8]], rate_hz: float = RATE_HZ) -> None:
        self.image, self.rate_hz, self.mode, self.shown, self.visits = image, rate_hz, "run", 0, 0
        self._links: list[Any] = []
        self._refusals: int | None = None
        camera = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def log_message(self, *_: object) -> None:
                pass

            def do_GET(self) -> None:
                camera.serve(self)

        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.address = f"http://127.0.0.1:{self._server.server_port}/camera"
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()

    def __enter__(self) -> WebCamera:
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()
        self._server.shutdown()
        self._server.server_close()

    def unplug(self, refusals: int | None = None) -> None:
        """Cut off everybody, and refuse until ``mode`` says otherwise, or for so many visits."""
        self.mode, self._refusals = "refuse", refusals
        links, self._links = self._links, []
        for link in links:
            with contextlib.suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)

    def serve(self, request: http.server.BaseHTTPRequestHandler) -> None:
        self.visits += 1
        if self.mode == "refuse":
            request.send_error(503)
            if self._refusals is not None:
                self._refusals -= 1
                self.mode = "refuse" if self._refusals > 0 else "run"
            return
        self._links.append(request.connection)
        request.send_response(200)
        request.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        request.end_headers()
        begun_s, count, kept = time.monotonic(), 0, b""
        try:
            while self.mode != "refuse":
                time.sleep(max(0.0, begun_s + count / self.rate_hz - time.monotonic()))
                count += 1
                if self.mode == "silent":
                    continue
                if self.mode != "freeze" or not kept:
                    kept = image_bytes(self.image(self.shown), "mjpeg", "yuvj420p")
                    self.shown += 1
                head = b"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(kept)
                request.wfile.write(head + kept + b"\r\n")
                request.wfile.flush()
                if self.mode == "end" and count >= 3:
                    return
        except OSError:
            pass
