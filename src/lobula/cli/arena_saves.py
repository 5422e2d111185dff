"""What ``lobula arena --save`` writes: the replay, a film of it, a picture of it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import ParameterError
from .counted import counted
from .destinations import check_ending
from .progress import screen

if TYPE_CHECKING:
    from ..arena.record import Record

REPLAY, FILM, PICTURE = SAVED_AS = (".npz", ".mp4", ".png")
"""What --save can write."""


class Shown(NamedTuple):
    """What a film or picture shows: whose view, which part of the run, how fast."""

    robot: int | None
    start_s: float | None
    end_s: float | None
    speed: float | None


def check_saves(saves: Sequence[Path], shown: Shown, robots: int, frames: int, rate_hz: float) -> None:
    """Check what is to be written of a run of so many robots and frames, before it begins.

    Raises
    ------
    ParameterError : an unknown ending, one ending twice, an option that no file uses, no such robot, part or speed
    """
    for path in saves:
        check_ending("--save", path, SAVED_AS)
    endings = [path.suffix.lower() for path in saves]
    if len(set(endings)) < len(endings):
        raise ParameterError(f"--save {' '.join(map(str, saves))}: must be one file of a kind")
    needed = {"--robot": (shown.robot, {FILM}), "--speed": (shown.speed, {FILM}),
              "--start": (shown.start_s, {FILM, PICTURE}), "--end": (shown.end_s, {FILM, PICTURE})}  # fmt: skip
    for option, (value, users) in needed.items():
        if value is not None and not users.intersection(endings):
            raise ParameterError(f"{option} {value}: goes with --save FILE{' or FILE'.join(sorted(users))}")
    if shown.robot is not None and not 0 <= shown.robot < robots:
        raise ParameterError(f"--robot {shown.robot}: must be one of 0..{robots - 1}")
    if {FILM, PICTURE}.intersection(endings):
        from ..experiments.arena_film import frames_of

        frames_of(frames, rate_hz, start_s=shown.start_s, end_s=shown.end_s, speed=shown.speed)


def write_saves(record: Record, saves: Sequence[Path], shown: Shown) -> dict[str, Any]:
    """Write the files, the replay first; return what there is to say of them.

    Raises
    ------
    ParameterError : a part of the run, a speed or a robot that there is not
    OutputError : a file cannot be written
    """
    written: list[str] = []
    said: dict[str, Any] = {"saved": written}
    for path in sorted(saves, key=lambda path: SAVED_AS.index(path.suffix.lower())):
        if path.suffix.lower() == REPLAY:
            record.save(path)
        elif path.suffix.lower() == PICTURE:
            from ..experiments.arena_film import save_still

            save_still(record, path, start_s=shown.start_s, end_s=shown.end_s)
        else:
            said["film"] = _film(record, path, shown)
        written.append(str(path))
    return said


def film_words(record: Record | None, saves: Sequence[Path], shown: Shown) -> str:
    """Return, for the end of a line, how long a film will be made of a run that ended early; else nothing."""
    if record is None or all(path.suffix.lower() != FILM for path in saves):
        return ""
    try:
        pictures, speed = _pictures(record, shown)
    except ParameterError:  # the part that was asked for was not reached: said when it is to be written
        return ""
    playing_s = len(pictures) * pictures.step / (record.world.camera.rate_hz * speed)
    return f"; the film: {counted(len(pictures), 'picture')} to draw, {playing_s:.0f} s to play"


def _pictures(record: Record, shown: Shown) -> tuple[range, float]:
    from ..experiments.arena_film import frames_of

    rate_hz = record.world.camera.rate_hz
    return frames_of(len(record.poses), rate_hz, start_s=shown.start_s, end_s=shown.end_s, speed=shown.speed)


def _film(record: Record, path: Path, shown: Shown) -> dict[str, Any]:
    from ..experiments.arena_film import save_film

    part: dict[str, Any] = {"start_s": shown.start_s, "end_s": shown.end_s, "speed": shown.speed}
    pictures, _ = _pictures(record, shown)
    with screen(len(pictures), "pictures of the film") as here:
        film = save_film(record, path, robot=shown.robot or 0, advance=here.advance, **part)
    return {"frames": film.frames, "duration_s": round(film.duration_s, 3), "speed": film.speed}
