"""Luminance along a wall: random upright stripes, one grey, or a strip from a picture."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError, ParameterError
from .world import WallParams

SAMPLE_CM = 0.02
"""Longest sample of a strip: a thirtieth of a fine stripe, and as wide as a pixel from 1.4 cm away."""

Floats = NDArray[np.float64]


def wall_strip(wall: WallParams, length_cm: float, rng: np.random.Generator) -> Floats:
    """Return luminance once around a wall of ``length_cm``, in samples of equal length, (n,).

    Raises
    ------
    FrameSourceError : the file of the pattern cannot be read
    ParameterError : it holds no picture
    """
    if wall.pattern == "file":
        return strip_from_file(wall.file)
    if wall.pattern == "plain":
        return np.array([(wall.dark_grey + wall.light_grey) / 2])
    return stripes(wall, length_cm, rng)


def stripes(wall: WallParams, length_cm: float, rng: np.random.Generator) -> Floats:
    """Return dark and light stripes in turn, each of a random width, closed around ``length_cm``, (n,).

    Widths are uniform between ``stripe_low_cm`` and ``stripe_high_cm``; then all are stretched alike, by less than
    half a pair of stripes over the whole length, so that as many dark as light ones fit. A sample that holds an edge
    has the mean of its parts.
    """
    mean_cm = (wall.stripe_low_cm + wall.stripe_high_cm) / 2
    count = 2 * max(round(length_cm / (2 * mean_cm)), 1)
    widths = rng.uniform(wall.stripe_low_cm, wall.stripe_high_cm, count)
    edges = np.concatenate([[0.0], np.cumsum(widths)])
    edges *= length_cm / edges[-1]
    greys = np.where(np.arange(count) % 2 == int(rng.integers(2)), wall.dark_grey, wall.light_grey)
    sums = np.concatenate([[0.0], np.cumsum(greys * np.diff(edges))])
    samples = np.linspace(0.0, length_cm, math.ceil(length_cm / SAMPLE_CM) + 1)
    means = np.diff(np.interp(samples, edges, sums)) / np.diff(samples)
    return np.asarray(np.round(means, 6))  # greys as given, not what the sums made of them


def strip_from_file(path: str | Path) -> Floats:
    """Return the luminance, 0..255, of a picture's middle row, (width,).

    Raises
    ------
    FrameSourceError : there is no such file, or it cannot be read
    ParameterError : it is no picture
    """
    # heavy: only for worlds with a file
    from ..frames.luma import Luma
    from ..frames.stills import read_still

    try:
        data = read_still(path)
    except FrameSourceError as error:
        raise FrameSourceError(f"wall.file: {error}") from error
    if data is None:
        raise ParameterError(f"wall.file = {str(path)!r}: must be a picture, such as a PNG of one row")
    luma = Luma(data)
    plane = luma.plane(data)
    row = plane[plane.shape[0] // 2].astype(np.float64)
    return np.asarray(np.clip(row * luma.gain + luma.offset, 0.0, 255.0))
