"""``mcap:FILE``: readings, events and a few pictures a second as a recording for Foxglove. Needs the extra ``mcap``."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any, cast

from ..errors import MissingExtraError, pip_install
from ..frames.jpeg import Jpeg
from ..runtime.events import Record
from . import foxglove_channels as channels
from .address import file_of
from .hook import Hook
from .message import Message, header_told
from .stream_clock import StreamClock
from .whole_writes import WholeWrites

try:
    from mcap.writer import Writer
except ImportError as error:
    raise MissingExtraError(f"hook mcap needs mcap: {pip_install('mcap')}") from error

CHUNK_S = 1.0
"""A chunk of readings is finished and written this often; one with an event at once."""


def make(target: str) -> Hook:
    """Return the hook of ``mcap:FILE.mcap``.

    Raises
    ------
    ParameterError : no file is named, or one with another ending
    """
    return Mcap(file_of(target, ".mcap"))


class Mcap(Hook):
    """Records a run. A file that is there is replaced.

    The file grows by whole chunks, so after a crash everything up to the last one can be read; the index at its end is
    written with the summary.
    """

    readings_hz = math.inf
    pictures_hz = channels.PICTURES_HZ
    readings_kept = 300  # with some 40 pictures at 30 Hz: 40 MB at 640 x 480

    def __init__(self, path: Path) -> None:
        super().__init__(f"mcap:{path}")
        self.path: Path = path
        self._file = WholeWrites(path)
        self._writer: Any = Writer(cast(IO[bytes], self._file))  # half of it has no types
        self._clock = StreamClock()
        self._jpeg = Jpeg()
        self._ids: dict[str, int] = {}  # by topic
        self._added: Message | None = None  # the last one, which comes again if the disk was full
        self._finished = False
        self._chunk_s = 0.0  # when the last one was written

    def check(self) -> None:
        """Make the file, or empty it.

        Raises
        ------
        OutputError : nothing can be written there
        """
        self._file.create()

    def connect(self, header: Record) -> None:
        """Open the file; the first time, begin the recording with the header and the settings."""
        self._file.open()
        if self._ids:
            return
        self._writer.start(library="lobula")
        self._writer.add_metadata("lobula", _as_text(header_told(header)))
        settings = header.get("settings", ())
        self._writer.add_metadata("lobula settings", {row["path"]: str(row["value"]) for row in settings})
        for channel in channels.CHANNELS:
            schema = self._writer.register_schema(channel.schema_name, "jsonschema", channel.schema)
            self._ids[channel.topic] = self._writer.register_channel(channel.topic, "json", schema)

    def send(self, message: Message) -> None:
        """Add one message; when it returns, it is in the file or in the chunk that is written within a second."""
        if message is not self._added:
            self._add(message)
            self._added = message
        if message.kind == "summary" and not self._finished:
            self._writer.finish()
            self._finished = True
        if message.kind != "reading" or time.monotonic() - self._chunk_s > CHUNK_S:
            self._writer.flush()
            self._chunk_s = time.monotonic()

    def disconnect(self) -> None:
        """Write what is still in memory and close the file."""
        try:
            self._writer.flush()
        finally:
            self._file.close()

    def _add(self, message: Message) -> None:
        at_ns = self._clock.at_ns(message.record)
        told_ns = round(message.record["unix_s"] * 1e3) * 1_000_000
        for channel, data in channels.messages_of(message, at_ns, self._jpeg):
            self._writer.add_message(self._ids[channel.topic], log_time=at_ns, data=data, publish_time=told_ns)


def _as_text(record: Mapping[str, Any]) -> dict[str, str]:
    return {key: str(value) for key, value in record.items()}
