"""When the collisions of a run started."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..runtime.sinks import Picture
from ..types import Reading


class Alarms:
    """A sink that keeps the start of each collision, s."""

    def __init__(self) -> None:
        self.starts_s: list[float] = []

    def open(self, header: Mapping[str, Any]) -> None:
        """Do nothing."""

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Do nothing."""

    def event(self, record: Mapping[str, Any]) -> None:
        """Keep the time if a collision starts."""
        if record["type"] == "collision" and record["phase"] == "start":
            self.starts_s.append(record["time_s"])

    def close(self, summary: Mapping[str, Any]) -> None:
        """Do nothing."""
