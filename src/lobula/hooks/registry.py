"""Which hooks there are, by the word before the first colon of a target."""

from __future__ import annotations

from importlib import import_module
from typing import NamedTuple

from ..errors import ParameterError
from .hook import Hook


class HookKind(NamedTuple):
    """``form`` is how a target is written, ``about`` what it does, ``module`` the file whose ``make`` makes it."""

    form: str
    about: str
    module: str


KINDS: dict[str, HookKind] = {
    "ndjson": HookKind("ndjson:FILE", "records as lines of a file", "ndjson_file"),
    "unix": HookKind("unix:PATH", "records as lines to a Unix socket", "socket_lines"),
    "tcp": HookKind("tcp:HOST:PORT", "records as lines over TCP", "socket_lines"),
    "exec": HookKind("exec:COMMAND", "runs a program for each event, the record on its standard input", "program"),
    "http": HookKind("http://ADDRESS", "posts each event as JSON", "webhook"),
    "https": HookKind("https://ADDRESS", "posts each event as JSON", "webhook"),
    "mqtt": HookKind("mqtt://HOST/TOPIC", "publishes the records to a broker", "mqtt"),
    "mqtts": HookKind("mqtts://HOST/TOPIC", "publishes the records to a broker, encrypted", "mqtt"),
    "mavlink": HookKind("mavlink:LINK", "COLLISION and potentials for an autopilot or ground station", "mavlink"),
    "foxglove": HookKind("foxglove:HOST:PORT", "a server that Foxglove looks at live, pictures included", "foxglove"),
    "mcap": HookKind("mcap:FILE.mcap", "a recording for Foxglove, pictures included", "mcap"),
    "rosbag": HookKind("rosbag:DIR", "a ROS 2 bag of standard messages, pictures included", "rosbag"),
    "rerun": HookKind("rerun:FILE.rrd", "a recording for Rerun, pictures included", "rerun"),
}
"""Scheme -> kind. A module is imported only when a target asks for it."""


def make_hook(target: str) -> Hook:
    """Return the hook that ``target`` names, ready to be run; nothing is opened yet.

    Raises
    ------
    ParameterError : an unknown scheme, or a target that is wrong for its scheme
    MissingExtraError : its library is not installed
    """
    scheme, colon, _ = target.partition(":")
    kind = KINDS.get(scheme.lower())
    if kind is None or not colon:
        # the word alone: what follows may hold a password
        forms = ", ".join(one.form for one in KINDS.values())
        raise ParameterError(f"hook {scheme!r}: must be one of {forms}")
    hook: Hook = import_module(f".{kind.module}", __package__).make(target)
    return hook
