"""Folders and patterns of images: natural order, rate or times.csv, every image format."""

from __future__ import annotations

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError

from .clips import HEIGHT, WIDTH, image_bytes, moving_bar

SIZE = (WIDTH, HEIGHT)


def fill(folder, names, pictures=None):
    for name, picture in zip(names, pictures or moving_bar(len(names)), strict=True):
        (folder / name).write_bytes(image_bytes(picture))
    return folder


def read(source, **options):
    with lobula.frames.open(source, size=SIZE, **options) as frames:
        return list(frames), frames


def test_natural_order_and_default_rate(tmp_path):
    fill(tmp_path, ["f1.png", "f2.png", "f10.png", "F3.png"])
    (tmp_path / "readme.txt").write_text("not an image")
    (tmp_path / "._f1.png").write_text("what some systems leave behind")
    got, frames = read(tmp_path)
    first, second, tenth, third = moving_bar(4)
    for frame, picture in zip(got, [first, second, third, tenth], strict=True):
        np.testing.assert_array_equal(frame.image, picture)
    np.testing.assert_allclose([f.time_s for f in got], np.arange(4) / 30)
    assert (frames.fps, frames.frame_count) == (30.0, 4)


def test_rate(tmp_path):
    got, frames = read(fill(tmp_path, ["a.png", "b.png", "c.png"]), rate_hz=10)
    np.testing.assert_allclose([f.time_s for f in got], [0, 0.1, 0.2])
    assert frames.fps == 10


def test_pattern(tmp_path):
    fill(tmp_path, ["left_1.png", "left_2.png", "right_1.png", "right_2.png"])
    got, _ = read(str(tmp_path / "right_*.png"))
    assert len(got) == 2
    np.testing.assert_array_equal(got[0].image, moving_bar(4)[2])


@pytest.mark.parametrize(
    ("ending", "codec", "pixel_format", "tolerance"),
    [
        ("png", "png", "gray", 0),
        ("PNG", "png", "rgb24", 0),
        ("jpg", "mjpeg", "yuvj420p", 8),
        ("bmp", "bmp", "bgr24", 0),
        ("tif", "tiff", "gray", 0),
        ("tiff", "tiff", "rgb24", 0),
        ("pgm", "pgm", "gray", 0),
    ],
)
def test_image_formats(tmp_path, ending, codec, pixel_format, tolerance):
    pictures = moving_bar(2)
    for i, picture in enumerate(pictures):
        (tmp_path / f"{i}.{ending}").write_bytes(image_bytes(picture, codec, pixel_format))
    got, _ = read(tmp_path)
    for frame, picture in zip(got, pictures, strict=True):
        np.testing.assert_allclose(frame.image, picture.astype(float), atol=tolerance)


def test_sign_characters_in_names_mean_nothing(tmp_path):
    folder = tmp_path / "2020:01:01 %d"
    folder.mkdir()
    got, _ = read(fill(folder, ["a%03d.png", "b:c.png"]))
    assert len(got) == 2


def test_mixed_pixel_formats_are_fine(tmp_path):
    pictures = moving_bar(2)
    (tmp_path / "0.png").write_bytes(image_bytes(pictures[0], "png", "gray"))
    (tmp_path / "1.png").write_bytes(image_bytes(pictures[1], "png", "rgba"))
    got, _ = read(tmp_path)
    np.testing.assert_array_equal(got[1].image, pictures[1])


def test_times_file_gives_order_and_stamps(tmp_path):
    fill(tmp_path, ["a.png", "b.png", "c.png"])
    (tmp_path / "times.csv").write_text("time_s,file\n100.0,c.png\n100.25,a.png\n")
    got, frames = read(tmp_path)
    assert [f.time_s for f in got] == [0.0, 0.25]
    np.testing.assert_array_equal(got[0].image, moving_bar(3)[2])
    assert frames.fps == 4.0  # one gap of 0.25 s


def test_start_is_not_read_from_disk(tmp_path):
    fill(tmp_path, ["0.png", "1.png", "2.png", "3.png"])
    (tmp_path / "1.png").write_text("damaged")
    got, frames = read(tmp_path, rate_hz=10, start_s=0.2)
    assert [f.index for f in got] == [2, 3]
    assert frames.damaged == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name,when\na.png,0\n", "columns .*: must hold file and time_s"),
        ("file,time_s\na.png,soon\n", "line 2: time_s = 'soon': must be a number"),
        ("file,time_s\na.png\n", "line 2: time_s = None"),
        ("file,time_s\na.png,1\nb.png,1\n", "line 3: time stands still: 1.000000 s after 1.000000 s"),
        ("file,time_s\na.png,1\nb.png,0.5\n", "line 3: time runs backwards: 0.500000 s after 1.000000 s"),
        ("file,time_s\nz.png,1\n", "line 2: no file 'z.png' in the folder"),
        ("file,time_s\n", "no rows: must name at least one image"),
        ("", "is empty"),
    ],
)
def test_times_file_that_does_not_fit(tmp_path, text, message):
    fill(tmp_path, ["a.png", "b.png"])
    (tmp_path / "times.csv").write_text(text)
    with pytest.raises(FrameSourceError, match=r"times\.csv: " + message):
        lobula.frames.open(tmp_path)


def test_a_folder_of_videos_is_told_where_it_belongs(tmp_path):
    (tmp_path / "a.mp4").write_bytes(b"a video")
    with pytest.raises(FrameSourceError, match=r"no images in it: .* a folder of them is for `lobula batch`"):
        lobula.frames.open(tmp_path)


def test_nothing_there(tmp_path):
    with pytest.raises(FrameSourceError, match=r"no images in it: must hold \.png.*\.webp files$"):
        lobula.frames.open(tmp_path)
    with pytest.raises(FrameSourceError, match="no file matches"):
        lobula.frames.open(tmp_path / "*.png")
    (tmp_path / "a.png").write_text("no image")
    with pytest.raises(FrameSourceError, match="none of its 1 files is an image"):
        lobula.frames.open(tmp_path)


def test_damaged_images(tmp_path):
    fill(tmp_path, ["0.png", "1.png", "2.png", "3.png"])
    (tmp_path / "0.png").write_text("damaged")
    (tmp_path / "2.png").write_bytes(b"")
    got, frames = read(tmp_path, rate_hz=10)
    assert [f.index for f in got] == [1, 3]
    np.testing.assert_allclose([f.time_s for f in got], [0.1, 0.3])
    assert frames.damaged == 2
    assert frames.notes == [f"{tmp_path / name}: damaged or not an image: left out" for name in ("0.png", "2.png")]
    (tmp_path / "3.png").write_text("damaged")
    with pytest.raises(FrameSourceError, match=r"3\.png: damaged") as caught:
        read(tmp_path)
    assert caught.value.on_the_way


def test_another_size_on_the_way(tmp_path):
    fill(tmp_path, ["0.png"])
    (tmp_path / "1.png").write_bytes(image_bytes(np.zeros((80, 80), np.uint8)))
    with pytest.raises(FrameSourceError, match="frame 1: picture is 80 x 80 px after 96 x 64: must stay the same"):
        read(tmp_path)


def test_one_image_is_a_source_of_one_frame(tmp_path):
    (tmp_path / "a.png").write_bytes(image_bytes(moving_bar(1)[0]))
    got, _ = read(tmp_path / "a.png")
    assert [(f.time_s, f.index) for f in got] == [(0.0, 0)]
