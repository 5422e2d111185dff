"""``foxglove:HOST:PORT``: a server that Foxglove looks at while the run goes on. Needs the extra ``foxglove``."""

from __future__ import annotations

import logging
import math
import threading
from typing import Any

from ..errors import MissingExtraError, pip_install
from ..frames.jpeg import Jpeg
from ..runtime.events import Record
from . import foxglove_channels as channels
from .address import HostPort, host_port
from .hook import Hook
from .message import Message
from .stream_clock import StreamClock

try:
    from foxglove import Channel, Context, Schema, start_server
except ImportError as error:
    raise MissingExtraError(f"hook foxglove needs foxglove-sdk: {pip_install('foxglove')}") from error

BACKLOG = 256
"""Messages that wait for one viewer; the library drops the oldest of one that does not keep up."""

_GOODBYE_S = 1.0


def make(target: str) -> Hook:
    """Return the hook of ``foxglove:HOST:PORT``.

    Raises
    ------
    ParameterError : no host or port
    """
    return Foxglove(host_port(target.partition(":")[2], target, "foxglove:HOST:PORT"))


class Foxglove(Hook):
    """Serves the channels of a recording to whoever connects; sent is what was handed to the server.

    Viewers can do nothing but look: the server offers neither publishing nor parameters nor services.
    """

    readings_hz = math.inf
    pictures_hz = channels.PICTURES_HZ
    readings_kept = 30  # it is for looking at what is, not at what was

    def __init__(self, address: HostPort) -> None:
        super().__init__(f"foxglove:{address}")
        self._address = address
        self._server: Any = None
        self._context: Any = None  # without it its channels close
        self._channels: dict[str, Channel] = {}  # by topic
        self._clock = StreamClock()
        self._jpeg = Jpeg()

    def connect(self, header: Record) -> None:
        """Start the server."""
        # what strangers send it is no news for people; without a handler Python prints it
        logging.getLogger("foxglove").addHandler(logging.NullHandler())
        self._context = Context()
        host, port = self._address
        try:
            self._server = start_server(
                name="lobula", host=host, port=port, context=self._context, message_backlog_size=BACKLOG
            )
        except RuntimeError as error:
            raise OSError(str(error).removeprefix("FoxgloveError: ")) from error
        for channel in channels.CHANNELS:
            schema = Schema(name=channel.schema_name, encoding="jsonschema", data=channel.schema)
            self._channels[channel.topic] = Channel(
                channel.topic, schema=schema, message_encoding="json", context=self._context
            )

    def send(self, message: Message) -> None:
        """Hand over one message; a picture only if somebody looks at it."""
        at_ns = self._clock.at_ns(message.record)
        if not self._channels[channels.PICTURES.topic].has_sinks():
            message = message._replace(picture=None)
        for channel, data in channels.messages_of(message, at_ns, self._jpeg):
            self._channels[channel.topic].log(data, log_time=at_ns)

    def disconnect(self) -> None:
        """Stop the server; one that waits for a viewer which takes nothing is left to itself."""
        if self._server is not None:
            stopping = threading.Thread(target=self._server.stop, daemon=True)
            stopping.start()
            stopping.join(_GOODBYE_S)
            for channel in self._channels.values():
                channel.close()
            self._server = None
