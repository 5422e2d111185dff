"""The mask: which working pixels are ignored, such as a car's bonnet or a clock burnt into the picture."""

from __future__ import annotations

from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError, ParameterError
from .geometry import Layout
from .luma import Luma
from .resize import Rect, coverage

_WHITE = 128
_TOUCHED = 1e-3  # a share of a working pixel below which the cover is rounding, not a mask


def ignored_pixels(
    mask: str | PathLike[str] | NDArray[Any], layout: Layout, size: tuple[int, int]
) -> NDArray[np.bool_]:
    """Return the (H, W) working pixels to ignore: those that any black part of ``mask`` touches.

    The mask is stretched over the region of interest as seen after rotation and flip; one exactly as large as the
    whole upright picture is cut by the region instead. Values of 128 and more keep the picture, lower ones ignore it.

    Raises
    ------
    FrameSourceError : the mask cannot be read
    ParameterError : the mask is not a grey (H, W) array, has another shape than the picture, or leaves nothing
    """
    where = "mask" if isinstance(mask, np.ndarray) else f"mask {mask}"
    image = mask if isinstance(mask, np.ndarray) else _read(mask)
    if image.ndim != 2 or image.size == 0:
        raise ParameterError(f"{where}: shape {image.shape}: must be (H, W), white where the picture counts")
    keep = (image if image.dtype == bool else image >= _WHITE).astype(np.float64)
    region, seen, place = layout.region, layout.seen, layout.place
    if keep.shape == (layout.height, layout.width):
        keep = keep[region.y : region.y + region.height, region.x : region.x + region.width]
    else:
        _require_shape(keep.shape, region, where)
    across, down = keep.shape[1] / region.width, keep.shape[0] / region.height
    rows = coverage(keep.shape[0], (seen.y - region.y) * down, seen.height * down, place.height)
    columns = coverage(keep.shape[1], (seen.x - region.x) * across, seen.width * across, place.width)
    ignored = np.zeros((size[1], size[0]), bool)
    inner = ignored[place.y : place.y + place.height, place.x : place.x + place.width]
    inner[:] = rows @ keep @ columns.T < 1 - _TOUCHED
    if inner.all():
        raise ParameterError(f"{where}: ignores the whole picture: must be white where the picture counts")
    return ignored


def _require_shape(shape: tuple[int, ...], region: Rect, where: str) -> None:
    """Refuse a mask that is not the region at some scale, each side rounded by less than a pixel."""
    height, width = shape
    if abs(width * region.height - height * region.width) > region.width + region.height:
        raise ParameterError(
            f"{where}: {width} x {height} px over a picture of {region.width} x {region.height}: must "
            "have the same shape, at any scale"
        )


def _read(path: str | PathLike[str]) -> NDArray[Any]:
    from .stills import read_still

    data = read_still(path)
    if data is None:
        raise FrameSourceError(f"mask {path}: not an image: must be a PNG or other picture")
    luma = Luma(data)
    return luma.plane(data) * luma.gain + luma.offset
