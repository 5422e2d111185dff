"""Checks at the borders: images and times are looked at once, here; the loops below trust."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import ShapeError, TimeError

MIN_WIDTH, MIN_HEIGHT = 32, 24
"""Smallest image the network reads, px: below it the 9 x 9 surround covers most of the picture."""


def require_images(images: Any, ndims: tuple[int, ...], where: str) -> NDArray[Any]:
    """Return ``images`` as a uint8 or float32 array of one of the allowed ranks, or say in one line what is wrong.

    Accepted: uint8, or float16/32/64 in 0..255. Refused, with the conversion that mends it: colour arrays, float
    images in 0..1, other dtypes, values that are not finite or lie outside 0..255, images under 32 x 24.

    Raises
    ------
    ShapeError : any of the above
    """
    a = np.asarray(images)
    hint = "; colour: use image[..., :3] @ [0.299, 0.587, 0.114]" if a.ndim > 2 and a.shape[-1] in (3, 4) else ""
    if a.ndim not in ndims:
        wanted = " or ".join({2: "(H, W)", 3: "(T, H, W)", 4: "(S, T, H, W)"}[n] for n in ndims)
        raise ShapeError(f"{where}: shape {a.shape}: must be {wanted} luminance{hint}")
    if (a.ndim >= 3 and a.shape[-1] in (1, 3, 4)) or min(a.shape, default=0) == 0:
        raise ShapeError(
            f"{where}: shape {a.shape}: must be luminance of at least {MIN_HEIGHT} rows x {MIN_WIDTH} columns{hint}"
        )
    if a.shape[-2] < MIN_HEIGHT or a.shape[-1] < MIN_WIDTH:
        raise ShapeError(
            f"{where}: {a.shape[-1]} x {a.shape[-2]} px (width x height): must be at least {MIN_WIDTH} x {MIN_HEIGHT}"
        )
    if a.dtype == np.uint8:
        return a
    if a.dtype.kind != "f":
        raise ShapeError(f"{where}: dtype {a.dtype}: must be uint8 or float in 0..255; use image.astype('float32')")
    low, high = float(a.min()), float(a.max())
    if not (math.isfinite(low) and math.isfinite(high)):
        raise ShapeError(f"{where}: holds NaN or infinity: every value must be finite, in 0..255")
    if low < 0 or high > 255:
        raise ShapeError(f"{where}: values {low:g}..{high:g}: must lie in 0..255")
    return a.astype(np.float32, copy=False)


def require_not_unit_range(image: NDArray[Any], where: str) -> None:
    """Refuse a float image that is scaled to 0..1: it would look like a black scene.

    Raises
    ------
    ShapeError : a float image with more than one value, all of them in 0..1
    """
    if image.dtype.kind == "f":
        low, high = float(image.min()), float(image.max())
        if 0.0 <= low < high <= 1.0:
            raise ShapeError(f"{where}: float values {low:g}..{high:g} look like 0..1: must be 0..255; use image * 255")


def require_later(time_s: float, previous_s: float | None, where: str) -> float:
    """Return ``time_s`` as a float if it is finite and after ``previous_s``.

    Raises
    ------
    TimeError : the stamp stands still, runs backwards or is no finite number
    """
    try:
        t = float(time_s)
    except (TypeError, ValueError) as error:
        raise TimeError(f"{where}: time {time_s!r}: must be a number of seconds") from error
    if not math.isfinite(t):
        raise TimeError(f"{where}: time {t!r} s: must be finite")
    if previous_s is not None and t <= previous_s:
        word = "stands still" if t == previous_s else "runs backwards"
        raise TimeError(f"{where}: time {word}: {t:.6f} s after {previous_s:.6f} s: must increase")
    return t
