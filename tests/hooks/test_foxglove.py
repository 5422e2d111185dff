"""A live server for Foxglove, looked at by clients that speak its protocol over loopback."""

from __future__ import annotations

import base64
import http.client
import io
import json
import socket
import struct
from contextlib import ExitStack, contextmanager
from functools import partial

import av
import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.hooks import make_hook

from .listeners import free_port
from .office import END, START, SUMMARY, delivered, event, opened, reading, wait_until

pytest.importorskip("foxglove", reason="needs foxglove-sdk (55 MB), the extra foxglove")
pytest.importorskip("websockets", reason="needs websockets, of the extra dashboard")
from websockets.sync.client import connect

from lobula.hooks import foxglove

CHANNELS = {
    "/lobula/reading": "lobula.Reading", "/lobula/event": "lobula.Event",
    "/lobula/log": "foxglove.Log", "/lobula/picture": "foxglove.CompressedImage",
}  # fmt: skip


class Viewer:
    """What Foxglove does: learns of the channels, subscribes, and gets their messages."""

    def __init__(self, stack, port, topics=tuple(CHANNELS)):
        address = f"ws://127.0.0.1:{port}"
        self.link = stack.enter_context(connect(address, subprotocols=["foxglove.sdk.v1"], close_timeout=0.1))
        self.server = self.next_of("serverInfo")
        self.channels = {}
        while len(self.channels) < len(CHANNELS):
            self.channels |= {one["topic"]: one for one in self.next_of("advertise")["channels"]}
        self._topics = {self.channels[topic]["id"]: topic for topic in topics}
        wanted = [{"id": number, "channelId": number} for number in self._topics]
        self.link.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))

    def next_of(self, op):
        while True:
            message = self.link.recv(timeout=30)
            if isinstance(message, str) and json.loads(message)["op"] == op:
                return json.loads(message)

    def messages(self, count):
        """Topic -> (log time ns, what the JSON says) of the next ``count`` messages."""
        found = {}
        while count:
            data = self.link.recv(timeout=30)
            if isinstance(data, bytes):
                kind, number, at_ns = struct.unpack("<BIQ", data[:13])
                assert kind == 1
                found.setdefault(self._topics[number], []).append((at_ns, json.loads(data[13:])))
                count -= 1
        return found


@contextmanager
def served():
    """A way to make viewers of a run whose server is up, its hook and its office."""
    port = free_port()
    hook = make_hook(f"foxglove:127.0.0.1:{port}")
    office = opened(hook)
    office.event(event(0))
    wait_until(lambda: office.tallies()[0]["sent"])
    with ExitStack() as stack:
        yield partial(Viewer, stack, port), hook, office


def looking(hook, topic="/lobula/event"):
    return lambda: hook._channels[topic].has_sinks()


def test_readings_and_events_as_foxglove_gets_them():
    with served() as (look, hook, office):
        viewer = look()
        wait_until(looking(hook, "/lobula/log"))
        for index in range(30):
            office.frame(index, reading(index / 30), None)
        office.event(START)
        office.event(END)
        found = viewer.messages(30 + 2 * 2)
        office.close(SUMMARY)
    assert {topic: one["schemaName"] for topic, one in viewer.channels.items()} == CHANNELS
    for one in viewer.channels.values():
        assert (one["encoding"], one["schemaEncoding"]) == ("json", "jsonschema")
        assert json.loads(one["schema"])["title"] == one["schemaName"]
    times_ns, readings = zip(*found["/lobula/reading"], strict=True)
    assert [r["frame"] for r in readings] == list(range(30))
    np.testing.assert_allclose(np.diff(times_ns), 1e9 / 30, atol=2000)  # the frames' own time
    assert readings[0]["lptc_l"] == -0.125
    (start_ns, start), (_, end) = found["/lobula/event"]
    assert (start.items() >= START.items(), end.items() >= END.items()) == (True, True)
    assert (start_ns - times_ns[0]) / 1e9 == pytest.approx(START["time_s"], abs=1e-5)
    assert [(log["level"], log["message"]) for _, log in found["/lobula/log"]] == [
        (3, "collision 1 start"), (2, "collision 1 end"),
    ]  # fmt: skip
    assert office.tallies()[0] == {"hook": hook.name, "sent": 1 + 30 + 3, "dropped": 0, "failures": 0}


def test_pictures_are_made_only_for_those_who_look():
    red = np.full((96, 128, 3), (200, 40, 90), np.uint8)
    with served() as (look, hook, office):
        made, encode = [], hook._jpeg
        hook._jpeg = lambda picture: made.append(1) or encode(picture)
        other = look(["/lobula/event"])
        wait_until(looking(hook))
        office.frame(0, reading(0.0), lambda: red)
        wait_until(lambda: office.tallies()[0]["sent"] == 2)
        assert not made
        viewer = look(["/lobula/picture"])
        wait_until(looking(hook, "/lobula/picture"))
        for index in range(1, 31):
            office.frame(index, reading(index / 30), lambda: red)
        office.event(START)
        found = viewer.messages(3)["/lobula/picture"]  # at 8, 16 and 24 of 30 frames: four a second
        assert set(other.messages(1)) == {"/lobula/event"}
        office.close(SUMMARY)
    assert np.diff([at_ns for at_ns, _ in found]) == pytest.approx([8e9 / 30] * 2, abs=2000)
    assert found[0][1]["format"] == "jpeg"
    with av.open(io.BytesIO(base64.b64decode(found[0][1]["data"]))) as container:
        shown = next(container.decode(video=0)).to_ndarray(format="rgb24").astype(int)
    assert np.abs(shown - (200, 40, 90)).max() < 10


def test_viewers_can_do_nothing_but_look_and_strangers_are_not_heard(capfd):
    with served() as (look, hook, office):
        viewer = look()
        assert viewer.server["capabilities"] == []
        for request in (
            {"op": "advertise", "channels": [{"id": 1, "topic": "/cmd_vel", "encoding": "json", "schemaName": "x"}]},
            {"op": "setParameters", "parameters": [{"name": "decision.collision_spikes", "value": 1}]},
            {"op": "fetchAsset", "uri": "file:///etc/passwd", "requestId": 1},
        ):
            viewer.link.send(json.dumps(request))
            assert "not support" in json.dumps(json.loads(viewer.link.recv(timeout=30)))
        stranger = http.client.HTTPConnection(hook.name.removeprefix("foxglove:"), timeout=30)
        stranger.request("GET", "/")
        with pytest.raises(http.client.HTTPException):
            stranger.getresponse()
        office.close(SUMMARY)
    assert capfd.readouterr() == ("", "")


def asleep(hook):
    """A viewer that asks for everything and then takes nothing from its socket."""
    host, _, port = hook.name.removeprefix("foxglove:").partition(":")
    link = socket.create_connection((host, int(port)), 30)
    link.sendall(
        b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
    )
    answer = b""
    while b"\r\n\r\n" not in answer:
        answer += link.recv(4096)
    channels = [channel.id() for channel in hook._channels.values()]
    request = {"op": "subscribe", "subscriptions": [{"id": number, "channelId": number} for number in channels]}
    text = json.dumps(request).encode()
    link.sendall(b"\x81\xfe" + struct.pack(">HI", len(text), 0) + text)  # a mask of zeros leaves it as it is
    return link


def test_a_viewer_that_never_reads_holds_up_nobody(monkeypatch):
    monkeypatch.setattr(foxglove, "_GOODBYE_S", 0.1)
    with served() as (look, hook, office):
        with asleep(hook):
            wait_until(looking(hook, "/lobula/picture"))
            awake = look(["/lobula/log"])
            big = event(1) | {"text": "x" * 100_000}
            for _ in range(200):  # far more than the system's buffers hold
                office.event(big)
            awake.messages(1)
            office.close(SUMMARY)
        assert office.tallies()[0] == {"hook": hook.name, "sent": 1 + 200 + 1, "dropped": 0, "failures": 0}


def test_a_port_that_is_taken_and_becomes_free():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        office = opened(make_hook(f"foxglove:127.0.0.1:{port}"))
        office.event(event(0))
        wait_until(lambda: office.tallies()[0]["failures"])
        assert "Address already in use" in office.tallies()[0]["problem"]
    wait_until(lambda: office.tallies()[0]["sent"])
    office.close(SUMMARY)
    assert [r["phase"] for r in office.news()] == ["start", "end"]


def test_a_host_that_is_no_address_of_this_machine():
    tally = delivered(make_hook("foxglove:192.0.2.1:8765"), START)
    assert (tally["sent"], tally["dropped"]) == (0, 2)
    assert "Cannot assign requested address" in tally["problem"] or "Can't assign" in tally["problem"]


@pytest.mark.parametrize("target", ["foxglove:", "foxglove:8765", "foxglove:ws://127.0.0.1:8765", "foxglove:h:0"])
def test_targets_that_cannot_be(target):
    with pytest.raises(ParameterError, match=r"must be foxglove:HOST:PORT, port 1 to 65535"):
        make_hook(target)
