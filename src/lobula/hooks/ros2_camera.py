"""The pictures of a ROS 2 topic as a live source: the newest one, at the stamp of its header."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any, NamedTuple

from ..engine.library import available
from ..engine.resize import CoreAreaAverage
from ..errors import FrameSourceError
from ..frames.geometry import View
from ..frames.live import FrameStream
from ..frames.ros_image import DamagedError, RosImages
from ..frames.selection import Picture, Selection
from .ros2 import CompressedImage, HistoryPolicy, Image, QoSProfile, ReliabilityPolicy, rclpy

SPIN_S = 0.1
HEADERS_KEPT = 1000
"""The end of a collision is told half a second late and more, and names a frame of that time."""

OLDEST_S = 10.0
"""A stamp further from the clock than this tells nothing of latency: a bag that is played without its clock."""


class _Arrival(NamedTuple):
    message: Any
    arrived_s: float
    clock_ns: int


class Ros2Camera:
    """Reads one topic, compressed pictures where its name ends in ``/compressed``. The reader's thread spins the node.

    The middleware keeps one picture, the newest; those that come meanwhile go over it and are not counted.

    Raises
    ------
    FrameSourceError : pictures in an encoding that is not read, or ROS was shut down before the first came
    """

    def __init__(self, node: Any, topic: str) -> None:
        self.name = topic
        self.fps = 0.0
        self.frame_count: int | None = None
        self.rotation = 0
        self.damaged = 0
        self.notes: list[str] = []
        self._node = node
        self._images = RosImages(topic)
        self._arrival: _Arrival | None = None
        self._closed = False
        self._count = 0
        self._first_ns = 0
        self._headers: dict[int, Any] = {}
        newest = QoSProfile(depth=1, history=HistoryPolicy.KEEP_LAST, reliability=ReliabilityPolicy.BEST_EFFORT)
        kind = CompressedImage if topic.endswith("/compressed") else Image
        self._subscription = node.create_subscription(kind, topic, self._take, newest)
        self._pictures = self._decoded()
        first = next(self._pictures, None)
        if first is None:
            raise FrameSourceError(f"{topic}: ROS was shut down before a picture came")
        self._first = first
        self.first = first.data

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield the pictures as they come, until the topic is closed.

        Raises
        ------
        FrameSourceError : another encoding came
        """
        yield self._first
        yield from self._pictures

    def header(self, index: int | None) -> Any:
        """Return the header of the picture with this number; of the newest if that is not known any more."""
        headers = self._headers
        return headers.get(index) if index in headers else headers[next(reversed(headers))]

    def close(self) -> None:
        """Ask for an end; it comes within ``SPIN_S``."""
        self._closed = True

    def _take(self, message: Any) -> None:
        self._arrival = _Arrival(message, time.monotonic(), self._node.get_clock().now().nanoseconds)

    def _arrivals(self) -> Iterator[_Arrival]:
        while not self._closed and rclpy.ok():
            rclpy.spin_once(self._node, timeout_sec=SPIN_S)
            arrival, self._arrival = self._arrival, None
            if arrival is not None:
                yield arrival

    def _decoded(self) -> Iterator[Picture]:
        for message, arrived_s, clock_ns in self._arrivals():
            try:
                data = self._images(message)
            except DamagedError as error:
                self.damaged += 1
                if self.damaged == 1:
                    self.notes.append(f"{self.name}: {error}: left out; more such are only counted")
                continue
            stamp = message.header.stamp
            at_ns = stamp.sec * 1_000_000_000 + stamp.nanosec or clock_ns
            index, self._count = self._count, self._count + 1
            self._first_ns = self._first_ns or at_ns
            self._headers[index] = message.header
            if len(self._headers) > HEADERS_KEPT:
                del self._headers[next(iter(self._headers))]
            age_s = (clock_ns - at_ns) / 1e9
            captured_s = arrived_s - age_s if 0 <= age_s < OLDEST_S else None
            yield Picture(data, (at_ns - self._first_ns) / 1e9, index, arrived_s, captured_s)


class Ros2Frames(FrameStream):
    """The newest frame of a camera."""

    def __init__(self, camera: Ros2Camera) -> None:
        self._camera = camera
        super().__init__(camera, View(), Selection(), CoreAreaAverage if available() else None)

    def close(self) -> None:
        """Stop spinning, then end as any stream does."""
        self._camera.close()
        super().close()
