"""Which part of the picture becomes the working image: rotate, flip, region of interest, fit; in that order."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..checks import MIN_HEIGHT, MIN_WIDTH
from ..errors import FrameSourceError, ParameterError
from .resize import Rect

Fit = Literal["crop", "squeeze", "pad"]
Flip = Literal["h", "v", "hv"]

GREY = 128
"""What masked and padded pixels hold, always: a constant never moves."""


@dataclass(frozen=True, kw_only=True)
class View:
    """What the user asked to look at; checked when it is made.

    ``size`` is (width, height) of the working image; ``roi`` is (x, y, width, height) in pixels of the picture after
    ``rotate`` (degrees clockwise, on top of what the container says) and ``flip`` ("h" mirrors left and right).
    ``mask`` is a path or an (H, W) array, white where the picture counts.
    """

    size: tuple[int, int] = (99, 72)
    fit: Fit = "crop"
    roi: tuple[int, int, int, int] | None = None
    mask: str | PathLike[str] | NDArray[Any] | None = None
    flip: Flip | None = None
    rotate: int = 0

    def __post_init__(self) -> None:
        if not _whole_numbers(self.size, 2) or self.size[0] < MIN_WIDTH or self.size[1] < MIN_HEIGHT:
            least = f"{MIN_WIDTH} x {MIN_HEIGHT}"
            raise ParameterError(f"size = {self.size!r}: must be (width, height) of at least {least}")
        if self.fit not in get_args(Fit):
            raise ParameterError(f"fit = {self.fit!r}: must be one of {', '.join(get_args(Fit))}")
        if self.flip is not None and self.flip not in get_args(Flip):
            raise ParameterError(f"flip = {self.flip!r}: must be one of {', '.join(get_args(Flip))}")
        if isinstance(self.rotate, bool) or self.rotate not in (0, 90, 180, 270):
            raise ParameterError(f"rotate = {self.rotate!r}: must be one of 0, 90, 180, 270 degrees clockwise")
        if self.roi is not None and not _whole_numbers(self.roi, 4):
            raise ParameterError(f"roi = {self.roi!r}: must be (x, y, width, height) in whole pixels")


@dataclass(frozen=True)
class Layout:
    """A ``View`` worked out for pictures of one size.

    ``crop`` is in pixels as decoded; ``region`` (the roi or the whole) and ``seen`` (the part of it that is looked at)
    are in pixels of the upright picture, ``width`` x ``height``. ``place`` is where that lies in the working image.
    """

    width: int
    height: int
    region: Rect
    seen: Rect
    crop: Rect
    place: Rect
    quarter_turns: int
    flip: Flip | None

    @property
    def crop_shape(self) -> tuple[int, int]:
        """(height, width) the crop is averaged to, before it is turned upright."""
        height, width = self.place.height, self.place.width
        return (width, height) if self.quarter_turns % 2 else (height, width)

    def upright(self, array: NDArray[Any]) -> NDArray[Any]:
        """Return a view of ``array`` (H, W, ...) as decoded, turned and mirrored as asked."""
        if self.quarter_turns:
            array = np.rot90(array, -self.quarter_turns)
        if self.flip in ("h", "hv"):
            array = array[:, ::-1]
        if self.flip in ("v", "hv"):
            array = array[::-1]
        return array


def lay_out(view: View, source_width: int, source_height: int, rotation: int, name: str) -> Layout:
    """Return the layout of ``view`` on pictures of the given size, whose container asks for ``rotation`` clockwise.

    Raises
    ------
    ParameterError : the region of interest leaves the picture or is too small
    FrameSourceError : the picture is under 32 x 24
    """
    turns = (view.rotate + rotation) // 90 % 4
    width, height = (source_height, source_width) if turns % 2 else (source_width, source_height)
    if width < MIN_WIDTH or height < MIN_HEIGHT:
        raise FrameSourceError(f"{name}: picture of {width} x {height} px: must be at least {MIN_WIDTH} x {MIN_HEIGHT}")
    region = Rect(0, 0, width, height) if view.roi is None else _region(Rect(*view.roi), width, height, name)
    seen, place = _fit(region, view.size, view.fit)
    crop = _as_decoded(seen, width, height, turns, view.flip)
    return Layout(width, height, region, seen, crop, place, turns, view.flip)


def _whole_numbers(values: object, count: int) -> bool:
    return (
        isinstance(values, tuple | list)
        and len(values) == count
        and all(isinstance(v, int | np.integer) and not isinstance(v, bool) for v in values)
    )


def _region(roi: Rect, width: int, height: int, name: str) -> Rect:
    inside = roi.x >= 0 and roi.y >= 0 and roi.x + roi.width <= width and roi.y + roi.height <= height
    if not inside or roi.width < MIN_WIDTH or roi.height < MIN_HEIGHT:
        raise ParameterError(
            f"roi = {tuple(roi)}: must be (x, y, width, height) inside the {width} x {height} px of {name}, "
            f"at least {MIN_WIDTH} x {MIN_HEIGHT}"
        )
    return roi


def _fit(region: Rect, size: tuple[int, int], fit: Fit) -> tuple[Rect, Rect]:
    """Return the part of ``region`` that is looked at, and where it lies in the working image."""
    out_width, out_height = size
    x, y, width, height = region
    wider = width * out_height > height * out_width
    whole = Rect(0, 0, out_width, out_height)
    if fit == "squeeze":
        return region, whole
    if fit == "crop":
        if wider:
            kept = max(1, round(height * out_width / out_height))
            return Rect(x + (width - kept) // 2, y, kept, height), whole
        kept = max(1, round(width * out_height / out_width))
        return Rect(x, y + (height - kept) // 2, width, kept), whole
    if wider:
        kept = max(1, round(out_width * height / width))
        return region, Rect(0, (out_height - kept) // 2, out_width, kept)
    kept = max(1, round(out_height * width / height))
    return region, Rect((out_width - kept) // 2, 0, kept, out_height)


def _as_decoded(rect: Rect, width: int, height: int, turns: int, flip: Flip | None) -> Rect:
    """Take a rectangle of the upright picture back to the picture as decoded: undo the flip, then each turn."""
    x, y, w, h = rect
    if flip in ("h", "hv"):
        x = width - x - w
    if flip in ("v", "hv"):
        y = height - y - h
    for _ in range(turns):
        x, y, w, h = y, width - x - w, h, w
        width, height = height, width
    return Rect(x, y, w, h)
