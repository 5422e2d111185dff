"""A video file all the way to decisions, against decoding it and looking at nothing."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from lobula.bench.timing import interleaved, ratio
from lobula.bench.video import clip_pictures, decode_only, to_decisions, write_clip

from .contenders import published
from .figure import Figure

FRAMES = 180


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time both in processor time of the process; decoding uses one thread in either."""
    with tempfile.TemporaryDirectory() as folder:
        clip = Path(folder, "clip.mp4")
        write_clip(clip, clip_pictures(FRAMES))
        kilobits_s = 8e-3 * clip.stat().st_size / (FRAMES / 30.0)
        contenders = {"decode": decode_only(clip), "decide": to_decisions(clip, published)}
        t = interleaved(contenders, rounds, time.process_time_ns)
    details = {f"{name}_us": timing.as_dict() for name, timing in t.items()} | {"kbit_s": round(kilobits_s)}
    over = ratio(t["decide"], t["decode"])
    return [Figure("file to decision over decoding, 640x480 H.264", over, "x", 1.5, 1.15, "less", details)]
