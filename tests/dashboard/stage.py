"""A live run with its page, in this process: a camera that is a movie played over and over, a server on loopback."""

from __future__ import annotations

import http.client
import json
import struct
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from lobula.cli.settings_file import settings_toml
from lobula.dashboard.about import about_run
from lobula.dashboard.board import Board
from lobula.dashboard.live_settings import LiveSettings
from lobula.dashboard.live_sink import LiveSink
from lobula.dashboard.rows import ROW, Rows
from lobula.dashboard.server import Site
from lobula.dashboard.tunable_network import TunableNetwork
from lobula.frames import FrameStream
from lobula.frames.geometry import View
from lobula.frames.selection import Picture, Selection
from lobula.model.presets import preset
from lobula.runtime.header import run_header, setting_rows
from lobula.runtime.loop import run
from lobula.runtime.outputs import Outputs


class MovieCamera:
    """A reader that gives the pictures of a movie at their own pace, from the start again after its end.

    With ``decided`` it waits for nothing but the decision on the picture before: quick, and none is dropped.
    """

    frame_count, rotation, damaged = None, 0, 0

    def __init__(self, images: NDArray[np.uint8], rate_hz: float, decided: Callable[[], int] | None = None):
        self.name, self.fps, self.first = "movie camera", rate_hz, images[0]
        self._decided = decided
        self.notes: list[str] = []
        self.given_s: list[float] = []
        self.silent = threading.Event()
        self._images = images
        self._closed = threading.Event()

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        self._begun_s = time.monotonic()
        number = 0
        while self._due(number):
            if not self.silent.is_set():
                self.given_s.append(time.monotonic())
                yield Picture(self._images[number % len(self._images)], number / self.fps, number)
            number += 1

    def _due(self, number: int) -> bool:
        """Wait until it is time for a picture; False when there is no time any more."""
        if self._decided is None:
            return not self._closed.wait(max(0.0, self._begun_s + number / self.fps - time.monotonic()))
        while self._decided() < number:
            if self._closed.wait(0.001):
                return False
        return not self._closed.is_set()

    def close(self) -> None:
        self._closed.set()


class Live(NamedTuple):
    """What a test may touch of a live run."""

    site: Site
    board: Board
    camera: MovieCamera
    settings: LiveSettings
    source: FrameStream
    changes: list[Any]


def toml(params: Any) -> str:
    return settings_toml(setting_rows(params), "default")


@contextmanager
def live(images: NDArray[np.uint8], rate_hz: float = 30.0, *, quick: bool = False, **how: Any) -> Iterator[Live]:
    """A camera, the detector in a thread of its own as in a process of its own, and the page.

    ``quick``: time is that of the movie, and runs as fast as the detector does.
    """
    rows = Rows(keep=1 << 16)
    camera = MovieCamera(images, rate_hz, (lambda: len(rows)) if quick else None)
    settings, changes = LiveSettings(preset(), "default"), []
    source = FrameStream(camera, View(), Selection())
    board: Board
    network = TunableNetwork(settings, wanted=lambda: board.wanted_maps, on_change=lambda *both: changes.append(both))
    header = run_header(source, settings.params, preset="default", engine=network.engine)
    board = Board(about_run("live", header, settings), rows, settings=settings)
    outputs = Outputs([LiveSink(board, source, network)], lambda text: None)
    loop = threading.Thread(target=run, args=(source, network, outputs, header))
    with Site(board, toml, **how) as site:
        loop.start()
        try:
            yield Live(site, board, camera, settings, source, changes)
        finally:
            source.close()
            loop.join(10)
            assert not loop.is_alive()


class Answer(NamedTuple):
    status: int
    headers: Mapping[str, str]
    body: bytes

    @property
    def text(self) -> str:
        return self.body.decode()

    @property
    def document(self) -> Any:
        return json.loads(self.body)


def ask(
    site: Site, path: str, method: str = "GET", body: Any = None, headers: Mapping[str, str] | None = None
) -> Answer:
    """Send one request exactly as it is given; a body that is no text goes as JSON."""
    connection = http.client.HTTPConnection("127.0.0.1", site.port, timeout=20)
    try:
        given = {"Host": f"127.0.0.1:{site.port}"} | dict(headers or {})
        if body is not None and not isinstance(body, str | bytes):
            body = json.dumps(body)
            given = {"Content-Type": "application/json"} | given
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        data = body.encode() if isinstance(body, str) else body
        if data is not None and "Content-Length" not in given and "Transfer-Encoding" not in given:
            given["Content-Length"] = str(len(data))
        for name, value in given.items():
            connection.putheader(name, value)
        connection.endheaders(data)
        answer = connection.getresponse()
        return Answer(answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read())
    finally:
        connection.close()


class Message(NamedTuple):
    head: dict[str, Any]
    rows: NDArray[Any]
    jpeg: bytes
    map: NDArray[np.int8] | None


class Watcher:
    """A viewer that is no browser."""

    def __init__(self, site: Site, **how: Any):
        how |= {"max_size": None, "max_queue": None}  # closing would wait for messages that nobody takes any more
        self._connection = connect(f"ws://127.0.0.1:{site.port}/stream", open_timeout=20, **how)

    def __enter__(self) -> Watcher:
        self.socket = self._connection.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self.socket.close()

    def send(self, wish: Any) -> None:
        self.socket.send(json.dumps(wish))

    def take(self, timeout_s: float = 60.0) -> Message:
        return taken_apart(self.socket.recv(timeout_s))

    def all(self, silent_s: float) -> list[Message]:
        """Return what comes until nothing has come for ``silent_s``."""
        found = []
        try:
            while True:
                found.append(self.take(silent_s))
        except TimeoutError:
            return found

    def end(self) -> int | None:
        """Take whatever comes until the server closes; return the code it gives."""
        try:
            while True:
                self.take()
        except ConnectionClosed as closed:
            return None if closed.rcvd is None else closed.rcvd.code

    def until(self, true: Callable[[Message], Any], timeout_s: float = 90.0) -> Message:
        deadline_s = time.monotonic() + timeout_s
        while time.monotonic() < deadline_s:
            message = self.take(timeout_s)
            if true(message):
                return message
        raise AssertionError("waited in vain")


def taken_apart(data: Any) -> Message:
    """The parts of a message, by the words of its format and not by its code."""
    (length,) = struct.unpack_from("<I", data)
    head, at = json.loads(data[4 : 4 + length]), 4 + length
    assert at % 8 == 0
    count = head.get("rows", {}).get("count", 0)
    rows = np.zeros(count, ROW)
    for name, kind, per_row in (
        ("time_s", "<f8", 1), ("frame", "<u4", 1), ("potentials", "<f4", 4), ("spikes", "u1", 4), ("state", "u1", 1),
        ("collision", "u1", 1),
    ):  # fmt: skip
        column = np.frombuffer(data, kind, per_row * count, at)
        rows[name] = column if per_row == 1 else column.reshape(-1, per_row)
        at += column.nbytes
    scene = head.get("scene", {})
    jpeg = data[at : at + scene.get("jpeg", 0)]
    at += len(jpeg)
    shape = (scene["map"]["height"], scene["map"]["width"]) if "map" in scene else None
    picture = None if shape is None else np.frombuffer(data, np.int8, shape[0] * shape[1], at).reshape(shape)
    assert at + (0 if picture is None else picture.nbytes) == len(data)
    return Message(head, rows, jpeg, picture)
