"""The smaller verbs, called as a user calls them."""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import lobula
from lobula.cli import doctor
from lobula.engine import library
from lobula.types import TRACE_DTYPE


class TestDemo:
    @pytest.fixture(autouse=True)
    def _without_matplotlib(self, monkeypatch):
        """Loading it takes longer than everything else here."""
        monkeypatch.setitem(sys.modules, "matplotlib.figure", None)

    def test_only_what_comes_is_a_collision(self, call, tmp_path):
        done = call("demo", "--json")
        assert done.code == 0
        movies = {m["movie"]: m for m in done.document["movies"]}
        assert list(movies) == ["looming", "translating_right", "receding"]
        (seen_s,) = movies["looming"]["collisions_s"]
        assert seen_s < movies["looming"]["contact_s"]
        assert movies["translating_right"]["collisions_s"] == movies["receding"]["collisions_s"] == []
        assert movies["receding"]["neurons"]["lgmd2"]["spikes"] == 0
        assert (tmp_path / "lobula-demo.png").read_bytes().startswith(b"\x89PNG")

    def test_people_get_a_table_and_a_sentence_each(self, call):
        done = call("demo", "--out", "d.png")
        assert done.out.splitlines()[1].split() == ["object", "LGMD-1", "LGMD-2", "LPTC-R", "LPTC-L", "collision"]
        assert "approach: collision seen at" in done.out
        assert "passing by: no collision\ngoing away: no collision" in done.out
        assert "picture: d.png" in done.err

    def test_an_unexpected_decision_is_exit_code_1(self, call):
        done = call("demo", "--set", "decision.collision_spikes=100")
        assert done.code == 1
        assert "NOT AS EXPECTED" in done.out

    def test_without_matplotlib_it_draws_itself(self, call, tmp_path):
        assert call("demo").code == 0
        with lobula.open(tmp_path / "lobula-demo.png") as frames:
            assert frames.source_width >= 600

    def test_without_matplotlib_other_pictures_need_it(self, call):
        done = call("demo", "--out", "d.svg")
        assert (done.code, 'pip install "lobula[plot]"' in done.err) == (2, True)

    def test_with_matplotlib_it_draws_with_that(self, call, tmp_path, monkeypatch):
        monkeypatch.undo()
        pytest.importorskip("matplotlib")
        assert call("demo", "--out", tmp_path / "demo.svg").code == 0
        assert b"<svg" in (tmp_path / "demo.svg").read_bytes()


class TestStimulus:
    @pytest.mark.parametrize("out", ["clip.mp4", "clip.mkv", "shots"])
    def test_what_is_read_back_is_the_movie(self, call, out, tmp_path):
        done = call("stimulus", "looming", "--set", "speed_cm_s=12", "--set", "scene=arena", "--out", out, "--json")
        movie = lobula.stimuli.looming(speed_cm_s=12, scene="arena")
        with lobula.open(tmp_path / out) as frames:
            read = list(frames)
        assert np.array_equal([f.image for f in read], movie.images)
        assert [f.time_s for f in read] == pytest.approx(movie.times_s.tolist(), abs=1e-3)
        truth = json.loads((tmp_path / done.document["truth"]).read_text())
        assert (truth["kind"], truth["contact_s"], truth["contact_frame"]) == ("looming", 3.0, 90)  # 0.5 s + 30 cm / 12
        assert truth["settings"]["speed_cm_s"] == 12

    def test_npz(self, call):
        assert call("stimulus", "flash", "--out", "f.npz").code == 0
        with np.load("f.npz") as file:
            assert json.loads(str(file["truth"]))["kind"] == "flash"
            assert len(file["images"]) == len(file["times_s"]) == 91

    def test_lists(self, call):
        assert "translating_left" in call("stimulus", "--list", "--json").document
        assert call("stimulus", "looming", "--list", "--json").document["start_cm"] == 30.0
        assert "start_cm" in call("stimulus", "looming", "--list").out

    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            ([], "no name: must be one of looming,"),
            (["loming"], "stimulus 'loming': must be one of"),
            (["looming", "--set", "sped_cm_s=8"], "unknown setting sped_cm_s: did you mean speed_cm_s?"),
            (["looming", "--set", "speed=12"], "unknown setting speed: did you mean speed_cm_s?"),
            (["looming", "--set", "speed_cm_s"], "must be NAME=VALUE"),
            (["looming", "--set", "speed_cm_s=-8"], "speed_cm_s = -8"),
            (["looming", "--out", "clip.avi"], "must end in .mp4, .mkv or .npz"),
            (["looming", "--set", "width=8"], "must be"),
        ],
    )
    def test_wrong_requests(self, call, arguments, says):
        done = call("stimulus", *arguments)
        assert done.code == 2
        assert done.err.count("\n") == 1
        assert says in done.err


class TestPlotAndExplain:
    def test_a_trace_becomes_a_figure(self, call, clip, tmp_path):
        pytest.importorskip("matplotlib")
        call("run", clip, "--trace", "t.csv")
        document = call("plot", "t.csv", "--json").document
        assert document["figure"] == "t.png"
        assert document["frames"] == 91
        assert len(document["collisions"]) == 1
        assert (tmp_path / "t.png").read_bytes().startswith(b"\x89PNG")
        assert call("plot", "t.csv", "--out", "f.svg").code == 0

    def test_wrong_traces(self, call, tmp_path):
        (tmp_path / "t.csv").write_text("a,b\n1,2\n")
        assert call("plot", "t.csv").err.count("spikes_lptc_r") == 1
        (tmp_path / "e.csv").write_text("")
        assert call("plot", "e.csv").err == "lobula: trace e.csv: is empty\n"
        (tmp_path / "e.csv").write_text(",".join(TRACE_DTYPE.names) + "\n")
        assert call("plot", "e.csv").err == "lobula: trace e.csv: has no rows: nothing to draw\n"
        assert call("plot", "none.csv").code == 2

    def test_the_alarm_is_explained(self, call, clip):
        start = next(r for r in call("run", clip, "--json").records if r["type"] == "collision")
        at = start["time_s"]
        why = call("explain", clip, "--at", at, "--json").document
        assert (why["frame"], why["collision"]) == (start["frame"], True)
        assert all(c["holds"] for c in why["conditions"])
        assert why["sums"]["lgmd"] >= 4
        assert why["potentials"]["lgmd1"] == pytest.approx(start["lgmd1"], abs=1e-5)
        before = call("explain", clip, "--at", at - 1 / 30, "--json").document
        assert before["collision"] is False
        assert not all(c["holds"] for c in before["conditions"])

    def test_people_get_sentences_and_a_picture(self, call, clip, tmp_path):
        done = call("explain", clip, "--at", 1, "--out", "maps.png")
        assert done.code == 0
        assert done.out.startswith("frame 30 at 1.000 s, state ok\nno collision: ")
        assert "lgmd2_grouped" in done.out
        assert "A speaks for a collision" in done.out
        assert (tmp_path / "maps.png").read_bytes().startswith(b"\x89PNG")

    def test_a_moment_outside(self, call, clip):
        done = call("explain", clip, "--at", 99)
        assert (done.code, done.err) == (2, f"lobula: at 99 s: {clip} ends at 3.000 s: must lie inside it\n")


class TestDoctor:
    def test_what_was_found(self, call):
        found = call("doctor", "--json").document
        assert found["lobula"] == lobula.__version__
        assert found["numpy"] == np.__version__
        assert found["h264_decoder"] is True
        assert (found["engine"] == "core") == library.available()
        assert "engine" in call("doctor").out

    def test_what_is_missing_comes_with_its_command(self, call, monkeypatch):
        monkeypatch.setattr(doctor, "find_spec", lambda module: None)
        missing = call("doctor", "--json").document["missing"]
        command = 'pip install "lobula[parquet]" (from a clone: pip install ".[parquet]")'
        assert f"traces in .parquet: {command}" in missing

    def test_it_knows_every_extra(self):
        project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
        assert {*doctor.EXTRAS, "test", "dev"} == set(project["optional-dependencies"])

    def test_no_core(self, call, monkeypatch):
        monkeypatch.setattr(library, "available", lambda: False)
        monkeypatch.setattr(library, "why_not", lambda: "it was not built")
        monkeypatch.setattr(library, "isas", tuple)
        found = call("doctor", "--json").document
        assert found["engine"] == "reference"
        assert "it was not built" in found["missing"][0]


class TestBench:
    @pytest.fixture(autouse=True)
    def _measured(self, monkeypatch):
        us = {"median": 50.0, "best": 40.0}
        figures = {
            "machine": {"processor": "cpu", "cores": 2, "isa": "v3"}, "engine": "core", "step_us": {"99x72": us},
            "block_us": {"99x72": us}, "reference_step_us": {"99x72": us},
            "streams": {"streams": 64, "threads": 2, "size": "99x72", "frame_us": us}, "video": None,
        }  # fmt: skip
        monkeypatch.setattr("lobula.bench.measure", lambda rounds: figures | {"rounds": rounds})

    def test_figures_as_json_and_as_text(self, call):
        assert call("bench", "--rounds", "3", "--json").document["rounds"] == 3
        assert "step 99x72" in call("bench").out

    def test_no_rounds(self, call):
        assert call("bench", "--rounds", "0").code == 2


class TestEvaluate:
    @pytest.fixture
    def clips(self, call, tmp_path):
        for name, kind in (("comes", "looming"), ("goes", "receding")):
            call("stimulus", kind, "--set", "scene=arena", "--set", "speed_cm_s=12", "--out", f"{name}.mp4")
        (tmp_path / "labels.csv").write_text(
            "file,collision,contact_frame,contact_uncertainty_frames,event\n"
            "comes.mp4,1,90,1,LOOMING: box\ngoes.mp4,0,,,RECEDING: box\n")  # fmt: skip
        return tmp_path

    def test_scores_as_json(self, call, clips):
        done = call("evaluate", "labels.csv", "--clips", clips, "--json")
        assert done.code == 0
        document = done.document
        headline = document["headline"]
        assert (headline["hits"], headline["collisions"], headline["false_alarms"]) == (1, 1, 0)
        assert headline["minutes"] == pytest.approx((1.0 + 91 / 30) / 60, abs=1e-4)  # 0..1 s of one, all of the other
        assert [c["class"] for c in document["clips"]] == ["LOOMING", "RECEDING"]
        assert 0.2 < document["clips"][0]["lead_s"] < 2

    def test_scores_as_text(self, call, clips, monkeypatch):
        monkeypatch.setenv("LOBULA_CLIPS", str(clips))
        out = call("evaluate", "labels.csv").out
        assert "hits 1 of 1 collision = 100% [21%, 100%] (Wilson)" in out  # 1 / (1 + 1.96^2) = 0.2065
        assert "false alarms 0 in 0.07 min" in out

    def test_a_clip_that_is_missing(self, call, clips):
        (clips / "goes.mp4").unlink()
        done = call("evaluate", "labels.csv", "--clips", ".", "--json")
        assert done.code == 4
        assert done.document["failed"] == [{"file": "goes.mp4", "problem": "goes.mp4: no such file or folder"}]
        (clips / "comes.mp4").unlink()
        none = call("evaluate", "labels.csv", "--clips", ".")
        assert none.code == 2
        assert none.err.splitlines()[-1] == "lobula: .: none of the clips that labels.csv names could be scored"

    def test_wrong_requests(self, call, clips, monkeypatch):
        assert "--clips none: no such folder" in call("evaluate", "labels.csv", "--clips", "none").err
        monkeypatch.delenv("LOBULA_CLIPS", raising=False)
        assert "no such folder: must hold the clips" in call("evaluate", "labels.csv").err
        assert "none.csv: no such file" in call("evaluate", "none.csv", "--clips", ".").err
