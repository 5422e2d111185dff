"""All hooks of a run as one sink: opened, fed and closed together, within one bounded time."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

from ..runtime.events import Record
from ..runtime.sinks import Picture
from ..types import Reading
from .hook import Hook
from .post import RETRY_S, Post

CLOSE_S = 5.0
"""How long the end of a run waits for its hooks, all together, s."""


class PostOffice:
    """The sink of a run's hooks. Once open, none of its calls waits for a hook or fails because of one.

    ``readings_hz`` overrides how many readings a second go to the hooks that carry them.
    """

    def __init__(
        self,
        hooks: Sequence[Hook],
        readings_hz: float | None = None,
        *,
        retry_s: float = RETRY_S,
        close_s: float = CLOSE_S,
    ) -> None:
        self._posts = [Post(hook, readings_hz, retry_s) for hook in hooks]
        self._close_s = close_s

    def open(self, header: Mapping[str, Any]) -> None:
        """Let every hook check what it can; nothing is sent before the first frame.

        Raises
        ------
        LobulaError : a hook can never work
        """
        for post in self._posts:
            post.open(header)

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Hand a reading to the hooks for which one is due."""
        for post in self._posts:
            post.frame(index, reading, picture)

    def event(self, record: Mapping[str, Any]) -> None:
        """Hand an event to every hook."""
        for post in self._posts:
            post.event(record)

    def close(self, summary: Mapping[str, Any]) -> None:
        """Hand over the summary and wait, for a bounded time, until what is queued was delivered."""
        for post in self._posts:
            post.finish(summary)
        deadline_s = time.monotonic() + self._close_s
        for post in self._posts:
            post.wait(max(0.0, deadline_s - time.monotonic()))

    def news(self) -> list[Record]:
        """Return the hook records since the last call: trouble that started, or that is over."""
        return [record for post in self._posts for record in post.news()]

    def tallies(self) -> list[Record]:
        """Return for each hook what became of its messages."""
        return [post.tally() for post in self._posts]
