"""A video file all the way to decisions, against decoding it and looking at nothing."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from lobula.bench.scenes import RATE_HZ
from lobula.bench.timing import interleaved, ratio
from lobula.bench.video import clip_pictures, decode_only, to_decisions, write_clip

from .contenders import published
from .figure import Figure

FRAMES = 60


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time both in processor time of the process; decoding uses one thread in either."""
    pictures = clip_pictures(FRAMES)
    with tempfile.TemporaryDirectory() as folder:
        usual, easy = Path(folder, "usual.mp4"), Path(folder, "easy.mp4")
        write_clip(usual, pictures)
        write_clip(easy, pictures, bit_s=None)
        return [
            _over("file to decision over decoding, 640x480 H.264", usual, len(pictures), rounds, must=1.5, aim=1.15),
            _over("the same where there is little to decode", easy, len(pictures), rounds),
        ]


def _over(
    name: str, clip: Path, frames: int, rounds: int, must: float | None = None, aim: float | None = None
) -> Figure:
    contenders = {"decode": decode_only(clip), "decide": to_decisions(clip, published)}
    t = interleaved(contenders, rounds, time.process_time_ns)
    kilobits_s = 8e-3 * clip.stat().st_size * RATE_HZ / frames
    details = {f"{contender}_us": timing.as_dict() for contender, timing in t.items()} | {"kbit_s": round(kilobits_s)}
    return Figure(name, ratio(t["decide"], t["decode"]), "x", must, aim, "less", details)
