"""MAVLink over UDP, TCP and a serial line, read back with pymavlink."""

from __future__ import annotations

import math
import os
import pty
import socket

import pytest

from lobula.hooks import make_hook

from .listeners import free_port
from .office import END, START, SUMMARY, delivered, event, opened, reading, wait_until

pytest.importorskip("pymavlink", reason="needs pymavlink (93 MB), the extra mavlink")
from pymavlink import mavutil

from lobula.hooks import mavlink
from lobula.hooks.mavlink_link import make_link


def read(link, count):
    """The next ``count`` messages of a pymavlink connection."""
    got = []

    def one():
        message = link.recv_match(blocking=False)
        if message is not None:
            got.append(message)
        return len(got) >= count

    wait_until(one)
    return got


@pytest.fixture
def station():
    """A ground station that listens on UDP."""
    port = free_port(socket.SOCK_DGRAM)
    link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
    link.target = f"mavlink:udpout:127.0.0.1:{port}"
    yield link
    link.close()


def test_collision_and_potentials_as_pymavlink_reads_them(station):
    hook = make_hook(station.target)
    office = opened(hook)
    office.frame(57, reading(1.9, 0.93), None)
    office.event(event(57))
    office.event(START)
    office.event(END)
    office.close(SUMMARY)
    beat, *floats, collision = read(station, 6)
    assert {m.get_srcSystem() for m in (beat, collision)} == {1}
    assert {m.get_srcComponent() for m in (beat, collision)} == {196}  # MAV_COMP_ID_OBSTACLE_AVOIDANCE
    assert beat.get_type() == "HEARTBEAT"
    assert (beat.type, beat.autopilot) == (18, 8)  # onboard controller, no autopilot
    assert [(m.get_type(), m.name, m.time_boot_ms) for m in floats] == [
        ("NAMED_VALUE_FLOAT", name, 1900) for name in ("lgmd1", "lgmd2", "lptc_r", "lptc_l")
    ]
    assert [m.value for m in floats] == pytest.approx([0.93, 0.6, 0.25, -0.125])
    assert collision.get_type() == "COLLISION"
    assert (collision.id, collision.threat_level) == (1, 2)  # MAV_COLLISION_THREAT_LEVEL_HIGH
    assert collision.action == 1  # MAV_COLLISION_ACTION_REPORT: nothing is to move
    unknown = (
        collision.time_to_minimum_delta, collision.altitude_minimum_delta, collision.horizontal_minimum_delta,
    )  # fmt: skip
    assert all(map(math.isnan, unknown))
    assert station.recv_match(blocking=False) is None
    assert office.tallies()[0] | {"hook": ""} == {"hook": "", "sent": 2, "dropped": 0, "failures": 0}


def test_nothing_it_sends_commands_motion(station):
    delivered(make_hook(station.target), START, END, event(0), readings=[reading(i / 30) for i in range(60)])
    kinds = {m.get_type() for m in read(station, 1 + 10 * 4 + 1)}
    assert kinds == {"HEARTBEAT", "NAMED_VALUE_FLOAT", "COLLISION"}


def test_one_heartbeat_a_second(station, monkeypatch):
    now_s = [100.0]
    monkeypatch.setattr(mavlink.time, "monotonic", lambda: now_s[0])
    hook = mavlink.make(station.target)
    hook.connect({})
    from lobula.hooks.message import reading_told

    for at_s in (100.0, 100.5, 101.0, 101.9, 102.0):
        now_s[0] = at_s
        hook.send(reading_told(0, reading(0.0)))
    hook.disconnect()
    kinds = [station.recv_match(blocking=False).get_type() for _ in range(5 * 4 + 3)]
    assert kinds.count("HEARTBEAT") == 3


def test_another_vehicle(station):
    delivered(make_hook(f"{station.target}?sysid=42"), START)
    assert {m.get_srcSystem() for m in read(station, 2)} == {42}


def test_an_old_alarm_is_left_out(station, monkeypatch):
    monkeypatch.setattr(mavlink, "LATE_S", -1.0)
    tally = delivered(make_hook(station.target), START)
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (0, 1, "older than -1 s: left out")
    assert station.recv_match(blocking=False) is None


def test_stamps_after_49_days_fit_the_message(station):
    delivered(make_hook(station.target), readings=[reading(5_000_000.0)])
    assert read(station, 2)[1].time_boot_ms == 5_000_000_000 - 2**32


def test_nobody_listens_and_the_run_does_not_care():
    tally = delivered(make_hook(f"mavlink:udpout:127.0.0.1:{free_port(socket.SOCK_DGRAM)}"), START, START)
    assert (tally["sent"], tally["failures"]) == (2, 0)


def test_waiting_for_a_station_to_call():
    port = free_port(socket.SOCK_DGRAM)
    office = opened(make_hook(f"mavlink:udpin:127.0.0.1:{port}"))
    office.event(START)
    wait_until(
        lambda: office.tallies()[0]["problem"] == "nobody has called yet" if office.tallies()[0]["dropped"] else 0
    )
    station = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}")
    station.write(b"hello")
    office.event(START)
    office.close(SUMMARY)
    assert [m.get_type() for m in read(station, 2)] == ["HEARTBEAT", "COLLISION"]
    station.close()


def test_who_calls_without_end_keeps_nothing_back():
    class Calls:
        count, sent = 0, ()

        def recvfrom(self, _):
            self.count += 1
            assert self.count < 1000
            return b"x", ("127.0.0.1", self.count)

        def sendto(self, packet, at):
            self.sent = (packet, at)

    link = make_link("udpin:127.0.0.1:1")
    link._socket = calls = Calls()
    link.write(b"packet")
    assert calls.sent == (b"packet", ("127.0.0.1", calls.count))


def test_a_broadcast():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as heard:
        heard.bind(("127.255.255.255", 0))
        heard.settimeout(30)
        delivered(make_hook(f"mavlink:udpbcast:127.255.255.255:{heard.getsockname()[1]}"), START)
        assert heard.recv(300)[0] == 0xFD  # where a MAVLink 2 packet starts


def test_tcp_with_a_peer_that_hangs_up_and_comes_back(capfd):
    port = free_port()
    station = mavutil.mavlink_connection(f"tcpin:127.0.0.1:{port}")
    office = opened(make_hook(f"mavlink:tcp:127.0.0.1:{port}"))
    office.event(START)
    assert [m.get_type() for m in read(station, 2)] == ["HEARTBEAT", "COLLISION"]
    station.close()
    office.event(START | {"id": 2})
    wait_until(lambda: office.tallies()[0]["failures"])
    station = mavutil.mavlink_connection(f"tcpin:127.0.0.1:{port}")
    office.event(START | {"id": 3})
    office.close(SUMMARY)
    got = [m for m in read(station, 2) if m.get_type() == "COLLISION"]
    assert got[-1].id in (2, 3)
    station.close()
    assert capfd.readouterr().out == ""


def test_a_serial_line():
    pytest.importorskip("serial", reason="needs pyserial, the extra mavlink")
    autopilot, line = pty.openpty()
    delivered(make_hook(f"mavlink:{os.ttyname(line)},115200"), START)
    parser = mavutil.mavlink.MAVLink(None)
    got = []
    while len(got) < 2:
        got += parser.parse_buffer(os.read(autopilot, 4096)) or []
    assert [m.get_type() for m in got] == ["HEARTBEAT", "COLLISION"]
    os.close(autopilot)
    os.close(line)


def test_a_serial_line_without_a_rate():
    pytest.importorskip("serial", reason="needs pyserial, the extra mavlink")
    assert make_link("/dev/ttyACM0")._baud == 57600


def test_a_serial_line_that_is_not_there():
    pytest.importorskip("serial", reason="needs pyserial, the extra mavlink")
    tally = delivered(make_hook("mavlink:/dev/no-such-line"), START)
    assert (tally["sent"], "No such file" in tally["problem"]) == (0, True)
