"""A run in the arena as a film or a picture, from its record alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arena.record import Record
from ..errors import ParameterError
from ..report.arena_video import ArenaVideo, write_still
from ..runtime.interrupts import Interrupts
from .arena_tale import tell, tell_own

LONGEST_S = 180.0
"""A film whose speed is not asked for is no longer than this."""

MOST_FPS = 30.0
SPEEDS = (1 / 64, 256.0)
_BATCH = 4


class Film(NamedTuple):
    """What was written: where, how many pictures, how long it plays, how many times as fast as the run."""

    path: Path
    frames: int
    duration_s: float
    speed: float


def save_film(
    record: Record, path: str | Path, *, robot: int = 0, start_s: float | None = None, end_s: float | None = None,
    speed: float | None = None, advance: Callable[[], None] | None = None,
) -> Film:  # fmt: skip
    """Write ``path``, an MP4 that browsers play: the arena from above, and the view and potentials of ``robot``.

    Parameters
    ----------
    start_s, end_s : the part of the run to show; all of it
    speed : times as fast as the run; 1, or the power of two that makes a long run a film of three minutes at most
    advance : called after each picture

    Raises
    ------
    ParameterError : no such robot, an empty part, a speed out of range, a name that does not end in .mp4
    OutputError : the file cannot be written
    Interrupted : Ctrl-C or SIGTERM, taken between two pictures; ``NAME.part.mp4`` holds what there is, and plays
    """
    path = Path(path)
    if path.suffix.lower() != ".mp4":
        raise ParameterError(f"film {path}: must end in .mp4")
    robots = record.poses.shape[1]
    if not 0 <= robot < robots:
        raise ParameterError(f"robot {robot}: must be one of 0..{robots - 1}")
    rate_hz = record.world.camera.rate_hz
    frames, speed = frames_of(len(record.poses), rate_hz, start_s=start_s, end_s=end_s, speed=speed)
    own = tell_own(record, robot)
    fps = rate_hz * speed / frames.step
    about = {"seed": record.seed, "controller": record.controller, "robot": robot, "speed": speed}
    video = ArenaVideo(path, tell(record), own, speed=speed, fps=fps, about=about)
    try:
        with Interrupts() as interrupts:
            for frame, image in interrupts.between(_pictures(record, robot, frames)):
                video.frame(frame, image)
                if advance:
                    advance()
    except BaseException:  # Ctrl-C too: the part stays and plays
        video.abandon()
        raise
    video.finish()
    return Film(path, len(frames), len(frames) / fps, speed)


def frames_of(
    count: int, rate_hz: float, *, start_s: float | None = None, end_s: float | None = None, speed: float | None = None
) -> tuple[range, float]:
    """Return which of a run's ``count`` frames a film shows, and how many times as fast; as for ``save_film``.

    Raises
    ------
    ParameterError : an empty part, a speed out of range
    """
    part = _part(count, rate_hz, start_s, end_s)
    speed = _fitting(len(part) / rate_hz) if speed is None else speed
    if not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise ParameterError(f"speed {speed!r}: must be from 1/64 to {SPEEDS[1]:g} times as fast as the run")
    return part[:: max(1, math.ceil(rate_hz * speed / MOST_FPS - 1e-9))], speed


def save_still(record: Record, path: str | Path, *, start_s: float | None = None, end_s: float | None = None) -> None:
    """Write ``path``, a PNG: the run from above with all tracks and events.

    Raises
    ------
    ParameterError : an empty part, a name that does not end in .png
    OutputError : the file cannot be written
    """
    if Path(path).suffix.lower() != ".png":
        raise ParameterError(f"picture {path}: must end in .png")
    part = _part(len(record.poses), record.world.camera.rate_hz, start_s, end_s)
    write_still(path, tell(record, part))


def _part(count: int, rate_hz: float, start_s: float | None, end_s: float | None) -> range:
    first = 0 if start_s is None else math.ceil(start_s * rate_hz - 1e-6)
    last = count if end_s is None else min(count, math.ceil(end_s * rate_hz - 1e-6))
    if not 0 <= first < last:
        of = " to ".join("its end" if end is None else f"{end:g} s" for end in (start_s or 0.0, end_s))
        raise ParameterError(f"from {of}: must be a part of the run, 0 to {count / rate_hz:g} s")
    return range(first, last)


def _fitting(length_s: float) -> float:
    return 2.0 ** max(0, math.ceil(math.log2(length_s / LONGEST_S)))


def _pictures(record: Record, robot: int, frames: range) -> Iterator[tuple[int, NDArray[np.uint8]]]:
    """Draw again what the robot saw in each of ``frames``; a few in one go, those between them too."""
    for at in range(0, len(frames), _BATCH):
        batch = frames[at : at + _BATCH]
        images = record.views(robot, batch[0], batch[-1] + 1)[:: frames.step]
        yield from zip(batch, images, strict=True)
