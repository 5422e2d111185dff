"""The frames of docs/telemetry.md by other means: the CRC of the standard library run backwards, COBS by splitting.

Imports nothing from lobula.
"""

from __future__ import annotations

import binascii
import struct

_TURNED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))


def crc(data: bytes) -> int:
    """CRC-16/IBM-SDLC: the CRC of ``binascii`` on mirrored bytes, mirrored, all bits turned over."""
    mirrored = binascii.crc_hqx(data.translate(_TURNED), 0xFFFF)
    return int(f"{mirrored:016b}"[::-1], 2) ^ 0xFFFF


def cobs(payload: bytes) -> bytes:
    """Every run of bytes up to a zero, or the end, after its length and one."""
    return b"".join(bytes([len(run) + 1]) + run for run in payload.split(b"\0"))


def framed(payload: bytes) -> bytes:
    """A frame with both its zeros."""
    body = cobs(payload)
    bits = crc(body)
    tail = bytes(0x80 | bits >> shift & 0x7F for shift in (0, 7, 14))
    return b"\0" + body + tail + b"\0"


def reading(
    *, sequence=0, frame=0, time_ms=0, potentials=(0.5, 0.5, 0.0, 0.0), spikes=(0, 0, 0, 0), state=0, collision=0,
    action=0, step_us=0,
) -> bytes:  # fmt: skip
    """A reading on the line."""
    head = struct.pack("<BBHII4f", 1, 1, sequence, frame, time_ms, *potentials)
    return framed(head + bytes([*spikes, state, collision, action, 0]) + struct.pack("<I", step_us))


def hello(
    *, width=99, height=72, neurons=0, rate_hz=30.0, thresholds=(0.7, 0.7, 0.2, -0.2), settings_hash=b"0123456789ab",
    preset=b"default", version=b"0.1.0",
) -> bytes:  # fmt: skip
    """A hello on the line."""
    head = struct.pack("<BBHHBBf4f", 1, 2, width, height, neurons, 0, rate_hz, *thresholds)
    return framed(head + settings_hash + preset.ljust(16, b"\0") + version.ljust(16, b"\0"))
