"""Frames on the line: known checksums, COBS by its paper, and no damage within the checksum's promise gets through."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.telemetry.framing import crc16, framed, payload_of

from . import oracle

payloads = st.binary(min_size=1, max_size=253)


def test_the_checksum_of_the_usual_nine_digits():  # the check value in catalogues of CRCs
    assert crc16(b"123456789") == 0x906E


@settings(deadline=None)
@given(st.binary(max_size=300))
def test_the_checksum_is_that_of_the_standard_library_run_backwards(data):
    assert crc16(data) == oracle.crc(data)


@pytest.mark.parametrize(
    ("payload", "encoded"),  # the examples every description of COBS has
    [("00", "01 01"), ("0000", "01 01 01"), ("11220033", "03 11 22 02 33"), ("11223344", "05 11 22 33 44"),
     ("11000000", "02 11 01 01 01")],
)  # fmt: skip
def test_cobs(payload, encoded):
    line = framed(bytes.fromhex(payload))
    assert line[1:-4] == bytes.fromhex(encoded)
    assert (line[0], line[-1]) == (0, 0)


@settings(deadline=None)
@given(payloads)
def test_a_frame_is_the_oracle_s_and_reads_back(payload):
    line = framed(payload)
    assert line == oracle.framed(payload)
    assert len(line) == len(payload) + 6
    assert 0 not in line[1:-1]
    assert payload_of(line[1:-1]) == payload


@settings(deadline=None)
@given(payloads, st.data())
def test_no_damage_of_up_to_sixteen_bits_in_a_row_is_taken_for_a_frame(payload, data):
    line = bytearray(framed(payload)[1:-1])
    burst = data.draw(st.integers(1, 2**16 - 1))
    bits = int.from_bytes(line, "little") ^ burst << data.draw(st.integers(0, 8 * len(line) - burst.bit_length()))
    damaged = bits.to_bytes(len(line), "little")  # the low bit of a byte goes first over the line
    assert payload_of(damaged) is None


@settings(deadline=None)
@given(payloads, st.data())
def test_no_three_wrong_bits_are_taken_for_a_frame(payload, data):
    line = bytearray(framed(payload)[1:-1])
    for bit in data.draw(st.sets(st.integers(0, 8 * len(line) - 1), min_size=1, max_size=3)):
        line[bit // 8] ^= 1 << bit % 8
    assert payload_of(bytes(line)) is None


@pytest.mark.parametrize("size", range(4))
def test_less_than_any_frame(size):
    assert payload_of(b"\x80" * size) is None


def test_a_run_that_leads_out_of_the_frame_is_damage_though_the_checksum_holds():
    body = b"\x09\x01\x02"
    bits = oracle.crc(body)
    assert payload_of(body + bytes([0x80 | bits & 0x7F, 0x80 | bits >> 7 & 0x7F, 0x80 | bits >> 14])) is None
