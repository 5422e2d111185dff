"""What Foxglove is given, live or as a recording: channels, their schemas, and how a record becomes messages.

Source: foxglove.dev, message schemas CompressedImage and Log, JSON encoding.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ..frames.jpeg import Jpeg
from ..types import TRACE_DTYPE
from .message import Message
from .said import said, warns

FRAME_ID = "camera"
_NAME = "lobula"

INFO, WARNING = 2, 3
"""Levels of a foxglove.Log."""

_TIME = {
    "type": "object",
    "title": "time",
    "properties": {
        "sec": {"type": "integer", "minimum": 0},
        "nsec": {"type": "integer", "minimum": 0, "maximum": 999_999_999},
    },
}
_TEXT = {"type": "string"}
_JSON_TYPES = {"i": "integer", "f": "number", "b": "boolean", "U": "string"}


class Channel(NamedTuple):
    """A topic and what its messages look like."""

    topic: str
    schema_name: str
    properties: Mapping[str, Any]

    @property
    def schema(self) -> bytes:
        """Its JSON schema."""
        return json.dumps({"title": self.schema_name, "type": "object", "properties": self.properties}).encode()


READINGS = Channel(
    "/lobula/reading",
    "lobula.Reading",
    {name: {"type": _JSON_TYPES[TRACE_DTYPE[name].kind]} for name in TRACE_DTYPE.names or ()},
)
EVENTS = Channel(
    "/lobula/event",
    "lobula.Event",
    {"type": _TEXT, "phase": _TEXT, "frame": {"type": "integer"}, "time_s": {"type": "number"}},
)
LOG = Channel(
    "/lobula/log",
    "foxglove.Log",
    {"timestamp": _TIME, "level": {"type": "integer"}, "message": _TEXT, "name": _TEXT, "file": _TEXT,
     "line": {"type": "integer", "minimum": 0}},
)  # fmt: skip
PICTURES = Channel(
    "/lobula/picture",
    "foxglove.CompressedImage",
    {"timestamp": _TIME, "frame_id": _TEXT, "data": {"type": "string", "contentEncoding": "base64"}, "format": _TEXT},
)
CHANNELS = (READINGS, EVENTS, LOG, PICTURES)


PICTURES_HZ = 4.0


def messages_of(message: Message, at_ns: int, jpeg: Jpeg) -> Iterator[tuple[Channel, bytes]]:
    """Yield what tells of ``message``, which happened at ``at_ns``: the channel and what goes there."""
    if message.kind == "reading":
        yield READINGS, _json(message.record)
    else:
        yield EVENTS, _json(message.record)
        yield LOG, _log(message.record, at_ns)
    if message.picture is not None:
        yield PICTURES, _picture(jpeg(message.picture), at_ns)


def _log(record: Mapping[str, Any], at_ns: int) -> bytes:
    """An event or the summary as a foxglove.Log; collisions that start and lost sources are warnings."""
    return _json({
        "timestamp": _time(at_ns), "level": WARNING if warns(record) else INFO, "message": said(record),
        "name": _NAME, "file": "", "line": 0,
    })  # fmt: skip


def _picture(jpeg: bytes, at_ns: int) -> bytes:
    data = base64.b64encode(jpeg).decode()
    return _json({"timestamp": _time(at_ns), "frame_id": FRAME_ID, "data": data, "format": "jpeg"})


def _json(fields: Mapping[str, Any]) -> bytes:
    return json.dumps(fields, separators=(",", ":"), allow_nan=False).encode()


def _time(at_ns: int) -> dict[str, int]:
    return {"sec": at_ns // 1_000_000_000, "nsec": at_ns % 1_000_000_000}
