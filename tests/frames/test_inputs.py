"""What the user's word for a source is taken to mean."""

from __future__ import annotations

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames.inputs import kind_of_source


@pytest.mark.parametrize(
    ("source", "kind"),
    [
        (0, ("camera", "0")),
        ("2", ("camera", "2")),
        ("/dev/video3", ("camera", "3")),
        ("-", ("pipe", "-")),
        ("rtsp://host:554/stream", ("address", "rtsp://host:554/stream")),
        ("http://host/a.mjpg", ("address", "http://host/a.mjpg")),
        ("no/such/*.png", ("pattern", "no/such/*.png")),
        (np.zeros((1, 2, 3)), ("array", "")),
    ],
)
def test_kinds(source, kind):
    assert kind_of_source(source) == kind


def test_paths_go_before_patterns(tmp_path, monkeypatch):
    odd = tmp_path / "clip[1].mp4"
    odd.write_bytes(b"")
    assert kind_of_source(odd) == ("file", str(odd))
    assert kind_of_source(f"file://{odd}") == ("file", str(odd))
    assert kind_of_source(tmp_path) == ("folder", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "0").write_bytes(b"")
    assert kind_of_source("./0") == ("file", "./0")


@pytest.mark.parametrize("source", [None, "", -1, 1.5, True, {}])
def test_refuses_what_is_no_source(source):
    with pytest.raises(ParameterError, match="must be a file, folder, pattern, '-', camera number, address or array"):
        lobula.frames.open(source)


def test_missing_file():
    with pytest.raises(FrameSourceError, match=r"none\.mp4: no such file or folder"):
        kind_of_source("none.mp4")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rate_hz": 0}, "rate_hz = 0: must be"),
        ({"rate_hz": float("inf")}, "rate_hz = inf"),
        ({"threads": -1}, "threads = -1"),
        ({"timeout_s": 0}, "timeout_s = 0"),
        ({"input_size": (640,)}, "input_size"),
        ({"input_size": (640, 0)}, "input_size"),
        ({"pixel_format": "gray8"}, "pixel_format: the source is an array: may be given only for a pipe, a camera"),
    ],
)
def test_refuses_options(options, message):
    with pytest.raises(ParameterError, match=message):
        lobula.frames.open(np.zeros((1, 72, 99), np.uint8), **options)


def test_times_belong_to_arrays(tmp_path):
    with pytest.raises(ParameterError, match=r"times_s: .* is a folder: may be given only for an array"):
        lobula.frames.open(tmp_path, times_s=[0.0])
