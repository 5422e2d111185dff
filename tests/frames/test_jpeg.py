"""JPEGs of whole pictures, given in colours or as decoded: upright, small, one after the other."""

from __future__ import annotations

import io

import av
import numpy as np
import pytest

import lobula
from lobula.frames.jpeg import Jpeg

from .clips import write_clip


def read(jpeg: bytes):
    with av.open(io.BytesIO(jpeg)) as container:
        return next(container.decode(video=0)).to_ndarray(format="rgb24")


@pytest.mark.parametrize(
    ("shape", "width", "size"),
    [((480, 640), 640, (640, 480)), ((1080, 1920), 640, (640, 360)), ((31, 33), 640, (32, 32)), ((2, 2), 640, (2, 2))],
)
def test_size_and_colours(shape, width, size):
    picture = np.zeros((*shape, 3), np.uint8)
    picture[:] = 200, 40, 90
    data = Jpeg(width)(picture)
    assert data[:2] == b"\xff\xd8"
    shown = read(data)
    assert shown.shape == (size[1], size[0], 3)
    assert np.abs(shown.astype(int) - (200, 40, 90)).max() < 10


def test_pictures_may_change_their_size():
    encode = Jpeg()
    for side in (64, 32, 64):
        assert read(encode(np.zeros((side, side, 3), np.uint8))).shape[1] == side


def quarters(height: int = 64, width: int = 96):
    """Four quarters of different greys: no turn or mirror leaves it as it is."""
    picture = np.empty((height, width), np.uint8)
    picture[: height // 2, : width // 2], picture[: height // 2, width // 2 :] = 40, 90
    picture[height // 2 :, : width // 2], picture[height // 2 :, width // 2 :] = 150, 220
    return picture


@pytest.mark.parametrize("how", [{}, {"rotate": 90}, {"rotate": 180, "flip": "h"}, {"rotate": 270}, {"flip": "v"}])
def test_it_is_the_upright_picture(tmp_path, how):
    clip = write_clip(tmp_path / "clip.mp4", [quarters()] * 3)
    with lobula.open(clip, **how) as frames:
        next(frames)
        decoded, picture = frames.decoded(), frames.picture()
        next(frames)  # what was handed over stays good
    shown = read(Jpeg()(decoded))
    assert shown.shape == picture.shape
    assert np.abs(shown.astype(int) - picture).mean() < 4


@pytest.mark.parametrize("how", [{}, {"rotate": 90}])
def test_a_wide_one_is_made_small_and_keeps_its_shape(how):
    with lobula.open(np.stack([quarters(400, 801)] * 2), **how) as frames:
        next(frames)
        shown = read(Jpeg(200)(frames.decoded()))
    upright = (100, 200) if not how else (400, 200)
    assert shown.shape[:2] == pytest.approx(upright, abs=1)
    greys = np.sort(np.unique(shown[10::40, 10::60, 0].round(-1)))
    assert greys[0] < 60
    assert greys[-1] > 200


def test_one_writer_takes_one_picture_after_the_other(tmp_path):
    clip = write_clip(tmp_path / "clip.mp4", [np.full((64, 96), grey, np.uint8) for grey in (60, 120, 180)])
    write = Jpeg()
    with lobula.open(clip) as frames:
        means = [read(write(frames.decoded())).mean() for _ in frames]
    assert np.diff(means) == pytest.approx([70, 70], abs=4)  # limited range: 60 grey levels are 70 of luma


def test_its_pictures_may_differ_in_size_and_kind():
    write = Jpeg()
    for images in (np.full((2, 64, 96), 50.4, np.float32), np.full((2, 64, 96), 200, np.uint8), quarters(30, 50)[None]):
        with lobula.open(images) as frames:
            next(frames)
            shown = read(write(frames.decoded()))
        assert shown.shape[:2] == images.shape[1:]
        assert abs(shown.mean() - images.mean()) < 3
