"""``lobula batch``: two processes against one, beside what the machine gives two, and what a clip costs by itself."""

from __future__ import annotations

import shutil
import struct
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from statistics import median

import numpy as np

from lobula.batch import Crew, find_clips, make_request, run_batch
from lobula.bench.network import network
from lobula.bench.timing import Pass, Timing, interleaved, ratio
from lobula.bench.video import clip_pictures, to_decisions, write_clip
from lobula.engine.network import Network
from lobula.model.presets import preset
from lobula.report.grey_clip import write_grey_clip

from .figure import Figure

CLIPS, CLIP_FRAMES = 64, 60
QUICK_CLIPS = 8
FEW, MANY, SHORT_FRAMES = 4, 44, 12
"""Short clips: what one more of them takes is told by ``MANY`` against ``FEW``, without the start of the worker."""


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time by the wall clock, workers' start included in the speed-up."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        return [*_speed_up(here, rounds, QUICK_CLIPS if quick else CLIPS), _overhead(here, rounds)]


def _speed_up(here: Path, rounds: int, count: int) -> list[Figure]:
    pictures = clip_pictures(CLIP_FRAMES)
    write_clip(here / "clip.mp4", pictures)
    clips = _copies(here / "clip.mp4", here / "long", count)
    frames = count * len(pictures)
    with _bare(here / "clip.mp4", 2) as lines:
        work = {f"workers_{n}": _batch(clips, here, n, frames) for n in (1, 2)}
        work |= {f"bare_{n}": _looks(lines[:n], count, frames) for n in (1, 2)}
        t = interleaved(work, rounds, time.perf_counter_ns)
    details = {f"{name}_us": timing.as_dict() for name, timing in t.items()} | {"clips": count, "frames": frames}
    batch, most = ratio(t["workers_1"], t["workers_2"]), ratio(t["bare_1"], t["bare_2"])
    return [
        Figure("lobula batch: 2 workers against 1, 640x480 H.264", batch, "x", 1.8, details=details),
        Figure("the same clips: 2 bare processes against 1, what this machine gives", most, "x", details=details),
        Figure("lobula batch: its speed-up, of what this machine gives", 100 * batch / most, "%", details=details),
    ]


@contextmanager
def _bare(clip: Path, count: int) -> Iterator[list[Connection]]:
    """Give lines to processes that look at ``clip`` as often as they are told, and write nothing."""
    context = get_context("spawn")
    pairs = [context.Pipe() for _ in range(count)]
    processes = [context.Process(target=_look, args=(theirs, clip), daemon=True) for _, theirs in pairs]
    for process in processes:
        process.start()
    try:
        yield [ours for ours, _ in pairs]
    finally:
        for process in processes:
            process.kill()
            process.join()


def _look(line: Connection, clip: Path) -> None:
    look = to_decisions(clip, _afresh())
    while True:
        for _ in range(line.recv()):
            look()
        line.send(True)


def _looks(lines: Sequence[Connection], count: int, frames: int) -> Pass:
    """Return a pass in which the processes at ``lines`` look at the clip ``count`` times in all."""

    def work() -> int:
        for line in lines:
            line.send(count // len(lines))
        for line in lines:
            line.recv()
        return frames

    return work


def _afresh() -> Callable[[], Network]:
    """Return a way to one network that each time knows nothing of the time before."""
    net = network("auto")

    def fresh() -> Network:
        net.reset()
        return net

    return fresh


def _overhead(here: Path, rounds: int) -> Figure:
    pictures = np.random.default_rng(0).integers(0, 255, (SHORT_FRAMES, 72, 99), np.uint8)
    write_grey_clip(here / "short.mp4", pictures, [i / 30 for i in range(SHORT_FRAMES)], 30)
    clips = _copies(here / "short.mp4", here / "short", MANY)
    look = to_decisions(here / "short.mp4", _afresh())
    work: dict[str, Pass] = {
        "many": _batch(clips, here, 1, 1),
        "few": _batch(clips[:FEW], here, 1, 1),
        "look": lambda: look() // SHORT_FRAMES,
    }
    t = interleaved(work, rounds, time.perf_counter_ns)
    each_us = [(a - b) / (MANY - FEW) for a, b in zip(t["many"].rounds_us, t["few"].rounds_us, strict=True)]
    beside_ms = median((a - b) / 1000 for a, b in zip(each_us, t["look"].rounds_us, strict=True))
    details = {
        f"{name}_us": timing.as_dict() for name, timing in {**t, "one more": Timing(each_us, min(each_us))}.items()
    }
    return Figure("lobula batch: a clip beside looking at it", beside_ms, "ms", 50, better="less", details=details)


def _copies(clip: Path, folder: Path, count: int) -> list[str]:
    """Copy an MP4, each time with a box that nobody reads: the same pictures, another content."""
    folder.mkdir()
    for i in range(count):
        path = folder / f"{i}.mp4"
        shutil.copy(clip, path)
        with path.open("ab") as file:
            file.write(struct.pack(">I4sI", 12, b"free", i))
    return [str(path) for path in sorted(folder.iterdir())]


def _batch(clips: Sequence[str], here: Path, workers: int, counts: int) -> Pass:
    """Return a pass that does all of ``clips`` into an empty folder, and counts as ``counts``."""

    def work() -> int:
        with tempfile.TemporaryDirectory(dir=here) as out:
            asked = make_request(Path(out), preset(), preset="default")
            ended = run_batch(find_clips(clips, Path(out)), asked, Crew(asked, workers))
            if ended.summary.done != len(clips) or ended.stop is not None:
                raise RuntimeError(f"the batch did not do its work: {ended.summary}")
        return counts

    return work
