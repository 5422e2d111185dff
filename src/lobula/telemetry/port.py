"""``serial:PORT[@BAUD]``: a serial line, opened for reading.

The standard library's termios is all it takes on the systems lobula runs on, so there is no extra to install: a device
is a file here, and silence, hang-up and Ctrl-C come the same way as from any other.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import re
import select
import termios
from typing import NamedTuple

from ..errors import FrameSourceError, ParameterError

PREFIX = "serial:"
DEFAULT_BAUD = 115200
WANTED = "serial:PORT or serial:PORT@BAUD, such as serial:/dev/ttyUSB0@115200"

_READ_BYTES = 4096


def _rates() -> dict[int, int]:
    """Baud rates of this system and the codes it has for them."""
    names = (name for name in vars(termios) if re.fullmatch(r"B[1-9]\d+", name))
    rates = {int(name[1:]): int(getattr(termios, name)) for name in names}
    return {baud: rates[baud] for baud in sorted(rates) if baud >= 1200}


RATES = _rates()


class Port(NamedTuple):
    """A device and the bits a second it runs at; a USB device may heed them or not."""

    path: str
    baud: int


def parse_port(text: str) -> Port:
    """Return ``serial:/dev/ttyUSB0@57600`` as its parts.

    Raises
    ------
    ParameterError : another form, or a rate that this system does not have
    """
    path, at, baud = text.removeprefix(PREFIX).partition("@")
    if not text.startswith(PREFIX) or not path or (at and not baud.isdecimal()):
        raise ParameterError(f"{text}: must be {WANTED}")
    rate = int(baud) if at else DEFAULT_BAUD
    if rate not in RATES:
        raise ParameterError(f"{text}: {rate} baud: must be one of {', '.join(map(str, RATES))}")
    return Port(path, rate)


class SerialLine:
    """An open line: eight bits, no parity, no flow control, nothing changed on the way, nothing sent."""

    def __init__(self, port: Port) -> None:
        """Open it.

        Raises
        ------
        FrameSourceError : it is not there, not a serial line, not ours to open, or in use
        """
        self.port = port
        try:
            self._fd = os.open(port.path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK | os.O_CLOEXEC)
        except OSError as error:
            raise FrameSourceError(f"{port.path}: {_reason(error)}") from error
        try:
            fcntl.flock(self._fd, fcntl.LOCK_EX | fcntl.LOCK_NB)  # two readers would each get half of it
            _make_raw(self._fd, port)
        except (OSError, termios.error) as error:
            os.close(self._fd)
            raise FrameSourceError(f"{port.path}: {_reason(error)}") from error
        except FrameSourceError:
            os.close(self._fd)
            raise

    def read(self, timeout_s: float) -> bytes:
        """Return what has come, after waiting up to ``timeout_s`` for it; empty where nothing has.

        Raises
        ------
        FrameSourceError : the device went away
        """
        try:
            if not select.select([self._fd], [], [], timeout_s)[0]:
                return b""
            data = os.read(self._fd, _READ_BYTES)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise FrameSourceError(f"{self.port.path}: {_reason(error)}", on_the_way=True) from error
        if not data:
            raise FrameSourceError(f"{self.port.path}: the device went away", on_the_way=True)
        return data

    def close(self) -> None:
        """Let go of it; more than once does no harm."""
        if self._fd >= 0:
            with contextlib.suppress(OSError):
                os.close(self._fd)
            self._fd = -1


def _make_raw(fd: int, port: Port) -> None:
    code = RATES[port.baud]
    characters = termios.tcgetattr(fd)[6]
    characters[termios.VMIN], characters[termios.VTIME] = 1, 0
    control = termios.CS8 | termios.CREAD | termios.CLOCAL
    wanted = [termios.IGNBRK, 0, control, 0, code, code, characters]
    termios.tcflush(fd, termios.TCIFLUSH)  # what was kept from before is no news
    termios.tcsetattr(fd, termios.TCSANOW, wanted)
    if termios.tcgetattr(fd)[5] != code:  # a call that succeeds need not have done all it was asked for
        raise FrameSourceError(f"{port.path}: does not run at {port.baud} baud: must be a rate of this device")


def _reason(error: Exception) -> str:
    code = error.args[0] if error.args else None
    words = {
        errno.ENOENT: "no such device",
        errno.EACCES: "no permission: you must be in the group of the device, mostly dialout",
        errno.EISDIR: "is a folder: must be a serial line",
        errno.ENOTTY: "is no serial line",
        errno.EWOULDBLOCK: "in use by another program",
        errno.EBUSY: "in use by another program",
        errno.EIO: "the device went away",
        errno.ENXIO: "the device went away",
        errno.ENODEV: "the device went away",
    }
    return words.get(code, os.strerror(code)) if isinstance(code, int) else str(error)
