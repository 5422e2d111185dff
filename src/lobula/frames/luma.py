"""Full-range luminance, whatever the pixel format: the decoder's own Y plane where there is one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

LIMITED = (255 / 219, -16 * 255 / 219)
"""Gain and offset that take limited-range luma (16 black, 235 white) to 0..255. Source: ITU-R BT.601."""

FULL = (1.0, 0.0)

_MPEG_RANGE, _JPEG_RANGE = 1, 2  # AVColorRange: what a container may say of its luma
_PACKED_LUMA = {"yuyv422": 0, "yvyu422": 0, "uyvy422": 1}  # first Y byte of a packed row; every second byte is Y


def kind_of(data: Any) -> tuple[int, int, str, int]:
    """Return (width, height, pixel format, colour range) of a decoded picture or an (H, W) array."""
    if isinstance(data, np.ndarray):
        return data.shape[1], data.shape[0], str(data.dtype), _JPEG_RANGE
    return data.width, data.height, data.format.name, int(data.color_range)


class Luma:
    """How to read luminance from one kind of picture, chosen once from its first example.

    ``plane(data)`` is an (H, W) array whose values ``gain * v + offset`` are luma in 0..255; it is a view into the
    decoder's memory for planar 8-bit YUV and grey, so use it before the next picture is asked for.
    """

    def __init__(self, data: Any) -> None:
        self._to: str | None = None
        self._reformatters: dict[str, Any] = {}
        self._shift, self._step, self._first = 0, 1, 0
        self.gain, self.offset = FULL
        if isinstance(data, np.ndarray):
            return
        fmt = data.format
        parts = fmt.components
        bits = parts[0].bits
        grey = fmt.name.startswith("gray")
        alone = parts[0].plane == 0 and all(c.plane != 0 for c in parts[1:])  # plane 0 holds Y and nothing else
        coloured = fmt.is_rgb or fmt.has_palette or bits < 8 or fmt.name.startswith(("ya", "grayf", "xyz"))
        if coloured:
            self._to = "gray"  # swscale writes grey in full range
            return
        full = fmt.name.startswith("yuvj") or int(data.color_range) == _JPEG_RANGE
        full = full or (grey and int(data.color_range) != _MPEG_RANGE)
        self.gain, self.offset = FULL if full else LIMITED
        if fmt.name in _PACKED_LUMA:
            self._first, self._step = _PACKED_LUMA[fmt.name], 2
        elif not alone or bits > 16:
            self._to = "yuv444p"
        elif bits > 8:
            # P010 and its family keep the value in the upper bits, the planar formats in the lower ones
            self._shift = 8 if fmt.name.startswith(("p0", "p2", "p4")) else bits - 8
        self._order = ">u2" if fmt.is_big_endian else "<u2"

    def plane(self, data: Any) -> NDArray[Any]:
        """Return the luminance plane (H, W) of ``data``; uint8, or the array itself for an in-memory source."""
        if isinstance(data, np.ndarray):
            return data
        if self._to:
            data = self._reformat(data, self._to)
        y = data.planes[0]
        rows = np.frombuffer(y, np.uint8).reshape(-1, y.line_size)[: data.height]
        if self._shift:
            deep = rows.view(self._order)[:, : data.width]
            return (deep >> self._shift).astype(np.uint8)
        if self._step > 1:
            return np.ascontiguousarray(rows[:, self._first : self._first + self._step * data.width : self._step])
        return rows[:, : data.width]

    def rgb(self, data: Any) -> NDArray[np.uint8]:
        """Return the colour picture (H, W, 3) uint8 of ``data``."""
        if isinstance(data, np.ndarray):
            grey = np.clip(np.rint(data), 0, 255).astype(np.uint8)
            return np.repeat(grey[:, :, None], 3, axis=2)
        return np.asarray(self._reformat(data, "rgb24").to_ndarray(), np.uint8)

    def _reformat(self, data: Any, pixel_format: str) -> Any:
        if pixel_format not in self._reformatters:
            from av.video.reformatter import VideoReformatter

            self._reformatters[pixel_format] = VideoReformatter()  # keeps its set-up from frame to frame
        return self._reformatters[pixel_format].reformat(data, format=pixel_format)
