"""Recordings for Foxglove, read back with the mcap library: whole, cut off, and on a disk that is full."""

from __future__ import annotations

import base64
import errno
import io
import json
import os
import struct
from pathlib import Path

import numpy as np
import pytest

from lobula.errors import OutputError, ParameterError
from lobula.frames.stills import read_still
from lobula.hooks import make_hook

from .office import END, HEADER, START, SUMMARY, delivered, event, killed_while_running, opened, reading

pytest.importorskip("mcap", reason="needs mcap (30 MB with its compressors), the extra mcap")
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader

from lobula.hooks import whole_writes

TORN = (EndOfFile, struct.error)
"""What the library raises where a file was cut off, between two chunks and inside one."""


def messages(path):
    """Topic -> (log time ns, what the JSON says) of a whole recording, read by its index."""
    with path.open("rb") as file:
        found = list(make_reader(file).iter_messages())
    by_topic = {}
    for _, channel, message in found:
        by_topic.setdefault(channel.topic, []).append((message.log_time, json.loads(message.data)))
    return by_topic


def salvaged(data):
    """Topic -> records of a recording that was cut off, read from its beginning as far as it goes."""
    topics, by_topic = {}, {}
    try:
        for record in StreamReader(io.BytesIO(data), validate_crcs=True).records:
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, Message):
                by_topic.setdefault(topics[record.channel_id], []).append(json.loads(record.data))
    except TORN:
        pass
    return by_topic


def test_readings_events_and_the_summary_on_the_clock_of_the_frames(tmp_path):
    path = tmp_path / "a.mcap"
    path.write_text("an older run")
    tally = delivered(make_hook(f"mcap:{path}"), START, END, readings=[reading(i / 30) for i in range(60)])
    assert tally["sent"] == 63
    found = messages(path)
    times_ns, readings = zip(*found["/lobula/reading"], strict=True)
    np.testing.assert_allclose(np.diff(times_ns), 1e9 / 30, atol=2000)  # however fast they came
    assert times_ns[0] / 1e9 == pytest.approx(readings[0]["unix_s"], abs=0.001)
    assert (readings[7]["frame"], readings[7]["spikes_lptc_l"], readings[7]["state"]) == (7, 4, "ok")
    (start_ns, start), (_, end), (_, summary) = found["/lobula/event"]
    assert (start.items() >= START.items(), end.items() >= END.items()) == (True, True)
    assert summary.items() >= SUMMARY.items()
    assert (start_ns - times_ns[0]) / 1e9 == pytest.approx(START["time_s"], abs=1e-5)
    logs = [log for _, log in found["/lobula/log"]]
    assert [(log["level"], log["message"]) for log in logs] == [
        (3, "collision 1 start"), (2, "collision 1 end"), (2, "summary ok"),
    ]  # fmt: skip
    assert logs[0]["timestamp"] == {"sec": start_ns // 10**9, "nsec": start_ns % 10**9}


def test_the_schemas_are_those_foxglove_knows_and_fit_the_messages(tmp_path):
    path = tmp_path / "a.mcap"
    office = opened(make_hook(f"mcap:{path}"))
    office.frame(0, reading(0.0), lambda: np.zeros((48, 64, 3), np.uint8))
    office.event(START)
    office.close(SUMMARY)
    with path.open("rb") as file:
        found = list(make_reader(file).iter_messages())
    assert {(channel.topic, schema.name) for schema, channel, _ in found} == {
        ("/lobula/reading", "lobula.Reading"), ("/lobula/event", "lobula.Event"),
        ("/lobula/log", "foxglove.Log"), ("/lobula/picture", "foxglove.CompressedImage"),
    }  # fmt: skip
    kinds = {"integer": int, "number": (int, float), "boolean": bool, "string": str, "object": dict}
    for schema, channel, message in found:
        assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
        fields = json.loads(message.data)
        for name, about in json.loads(schema.data)["properties"].items():
            if name in fields or not schema.name.endswith("Event"):  # the summary has no frame
                assert isinstance(fields[name], kinds[about["type"]]), (schema.name, name)


def test_a_few_pictures_a_second_as_jpeg(tmp_path):
    path = tmp_path / "a.mcap"
    office = opened(make_hook(f"mcap:{path}"))
    picture = np.zeros((96, 128, 3), np.uint8)
    picture[:, 64:] = 255, 0, 0
    for index in range(31):
        office.frame(index, reading(index / 30), lambda: picture)
    office.close(SUMMARY)
    found = messages(path)["/lobula/picture"]
    assert len(found) == 4
    _, image = found[0]
    assert (image["format"], image["frame_id"]) == ("jpeg", "camera")
    still = tmp_path / "a.jpg"
    still.write_bytes(base64.b64decode(image["data"]))
    shown = read_still(still).to_ndarray(format="rgb24").astype(int)
    assert np.abs(shown[:, :60]).max() < 12
    assert np.abs(shown[:, 68:] - (255, 0, 0)).max() < 12


def test_header_and_settings_are_metadata(tmp_path):
    path = tmp_path / "a.mcap"
    office = opened()
    hook = make_hook(f"mcap:{path}")
    hook.check()
    hook.connect({**HEADER, "settings": [{"path": "lamina.dog.sigma_px", "value": 2.0}]})
    hook.disconnect()
    office.close(SUMMARY)
    with path.open("rb") as file:
        found = {r.name: r.metadata for r in _records(file) if type(r).__name__ == "Metadata"}
    assert found["lobula"]["source"] == "movie"
    assert found["lobula settings"] == {"lamina.dog.sigma_px": "2.0"}


def _records(file):
    reader = StreamReader(file).records
    while True:
        try:
            yield next(reader)
        except (*TORN, StopIteration):
            return


def test_cut_off_anywhere_it_can_be_read_up_to_the_last_chunk(tmp_path):
    path = tmp_path / "a.mcap"
    delivered(make_hook(f"mcap:{path}"), *map(event, range(50)))  # a chunk each
    data = path.read_bytes()
    counts = [len(salvaged(data[:length]).get("/lobula/event", ())) for length in range(0, len(data), 601)]
    assert counts == sorted(counts)
    assert len(set(counts)) > 20  # every chunk that is whole counts, whatever follows it
    assert salvaged(data)["/lobula/event"][-1]["type"] == "summary"


def test_killed_while_running(tmp_path):
    path = tmp_path / "a.mcap"
    killed_while_running(f"mcap:{path}", lambda: "/lobula/event" in salvaged(path.read_bytes()))
    found = salvaged(path.read_bytes())
    assert [r["frame"] for r in found["/lobula/reading"]] == list(range(100))
    assert found["/lobula/event"][0].items() >= START.items()


def test_a_disk_that_was_full_for_a_while_costs_nothing(tmp_path, monkeypatch):
    write, room = os.write, [10_000, 700, None, None]  # the beginning, 700 bytes of a chunk, no room; then room again

    def narrow(file, data):
        left = room.pop(0) if room else 1_000_000
        if left is None:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(file, data[:left])

    monkeypatch.setattr(whole_writes.os, "write", narrow)
    path = tmp_path / "a.mcap"
    hook = make_hook(f"mcap:{path}")
    office = opened(hook)
    for number in range(20):
        office.event(event(number))
    office.close(SUMMARY)
    (tally,) = office.tallies()
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (21, 0, "No space left on device")
    assert [r.get("frame") for _, r in messages(path)["/lobula/event"]] == [*range(20), None]  # none twice


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_a_failure_and_no_more(tmp_path):
    (tmp_path / "full.mcap").symlink_to("/dev/full")
    tally = delivered(make_hook(f"mcap:{tmp_path / 'full.mcap'}"), START)
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (0, 2, "No space left on device")


@pytest.mark.parametrize("target", ["mcap:", "mcap:-", "mcap:recording", "mcap:a.db3"])
def test_targets_that_cannot_be(target):
    with pytest.raises(ParameterError, match=r"must be mcap:FILE\.mcap"):
        make_hook(target)


def test_a_place_where_nothing_can_be_written_is_told_before_the_first_frame(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OutputError, match=r"cannot write none/a\.mcap: "):
        opened(make_hook("mcap:none/a.mcap"))
