"""Readings and hellos: the bytes of docs/telemetry.md, and refusal of what cannot be."""

from __future__ import annotations

import math
import re
import struct
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.telemetry import RobotHello, RobotReading, hello_frame, reading_frame
from lobula.telemetry.framing import payload_of
from lobula.telemetry.messages import ForeignFrameError, message_of
from lobula.types import STATES, Spikes

from . import oracle

HELLO = RobotHello(99, 72, "all", 30.0, (0.7, 0.7, 0.2, -0.2), "0123456789ab", "default", "0.1.0")
READING = RobotReading(258, 1000, 33333, (0.75, 0.71875, 0.0, -0.25), Spikes(2, 1), True, "ok", "stop", 5120)
OF_THE_ORACLE = {
    "sequence": 258, "frame": 1000, "time_ms": 33333, "potentials": (0.75, 0.71875, 0.0, -0.25), "spikes": (2, 1, 0, 0),
    "state": 0, "collision": 1, "action": 1, "step_us": 5120,
}  # fmt: skip


def single(bits: float) -> float:
    return struct.unpack("<f", struct.pack("<f", bits))[0]


def potential(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, width=32)


readings = st.builds(
    RobotReading,
    st.integers(0, 2**16 - 1), st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1),
    st.tuples(potential(0.5, 1), potential(0.5, 1), potential(0, 1), potential(-1, 0)),
    st.builds(Spikes, *[st.integers(0, 255)] * 4), st.booleans(), st.sampled_from(STATES),
    st.sampled_from([None, "forward", "stop", "turn_left", "turn_right"]), st.integers(0, 2**32 - 1),
)  # fmt: skip


def test_the_examples_of_the_page_are_the_oracle_s_and_ours():
    page = (Path(__file__).parents[2] / "docs" / "telemetry.md").read_text(encoding="utf-8")
    shown = [bytes.fromhex(block) for block in re.findall(r"^```hex\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)]
    assert shown == [oracle.reading(**OF_THE_ORACLE), oracle.hello()]
    assert shown == [reading_frame(READING), hello_frame(HELLO)]


def test_the_examples_read_back():
    assert message_of(payload_of(oracle.reading(**OF_THE_ORACLE)[1:-1])) == READING
    hello = message_of(payload_of(oracle.hello()[1:-1]))
    assert hello == HELLO._replace(thresholds=tuple(map(single, HELLO.thresholds)))


@settings(deadline=None)
@given(readings)
def test_any_reading_comes_as_it_was(reading):
    line = reading_frame(reading)
    assert len(line) == 46
    assert message_of(payload_of(line[1:-1])) == reading


def test_numbers_wrap_and_counts_that_do_not_fit_are_cut():
    line = reading_frame(READING._replace(sequence=65536, frame=2**32 + 5, time_ms=2**32, spikes=Spikes(300, 0, 0, 0)))
    found = message_of(payload_of(line[1:-1]))
    assert (found.sequence, found.frame, found.time_ms, found.spikes.lgmd1) == (0, 5, 0, 255)


def test_texts_that_are_too_long_are_cut():
    line = hello_frame(HELLO._replace(preset="a name of more than sixteen", version="1.2\N{DEGREE SIGN}"))
    assert len(line) == 78
    found = message_of(payload_of(line[1:-1]))
    assert (found.preset, found.version) == ("a name of more t", "1.2?")


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"potentials": (math.nan, 0.5, 0, 0)}, "lgmd1 = nan"),
        ({"potentials": (0.5, 0.4, 0, 0)}, "lgmd2 = 0.4"),
        ({"potentials": (0.5, 0.5, math.inf, 0)}, "lptc_r = inf"),
        ({"potentials": (0.5, 0.5, 0, 0.25)}, "lptc_l = 0.25"),
        ({"state": 5}, "state = 5"),
        ({"collision": 2}, "collision = 2"),
        ({"action": 4}, "action = 4"),
    ],
)
def test_a_reading_that_cannot_be(given, says):
    with pytest.raises(ValueError, match=says):
        message_of(payload_of(oracle.reading(**given)[1:-1]))


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"width": 0}, "size = 0 x 72"),
        ({"neurons": 3}, "neurons = 3"),
        ({"rate_hz": math.nan}, "rate_hz = nan"),
        ({"thresholds": (0.7, 2.0, 0.2, -0.2)}, "threshold of lgmd2 = 2"),
        ({"preset": b"\xff"}, "text = "),
        ({"settings_hash": b"01\x0023456789a"}, "text = "),
    ],
)
def test_a_hello_that_cannot_be(given, says):
    with pytest.raises(ValueError, match=says):
        message_of(payload_of(oracle.hello(**given)[1:-1]))


@pytest.mark.parametrize(
    ("payload", "says"),
    [
        (b"\x02\x01" + bytes(38), "version 2 of the frames"),
        (b"\x01\x07" + bytes(9), "kind 7 with 11 bytes"),
        (b"\x01\x01" + bytes(39), "kind 1 with 41 bytes"),
        (b"\x01", "kind None with 1 bytes"),
    ],
)
def test_frames_of_another_make(payload, says):
    with pytest.raises(ForeignFrameError, match=says):
        message_of(payload)
