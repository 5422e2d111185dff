"""Peers on loopback: what they hear is what a user's own program would."""

from __future__ import annotations

import json
import socket
import threading
from contextlib import suppress


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class LineServer:
    """Listens on a TCP port or a Unix path; ``lines`` holds the records of each connection in turn."""

    def __init__(self, at=("127.0.0.1", 0), reads=True):
        family = socket.AF_UNIX if isinstance(at, str) else socket.AF_INET
        self._server = socket.socket(family)
        self._server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if not reads:
            self._server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        self._server.bind(at)
        self._server.listen()
        self.at = self._server.getsockname()
        self.heard, self._open, self._reads, self.ends = [], [], reads, 0
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    @property
    def records(self):
        """Records by connection; a line without its end is none."""
        return [[json.loads(one) for one in data.split(b"\n")[:-1]] for data in self.heard]

    def _serve(self):
        while True:
            try:
                connection, _ = self._server.accept()
            except OSError:
                return
            self._open.append(connection)
            self.heard.append(b"")
            if self._reads:
                threading.Thread(target=self._read, args=(connection, len(self.heard) - 1), daemon=True).start()

    def _read(self, connection, number):
        with suppress(OSError):
            while data := connection.recv(65536):
                self.heard[number] += data
        self.ends += 1

    def close(self):
        """Die: no connection survives, and nobody listens."""
        for one in (self._server, *self._open):
            with suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._thread.join(10)
