"""A video clip to measure with, decoding it, and taking it all the way to decisions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..engine.network import Network
from ..runtime.opening import open as open_frames
from .scenes import RATE_HZ, Images, scenes
from .timing import Pass

CLIP_SIZE = (640, 480)
CODEC = "libx264"
BIT_S = 1_200_000
"""Real clips hold 0.13 bits for each pixel of each picture and more; without a rate the encoder would smooth the noise
of a synthetic one away and leave little to decode."""


def write_clip(path: Path, images: Iterable[Images], bit_s: int | None = BIT_S) -> None:
    """Write pictures (H, W) uint8 as H.264 at ``bit_s``, by default a real camera's; None: as the encoder likes.

    Raises
    ------
    ImportError : PyAV is not installed
    ValueError, OSError : it has no H.264 encoder, or the file cannot be written
    """
    import av

    with av.open(str(path), "w") as container:
        stream: Any = container.add_stream(CODEC, rate=round(RATE_HZ))
        stream.width, stream.height = CLIP_SIZE
        stream.pix_fmt = "yuv420p"
        if bit_s is not None:
            stream.bit_rate = bit_s
        for image in images:
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="gray")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())


def clip_pictures(frames: int) -> Images:
    """Return the pictures of the clip, all three movies, ``frames`` of each."""
    return np.concatenate(list(scenes(*CLIP_SIZE, frames).values()))


def decode_only(path: Path) -> Pass:
    """Return a pass that decodes every picture on one thread, as ``lobula.open`` does, and looks at none."""
    import av

    def work() -> int:
        with av.open(str(path)) as container:
            stream = container.streams.video[0]
            stream.codec_context.thread_type = "SLICE"
            stream.codec_context.thread_count = 1
            return sum(1 for _ in container.decode(stream))

    return work


def to_decisions(path: Path, make: Callable[[], Network]) -> Pass:
    """Return a pass from the file to a decision on every picture, at the default working size."""

    def work() -> int:
        net, frames = make(), 0
        with open_frames(path) as pictures:
            for picture in pictures:
                net.step(picture)
                frames += 1
        return frames

    return work
