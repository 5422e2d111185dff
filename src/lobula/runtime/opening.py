"""``lobula.open``: sources of frames, resized by the C core where it was built."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from ..engine.library import available
from ..engine.resize import CoreAreaAverage
from ..frames import open as open_frames

P = ParamSpec("P")
R = TypeVar("R")


def _resized_by_the_core(opener: Callable[P, R]) -> Callable[P, R]:
    @wraps(opener)
    def opened(*args: P.args, **kwargs: P.kwargs) -> R:
        if available():
            kwargs.setdefault("resizer", CoreAreaAverage)
        return opener(*args, **kwargs)

    return opened


open = _resized_by_the_core(open_frames)
