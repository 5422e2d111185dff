"""HTTP that takes only so many connections and does not wait for ever for what they want."""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

MOST_CONNECTIONS = 64
"""Connections there may be at once, viewers' streams among them."""

REQUEST_S = 10.0
"""A request whose head has not come whole after this long is given up, s."""


class PromptHttp(H11Protocol):
    """Closes connections above ``MOST_CONNECTIONS``: each is a file descriptor, and the detector needs some, too.

    So it does with those that hold a place without asking for anything, such as those of a phone that has gone.
    """

    _hurry: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Give the first request its time, if there is a place."""
        super().connection_made(transport)
        if len(self.connections) > MOST_CONNECTIONS:
            transport.abort()
            return
        self._begin()

    def data_received(self, data: bytes) -> None:
        """Stop the clock when a request is whole; start it when part of the next one has come."""
        before = self.cycle
        super().data_received(data)
        if self.cycle is not before:
            self._stop()
        elif before is not None and before.response_complete and self._hurry is None:
            self._begin()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the clock."""
        self._stop()
        super().connection_lost(exc)

    def _begin(self) -> None:
        self._hurry = self.loop.call_later(REQUEST_S, self._give_up)

    def _stop(self) -> None:
        if self._hurry is not None:
            self._hurry.cancel()
            self._hurry = None

    def _give_up(self) -> None:
        self._hurry = None
        if self.transport.get_protocol() is self:  # not if it has become the stream of a viewer
            self.transport.close()
