"""A scored set of clips as one JSON document."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from .clips import Failure
from .scoring import AFTER_FRAMES, MIN_LEAD_FRAMES, WINDOW_S, ClipScore
from .summary import Summary, Totals

RULES = {
    "window_s": WINDOW_S,
    "min_lead_frames": MIN_LEAD_FRAMES,
    "after_frames": AFTER_FRAMES,
    "hit_interval": "Wilson, 95 %",
    "false_alarm_interval": "exact Poisson (Garwood), 95 %",
}


def document(scores: Sequence[ClipScore], failures: Sequence[Failure], summary: Summary) -> dict[str, Any]:
    """Return everything that was found, as plain dictionaries, lists and numbers, rounded to 6 decimals."""
    return {
        "rules": RULES,
        "headline": _totals(summary.headline),
        "classes": {kind: _totals(t) for kind, t in summary.classes.items()},
        "apart": {why: _totals(t) for why, t in summary.apart.items()},
        "clips": [_clip(score) for score in scores],
        "failed": [{"file": f.label.file, "problem": f.message} for f in failures],
    }


def _totals(t: Totals) -> dict[str, Any]:
    return {name: _plain(value) for name, value in asdict(t).items()}


def _clip(s: ClipScore) -> dict[str, Any]:
    return {
        "file": s.label.file,
        "class": s.label.kind,
        "collision": s.label.collision,
        "apart": s.label.apart or None,
        "hit": s.hit if s.label.collision else None,
        "lead_s": _plain(s.lead_s),
        "false_alarms": s.false_alarms,
        "late": s.late,
        "footage_s": _plain(s.footage_s),
        "window_s": _plain(s.window_s),
        "frames": s.frames,
        "alarms": [{"frame": a.start_frame, "time_s": _plain(a.start_s), "peak_frame": a.peak_frame}
                   for a in s.alarms],
    }  # fmt: skip


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return round(value, 6) if isinstance(value, float) and math.isfinite(value) else value
