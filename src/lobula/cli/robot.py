"""``serial:PORT`` as a source: a robot that decides by itself is recorded and shown, no network is run here."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import typer

from ..errors import ParameterError

if TYPE_CHECKING:
    from ..frames.selection import Selection
    from ..runtime.robot import RobotStream
    from ..telemetry import Port


def is_robot(source: str) -> bool:
    """Whether a source names a robot's serial line."""
    return source.startswith("serial:")


def refuse_others(context: typer.Context, source: str, taken: frozenset[str]) -> None:
    """Check that only options were given that a robot's readings can heed: ``taken``, by their Python names.

    Raises
    ------
    ParameterError : another one was given
    """
    for parameter in context.command.params:
        name = parameter.name or ""
        given = context.get_parameter_source(name)
        if name not in taken and given is not None and given.name in ("COMMANDLINE", "ENVIRONMENT"):
            option = max(parameter.opts, key=len)
            raise ParameterError(
                f"{option}: {source} is a robot, which decides by itself and sends no pictures: may be given only for "
                "sources of pictures"
            )


def port_of(source: str) -> Port:
    """Return the port and the rate that ``serial:PORT[@BAUD]`` names.

    Raises
    ------
    ParameterError : another form, or a rate that this system does not have
    """
    from ..telemetry import parse_port

    return parse_port(source)


def open_robot(port: Port, selection: Selection, reconnect: str | None, timeout_s: float | None) -> RobotStream:
    """Return the robot at ``port``, once it has said what it is.

    Raises
    ------
    ParameterError : an option out of range
    FrameSourceError : no such port, or no robot that speaks
    """
    from ..runtime.robot import RobotStream
    from .live import live_options

    options = {"reconnect_s": math.inf} | live_options(reconnect, timeout_s)
    return RobotStream(port, selection, **options)
