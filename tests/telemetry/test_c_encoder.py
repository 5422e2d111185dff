"""The robot's C and the laptop's Python speak of the same frames: whatever C sends, Python reads."""

from __future__ import annotations

import ctypes as c
import os
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given, settings

from lobula.telemetry import ACTIONS, Decoder, hello_frame, reading_frame
from lobula.types import STATES

from .test_messages import HELLO, READING, readings

ROBOT = Path(__file__).parents[2] / "core" / "robot"
COMPILER = shlex.split(os.environ.get("CC", "cc"))

pytestmark = [
    pytest.mark.skipif(shutil.which(COMPILER[0]) is None, reason="no C compiler on this machine"),
    pytest.mark.skipif(not ROBOT.is_dir(), reason="no C sources beside the tests"),
]


class CReading(c.Structure):
    _fields_ = (
        ("frame", c.c_uint32), ("time_ms", c.c_uint32), ("potentials", c.c_float * 4), ("spikes", c.c_int32 * 4),
        ("state", c.c_int32), ("collision", c.c_int32), ("action", c.c_int32), ("step_us", c.c_uint32),
    )  # fmt: skip


class CHello(c.Structure):
    _fields_ = (
        ("width", c.c_uint16), ("height", c.c_uint16), ("neurons", c.c_uint8), ("rate_hz", c.c_float),
        ("thresholds", c.c_float * 4), ("settings_hash", c.c_char_p), ("preset", c.c_char_p), ("version", c.c_char_p),
    )  # fmt: skip


class CLine(c.Structure):
    _fields_ = (
        ("hello", c.POINTER(CHello)), ("sequence", c.c_uint16), ("until_hello", c.c_uint8), ("begin", c.c_uint8),
        ("end", c.c_uint8), ("waiting", c.c_uint8 * 128),
    )  # fmt: skip


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    target = tmp_path_factory.mktemp("robot") / "telemetry.so"
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O2", "-shared", "-fPIC"]
    subprocess.run([*COMPILER, *flags, "-o", str(target), str(ROBOT / "telemetry.c")], check=True)
    return c.CDLL(str(target))


def in_c(reading):
    action = 255 if reading.action is None else ACTIONS.index(reading.action)
    return CReading(
        reading.frame, reading.time_ms, (c.c_float * 4)(*reading.potentials), (c.c_int32 * 4)(*reading.spikes),
        STATES.index(reading.state), reading.collision, action, reading.step_us,
    )  # fmt: skip


HELLO_IN_C = CHello(
    99, 72, 0, 30.0, (c.c_float * 4)(*HELLO.thresholds), HELLO.settings_hash.encode(), b"default", b"0.1.0"
)


@settings(deadline=None)
@given(readings)
def test_any_reading(library, reading):
    out = c.create_string_buffer(46)
    library.lobula_telemetry_encode_reading(c.byref(in_c(reading)), c.c_uint16(reading.sequence), out)
    assert out.raw == reading_frame(reading)
    assert Decoder().feed(out.raw) == [reading]


def test_a_hello(library):
    out = c.create_string_buffer(78)
    library.lobula_telemetry_encode_hello(c.byref(HELLO_IN_C), out)
    assert out.raw == hello_frame(HELLO)


def test_texts_that_are_too_long_are_cut_alike(library):
    long = HELLO._replace(preset="a preset with a long name", version="0.1.0+a build with a long name")
    out = c.create_string_buffer(78)
    given = CHello(99, 72, 0, 30.0, HELLO_IN_C.thresholds, HELLO.settings_hash.encode(), long.preset.encode(),
                   long.version.encode())  # fmt: skip
    library.lobula_telemetry_encode_hello(c.byref(given), out)
    assert out.raw == hello_frame(long)


def test_what_a_robot_sends_byte_by_byte(library):
    line, decoder, found = CLine(), Decoder(), []
    library.lobula_telemetry_init(c.byref(line), c.byref(HELLO_IN_C))
    for number in range(70):
        told = in_c(READING._replace(frame=number))
        assert library.lobula_telemetry_put(c.byref(line), c.byref(told)) == 1
        while (byte := library.lobula_telemetry_next(c.byref(line))) >= 0:
            found += decoder.feed(bytes([byte]))
    assert [message.frame for message in found if hasattr(message, "frame")] == list(range(70))
    assert [message.sequence for message in found if hasattr(message, "frame")] == list(range(70))
    assert [i for i, message in enumerate(found) if not hasattr(message, "frame")] == [0, 33, 66]
    assert len(found) == 70 + 3
    assert decoder.damaged == 0
