"""JPEGs of pictures as they were decoded, one after the other, without a detour through colour arrays."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import av
import numpy as np
from av.video.reformatter import ColorRange, VideoReformatter
from numpy.typing import NDArray

from ..frames.geometry import Layout
from ..frames.source import Decoded

QUALITY = "5"
"""The quantiser of MJPEG, 2 (best) to 31."""

_TICK = Fraction(1, 1000)


class LiveJpeg:
    """Makes JPEGs at most ``width`` px wide, upright. For one thread; most of the work lets other threads run."""

    def __init__(self, width: int = 640) -> None:
        self._width = width
        self._scaler = VideoReformatter()
        self._encoder: Any = None
        self._count = 0

    def __call__(self, decoded: Decoded) -> bytes:
        """Return the picture as a JPEG."""
        frame = self._small(decoded)
        if decoded.layout.quarter_turns or decoded.layout.flip:
            frame = _upright(frame, decoded.layout)
        if self._encoder is None or (self._encoder.width, self._encoder.height) != (frame.width, frame.height):
            self._encoder = _encoder(frame.width, frame.height)
        self._count += 1
        frame.pts, frame.time_base = self._count, _TICK  # the encoder refuses stamps that do not increase
        return b"".join(bytes(packet) for packet in self._encoder.encode(frame))

    def _small(self, decoded: Decoded) -> Any:
        """The picture in full-range YUV 4:2:0, no wider than asked for once it is upright; even sides."""
        data = decoded.data
        if isinstance(data, np.ndarray):
            grey = np.clip(np.rint(data), 0, 255).astype(np.uint8)
            data = av.VideoFrame.from_ndarray(np.ascontiguousarray(grey), "gray")
        scale = min(1.0, self._width / decoded.layout.width)
        width, height = (max(2 * round(side * scale / 2), 2) for side in (data.width, data.height))
        way = "AREA" if scale < 1 else "FAST_BILINEAR"
        return self._scaler.reformat(
            data, width, height, "yuvj420p", dst_color_range=ColorRange.JPEG, interpolation=way
        )


def _encoder(width: int, height: int) -> Any:
    encoder = av.CodecContext.create("mjpeg", "w")
    encoder.width, encoder.height, encoder.pix_fmt = width, height, "yuvj420p"
    encoder.time_base = _TICK
    encoder.thread_count = 1  # several would hold pictures back
    encoder.options = {"qmin": QUALITY, "qmax": QUALITY}
    return encoder


def _upright(frame: Any, layout: Layout) -> Any:
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
