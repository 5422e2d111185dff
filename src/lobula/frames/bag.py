"""Pictures of a ROS bag, ROS 1 or 2, without ROS: stamps from the message headers. Needs the extra ``rosbags``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import FrameSourceError, MissingExtraError, pip_install
from .ros_image import COMPRESSED, RAW, DamagedError, RosImages
from .selection import Picture

try:
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore
except ImportError as error:
    raise MissingExtraError(f"ROS bags need rosbags: {pip_install('rosbags')}") from error


def open_bag(path: str, topic: str | None) -> BagReader:
    """Open the pictures of a bag; ``topic`` may be left out if only one has any.

    Raises
    ------
    FrameSourceError : no bag, no such topic, several to choose from, or pictures in an encoding that is not read
    """
    reader = None
    try:
        # bags of ROS 2 Humble and before do not hold the definitions of their messages
        reader = AnyReader([Path(path)], default_typestore=get_typestore(Stores.ROS2_HUMBLE))
        reader.open()
    except Exception as error:  # a damaged file can make the library raise anything
        raise FrameSourceError(f"{path}: {_reason(error)}: must be a ROS bag that rosbags reads") from error
    try:
        return BagReader(reader, path, topic)
    except BaseException:
        reader.close()
        raise


class BagReader:
    """Reads one topic in the order of the bag. Time counts from the stamp of its first picture.

    Pictures that cannot be decoded, or whose stamp is not after the one before, are counted as damaged and left out.
    """

    def __init__(self, reader: Any, name: str, topic: str | None) -> None:
        self.name = name
        self.damaged = 0
        self.notes: list[str] = []
        self.rotation = 0
        self._reader = reader
        self._closed = False
        self._connections = _chosen(reader.connections, name, topic)
        self._images = RosImages(f"{name}: {self._connections[0].topic}")
        self.frame_count: int | None = sum(connection.msgcount for connection in self._connections)
        duration_s = reader.duration / 1e9
        self.fps = (self.frame_count - 1) / duration_s if duration_s > 0 else 0.0
        self._last_s: float | None = None
        self._start_s = 0.0
        self._pictures = self._decoded()
        first = next(self._pictures, None)
        if first is None:
            raise FrameSourceError(f"{name}: none of its {self.frame_count} pictures can be decoded")
        self._first = first
        self.first = first.data

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield the pictures in order; those before ``start_s`` are not decoded.

        Raises
        ------
        FrameSourceError : the bag is damaged, or another encoding came
        """
        self._start_s = start_s or 0.0
        yield self._first
        yield from self._pictures

    def close(self) -> None:
        """Close the bag."""
        if not self._closed:
            self._closed = True
            self._reader.close()

    def _decoded(self) -> Iterator[Picture]:
        for index, time_s, message in self._stamped():
            if self._last_s is not None and time_s <= self._last_s:
                self._leave_out(time_s, "its stamp is not after the one before")
                continue
            if time_s >= self._start_s or self._last_s is None:
                try:
                    picture = Picture(self._images(message), time_s, index)
                except DamagedError as error:
                    self._leave_out(time_s, str(error))
                    continue
                self._last_s = time_s
                yield picture

    def _stamped(self) -> Iterator[tuple[int, float, Any]]:
        """Yield number, time and message of each picture: the header's stamps, or the bag's where those are not set."""
        first_ns, of_header = None, True
        for index, (bag_ns, message) in enumerate(self._messages()):
            stamp = message.header.stamp
            at_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
            if first_ns is None:
                of_header = at_ns != 0
                if not of_header:
                    self.notes.append(f"{self.name}: its pictures have no stamps: the times of recording are taken")
            at_ns = at_ns if of_header else bag_ns
            first_ns = at_ns if first_ns is None else first_ns
            yield index, (at_ns - first_ns) / 1e9, message

    def _messages(self) -> Iterator[tuple[int, Any]]:
        try:
            for connection, bag_ns, data in self._reader.messages(connections=self._connections):
                yield bag_ns, self._reader.deserialize(data, connection.msgtype)
        except Exception as error:  # see open_bag
            raise FrameSourceError(f"{self.name}: damaged or cut off: {_reason(error)}", on_the_way=True) from error

    def _leave_out(self, time_s: float, why: str) -> None:
        self.damaged += 1
        if self.damaged == 1:
            self.notes.append(f"{self.name}: picture at {time_s:.3f} s: {why}: left out; more such are only counted")


def _chosen(connections: list[Any], name: str, topic: str | None) -> list[Any]:
    """Return the connections of the topic that is to be read."""
    found = [connection for connection in connections if connection.msgtype in (RAW, COMPRESSED)]
    topics = sorted({connection.topic for connection in found})
    if not topics:
        raise FrameSourceError(f"{name}: no pictures in it: must hold a topic of {RAW} or {COMPRESSED}")
    if topic is None and len(topics) > 1:
        raise FrameSourceError(
            f"{name}: pictures on several topics: topic (--topic) must be one of {', '.join(topics)}"
        )
    if topic is not None and topic not in topics:
        raise FrameSourceError(f"{name}: topic {topic!r} (--topic): must be one of {', '.join(topics)}")
    chosen = [connection for connection in found if connection.topic == (topic or topics[0])]
    if not any(connection.msgcount for connection in chosen):
        raise FrameSourceError(f"{name}: topic {chosen[0].topic}: holds no message: must hold at least one picture")
    return chosen


def _reason(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return next(iter(text.splitlines()), type(error).__name__).rstrip(".")
