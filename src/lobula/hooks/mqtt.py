"""``mqtt://`` and ``mqtts://``: publishes the records of a run to a broker. Needs the extra ``mqtt``."""

from __future__ import annotations

import socket
import threading
import time
from contextlib import suppress
from typing import Any
from urllib.parse import unquote

from ..errors import MissingExtraError, ParameterError, pip_install
from ..runtime.events import Record
from .address import Url, split_url
from .hook import TIMEOUT_S, Hook
from .message import Message, header_told, line

try:
    from paho.mqtt.client import Client
    from paho.mqtt.enums import CallbackAPIVersion
except ImportError as error:
    raise MissingExtraError(f"hook mqtt needs paho-mqtt 2: {pip_install('mqtt')}") from error

WANTED = "mqtt[s]://[user:password@]host[:port]/topic"
KEEPALIVE_S = 20
"""The broker holds a silent lobula for dead after one and a half of these, s."""

ONCE_AT_LEAST, ONCE_AT_MOST = 1, 0
_GOODBYE_S = 1.0
_CLOSED = "the broker has closed the connection"
_LOOK_S = 0.1  # between two looks whether the connection is still there


def make(target: str) -> Hook:
    """Return the hook of an ``mqtt://`` or ``mqtts://`` address.

    Raises
    ------
    ParameterError : no host or topic, a wrong port, or a topic with a wildcard
    """
    url = split_url(target, 8883 if target.lower().startswith("mqtts:") else 1883, WANTED)
    topic = unquote(url.path).strip("/")
    if not topic or any(sign in topic for sign in "+#?\0"):
        raise ParameterError(f"hook {url.shown}: must be {WANTED}, the topic without + and #")
    return Mqtt(url, topic)


class Mqtt(Hook):
    """Publishes each record as JSON under ``topic/TYPE``: header, state, collision, reading, summary.

    Events are acknowledged by the broker (quality of service 1), readings are not (0). The header is retained, and so
    is ``topic/online``: 1, or 0 once lobula has ended or the broker has lost it.
    """

    def __init__(self, url: Url, topic: str) -> None:
        super().__init__(f"{url.shown}/{topic}")
        self._url = url
        self._topic = topic
        self._client: Client | None = None

    def connect(self, header: Record) -> None:
        """Log in, publish the header and that lobula is online."""
        answered = threading.Event()
        refusals: list[str] = []

        def on_connect(client: Client, data: Any, flags: Any, reason: Any, properties: Any) -> None:
            if reason.is_failure:
                refusals.append(str(reason))
            answered.set()

        client = Client(CallbackAPIVersion.VERSION2, reconnect_on_failure=False)
        self._client = client
        client.on_connect = on_connect
        client.connect_timeout = TIMEOUT_S
        if self._url.user is not None:
            client.username_pw_set(self._url.user, self._url.password)
        if self._url.scheme == "mqtts":
            client.tls_set()
        client.will_set(f"{self._topic}/online", "0", ONCE_AT_LEAST, retain=True)
        client.connect(*self._url.address, keepalive=KEEPALIVE_S)
        client.loop_start()
        if not answered.wait(TIMEOUT_S):
            raise TimeoutError("the broker does not answer")
        if refusals:
            raise ConnectionRefusedError(f"the broker answers: {refusals[0]}")
        self._publish("header", line(header_told(header))[:-1], ONCE_AT_LEAST, retain=True)
        self._publish("online", b"1", ONCE_AT_LEAST, retain=True)

    def send(self, message: Message) -> None:
        """Publish one record; of an event, wait until the broker has it."""
        quality = ONCE_AT_MOST if message.kind == "reading" else ONCE_AT_LEAST
        self._publish(str(message.record["type"]), line(message.record)[:-1], quality)

    def disconnect(self) -> None:
        """Publish that lobula is no longer online, and log out."""
        if self._client is None:
            return
        try:
            self._publish("online", b"0", ONCE_AT_LEAST, retain=True, timeout_s=_GOODBYE_S)
            self._client.disconnect()
        except OSError:  # cut the line: the broker then publishes the 0 by itself
            connection: Any = self._client.socket()
            if connection is not None:
                with suppress(OSError):
                    connection.shutdown(socket.SHUT_RDWR)
        self._client.loop_stop()
        self._client = None

    def _publish(
        self, name: str, payload: bytes, quality: int, *, retain: bool = False, timeout_s: float | None = None
    ) -> None:
        assert self._client is not None
        deadline_s = time.monotonic() + (TIMEOUT_S if timeout_s is None else timeout_s)
        handed = self._client.publish(f"{self._topic}/{name}", payload, quality, retain)
        while self._client.is_connected() and time.monotonic() < deadline_s:
            try:
                handed.wait_for_publish(_LOOK_S)
                if handed.is_published():
                    return
            except RuntimeError as error:  # it could not even be written
                raise ConnectionResetError(_CLOSED) from error
        if self._client.is_connected():
            raise TimeoutError("the broker does not acknowledge")
        raise ConnectionResetError(_CLOSED)
