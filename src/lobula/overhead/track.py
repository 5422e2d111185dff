"""A recording from above in, tracks of the robots out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from os import PathLike
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameSourceError, LobulaError, ParameterError
from ..frames import FrameSource
from ..runtime.interrupts import Interrupted
from ..runtime.opening import open as open_frames
from .detection import DETECTION_DTYPE, MarkerFinder
from .gaps import bridged
from .lens import Lens
from .markers import DICTIONARY, MarkerParams, require_ids
from .overlay import overlay
from .reference import Reference
from .room import Room
from .sightings import Sightings, TrackParams
from .tracks import Tracks


def track(
    source: str | PathLike[str] | NDArray[Any] | Any, room: Room, reference: Reference, *,
    marker: MarkerParams | None = None, params: TrackParams | None = None, ids: Sequence[int] | None = None,
    advance: Callable[[], None] | None = None, **opening: Any,
) -> Tracks:  # fmt: skip
    """Find the robots in every frame of ``source``, a recording from above.

    A source that fails on the way, or an interruption, ends the tracks there: see ``Tracks.stopped``.

    Parameters
    ----------
    source : a video, a folder of pictures, a pattern, or arrays, as ``lobula.open`` takes them
    room : plan of the floor
    reference : what ties the picture to the room
    marker : size and height of the ID patterns
    params : what is believed, how gaps are bridged
    ids : the robots' ids; others are left out. If left out: all that are seen often enough and mark no corner
    advance : called after every frame
    opening : ``start_s``, ``end_s``, ``stride``, ``max_frames``, ``rate_hz``, ... of ``lobula.open``

    Raises
    ------
    FrameSourceError : the source cannot be opened, or shows no ID pattern
    ParameterError : a source that is not recorded, or a reference that does not fit what is seen
    Interrupted : a signal came before there were tracks
    MissingExtraError : OpenCV is not installed
    """
    marker, params = marker or MarkerParams(), params or TrackParams()
    wanted = None if ids is None else require_ids(list(ids), "ids")
    finder = MarkerFinder()
    with _opened(source, opening) as frames:
        name, lens = frames.name, Lens(frames.width, frames.height)
        if reference.corner_ids is None:
            reference.calibration(room, lens, marker)  # wrong corners are told before the work, not after it
        watched = _watch(frames, finder, advance)
        notes = [*frames.notes, *reference.notes(marker)]
    try:
        return _tracks(watched, name, lens, notes, room, reference, marker, params, wanted)
    except LobulaError as error:  # what was read may be too little: no reason to find fault with the rest
        if isinstance(watched.stopped, Interrupted):
            raise watched.stopped from error
        if watched.stopped is not None:
            raise FrameSourceError(f"{watched.stopped}; until there: {error}", on_the_way=True) from error
        raise


class _Watched(NamedTuple):
    """Everything that looks like an ID pattern, the frames' numbers and times, and what ended it too early.

    ``image`` is a frame with as many patterns as any, ``shown`` says which.
    """

    found: NDArray[np.void]
    numbers: NDArray[np.int64]
    times_s: NDArray[np.float64]
    stopped: FrameSourceError | Interrupted | None
    image: NDArray[Any]
    shown: int


def _tracks(
    watched: _Watched, name: str, lens: Lens, notes: list[str], room: Room, reference: Reference, marker: MarkerParams,
    params: TrackParams, wanted: tuple[int, ...] | None,
) -> Tracks:  # fmt: skip
    frames_seen = f"in {len(watched.numbers)} frames"
    if not len(watched.found):
        raise FrameSourceError(
            f"{name}: no ID pattern {frames_seen}: must show {DICTIONARY} markers, dark on white, some 14 px wide or "
            "more; `lobula track --print` draws them"
        )
    calibration = reference.calibration(room, lens, marker, watched.found)
    robots = watched.found[~np.isin(watched.found["id"], list(reference.corner_ids or ()))]
    sightings = Sightings(robots, watched.numbers, watched.times_s, calibration, marker)
    notes = [*notes, *sightings.sift(room, params, wanted)]
    rows = sightings.rows
    if not len(rows):
        why = ", ".join(f"{reason}: {count}" for reason, count in sightings.left_out.items())
        raise FrameSourceError(f"{name}: no robot's ID pattern {frames_seen}: {why or 'only corner markers were seen'}")
    robot_ids = np.unique(rows["id"])
    table = np.concatenate(
        [bridged(rows[rows["id"] == one], watched.numbers, watched.times_s, params.max_gap_s) for one in robot_ids]
    )
    shown = rows[rows["frame"] == watched.numbers[watched.shown]]
    ground = reference.ground(room, lens, watched.found)
    return Tracks(
        rows=table[np.lexsort((table["id"], table["frame"]))],
        frames=watched.numbers,
        times_s=watched.times_s,
        ids=tuple(robot_ids.tolist()),
        room=room,
        source=name,
        calibration_error_cm=calibration.error_cm,
        left_out=sightings.left_out,
        notes=tuple(notes),
        stopped=watched.stopped,
        draw=partial(overlay, watched.image, room, ground, calibration, shown, marker),
    )


def frame_count(source: Any, **opening: Any) -> int | None:
    """Return about how many frames ``track`` will read from ``source``, None if nobody knows.

    Raises
    ------
    FrameSourceError : it cannot be opened
    ParameterError : it is not recorded
    """
    with _at_first(source, opening) as frames:
        return frames.frame_count


def _at_first(source: Any, opening: dict[str, Any]) -> FrameSource:
    allowed = "must be a recording: a video, a folder or a pattern"
    text = str(source) if isinstance(source, str | int | PathLike) else ""
    if text == "-" or text.isdecimal() or text.startswith("/dev/"):
        raise ParameterError(f"source {text}: {allowed}")
    frames = open_frames(source, **opening)
    if frames.live:
        frames.close()
        raise ParameterError(f"source {text}: {allowed}")
    return frames


def _opened(source: Any, opening: dict[str, Any]) -> FrameSource:
    """Open ``source`` at its own size, which has to be asked for first."""
    with _at_first(source, opening) as first:
        size = first.source_width, first.source_height
    return open_frames(source, size=size, **opening)


def _watch(frames: FrameSource, finder: MarkerFinder, advance: Callable[[], None] | None) -> _Watched:
    seen: list[tuple[NDArray[np.void], int, float]] = []
    best: tuple[int, int, NDArray[Any]] = (-1, 0, np.zeros((0, 0)))
    stopped: FrameSourceError | Interrupted | None = None
    try:
        for frame in frames:
            here = finder.find(frame.image, len(seen))
            if len(here) > best[0]:
                best = len(here), len(seen), frame.image
            seen.append((here, frame.index, frame.time_s))
            if advance is not None:
                advance()
    except (FrameSourceError, Interrupted) as error:
        stopped = error
    found = np.concatenate([np.zeros(0, DETECTION_DTYPE), *(one for one, _, _ in seen)])
    if stopped is not None and not len(found):
        raise stopped
    numbers, times_s = (np.array([one[k] for one in seen]) for k in (1, 2))
    return _Watched(found, numbers.astype(np.int64), times_s.astype(np.float64), stopped, best[2], best[1])
