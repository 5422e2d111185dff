"""A run on ROS 2 topics, in standard messages whose stamps are those of the pictures."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ..runtime.events import Record
from . import ros_words as words
from .hook import Hook
from .message import Message
from .ros2 import (
    Bool,
    DiagnosticArray,
    DiagnosticStatus,
    Float64MultiArray,
    Int32MultiArray,
    KeyValue,
    MultiArrayDimension,
    MultiArrayLayout,
)

DEPTH = 10
"""Messages a publisher keeps for its subscribers."""


class Ros2Topics(Hook):
    """Publishes readings and events; ``header`` gives the header of the picture with a number."""

    readings_hz = math.inf
    readings_kept = 10  # a late reading is of no use to a robot

    def __init__(self, node: Any, header: Callable[[int | None], Any]) -> None:
        super().__init__("ros2")
        self._header = header
        self._potentials = node.create_publisher(Float64MultiArray, "~/potentials", DEPTH)
        self._spikes = node.create_publisher(Int32MultiArray, "~/spikes", DEPTH)
        self._reading = node.create_publisher(DiagnosticArray, "~/reading", DEPTH)
        self._collision = node.create_publisher(Bool, "~/collision", DEPTH)
        self._diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", DEPTH)
        dimension = MultiArrayDimension(label=words.POTENTIALS_LABEL, size=4, stride=4)
        self._layout = MultiArrayLayout(dim=[dimension], data_offset=0)

    def send(self, message: Message) -> None:
        """Publish one reading, event or summary."""
        record = message.record
        if message.kind == "reading":
            self._potentials.publish(Float64MultiArray(layout=self._layout, data=words.potentials(record)))
            self._spikes.publish(Int32MultiArray(layout=self._layout, data=words.spikes(record)))
            self._reading.publish(self._array(record, words.reading_status(record)))
            return
        if (alarm := words.alarm(record)) is not None:
            self._collision.publish(Bool(data=alarm))
        self._diagnostics.publish(self._array(record, words.status(record)))

    def _array(self, record: Record, status: words.Status) -> Any:
        header = self._header(record.get("frame"))
        told = DiagnosticStatus(
            level=bytes([status.level]),  # a byte is bytes in rclpy
            name=status.name, message=status.message, hardware_id=header.frame_id,
            values=[KeyValue(key=key, value=value) for key, value in status.values],
        )  # fmt: skip
        return DiagnosticArray(header=header, status=[told])
