"""Ways to an autopilot, written as pymavlink writes them: UDP, TCP and serial lines that carry whole packets.

pymavlink has links of its own; they print to standard output, where records go, and keep failures to themselves.
"""

from __future__ import annotations

import re
import socket
from abc import ABC, abstractmethod
from typing import Any

from ..errors import MissingExtraError, ParameterError, pip_install
from .address import HostPort, host_port
from .hook import TIMEOUT_S, RefusedError
from .stream import check_peer, connect_tcp

WANTED = "mavlink:udpout|udpin|udpbcast|tcp:HOST:PORT or mavlink:/dev/DEVICE[,BAUD]"
BAUD = 57600
"""What telemetry radios and the second port of most autopilots are set to."""

_CALLS = 100  # looked at before a packet is sent: who calls without end does not keep it back


class Link(ABC):
    """A way to send packets. ``open`` may be called again after ``close``; failures are ``OSError``."""

    @abstractmethod
    def open(self) -> None:
        """Reach the other side."""

    @abstractmethod
    def write(self, packet: bytes | bytearray) -> None:
        """Send one whole packet."""

    @abstractmethod
    def close(self) -> None:
        """Let go; also when nothing is open."""


def make_link(text: str) -> Link:
    """Return the link that ``text`` names, such as ``udpout:127.0.0.1:14550``.

    Raises
    ------
    ParameterError : another form
    MissingExtraError : a serial line without pyserial
    """
    serial = re.fullmatch(r"(/[^,:]+)(?:,(\d+))?", text)
    if serial is not None:
        return SerialLink(serial[1], int(serial[2] or BAUD))
    kind, _, rest = text.partition(":")
    target = f"mavlink:{text}"
    if kind in ("udpout", "udpbcast"):
        return UdpLink(host_port(rest, target, WANTED), broadcast=kind == "udpbcast")
    if kind in ("udpin", "udp"):
        return UdpListener(host_port(rest, target, WANTED))
    if kind == "tcp":
        return TcpLink(host_port(rest, target, WANTED))
    raise ParameterError(f"hook {target}: must be {WANTED}")


class SocketLink(Link):
    """What UDP and TCP have in common."""

    def __init__(self, address: HostPort) -> None:
        self._address = address
        self._socket: socket.socket | None = None

    def close(self) -> None:
        """Close the socket."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


class UdpLink(SocketLink):
    """Sends each packet to an address, or to all of a network; nobody says whether it arrives."""

    def __init__(self, address: HostPort, *, broadcast: bool) -> None:
        super().__init__(address)
        self._broadcast = broadcast
        self._to: Any = None

    def open(self) -> None:
        """Look the address up."""
        family, _, _, _, self._to = socket.getaddrinfo(*self._address, type=socket.SOCK_DGRAM)[0]
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, int(self._broadcast))

    def write(self, packet: bytes | bytearray) -> None:
        """Send one packet as one datagram."""
        assert self._socket is not None
        self._socket.sendto(packet, self._to)


class UdpListener(SocketLink):
    """Waits at an address for someone to call, and sends each packet to whoever called last."""

    _caller: Any = None

    def open(self) -> None:
        """Take the address."""
        family, _, _, _, at = socket.getaddrinfo(*self._address, type=socket.SOCK_DGRAM)[0]
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.bind(at)
        self._socket.setblocking(False)

    def write(self, packet: bytes | bytearray) -> None:
        """Send one packet, if anyone has called.

        Raises
        ------
        RefusedError : nobody has
        """
        assert self._socket is not None
        try:
            for _ in range(_CALLS):
                _, self._caller = self._socket.recvfrom(4096)
        except BlockingIOError:
            pass
        if self._caller is None:
            raise RefusedError("nobody has called yet")
        self._socket.sendto(packet, self._caller)


class TcpLink(SocketLink):
    """Connects to a host."""

    def open(self) -> None:
        """Connect."""
        self._socket = connect_tcp(self._address)

    def write(self, packet: bytes | bytearray) -> None:
        """Send one packet, unless the other side has hung up."""
        assert self._socket is not None
        check_peer(self._socket)
        self._socket.sendall(packet)


class SerialLink(Link):
    """A serial line; its other direction is left unread by lobula and overwritten by the system."""

    def __init__(self, device: str, baud: int) -> None:
        try:
            import serial
        except ImportError as error:
            raise MissingExtraError(f"hook mavlink:{device} needs pyserial: {pip_install('mavlink')}") from error
        self._serial = serial
        self._device = device
        self._baud = baud
        self._port: Any = None

    def open(self) -> None:
        """Open the device."""
        self._port = self._serial.Serial(self._device, self._baud, timeout=0, write_timeout=TIMEOUT_S)

    def write(self, packet: bytes | bytearray) -> None:
        """Send one packet."""
        self._port.write(packet)

    def close(self) -> None:
        """Close the device."""
        if self._port is not None:
            self._port.close()
            self._port = None
