"""``lobula batch``: two processes against one, and what a clip costs beside being looked at."""

from __future__ import annotations

import shutil
import struct
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median

import numpy as np

from lobula.batch import Crew, find_clips, make_request, run_batch
from lobula.bench.network import network
from lobula.bench.timing import Pass, Timing, interleaved, ratio
from lobula.bench.video import clip_pictures, to_decisions, write_clip
from lobula.model.presets import preset
from lobula.report.grey_clip import write_grey_clip

from .figure import Figure

CLIPS, CLIP_FRAMES = 32, 60
QUICK_CLIPS = 8
FEW, MANY, SHORT_FRAMES = 4, 44, 12
"""Short clips: what one more of them takes is told by ``MANY`` against ``FEW``, without the start of the worker."""


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time by the wall clock, workers' start included in the speed-up."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        return [_speed_up(here, rounds, QUICK_CLIPS if quick else CLIPS), _overhead(here, rounds)]


def _speed_up(here: Path, rounds: int, count: int) -> Figure:
    pictures = clip_pictures(CLIP_FRAMES)
    write_clip(here / "clip.mp4", pictures)
    clips = _copies(here / "clip.mp4", here / "long", count)
    frames = count * len(pictures)
    work = {f"workers_{n}": _batch(clips, here, n, frames) for n in (1, 2)}
    t = interleaved(work, rounds, time.perf_counter_ns)
    details = {f"{name}_us": timing.as_dict() for name, timing in t.items()} | {"clips": count, "frames": frames}
    return Figure("lobula batch: 2 workers against 1, 640x480 H.264", ratio(t["workers_1"], t["workers_2"]), "x", 1.8,
                  details=details)  # fmt: skip


def _overhead(here: Path, rounds: int) -> Figure:
    pictures = np.random.default_rng(0).integers(0, 255, (SHORT_FRAMES, 72, 99), np.uint8)
    write_grey_clip(here / "short.mp4", pictures, [i / 30 for i in range(SHORT_FRAMES)], 30)
    clips = _copies(here / "short.mp4", here / "short", MANY)
    net = network("auto")

    def fresh() -> Callable[..., object]:
        net.reset()
        return net

    look = to_decisions(here / "short.mp4", fresh)
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
