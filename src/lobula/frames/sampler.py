"""From a decoded picture to the working image: luma, area average, upright, padding, mask."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError
from ..types import Image
from .geometry import GREY, View, lay_out
from .luma import FULL, Luma, kind_of
from .mask import ignored_pixels
from .resize import AreaAverage, Rect, Resizer


class Sampler:
    """Makes working images (H, W) of pictures of one size; uint8 where nothing had to be computed, else float32.

    The picture is averaged as decoded and turned upright afterwards, when it is small: turning and averaging commute.
    """

    def __init__(self, view: View, data: Any, rotation: int, name: str, resizer: Resizer | None = None) -> None:
        self.kind = kind_of(data)
        self.layout = lay_out(view, self.kind[0], self.kind[1], rotation, name)
        self._size = view.size
        self._resizer = resizer
        self._ignored = None if view.mask is None else ignored_pixels(view.mask, self.layout, view.size)
        self._prepare(data)

    def adapt(self, data: Any, where: str) -> None:
        """Take on a picture of another pixel format.

        Raises
        ------
        FrameSourceError : its size changed
        """
        kind = kind_of(data)
        if kind[:2] != self.kind[:2]:
            was = f"{self.kind[0]} x {self.kind[1]}"
            raise FrameSourceError(
                f"{where}: picture is {kind[0]} x {kind[1]} px after {was}: must stay the same", on_the_way=True
            )
        self.kind = kind
        self._prepare(data)

    def __call__(self, data: Any) -> NDArray[np.uint8] | Image:
        """Return the working image of ``data``: luminance in 0..255, memory of its own."""
        plane = self._luma.plane(data)
        if self._as_it_is:
            x, y, width, height = self.layout.crop
            image = plane[y : y + height, x : x + width].copy()
        else:
            image = self._resize(plane)
        image = self.layout.upright(image)
        place = self.layout.place
        if (place.width, place.height) != self._size:
            padded = np.full((self._size[1], self._size[0]), GREY, image.dtype)
            padded[place.y : place.y + place.height, place.x : place.x + place.width] = image
            image = padded
        image = np.ascontiguousarray(image)
        if self._ignored is not None:
            image[self._ignored] = GREY
        return image

    def rgb(self, data: Any) -> NDArray[np.uint8]:
        """Return the whole picture of ``data``, upright, (H, W, 3)."""
        return np.ascontiguousarray(self.layout.upright(self._luma.rgb(data)))

    def _prepare(self, data: Any) -> None:
        self._luma = luma = Luma(data)
        crop = self.layout.crop
        height, width = self.layout.crop_shape
        self._as_it_is = (crop.height, crop.width) == (height, width) and (luma.gain, luma.offset) == FULL
        if not self._as_it_is:
            in_memory = isinstance(data, np.ndarray) and data.dtype != np.uint8  # a given resizer reads uint8 planes
            make = AreaAverage if self._resizer is None or in_memory else self._resizer
            self._resize = make(self.kind[1], self.kind[0], Rect(*crop), height, width, luma.gain, luma.offset)
