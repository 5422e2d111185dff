"""Many cameras: 64 streams in blocks on two threads against one stream, frame by frame, on one."""

from __future__ import annotations

import time

from lobula.bench.network import frame_by_frame, streams_in_blocks
from lobula.bench.scenes import scenes
from lobula.bench.timing import interleaved, ratio

from .contenders import published
from .figure import Figure

STREAMS, THREADS, FRAMES = 64, 2, 64


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time both by the wall clock."""
    movies = list(scenes(99, 72, FRAMES).values())
    contenders = {
        "one": frame_by_frame(lambda: published().step, movies[:1]),
        "streams": streams_in_blocks(published, movies, STREAMS, THREADS),
        "one_thread": streams_in_blocks(published, movies, STREAMS, 1),
    }
    t = interleaved(contenders, rounds, time.perf_counter_ns)
    details = {f"{name}_us": timing.as_dict() for name, timing in t.items()}
    details["frames_per_s"] = {"median": round(1e6 / t["streams"].median_us), "best": round(1e6 / t["streams"].best_us)}
    both, one = (ratio(t["one"], t[name]) for name in ("streams", "one_thread"))
    return [
        Figure(f"{STREAMS} streams, {THREADS} threads, against one stream", both, "x", 1.3, 1.8, details=details),
        Figure(f"{STREAMS} streams, 1 thread, against one stream", one, "x", details=details),
    ]
