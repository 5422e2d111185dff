"""Bytes as they come, whole frames as they were sent; what was damaged on the way is counted and left out."""

from __future__ import annotations

from .framing import LONGEST_PAYLOAD, payload_of
from .messages import ForeignFrameError, RobotHello, RobotReading, message_of

_LONGEST_BLOCK = LONGEST_PAYLOAD + 4
_MOST_NOTES = 8


class Decoder:
    """Reads one connection. It finds its place at the next zero, whatever came before.

    ``received`` counts bytes; ``damaged`` what stood between two zeros and was no frame, but for what came before the
    first zero, since everybody comes in the middle. ``notes`` says what is odd about frames that were whole.
    """

    def __init__(self) -> None:
        self.received = self.damaged = 0
        self.notes: list[str] = []
        self._begun = b""
        self._placed = False

    def feed(self, data: bytes) -> list[RobotReading | RobotHello]:
        """Take bytes and return what they complete, oldest first."""
        self.received += len(data)
        *blocks, begun = (self._begun + data).split(b"\0")
        self._begun = begun[: _LONGEST_BLOCK + 1]  # longer than any frame is enough to know
        found = []
        for block in blocks:
            message = self._message(block)
            if message is not None:
                found.append(message)
            elif block and self._placed:
                self.damaged += 1
            self._placed = True
        return found

    def _message(self, block: bytes) -> RobotReading | RobotHello | None:
        payload = payload_of(block) if len(block) <= _LONGEST_BLOCK else None
        if payload is None:
            return None
        try:
            return message_of(payload)
        except ForeignFrameError as error:
            self._note(f"the robot sends {error}: left out; lobula here and on the robot should be of one version")
        except ValueError as error:
            self._note(f"the robot sends what cannot be ({error}): left out; a fault of its program")
        return None

    def _note(self, text: str) -> None:
        if text not in self.notes and len(self.notes) < _MOST_NOTES:
            self.notes.append(text)
