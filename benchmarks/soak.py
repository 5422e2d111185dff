"""A live run for half an hour: does its memory stay flat, does its time keep pace with the clock, what is dropped?

    python benchmarks/soak.py --minutes 30 --rate 120 --out soak.json
    python benchmarks/soak.py --minutes 30 --rate 30 --through http --out soak_http.json

The whole of `lobula run`: the thread that reads, the network, a trace, clips of alarms, records. ``memory`` makes the
pictures in this process, with a camera's stamps; ``http`` has them sent by ``web_camera.py`` as JPEGs and stamped by
arrival. Memory is what the process holds after the warm-up, ten minutes: the C library's allocator and the encoder's
take some forty clips of alarms to find their level. It is also told for each minute. Drift is how far the frames' own
time has moved against the clock since then. The exit code is 1 where a limit is passed.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from web_camera import approach_and_pause

import lobula
from lobula.bench.machine import machine
from lobula.frames import FrameStream
from lobula.frames.geometry import View
from lobula.frames.selection import Picture, Selection
from lobula.report.kept import KeptClips
from lobula.report.trace import TraceWriter
from lobula.runtime.header import run_header
from lobula.runtime.loop import run
from lobula.runtime.ndjson import NdjsonSink
from lobula.runtime.outputs import Outputs

MOST_GROWTH_BYTES = 2**20
"""Memory is flat within this after the warm-up."""

WARM_UP_S = 600.0

SCALE = 3  # 294 x 216 px


class SyntheticCamera:
    """A reader that shows an approach and a pause over and over, at a steady rate and with exact stamps."""

    name, frame_count, rotation, damaged = "synthetic camera", None, 0, 0

    def __init__(self, rate_hz: float) -> None:
        self.fps = rate_hz
        self.notes: list[str] = []
        self._pictures, self._order = approach_and_pause(rate_hz, SCALE)
        self.first = self._pictures[0]

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield pictures for ever, each when its time has come."""
        begun_s, index = time.monotonic(), 0
        while True:
            due_s = begun_s + index / self.fps
            time.sleep(max(0.0, due_s - time.monotonic()))
            data = self._pictures[self._order[index % len(self._order)]]
            yield Picture(data, index / self.fps, index, captured_s=due_s)
            index += 1

    def close(self) -> None:
        """Nothing to let go of."""


class Probe:
    """A sink that looks at memory and time once a second."""

    def __init__(self) -> None:
        self.at_s: list[float] = []
        self.bytes: list[int] = []
        self.ahead_s: list[float] = []
        self._begun_s = self._first_s = 0.0
        self._nearest_s = np.inf

    def open(self, header: Mapping[str, Any]) -> None:
        """Nothing to do."""

    def frame(self, index: int, reading: lobula.Reading, picture: object) -> None:
        """Note how far time is ahead of the clock; the promptest frame of each second counts."""
        now_s = time.monotonic()
        if not self._begun_s:
            self._begun_s, self._first_s = now_s, reading.time_s
        self._nearest_s = min(self._nearest_s, (now_s - self._begun_s) - (reading.time_s - self._first_s))
        if now_s - self._begun_s >= len(self.at_s) + 1:
            self.at_s.append(now_s - self._begun_s)
            self.bytes.append(resident_bytes())
            self.ahead_s.append(-float(self._nearest_s))
            self._nearest_s = np.inf

    def event(self, record: Mapping[str, Any]) -> None:
        """Nothing to do."""

    def close(self, summary: Mapping[str, Any]) -> None:
        """Nothing to do."""


def resident_bytes() -> int:
    """Return the memory that this process holds (Linux)."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def soak(source: FrameStream, folder: Path) -> tuple[Probe, dict[str, Any], int]:
    """Run to the end of ``source``; return the probe, the summary and the number of clips."""
    network, probe = lobula.Network(), Probe()
    with Path(os.devnull).open("w") as nowhere:
        sinks = [TraceWriter(folder / "trace.csv"), KeptClips(folder / "clips"), probe, NdjsonSink(nowhere)]
        header = run_header(source, network.params, preset="default", engine=network.engine)
        outcome = run(source, network, Outputs(sinks, lambda text: print(text, file=sys.stderr)), header)
    return probe, outcome.summary, len(list((folder / "clips").glob("collision-*.mp4")))


def figures(probe: Probe, warm_up_s: float, rate_hz: float) -> dict[str, Any]:
    """Return growth of memory and drift of time after the warm-up, and whether they are within the limits."""
    warm = [i for i, at_s in enumerate(probe.at_s) if at_s >= warm_up_s]
    if len(warm) < 4:
        raise SystemExit("too short: must leave at least four seconds after the warm-up")
    held, ahead_s = [probe.bytes[i] for i in warm], [probe.ahead_s[i] for i in warm]
    tenth = max(1, len(warm) // 10)
    growth = statistics.median(held[-tenth:]) - statistics.median(held[:tenth])
    drift_s = statistics.median(ahead_s[-tenth:]) - statistics.median(ahead_s[:tenth])
    return {
        "seconds": round(probe.at_s[-1], 1),
        "memory_mb": round(held[0] / 2**20, 2),
        "memory_growth_mb": round(growth / 2**20, 3),
        "memory_span_mb": round((max(held) - min(held)) / 2**20, 3),
        "memory_mb_by_minute": [round(each / 2**20, 2) for each in probe.bytes[59::60]],
        "memory_flat": growth <= MOST_GROWTH_BYTES,
        "drift_ms": round(1000 * drift_s, 3),
        "no_drift": abs(drift_s) <= 1 / rate_hz,
    }


def main() -> int:
    """Soak, print the figures, write the file."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--rate", type=float, default=120.0, help="pictures per second")
    parser.add_argument("--through", choices=("memory", "http"), default="memory")
    parser.add_argument("--warm-up", type=float, help="seconds; 600, or a third of a shorter run")
    parser.add_argument("--out", type=Path, help="JSON file to write")
    options = parser.parse_args()
    length_s = 60 * options.minutes
    warm_up_s = min(WARM_UP_S, length_s / 3) if options.warm_up is None else options.warm_up
    about, server = machine(), None
    try:
        if options.through == "http":
            command = [sys.executable, str(Path(__file__).with_name("web_camera.py"))]
            server = subprocess.Popen(
                [*command, "--rate", str(options.rate), "--scale", str(SCALE)], stdout=subprocess.PIPE, text=True
            )
            assert server.stdout is not None
            source = lobula.open(server.stdout.readline().strip(), end_s=length_s)
        else:
            source = FrameStream(SyntheticCamera(options.rate), View(), Selection(end_s=length_s))
        with tempfile.TemporaryDirectory() as folder, source:
            probe, summary, clips = soak(source, Path(folder))
    finally:
        if server is not None:
            server.kill()
            server.wait()
    found = figures(probe, warm_up_s, options.rate)
    told = ("frames", "dropped", "collisions", "latency_ms", "latency_ms_worst", "lost", "status")
    document = {
        "machine": about, "rate_hz": options.rate, "through": options.through, "warm_up_s": warm_up_s,
        **found, **{key: summary[key] for key in told if key in summary}, "clips": clips,
    }  # fmt: skip
    if options.out is not None:
        options.out.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(document, indent=1))
    return 0 if found["memory_flat"] and found["no_drift"] else 1


if __name__ == "__main__":
    sys.exit(main())
