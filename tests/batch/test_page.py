"""docs/batch.md: its Python runs as it stands, and its tables are those of the code."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import pytest

from lobula.batch.row import COLUMNS
from lobula.batch.summary import Summary

from .conftest import write_clip

PAGE = (Path(__file__).parents[2] / "docs" / "batch.md").read_text(encoding="utf-8")


def test_the_python_runs(tmp_path, monkeypatch, capsys):
    (code,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    for seed in range(2):
        write_clip(tmp_path / "clips" / f"{seed}.mp4", seed)
    monkeypatch.chdir(tmp_path)
    exec(code, {"__name__": "__main__"})
    lines = capsys.readouterr().out.splitlines()
    assert sorted(lines[:2]) == ["clips/0.mp4 ok ()", "clips/1.mp4 ok ()"]
    assert lines[2] == "2 of 2"


def test_the_columns_are_told_in_their_order():
    table = PAGE.split("The columns of `clips.csv`")[1].split("`summary.json`, which")[0]
    told = [name for cell in re.findall(r"^\| (`.*?) \|", table, re.MULTILINE) for name in re.findall(r"`(\w+)`", cell)]
    assert told == list(COLUMNS)


@pytest.mark.parametrize("name", ["clips", "ok", "failed", "unfinished", "done", "kept", "footage_s", "busy_s"])
def test_the_counts_on_the_page_are_there(name):
    assert name in {f.name for f in fields(Summary)}
    assert f"`{name}`" in PAGE
