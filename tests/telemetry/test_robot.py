"""A robot over a pseudo-terminal: every reading in its place, losses counted, restarts and returns told."""

from __future__ import annotations

import random
import time
from contextlib import contextmanager

import pytest

from lobula.errors import FrameSourceError
from lobula.frames.selection import Selection
from lobula.runtime import robot as stream
from lobula.runtime.header import robot_header
from lobula.runtime.robot import RobotStream
from lobula.telemetry import parse_port

from . import oracle
from .robots import frame_of, reading


@contextmanager
def heard(robot, *, select=None, **how):
    """A stream of the robot, which has said hello."""
    robot.greet()
    with RobotStream(parse_port(robot.port), Selection(**(select or {})), timeout_s=20.0, **how) as found:
        yield found


def take(found, count, timeout_s=20.0):
    """The next ``count`` readings."""
    frames, until_s = [], time.monotonic() + timeout_s
    while len(frames) < count:
        assert time.monotonic() < until_s, f"only {len(frames)} of {count}"
        frame = found.poll(0.1)
        if frame is not None:
            frames.append(frame)
    return frames


def numbers(frames):
    return [frame.index for frame in frames]


def settled(true, timeout_s=20.0):
    until_s = time.monotonic() + timeout_s
    while not true():
        assert time.monotonic() < until_s
        time.sleep(0.01)


def test_what_it_is_and_what_it_says(robot):
    with heard(robot) as found:
        assert (found.name, found.width, found.height, found.fps) == (robot.port, 99, 72, 30.0)
        assert found.hello.thresholds == pytest.approx((0.7, 0.7, 0.2, -0.2))
        robot.tell(458, 465)
        frames = take(found, 8)
        assert (found.dropped, found.damaged, found.notes) == (0, 0, [])
    assert numbers(frames) == list(range(8))
    assert [frame.time_s for frame in frames] == pytest.approx([k / 100 for k in range(8)])
    assert [frame.reading.collision for frame in frames] == [False, False, *[True] * 6]
    assert frames[3].reading[1:5] == (0.75, 0.875, 0.0, -0.125)
    assert (frames[3].reading.spikes, frames[3].action, frames[3].step_s) == ((2, 3, 0, 0), "stop", 0.0025)


def test_the_header_says_what_the_robot_says(robot):
    with heard(robot) as found:
        header = robot_header(found)
    assert header | {"thresholds": {}} == {
        "type": "header", "version": "0.1.0", "preset": "default", "neurons": "all", "settings_hash": "0123456789ab",
        "engine": "robot", "source": robot.port, "width": 99, "height": 72, "fps": 30.0, "thresholds": {},
        "settings": [],
    }  # fmt: skip
    assert header["thresholds"] == pytest.approx({"lgmd1": 0.7, "lgmd2": 0.7, "lptc_r": 0.2, "lptc_l": -0.2})


def test_settings_are_listed_where_the_hash_is_that_of_the_preset(robot):
    from lobula.model.presets import preset
    from lobula.params import settings_hash

    robot.greet(settings_hash=settings_hash(preset("paper")).encode(), preset=b"paper")
    with RobotStream(parse_port(robot.port), Selection(), timeout_s=20) as found:
        rows = robot_header(found)["settings"]
    assert {row["path"]: row["value"] for row in rows}["lgmd1.spiking.threshold"] == 0.7


def test_noise_at_the_start(robot):
    robot.then(lambda: robot.say(random.Random(1).randbytes(3000)), lambda: robot.say(oracle.hello()))
    with RobotStream(parse_port(robot.port), Selection(), timeout_s=20) as found:
        robot.tell(0, 9)
        assert numbers(take(found, 10)) == list(range(10))
        assert found.dropped == 0
        assert found.damaged > 0


def test_lost_and_damaged_bytes(robot):
    frames = [bytearray(frame_of(reading(number))) for number in range(20)]
    del frames[4][10:17]
    frames[9][30] ^= 0x20
    del frames[12][:]
    del frames[15][40:]
    del frames[16][:5]
    with heard(robot) as found:
        robot.say(*map(bytes, frames))
        got = take(found, 15)
        settled(lambda: found.damaged == 3)  # 15 and 16 ran into one
        assert found.dropped == 5
    assert numbers(got) == [k for k in range(20) if k not in (4, 9, 12, 15, 16)]
    assert [frame.time_s for frame in got] == pytest.approx([k / 100 for k in numbers(got)])
    assert [frame.reading.collision for frame in got] == [False] * 15


def test_a_robot_that_restarts(robot):
    with heard(robot) as found:
        robot.tell(5000, 5009)
        take(found, 10)
        time.sleep(0.3)
        robot.tell(2, 6)
        frames = take(found, 5)
        assert [news.phase for news in found.news()] == ["restarted"]
        assert found.dropped == 0
    assert numbers(frames) == list(range(10, 15))
    assert frames[0].time_s >= 0.09 + 0.3
    assert frames[4].time_s - frames[0].time_s == pytest.approx(0.04)


def test_a_restart_right_after_the_start(robot):
    with heard(robot) as found:
        robot.tell(0, 3)
        robot.tell(0, 3)
        assert numbers(take(found, 8)) == list(range(8))
        assert [news.phase for news in found.news()] == ["restarted"]


def test_the_clock_of_the_robot_wraps(robot):
    with heard(robot) as found:
        for number in range(10):
            robot.tell(number, number, time_ms=(2**32 - 50 + 10 * number) % 2**32)
        assert [frame.time_s for frame in take(found, 10)] == pytest.approx([k / 100 for k in range(10)])
        assert found.news() == []


def test_silence_is_no_loss(robot):
    with heard(robot) as found:
        robot.tell(0, 4)
        take(found, 5)
        assert found.poll(0.5) is None
        robot.tell(55, 55, sequence=5)
        (frame,) = take(found, 1)
        assert (frame.index, found.dropped, found.news()) == (55, 0, [])


def test_a_port_that_goes_away_and_comes_back(robot):
    with heard(robot) as found:
        robot.tell(0, 4)
        take(found, 5)
        robot.unplug()
        settled(lambda: found.poll(0.05) is None and found._link.away)
        robot.plug()
        robot.then(lambda: robot.tell(300, 304))
        frames = take(found, 5)
        phases = [news.phase for news in found.news()]
        assert (phases[0], phases[-1]) == ("lost", "back")
        assert set(phases[1:-1]) <= {"retry"}
        assert found.dropped == 0  # what was missed meanwhile is what ``away_s`` tells
    assert numbers(frames) == list(range(300, 305))


def test_a_port_that_goes_away_for_good(robot):
    with heard(robot, reconnect_s=0.0) as found:
        robot.tell(0, 4)
        settled(lambda: len(found._waiting) == 5)
        robot.unplug()
        settled(lambda: found._ended)
        assert numbers(take(found, 5)) == list(range(5))
        with pytest.raises(FrameSourceError, match="the device went away") as caught:
            found.poll(1.0)
        assert caught.value.on_the_way
        assert found.ended


def test_patience_that_ends(robot):
    with heard(robot, reconnect_s=0.4) as found:
        robot.unplug()
        with pytest.raises(FrameSourceError, match="no such device; given up after"):
            take(found, 1)


def test_a_flood_keeps_the_newest(robot, monkeypatch):
    monkeypatch.setattr(stream, "MOST_WAITING", 50)
    with heard(robot) as found:
        robot.tell(0, 299)
        settled(lambda: found.dropped == 250)
        assert numbers(take(found, 50)) == list(range(250, 300))
        assert found.dropped == 250


def test_other_settings_are_told_once(robot):
    with heard(robot) as found:
        robot.tell(0, 0)
        robot.say(oracle.hello(), oracle.hello(preset=b"paper", settings_hash=b"ba9876543210"), oracle.hello(
            preset=b"paper", settings_hash=b"ba9876543210"))  # fmt: skip
        robot.tell(1, 1)
        take(found, 2)
        (news,) = found.news()
        assert (news.phase, news.facts) == ("settings", {"preset": "paper", "settings_hash": "ba9876543210"})
        assert found.hello.preset == "default"


def test_time_that_stands_still_is_dropped(robot):
    with heard(robot) as found:
        robot.tell(0, 2)
        robot.tell(3, 3, time_ms=20)
        robot.tell(4, 4)
        assert numbers(take(found, 4)) == [0, 1, 2, 4]
        assert found.dropped == 1


def test_the_same_twice_counts_once(robot):
    with heard(robot) as found:
        robot.tell(0, 1)
        robot.tell(1, 1)
        robot.tell(2, 2)
        assert numbers(take(found, 3)) == [0, 1, 2]
        assert found.dropped == 0


@pytest.mark.parametrize(
    ("select", "expected"),
    [({"max_frames": 3}, [0, 1, 2]), ({"start_s": 0.05, "end_s": 0.1, "stride": 2}, [5, 7, 9])],
)
def test_a_part_of_it(robot, select, expected):
    with heard(robot, select=select) as found:
        robot.tell(0, 20)
        assert numbers(take(found, 3)) == expected
        settled(lambda: found.ended)
        assert found.poll(0.0) is None


def test_frames_of_another_make_are_left_out_and_noted(robot):
    with heard(robot) as found:
        robot.say(oracle.framed(b"\x02\x01" + bytes(50)), oracle.reading(potentials=(0.1, 0.5, 0, 0)))
        robot.tell(0, 0)
        take(found, 1)
        foreign, impossible = found.notes
        assert "version 2" in foreign
        assert "lgmd1 = 0.1" in impossible


class TestNoRobot:
    @pytest.mark.parametrize(
        ("sent", "says"),
        [
            (b"", "in 0.3 s nothing came: must be a robot that sends"),
            (b"U\xaa" * 50, "in 0.3 s 100 bytes and no frame among them: 115200 baud must be the robot's rate"),
            (frame_of(reading(7)), "in 0.3 s readings but no hello"),
            (oracle.framed(b"\x02\x02" + bytes(9)), "no frame among them: .* version 2 of the frames"),
        ],
    )
    def test_what_is_missing_is_said(self, robot, sent, says):
        robot.then(lambda: robot.say(sent))
        with pytest.raises(FrameSourceError, match=says) as caught:
            RobotStream(parse_port(robot.port), Selection(), timeout_s=0.3)
        assert not caught.value.on_the_way

    def test_no_port(self, tmp_path):
        with pytest.raises(FrameSourceError, match="no such device"):
            RobotStream(parse_port(f"serial:{tmp_path}/none"), Selection(), timeout_s=0.3)

    def test_a_port_that_goes_away_at_once(self, robot):
        robot.then(robot.unplug)
        with pytest.raises(FrameSourceError, match="the device went away"):
            RobotStream(parse_port(robot.port), Selection(), timeout_s=20, reconnect_s=0.0)
