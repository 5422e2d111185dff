"""One message to a viewer: everything that is new to it, in one piece.

    uint32 length of the head; head, JSON padded with spaces to a multiple of 8 with those 4 bytes; columns of the rows;
    JPEG; map

The head says how long each part is; what is not new is left out.
"""

from __future__ import annotations

import json
import struct
from typing import Any

from .board import Board, Viewer
from .rows import columns
from .scene import Scene

MOST_ROWS = 16_384
"""Rows in one message; who lacks more gets them with the next."""

_LENGTH = struct.Struct("<I")


def message(board: Board, viewer: Viewer, scene: Scene | None) -> tuple[bytes, bool]:
    """Return what ``viewer`` lacks, noting that it has it now, and whether there is more to come.

    ``scene`` is the one it is to see now, or None for whatever it sees already.
    """
    head: dict[str, Any] = {"status": board.status}
    parts: list[bytes] = []
    if not viewer.greeted:
        viewer.greeted = True
        head["hello"] = board.about
    more = _add_rows(board, viewer, head, parts)
    events = board.events
    if events.version != viewer.events_version:
        viewer.events_version = events.version
        head["events"], head["collisions"] = events.records, events.collisions
    if board.settings is not None and board.settings.version != viewer.settings_version:
        head["settings"] = board.settings.values()
        viewer.settings_version = head["settings"]["version"]
    if scene is not None:
        _add_scene(scene, viewer.map, head, parts)
    return _packed(head, parts), more


def _add_rows(board: Board, viewer: Viewer, head: dict[str, Any], parts: list[bytes]) -> bool:
    version, first, rows = board.rows.since(viewer.rows_version, viewer.row_number, MOST_ROWS)
    if version != viewer.rows_version or len(rows):
        head["rows"] = {"version": version, "first": first, "count": len(rows)}
        parts.append(columns(rows))
    viewer.rows_version, viewer.row_number = version, first + len(rows)
    return len(rows) == MOST_ROWS


def _add_scene(scene: Scene, map_name: str | None, head: dict[str, Any], parts: list[bytes]) -> None:
    head["scene"] = {
        "number": scene.number, "time_s": scene.time_s, "jpeg": len(scene.jpeg), "box": scene.box, "why": scene.why,
    }  # fmt: skip
    parts.append(scene.jpeg)
    packet = None if map_name is None else scene.maps.get(map_name)
    if packet is not None:
        head["scene"]["map"] = {
            "name": packet.name, "peak": packet.peak, "width": packet.width, "height": packet.height,
        }  # fmt: skip
        parts.append(packet.data)


def _packed(head: dict[str, Any], parts: list[bytes]) -> bytes:
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-(len(text) + _LENGTH.size) % 8)
    return b"".join([_LENGTH.pack(len(text)), text, *parts])
