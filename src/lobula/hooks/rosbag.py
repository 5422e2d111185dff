"""``rosbag:DIR``: a run as a ROS 2 bag of standard messages, without ROS. Needs the extra ``rosbags``."""

from __future__ import annotations

import math
import sqlite3
import time
from pathlib import Path
from shutil import rmtree
from typing import Any

import numpy as np

from ..errors import MissingExtraError, OutputError, ParameterError, pip_install
from ..frames.jpeg import Jpeg
from ..runtime.events import Record
from . import ros_words as words
from .hook import Hook
from .message import Message
from .stream_clock import StreamClock

try:
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore
except ImportError as error:
    raise MissingExtraError(f"hook rosbag needs rosbags: {pip_install('rosbags')}") from error

COMMIT_S = 1.0
"""Readings are committed this often, an event at once."""

PICTURES_HZ = 4.0
FRAME_ID = "camera"

TOPICS = {
    "/lobula/potentials": "std_msgs/msg/Float64MultiArray",
    "/lobula/spikes": "std_msgs/msg/Int32MultiArray",
    "/lobula/collision": "std_msgs/msg/Bool",
    "/lobula/picture/compressed": "sensor_msgs/msg/CompressedImage",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
}
"""Topic -> type. No standard message holds potentials or spikes; arrays with a label come nearest, and are plotted."""

_TYPES = get_typestore(Stores.ROS2_HUMBLE)


def make(target: str) -> Hook:
    """Return the hook of ``rosbag:DIR``.

    Raises
    ------
    ParameterError : no folder is named, or one that is there
    """
    name = target.partition(":")[2]
    if name in ("", "-"):
        raise ParameterError(f"hook {target}: must be rosbag:DIR")
    if Path(name).exists():
        raise ParameterError(f"hook {target}: is there already: must be a new folder")
    return Rosbag(Path(name))


class Rosbag(Hook):
    """Writes a bag with SQLite storage, which every ROS 2 can read.

    What is sent within a second is one transaction, so a crash or a full disk costs no more than that and leaves a
    sound file. ``metadata.yaml`` comes with the summary.
    """

    readings_hz = math.inf
    pictures_hz = PICTURES_HZ
    readings_kept = 300  # with some 40 pictures at 30 Hz: 40 MB at 640 x 480

    def __init__(self, path: Path) -> None:
        super().__init__(f"rosbag:{path}")
        self.path: Path = path
        self._writer: Any = None  # made in the hook's own thread: SQLite asks for that
        self._connections: dict[str, Any] = {}
        self._clock = StreamClock()
        self._jpeg = Jpeg()
        self._waiting: list[tuple[str, int, bytes]] = []
        self._added: Message | None = None  # the last one, which comes again if the disk was full
        self._finished = False
        self._commit_s = 0.0

    def check(self) -> None:
        """See whether the folder can be made.

        Raises
        ------
        OutputError : it cannot
        """
        try:
            self.path.mkdir()
            self.path.rmdir()  # it is the library that makes it
        except OSError as error:
            raise OutputError(f"cannot write {self.path}: {error.strerror}") from error

    def connect(self, header: Record) -> None:
        """Begin the bag, the first time."""
        if self._writer is None:
            writer = Writer(self.path, version=8)  # the newest metadata that ROS 2 Humble reads
            try:
                writer.open()
                self._connections = {
                    topic: writer.add_connection(topic, kind, typestore=_TYPES) for topic, kind in TOPICS.items()
                }
            except sqlite3.Error as error:
                rmtree(self.path, ignore_errors=True)  # it was made just now, and the library wants a new one
                raise OSError(str(error)) from error
            self._writer = writer

    def send(self, message: Message) -> None:
        """Add one message; when it returns, it is in the bag, or in memory for the next transaction."""
        if message is not self._added:
            self._add(message)
            self._added = message
        if message.kind != "reading" or time.monotonic() - self._commit_s > COMMIT_S:
            self._commit()
        if message.kind == "summary" and not self._finished:
            try:
                self._writer.close()
            except sqlite3.Error as error:
                raise OSError(str(error)) from error
            self._finished = True

    def disconnect(self) -> None:
        """Commit what waits; the bag itself stays open for what may follow."""
        if self._writer is not None and not self._finished:
            self._commit()

    def _commit(self) -> None:
        """Write all that waits, or nothing of it."""
        database, counts = self._writer.storage.conn, dict(self._writer.counts)
        try:
            for topic, at_ns, data in self._waiting:
                self._writer.write(self._connections[topic], at_ns, data)
            database.commit()
        except sqlite3.Error as error:
            database.rollback()
            self._writer.counts = counts
            raise OSError(str(error)) from error
        self._waiting.clear()
        self._commit_s = time.monotonic()

    def _add(self, message: Message) -> None:
        record, at_ns = message.record, self._clock.at_ns(message.record)
        if message.kind == "reading":
            self._put("/lobula/potentials", at_ns, data=np.array(words.potentials(record)), layout=_layout())
            self._put("/lobula/spikes", at_ns, data=np.array(words.spikes(record), np.int32), layout=_layout())
        else:
            self._put("/diagnostics", at_ns, header=_header(at_ns), status=[_status(record)])
            if (alarm := words.alarm(record)) is not None:
                self._put("/lobula/collision", at_ns, data=alarm)
        if message.picture is not None:
            jpeg = np.frombuffer(self._jpeg(message.picture), np.uint8)
            self._put("/lobula/picture/compressed", at_ns, header=_header(at_ns), format="jpeg", data=jpeg)

    def _put(self, topic: str, at_ns: int, **fields: Any) -> None:
        kind = TOPICS[topic]
        data = _TYPES.serialize_cdr(_TYPES.types[kind](**fields), kind)
        self._waiting.append((topic, at_ns, bytes(data)))


def _ros(kind: str, **fields: Any) -> Any:
    return _TYPES.types[kind](**fields)


def _header(at_ns: int) -> Any:
    stamp = _ros("builtin_interfaces/msg/Time", sec=at_ns // 1_000_000_000, nanosec=at_ns % 1_000_000_000)
    return _ros("std_msgs/msg/Header", stamp=stamp, frame_id=FRAME_ID)


def _layout() -> Any:
    dimension = _ros("std_msgs/msg/MultiArrayDimension", label=words.POTENTIALS_LABEL, size=4, stride=4)
    return _ros("std_msgs/msg/MultiArrayLayout", dim=[dimension], data_offset=0)


def _status(record: Record) -> Any:
    status = words.status(record)
    values = [_ros("diagnostic_msgs/msg/KeyValue", key=key, value=value) for key, value in status.values]
    return _ros(
        "diagnostic_msgs/msg/DiagnosticStatus",
        level=status.level, name=status.name, message=status.message, hardware_id=FRAME_ID, values=values,
    )  # fmt: skip
