"""ROS 2 bags, read back with rosbags and with plain SQLite: whole, killed, and on a disk that is full."""

from __future__ import annotations

import io
import sqlite3

import av
import numpy as np
import pytest

from lobula.errors import OutputError, ParameterError
from lobula.hooks import make_hook
from lobula.types import NEURONS

from .office import END, START, SUMMARY, delivered, event, killed_while_running, opened, reading

pytest.importorskip("rosbags", reason="needs rosbags (22 MB with what it needs), the extra rosbags")
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Writer


def messages(path):
    """Topic -> (bag time ns, message) of a bag or of one of its files."""
    by_topic = {}
    with AnyReader([path]) as reader:
        for connection, time_ns, data in reader.messages():
            by_topic.setdefault(connection.topic, []).append((time_ns, reader.deserialize(data, connection.msgtype)))
    return by_topic


def test_readings_events_and_the_summary_as_standard_messages(tmp_path):
    path = tmp_path / "bag"
    tally = delivered(make_hook(f"rosbag:{path}"), START, END, readings=[reading(i / 30) for i in range(60)])
    assert tally == {"hook": f"rosbag:{path}", "sent": 63, "dropped": 0, "failures": 0}
    found = messages(path)
    times_ns, arrays = zip(*found["/lobula/potentials"], strict=True)
    np.testing.assert_allclose(np.diff(times_ns), 1e9 / 30, atol=2000)
    np.testing.assert_array_equal(arrays[0].data, [0.5, 0.6, 0.25, -0.125])
    assert arrays[0].layout.dim[0].label.split() == list(NEURONS)
    assert (arrays[0].layout.dim[0].size, arrays[0].layout.dim[0].stride) == (4, 4)
    np.testing.assert_array_equal(found["/lobula/spikes"][0][1].data, [1, 2, 3, 4])
    assert [m.data for _, m in found["/lobula/collision"]] == [True, False]
    (start_ns, start), (_, end), (_, summary) = found["/diagnostics"]
    assert start.header.stamp.sec * 10**9 + start.header.stamp.nanosec == start_ns
    assert (start_ns - times_ns[0]) / 1e9 == pytest.approx(START["time_s"], abs=1e-5)
    said = [(m.status[0].level, m.status[0].name, m.status[0].message) for m in (start, end, summary)]
    assert said == [
        (2, "lobula: collision", "collision 1 start"), (0, "lobula: collision", "collision 1 end"),
        (0, "lobula: summary", "summary ok"),
    ]  # fmt: skip
    assert {pair.key: pair.value for pair in start.status[0].values}["lgmd1"] == "0.93"


def test_what_the_metadata_says_of_it(tmp_path):
    path = tmp_path / "bag"
    delivered(make_hook(f"rosbag:{path}"), START, readings=[reading(0.0), reading(0.1)])
    with Reader(path) as reader:
        counts = {c.topic: (c.msgtype, c.msgcount) for c in reader.connections}
        assert reader.message_count == 7
    assert counts == {
        "/lobula/potentials": ("std_msgs/msg/Float64MultiArray", 2),
        "/lobula/spikes": ("std_msgs/msg/Int32MultiArray", 2),
        "/lobula/collision": ("std_msgs/msg/Bool", 1),
        "/lobula/picture/compressed": ("sensor_msgs/msg/CompressedImage", 0),
        "/diagnostics": ("diagnostic_msgs/msg/DiagnosticArray", 2),
    }


def test_a_few_pictures_a_second_as_jpeg(tmp_path):
    office = opened(make_hook(f"rosbag:{tmp_path / 'bag'}"))
    picture = np.full((96, 128, 3), (200, 40, 90), np.uint8)
    for index in range(31):
        office.frame(index, reading(index / 30), lambda: picture)
    office.close(SUMMARY)
    found = messages(tmp_path / "bag")["/lobula/picture/compressed"]
    assert len(found) == 4
    assert (found[0][1].format, found[0][1].header.frame_id) == ("jpeg", "camera")
    with av.open(io.BytesIO(found[0][1].data.tobytes())) as container:
        shown = next(container.decode(video=0)).to_ndarray(format="rgb24").astype(int)
    assert np.abs(shown - (200, 40, 90)).max() < 10


def test_killed_while_running(tmp_path):
    path = tmp_path / "bag"
    file = path / "bag.db3"
    # two arrays a reading; status and alarm
    killed_while_running(f"rosbag:{path}", lambda: file.exists() and committed(file) == 202)
    assert len(messages(file)["/lobula/potentials"]) == 100


def committed(file):
    with sqlite3.connect(file) as database:
        try:
            return database.execute("SELECT count(*) FROM messages").fetchone()[0]
        except sqlite3.OperationalError:  # no table yet, or being written just now
            return 0


def test_a_disk_that_was_full_for_a_while_costs_nothing(tmp_path):
    path = tmp_path / "bag"
    hook = make_hook(f"rosbag:{path}")
    connect, refusals = hook.connect, [True, False]

    def begun(header):
        connect(header)
        pages = hook._writer.storage.conn.execute("PRAGMA page_count").fetchone()[0]
        hook._writer.storage.conn.execute(f"PRAGMA max_page_count = {pages + (0 if refusals[0] else 10_000)}")
        if len(refusals) > 1:
            refusals.pop(0)

    hook.connect = begun
    office = opened(hook)
    for number in range(30):
        office.event(event(number))
    office.close(SUMMARY)
    (tally,) = office.tallies()
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (31, 0, "database or disk is full")
    frames = [{v.key: v.value for v in m.status[0].values}.get("frame") for _, m in messages(path)["/diagnostics"]]
    assert frames == [*map(str, range(30)), None]
    with Reader(path) as reader:
        assert reader.message_count == 31


def test_a_disk_that_is_full_at_the_very_beginning(tmp_path, monkeypatch):
    script = Sqlite3Writer.SQLITE_SCHEMA
    monkeypatch.setattr(Sqlite3Writer, "SQLITE_SCHEMA", f"PRAGMA max_page_count = 2;{script}")
    hook = make_hook(f"rosbag:{tmp_path / 'bag'}")
    failed = hook.disconnect

    def room_again():
        monkeypatch.setattr(Sqlite3Writer, "SQLITE_SCHEMA", script)
        failed()

    hook.disconnect = room_again
    tally = delivered(hook, START)
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (2, 0, "database or disk is full")
    assert len(messages(tmp_path / "bag")["/diagnostics"]) == 2


@pytest.mark.parametrize(("target", "says"), [("rosbag:", "must be rosbag:DIR"), ("rosbag:.", "must be a new folder")])
def test_targets_that_cannot_be(target, says):
    with pytest.raises(ParameterError, match=says):
        make_hook(target)


def test_a_place_where_nothing_can_be_written_is_told_before_the_first_frame(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    hook = make_hook("rosbag:none/bag")
    with pytest.raises(OutputError, match=r"cannot write none/bag: No such file"):
        opened(hook)
