"""Small clips, a request for them, and hands that do the work in this process."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import lobula
from lobula.batch.request import make_request, write_settings
from lobula.batch.work import Desk
from lobula.report.grey_clip import write_grey_clip


def write_clip(path: Path, seed: int = 0, frames: int = 20) -> Path:
    """Write noise at 30 Hz: another ``seed`` is another content."""
    images = np.random.default_rng(seed).integers(0, 255, (frames, 72, 99), np.uint8)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_grey_clip(path, images, [i / 30 for i in range(frames)], 30)
    return path


class Alone:
    """Hands of a batch: this process."""

    workers = 1

    def __init__(self, asked):
        self.asked = asked

    def __enter__(self):
        return self

    def __exit__(self, *how):
        pass

    def each(self, clips):
        desk = Desk(self.asked)
        for clip in clips:
            yield clip, desk.do(clip)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out"


@pytest.fixture
def ask(out):
    """Make a request into ``out``, whose places are there."""

    def make(**options):
        network = {name: options.pop(name) for name in ("params", "preset") if name in options}
        asked = make_request(
            out, network.get("params", lobula.preset()), preset=network.get("preset", "default"), **options
        )
        write_settings(asked)
        return asked

    return make
