"""Every example runs offline as it stands and prints what it promises."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"

PRINTS = {
    "six_lines.py": ("avoid at ", " s before contact"),
    "frame_by_frame.py": ("99 x 72 px, recorded", "COLLISION", "0 frames dropped"),
    "blocks.py": ("one stream of 124 frames: first alarm in frame ", "comes: ", "alarm: True", "alarm: False"),
    "look_inside.py": ("lgmd2_grouped", "net motion is rightward"),
    "score_own_clips.py": ("comes.mp4", "hits 2 of 2, false alarms 0"),
    "arena_own_detector.py": ("own detector: ", "the network: ", "chance: ", "SR1"),
    "serial_robot.py": ("serial:/dev/", "124 readings sent, collisions: 1"),
    "arena_environment.py": ("robot_3: ", " gained, ", " CP"),
}
NEEDS = {"arena_environment.py": "pettingzoo"}


def test_every_example_is_tested():
    assert {path.name for path in EXAMPLES.glob("*.py")} == set(PRINTS)


@pytest.mark.parametrize("name", PRINTS)
def test_an_example_runs(name, capsys, monkeypatch, tmp_path):
    if name in NEEDS:
        pytest.importorskip(NEEDS[name], reason=f"the extra {NEEDS[name]} is not installed")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [name])
    runpy.run_path(str(EXAMPLES / name), run_name="__main__")
    printed = capsys.readouterr().out
    for words in PRINTS[name]:
        assert words in printed
    assert not list(tmp_path.iterdir())


def test_the_maps_can_be_saved(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "argv", ["look_inside.py", str(tmp_path / "maps.png")])
    runpy.run_path(str(EXAMPLES / "look_inside.py"), run_name="__main__")
    assert (tmp_path / "maps.png").read_bytes().startswith(b"\x89PNG")


def test_a_clip_instead_of_the_movie(monkeypatch, tmp_path, capsys):
    from lobula.cli import main

    monkeypatch.chdir(tmp_path)
    assert main(["stimulus", "receding"]) == 0
    monkeypatch.setattr(sys, "argv", ["frame_by_frame.py", "receding.mp4"])
    runpy.run_path(str(EXAMPLES / "frame_by_frame.py"), run_name="__main__")
    printed = capsys.readouterr().out
    assert "receding.mp4: 99 x 72 px" in printed
    assert "COLLISION" not in printed
