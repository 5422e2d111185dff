"""The web server: a socket that is there before anything else begins, and a thread of its own."""

from __future__ import annotations

import asyncio
import errno
import socket
import threading
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from types import TracebackType
from typing import Any, Self

from ..errors import MissingExtraError, ParameterError, pip_install
from .access import Access, access_to
from .board import Board

try:
    import uvicorn

    from .app import Toml, make_app
    from .prompt_http import MOST_CONNECTIONS, PromptHttp
except ImportError as missing:
    raise MissingExtraError(
        f"the page needs starlette, uvicorn and websockets: {pip_install('dashboard')}"
    ) from missing

ACCEPTED_AT_ONCE = 16
"""Connections taken from the system in one go: some four times as many can be open before the first of those above
``MOST_CONNECTIONS`` is closed."""

UNREAD_S = 30.0
"""A connection whose other end has taken nothing for so long is cut, s (where the system can, as Linux)."""

_START_S, _STOP_S = 30.0, 5.0


class Site:
    """A page that is served while this context lasts; ``url`` is where, ``access`` what it asks of a visitor."""

    def __init__(
        self, board: Board, toml: Toml, *, host: str = "127.0.0.1", port: int = 0, token: str | None = None,
        also_known_as: Sequence[str] = (),
    ) -> None:  # fmt: skip
        """Take the address.

        Raises
        ------
        ParameterError : no such address on this machine, a port that is taken or not ours to take, a poor token
        """
        self._socket = _listen(host, port)
        self.port = int(self._socket.getsockname()[1])
        try:
            self.access: Access = access_to(host, self.port, token, also_known_as)
        except ParameterError:
            self._socket.close()
            raise
        self.url = f"http://{_reachable(host)}:{self.port}/"
        self._board = board
        self._executor = ThreadPoolExecutor(1, "lobula dashboard scenes")
        config = uvicorn.Config(
            make_app(board, self.access, self._executor, toml),
            http=PromptHttp, loop="asyncio", lifespan="off", log_config=None, log_level="error", access_log=False,
            proxy_headers=False, server_header=False, backlog=ACCEPTED_AT_ONCE, timeout_keep_alive=5,
            timeout_graceful_shutdown=1, h11_max_incomplete_event_size=16_384, ws_max_size=4096,
            ws_per_message_deflate=False,
        )  # fmt: skip
        self._server = uvicorn.Server(config)
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="lobula dashboard", daemon=True)

    @property
    def link(self) -> str:
        """The address with the token in it, where there is one: for one pair of eyes."""
        return self.url if self.access.token is None else f"{self.url}?token={self.access.token}"

    def __enter__(self) -> Self:
        self._thread.start()
        self._ready.wait(_START_S)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.should_exit = True
        self._thread.join(_STOP_S)
        self._executor.shutdown(wait=False, cancel_futures=True)
        self._socket.close()

    def _serve(self) -> None:
        asyncio.run(self._run())

    async def _run(self) -> None:
        self._board.attach(asyncio.get_running_loop())
        serving = asyncio.create_task(self._server.serve(sockets=[self._socket]))
        while not self._server.started and not serving.done():
            await asyncio.sleep(0.01)
        if self._server.started:
            self._socket.listen(MOST_CONNECTIONS)  # those in the system's queue hold none of our file descriptors
        self._ready.set()
        await serving


def _listen(host: str, port: int) -> socket.socket:
    """Return a socket that listens."""
    where = f"--host {host}, --port {port}"
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (socket.gaierror, UnicodeError) as error:
        raise ParameterError(f"--host {host}: must be an address or a name of this machine") from error
    family, kind, protocol, _, address = found[0]
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        _cut_when_unread(listener)
        listener.bind(address)
        listener.listen(MOST_CONNECTIONS)
    except OSError as error:
        listener.close()
        reasons = {
            errno.EADDRINUSE: "taken: must be free, or 0 for any that is",
            errno.EACCES: "not this user's to take: must be 1024 or above",
            errno.EADDRNOTAVAIL: "must be an address of this machine",
        }
        raise ParameterError(f"{where}: {reasons.get(error.errno or 0, error.strerror)}") from error
    return listener


def _cut_when_unread(listener: Any) -> None:
    option = getattr(socket, "TCP_USER_TIMEOUT", None)
    if option is not None:  # connections take it over from the socket they came in by
        listener.setsockopt(socket.IPPROTO_TCP, option, round(1000 * UNREAD_S))


def _reachable(host: str) -> str:
    """Return the host as another machine writes it; where all addresses are served, the one that leads outside."""
    if host in ("0.0.0.0", "::"):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe, suppress(OSError):
            probe.connect(("192.0.2.1", 9))  # sends nothing: asks the system which address it would take
            return str(probe.getsockname()[0])
        return socket.gethostname()
    return f"[{host}]" if ":" in host else host
