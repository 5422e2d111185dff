"""``python -m lobula.evaluate.clip_baselines`` as a user calls it, with few thresholds."""

from __future__ import annotations

import json
import shutil
import sys

import numpy as np
import pytest

from lobula import stimuli
from lobula.cli import main as lobula_command
from lobula.evaluate import contenders
from lobula.evaluate.clip_baselines import main
from lobula.report.grey_clip import write_grey_clip

HEADING = "file,collision,contact_frame,contact_uncertainty_frames,group,confidence\n"


@pytest.fixture
def clips(tmp_path, monkeypatch):
    """An approach in two groups and a passing object, with their labels; thresholds few and far between."""
    pytest.importorskip("cv2", reason="the extra opencv is not installed")
    monkeypatch.setattr(contenders, "SIZES", {(99, 72): "ultrafast"})
    monkeypatch.setattr(contenders, "THRESHOLDS", np.array([0.1, 1.0, 1e4]))
    monkeypatch.setattr(contenders, "SPIKES", (4, 100))
    monkeypatch.setattr(contenders, "POTENTIALS", (0.7,))
    monkeypatch.chdir(tmp_path)
    approach = stimuli.looming(scene="arena", speed_cm_s=12.0)
    passing = stimuli.translating(scene="arena", speed_cm_s=12.0, distance_cm=6.0)
    for name, movie in {"a": approach, "c": passing}.items():
        write_grey_clip(tmp_path / f"{name}.mp4", movie.images, movie.times_s, movie.rate_hz)
    shutil.copy("a.mp4", "b.mp4")
    (tmp_path / "labels.csv").write_text(f"{HEADING}a.mp4,1,90,1,x,\nb.mp4,1,90,1,y,\nc.mp4,0,,,y,\nd.mp4,0,,,y,low\n")
    return tmp_path


def test_everything_is_compared_and_written(clips, capsys):
    assert main(["labels.csv", "--clips", ".", "--out", "out"]) == 0
    printed = capsys.readouterr().out
    assert (clips / "out/clip_baselines.md").read_text() == printed
    lines = printed.splitlines()
    assert all(line.count("|") == 8 for line in lines)
    names = [line.split(" | ")[0][2:] for line in lines[2:]]
    assert names == [
        "preset `paper`", "preset `published`", "preset `lobula`",
        "mean absolute difference, 99x72", "mean square difference, 99x72",
        "frame difference: which of these is chosen, too",
        "mean divergence, 99x72", "mean divergence, middle half, 99x72", "divergence, 95th percentile, 99x72",
        "DIS flow: which of these is chosen, too",
        "LGMD-2 alone, spikes for an alarm", "LGMD-2 alone, T_sp",
        "the LGMD pair, spikes for an alarm", "the LGMD pair, T_sp",
        "older models: which of these is chosen, too",
        "all four neurons, spikes for an alarm", "all four neurons, T_sp",
        "all four: which of these is chosen, too",
    ]  # fmt: skip
    pair = next(line for line in lines if line.startswith("| the LGMD pair, spikes"))
    assert pair.split(" | ")[1:3] == ["4", "2 of 2 [34%, 100%]"]  # 100 spikes never come together; Wilson of 2 in 2


def test_a_preset_has_the_score_that_evaluate_gives_it(clips, capsys):
    assert main(["labels.csv", "--clips", ".", "--out", "out"]) == 0
    found = json.loads((clips / "out/clip_baselines.json").read_text())
    capsys.readouterr()
    (clips / "short.csv").write_text("".join((clips / "labels.csv").read_text().splitlines(keepends=True)[:-1]))
    for name in ("paper", "published", "lobula"):
        lobula_command(["evaluate", "short.csv", "--clips", ".", "--preset", name, "--json"])
        wanted = json.loads(capsys.readouterr().out)["clips"]
        (own,) = (one["clips"] for one in found["contenders"] if one["name"] == f"preset `{name}`")
        for mine, theirs in zip(own, wanted, strict=True):
            assert {key: mine[key] for key in ("file", "hit", "lead_s", "false_alarms")} == {
                key: theirs[key] for key in ("file", "hit", "lead_s", "false_alarms")
            }


@pytest.mark.parametrize(
    ("rows", "code", "says"),
    [
        ("a.mp4,1,90,1,,\n", 2, "lobula: labels labels.csv: a.mp4 has no group (1 of 1 clips)"),
        ("a.mp4,1,90,1,x,\n", 2, "all clips are of one group, x"),
        ("z.mp4,1,90,1,x,\nb.mp4,1,90,1,y,\n", 2, "z.mp4: no such file"),
    ],
)
def test_labels_that_do_not_do(clips, capsys, rows, code, says):
    (clips / "labels.csv").write_text(HEADING + rows)
    assert main(["labels.csv", "--clips", ".", "--out", "out"]) == code
    err = capsys.readouterr().err
    assert says in err
    assert len(err.splitlines()) == 1


def test_an_output_that_cannot_be_written(clips, capsys):
    (clips / "out").write_text("")
    assert main(["labels.csv", "--clips", ".", "--out", "out"]) == 3
    assert capsys.readouterr().err.startswith("lobula: cannot write out: ")


def test_without_opencv_it_says_what_to_install(clips, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    assert main(["labels.csv", "--clips", ".", "--out", "out"]) == 2
    assert 'pip install "lobula[opencv]"' in capsys.readouterr().err
