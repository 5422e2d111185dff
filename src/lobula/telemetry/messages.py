"""The two kinds of frames: a reading of one picture, and a hello in which the robot says what it is."""

from __future__ import annotations

import math
import struct
from typing import Literal, NamedTuple, cast

from ..types import NEURONS, STATES, Neuron, Spikes, State
from .framing import framed

VERSION = 1
READING, HELLO = 1, 2

Action = Literal["forward", "stop", "turn_left", "turn_right"]
ACTIONS: tuple[Action, ...] = ("forward", "stop", "turn_left", "turn_right")
"""What the wheels do; the position in this tuple is the code on the line."""

NO_MOTOR = 255
DECIDERS = ("all", "lgmds", "lgmd2")
"""Who decides, by the code on the line."""

_RANGES: dict[Neuron, tuple[float, float]] = {
    "lgmd1": (0.5, 1.0), "lgmd2": (0.5, 1.0), "lptc_r": (0.0, 1.0), "lptc_l": (-1.0, 0.0),
}  # fmt: skip
_READING = struct.Struct("<BBHII4f4BBBBxI")
_HELLO = struct.Struct("<BBHHBxf4f12s16s16s")
_MOST_SPIKES = 255


class RobotReading(NamedTuple):
    """What the robot says of one picture.

    ``sequence`` counts the readings it made, modulo 65536, also those it had no time to send; ``frame`` the pictures it
    looked at and ``time_ms`` the time by its own clock, modulo 2^32, both since it was switched on; ``potentials`` in
    the order of NEURONS; ``action`` what its wheels do, None for a robot that has none; ``step_us`` how long the
    network took, 0 where nobody measures.
    """

    sequence: int
    frame: int
    time_ms: int
    potentials: tuple[float, float, float, float]
    spikes: Spikes
    collision: bool
    state: State
    action: Action | None = None
    step_us: int = 0


class RobotHello(NamedTuple):
    """What the robot is: working size, who decides, intended rate, thresholds in the sign of their potentials.

    ``settings_hash`` names its settings as everywhere in lobula, ``preset`` what they started from, ``version`` the
    lobula they were exported by.
    """

    width: int
    height: int
    neurons: str
    rate_hz: float
    thresholds: tuple[float, float, float, float]
    settings_hash: str
    preset: str
    version: str


class ForeignFrameError(ValueError):
    """A whole frame, but of another version or kind than this lobula knows."""


def reading_frame(reading: RobotReading) -> bytes:
    """Return ``reading`` as it goes over the line, 46 bytes: what a robot that is programmed in Python sends."""
    action = NO_MOTOR if reading.action is None else ACTIONS.index(reading.action)
    spikes = (min(count, _MOST_SPIKES) for count in reading.spikes)
    return framed(
        _READING.pack(
            VERSION, READING, reading.sequence % 2**16, reading.frame % 2**32, reading.time_ms % 2**32,
            *reading.potentials, *spikes, STATES.index(reading.state), reading.collision, action, reading.step_us,
        )
    )  # fmt: skip


def hello_frame(hello: RobotHello) -> bytes:
    """Return ``hello`` as it goes over the line, 78 bytes; texts that are too long are cut."""
    texts = (text.encode("ascii", "replace") for text in (hello.settings_hash, hello.preset, hello.version))
    return framed(
        _HELLO.pack(
            VERSION, HELLO, hello.width, hello.height, DECIDERS.index(hello.neurons), hello.rate_hz, *hello.thresholds,
            *texts,
        )
    )  # fmt: skip


def message_of(payload: bytes) -> RobotReading | RobotHello:
    """Return what a payload says.

    Raises
    ------
    ForeignFrameError : it is of a version or a kind that is not known here
    ValueError : it holds what cannot be, such as a potential that is no number
    """
    if payload[:1] != bytes([VERSION]):
        raise ForeignFrameError(f"version {payload[0] if payload else 'none'} of the frames, known here is {VERSION}")
    kind = payload[1] if len(payload) > 1 else None
    if (kind, len(payload)) == (READING, _READING.size):
        return _reading(payload)
    if (kind, len(payload)) == (HELLO, _HELLO.size):
        return _hello(payload)
    raise ForeignFrameError(f"frames of kind {kind} with {len(payload)} bytes, known here are readings and hellos")


def _reading(payload: bytes) -> RobotReading:
    _, _, sequence, frame, time_ms, *values, step_us = _READING.unpack(payload)
    potentials, spikes, (state, collision, action) = values[:4], values[4:8], values[8:]
    for name, value in zip(NEURONS, potentials, strict=True):
        low, high = _RANGES[name]
        _require(low <= value <= high, name, value)  # NaN never is
    _require(state < len(STATES), "state", state)
    _require(collision <= 1, "collision", collision)
    _require(action < len(ACTIONS) or action == NO_MOTOR, "action", action)
    return RobotReading(
        sequence, frame, time_ms, cast(tuple[float, float, float, float], tuple(potentials)), Spikes(*spikes),
        bool(collision), STATES[state], None if action == NO_MOTOR else ACTIONS[action], step_us,
    )  # fmt: skip


def _hello(payload: bytes) -> RobotHello:
    _, _, width, height, neurons, rate_hz, *rest = _HELLO.unpack(payload)
    thresholds, texts = rest[:4], [text.rstrip(b"\0") for text in rest[4:]]
    _require(width > 0 and height > 0, "size", f"{width} x {height}")
    _require(neurons < len(DECIDERS), "neurons", neurons)
    _require(math.isfinite(rate_hz) and rate_hz >= 0, "rate_hz", rate_hz)
    for name, value in zip(NEURONS, thresholds, strict=True):
        _require(abs(value) <= 1, f"threshold of {name}", value)
    for text in texts:
        _require(all(0x20 <= byte < 0x7F for byte in text), "text", text)
    settings_hash, preset, version = (text.decode("ascii") for text in texts)
    return RobotHello(
        width, height, DECIDERS[neurons], rate_hz, cast(tuple[float, float, float, float], tuple(thresholds)),
        settings_hash, preset, version,
    )  # fmt: skip


def _require(possible: bool, name: str, value: object) -> None:
    if not possible:
        raise ValueError(f"{name} = {value}")
