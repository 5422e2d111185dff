"""``--yaw``: a camera that says how it turns is not alarmed by its own turning."""

from __future__ import annotations

import pytest

from ..runtime.readings import LiveSource

TURN = "time_s,yaw_deg_s\n0,0\n1.5,0\n1.6,90\n2.0,90\n2.1,0\n3.0,0\n"
"""Above 45 deg/s after 1.55 s and before 2.05 s: in frames 47..61 of 30 a second."""


@pytest.fixture
def yaw(tmp_path):
    def write(text):
        (tmp_path / "yaw.csv").write_text(text)
        return "yaw.csv"

    return write


def collisions(done):
    return [r for r in done.records if r["type"] == "collision"]


def test_turning_is_told_from_the_first_fast_frame_to_67_ms_after_the_last(call, clip, yaw):
    done = call("run", clip, "--json", "--yaw", yaw(TURN))
    assert (done.code, done.err) == (0, "")
    turning = [(r["phase"], r["frame"]) for r in done.records if r.get("state") == "turning"]
    assert turning == [("start", 47), ("end", 64)]  # frame 63 comes 66.7 ms after frame 61


def test_while_it_turns_nothing_is_a_collision(call, clip, yaw):
    assert collisions(call("run", clip, "--json"))
    assert not collisions(call("run", clip, "--json", "--yaw", yaw("time_s,yaw_deg_s\n0,-50\n3,-50\n")))


def test_a_slow_turn_changes_nothing_and_the_threshold_is_a_setting(call, clip, yaw):
    slow = yaw("time_s,yaw_deg_s\n0,40\n3,40\n")
    assert call("run", clip, "--json", "--yaw", slow).records[1:-1] == call("run", clip, "--json").records[1:-1]
    done = call("run", clip, "--json", "--yaw", slow, "--set", "decision.turning_deg_s=30")
    assert not collisions(done)


def test_explain_knows_of_the_turn(call, clip, yaw):
    why = call("explain", clip, "--at", 1.8, "--json", "--yaw", yaw(TURN)).document
    assert (why["state"], why["collision"]) == ("turning", False)
    assert {c["name"]: c["holds"] for c in why["conditions"]}["not turning"] is False


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("time_s,yaw\n0,1\n", "yaw file yaw.csv: lacks the column yaw_deg_s: must begin with a heading"),
        ("time_s,yaw_deg_s\n0,x\n", "yaw file yaw.csv: line 2: yaw_deg_s = 'x': must be a finite number"),
        ("time_s,yaw_deg_s\n1700000000,1\n", "yaw file yaw.csv: no rate for the frame at 0.000 s: covers 1700000000"),
    ],
)
def test_a_wrong_file_is_one_line_and_2(call, clip, yaw, text, says):
    done = call("run", clip, "--json", "--yaw", yaw(text))
    assert done.code == 2
    assert done.err.count("\n") == 1
    assert done.err.startswith(f"lobula: {says}")
    assert [r["status"] for r in done.records] == ["refused"]
    assert call("explain", clip, "--at", 1, "--yaw", "yaw.csv").err == done.err


def test_a_record_that_ends_before_the_clip_stops_there(call, clip, yaw):
    done = call("run", clip, "--json", "--yaw", yaw("time_s,yaw_deg_s\n0,0\n1,0\n"))
    assert done.code == 3
    assert done.err.startswith("lobula: yaw file yaw.csv: no rate for the frame at 1.533 s: covers 0.000..1.000 s")
    assert (done.records[-1]["status"], done.records[-1]["frames"]) == ("source_failed", 46)  # up to 1.5 s
    assert call("run", clip, "--yaw", "yaw.csv", "--end", 1.5).code == 0


def test_it_is_not_written_over(call, clip, yaw):
    done = call("run", clip, "--yaw", yaw(TURN), "--trace", "yaw.csv")
    assert done.code == 2
    assert "which is the yaw file itself" in done.err


def test_a_camera_has_no_times_that_a_file_could_know(call, yaw, monkeypatch):
    monkeypatch.setattr("lobula.runtime.opening.open", lambda *_, **__: LiveSource([], None))
    done = call("run", "0", "--json", "--yaw", yaw(TURN))
    assert (done.code, done.err) == (
        2,
        "lobula: --yaw yaw.csv: camera is live: must be a recording, whose times are known\n",
    )
    assert done.records[-1]["status"] == "refused"
