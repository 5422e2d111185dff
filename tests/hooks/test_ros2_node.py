"""The ROS 2 node against a stand-in for rclpy: what it publishes, at which stamps, and how it ends."""

from __future__ import annotations

import array
import os
import signal
import sys
import threading

import numpy as np
import pytest

import lobula
from lobula.hooks import ros2_node

from ..frames.clips import image_bytes
from .office import wait_until
from .standin_ros import Ros

TOPIC = "/camera/image_raw"
T0_NS = 1_700_000_000_123_456_789


@pytest.fixture
def ros(monkeypatch):
    ros = Ros()
    ros.install(monkeypatch)
    yield ros
    for name in ("ros2", "ros2_camera", "ros2_topics"):
        sys.modules.pop(f"lobula.hooks.{name}", None)


def header(ros, stamp_ns, frame_id="eye"):
    stamp = ros.messages["Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return ros.messages["Header"](stamp=stamp, frame_id=frame_id)


def image(ros, picture, stamp_ns, encoding="mono8"):
    height, width = picture.shape
    return ros.messages["Image"](
        header=header(ros, stamp_ns), height=height, width=width, encoding=encoding, step=width,
        data=array.array("B", picture.tobytes()),
    )  # fmt: skip


def stamp_ns(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def running(feed, number=signal.SIGINT):
    """Run the node, with ``feed`` in another thread; the node is stopped when that is done. Return the exit code."""
    failed = []

    def work():
        try:
            feed()
        except BaseException as error:
            failed.append(error)
        finally:
            os.kill(os.getpid(), number)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        return ros2_node.main([])
    finally:
        thread.join(30)
        if failed:
            raise failed[0]


def play(ros, messages, topic=TOPIC):
    """Send the pictures, each after the reading of the one before."""
    wait_until(lambda: ros.subscribed(topic))
    for count, message in enumerate(messages, 1):
        ros.send(topic, message)
        wait_until(lambda count=count: len(ros.published.get("/lobula/reading", ())) == count)


def test_an_approach_alarms_at_the_stamp_of_its_picture(ros):
    movie = lobula.stimuli.looming(scene="arena")
    pictures = np.clip(np.rint(movie.images), 0, 255).astype(np.uint8)
    times_ns = [T0_NS + round(time_s * 1e9) for time_s in movie.times_s]
    messages = [image(ros, p, t) for p, t in zip(pictures, times_ns, strict=True)]
    assert running(lambda: play(ros, messages)) == 130
    trace = lobula.Network().run(pictures, (np.array(times_ns) - times_ns[0]) / 1e9)
    readings = ros.published["/lobula/reading"]
    assert [stamp_ns(m) for m in readings] == times_ns
    assert {m.header.frame_id for m in readings} == {"eye"}
    potentials = np.array([m.data for m in ros.published["/lobula/potentials"]])
    np.testing.assert_allclose(potentials[:, 0], trace["lgmd1"], atol=1e-6)
    np.testing.assert_allclose(potentials[:, 3], trace["lptc_l"], atol=1e-6)
    assert [m.data[1] for m in ros.published["/lobula/spikes"]] == trace["spikes_lgmd2"].tolist()
    alarmed = int(np.argmax(trace["collision"]))
    (start,) = [m for m in ros.published["/diagnostics"] if m.status[0].message == "collision 1 start"]
    assert (stamp_ns(start), start.status[0].level) == (times_ns[alarmed], b"\2")
    assert (readings[alarmed].status[0].level, readings[alarmed].status[0].message) == (b"\2", "collision")
    assert (readings[0].status[0].level, readings[0].status[0].message) == (b"\1", "warming up")
    assert [m.data for m in ros.published["/lobula/collision"]] == [True, False]
    assert ("warning", "collision 1 start") in ros.log
    assert (ros.running, ros.destroyed) == (False, True)


def test_only_the_newest_picture_waits(ros):
    """Ten pictures at once while none is taken: the middleware keeps one, so the node looks at no more than two."""
    pictures = [image(ros, np.full((72, 99), 10 * i, np.uint8), T0_NS + i * 10**7) for i in range(12)]

    def feed():
        play(ros, pictures[:1])
        with ros._arrived:  # holds up spin_once
            for message in pictures[1:]:
                ros.send(TOPIC, message)
        wait_until(lambda: len(ros.published["/lobula/reading"]) == 2)

    running(feed)
    assert [stamp_ns(m) for m in ros.published["/lobula/reading"]] == [T0_NS, T0_NS + 11 * 10**7]


def test_compressed_pictures_and_parameters(ros):
    topic = "/front/image/compressed"
    ros.parameters = {"topic": topic, "preset": "published"}
    data = image_bytes(np.full((72, 99), 90, np.uint8), "png", "gray")
    message = ros.messages["CompressedImage"](header=header(ros, T0_NS), format="png", data=array.array("B", data))
    assert running(lambda: play(ros, [message], topic), signal.SIGTERM) == 143
    assert stamp_ns(ros.published["/lobula/reading"][0]) == T0_NS
    assert any("with preset published" in text for _, text in ros.log)


def test_pictures_that_stop_are_stale_and_not_the_end(ros):
    still = [image(ros, np.full((72, 99), 90 + i, np.uint8), T0_NS + i * 33_000_000) for i in range(3)]

    def feed():
        play(ros, still)
        wait_until(lambda: any("stale" in m.status[0].message for m in ros.published["/diagnostics"]))
        ros.send(TOPIC, image(ros, np.full((72, 99), 7, np.uint8), T0_NS + 2 * 10**9))
        wait_until(lambda: len(ros.published["/lobula/reading"]) == 4)

    running(feed)
    (told,) = [m for m in ros.published["/diagnostics"] if m.status[0].message == "state stale start"]
    assert (told.status[0].level, stamp_ns(told)) == (b"\3", T0_NS + 2 * 33_000_000)


def test_latency_counts_from_the_stamp(ros):
    ros.clock_ns = lambda: T0_NS + 50_000_000
    running(lambda: play(ros, [image(ros, np.full((72, 99), 90, np.uint8), T0_NS)]))
    values = {pair.key: pair.value for pair in ros.published["/diagnostics"][-1].status[0].values}
    assert 50 <= float(values["latency_ms"]) < 5000


def test_a_damaged_picture_is_left_out(ros):
    good = [image(ros, np.full((72, 99), 90 + i, np.uint8), T0_NS + i * 33_000_000) for i in range(2)]
    broken = image(ros, np.zeros((72, 99), np.uint8), T0_NS)
    broken.data = broken.data[:50]

    def feed():
        wait_until(lambda: ros.subscribed(TOPIC))
        ros.send(TOPIC, broken)
        wait_until(lambda: not ros._queue)
        play(ros, good)

    running(feed)
    assert [stamp_ns(m) for m in ros.published["/lobula/reading"]] == [stamp_ns(m) for m in good]


def test_an_encoding_that_is_not_read_is_refused_in_one_line(ros):
    feeder = threading.Thread(
        target=lambda: (
            wait_until(lambda: ros.subscribed(TOPIC)),
            ros.send(TOPIC, image(ros, np.zeros((8, 8), np.uint8), T0_NS, "yuv422")),
        )
    )
    feeder.start()
    assert ros2_node.main([]) == 2
    feeder.join(30)
    (line,) = [text for level, text in ros.log if level == "error"]
    assert line.startswith(f"{TOPIC}: encoding 'yuv422': must be mono8, rgb8, bgr8")


def test_a_preset_that_is_none(ros):
    ros.parameters = {"preset": "bold"}
    assert ros2_node.main([]) == 2
    assert ros.log[0][0] == "error"
    assert ros.log[0][1].startswith("preset 'bold': must be one of ")


def test_stopped_before_the_first_picture(ros):
    assert running(lambda: wait_until(lambda: ros.subscribed(TOPIC))) == 130
    assert ros.destroyed


def test_without_ros(monkeypatch, capsys):
    for name in ("rclpy", "lobula.hooks.ros2"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "rclpy", None)
    assert ros2_node.main([]) == 2
    said = capsys.readouterr().err
    assert said.startswith("lobula: the ROS 2 node needs rclpy: source /opt/ros/DISTRO/setup.bash first")
    assert said.count("\n") == 1
