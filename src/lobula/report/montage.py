"""Several small pictures on one sheet, each with a line of text: maps of the layers, frames of a movie."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..types import Image
from .canvas import Canvas, rgb, text
from .palette import DARK

_GAP, _CAPTION = 12, 26
_GROUND, _TEXT, _ABOVE, _BELOW = rgb(DARK.ground), rgb(DARK.text), rgb("#ff9f4d"), rgb("#58a9ff")


class Tile(NamedTuple):
    """One picture of a sheet: (h, w) grey or (h, w, 3) RGB, uint8, and what it says below."""

    picture: NDArray[np.uint8]
    caption: str


def montage(tiles: Sequence[Tile], columns: int, tile_width: int = 198) -> Canvas:
    """Return a sheet of ``tiles``, all of one shape, row by row; pixels are repeated up to about ``tile_width``."""
    height, width = tiles[0].picture.shape[:2]
    scale = max(1, round(tile_width / width))
    height, width = height * scale, width * scale
    rows = -(-len(tiles) // columns)
    sheet = np.full((rows * (height + _CAPTION) + _GAP, columns * (width + _GAP) + _GAP, 3), _GROUND, np.uint8)
    for number, (picture, caption) in enumerate(tiles):
        row, column = divmod(number, columns)
        top, left = _GAP + row * (height + _CAPTION), _GAP + column * (width + _GAP)
        large = picture.repeat(scale, axis=0).repeat(scale, axis=1)
        sheet[top : top + height, left : left + width] = large if large.ndim == 3 else large[:, :, None]
        text(sheet, caption, top + height + 6, left, _TEXT, _GROUND, size_px=8)
    return sheet


def map_picture(image: Image) -> NDArray[np.uint8]:
    """Return a map (H, W) as RGB: grey for zero, orange above, blue below, full colour at the largest magnitude."""
    largest = float(np.abs(image).max())
    share = image[:, :, None] / np.float32(largest or 1.0)
    ground = np.array(rgb(DARK.panel), np.float32)
    above, below = (np.array(colour, np.float32) - ground for colour in (_ABOVE, _BELOW))
    coloured = ground + np.clip(share, 0, 1) * above + np.clip(-share, 0, 1) * below
    return np.asarray(np.rint(coloured), np.uint8)
