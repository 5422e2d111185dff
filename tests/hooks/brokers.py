"""A real MQTT broker on loopback, and someone who listens to it."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
from contextlib import suppress

import pytest

from .listeners import free_port
from .office import wait_until

PLACES = "/usr/sbin:/usr/local/sbin:/opt/homebrew/sbin:" + os.environ.get("PATH", "")


def program(name):
    """Where mosquitto's ``name`` is; Debian keeps it outside of a user's PATH."""
    found = shutil.which(name, path=PLACES)
    if found is None:
        pytest.skip(f"needs {name}: apt install mosquitto")
    return found


class Broker:
    """mosquitto with the given lines of configuration; it may be stopped, killed and started again."""

    def __init__(self, folder, *lines):
        self.port = free_port()
        self._file = folder / "mosquitto.conf"
        user = ["user root"] if os.geteuid() == 0 else []  # or it could not read the folder of a test
        own = [f"listener {self.port} 127.0.0.1", "persistence false", *user]
        self._file.write_text("\n".join([*own, *lines]) + "\n")
        self._process = None
        self.start()

    def start(self):
        self._process = subprocess.Popen(
            [program("mosquitto"), "-c", self._file], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        wait_until(self._answers)

    def _answers(self):
        assert self._process.poll() is None, "mosquitto ended"
        with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), 1):
            return True
        return False

    def kill(self):
        if self._process is not None:
            self._process.send_signal(signal.SIGCONT)
            self._process.kill()
            self._process.wait(10)
            self._process = None

    def send_signal(self, number):
        self._process.send_signal(number)


class Subscriber:
    """Notes what is published under ``topic``: ``got`` holds name, payload and whether it was kept by the broker."""

    def __init__(self, port, topic="#", **login):
        from paho.mqtt.client import Client
        from paho.mqtt.enums import CallbackAPIVersion

        self.got, self._ready = [], False
        self._client = Client(CallbackAPIVersion.VERSION2)
        if login:
            self._client.username_pw_set(**login)
        self._client.on_connect = lambda client, *_: client.subscribe(topic, 1)
        self._client.on_subscribe = self._subscribed
        self._client.on_message = lambda _, __, m: self.got.append((m.topic, json.loads(m.payload), m.retain, m.qos))
        self._client.connect("127.0.0.1", port)
        self._client.loop_start()
        wait_until(lambda: self._ready)

    def _subscribed(self, *_):
        self._ready = True

    def of(self, topic):
        return [payload for name, payload, _, _ in self.got if name == topic]

    def close(self):
        self._client.disconnect()
        self._client.loop_stop()
