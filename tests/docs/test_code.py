"""Python on the pages runs as it stands, on a clip in which something comes."""

from __future__ import annotations

from pathlib import Path

import pytest

import lobula
from lobula.report.grey_clip import write_grey_clip

from .pages import ROOT, blocks


@pytest.fixture
def clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> float:
    """Lay ``clip.mp4`` into an empty working folder; return the moment of contact, s."""
    movie = lobula.stimuli.looming(scene="arena")
    write_grey_clip(tmp_path / "clip.mp4", movie.images, movie.times_s.tolist(), movie.rate_hz)
    monkeypatch.chdir(tmp_path)
    assert movie.contact_s is not None
    return movie.contact_s


def test_the_lines_of_the_readme_find_the_collision(clip: float, capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = blocks(ROOT / "README.md", "python")
    assert len([line for line in code.splitlines() if line]) == 6
    exec(code, {})
    times_s = [float(line.split()[-2]) for line in capsys.readouterr().out.splitlines()]
    (time_s,) = times_s  # once, though the alarm lasts for many frames
    assert clip - 2 < time_s < clip


def test_the_python_page_runs_from_top_to_bottom(clip: float) -> None:
    code = blocks(ROOT / "docs" / "python.md", "python")
    assert len(code) >= 5
    names: dict[str, object] = {}
    for block in code:
        exec(block, names)


def test_the_python_page_names_every_public_name() -> None:
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    assert not [name for name in lobula.__all__ if f"`{name}`" not in text]
