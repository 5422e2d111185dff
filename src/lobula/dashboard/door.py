"""The door: a token is looked at here and nowhere else, so that guessing is slow whichever way the guesses come."""

from __future__ import annotations

import asyncio

from .access import Access

AFTER_WRONG_TOKEN_S = 0.5
"""So long whoever guesses tokens waits for each answer, s."""

MOST_GUESSES = 8
"""So many wrong tokens at most wait for their answers at once, and so hold no more connections than that."""


class BusyError(Exception):
    """``MOST_GUESSES`` wrong tokens wait: before one of them has its answer, no other is looked at."""


class Door:
    """Opens as ``access`` says. For the server's thread."""

    def __init__(self, access: Access) -> None:
        self._access = access
        self._waiting = 0

    def knows(self, session: str | None) -> bool:
        """Whether ``session``, the value of the cookie, opens; nobody guesses its 256 bits, so it never waits."""
        return self._access.opened_by(session=session)

    async def opens_to(self, token: str) -> bool:
        """Whether ``token`` opens; a wrong one learns it after ``AFTER_WRONG_TOKEN_S``.

        Raises
        ------
        BusyError : too many guesses wait. The right token is turned away, too: else a quick answer told it from others
        """
        if self._waiting >= MOST_GUESSES:
            raise BusyError
        if self._access.opened_by(token=token):
            return True
        self._waiting += 1
        try:
            await asyncio.sleep(AFTER_WRONG_TOKEN_S)
        finally:
            self._waiting -= 1
        return False
