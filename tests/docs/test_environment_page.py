"""Python on the page about detectors and the environment runs as it stands."""

from __future__ import annotations

import pytest

from .pages import ROOT, blocks

PAGE = ROOT / "docs" / "environment.md"


def test_the_detector(capsys: pytest.CaptureFixture[str]) -> None:
    exec(blocks(PAGE, "python")[0], {})
    assert capsys.readouterr().out.startswith("counterfactual ")


def test_the_environment(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pettingzoo", reason="the extra pettingzoo is not installed")
    names: dict[str, object] = {}
    exec(blocks(PAGE, "python")[1], names)
    assert "'CR'" in capsys.readouterr().out
    assert names["picture"].shape == (456, 576, 3)  # (55 + 2) and (70 + 2) cm at 8 px
