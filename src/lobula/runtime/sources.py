"""What the loop asks of whatever it follows: a recording, a camera, a robot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeVar


class Numbered(Protocol):
    """A frame, as far as it is counted."""

    @property
    def index(self) -> int:
        """Its number in its source."""

    @property
    def time_s(self) -> float:
        """Its stamp, s."""


F = TypeVar("F", bound=Numbered)
F_co = TypeVar("F_co", bound=Numbered, covariant=True)


class Source(Protocol):
    """What gives frames."""

    @property
    def live(self) -> bool:
        """Whether it goes on by itself."""

    @property
    def dropped(self) -> int:
        """Frames that were there and not looked at."""

    @property
    def damaged(self) -> int:
        """Frames that could not be read."""

    @property
    def notes(self) -> Sequence[str]:
        """Lines for the user about what is odd but no error."""

    def close(self) -> None:
        """Let go of it."""


class Polled(Protocol[F_co]):
    """A live source, whose frames are waited for."""

    @property
    def ended(self) -> bool:
        """True when no further frame will come."""

    def poll(self, timeout_s: float, /) -> F_co | None:
        """Return the next frame, waiting up to ``timeout_s`` for it; None when none came."""
