"""JPEGs of whole pictures: their size and their colours."""

from __future__ import annotations

import io

import av
import numpy as np
import pytest

from lobula.frames.jpeg import Jpeg


@pytest.mark.parametrize(
    ("shape", "width", "size"),
    [((480, 640), 640, (640, 480)), ((1080, 1920), 640, (640, 360)), ((31, 33), 640, (32, 32)), ((2, 2), 640, (2, 2))],
)
def test_size_and_colours(shape, width, size):
    picture = np.zeros((*shape, 3), np.uint8)
    picture[:] = 200, 40, 90
    data = Jpeg(width)(picture)
    assert data[:2] == b"\xff\xd8"
    with av.open(io.BytesIO(data)) as container:
        frame = next(container.decode(video=0))
    assert (frame.width, frame.height) == size
    assert np.abs(frame.to_ndarray(format="rgb24").astype(int) - (200, 40, 90)).max() < 10


def test_pictures_may_change_their_size():
    encode = Jpeg()
    for side in (64, 32, 64):
        with av.open(io.BytesIO(encode(np.zeros((side, side, 3), np.uint8)))) as container:
            assert container.streams.video[0].width == side
