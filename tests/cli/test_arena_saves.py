"""``lobula arena --save`` a film and a picture, and ``--replay``."""

from __future__ import annotations

import json
import signal

import av
import numpy as np
import pytest

from lobula.arena.snapshot import save_snapshot

SHORT = ("arena", "--minutes", "0.05", "--seed", "5")


def frames_in(path):
    with av.open(str(path)) as film:
        return sum(1 for packet in film.demux(video=0) if packet.size)


def test_replay_film_and_picture_of_one_run(call, tmp_path):
    done = call(*SHORT, "--save", "r.npz", "--save", "r.mp4", "--save", "r.png", "--speed", "9", "--json")
    assert done.code == 0
    (record,) = done.records
    assert record["saved"] == ["r.npz", "r.mp4", "r.png"]
    assert record["film"] == {"frames": 10, "duration_s": 0.333, "speed": 9.0}
    assert frames_in(tmp_path / "r.mp4") == 10

    again = call("arena", "--replay", "r.npz", "--save", "again.mp4", "--robot", "3", "--start", "1", "--end", "1.2")
    assert again.code == 0
    assert frames_in(tmp_path / "again.mp4") == 6
    told = json.loads(call("arena", "--replay", "r.npz", "--save", "again.png", "--json").out)
    assert (told["driver"], told["robots"], told["minutes"]) == ("preset paper, neurons all", 4, 0.05)
    assert (tmp_path / "again.png").read_bytes() == (tmp_path / "r.png").read_bytes()


def test_a_signal_while_the_film_is_made_leaves_what_there_is_and_a_record(call, tmp_path, monkeypatch):
    from lobula.experiments import arena_film

    frame, drawn = arena_film.ArenaVideo.frame, []

    def signalled(self, number, image):
        frame(self, number, image)
        drawn.append(number)
        if len(drawn) == 35:
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(arena_film.ArenaVideo, "frame", signalled)
    done = call(*SHORT, "--save", "r.npz", "--save", "r.mp4", "--json")
    assert done.code == 130
    (record,) = done.records
    assert (record["status"], record["minutes"], len(drawn)) == ("interrupted", 0.05, 35)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["r.npz", "r.part.mp4"]
    assert frames_in(tmp_path / "r.part.mp4") >= 15


@pytest.mark.parametrize(
    ("options", "film"),
    [
        # 30 frames a second until 1 s
        (("--save", "r.mp4"), "; the film: {frames} pictures to draw, 1 s to play"),
        (("--save", "r.mp4", "--speed", "0.25", "--end", "0.5"), "; the film: 15 pictures to draw, 2 s to play"),
        (("--save", "r.png"), ""),
        (("--save", "r.npz"), ""),
    ],
)
def test_a_signal_tells_how_long_the_film_takes_that_is_still_made(call, tmp_path, monkeypatch, options, film):
    def along(here):
        return lambda done_minutes, minutes: signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("lobula.cli.arena._along", along)
    done = call(*SHORT, *options, "--json")
    assert done.code == 130
    (record,) = done.records
    frames = round(record["minutes"] * 1800)
    assert 30 <= frames < 90
    told = done.err.splitlines()[0].split(" simulated minutes; ")[1]
    assert told == f"saving, Ctrl-C again ends that too{film.format(frames=frames)}"
    if film:
        assert f" {record['film']['frames']} pictures" in told
        assert frames_in(tmp_path / "r.mp4") == record["film"]["frames"]


def test_a_part_that_was_not_reached_is_said_once(call, monkeypatch):
    monkeypatch.setattr("lobula.cli.arena._along", lambda here: lambda *_: signal.raise_signal(signal.SIGINT))
    done = call(*SHORT, "--save", "r.mp4", "--start", "2")
    assert "saving, Ctrl-C again ends that too\n" in done.err
    assert done.err.count("from 2 s to its end: must be a part of the run") == 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--save", "r.avi"), "--save r.avi: must end in .npz, .mp4, .png"),
        (("--save", "a.mp4", "--save", "b.mp4"), "must be one file of a kind"),
        (("--save", "r.mp4", "--robot", "4"), "--robot 4: must be one of 0..3"),
        (("--save", "r.mp4", "--robots", "7", "--robot", "7"), "--robot 7: must be one of 0..6"),
        (("--save", "r.npz", "--robot", "1"), "--robot 1: goes with --save FILE.mp4"),
        (("--start", "1"), "--start 1.0: goes with --save FILE.mp4 or FILE.png"),
        (("--save", "r.mp4", "--start", "9"), "from 9 s to its end: must be a part of the run, 0 to 3 s"),
        (("--save", "r.mp4", "--speed", "-1"), "speed -1.0: must be from 1/64 to 256"),
        (("--replay", "none.npz", "--save", "r.mp4"), "a --replay holds its own run"),
    ],
)
def test_refused_before_anything_runs(call, tmp_path, options, words):
    done = call(*SHORT, *options)
    assert (done.code, done.out) == (2, "")
    assert words in done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--preset", "lobula", "--save", "r.mp4"), "--preset lobula: a --replay holds its own run"),
        (("--set", "decision.neurons=lgmd2", "--save", "r.mp4"), "--set decision.neurons=lgmd2: a --replay holds"),
        ((), "draws a run: must go with --save FILE.mp4 or --save FILE.png"),
        (("--save", "copy.npz"), "draws a run"),
        (("--save", "r.mp4"), "none.npz: cannot be read"),
    ],
)
def test_replays_that_cannot_be(call, options, words):
    done = call("arena", "--replay", "none.npz", *options)
    assert done.code == 2
    assert words in done.err


@pytest.mark.parametrize("kind", ["trace", "text", "checkpoint"])
def test_a_replay_of_a_file_that_is_no_run(call, tmp_path, kind):
    if kind == "trace":
        np.savez(tmp_path / "x.npz", lgmd1=np.zeros(3))
    elif kind == "text":
        (tmp_path / "x.npz").write_text("no")
    else:
        save_snapshot(tmp_path / "x.npz", {"minutes": 1.0})
    done = call("arena", "--replay", "x.npz", "--save", "r.png")
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert done.err.startswith("lobula: --replay x.npz: is no ")
    assert done.err.endswith(": must be a run saved by `lobula arena --save FILE.npz`\n")
