"""Packets: one for each picture at once, a key frame every second of the pictures' own time."""

from pathlib import Path

import av
import numpy as np
import pytest

from lobula.report.h264 import TICK, H264Encoder
from lobula.report.mp4 import Mp4File

HERE = Path("v.mp4")


def coded(times_s, noise=0):
    rng = np.random.default_rng(0)
    encoder = H264Encoder(HERE, 64, 48)
    pictures = (
        np.full((48, 64, 3), 40 + i % 150, np.uint8) + rng.integers(0, noise + 1, (48, 64, 3), np.uint8)
        for i in range(len(times_s))
    )
    return encoder, [encoder.encode(p, t) for p, t in zip(pictures, times_s, strict=True)]


@pytest.mark.parametrize(
    ("times_s", "keys"),
    [
        (np.arange(70) / 30, [0, 30, 60]),
        (np.arange(5) / 2, [0, 2, 4]),
        (np.arange(4) * 3.0, [0, 1, 2, 3]),  # slower than a key frame a second: all of them
        (np.arange(250) / 120, [0, 120, 240]),
        ([5.0, 5.5, 5.9, 6.05, 6.9, 7.2], [0, 3, 5]),  # uneven, and not from 0
    ],
)
def test_a_key_frame_every_second(times_s, keys):
    _, packets = coded(times_s)
    assert [i for i, p in enumerate(packets) if p.key] == keys
    assert [p.tick for p in packets] == [round((t - times_s[0]) / TICK) for t in times_s]


def test_a_scene_that_changes_all_at_once_may_add_one():
    encoder = H264Encoder(HERE, 64, 48)
    pictures = [np.full((48, 64, 3), 20 if i < 5 else 230, np.uint8) for i in range(10)]
    packets = [encoder.encode(p, i / 10) for i, p in enumerate(pictures)]
    assert len(packets) == 10  # and nothing waits in the encoder
    assert packets[0].key


@pytest.mark.parametrize("noise", [0, 90])
def test_a_file_may_begin_at_any_key_frame(tmp_path, noise):
    encoder, packets = coded(np.arange(50) / 20, noise)
    for number, start in enumerate((0, 20, 40)):
        file = Mp4File(tmp_path / f"{number}.mp4", encoder.template)
        for packet in packets[start:]:
            file.add(packet)
        file.finish(50 - start)
        with av.open(str(tmp_path / f"{number}.mp4")) as container:
            frames = list(container.decode(video=0))
        assert [f.time for f in frames] == pytest.approx([i / 20 for i in range(50 - start)])
        grey = frames[0].to_ndarray(format="rgb24").mean()
        assert grey == pytest.approx(40 + start + noise / 2, abs=4)
        assert not any(f.is_corrupt for f in frames)
