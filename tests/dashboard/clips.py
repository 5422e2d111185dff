"""Recordings for the tests of this folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import lobula
from lobula.dashboard.recording import Recording
from lobula.report.grey_clip import write_grey_clip


def approach(path: Path, **settings: Any) -> Path:
    """Write an approach, 91 frames at 30 Hz, contact at 3.0 s."""
    movie = lobula.stimuli.looming(scene="arena", speed_cm_s=12.0, **settings)
    write_grey_clip(path, movie.images, movie.times_s, movie.rate_hz)
    return path


def recording(path: Path, memory_bytes: int = 1 << 28, **how: Any) -> Recording:
    first = lobula.open(path, **how)
    later = {name: value for name, value in how.items() if name not in ("start_s", "max_frames")}
    return Recording(first, lambda start_s: lobula.open(path, start_s=start_s, **later), memory_bytes)
