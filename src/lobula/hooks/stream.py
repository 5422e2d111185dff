"""Connections over which a hook talks and its peer only listens: TCP and Unix stream sockets."""

from __future__ import annotations

import socket
import sys

from .address import HostPort
from .hook import TIMEOUT_S

_READS = 16
"""How often a look at the peer reads, at most: one that never stops talking is not to keep a hook from sending."""


def connect_tcp(address: HostPort) -> socket.socket:
    """Return a connection to ``address``; a host may have several addresses, each is tried.

    Raises
    ------
    OSError : nobody answers
    """
    connection = socket.create_connection(address, TIMEOUT_S)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # an alarm does not wait for company
    if sys.platform == "linux":  # else a peer whose power is cut is missed only after a quarter of an hour
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, round(1000 * TIMEOUT_S))
    return connection


def connect_unix(path: str) -> socket.socket:
    """Return a connection to the Unix stream socket at ``path``.

    Raises
    ------
    OSError : nobody listens there
    """
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        connection.settimeout(TIMEOUT_S)
        connection.connect(path)
    except OSError:
        connection.close()
        raise
    return connection


def check_peer(connection: socket.socket) -> None:
    """Throw away what the peer said, or its line would fill up, and notice if it has hung up.

    Raises
    ------
    ConnectionResetError : it has
    """
    connection.setblocking(False)
    try:
        for _ in range(_READS):
            if not connection.recv(65536):
                raise ConnectionResetError("closed by the peer")
    except BlockingIOError:
        pass
    finally:
        connection.settimeout(TIMEOUT_S)
