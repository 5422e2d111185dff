"""Payloads between zeros: COBS takes the zeros out of them, a checksum of what is on the line follows.

The checksum is taken of the line's own bytes, not of the payload: damage to a length of COBS would move the payload's
zeros about, far apart, where a checksum promises nothing. So any damage of up to 16 bits in a row is noticed.

Source: Cheshire & Baker, Consistent Overhead Byte Stuffing, IEEE/ACM Transactions on Networking 7(2), 1999; RFC 1662,
appendix C (the checksum).
"""

from __future__ import annotations

LONGEST_PAYLOAD = 253
"""A run of COBS without zeros ends here, and with it the rule that a frame has always the same length."""

_CHECK_BYTES = 3


def crc16(data: bytes) -> int:
    """Return CRC-16/IBM-SDLC of ``data``, also known as X-25 and as the frame check of HDLC and PPP."""
    crc = 0xFFFF
    for byte in data:
        crc = crc >> 8 ^ _TABLE[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFF


def framed(payload: bytes) -> bytes:
    """Return ``payload`` as it goes over the line, its two zeros included: 6 bytes longer."""
    body = bytearray([1])
    code = 0  # where the length of the present run stands
    for byte in payload:
        if byte:
            body.append(byte)
            body[code] += 1
        else:
            code = len(body)
            body.append(1)
    crc = crc16(bytes(body))
    # seven bits a byte and the top one set, so that none of them is zero
    return bytes([0, *body, 0x80 | crc & 0x7F, 0x80 | crc >> 7 & 0x7F, 0x80 | crc >> 14, 0])


def payload_of(block: bytes) -> bytes | None:
    """Return the payload of what came between two zeros, or None where it was damaged on the way."""
    body, tail = block[:-_CHECK_BYTES], block[-_CHECK_BYTES:]
    if not body or not all(byte & 0x80 for byte in tail) or tail[2] > 0x83:
        return None
    if crc16(body) != tail[0] & 0x7F | (tail[1] & 0x7F) << 7 | (tail[2] & 3) << 14:
        return None
    payload = bytearray()
    at = 0
    while at < len(body):
        after = at + body[at]
        if after > len(body):
            return None
        payload += body[at + 1 : after]
        if after < len(body):
            payload.append(0)
        at = after
    return bytes(payload)


def _row(byte: int) -> int:
    for _ in range(8):
        byte = byte >> 1 ^ (0x8408 if byte & 1 else 0)
    return byte


_TABLE = tuple(map(_row, range(256)))
