"""A small JPEG of a picture, for the report page."""

from __future__ import annotations

from fractions import Fraction

import av
import numpy as np
from av.video.reformatter import ColorRange
from numpy.typing import NDArray


def thumbnail(picture: NDArray[np.uint8], width: int = 320) -> bytes:
    """Return an (h, w, 3) RGB picture as a JPEG ``width`` pixels wide, or as wide as it is if it is smaller."""
    width = max(2 * (min(width, picture.shape[1]) // 2), 2)
    height = max(2 * round(picture.shape[0] * width / picture.shape[1] / 2), 2)
    frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")
    frame = frame.reformat(width, height, "yuvj420p", dst_color_range=ColorRange.JPEG, interpolation="AREA")
    encoder = av.CodecContext.create("mjpeg", "w")
    encoder.width, encoder.height, encoder.pix_fmt = width, height, "yuvj420p"
    encoder.time_base = Fraction(1, 30)
    encoder.options = {"qmin": "4", "qmax": "4"}
    return b"".join(bytes(packet) for packet in [*encoder.encode(frame), *encoder.encode(None)])
