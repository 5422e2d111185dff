"""What a protocol must know: connect, send one message, let go. Everything else is the ``Post``'s."""

from __future__ import annotations

from collections.abc import Set
from pathlib import Path

from ..runtime.events import Record
from .message import Kind, Message

READINGS_HZ = 5.0
"""How many readings a second go to a hook that carries them, unless it or the user says otherwise."""

TIMEOUT_S = 5.0
"""How long a hook waits for its peer before it calls that a failure, s."""


class RefusedError(Exception):
    """The peer answered and will not have this message: it is not sent again, and the connection stays."""


class Hook:
    """Base of every hook. ``connect``, ``send`` and ``disconnect`` are called from one thread, never two at once.

    Both ``connect`` and ``send`` may block for about ``TIMEOUT_S``, no longer. A failure is an exception whose text is
    the reason in a few words, without passwords: ``OSError`` when the link is lost (it is connected anew, and the
    message is sent again), ``RefusedError`` when only this message could not be taken. Anything else counts as a fault
    of the hook: the message is given up, and it is connected anew.
    """

    kinds: Set[Kind] = frozenset({"event", "reading", "summary"})
    """What it carries."""

    readings_hz: float = READINGS_HZ
    """Readings a second at most, by the frames' own stamps; ``math.inf`` for all of them."""

    pictures_hz: float = 0.0
    """How many readings a second bring their picture; each costs the run a copy, and often a decoding."""

    events_kept: int = 1000
    readings_kept: int = 100
    """How many wait while the hook is busy or its peer away; the oldest goes when another comes."""

    path: Path | None = None
    """The file or folder it writes, if it does; the cli sees to it that it is nothing that is read."""

    def __init__(self, name: str) -> None:
        self.name = name
        """What people and records call it: the target without passwords or other secrets."""

    def wants(self, message: Message) -> bool:
        """Say whether ``message`` is of its business; asked in the run's own thread, so it must be quick."""
        return message.kind in self.kinds

    def check(self) -> None:
        """Do what can fail only for a wrong request; called once, in the run's own thread, before the first frame.

        Raises
        ------
        LobulaError : it can never work, as with a file in a place where nothing may be written
        """

    def connect(self, header: Record) -> None:
        """Reach the peer. ``header`` is the run's header record, with ``thresholds`` and ``settings``."""

    def send(self, message: Message) -> None:
        """Hand over one message; when it returns, the message counts as sent."""
        raise NotImplementedError

    def disconnect(self) -> None:
        """Let go of the peer, after a failure or at the end; also called when nothing is connected."""

    def abort(self) -> None:
        """Let go at once of what a blocked ``send`` still holds; called from another thread when time is up."""
