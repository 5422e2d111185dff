"""Recordings for Rerun, read back with its own reader."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from lobula.errors import OutputError, ParameterError
from lobula.hooks import make_hook

from .office import END, START, SUMMARY, delivered, killed_while_running, opened, reading

pytest.importorskip("rerun", reason="needs rerun-sdk (500 MB), the extra rerun")
from rerun.chunk import RrdReader


def columns(path):
    """Entity -> column -> values of a recording."""
    found = {}
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        entity = found.setdefault(str(chunk.entity_path), {})
        for name, values in zip(batch.schema.names, batch.columns, strict=True):
            counts = values.cast("int64") if str(values.type).startswith(("timestamp", "duration")) else values
            entity.setdefault(name.rpartition(":")[2], []).extend(counts.to_pylist())
    return found


def test_readings_events_and_the_summary_on_both_clocks(tmp_path):
    path = tmp_path / "a.rrd"
    path.write_text("an older run")
    tally = delivered(make_hook(f"rerun:{path}"), START, END, readings=[reading(i / 30) for i in range(60)])
    assert tally == {"hook": f"rerun:{path}", "sent": 63, "dropped": 0, "failures": 0}
    found = columns(path)
    potentials = found["/potentials"]
    assert potentials["names"] == [["lgmd1", "lgmd2", "lptc_r", "lptc_l"]]
    assert potentials["scalars"] == [[0.5, 0.6, 0.25, -0.125]] * 60
    np.testing.assert_allclose(potentials["source"], np.arange(60) * 1e9 / 30, atol=1000)
    np.testing.assert_allclose(np.diff(potentials["clock"]), 1e9 / 30, atol=2000)
    assert found["/spikes"]["scalars"] == [[1, 2, 3, 4]] * 60
    assert found["/collision"]["scalars"] == [[0]] * 60
    events = found["/events"]
    assert events["text"] == [["collision 1 start"], ["collision 1 end"], ["summary ok"]]
    assert events["level"] == [["WARN"], ["INFO"], ["INFO"]]
    assert events["source"][0] == pytest.approx(START["time_s"] * 1e9, abs=1000)
    ((header,),) = found["/header"]["text"]
    assert '"source":"movie"' in header


def test_a_few_pictures_a_second_as_jpeg(tmp_path):
    path = tmp_path / "a.rrd"
    office = opened(make_hook(f"rerun:{path}"))
    for index in range(31):
        office.frame(index, reading(index / 30), lambda: np.zeros((48, 64, 3), np.uint8))
    office.close(SUMMARY)
    picture = columns(path)["/picture"]
    assert picture["media_type"] == [["image/jpeg"]] * 4
    assert all(bytes(blob[0]).startswith(b"\xff\xd8") for blob in picture["blob"])


def test_killed_while_running(tmp_path):
    path = tmp_path / "a.rrd"
    killed_while_running(f"rerun:{path}")
    printed = subprocess.run(
        [sys.executable, "-m", "rerun", "rrd", "print", "-vvv", path],
        capture_output=True, text=True, check=True, env={**os.environ, "HOME": str(tmp_path)},
    ).stdout  # fmt: skip
    assert (
        "collision 1 start" in printed
    )  # without an index the other reader refuses it, the viewer and its tools do not
    assert "Chunk" in printed
    assert printed.count("[0.5, 0.6, 0.25, -0.125]") == 100


@pytest.mark.parametrize("target", ["rerun:", "rerun:-", "rerun:recording", "rerun:a.mcap"])
def test_targets_that_cannot_be(target):
    with pytest.raises(ParameterError, match=r"must be rerun:FILE\.rrd"):
        make_hook(target)


def test_a_place_where_nothing_can_be_written_is_told_before_the_first_frame(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OutputError, match=r"cannot write none/a\.rrd: "):
        opened(make_hook("rerun:none/a.rrd"))


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk_is_a_failure_and_no_more(tmp_path):
    (tmp_path / "full.rrd").symlink_to("/dev/full")
    tally = delivered(make_hook(f"rerun:{tmp_path / 'full.rrd'}"), START)
    assert (tally["sent"], tally["dropped"]) == (0, 2)
    assert "No space left on device" in tally["problem"]
