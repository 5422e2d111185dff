"""The thread that turns the newest moment of a live run into a scene, once for all viewers; older ones are left out."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ..frames.jpeg import Jpeg
from ..frames.source import Decoded
from ..types import Image
from .scene import MapScale, Scene, box_of


class Shot(NamedTuple):
    """What the detector hands over: nothing in it is computed yet, and nobody changes it afterwards."""

    time_s: float
    decoded: Decoded
    maps: Mapping[str, Image]
    why: list[dict[str, Any]]


class Darkroom:
    """Develops shots into scenes and gives them to ``show``; takes at most half of one processor core.

    ``size`` is (width, height) of the working image. A context manager: the thread works inside it.
    """

    def __init__(self, size: tuple[int, int], show: Callable[[Scene], None], tell: Callable[[str], None]) -> None:
        self._size = size
        self._show = show
        self._tell = tell
        self._changed = threading.Condition()
        self._newest: Shot | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="lobula dashboard pictures", daemon=True)

    def __enter__(self) -> Darkroom:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify()
        self._thread.join(1.0)

    def hand(self, shot: Shot) -> None:
        """Take the newest moment in place of any that still waits."""
        with self._changed:
            self._newest = shot
            self._changed.notify()

    def _work(self) -> None:
        number, jpeg, scale = 0, Jpeg(), MapScale()
        while (shot := self._next()) is not None:
            begun_s = time.perf_counter()
            number += 1
            try:
                picture = jpeg(shot.decoded)
            except Exception as error:  # nobody waits for this thread: the page says it, the detector goes on
                picture, jpeg = b"", Jpeg()
                self._tell(f"no picture: {error!r}")
            maps = {name: scale(name, image) for name, image in shot.maps.items()}
            box = box_of(shot.decoded.layout, *self._size)
            self._show(Scene(number, shot.time_s, picture, box, maps, shot.why))
            self._rest(time.perf_counter() - begun_s)

    def _next(self) -> Shot | None:
        with self._changed:
            self._changed.wait_for(lambda: self._newest is not None or self._closed)
            shot, self._newest = self._newest, None
            return None if self._closed else shot

    def _rest(self, duration_s: float) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._closed, duration_s)
