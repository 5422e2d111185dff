"""A network camera that does what a test says: a small RTSP server on loopback, H.264 in RTP inside the connection.

It knows what a player asks of it (OPTIONS, DESCRIBE, SETUP, PLAY) and nothing more. Sources: RFC 2326, section 10.12
for the framing; RFC 6184, sections 5.6 and 5.8 for the packets.
"""

from __future__ import annotations

import base64
import contextlib
import re
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator
from fractions import Fraction

import av
import numpy as np
from numpy.typing import NDArray

from .clips import as_frame

RATE_HZ = 25.0
CLOCK_HZ = 90_000
MOST_BYTES = 1200  # of a NAL unit in one RTP packet
BASE = 0x12345678  # RTP stamps begin anywhere


class RtspCamera:
    """Gives ``image(n)`` as its n-th picture. ``mode``: ``run``, ``silent`` (keeps the connection), ``refuse``."""

    def __init__(self, image: Callable[[int], NDArray[np.uint8]], rate_hz: float = RATE_HZ) -> None:
        self.image, self.rate_hz, self.mode, self.shown = image, rate_hz, "run", 0
        self._links: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"rtsp://127.0.0.1:{self._listener.getsockname()[1]}/camera"
        threading.Thread(target=self._accept, daemon=True).start()

    def __enter__(self) -> RtspCamera:
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()
        self._listener.close()

    def unplug(self) -> None:
        """Cut off everybody, and refuse until ``mode`` says otherwise."""
        self.mode = "refuse"
        links, self._links = self._links, []
        for link in links:
            with contextlib.suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)

    def _accept(self) -> None:
        while True:
            try:
                link, _ = self._listener.accept()
            except OSError:
                return
            if self.mode == "refuse":
                link.close()
                continue
            self._links.append(link)
            threading.Thread(target=self._serve, args=(link,), daemon=True).start()

    def _serve(self, link: socket.socket) -> None:
        units = self._units()
        first = next(units)
        try:
            with link, link.makefile("rb") as requests:
                while request := _request(requests):
                    method, headers = request
                    answer = {"CSeq": headers.get("cseq", "0")}
                    body = b""
                    if method == "DESCRIBE":
                        answer["Content-Type"] = "application/sdp"
                        body = _description(first[1])
                    elif method == "SETUP":
                        answer |= {"Transport": "RTP/AVP/TCP;unicast;interleaved=0-1", "Session": "1"}
                    elif method == "PLAY":
                        answer |= {"Session": "1"}
                    else:
                        answer["Public"] = "OPTIONS, DESCRIBE, SETUP, PLAY, GET_PARAMETER"
                    link.sendall(_answer(answer, body))
                    if method == "PLAY":
                        threading.Thread(target=self._play, args=(link, first, units), daemon=True).start()
        except OSError:
            pass

    def _play(self, link: socket.socket, first: Unit, units: Iterator[Unit]) -> None:
        begun_s, number = time.monotonic(), 0
        try:
            for count, (tick, nals) in enumerate(_chain(first, units)):
                time.sleep(max(0.0, begun_s + count / self.rate_hz - time.monotonic()))
                if self.mode == "refuse":
                    return
                if self.mode == "silent":
                    continue
                for payload, last in _payloads(nals):
                    head = struct.pack(">BBHII", 0x80, 96 | (last << 7), number & 0xFFFF, (tick + BASE) & 0xFFFFFFFF, 7)
                    link.sendall(struct.pack(">cBH", b"$", 0, len(head) + len(payload)) + head + payload)
                    number += 1
        except OSError:
            pass

    def _units(self) -> Iterator[Unit]:
        """Yield the pictures of one connection as access units: RTP time stamp and NAL units."""
        encoder, count = None, 0
        while True:
            picture = self.image(self.shown)
            self.shown += 1
            if encoder is None:
                encoder = av.CodecContext.create("libx264", "w")
                encoder.height, encoder.width = picture.shape
                encoder.pix_fmt, encoder.time_base = "yuv420p", Fraction(1, CLOCK_HZ)
                encoder.options = {"tune": "zerolatency", "preset": "ultrafast", "g": "10", "threads": "1"}
            frame = as_frame(picture, "yuv420p")
            frame.pts, frame.time_base = round(count * CLOCK_HZ / self.rate_hz), Fraction(1, CLOCK_HZ)
            for packet in encoder.encode(frame):
                yield packet.pts, [nal for nal in re.split(rb"\x00\x00\x00?\x01", bytes(packet)) if nal]
            count += 1


Unit = tuple[int, list[bytes]]


def _chain(first: Unit, units: Iterator[Unit]) -> Iterator[Unit]:
    yield first
    yield from units


def _payloads(nals: list[bytes]) -> Iterator[tuple[bytes, bool]]:
    """Yield the RTP payloads of one picture, each with whether it is the last: whole NAL units, or fragments (FU-A)."""
    for number, nal in enumerate(nals):
        final = number == len(nals) - 1
        if len(nal) <= MOST_BYTES:
            yield nal, final
            continue
        pieces = [nal[i : i + MOST_BYTES] for i in range(1, len(nal), MOST_BYTES)]
        for i, piece in enumerate(pieces):
            start, end = i == 0, i == len(pieces) - 1
            head = bytes([(nal[0] & 0xE0) | 28, (start << 7) | (end << 6) | (nal[0] & 0x1F)])
            yield head + piece, final and end


def _description(nals: list[bytes]) -> bytes:
    sets = ",".join(base64.b64encode(nal).decode() for nal in nals if nal[0] & 0x1F in (7, 8))
    lines = [
        "v=0", "o=- 0 0 IN IP4 127.0.0.1", "s=camera", "c=IN IP4 0.0.0.0", "t=0 0",
        "m=video 0 RTP/AVP 96", "a=rtpmap:96 H264/90000",
        f"a=fmtp:96 packetization-mode=1;sprop-parameter-sets={sets}", "a=control:track",
    ]  # fmt: skip
    return "".join(f"{line}\r\n" for line in lines).encode()


def _request(lines) -> tuple[str, dict[str, str]] | None:
    """Read one request; what a player sends on the data channels is passed over."""
    while True:
        first = lines.read(1)
        if not first:
            return None
        if first != b"$":
            break
        _, length = struct.unpack(">BH", lines.read(3))
        lines.read(length)
    method = (first + lines.readline()).split()[0].decode()
    headers = {}
    while line := lines.readline().strip():
        name, _, value = line.decode().partition(":")
        headers[name.lower()] = value.strip()
    return method, headers


def _answer(headers: dict[str, str], body: bytes) -> bytes:
    if body:
        headers = headers | {"Content-Length": str(len(body))}
    return b"RTSP/1.0 200 OK\r\n" + "".join(f"{k}: {v}\r\n" for k, v in headers.items()).encode() + b"\r\n" + body
