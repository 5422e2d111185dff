"""What the options of ``lobula track`` ask for: the room, what ties the picture to it, the ID patterns."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import ParameterError

if TYPE_CHECKING:
    from ..arena.world import World
    from ..overhead import MarkerParams, Reference, Room


def parse_ids(text: str, option: str) -> list[int]:
    """Return ``0-3,9`` as [0, 1, 2, 3, 9].

    Raises
    ------
    ParameterError : another form
    """
    ids: list[int] = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d{1,4})\s*(?:-\s*(\d{1,4})\s*)?", part)
        if match is None:
            raise ParameterError(f"{option} {text!r}: must be numbers and ranges, such as 0-6,9")
        ids += range(int(match[1]), int(match[2] or match[1]) + 1)
    return ids


def parse_corners(text: str) -> list[tuple[float, float]]:
    """Return eight numbers, separated by commas, semicolons or spaces, as four pairs.

    Raises
    ------
    ParameterError : another form
    """
    try:
        numbers = [float(part) for part in re.split(r"[\s,;]+", text.strip())]
    except ValueError:
        numbers = []
    if len(numbers) != 8:
        example = "33,638,803,638,803,33,33,33"
        raise ParameterError(f"--corners {text!r}: must be eight numbers, X,Y of four corners, such as {example}")
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def reference_of(
    corners: str | None, corner_ids: str | None, points: Path | None, px_per_cm: float | None,
    plane_cm: float | None, camera_cm: float | None,
) -> Reference:  # fmt: skip
    """Return what ties the picture to the room.

    Raises
    ------
    ParameterError : not exactly one of the first four, or one in another form
    """
    from ..overhead import Reference, read_points

    given = {"--corners": corners, "--corner-ids": corner_ids, "--points": points, "--px-per-cm": px_per_cm}
    named = [option for option, value in given.items() if value is not None]
    if len(named) != 1:
        what = " and ".join(named) or "nothing"
        raise ParameterError(f"track: {what} ties the picture to the room: must be one of {', '.join(given)}")
    return Reference(
        corners_px=None if corners is None else parse_corners(corners),
        corner_ids=None if corner_ids is None else parse_ids(corner_ids, "--corner-ids"),
        points=None if points is None else read_points(points),
        px_per_cm=px_per_cm,
        plane_cm=plane_cm,
        camera_cm=camera_cm,
    )


def room_of(text: str | None, world: World | None) -> Room:
    """Return the room of ``--room``, or that of the world's file.

    Raises
    ------
    ParameterError : both are given or none, or a room in another form
    """
    from ..overhead import Room, parse_room

    if text is not None and world is None:
        return parse_room(text)
    if text is None and world is not None:
        return Room(*world.room.size_cm, "circle" if world.room.shape == "circle" else "box")
    what = "both --room and --world" if text is not None else "neither --room nor --world"
    raise ParameterError(f"track: {what} given: must be one of them, such as --room 70x55")


def marker_of(disc_cm: float | None, height_cm: float | None, world: World | None) -> MarkerParams:
    """Return the ID patterns: of the size given, else of the world's robots, else of the paper's.

    Raises
    ------
    ParameterError : a size out of its range
    """
    from ..overhead import MarkerParams

    own = MarkerParams()
    if world is not None:
        own = MarkerParams(disc_cm=2 * world.body.radius_cm, height_cm=world.body.height_cm)
    return MarkerParams(
        disc_cm=own.disc_cm if disc_cm is None else disc_cm,
        height_cm=own.height_cm if height_cm is None else height_cm,
    )
