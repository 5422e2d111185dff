"""What people would try first: one number a frame, from plain frame difference or from optical flow."""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import MissingExtraError, pip_install
from ..types import TRACE_DTYPE, Frame
from .labels import Label
from .scoring import ClipScore, score_clip

DIFFERENCES = ("mean absolute difference", "mean square difference")
DIVERGENCES = ("mean divergence", "mean divergence, middle half", "divergence, 95th percentile")
SIGNALS = (*DIFFERENCES, *DIVERGENCES)

PRESETS = {"ultrafast": "DISOPTICAL_FLOW_PRESET_ULTRAFAST", "fast": "DISOPTICAL_FLOW_PRESET_FAST"}

WARM_UP_S = HOLD_S = 0.2
"""No alarm so long after the first frame; an alarm lasts so long after the signal was last above its threshold: as the
network's decision has it."""

_JITTER_S = 1e-3


class SignalTrace(NamedTuple):
    """The signals of one clip, (n,) each, by name; and stamp and number of each frame."""

    times_s: NDArray[np.float64]
    frames: NDArray[np.int64]
    signals: dict[str, NDArray[np.float64]]


def signal_trace(frames: Iterable[Frame], flow: str) -> SignalTrace:
    """Return all ``SIGNALS`` of a clip; the first frame, which has none before it, has none.

    Differences are in grey levels, or their squares, from each picture to the next. Divergence is in 1/s: of the
    optical flow from each picture to the next by OpenCV's DIS with preset ``flow``, over the time between them.

    Raises
    ------
    MissingExtraError : OpenCV is not installed
    """
    cv2 = load_opencv()
    dis = cv2.DISOpticalFlow.create(getattr(cv2, PRESETS[flow]))
    rows: list[tuple[float, ...]] = []
    times_s: list[float] = []
    numbers: list[int] = []
    before: NDArray[np.uint8] | None = None
    for frame in frames:
        image = np.rint(frame.image).astype(np.uint8)
        if before is None:
            rows.append((-np.inf,) * len(SIGNALS))
        else:
            moved = divergence(dis.calc(before, image, None)) / (frame.time_s - times_s[-1])
            rows.append((*_differences(before, image), *_read_out(moved)))
        before = image
        times_s.append(frame.time_s)
        numbers.append(frame.index)
    columns = np.array(rows, np.float64).reshape(-1, len(SIGNALS)).T
    return SignalTrace(np.array(times_s), np.array(numbers), dict(zip(SIGNALS, columns, strict=True)))


def divergence(flow: NDArray[Any]) -> NDArray[np.float64]:
    """Return du/dx + dv/dy of a flow field (H, W, 2), (H, W): twice the rate at which things grow where it is even."""
    across = np.gradient(flow[..., 0].astype(np.float64), axis=1)
    down = np.gradient(flow[..., 1].astype(np.float64), axis=0)
    total: NDArray[np.float64] = across + down
    return total


def score_signal(label: Label, trace: SignalTrace, signal: NDArray[np.float64], threshold: float) -> ClipScore:
    """Score the alarms that ``signal`` above ``threshold`` gives, by the rules of ``score_clip``."""
    times_s = trace.times_s
    above = (signal > threshold) & (times_s - times_s[0] > WARM_UP_S - _JITTER_S)
    last_s = np.maximum.accumulate(np.where(above, times_s, -np.inf))
    readings = np.zeros(len(times_s), TRACE_DTYPE)
    readings["frame"], readings["time_s"], readings["state"] = trace.frames, times_s, "ok"
    readings["collision"] = times_s - last_s < HOLD_S - _JITTER_S
    return score_clip(label, readings)


def load_opencv() -> Any:
    """Return the module ``cv2``.

    Raises
    ------
    MissingExtraError : it is not installed
    """
    try:
        return importlib.import_module("cv2")
    except ImportError as error:
        raise MissingExtraError(f"optical flow needs OpenCV: {pip_install('opencv')}") from error


def _differences(before: NDArray[np.uint8], now: NDArray[np.uint8]) -> tuple[float, float]:
    change = now.astype(np.float64) - before
    return float(np.abs(change).mean()), float(np.square(change).mean())


def _read_out(moved: NDArray[np.float64]) -> tuple[float, float, float]:
    rows, columns = (side // 4 for side in moved.shape)
    middle = moved[rows : moved.shape[0] - rows, columns : moved.shape[1] - columns]
    return float(moved.mean()), float(middle.mean()), float(np.percentile(moved, 95))
