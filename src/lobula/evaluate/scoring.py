"""The rules: which alarm is a hit, which is false, and how much footage it is counted over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeError
from ..runtime.events import Collision, collisions_of
from .labels import Label

WINDOW_S = 2.0
"""A collision event that starts at most this long before contact is a hit, s."""

MIN_LEAD_FRAMES = 2
"""It must start at least this many frames before contact, or the label's uncertainty if that is more."""

AFTER_FRAMES = 5
"""Frames later than this after contact are not looked at: the camera tumbles."""

_JITTER_S = 1e-6


@dataclass(frozen=True, kw_only=True)
class ClipScore:
    """How one clip went.

    Attributes
    ----------
    alarms : the collision events that started in the part that counts
    lead_s : contact minus the start of the first hit, s; None without a hit
    false_alarms : starts before the window; in a clip without collision, all of them
    late : starts after the window, up to ``AFTER_FRAMES`` after contact: neither hits nor false alarms
    footage_s : the footage over which false alarms count, s
    window_s : the part of the hit window that lies in the clip, s; 0 where there is no collision
    """

    label: Label
    frames: int
    alarms: tuple[Collision, ...]
    lead_s: float | None
    false_alarms: int
    late: int
    footage_s: float
    window_s: float

    @property
    def hit(self) -> bool:
        """Whether an alarm started inside the window."""
        return self.lead_s is not None


def last_frame(label: Label) -> int | None:
    """Return the number of the last frame that counts; None for all of them."""
    return None if label.contact_frame is None else label.contact_frame + AFTER_FRAMES


def score_clip(label: Label, trace: NDArray[np.void]) -> ClipScore:
    """Score the readings of one clip, (n,) TRACE_DTYPE, against its label.

    A frame's time is its own stamp; a contact after the end of the clip lies on the line through its last frames.

    Raises
    ------
    ShapeError : a trace without a frame that counts
    """
    last = last_frame(label)
    if last is not None:
        trace = trace[trace["frame"] <= last]
    if len(trace) == 0:
        raise ShapeError(f"{label.file}: the trace holds no frame that counts: must have at least one")
    alarms = tuple(collisions_of(trace))
    first_s, end_s = _span(trace)
    if label.contact_frame is None:
        return ClipScore(
            label=label,
            frames=len(trace),
            alarms=alarms,
            lead_s=None,
            false_alarms=len(alarms),
            late=0,
            footage_s=end_s - first_s,
            window_s=0.0,
        )
    contact_s = _time_of(trace, label.contact_frame)
    opens_s = contact_s - WINDOW_S
    closes = label.contact_frame - max(label.uncertainty_frames, MIN_LEAD_FRAMES)
    early = [a for a in alarms if a.start_s < opens_s - _JITTER_S]
    inside = alarms[len(early) :]
    hits = [a for a in inside if a.start_frame <= closes]
    closes_s = min(_time_of(trace, closes), end_s)
    return ClipScore(
        label=label,
        frames=len(trace),
        alarms=alarms,
        lead_s=contact_s - hits[0].start_s if hits else None,
        false_alarms=len(early),
        late=len(inside) - len(hits),
        footage_s=max(0.0, min(opens_s, end_s) - first_s),
        window_s=max(0.0, closes_s - max(opens_s, first_s)),
    )


def _span(trace: NDArray[np.void]) -> tuple[float, float]:
    """When the first frame begins and the last one ends, s; the last lasts as long as the others at the median."""
    times_s = trace["time_s"]
    return float(times_s[0]), float(times_s[-1] + _gap_s(times_s))


def _gap_s(times_s: NDArray[np.float64]) -> float:
    return float(np.median(np.diff(times_s))) if len(times_s) > 1 else 0.0


def _time_of(trace: NDArray[np.void], frame: int) -> float:
    frames, times_s = trace["frame"], trace["time_s"]
    if frame > frames[-1]:
        return float(times_s[-1] + (frame - frames[-1]) * _gap_s(times_s))
    if frame < frames[0]:
        return float(times_s[0] - (frames[0] - frame) * _gap_s(times_s))
    return float(np.interp(frame, frames, times_s))
