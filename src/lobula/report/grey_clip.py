"""Grey pictures as an H.264 clip without loss: what is read back is what was written, to the last grey level."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.error import FFmpegError
from numpy.typing import NDArray

from ..errors import ParameterError
from ..landing import whole_file
from .h264 import TICK, require_h264

CLIP_SUFFIXES = (".mp4", ".mkv")
_FULL_RANGE = 2


def write_grey_clip(
    path: str | Path, images: Iterable[NDArray[Any]], times_s: Iterable[float], rate_hz: float, comment: str = ""
) -> None:
    """Write luminance images (H, W), 0..255, each to be shown from its time on; floats are rounded to grey levels.

    Raises
    ------
    ParameterError : a suffix other than .mp4 or .mkv
    OutputError : the file cannot be written, or PyAV has no H.264 encoder
    """
    path = Path(path)
    if path.suffix.lower() not in CLIP_SUFFIXES:
        raise ParameterError(f"clip {path}: must end in {', '.join(CLIP_SUFFIXES)}")
    require_h264(path)
    container_format = "mp4" if path.suffix.lower() == ".mp4" else "matroska"
    with whole_file(path, FFmpegError) as temporary, av.open(str(temporary), "w", format=container_format) as container:
        container.metadata["comment"] = comment
        stream = container.add_stream("libx264", rate=Fraction(rate_hz).limit_denominator(1000))
        stream.pix_fmt = "gray"
        context = stream.codec_context
        context.time_base, context.color_range = TICK, _FULL_RANGE
        context.options = {"qp": "0", "preset": "veryfast", "bf": "0"}
        for image, time_s in zip(images, times_s, strict=True):
            grey = np.rint(image).astype(np.uint8)
            if not context.is_open:
                stream.height, stream.width = grey.shape
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(grey), format="gray")
            frame.color_range = _FULL_RANGE
            frame.pts, frame.time_base = round(time_s / TICK), TICK
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
