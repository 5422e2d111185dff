"""What is asked of live sources alone."""

from __future__ import annotations

import math
from typing import Any

from ..errors import ParameterError
from ..frames.source import FrameSource

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


def _seconds(option: str, text: str, allowed: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0 < seconds < math.inf:
        raise ParameterError(f"{option} {text}: must be {allowed}")
    return seconds
