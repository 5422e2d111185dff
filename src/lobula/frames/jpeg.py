"""JPEGs of whole pictures, for those who store or send a few of them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import av
import numpy as np
from av.video.reformatter import ColorRange, VideoReformatter
from numpy.typing import NDArray

QUALITY = "4"
"""The quantiser of MJPEG, 2 (best) to 31."""


class Jpeg:
    """Makes JPEGs at most ``width`` px wide, one after the other; for one thread."""

    def __init__(self, width: int = 640) -> None:
        self._width = width
        self._scaler = VideoReformatter()
        self._encoder: Any = None

    def __call__(self, picture: NDArray[np.uint8]) -> bytes:
        """Return an (h, w, 3) RGB picture as a JPEG; its sides are even."""
        scale = min(1.0, self._width / picture.shape[1])
        width, height = (max(2 * round(side * scale / 2), 2) for side in (picture.shape[1], picture.shape[0]))
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), "rgb24")
        frame = self._scaler.reformat(
            frame, width, height, "yuvj420p", dst_color_range=ColorRange.JPEG, interpolation="AREA"
        )
        if self._encoder is None or (self._encoder.width, self._encoder.height) != (width, height):
            self._encoder = _encoder(width, height)
        frame.pts = None
        return b"".join(bytes(packet) for packet in self._encoder.encode(frame))


def _encoder(width: int, height: int) -> Any:
    encoder = av.CodecContext.create("mjpeg", "w")
    encoder.width, encoder.height, encoder.pix_fmt = width, height, "yuvj420p"
    encoder.time_base = Fraction(1, 1000)
    encoder.thread_count = 1  # several would hold pictures back
    encoder.options = {"qmin": QUALITY, "qmax": QUALITY}
    return encoder
