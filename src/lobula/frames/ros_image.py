"""Pictures out of the standard image messages of ROS, whichever library made them: from a bag, or live in a node."""

from __future__ import annotations

from typing import Any

import av
import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError

RAW, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"

LAYOUTS = {
    "mono8": ("gray", 1), "8uc1": ("gray", 1), "rgb8": ("rgb24", 3), "bgr8": ("bgr24", 3), "8uc3": ("bgr24", 3),
    "rgba8": ("rgba", 4), "bgra8": ("bgra", 4),
}  # fmt: skip
"""Encoding of an Image, in lower case -> pixel format and bytes a pixel. 8UC3 counts as blue first, as in OpenCV."""

_SIGNS = {b"\xff\xd8": "mjpeg", b"\x89P": "png"}
"""First bytes of a compressed picture -> its decoder; what the message calls its format is written in many ways."""


class DamagedError(Exception):
    """One picture cannot be had; the next one may."""


class RosImages:
    """Turns Image and CompressedImage messages into what the rest of ``frames`` reads.

    A grey picture is an (H, W) array, any other a PyAV video frame.
    """

    def __init__(self, where: str) -> None:
        self._where = where
        self._decoders: dict[str, Any] = {}

    def __call__(self, message: Any) -> Any:
        """Return the picture of ``message``.

        Raises
        ------
        DamagedError : its data is cut short or cannot be decoded
        FrameSourceError : its encoding is none that is read
        """
        return self._raw(message) if hasattr(message, "encoding") else self._compressed(message)

    def _raw(self, message: Any) -> Any:
        layout = LAYOUTS.get(message.encoding.lower())
        if layout is None:
            raise FrameSourceError(
                f"{self._where}: encoding {message.encoding!r}: must be mono8, rgb8, bgr8, rgba8, bgra8, 8UC1 or 8UC3"
            )
        pixel_format, depth = layout
        height, width, step = message.height, message.width, message.step
        data = _bytes(message.data)
        if not (height and width) or step < width * depth or data.size < height * step:
            raise DamagedError(f"{data.size} bytes are no {width} x {height} picture of {step} bytes a row")
        rows = data[: height * step].reshape(height, step)[:, : width * depth]
        if depth == 1:
            return rows
        return av.VideoFrame.from_ndarray(np.ascontiguousarray(rows).reshape(height, width, depth), pixel_format)

    def _compressed(self, message: Any) -> Any:
        data = _bytes(message.data).tobytes()
        name = _SIGNS.get(data[:2])
        if name is None:
            told = message.format.lower()
            if "depth" not in told and any(word in told for word in ("jpeg", "jpg", "png")):
                raise DamagedError(f"no {message.format} picture")
            raise FrameSourceError(f"{self._where}: format {message.format!r}: must be jpeg or png")
        packet = av.Packet(data)
        packet.is_keyframe = True  # else the decoder of PNG takes it for what changed since the last one
        try:
            frames = self._decoder(name).decode(packet)
        except av.FFmpegError as error:
            raise DamagedError(error.strerror or str(error)) from error
        if not frames or frames[0].is_corrupt:
            raise DamagedError("its data is cut short")
        return frames[0]

    def _decoder(self, name: str) -> Any:
        if name not in self._decoders:
            decoder: Any = av.CodecContext.create(name, "r")
            decoder.thread_count = 1  # several would hold pictures back
            self._decoders[name] = decoder
        return self._decoders[name]


def _bytes(data: Any) -> NDArray[np.uint8]:
    """Return the data of a message, an array or an ``array.array``, as bytes; no copy."""
    return np.frombuffer(data, np.uint8)
