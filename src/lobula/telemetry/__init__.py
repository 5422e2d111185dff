"""What a robot says over a serial line: frames, their decoder, the line itself. docs/telemetry.md has every byte."""

from __future__ import annotations

from .decoder import Decoder
from .messages import ACTIONS, Action, RobotHello, RobotReading, hello_frame, reading_frame
from .port import Port, SerialLine, parse_port
from .succession import Place, Succession

__all__ = [
    "ACTIONS",
    "Action",
    "Decoder",
    "Place",
    "Port",
    "RobotHello",
    "RobotReading",
    "SerialLine",
    "Succession",
    "hello_frame",
    "parse_port",
    "reading_frame",
]
