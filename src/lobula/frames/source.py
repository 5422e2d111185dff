"""What every source has in common: pictures in, sampled frames out, the full picture on request."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from types import TracebackType
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError
from ..types import Frame
from .geometry import Layout, View
from .luma import kind_of
from .resize import Resizer
from .sampler import Sampler
from .selection import Picture, Selection, increasing


class Reader(Protocol):
    """Where pictures come from; one class for each kind of source.

    ``first`` is the first picture's data, decoded when the reader was made, and is delivered again by ``pictures``.
    """

    name: str
    fps: float
    frame_count: int | None
    first: Any

    @property
    def rotation(self) -> int:
        """What the container asks for, degrees clockwise."""

    @property
    def damaged(self) -> int:
        """How many pictures could not be decoded."""

    @property
    def notes(self) -> list[str]:
        """Lines for the user about what is odd but no error."""

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield the pictures in order; those well before ``start_s`` may be left out."""

    def close(self) -> None:
        """Let go of the file, camera or connection; more than once does no harm."""


class Decoded(NamedTuple):
    """One whole picture as the decoder gave it, and how it is turned upright; stays good after the next one came."""

    data: Any
    layout: Layout


FEWEST_HZ = 8.0
"""With fewer pictures a second the network is not to be relied on; with five it never alarms (docs/limits.md)."""


class FrameSource(ABC):
    """An open source of frames: a context manager and an iterator, once through.

    ``name``; ``width`` and ``height`` of the working image; ``source_width`` and ``source_height`` of the upright
    picture, and ``seen``, the (x, y, width, height) of it that the working image shows; ``fps`` as the container
    estimates it, 0 where it says nothing; ``frame_count``, an estimate, or None; ``live``; ``dropped`` frames that a
    live source had to leave out; ``damaged`` pictures that could not be decoded; ``notes`` for the user.
    """

    live = False

    def __init__(self, reader: Reader, view: View, selection: Selection, resizer: Resizer | None = None) -> None:
        self._reader = reader
        self._view, self._resizer = view, resizer
        self._selection = selection
        self.name = reader.name
        self.width, self.height = view.size
        self._lay_out(reader.first)
        self.fps = reader.fps
        self._slow = _too_slow(reader.name, reader.fps / selection.stride)
        self.frame_count = selection.expected(reader.frame_count, reader.fps)
        self.dropped = 0
        self._delivered = 0
        self._last: Picture | None = None

    @property
    def damaged(self) -> int:
        """Pictures that could not be decoded and were left out."""
        return self._reader.damaged

    @property
    def notes(self) -> list[str]:
        """Lines for the user about what is odd but no error."""
        return [*self._reader.notes, *self._slow]

    def picture(self) -> NDArray[np.uint8]:
        """Return the last frame's whole picture, upright, (source_height, source_width, 3) RGB; made when asked for.

        Raises
        ------
        FrameSourceError : no frame has been delivered yet
        """
        if self._last is None:
            raise FrameSourceError(f"{self.name}: no picture before the first frame")
        return self._sampler.rgb(self._last.data)

    def decoded(self) -> Decoded:
        """Return the last frame's picture as decoded, at no cost: to be drawn later, or by another thread.

        Raises
        ------
        FrameSourceError : no frame has been delivered yet
        """
        if self._last is None:
            raise FrameSourceError(f"{self.name}: no picture before the first frame")
        return Decoded(self._last.data, self._sampler.layout)

    def with_pictures(self) -> Iterator[tuple[Frame, NDArray[np.uint8]]]:
        """Yield every frame together with its whole picture, as ``picture`` gives it."""
        for frame in self:
            yield frame, self.picture()

    def close(self) -> None:
        """Let go of the source."""
        self._reader.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __iter__(self) -> Iterator[Frame]:
        return self

    @abstractmethod
    def __next__(self) -> Frame:
        """Return the next frame."""

    def _lay_out(self, data: Any) -> None:
        """Work out the view on pictures like ``data``."""
        self._sampler = Sampler(self._view, data, self._reader.rotation, self.name, self._resizer)
        layout = self._sampler.layout
        self.source_width, self.source_height = layout.width, layout.height
        self.seen = layout.seen

    def _enough(self) -> bool:
        return self._delivered == self._selection.max_frames

    def _deliver(self, picture: Picture) -> Frame:
        if kind_of(picture.data) != self._sampler.kind:
            self._sampler.adapt(picture.data, f"{self.name}: frame {picture.index}")
        self._last = picture
        self._delivered += 1
        return Frame(self._sampler(picture.data), picture.time_s, picture.index, picture.captured_s)


class FrameSequence(FrameSource):
    """Every frame, in order: a file, a folder, a glob, a raw pipe, an array."""

    def __init__(self, reader: Reader, view: View, selection: Selection, resizer: Resizer | None = None) -> None:
        super().__init__(reader, view, selection, resizer)
        self._pictures = selection.within(increasing(reader.pictures(selection.start_s), reader.name))
        self._closed = False

    def close(self) -> None:
        """Let go of the source; it gives no more frames, but ``picture`` still shows the last one."""
        self._closed = True  # FFmpeg must not be asked for more: it would read freed memory
        super().close()

    def __next__(self) -> Frame:
        """Return the next frame.

        Raises
        ------
        FrameSourceError : the source failed on the way or was closed, or the selection holds no frame
        """
        if self._closed:
            raise FrameSourceError(f"{self.name}: is closed: frames must be read before that", on_the_way=True)
        if self._enough():
            raise StopIteration
        picture = next(self._pictures, None)
        if picture is not None:
            return self._deliver(picture)
        if not self._delivered:
            wanted = f"from {self._selection.start_s or 0:g} s"
            if self._selection.end_s is not None:
                wanted += f" to {self._selection.end_s:g} s"
            raise FrameSourceError(f"{self.name}: no frame {wanted}: must lie inside the source")
        raise StopIteration


def _too_slow(name: str, rate_hz: float) -> list[str]:
    """What is to be said of so few pictures a second; 0 where nobody knows how many."""
    if not 0 < rate_hz < FEWEST_HZ:
        return []
    return [f"{name}: {rate_hz:.3g} pictures a second: too few to rely on, must be {FEWEST_HZ:g} or more"]
