"""What is asked of live sources alone."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from ..errors import ParameterError
from ..frames.source import FrameSource
from ..runtime.service import Listener, find_service
from ..runtime.sources import Source
from .progress import Describe, Screen

DEFAULT_RECONNECT = "forever"


def live_options(reconnect: str | None, timeout_s: float | None) -> dict[str, Any]:
    """Return ``--reconnect`` and ``--timeout`` as keywords of ``lobula.open``.

    Raises
    ------
    ParameterError : not forever, never or a number of seconds above 0
    """
    patience_s = {"forever": math.inf, "never": 0.0}.get(reconnect or DEFAULT_RECONNECT)
    if patience_s is None:
        patience_s = _seconds("--reconnect", str(reconnect), "forever, never or seconds above 0")
    if timeout_s is not None:
        _seconds("--timeout", f"{timeout_s:g}", "seconds above 0")
    return {"reconnect_s": patience_s} | ({} if timeout_s is None else {"timeout_s": timeout_s})


def require_live(frames: FrameSource, **given: object) -> None:
    """Check options that only sources heed which can be opened again; ``given`` maps their names to their values.

    Raises
    ------
    ParameterError : one of them was given, and the source is a recording or a pipe
    """
    for name, value in given.items():
        if value is not None and (not frames.live or frames.name == "-"):
            what = "a pipe" if frames.name == "-" else "not live"
            raise ParameterError(f"--{name} {value}: {frames.name} is {what}: must be a camera or a stream")


def listeners(frames: Source, here: Screen | None = None) -> list[Listener]:
    """Return who is told how the run fares: a service manager, and of a live source the words before the bar."""
    service = find_service()
    found: list[Listener] = [] if service is None else [service]
    if frames.live and here is not None and here.describe is not None:
        found.append(_Described(here.describe))
    return found


class _Described:
    """Shows how the run fares, and how many frames it had, once a second."""

    def __init__(self, describe: Describe) -> None:
        self._describe = describe
        self._told_s = -math.inf
        self._frames = 0

    def beat(self, words: Callable[[], str], ready: bool) -> None:
        self._frames += ready
        now_s = time.monotonic()
        if now_s - self._told_s >= 1.0:
            self._told_s = now_s
            self._describe(words(), self._frames)

    def stop(self) -> None:
        """The bar goes with the run."""


def _seconds(option: str, text: str, allowed: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0 < seconds < math.inf:
        raise ParameterError(f"{option} {text}: must be {allowed}")
    return seconds
