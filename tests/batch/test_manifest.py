"""Rows are found again by content, settings and code, as long as what they name is there."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from lobula.batch.manifest import Manifest
from lobula.batch.row import COLUMNS, Row, row_of

ROW = Row(
    file="a.mp4", status="ok", frames=3, damaged=1, duration_s=0.1, collisions=2, alarms_s=(0.5, 1.5), seconds=0.25,
    content="c" * 64, settings="s" * 12, code="d" * 12, version="1", date="2026-11-22T10:00:00+00:00",
    events="s/a.events.ndjson", trace="s/a.csv", notes=("odd",),
)  # fmt: skip
KEY = (ROW.content, ROW.settings, ROW.code)
WANTED = (".events.ndjson", ".csv")


@pytest.fixture
def outputs(tmp_path):
    (tmp_path / "s").mkdir()
    for name in ("a.events.ndjson", "a.csv"):
        (tmp_path / "s" / name).touch()
    return tmp_path


def test_a_row_survives_the_manifest(outputs):
    Manifest(outputs).add(ROW)
    assert Manifest(outputs).find(KEY, WANTED) == ROW
    (line,) = (outputs / "manifest.ndjson").read_text().splitlines()
    assert tuple(json.loads(line)) == COLUMNS


def test_only_the_same_content_settings_and_code_will_do(outputs):
    manifest = Manifest(outputs)
    manifest.add(ROW)
    for i in range(3):
        assert manifest.find((*KEY[:i], "x", *KEY[i + 1 :]), WANTED) is None


def test_a_failure_is_nothing_to_build_on(outputs):
    manifest = Manifest(outputs)
    manifest.add(replace(ROW, status="failed"))
    assert manifest.find(KEY, WANTED) is None


def test_what_another_process_adds_is_found(outputs):
    manifest = Manifest(outputs)
    assert manifest.find(KEY, WANTED) is None
    Manifest(outputs).add(ROW)
    assert manifest.find(KEY, WANTED) == ROW


def test_a_row_whose_output_is_gone_is_passed_over(outputs):
    Manifest(outputs).add(ROW)
    (outputs / "s" / "a.csv").unlink()
    assert Manifest(outputs).find(KEY, WANTED) is None
    assert Manifest(outputs).find(KEY, WANTED[:1]) == ROW  # nobody wants the trace


def test_a_row_without_what_is_wanted_is_passed_over_for_an_older_one_that_has_it(outputs):
    manifest = Manifest(outputs)
    manifest.add(ROW)
    manifest.add(replace(ROW, trace="", file="later.mp4"))
    assert manifest.find(KEY, WANTED) == ROW
    assert manifest.find(KEY, WANTED[:1]).file == "later.mp4"
    assert manifest.find(KEY, (*WANTED, ".mp4")) is None


@pytest.mark.parametrize(
    "change",
    [{"status": "odd"}, {"status": None}, {"file": 3}, {"content": None}, {"trace": 1}, {"settings": ["x"]}],
)
def test_a_line_that_is_no_row(change):
    assert row_of(ROW.as_dict() | change) is None


def test_a_line_with_less_or_more_than_a_row():
    assert row_of({"status": "ok"}) is None
    assert row_of(ROW.as_dict() | {"of a later version": 1}) == ROW
