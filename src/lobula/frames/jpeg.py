"""JPEGs of whole pictures, for those who store, send or show them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import av
import numpy as np
from av.video.reformatter import ColorRange, VideoReformatter
from numpy.typing import NDArray

from .geometry import Layout
from .source import Decoded

QUALITY = "5"
"""The quantiser of MJPEG, 2 (best) to 31."""

_TICK = Fraction(1, 1000)


class Jpeg:
    """Makes JPEGs at most ``width`` px wide, one after the other. For one thread, beside which others can run."""

    def __init__(self, width: int = 640) -> None:
        self._width = width
        self._scaler = VideoReformatter()
        self._encoder: Any = None
        self._count = 0

    def __call__(self, picture: NDArray[np.uint8] | Decoded) -> bytes:
        """Return an (h, w, 3) RGB picture, or one as it was decoded, as a JPEG: upright, its sides even."""
        if isinstance(picture, Decoded):
            frame = _upright(self._small(_frame(picture.data), picture.layout.width), picture.layout)
        else:
            frame = self._small(_frame(picture), picture.shape[1])
        if self._encoder is None or (self._encoder.width, self._encoder.height) != (frame.width, frame.height):
            self._encoder = _encoder(frame.width, frame.height)
        self._count += 1
        frame.pts, frame.time_base = self._count, _TICK  # the encoder refuses stamps that do not increase
        return b"".join(bytes(packet) for packet in self._encoder.encode(frame))

    def _small(self, frame: Any, upright_width: int) -> Any:
        """The picture in full-range YUV 4:2:0, no wider than asked for once it is upright; even sides."""
        scale = min(1.0, self._width / upright_width)
        width, height = (max(2 * round(side * scale / 2), 2) for side in (frame.width, frame.height))
        way = "AREA" if scale < 1 else "FAST_BILINEAR"
        return self._scaler.reformat(
            frame, width, height, "yuvj420p", dst_color_range=ColorRange.JPEG, interpolation=way
        )


def _frame(data: Any) -> Any:
    """What a decoder gave, grey values or an RGB picture as a frame of FFmpeg's."""
    if not isinstance(data, np.ndarray):
        return data
    if data.ndim == 3:
        return av.VideoFrame.from_ndarray(np.ascontiguousarray(data), "rgb24")
    grey = np.clip(np.rint(data), 0, 255).astype(np.uint8)
    return av.VideoFrame.from_ndarray(np.ascontiguousarray(grey), "gray")


def _encoder(width: int, height: int) -> Any:
    encoder = av.CodecContext.create("mjpeg", "w")
    encoder.width, encoder.height, encoder.pix_fmt = width, height, "yuvj420p"
    encoder.time_base = _TICK
    encoder.thread_count = 1  # several would hold pictures back
    encoder.options = {"qmin": QUALITY, "qmax": QUALITY}
    return encoder


def _upright(frame: Any, layout: Layout) -> Any:
    if not layout.quarter_turns and not layout.flip:
        return frame
    planes = [layout.upright(_rows(plane)) for plane in frame.planes]
    height, width = planes[0].shape
    turned = av.VideoFrame(width, height, "yuvj420p")
    for plane, pixels in zip(turned.planes, planes, strict=True):
        rows = np.zeros((plane.height, plane.line_size), np.uint8)
        rows[:, : plane.width] = pixels
        plane.update(rows.tobytes())
    return turned


def _rows(plane: Any) -> NDArray[np.uint8]:
    return np.frombuffer(plane, np.uint8).reshape(-1, plane.line_size)[: plane.height, : plane.width]
