"""Word to a service manager: that the run is ready, that it is alive, how it fares, that it ends."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Protocol

BEAT_S = 1.0
"""How often the manager hears of the run, s; a watchdog should wait for several of these."""


class Listener(Protocol):
    """Whoever wants to hear how a run fares, and is quick about it."""

    def beat(self, words: Callable[[], str], ready: bool) -> None:
        """The run is alive; ``words()`` tells how it fares, ``ready`` says that a frame came."""

    def stop(self) -> None:
        """The run ends."""


class Service:
    """Speaks the datagrams of sd_notify(3) to ``address``. A manager that does not listen is no fault of the run."""

    def __init__(self, address: str) -> None:
        self._address = f"\0{address[1:]}" if address.startswith("@") else address  # @: a name outside the file system
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
        self._socket.setblocking(False)
        self._ready = False
        self._told_s = -BEAT_S

    def beat(self, words: Callable[[], str], ready: bool) -> None:
        """Say that the run is alive, once every ``BEAT_S`` at most, and once that it is ``ready``."""
        now_s = time.monotonic()
        if ready and not self._ready:
            self._ready = True
            self._say("READY=1")
        if now_s - self._told_s >= BEAT_S:
            self._told_s = now_s
            self._say(f"WATCHDOG=1\nSTATUS={words()}")

    def stop(self) -> None:
        """Say that the run ends: files are being closed."""
        self._say("STOPPING=1\nSTATUS=closing files")
        self._socket.close()

    def _say(self, text: str) -> None:
        with suppress(OSError):
            self._socket.sendto(text.encode(), self._address)


def find_service(environment: Mapping[str, str] = os.environ) -> Service | None:
    """Return the manager that started this process and wants to be told, or None."""
    address = environment.get("NOTIFY_SOCKET", "")
    return Service(address) if address.startswith(("/", "@")) else None
