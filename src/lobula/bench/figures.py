"""What ``lobula bench`` prints."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..engine.network import chosen_engine
from .machine import machine
from .network import frame_by_frame, in_blocks, network, streams_in_blocks
from .scenes import scenes
from .timing import Pass, Timing, interleaved

SIZES = ((99, 72), (320, 240), (640, 480), (1280, 720))
"""Working sizes, width x height."""

FRAMES = {(99, 72): 60, (320, 240): 32}
LARGE_FRAMES = 16
STREAMS, THREADS = 64, 2
CLIP_FRAMES = 40


def measure(rounds: int = 7) -> dict[str, Any]:
    """Return this machine's figures, ready for JSON; all with the default preset.

    Times are microseconds a frame, ``median`` over ``rounds`` and ``best`` of all. ``step_us`` and ``block_us`` are
    processor time of one thread for each working size, frame by frame and as blocks; ``reference_step_us`` is the
    NumPy engine at 99x72; ``streams`` is wall time of 64 streams on two threads; ``video``, None without PyAV and an
    H.264 encoder, is a 640x480 file decoded, and taken to decisions.
    """
    engine = chosen_engine("auto")
    step, block = {}, {}
    for width, height in SIZES:
        movies = list(scenes(width, height, FRAMES.get((width, height), LARGE_FRAMES)).values())
        contenders = {"step": frame_by_frame(lambda: network(engine).step, movies)}
        if engine == "core":
            contenders["block"] = in_blocks(lambda: network(engine), movies)
        if (width, height) == SIZES[0]:
            contenders["reference"] = frame_by_frame(lambda: network("reference").step, movies)
        timings = interleaved(contenders, rounds)
        size = f"{width}x{height}"
        step[size] = timings["step"].as_dict()
        if "block" in timings:
            block[size] = timings["block"].as_dict()
        if "reference" in timings:
            reference = {size: timings["reference"].as_dict()}
    return {
        "machine": machine(),
        "engine": engine,
        "rounds": rounds,
        "step_us": step,
        "block_us": block,
        "reference_step_us": reference,
        "streams": _streams(engine, rounds),
        "video": _video(engine, rounds),
    }


def _streams(engine: str, rounds: int) -> dict[str, Any]:
    movies = list(scenes(*SIZES[0], FRAMES[SIZES[0]]).values())
    work = {"streams": streams_in_blocks(lambda: network(engine), movies, STREAMS, THREADS)}
    us = _wall(work, rounds)["streams"]
    return {
        "streams": STREAMS, "threads": THREADS, "size": "99x72", "frame_us": us.as_dict(),
        "frames_per_s": {"median": round(1e6 / us.median_us), "best": round(1e6 / us.best_us)},
    }  # fmt: skip


def _wall(work: Mapping[str, Pass], rounds: int) -> dict[str, Timing]:
    return interleaved(work, rounds, time.perf_counter_ns)


def _video(engine: str, rounds: int) -> dict[str, Any] | None:
    try:
        from .video import clip_pictures, decode_only, to_decisions, write_clip

        with tempfile.TemporaryDirectory() as folder:
            clip = Path(folder, "clip.mp4")
            write_clip(clip, clip_pictures(CLIP_FRAMES))
            work = {"decode": decode_only(clip), "decide": to_decisions(clip, lambda: network(engine))}
            timings = interleaved(work, rounds, time.process_time_ns)
    except (ImportError, ValueError, OSError):
        return None
    return {"clip": "640x480 H.264", "decode_us": timings["decode"].as_dict(),
            "to_decision_us": timings["decide"].as_dict()}  # fmt: skip
