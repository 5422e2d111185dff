"""What the live page costs the detector: a 640 x 480 camera at 30 Hz, without the page, with it, and with viewers.

    python benchmarks/dashboard.py --out dashboard.json [--seconds 20] [--rounds 3] [--viewers 4]

Latency is from the moment the camera gives a picture to the moment an output has the decision, wall clock. The cases
take turns; viewers are processes of their own, each looks at another map; in the last case one more never reads. Needs
the extra `dashboard` and a machine that does nothing else: exit code 1 where a median is above 1.2 of that without the
page, or a frame was dropped.
"""

from __future__ import annotations

import argparse
import json
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import av
import numpy as np

import lobula
from lobula.bench.machine import machine
from lobula.dashboard.about import about_run
from lobula.dashboard.board import Board
from lobula.dashboard.live_settings import LiveSettings
from lobula.dashboard.live_sink import LiveSink
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site
from lobula.dashboard.tunable_network import TunableNetwork
from lobula.engine.resize import CoreAreaAverage
from lobula.frames import FrameStream
from lobula.frames.geometry import View
from lobula.frames.selection import Picture, Selection
from lobula.runtime.header import run_header
from lobula.runtime.loop import run
from lobula.runtime.outputs import Outputs

WIDTH, HEIGHT, RATE_HZ = 640, 480, 30.0
MUST_RATIO = 1.2
MAPS = ("lamina", "lgmd1_summation", "lgmd2_grouped", "motion", "change", "adapted_on", "lgmd1_grouped", "adapted_off")
SETTLE_FRAMES = 15  # not counted: the run begins, and the viewers get their first messages

VIEWER = """
import json, sys
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
count = size = 0
with connect(sys.argv[1], max_size=None, compression=None) as stream:
    stream.send(json.dumps({"map": sys.argv[2]}))
    try:
        while True:
            size += len(stream.recv(20))
            count += 1
    except ConnectionClosed:
        print(json.dumps([count, size]))
"""


class Camera:
    """Gives frames as a decoder does, at their pace, and notes when."""

    name, frame_count, rotation, damaged, fps = "camera", None, 0, 0, RATE_HZ

    def __init__(self, frames: list[Any]) -> None:
        self.first = frames[0]
        self.notes: list[str] = []
        self.given_s: list[float] = []
        self._frames = frames
        self._closed = threading.Event()

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield picture after picture until closed."""
        begun_s = time.monotonic()
        while not self._closed.wait(max(0.0, begun_s + len(self.given_s) / self.fps - time.monotonic())):
            number = len(self.given_s)
            self.given_s.append(time.monotonic())
            yield Picture(self._frames[number % len(self._frames)], number / self.fps, number)

    def close(self) -> None:
        """Stop."""
        self._closed.set()


class Stopwatch:
    """The first of the outputs, so that it waits for none: notes how long after its picture each decision came.

    ``dropped`` counts what the source left out since the run settled.
    """

    def __init__(self, camera: Camera, source: FrameStream) -> None:
        self._camera, self._source = camera, source
        self._dropped_before = 0
        self.latencies_ms: list[float] = []

    @property
    def dropped(self) -> int:
        """Frames overtaken since the run settled."""
        return self._source.dropped - self._dropped_before

    def open(self, header: Any) -> None:
        """Nothing to do."""

    def frame(self, index: int, reading: Any, picture: Any) -> None:
        """Note one."""
        self.latencies_ms.append(1000 * (time.monotonic() - self._camera.given_s[index]))
        if len(self.latencies_ms) == SETTLE_FRAMES:
            self._dropped_before = self._source.dropped

    def event(self, record: Any) -> None:
        """Nothing to do."""

    def close(self, summary: Any) -> None:
        """Nothing to do."""


def main() -> int:
    """Measure, print, write; 1 where a figure is not what it must be."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="JSON file to write")
    parser.add_argument("--seconds", type=float, default=20.0, help="of each case in each round")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--viewers", type=int, default=4)
    options = parser.parse_args()
    frames = decoded_frames()
    cases: dict[str, Callable[[], dict[str, Any]]] = {
        "without the page": lambda: case(frames, options.seconds, None),
        "nobody watches": lambda: case(frames, options.seconds, 0),
        f"{options.viewers} viewers": lambda: case(frames, options.seconds, options.viewers),
        f"{options.viewers} and one that never reads": lambda: case(frames, options.seconds, options.viewers, True),
    }
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in cases}
    for number in range(options.rounds):
        for name, measure in cases.items():
            print(f"round {number + 1}: {name}", file=sys.stderr)
            found[name].append(measure())
    rows = [summed_up(name, rounds) for name, rounds in found.items()]
    for row in rows:
        row["ratio"] = round(row["median_ms"] / rows[0]["median_ms"], 3)
    document = {"machine": machine(), "camera": f"{WIDTH}x{HEIGHT} at {RATE_HZ:g} Hz", "cases": rows}
    options.out.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    print("| case | median ms | 99 % ms | worst ms | ratio | frames | dropped | messages / s | kB / s |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    keys = ("case", "median_ms", "p99_ms", "worst_ms", "ratio", "frames", "dropped", "messages_hz", "kb_s")
    for row in rows:
        print("| " + " | ".join("" if row[key] is None else str(row[key]) for key in keys) + " |")
    return 1 if any(row["dropped"] or row["ratio"] > MUST_RATIO for row in rows) else 0


def decoded_frames() -> list[Any]:
    """Three seconds of an approach as a decoder gives them, YUV 4:2:0 in its limited range."""
    movie = lobula.stimuli.looming(scene="arena", speed_cm_s=12.0, width=WIDTH, height=HEIGHT)
    return [av.VideoFrame.from_ndarray(image, "gray").reformat(format="yuv420p") for image in movie.images]


def case(frames: list[Any], seconds: float, viewers: int | None, silent: bool = False) -> dict[str, Any]:
    """Run the detector for a while; ``viewers`` None is without the page."""
    camera = Camera(frames)
    count = round(seconds * RATE_HZ) + SETTLE_FRAMES
    source = FrameStream(camera, View(), Selection(max_frames=count), CoreAreaAverage)
    watch, settings = Stopwatch(camera, source), LiveSettings(lobula.preset(), "default")
    with ExitStack() as stack:
        readers: list[subprocess.Popen[str]] = []
        if viewers is None:
            network: Any = lobula.Network()
            sinks: list[Any] = [watch]
        else:
            board: Board
            network = TunableNetwork(settings, wanted=lambda: board.wanted_maps, on_change=lambda before, after: None)
            header = run_header(source, settings.params, preset="default", engine=network.engine)
            board = Board(about_run("live", header, settings), Rows(keep=4096), settings=settings)
            site = stack.enter_context(Site(board, lambda params: ""))
            sinks = [watch, LiveSink(board, source, network)]
            readers = [viewer(site, MAPS[i % len(MAPS)]) for i in range(viewers)]
            if silent:
                stack.enter_context(one_that_never_reads(site.port))
            wait_for(board, viewers + silent)
        header = run_header(source, settings.params, preset="default", engine=network.engine)
        run(source, network, Outputs(sinks, print), header)
    told = [json.loads(reader.communicate(timeout=30)[0]) for reader in readers]
    return {
        "latencies_ms": watch.latencies_ms[SETTLE_FRAMES:],
        "dropped": watch.dropped,
        "messages_hz": [round(messages / seconds, 1) for messages, _ in told],
        "kb_s": [round(size / 1000 / seconds) for _, size in told],
    }


def wait_for(board: Board, viewers: int) -> None:
    """Return when so many are there."""
    deadline_s = time.monotonic() + 60
    while len(board.viewers) < viewers:
        if time.monotonic() > deadline_s:
            raise SystemExit(f"of {viewers} viewers only {len(board.viewers)} came")
        time.sleep(0.05)


def viewer(site: Site, name: str) -> subprocess.Popen[str]:
    """Start a process that takes whatever comes."""
    address = f"ws://127.0.0.1:{site.port}/stream"
    return subprocess.Popen([sys.executable, "-c", VIEWER, address, name], stdout=subprocess.PIPE, text=True)


def one_that_never_reads(port: int) -> socket.socket:
    """Shake hands and leave it at that."""
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)  # soon full
    connection.connect(("127.0.0.1", port))
    connection.sendall(
        b"GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
    )
    return connection


def summed_up(name: str, rounds: list[dict[str, Any]]) -> dict[str, Any]:
    """Return one row: the median of the rounds' medians, the worst of all, every drop; the median over viewers."""
    every = np.concatenate([one["latencies_ms"] for one in rounds])
    return {
        "case": name,
        "median_ms": round(statistics.median(float(np.median(one["latencies_ms"])) for one in rounds), 3),
        "p99_ms": round(float(np.percentile(every, 99)), 3),
        "worst_ms": round(float(every.max()), 3),
        "frames": len(every),
        "dropped": sum(one["dropped"] for one in rounds),
        "messages_hz": middle([rate for one in rounds for rate in one["messages_hz"]]),
        "kb_s": middle([rate for one in rounds for rate in one["kb_s"]]),
    }


def middle(values: list[float]) -> float | None:
    """Return the median, None where there is nothing."""
    return statistics.median(values) if values else None


if __name__ == "__main__":
    sys.exit(main())
