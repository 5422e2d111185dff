"""The corners of a black square to a few hundredths of a pixel: a line through each of its four edges.

An edge is looked at along profiles across it. Where it lies on a profile follows from how much of the profile is dark,
which blur does not move; the line through these points averages the noise out; lines that meet make the corners.

Source: Wang and Olson, AprilTag 2: Efficient and robust fiducial detection, IROS 2016 (the idea of edge refinement).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .opencv import load_opencv

_ALONG = np.linspace(0.12, 0.88, 24)  # of the edge: near the corners the other edge would be seen
_IN_CELLS, _OUT_CELLS = 0.5, 0.6  # across the edge: away from the cells within the border and the disc's rim without
_ACROSS = np.linspace(-_IN_CELLS, _OUT_CELLS, 25)
_ENDS = 4  # samples at either end of a profile that tell how dark and how bright it is
_ROUNDS = 2  # the second round starts where the first one ended: profiles centred on the edge
_CONTRAST_GREY = 15.0


def refine_corners(image: NDArray[np.uint8], corners_px: NDArray[Any], cells: int) -> NDArray[np.float64]:
    """Return the corners (M, 4, 2) of dark squares of ``cells`` x ``cells``, given to about a pixel, sharper.

    A square whose edges cannot be told (hardly any contrast, a shape that runs away) comes back as NaN.
    """
    rough = np.asarray(corners_px, np.float64)
    corners = rough
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(_ROUNDS):
            corners = _fitted(image, corners, cells)
        cell = np.linalg.norm(np.roll(rough, -1, axis=1) - rough, axis=-1).mean(axis=1) / cells
        moved = np.abs(corners - rough).max(axis=(1, 2))
    return np.where((moved < cell)[:, None, None], corners, np.nan)


def _fitted(image: NDArray[np.uint8], corners: NDArray[np.float64], cells: int) -> NDArray[np.float64]:
    edge = np.roll(corners, -1, axis=1) - corners  # (M, 4, 2): from each corner to the next
    length = np.linalg.norm(edge, axis=-1, keepdims=True)
    outward = np.stack([edge[..., 1], -edge[..., 0]], axis=-1) / length
    middle = corners.mean(axis=1, keepdims=True)
    outward *= np.sign(np.sum((corners + edge / 2 - middle) * outward, axis=-1, keepdims=True))
    cell = length.mean(axis=1, keepdims=True) / cells  # (M, 1, 1)
    offset = _edge_offsets(image, corners, edge, outward, cell)
    # offset = level + slope (along - 1/2), least squares
    arm = _ALONG - _ALONG.mean()
    level, slope = offset.mean(axis=-1), offset @ arm / (arm @ arm)
    start = corners + outward * (level - slope * _ALONG.mean())[..., None]
    direction = edge + outward * slope[..., None]
    # each corner is where the line before it and its own meet
    before, before_direction = np.roll(start, 1, axis=1), np.roll(direction, 1, axis=1)
    way = _cross(start - before, direction) / _cross(before_direction, direction)
    return np.asarray(before + before_direction * way[..., None])


def _edge_offsets(
    image: NDArray[np.uint8], corners: NDArray[np.float64], edge: NDArray[np.float64], outward: NDArray[np.float64],
    cell: NDArray[np.float64],
) -> NDArray[np.float64]:  # fmt: skip
    """How far outward of each edge the change from dark to bright lies, (M, 4, along)."""
    points = (corners[:, :, None] + edge[:, :, None] * _ALONG[:, None])[:, :, :, None]
    points = points + (outward * cell)[:, :, None, None] * _ACROSS[:, None]  # (M, 4, along, across, 2)
    column, row = np.moveaxis(points.reshape(-1, len(_ACROSS), 2), -1, 0).astype(np.float32)
    cv2 = load_opencv()
    grey = cv2.remap(image, column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    grey = grey.reshape(points.shape[:-1]).astype(np.float64)
    dark = np.median(grey[..., :_ENDS], axis=(1, 2, 3), keepdims=True)
    bright = np.median(grey[..., -_ENDS:], axis=(1, 2, 3), keepdims=True)
    contrast = np.where(bright - dark > _CONTRAST_GREY, bright - dark, np.nan)
    share = np.clip((bright - grey) / contrast, -0.5, 1.5).mean(axis=-1)
    return np.asarray((share * (_IN_CELLS + _OUT_CELLS) - _IN_CELLS) * cell)


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
