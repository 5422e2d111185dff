"""``tcp:HOST:PORT`` and ``unix:PATH``: the records of a run as lines to whoever listens there."""

from __future__ import annotations

import socket
from abc import ABC, abstractmethod

from ..errors import ParameterError
from ..runtime.events import Record
from .address import HostPort, host_port
from .hook import Hook
from .message import Message, header_told, line
from .stream import check_peer, connect_tcp, connect_unix

_LONGEST_PATH = 107  # bytes in sockaddr_un without the closing zero; macOS has 103 and says so itself


def make(target: str) -> Hook:
    """Return the hook of ``tcp:HOST:PORT`` or ``unix:PATH``.

    Raises
    ------
    ParameterError : no host, port or path
    """
    scheme, _, rest = target.partition(":")
    if scheme.lower() == "tcp":
        return TcpLines(host_port(rest, target, "tcp:HOST:PORT"))
    if not rest or len(rest.encode()) > _LONGEST_PATH:
        raise ParameterError(f"hook {target}: must be unix:PATH with at most {_LONGEST_PATH} bytes of path")
    return UnixLines(rest)


class SocketLines(Hook, ABC):
    """Sends the header at the start of each connection, then a line for each record.

    A connection that was broken, or blocked for ``hook.TIMEOUT_S``, is given up: the next one starts with a
    whole line. What the peer sends is thrown away.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._socket: socket.socket | None = None

    def connect(self, header: Record) -> None:
        """Connect and send the header."""
        self._socket = self._connected()
        self._socket.sendall(line(header_told(header)))

    def send(self, message: Message) -> None:
        """Send one line; a peer that has hung up is noticed before, so that the line is not lost with it."""
        assert self._socket is not None
        check_peer(self._socket)
        self._socket.sendall(line(message.record))

    def disconnect(self) -> None:
        """Close the connection."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    @abstractmethod
    def _connected(self) -> socket.socket: ...


class TcpLines(SocketLines):
    """Lines over TCP."""

    def __init__(self, address: HostPort) -> None:
        super().__init__(f"tcp:{address}")
        self._address = address

    def _connected(self) -> socket.socket:
        return connect_tcp(self._address)


class UnixLines(SocketLines):
    """Lines over a Unix stream socket."""

    def __init__(self, path: str) -> None:
        super().__init__(f"unix:{path}")
        self._path = path

    def _connected(self) -> socket.socket:
        return connect_unix(self._path)
