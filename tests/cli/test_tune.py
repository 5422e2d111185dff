"""``lobula tune`` as a user calls it."""

from __future__ import annotations

import json
import shutil
import signal
import sys
import time
from functools import cache

import pytest

from lobula.stimuli.battery import battery

pytest.importorskip("optuna", reason="the extra tune is not installed")
pytest.importorskip("matplotlib", reason="the extra plot is not installed")

from .terminal import Terminal

NAMES = ("looming-dark-12cm_s", "looming-arena", "translating_right-dark-12cm_s", "translating_right-arena")
SHORT = ("tune", "--on", "battery", "--out", "t", "--workers", "1")
HEADING = "file,collision,contact_frame,contact_uncertainty_frames,group,split,confidence\n"
ROWS = "a.mp4,1,88,1,front,,\nb.mp4,1,88,1,rear,,\nc.mp4,0,,,rear,,\n"


@pytest.fixture
def _undrawn(monkeypatch):
    """Draw nothing: it takes longer than all the rest, and has tests of its own."""
    monkeypatch.setattr("lobula.tuning.results.draw", lambda found: None)
    monkeypatch.setattr("lobula.tuning.results.save_figure", lambda drawing, path: path.touch())


@pytest.fixture(scope="module")
def cases():
    """Four movies of the battery, two of them approaches; each is drawn once."""
    chosen = [case for case in battery() if case.name in NAMES]
    return [case._replace(movie=cache(case.movie)) for case in chosen]


@pytest.fixture
def tiny(monkeypatch, cases):
    """Make the battery four movies, and the disk quick."""
    monkeypatch.setattr("lobula.tuning.battery_task.battery_cases", lambda: iter(cases))
    monkeypatch.setattr("os.fsync", lambda file: None)


@pytest.fixture
def labelled(clip, tmp_path, monkeypatch, _undrawn):
    """Three clips of two groups, an approach each, and their labels."""
    monkeypatch.setattr("os.fsync", lambda file: None)
    (tmp_path / "clips").mkdir()
    for name in "abcd":
        shutil.copy(clip, tmp_path / "clips" / f"{name}.mp4")

    def write(rows=ROWS, heading=HEADING):
        (tmp_path / "labels.csv").write_text(heading + rows)
        return "tune", "--on", "labels.csv", "--clips", "clips", "--out", "t", "--workers", "1"

    return write


class TestBattery:
    @pytest.fixture(autouse=True)
    def _only_one_is_drawn(self, request):
        if "people" not in request.node.name:
            request.getfixturevalue("_undrawn")

    def test_people_get_both_scores(self, call, tmp_path, tiny):
        done = call(*SHORT, "--trials", "4", "--vary", "decision.*_weight", "--vary", "lgmd?.sigmoid_grey=x2")
        assert done.code == 0, done.err
        lines = done.out.splitlines()
        assert lines[0].split() == ["hits", "false", "minutes", "false/min", "mean", "lead", "s"]
        assert [line.split("  ")[0] for line in lines[1:5]] == [
            "preset paper, searched on", f"best, trial {lines[2].split()[2][:-1]}, searched on",
            "preset paper, held out", f"best, trial {lines[2].split()[2][:-1]}, held out",
        ]  # fmt: skip
        assert "lgmd2.sigmoid_grey" in done.out
        assert "0.0024..0.0096 grey, log" in done.out
        assert "4 trials in this call" in done.out
        assert "times real time" in done.out
        assert done.err.endswith("t/best.toml: for --config of every verb; t/front.png: all that is worth a look\n")
        assert {path.name for path in (tmp_path / "t").iterdir()} == {
            "best.toml", "front", "front.png", "front.svg", "journal.log", "search.json", "trials.csv", "tuning.json"
        }  # fmt: skip

    def test_a_bar_on_a_terminal(self, call, tiny, monkeypatch):
        terminal = Terminal()
        monkeypatch.setattr(sys, "stderr", terminal)
        monkeypatch.setenv("TERM", "xterm")
        assert call(*SHORT, "--trials", "3", "--vary", "lgmd1.sigmoid_grey=x2").code == 0
        shown = terminal.getvalue()
        assert "movies made" in shown
        assert "trials" in shown
        assert "3/3" in shown

    def test_what_was_found_is_a_settings_file(self, call, tmp_path, tiny, clip):
        done = call(*SHORT, "--trials", "3", "--vary", "lgmd?.sigmoid_grey=0.001..0.002", "--set",
                    "decision.window_ms=300", "--json")  # fmt: skip
        found = done.document
        best = found["best"]
        assert best["settings"]["lgmd1.sigmoid_grey"] <= 0.002
        checked = call("config", "validate", "t/best.toml", "--json").document
        assert checked["settings_hash"] == best["settings_hash"]
        assert checked["preset"] == "paper"
        assert checked["changed"] == {"decision.window_ms": 300.0, **best["settings"]}
        run = call("run", clip, "--config", "t/best.toml", "--json")
        assert (run.code, run.records[0]["settings_hash"]) == (0, best["settings_hash"])
        assert {path.stem for path in (tmp_path / "t/front").iterdir()} == {
            f"trial-{entry['trial']:04d}" for entry in found["front"]
        }  # fmt: skip
        assert json.loads((tmp_path / "t/tuning.json").read_text()) | {"folder": "t"} == found

    def test_the_file_says_where_it_comes_from(self, call, tmp_path, tiny):
        done = call(*SHORT, "--trials", "2", "--seed", "5", "--vary", "lgmd1.sigmoid_grey=x2", "--json").document
        text = (tmp_path / "t/best.toml").read_text()
        remarks = [line[2:] for line in text.splitlines() if line.startswith("# ")]
        best = done["best"]
        assert remarks[0] == (
            f"Settings {best['settings_hash']}, found by lobula tune: trial {best['trial']} of 2, seed 5."
        )
        assert remarks[1] == f"lobula {done['version']}, code {done['code']}."
        assert "Held out: of each kind of movie each third variation" in text
        assert f"hits {best['searched_on']['hits']} of 1, " in text
        assert f"Score of what was held out: hits {best['held_out']['hits']} of 1, " in text
        assert "#   lgmd1.sigmoid_grey: 0.0024..0.0096 grey, log" in text

    def test_the_same_command_goes_on(self, call, tmp_path, tiny):
        first = call(*SHORT, "--trials", "2", "--json").document
        again = call(*SHORT, "--trials", "2", "--json").document
        assert again["speed"]["trials"] == 0
        assert again["best"] == first["best"]
        more = call(*SHORT, "--trials", "3", "--json").document
        assert more["speed"]["trials"] == 1
        other = call(*SHORT, "--trials", "3", "--seed", "1")
        assert other.code == 2
        assert other.err == (
            "lobula: t: was begun with another seed (0, not 1): must go on as it began, or in another folder\n"
        )

    def test_nothing_better_is_told(self, call, tiny):
        done = call(*SHORT, "--trials", "1")
        assert "nothing better was found than the settings it began with" in done.out

    def test_a_full_disk_is_told_and_loses_no_finished_trial(self, call, tiny, monkeypatch):
        from optuna.storages.journal import JournalFileBackend

        write, calls = JournalFileBackend.append_logs, []

        def full(self, logs):
            calls.append(logs)
            if len(calls) > 160:
                raise OSError(28, "No space left on device")
            write(self, logs)

        monkeypatch.setattr(JournalFileBackend, "append_logs", full)
        done = call(*SHORT, "--trials", "16")
        assert (done.code, done.err) == (3, "lobula: cannot write t/journal.log: the disk is full\n")
        monkeypatch.setattr(JournalFileBackend, "append_logs", write)
        after = call(*SHORT, "--trials", "16", "--json").document
        assert 0 < after["speed"]["trials"] < 16
        assert after["trials"]["battery"]["measured"] == 16


class TestClips:
    def test_each_group_is_scored_by_settings_found_without_it(self, call, labelled, tmp_path):
        done = call(*labelled(), "--trials", "2", "--vary", "lgmd?.sigmoid_grey=x2", "--json")
        found = done.document
        assert done.code == 0
        folds = {name: part["held_out"] for name, part in found["parts"].items()}
        assert folds == {
            "all groups": [], "without fold 1 (rear)": ["b.mp4", "c.mp4"], "without fold 2 (front)": ["a.mp4"]
        }  # fmt: skip
        assert found["best"]["held_out"]["clips"] == 3
        assert [fold["search"] for fold in found["cross_validation"]] == list(folds)[1:]
        assert "cross-validation: each group" in found["measured_on"]["held_out"]
        assert "Score of settings chosen without the clips they are scored on: " in (
            (tmp_path / "t/best.toml").read_text()
        )
        assert (
            "No score of its own" in "".join(p.read_text() for p in (tmp_path / "t/front").iterdir())
            or len(found["front"]) == 1
        )
        people = call(*labelled(), "--trials", "2", "--vary", "lgmd?.sigmoid_grey=x2")
        assert "chosen without the fold, held out" in people.out
        assert not list((tmp_path / "t").glob(".films-*"))

    def test_the_preset_is_scored_as_evaluate_scores_it(self, call, labelled):
        arguments = labelled()
        found = call(*arguments, "--trials", "1", "--preset", "published", "--json").document
        headline = call("evaluate", "labels.csv", "--clips", "clips", "--preset", "published", "--json").document
        for part in ("searched_on", "held_out"):
            score = found["preset"][part]
            assert {name: score[name] for name in headline["headline"]} == headline["headline"]

    def test_test_rows_are_left_out_and_named(self, call, labelled):
        done = call(*labelled(f"{ROWS}d.mp4,0,,,front,test,\n"), "--trials", "1", "--json")
        assert done.document["measured_on"]["left_out"] == ["d.mp4"]
        assert done.err == "lobula: left out, for they do not count or are marked as test: d.mp4\n"

    def test_without_a_held_out_score_everything_is_marked(self, call, labelled, tmp_path):
        one_group = ROWS.replace("rear", "front")
        refused = call(*labelled(one_group), "--trials", "1")
        assert refused.code == 2
        assert "all clips are of one group, front: must be of 2 or more" in refused.err
        done = call(*labelled(one_group), "--trials", "1", "--no-held-out")
        assert done.code == 0
        assert "NOT HELD OUT" in done.out
        assert "# NOT HELD OUT" in (tmp_path / "t/best.toml").read_text()
        assert json.loads((tmp_path / "t/tuning.json").read_text())["best"]["held_out"] is None

    @pytest.mark.parametrize(
        ("rows", "heading", "says"),
        [
            ("a.mp4,1,88,1\n", HEADING.replace(",group,split,confidence", ""), "a.mp4 has no group (1 of 1 clips)"),
            ("a.mp4,0,,,x,,\nb.mp4,0,,,y,,\n", HEADING, "a collision in no clip: must be in 2 groups or more"),
            ("a.mp4,1,88,1,x,,\nb.mp4,0,,,y,,\n", HEADING, "a collision only in the group x: must be in 2 groups"),
            ("a.mp4,1,88,1,x,test,\n", HEADING, "no clip to search on"),
            ("", HEADING, "no rows: must name at least one clip"),
            ("z.mp4,1,88,1,x,,\nb.mp4,1,88,1,y,,\n", HEADING, "z.mp4: no such file"),
        ],
    )
    def test_labels_that_do_not_do(self, call, labelled, tmp_path, rows, heading, says):
        done = call(*labelled(rows, heading), "--trials", "1")
        assert done.code == 2
        assert says in done.err
        assert len(done.err.splitlines()) == 1
        assert not list((tmp_path / "t").glob(".films-*"))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--on", "battery"), "Missing option '--out'"),
        (("--out", "t"), "Missing option '--on'"),
        (("--on", "batery", "--out", "t"), "--on batery: must be battery, arena, or a file LABELS.csv"),
        (("--on", "none.csv", "--out", "t", "--clips", "."), "--on none.csv: no such file: must be labels of clips"),
        ((*SHORT[1:], "--vary", "lgmd2.sigmod"), "--vary lgmd2.sigmod: no such setting: did you mean lgmd2.sigmoid"),
        ((*SHORT[1:], "--vary", "lgmd2.sigmoid_grey=2..1"), "must be LOW..HIGH in 1e-06..100 grey"),
        ((*SHORT[1:], "--trials", "0"), "0 trials: must be 1 to"),
        ((*SHORT[1:], "--minutes", "0"), "0 minutes: must be above 0"),
        ((*SHORT[1:-1], "0"), "workers = 0: must be 1 to 256"),
        ((*SHORT[1:], "--seed", "-1"), "seed -1: must be 0 or more"),
        ((*SHORT[1:], "--preset", "papre"), "preset 'papre': must be one of default"),
        ((*SHORT[1:], "--set", "lgmd1.gain=2"), "unknown setting lgmd1.gain"),
        ((*SHORT[1:], "--clips", "."), "--clips: means something with --on LABELS.csv only, not --on battery"),
        ((*SHORT[1:], "--no-held-out"), "--no-held-out: means something with --on LABELS.csv only"),
        ((*SHORT[1:], "--seeds", "1..2"), "--seeds: means something with --on arena only, not --on battery"),
        (("--on", "arena", "--out", "t", "--seeds", "2..1"), "--seeds 2..1: must be A..B, whole numbers of 0 or more"),
        (("--on", "arena", "--out", "t", "--seeds", "7001"), "seed 7001: must not be among 7000 to 7999"),
        (("--on", "arena", "--out", "t", "--held-out-seeds", "201"), "must not be searched on and held out at once"),
        (("--on", "arena", "--out", "t", "--sim-minutes", "0"), "0 simulated minutes: must be above 0"),
        (("--on", "arena", "--out", "t", "--seeds", "1..20000"), "20000 seeds: must be at most 1000"),
        (("--on", "arena", "--out", "t", "--robots", "0"), "RobotParams.count = 0: must be int in [1, 256]"),
        (("--on", "arena", "--out", "t", "--robots", "4;7"), "--robots 4;7: must be whole numbers parted by commas"),
        (("--on", "battery", "--out", "file/below"), "--out file/below: file is a file, must be a folder"),
    ],
)
def test_a_wrong_request_is_one_line(call, tmp_path, arguments, says):
    (tmp_path / "file").write_text("")
    done = call("tune", *arguments)
    assert done.code == 2
    assert says in done.err
    assert len(done.err.splitlines()) == 1
    assert not list(tmp_path.glob("t/best.toml"))


@pytest.mark.parametrize(("module", "extra"), [("optuna", "tune"), ("matplotlib.figure", "plot")])
def test_without_its_extra_it_says_what_to_install(call, monkeypatch, module, extra):
    monkeypatch.setitem(sys.modules, module, None)
    done = call(*SHORT)
    assert done.code == 2
    assert f'pip install "lobula[{extra}]"' in done.err


@pytest.mark.parametrize(
    ("number", "code", "workers"), [(signal.SIGTERM, 143, 2), (signal.SIGINT, 130, 1), (signal.SIGKILL, -9, 2)]
)
def test_a_signal_loses_what_was_under_way_and_the_same_command_goes_on(
    call, spawn, labelled, tmp_path, number, code, workers
):
    arguments = [*labelled()[:-2], "--vary", "lgmd?.sigmoid_grey=x2", "--workers", "1"]
    process = spawn(*arguments[:-1], workers, "--trials", "5000")
    journal, deadline_s = tmp_path / "t" / "journal.log", time.monotonic() + 300
    while not (journal.exists() and journal.read_text().count('"trial ') >= 5):
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline_s
        time.sleep(0.1)
    process.send_signal(number)
    _, err = process.communicate(timeout=300)
    assert process.returncode == code
    if code > 0:
        assert "the same command goes on from there" in err
        assert err.endswith(f"interrupted ({signal.Signals(number).name})\n")
        assert not list((tmp_path / "t").glob(".films-*"))
    told = journal.read_text().count('"op_code":6')
    found = call(*arguments, "--trials", "6", "--json")
    assert found.code == 0, found.err
    assert [some["measured"] >= 6 for some in found.document["trials"].values()] == [True] * 3
    assert found.document["speed"]["trials"] <= 18
    assert told >= 5
    assert not list((tmp_path / "t").glob(".films-*"))  # those of the killed one too
