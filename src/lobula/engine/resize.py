"""The area average of the C core: from a decoder's luma plane to the working image in one pass."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeError
from ..types import Image
from .core import TYPES, Memory
from .library import isa_index, library
from .structures import Images, ResizeSpec


class CoreAreaAverage:
    """Crop, area average and luma mapping of one kind of plane; the same as ``frames.AreaAverage`` to float32 rounding.

    ``image = clip(gain * mean + offset, 0, 255)``; ``crop`` is (x, y, width, height). One thread at a time.

    Raises
    ------
    ShapeError : a crop that leaves the source, or a side that the core does not take
    """

    def __init__(
        self, source_height: int, source_width: int, crop: tuple[int, int, int, int], out_height: int, out_width: int,
        gain: float = 1.0, offset: float = 0.0,
    ) -> None:  # fmt: skip
        self._core = library()
        self._shape = (source_height, source_width)
        self._out = (out_height, out_width)
        spec = ResizeSpec(source_width, source_height, *crop, out_width, out_height, gain, offset)
        size = int(self._core.lobula_resize_size(ctypes.byref(spec)))
        if not size:
            raise ShapeError(
                f"resize: {tuple(crop)} of {source_width} x {source_height} to {out_width} x {out_height} "
                "px: must lie inside the source, sides of at most 32768"
            )
        self._plan = Memory(size)
        self._core.lobula_resize_init(self._plan.address, ctypes.byref(spec), isa_index())

    def __call__(self, plane: NDArray[Any]) -> Image:
        """Return the (out_height, out_width) float32 image of ``plane`` (H, W), uint8 or float32."""
        if plane.shape != self._shape:
            raise ValueError(f"plane of {plane.shape}: made for {self._shape}")
        if plane.strides[1] != plane.itemsize:
            plane = np.ascontiguousarray(plane)
        image = np.empty(self._out, np.float32)
        source = Images(pixels=plane.ctypes.data, row_bytes=plane.strides[0], type=TYPES[plane.dtype])
        status = self._core.lobula_resize(self._plan.address, ctypes.byref(source), image.ctypes.data)
        if status:
            raise RuntimeError(f"the C core's resize failed with code {status}")
        return image
