"""Frames that are in memory already, or in a file of NumPy arrays."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import require_images, require_later, require_not_unit_range
from ..errors import FrameSourceError, ShapeError
from .selection import Picture

DEFAULT_RATE_HZ = 30.0


class ArrayReader:
    """Reads (T, H, W) images, uint8 or float luma in 0..255; times as given, or ``index / rate_hz``.

    Raises
    ------
    ShapeError : the images are not what the network reads, or there are not as many times as images
    TimeError : the times do not increase
    """

    def __init__(
        self,
        images: Any,
        times_s: Sequence[float] | NDArray[Any] | None = None,
        rate_hz: float | None = None,
        name: str = "array",
    ) -> None:
        self.name = name
        self._images = require_images(images, (3,), self.name)
        require_not_unit_range(self._images, self.name)
        count = len(self._images)
        times = np.arange(count) / (rate_hz or DEFAULT_RATE_HZ) if times_s is None else np.asarray(times_s, np.float64)
        if times.shape != (count,):
            raise ShapeError(f"{self.name}: times_s of shape {times.shape}: must be ({count},), one for each image")
        previous_s: float | None = None
        for i, time_s in enumerate(times.tolist()):
            previous_s = require_later(time_s, previous_s, f"{self.name}: frame {i}")
        self._times_s = times.tolist()
        self.fps = (count - 1) / (self._times_s[-1] - self._times_s[0]) if count > 1 else 0.0
        self.frame_count: int | None = count
        self.rotation = 0
        self.first = self._images[0]
        self.damaged = 0
        self.notes: list[str] = []

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield the images in order."""
        for i, time_s in enumerate(self._times_s):
            yield Picture(self._images[i], time_s, i)

    def close(self) -> None:
        """Nothing to let go of."""


def open_npz(path: str, rate_hz: float | None = None) -> ArrayReader:
    """Open a ``.npz`` with ``images`` (T, H, W) and, unless ``rate_hz`` is given, their ``times_s`` (T,) if it has any.

    Such a file is what ``lobula stimulus`` writes, or ``np.savez(path, images=images, times_s=times_s)``.

    Raises
    ------
    FrameSourceError : it cannot be read, or holds no ``images``
    ShapeError, TimeError : as ``ArrayReader``
    """
    allowed = "must be a file of numpy.savez with images (T, H, W) and, if they have any, times_s (T,)"
    try:
        with np.load(Path(path), allow_pickle=False) as file:
            if "images" not in file:
                trace = "; a trace is for lobula plot and serve" if "trace" in file else ""
                raise FrameSourceError(f"{path}: holds no images: {allowed}{trace}")
            times_s = file["times_s"].astype(np.float64) if rate_hz is None and "times_s" in file else None
            images = file["images"]
    except FrameSourceError:
        raise
    except Exception as error:  # a damaged file can raise what its zip, its compressor, its headers or its size will
        raise FrameSourceError(f"{path}: {getattr(error, 'strerror', None) or 'not such a file'}: {allowed}") from error
    return ArrayReader(images, times_s, rate_hz, path)


def holds_images(path: Path) -> bool:
    """Whether a file is one that ``open_npz`` is for."""
    try:
        with zipfile.ZipFile(path) as file:
            return "images.npy" in file.namelist()
    except (OSError, zipfile.BadZipFile):
        return False
