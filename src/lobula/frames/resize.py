"""Area average: a working pixel is the mean of the source area it covers, to the fraction of a source pixel."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..types import Image


class Rect(NamedTuple):
    """A rectangle of pixels: left column, top row, width, height."""

    x: int
    y: int
    width: int
    height: int


Resize = Callable[[NDArray[Any]], Image]
"""Takes a whole source plane (H, W) with adjacent columns, returns the working image, float32 in 0..255."""

Resizer = Callable[[int, int, Rect, int, int, float, float], Resize]
"""Makes a ``Resize`` from (source_height, source_width, crop, out_height, out_width, gain, offset)."""


def coverage(n_in: int, start: float, length: float, n_out: int) -> NDArray[np.float64]:
    """Return the (n_out, n_in) weights that average ``length`` source pixels from ``start`` into ``n_out`` equal parts.

    Each row holds the share of every source pixel in one part, and sums to 1 where the span lies inside the source.
    """
    edges = start + length * np.arange(n_out + 1) / n_out
    pixel = np.arange(n_in)
    overlap = np.minimum(edges[1:, None], pixel + 1) - np.maximum(edges[:-1, None], pixel)
    return np.asarray(np.clip(overlap, 0, None) * (n_out / length))


class AreaAverage:
    """Crop, area average and luma mapping of one kind of plane: the NumPy form of ``Resize``.

    ``image = clip(gain * mean + offset, 0, 255)``; the mapping is applied to the mean, so it costs nothing extra.
    """

    def __init__(
        self,
        source_height: int,
        source_width: int,
        crop: Rect,
        out_height: int,
        out_width: int,
        gain: float = 1.0,
        offset: float = 0.0,
    ) -> None:
        self._shape = (source_height, source_width)
        self._rows_of = slice(crop.y, crop.y + crop.height)
        self._columns_of = slice(crop.x, crop.x + crop.width)
        self._rows = _bands(gain * coverage(crop.height, 0, crop.height, out_height))
        self._columns = _bands(coverage(crop.width, 0, crop.width, out_width))
        self._offset = np.float32(offset)

    def __call__(self, plane: NDArray[Any]) -> Image:
        """Return the (out_height, out_width) float32 image of ``plane``."""
        if plane.shape != self._shape:
            raise ValueError(f"plane of {plane.shape}: made for {self._shape}")
        part = plane[self._rows_of, self._columns_of].astype(np.float32)
        image = _average_rows(np.ascontiguousarray(_average_rows(part, self._rows).T), self._columns).T
        image += self._offset
        # also takes off the 1e-5 by which float32 sums overshoot white
        return np.clip(image, 0, 255, out=np.empty(image.shape, np.float32))


_Band = tuple[slice, NDArray[np.float32]]


def _bands(weights: NDArray[np.float64]) -> list[_Band]:
    """Return, for each row of ``weights``, where it is not zero and what it holds there."""
    bands = []
    for row in weights:
        held = np.flatnonzero(row)
        span = slice(int(held[0]), int(held[-1]) + 1)
        bands.append((span, row[span].astype(np.float32)))
    return bands


def _average_rows(image: Image, bands: list[_Band]) -> Image:
    # one small product for each band: a product of whole matrices would be mostly zeros, and would start a thread pool
    averaged = np.empty((len(bands), image.shape[1]), np.float32)
    for row, (span, weights) in zip(averaged, bands, strict=True):
        np.dot(weights, image[span], out=row)
    return averaged
