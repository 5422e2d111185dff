"""Connections to peers that talk, hang up, or lose their power."""

from __future__ import annotations

import socket
import sys

import pytest

from lobula.hooks.address import HostPort
from lobula.hooks.stream import check_peer, connect_tcp


def test_what_the_peer_said_is_thrown_away_and_its_end_is_noticed():
    ours, theirs = socket.socketpair()
    with ours:
        theirs.sendall(b"hello" * 1000)
        check_peer(ours)
        assert ours.gettimeout() == 5.0  # sending may block again, for that long
        ours.setblocking(False)
        with pytest.raises(BlockingIOError):
            ours.recv(1)
        theirs.close()
        with pytest.raises(ConnectionResetError, match="closed by the peer"):
            check_peer(ours)


def test_a_peer_that_never_stops_talking_is_not_listened_to_for_ever():
    class Talker:
        heard = 0

        def recv(self, size):
            self.heard += 1
            assert self.heard < 1000
            return b"x" * size

        def setblocking(self, _):
            pass

        settimeout = setblocking

    check_peer(Talker())


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the system alone decides")
def test_a_peer_whose_power_is_cut_is_lost_after_five_seconds():
    with socket.create_server(("127.0.0.1", 0)) as server, connect_tcp(HostPort(*server.getsockname())) as ours:
        assert ours.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) == 5000  # ms without an answer
        assert ours.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
