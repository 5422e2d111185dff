"""``lobula arena``, called as a user calls it."""

from __future__ import annotations

import csv
import json
import os
import signal
import time

import pytest

from lobula import arena
from lobula.arena.snapshot import load_snapshot

SHORT = ("arena", "--minutes", "0.1", "--seed", "5")
LEFT_OUT = ("seconds",)  # the only numbers that two equal runs do not share


def record(called):
    (one,) = called.records
    return one


def told(called):
    return {name: value for name, value in record(called).items() if name not in LEFT_OUT}


class TestReport:
    def test_the_record_holds_what_arena_run_counts(self, call):
        done = call(*SHORT, "--robots", "3", "--json")
        assert (done.code, done.err) == (0, "")
        own = arena.run(minutes=0.1, seed=5, robots=3).score.as_dict()
        found = record(done)
        assert {name: found[name] for name in own} == own
        assert {"CR", "CP", "AA", "AT", "AP", "spurious", "SR1", "SR1_low", "SR1_high", "SR2", "SR2_low"} <= set(found)
        assert (found["status"], found["robots"], found["minutes"], found["robot_frames"]) == ("ok", 3, 0.1, 540)
        assert set(found["seconds"]) == {"eye", "network", "physics", "scoring"}

    def test_people_get_a_table(self, call):
        done = call(*SHORT)
        lines = done.out.splitlines()
        assert done.code == 0
        assert lines[1].split() == ["cause", "of", "a", "turn", "CR", "CP", "AA", "AT", "AP", "spurious"]
        assert "SR1 = AP/(AP+CP)" in done.out
        assert "robot-frames in" in lines[-1]

    def test_who_decides_and_which_settings_are_told(self, call):
        done = call(*SHORT, "--json", "--preset", "published", "--neurons", "lgmd2")
        assert (record(done)["preset"], record(done)["neurons"]) == ("published", "lgmd2")

    def test_the_robots_own_arithmetic(self, call):
        done = call(*SHORT, "--json", "--storage", "compact")
        assert (done.code, record(done)["status"]) == (0, "ok")
        done = call(*SHORT, "--storage", "tiny")
        assert done.code == 2
        assert "storage 'tiny': must be one of float, compact" in done.err

    def test_every_event_in_a_table(self, call, tmp_path):
        done = call(*SHORT, "--json", "--events", "events.csv")
        with (tmp_path / "events.csv").open() as file:
            rows = list(csv.DictReader(file))
        kinds = [row["kind"] for row in rows]
        found = record(done)
        assert {kind: kinds.count(kind) for kind in ("CR", "CP", "AA", "AT", "AP")} == {
            kind: found[kind] for kind in ("CR", "CP", "AA", "AT", "AP")
        }
        assert {row["other"] for row in rows} <= {"wall", "nothing", *(f"robot {n}" for n in range(4))}

    def test_a_replay_with_every_frame(self, call, tmp_path):
        assert call(*SHORT, "--save", "run.npz").code == 0
        assert arena.load_record(tmp_path / "run.npz").poses.shape == (180, 4, 3)

    def test_a_world_of_ones_own(self, call, tmp_path):
        (tmp_path / "w.toml").write_text("[robots]\ncount = 2\n")
        assert record(call(*SHORT, "--world", "w.toml", "--json"))["robots"] == 2


class TestCheckpoint:
    def test_taken_up_again_it_ends_the_same(self, call):
        whole = told(call("arena", "--minutes", "0.2", "--seed", "5", "--json"))
        call(*SHORT, "--checkpoint", "ck")
        assert told(call("arena", "--minutes", "0.2", "--checkpoint", "ck", "--json")) == whole

    def test_a_signal_leaves_a_report_and_a_checkpoint(self, spawn, call, tmp_path):
        request = ("arena", "--minutes", "0.3", "--seed", "5", "--checkpoint", "ck", "--json")
        process = spawn(*request)
        deadline_s = time.monotonic() + 30
        while not (tmp_path / "ck").exists() and process.poll() is None:
            assert time.monotonic() < deadline_s
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=30)
        assert process.returncode == 143
        found = json.loads(out)
        assert found["status"] == "interrupted"
        assert 0 <= found["minutes"] < 0.3
        assert "lobula: interrupted after" in err
        assert load_snapshot(tmp_path / "ck")["minutes"] == 0.3
        again = told(call(*request))
        os.remove(tmp_path / "ck")
        assert again == told(call(*request))
        assert again["status"] == "ok"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--robots", "0"), "--robots 0: must be from 1 to 256"),
        (("--robots", "257"), "--robots 257: must be from 1 to 256"),
        (("--minutes", "-1"), "minutes = -1.0: must be above 0"),
        (("--save", "run.avi"), "--save run.avi: must end in .npz"),
        (("--world", "none.toml"), "none.toml"),
        (("--preset", "papre"), "preset 'papre'"),
        (("--events", "no/such.csv"), "no such folder no"),
        (("--world", "tiny.toml"), "no room for so many robots"),
    ],
)
def test_a_request_that_cannot_be_met(call, tmp_path, arguments, words):
    (tmp_path / "tiny.toml").write_text('[room]\nshape = "circle"\nradius_cm = 5\n')
    done = call("arena", "--json", *arguments)
    assert done.code == 2
    assert len(done.err.splitlines()) == 1
    assert words in done.err
    assert record(done)["status"] == "refused"
    assert words in record(done)["problems"][0]


def test_a_checkpoint_of_another_run(call):
    call(*SHORT, "--checkpoint", "ck")
    done = call("arena", "--seed", "6", "--checkpoint", "ck")
    assert (done.code, "seed 5: must be" in done.err) == (2, True)


def test_a_checkpoint_that_is_none(call, tmp_path):
    (tmp_path / "ck").write_text("no")
    done = call(*SHORT, "--checkpoint", "ck")
    assert (done.code, "ck: is no snapshot of lobula" in done.err) == (2, True)


def test_a_file_that_cannot_be_written_is_said_after_the_table(call, tmp_path, monkeypatch):
    from lobula.arena.record import Record
    from lobula.errors import OutputError

    def full(self, path):
        raise OutputError(f"{path}: the disk is full")

    monkeypatch.setattr(Record, "save", full)
    done = call(*SHORT, "--save", "run.npz", "--json")
    assert (done.code, record(done)["status"]) == (3, "failed")
    assert record(done)["CP"] >= 0
    assert "the disk is full" in done.err
