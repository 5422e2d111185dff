"""Bytes in, frames out: in any pieces, with damage and gaps; all that was whole, nothing that was not sent."""

from __future__ import annotations

import random
from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.telemetry import Decoder, RobotReading, hello_frame, reading_frame
from lobula.types import Spikes

from . import oracle
from .test_messages import HELLO


def reading(number: int) -> RobotReading:
    return RobotReading(number, number, 33 * number, (0.5, 0.75, 0.25, 0.0), Spikes(number % 7), False, "ok", "forward")


def line(*numbers: int) -> list[bytes]:
    """A hello and readings, a frame each."""
    return [hello_frame(HELLO), *(reading_frame(reading(number)) for number in numbers)]


SENT = line(*range(252, 258))
WHOLE = b"".join(SENT)


def decoded(data: bytes) -> list:
    return Decoder().feed(data)


EXPECTED = decoded(WHOLE)


def test_everything_that_was_sent():
    hello, *readings = EXPECTED
    assert hello.settings_hash == HELLO.settings_hash
    assert readings == [reading(number) for number in range(252, 258)]


@settings(deadline=None)
@given(st.sets(st.integers(1, len(WHOLE) - 1)))
def test_in_any_pieces(cuts):
    decoder, found = Decoder(), []
    places = [0, *sorted(cuts), len(WHOLE)]
    for first, last in pairwise(places):
        found += decoder.feed(WHOLE[first:last])
    assert found == EXPECTED
    assert (decoder.damaged, decoder.received) == (0, len(WHOLE))


def spared(first: int, last: int) -> list:
    """The frames none of whose bytes lie in first..last."""
    found, at = [], 0
    for frame, message in zip(SENT, EXPECTED, strict=True):
        if last < at or first >= at + len(frame):
            found.append(message)
        at += len(frame)
    return found


def subsequence(found: list, sent: list) -> bool:
    rest = iter(sent)
    return all(any(message == other for other in rest) for message in found)


@settings(max_examples=120, deadline=None)
@given(st.integers(1, 2**16 - 1), st.data())
def test_sixteen_wrong_bits_in_a_row_cost_the_frames_they_hit_and_make_none(burst, data):
    shift = data.draw(st.integers(0, 8 * len(WHOLE) - burst.bit_length()))
    damaged = (int.from_bytes(WHOLE, "little") ^ burst << shift).to_bytes(len(WHOLE), "little")
    found = decoded(damaged)
    assert subsequence(found, EXPECTED)
    assert subsequence(spared(shift // 8, (shift + burst.bit_length() - 1) // 8), found)


@settings(max_examples=120, deadline=None)
@given(st.integers(0, len(WHOLE) - 1), st.integers(1, 45))
def test_bytes_that_are_lost_cost_the_frames_they_are_of_and_make_none(first, count):
    # 46 at once could join the beginning of one reading and the end of the next to something as long as a reading
    found = decoded(WHOLE[:first] + WHOLE[first + count :])
    assert subsequence(found, EXPECTED)
    assert subsequence(spared(first, first + count - 1), found)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.binary(max_size=200), min_size=len(SENT) + 1, max_size=len(SENT) + 1))
def test_whole_frames_are_found_whatever_lies_between_them(rubbish):
    """Any rubbish, of any length, before, between and after: what is whole from zero to zero is received."""
    decoder, found = Decoder(), []
    for before, frame in zip(rubbish, [*SENT, b""], strict=True):
        found += decoder.feed(before + frame)
    assert subsequence(EXPECTED, found)


def test_a_beginning_in_the_middle_is_no_damage():
    for cut in range(2, len(SENT[0])):
        decoder = Decoder()
        assert decoder.feed(WHOLE[cut:]) == EXPECTED[1:]
        assert decoder.damaged == 0


def test_damage_is_counted_once_a_frame():
    frames = [bytearray(frame) for frame in SENT]
    frames[3][20] ^= 0x10
    frames[5][5] = 0  # one that breaks into two
    decoder = Decoder()
    found = decoder.feed(b"".join(frames))
    assert found == [message for i, message in enumerate(EXPECTED) if i not in (3, 5)]
    assert decoder.damaged == 3


def test_random_bytes_make_no_frame_and_no_memory():
    noise = random.Random(5)
    decoder = Decoder()
    for _ in range(200):
        assert decoder.feed(noise.randbytes(4096)) == []
    assert decoder.damaged > 1000
    for _ in range(50):
        decoder.feed(b"\xff" * 4096)  # no zero at all
    assert len(decoder._begun) < 300
    assert decoder.feed(WHOLE) == EXPECTED


def test_a_line_that_is_held_low_is_no_damage():
    decoder = Decoder()
    assert decoder.feed(bytes(5000) + WHOLE + bytes(5000)) == EXPECTED
    assert decoder.damaged == 0


def test_whole_frames_that_say_what_is_not_known_or_cannot_be_are_noted_once():
    decoder = Decoder()
    for _ in range(3):
        assert decoder.feed(oracle.framed(b"\x02\x01" + bytes(38)) + oracle.reading(state=9)) == []
    assert decoder.damaged == 6
    foreign, impossible = decoder.notes
    assert "version 2 of the frames" in foreign
    assert "state = 9" in impossible
