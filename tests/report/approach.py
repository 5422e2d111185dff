"""A run made by hand: 30 frames at 10 Hz, warming up for 3, a collision from frame 18 to 23, flat grey pictures."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lobula.types import NEURONS, TRACE_DTYPE, Reading, Spikes

FRAMES = 30
GREY = 120
COLLISION = range(18, 24)
HEADER: dict[str, Any] = {
    "type": "header",
    "version": "0.1.0",
    "preset": "default",
    "neurons": "all",
    "settings_hash": "0123456789ab",
    "source": "clip.mp4",
    "width": 99,
    "height": 72,
    "fps": 10.0,
    "thresholds": dict(zip(NEURONS, (0.7, 0.7, 0.2, 0.2), strict=True)),
    "settings": [
        {
            "path": "lamina.dog.sigma_px",
            "value": 2.0,
            "unit": "px",
            "meaning": "width of the inner field",
            "source": "published code",
        }
    ],
}
SUMMARY: dict[str, Any] = {
    "type": "summary",
    "status": "ok",
    "frames": FRAMES,
    "dropped": 0,
    "collisions": 1,
    "duration_s": 3.0,
    "ms_per_frame": 0.31,
}


def reading(index: int) -> Reading:
    alarm = index in COLLISION
    spikes = Spikes(2, 1, 0, 0) if alarm else Spikes(lptc_l=5 if index == 27 else 0)
    return Reading(
        index / 10,
        0.9 if alarm else 0.55,
        0.8 if alarm else 0.5,
        0.1,
        -0.6 if index == 27 else 0.0,
        spikes,
        alarm,
        "warming_up" if index < 3 else "ok",
    )


def table() -> NDArray[np.void]:
    """The trace this run must leave, written out without the code under test."""
    rows = [
        (i, r.time_s, r.lgmd1, r.lgmd2, r.lptc_r, r.lptc_l, *r.spikes, r.collision, r.state)
        for i, r in ((i, reading(i)) for i in range(FRAMES))
    ]
    return np.array(rows, TRACE_DTYPE)


def picture(height: int = 48, width: int = 64) -> NDArray[np.uint8]:
    return np.full((height, width, 3), GREY, np.uint8)


def events(index: int) -> list[dict[str, Any]]:
    stamp = {"frame": index, "time_s": index / 10}
    return {
        0: [{"type": "state", "state": "warming_up", "phase": "start", **stamp}],
        3: [{"type": "state", "state": "warming_up", "phase": "end", **stamp}],
        18: [
            {
                "type": "collision",
                "phase": "start",
                "id": 1,
                **stamp,
                "lgmd1": 0.9,
                "lgmd2": 0.8,
                "lptc_r": 0.1,
                "lptc_l": 0.0,
            }
        ],
        24: [{"type": "collision", "phase": "end", "id": 1, **stamp, "peak_frame": 20}],
    }.get(index, [])


def play(*sinks: Any, frames: int = FRAMES, header: dict[str, Any] | None = None, finish: bool = True) -> None:
    """Drive sinks as the runtime does; without ``finish`` stop as a crash would, before ``close``."""
    for sink in sinks:
        sink.open(HEADER if header is None else header)
    for index in range(frames):
        for sink in sinks:
            sink.frame(index, reading(index), picture)
            for record in events(index):
                sink.event(record)
    if finish:
        for sink in sinks:
            sink.close({**SUMMARY, "frames": frames})
