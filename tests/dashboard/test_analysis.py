"""A recording analysed on the page is the run that `lobula run` makes of it, for any settings; so is every scene."""

from __future__ import annotations

import numpy as np
import pytest

import lobula
from lobula.dashboard import analysis as analysis_module
from lobula.dashboard.analysis import Analysis, Pass, event_records
from lobula.dashboard.recorded_scenes import RecordedScenes
from lobula.engine.library import available
from lobula.frames.jpeg import Jpeg
from lobula.params import with_settings
from lobula.runtime.events import EventLog, reading_of
from lobula.runtime.explanation import explain
from lobula.types import STATES, TRACE_DTYPE

from .clips import approach, recording

PARAMS = lobula.preset()
READY = with_settings(PARAMS, {"decision": {"collision_spikes": 1}, "lgmd1": {"spiking": {"threshold": 0.6}}}, "test")


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    return approach(tmp_path_factory.mktemp("clips") / "approach.mp4")


def stepped(clip, params, taps=()):
    """Every reading of the clip, step by step."""
    network = lobula.Network(params)
    with lobula.open(clip) as frames:
        return [(frame.index, network.step(frame, taps=taps)) for frame in frames]


def rows_of_readings(readings):
    return np.array(
        [(i, r.time_s, r.lgmd1, r.lgmd2, r.lptc_r, r.lptc_l, *r.spikes, r.collision, r.state) for i, r in readings],
        TRACE_DTYPE,
    )


@pytest.mark.parametrize("memory_bytes", [1 << 28, 0])
def test_it_is_the_run_with_the_same_settings(clip, memory_bytes):
    found = Analysis(recording(clip, memory_bytes))
    for params in (PARAMS, READY, PARAMS):
        pieces = []
        trace = found.run(params, lambda first, rows, to=pieces: to.append((first, rows)), lambda: False)
        np.testing.assert_array_equal(trace, rows_of_readings(stepped(clip, params)))
        assert [first for first, _ in pieces] == [0, 64]
        np.testing.assert_array_equal(np.concatenate([rows for _, rows in pieces]), trace)


def test_it_stops_when_other_settings_are_wanted(clip):
    found, asked = Analysis(recording(clip)), iter([False, True])
    assert found.run(PARAMS, lambda first, rows: None, lambda: next(asked)) is None
    assert found.current.rows == 64


def test_a_camera_that_turns(clip):
    found = Analysis(recording(clip), yaw_rate_deg_s=lambda time_s: 90.0 if time_s > 1.0 else 0.0)
    trace = found.run(PARAMS, lambda first, rows: None, lambda: False)
    assert (trace["state"][trace["time_s"] > 1.01] == "turning").all()
    assert not trace["collision"].any()


@pytest.mark.parametrize("memory_bytes", [1 << 28, 0])
def test_the_scene_of_any_row_is_that_of_the_run(clip, memory_bytes):
    taps = ("lamina", "lgmd2_grouped", "motion")
    readings = stepped(clip, READY, taps)
    found = Analysis(recording(clip, memory_bytes))
    found.run(READY, lambda first, rows: None, lambda: False)
    scenes = RecordedScenes(found)
    for row, name in (
        (70, "lamina"),
        (71, "motion"),
        (71, "lgmd2_grouped"),
        (3, "motion"),
        (0, "lamina"),
        (90, "lamina"),
    ):
        scene = scenes.at(row, name)
        expected = readings[row][1].taps[name]
        packet = scene.maps[name]
        assert (scene.number, scene.time_s) == (row, readings[row][1].time_s)
        assert (packet.width, packet.height) == (99, 72)
        shown = np.frombuffer(packet.data, np.int8).reshape(72, 99) * (packet.peak / 127)
        np.testing.assert_allclose(shown, expected, atol=packet.peak / 250)
        with lobula.open(clip) as frames:
            told = explain(frames, lobula.Network(READY), scene.time_s)
        assert [c["because"] for c in scene.why] == [c.because for c in told.conditions]
        assert scene.jpeg.startswith(b"\xff\xd8")
    assert scenes.at(50, None).maps == {}
    assert scenes.at(10_000, None).number == 90
    scenes.close()


def test_a_picture_of_a_recording_is_encoded_once_for_all_viewers(clip, monkeypatch):
    made, encode = [], Jpeg.__call__
    monkeypatch.setattr(Jpeg, "__call__", lambda self, picture: made.append(0) or encode(self, picture))
    found = Analysis(recording(clip))
    found.run(PARAMS, lambda first, rows: None, lambda: False)
    scenes = RecordedScenes(found)
    jpegs = {scenes.at(row, "lamina").jpeg for row in (40, 41, 40, 41, 40, 41)}
    assert len(made) == len(jpegs) == 2
    scenes.close()


def test_a_row_that_the_analysis_has_not_reached_has_a_picture_only(clip):
    found, asked = Analysis(recording(clip)), iter([False, True])
    found.run(PARAMS, lambda first, rows: None, lambda: next(asked))
    found.recording.block(1)
    scenes = RecordedScenes(found)
    assert (scenes.at(80, "lamina").maps, scenes.at(80, "lamina").why) == ({}, [])
    before = scenes.key(80, "lamina")
    found.run(PARAMS, lambda first, rows: None, lambda: False)
    assert scenes.key(80, "lamina") != before
    assert scenes.at(80, "lamina").why != []


def test_a_file_that_has_gone_leaves_what_is_in_memory(clip, tmp_path):
    here = tmp_path / "here.mp4"
    here.write_bytes(clip.read_bytes())
    found = Analysis(recording(here))
    found.run(PARAMS, lambda first, rows: None, lambda: False)
    here.unlink()
    scene = RecordedScenes(found).at(40, "lamina")
    assert scene.jpeg == b""
    assert scene.why != []


@pytest.mark.skipif(not available(), reason="the NumPy reference is too slow for so many frames")
def test_states_are_kept_within_bounds_and_any_row_can_be_reached(monkeypatch):
    monkeypatch.setattr(analysis_module, "_CHECK_BYTES", 1_000_000)
    network, kept = lobula.Network(), Pass(1, PARAMS)
    rng = np.random.default_rng(0)
    for first in range(0, 256 * 40, 64):
        kept.keep(first, network)
        if first % 1024 == 0:
            network.run(rng.integers(0, 255, (2, 72, 99), np.uint8), [first + 1.0, first + 1.1])
    for row in (0, 255, 256, 5000, 10_239):
        at, _ = kept.before(row)
        assert 0 <= row - at < 256 * 16
    assert len(kept._checkpoints) * sum(np.asarray(v).nbytes for v in network.snapshot().values()) <= 1_000_000


@pytest.mark.parametrize("seed", range(4))
def test_events_are_those_of_every_reading(seed):
    rng = np.random.default_rng(seed)
    trace = np.zeros(400, TRACE_DTYPE)
    trace["frame"], trace["time_s"] = np.arange(400), np.arange(400) / 30
    trace["collision"] = np.repeat(rng.random(40) < 0.3, 10)
    trace["state"] = np.repeat(rng.choice([*STATES, "ok", "ok"], 20), 20)
    trace["lgmd1"], trace["lgmd2"] = rng.random((2, 400))
    log, expected = EventLog(), []
    for row in trace:
        expected += log.step(int(row["frame"]), reading_of(row))
    expected += log.finish()
    found = event_records(trace)
    assert sorted(map(str, found)) == sorted(map(str, expected))


def test_no_rows_no_events():
    assert event_records(np.zeros(0, TRACE_DTYPE)) == []
