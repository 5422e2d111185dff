"""The hash of what is asked changes with all that the numbers depend on, and with nothing else."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest

import lobula
from lobula.batch.request import make_request
from lobula.engine import library
from lobula.errors import FrameSourceError, LobulaError, MissingExtraError, ParameterError
from lobula.report.png import write_png


def settings(out, params=None, **options):
    return make_request(out, params or lobula.preset(), preset="default", **options).settings


@pytest.mark.parametrize(
    "options",
    [
        {"size": (120, 90)}, {"fit": "pad"}, {"roi": (0, 0, 99, 72)}, {"flip": "h"}, {"rotate": 90}, {"start_s": 1.0},
        {"end_s": 1.0}, {"stride": 2}, {"max_frames": 5}, {"rate_hz": 25.0}, {"engine": "reference"},
        {"params": lobula.preset("published")},
    ],
)  # fmt: skip
def test_it_changes_with(out, options):
    assert settings(out, **options) != settings(out)


@pytest.mark.parametrize(
    "options",
    [
        {"size": (99, 72)}, {"fit": "crop"}, {"roi": None}, {"stride": 1}, {"trace": None}, {"trace": ".npz"},
        {"annotate": True}, {"engine": "core"},
    ],
)  # fmt: skip
def test_it_does_not_change_with(out, options):
    if options.get("engine") == "core":
        library.available() or pytest.skip("the C core was not built")
    assert settings(out, **options) == settings(out)


def test_a_mask_counts_by_its_content(out, tmp_path):
    for name, grey in (("a", 255), ("same", 255), ("other", 200)):
        write_png(tmp_path / f"{name}.png", np.full((72, 99), grey, np.uint8))
    a, same, other = (settings(out, mask=tmp_path / f"{name}.png") for name in ("a", "same", "other"))
    assert a == same
    assert len({settings(out), a, other}) == 3


def test_the_settings_are_written_where_the_outputs_go(ask, out):
    asked = ask(stride=3)
    told = json.loads((out / asked.settings / "settings.json").read_text())
    assert told["settings"] == asked.settings
    assert told["open"]["stride"] == 3
    assert told["network"]["decision"]["window_ms"] == asked.params.decision.window_ms


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"fit": "odd"}, ParameterError, "fit = 'odd': must be one of"),
        ({"stride": 0}, ParameterError, "stride = 0: must be"),
        ({"rate_hz": -1.0}, ParameterError, "rate_hz = -1.0: must be"),
        ({"trace": ".xls"}, ParameterError, "trace '.xls': must be one of .csv, .npz, .parquet, or none"),
        ({"engine": "gpu"}, ParameterError, "engine 'gpu': must be one of"),
        ({"times_s": [0.0]}, ParameterError, "times_s: not an option for every clip: must be one of size, "),
        ({"mask": "gone.png"}, FrameSourceError, "mask gone.png: no such file"),
    ],
)
def test_refused(out, options, error, message):
    with pytest.raises(error) as caught:
        settings(out, **options)
    assert str(caught.value).startswith(message)
    assert not out.exists()


def test_what_is_missing_is_said_before_the_work(out, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(MissingExtraError, match=r"lobula\[parquet\]"):
        settings(out, trace=".parquet")
    monkeypatch.setattr("av.codecs_available", set())
    with pytest.raises(LobulaError, match="no libx264 encoder"):
        settings(out, annotate=True)
