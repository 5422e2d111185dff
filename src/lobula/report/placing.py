"""A picture of any size in a frame of a fixed one: as large as it fits, in the middle."""

from __future__ import annotations

import av
import numpy as np
from av.video.reformatter import VideoReformatter
from numpy.typing import NDArray

from .canvas import Canvas


def fitted(shape: tuple[int, ...], width: int, height: int) -> tuple[int, int]:
    """Return the even height and width of a picture of ``shape`` (h, w, ...) scaled to fit into width x height."""
    scale = min(width / shape[1], height / shape[0])
    return max(2 * round(shape[0] * scale / 2), 2), max(2 * round(shape[1] * scale / 2), 2)


def place(view: Canvas, image: NDArray[np.uint8], scaler: VideoReformatter, ground: tuple[int, int, int]) -> None:
    """Put ``image`` (h, w, 3), scaled, in the middle of ``view``, with ``ground`` where it does not reach."""
    fits = fitted(image.shape, view.shape[1], view.shape[0])
    # two pixels too few are the rounding of the frame's own size
    height, width = (there if there - side <= 2 else side for side, there in zip(fits, view.shape[:2], strict=True))
    if (height, width) != view.shape[:2]:
        view[...] = ground
    top, left = (view.shape[0] - height) // 2, (view.shape[1] - width) // 2
    view[top : top + height, left : left + width] = scaled(image, height, width, scaler)


def scaled(image: NDArray[np.uint8], height: int, width: int, scaler: VideoReformatter) -> NDArray[np.uint8]:
    """Return ``image`` (h, w, 3) at another size."""
    if image.shape[:2] == (height, width):
        return image
    way = "AREA" if height < image.shape[0] else "FAST_BILINEAR"
    frame = av.VideoFrame.from_numpy_buffer(np.ascontiguousarray(image), format="rgb24")
    return np.asarray(scaler.reformat(frame, width, height, interpolation=way).to_ndarray(), np.uint8)
