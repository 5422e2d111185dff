"""``rerun:FILE.rrd``: readings, events and a few pictures a second for the Rerun viewer. Needs the extra ``rerun``."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MissingExtraError, pip_install
from ..frames.jpeg import Jpeg
from ..landing import make_empty
from ..runtime.events import Record
from ..types import NEURONS
from .address import file_of
from .hook import TIMEOUT_S, Hook
from .message import Message, header_told, line
from .said import said, warns
from .stream_clock import StreamClock

try:
    import rerun as rr
except ImportError as error:
    raise MissingExtraError(f"hook rerun needs rerun-sdk: {pip_install('rerun')}") from error

FLUSH_S = 1.0
"""Readings are flushed into the file this often, an event at once."""

PICTURES_HZ = 4.0


def make(target: str) -> Hook:
    """Return the hook of ``rerun:FILE.rrd``.

    Raises
    ------
    ParameterError : no file is named, or one with another ending
    """
    return Rerun(file_of(target, ".rrd"))


class Rerun(Hook):
    """Records a run. A file that is there is replaced.

    Two timelines: ``source``, the frames' own time, and ``clock``, the same on the system's clock.
    """

    readings_hz = math.inf
    pictures_hz = PICTURES_HZ
    readings_kept = 300  # with some 40 pictures at 30 Hz: 40 MB at 640 x 480

    def __init__(self, path: Path) -> None:
        super().__init__(f"rerun:{path}")
        self.path: Path = path
        self._stream: Any = None
        self._clock = StreamClock()
        self._jpeg = Jpeg()
        self._added: Message | None = None  # the last one, which comes again if the disk was full
        self._flush_s = 0.0

    def check(self) -> None:
        """Make the file, or empty it.

        Raises
        ------
        OutputError : nothing can be written there
        """
        make_empty(self.path)

    def connect(self, header: Record) -> None:
        """Begin the recording, the first time, with the header and the names of the curves."""
        if self._stream is not None:
            return
        stream = rr.RecordingStream("lobula")
        try:
            stream.save(self.path)
            for entity in ("potentials", "spikes"):
                stream.log(entity, rr.SeriesLines(names=list(NEURONS)), static=True, strict=True)
            stream.log("header", rr.TextDocument(line(header_told(header)).decode()), static=True, strict=True)
        except RuntimeError as error:
            raise OSError(str(error)) from error
        self._stream = stream

    def send(self, message: Message) -> None:
        """Add one message; when it returns, it is in the file or is written within a second."""
        if message is not self._added:
            self._add(message)
            self._added = message
        if message.kind != "reading" or time.monotonic() - self._flush_s > FLUSH_S:
            try:
                self._stream.flush(timeout_sec=TIMEOUT_S)
            except RuntimeError as error:
                raise OSError(str(error)) from error
            self._flush_s = time.monotonic()
        if message.kind == "summary":
            self._stream.disconnect()  # writes the index

    def disconnect(self) -> None:
        """Flush what waits; the recording itself stays open for what may follow."""
        if self._stream is not None:
            with suppress(RuntimeError):
                self._stream.flush(timeout_sec=TIMEOUT_S)

    def _add(self, message: Message) -> None:
        record, stream = message.record, self._stream
        at_ns = self._clock.at_ns(record)
        stream.set_time("clock", timestamp=np.datetime64(at_ns, "ns"))
        if "time_s" in record:
            stream.set_time("source", duration=np.timedelta64(round(record["time_s"] * 1e9), "ns"))
        if message.kind == "reading":
            stream.log("potentials", rr.Scalars([record[name] for name in NEURONS]), strict=True)
            stream.log("spikes", rr.Scalars([record[f"spikes_{name}"] for name in NEURONS]), strict=True)
            stream.log("collision", rr.Scalars([float(record["collision"])]), strict=True)
        else:
            level = rr.TextLogLevel.WARN if warns(record) else rr.TextLogLevel.INFO
            stream.log("events", rr.TextLog(said(record), level=level), strict=True)
        if message.picture is not None:
            jpeg = self._jpeg(message.picture)
            stream.log("picture", rr.EncodedImage(contents=jpeg, media_type="image/jpeg"), strict=True)
