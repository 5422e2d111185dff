"""The lines of Python on docs/track.md run as they stand."""

from __future__ import annotations

import pytest

from ..docs.pages import ROOT, blocks

pytest.importorskip("cv2")


def test_the_lines_run_and_find_the_robots(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = blocks(ROOT / "docs" / "track.md", "python")
    exec(code, {})
    printed = capsys.readouterr().out
    assert "21." in printed  # 20 + 4 / 4 cm in the last picture
    assert "nan" not in printed
