"""Files: every frame, its own stamp, full-range luma; one movie through many codecs and containers."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError
from lobula.frames import FrameSequence
from lobula.frames.resize import AreaAverage

from .clips import HEIGHT, WIDTH, as_frame, moving_bar, turn_clockwise, write_clip, write_lossless, write_sizes

PICTURES = moving_bar(24)
AS_IT_IS = {"size": (WIDTH, HEIGHT)}  # the working image is the picture


def expanded(pictures):
    """Limited-range luma (16..235) as full range."""
    return (np.stack(pictures).astype(float) - 16) * 255 / 219


def read(path, **options):
    with lobula.frames.open(path, **options) as frames:
        return list(frames)


def images(frames):
    return np.stack([frame.image for frame in frames])


@pytest.mark.parametrize(
    ("name", "codec", "pixel_format", "options", "tolerance"),
    [
        ("a.mp4", "libx264", "yuv420p", {"qp": "0", "bf": "2"}, 0.01),  # lossless
        ("a.mkv", "ffv1", "yuv420p", {}, 0.01),
        ("a.avi", "libx264", "yuv420p", {"qp": "0", "bf": "2"}, 0.01),  # AVI holds no presentation stamps
        ("a.ts", "libx264", "yuv420p", {"qp": "0"}, 0.01),
        ("b.mkv", "libx264", "yuv420p10le", {"qp": "0"}, 0.01),
        ("a.mov", "mpeg4", "yuv420p", {"qscale": "1", "bf": "2"}, 25.0),
        ("b.avi", "mpeg4", "yuv420p", {"qscale": "1"}, 25.0),
    ],
)
def test_limited_range_codecs(tmp_path, name, codec, pixel_format, options, tolerance):
    path = write_clip(tmp_path / name, PICTURES, codec=codec, pixel_format=pixel_format, options=options)
    frames = read(path, **AS_IT_IS)
    assert [frame.index for frame in frames] == list(range(24))
    np.testing.assert_allclose([frame.time_s for frame in frames], np.arange(24) / 30, atol=6e-4)  # mkv: whole ms
    assert images(frames).dtype == np.float32
    np.testing.assert_allclose(images(frames), expanded(PICTURES), atol=tolerance)


@pytest.mark.parametrize(
    ("name", "codec", "pixel_format", "color_range", "tolerance"),
    [
        ("a.avi", "mjpeg", "yuvj420p", 2, 20.0),
        ("a.mkv", "ffv1", "gray", 0, 0.0),
        ("b.mkv", "ffv1", "yuv420p", 2, 0.0),
        ("c.mkv", "ffv1", "gray16le", 0, 0.0),
        ("d.mov", "png", "rgb24", 0, 0.0),
    ],
)
def test_full_range_codecs(tmp_path, name, codec, pixel_format, color_range, tolerance):
    path = write_clip(tmp_path / name, PICTURES, codec=codec, pixel_format=pixel_format, color_range=color_range)
    frames = read(path, **AS_IT_IS)
    assert images(frames).dtype == np.uint8  # nothing had to be computed
    np.testing.assert_allclose(images(frames), np.stack(PICTURES), atol=tolerance)


def test_same_picture_from_limited_and_full_range(tmp_path):
    full = [np.clip(np.rint((p - 16.0) * 255 / 219), 0, 255).astype(np.uint8) for p in PICTURES]
    limited = read(write_lossless(tmp_path / "limited.mkv", PICTURES, "yuv420p"))
    grey = read(write_lossless(tmp_path / "grey.mkv", full, "gray"))
    np.testing.assert_allclose(images(limited), images(grey), atol=0.51)  # eight bits


def test_what_is_told(tmp_path):
    path = write_clip(tmp_path / "a.mp4", PICTURES)
    with lobula.frames.open(path) as frames:
        assert isinstance(frames, FrameSequence)
        assert (frames.name, frames.width, frames.height) == (str(path), 99, 72)
        assert (frames.source_width, frames.source_height) == (WIDTH, HEIGHT)
        assert (frames.fps, frames.frame_count, frames.live) == (30.0, 24, False)
        assert (frames.dropped, frames.damaged, frames.notes) == (0, 0, [])
        first = next(frames)
        assert first.image.shape == (72, 99)


def test_variable_frame_rate_keeps_its_stamps(tmp_path):
    stamps = [0, 40, 50, 130, 131, 200, 500, 1000]
    write = {"stamps": stamps, "time_base": Fraction(1, 1000)}
    for name in ("a.mp4", "a.mkv"):
        frames = read(write_clip(tmp_path / name, PICTURES[:8], **write))
        np.testing.assert_allclose([frame.time_s for frame in frames], np.array(stamps) / 1000, atol=1e-4)


def test_time_counts_from_the_first_picture(tmp_path):
    path = write_clip(tmp_path / "a.mkv", PICTURES[:4], stamps=[90, 91, 92, 95])
    np.testing.assert_allclose([f.time_s for f in read(path)], [0, 1 / 30, 2 / 30, 5 / 30], atol=1e-3)


@pytest.mark.parametrize("name", ["a.mp4", "a.mkv", "a.avi", "a.ts"])
@pytest.mark.parametrize("options", [{"g": "6", "bf": "2"}, {"g": "6", "x264-params": "open-gop=1"}, {"g": "1000"}])
def test_starting_late_is_the_tail_of_the_whole(tmp_path, name, options):
    path = write_clip(tmp_path / name, moving_bar(40), options=options | {"crf": "20"})
    whole = read(path)
    for start_s in (0.01, 0.5, 0.61, 1.0, 1.29):
        tail = [frame for frame in whole if frame.time_s >= start_s]
        got = read(path, start_s=start_s)
        assert [(f.index, f.time_s) for f in got] == [(f.index, f.time_s) for f in tail]
        np.testing.assert_array_equal(images(got), images(tail))


def test_what_lies_before_the_start_is_not_decoded(tmp_path):
    path = write_clip(tmp_path / "a.mp4", moving_bar(60), options={"g": "10", "bf": "0"})
    with lobula.frames.open(path, start_s=1.7) as frames:
        reader = frames._reader
        decoded = []
        decode, reader._decode = reader._decode, lambda packet: (decoded.append(packet), decode(packet))
        assert next(frames).index == 51
    assert len(decoded) <= 10  # from the key frame 50 on, and what the decoder holds back


def test_telephone_video_is_turned_upright(tmp_path):
    picture = np.full((HEIGHT, WIDTH), 40, np.uint8)
    picture[:16, :24] = 220  # top left, which comes to be top right
    path = turn_clockwise(write_clip(tmp_path / "a.mp4", [picture] * 3, options={"qp": "0"}))
    with lobula.frames.open(path, size=(HEIGHT, WIDTH)) as frames:
        assert (frames.source_width, frames.source_height) == (HEIGHT, WIDTH)
        image = next(frames).image
        shown = frames.picture()
    np.testing.assert_allclose(image, expanded([np.rot90(picture, -1)])[0], atol=0.01)
    assert shown.shape == (WIDTH, HEIGHT, 3)
    assert shown[4, -4].mean() > 200 > 60 > shown[4, 4].mean()


def test_geometry_is_that_of_the_whole_picture(tmp_path):
    rng = np.random.default_rng(0)
    picture = rng.integers(0, 256, (120, 160), np.uint8)
    path = write_lossless(tmp_path / "a.mkv", [picture])
    wanted = {"rotate": 90, "flip": "h", "roi": (10, 20, 64, 48), "size": (32, 24)}
    with lobula.frames.open(path, **wanted) as frames:
        image = next(frames).image
        upright = frames.picture()[:, :, 0]
    np.testing.assert_array_equal(upright, np.rot90(picture, -1)[:, ::-1])
    blocks = upright[20:68, 10:74].reshape(24, 2, 32, 2).mean(axis=(1, 3))
    np.testing.assert_allclose(image, blocks, atol=1e-3)


def test_padding_is_grey_and_still(tmp_path):
    path = write_lossless(tmp_path / "a.mkv", moving_bar(3, 128, 64))
    for frame in read(path, size=(64, 64), fit="pad"):
        np.testing.assert_array_equal(frame.image[:16], 128)
        np.testing.assert_array_equal(frame.image[48:], 128)
        assert not (frame.image[16:48] == 128).any()


@pytest.mark.parametrize(("width", "height"), [(97, 71), (33, 25)])
def test_odd_sizes(tmp_path, width, height):
    pictures = moving_bar(3, width, height)
    frames = read(write_lossless(tmp_path / "a.mkv", pictures, "yuv420p"), size=(width, height))
    np.testing.assert_allclose(images(frames), expanded(pictures), atol=0.01)


def test_picture_is_the_original_in_colour(tmp_path):
    path = write_clip(tmp_path / "a.mov", PICTURES[:3], codec="png", pixel_format="rgb24")
    with lobula.frames.open(path, size=(32, 24)) as frames:
        for (frame, rgb), y in zip(frames.with_pictures(), PICTURES, strict=False):
            assert frame.image.shape == (24, 32)
            assert rgb.dtype == np.uint8
            np.testing.assert_array_equal(rgb, np.repeat(y[:, :, None], 3, axis=2))


def test_frames_keep_their_own_memory(tmp_path):
    path = write_lossless(tmp_path / "a.mkv", PICTURES)
    kept = read(path, **AS_IT_IS)
    np.testing.assert_array_equal(images(kept), np.stack(PICTURES))


def test_closed_source_gives_no_frames_but_its_last_picture(tmp_path):
    with lobula.frames.open(write_clip(tmp_path / "a.mp4", PICTURES)) as frames:
        next(frames)
    frames.close()
    with pytest.raises(FrameSourceError, match=r"a\.mp4: is closed: frames must be read before that"):
        next(frames)
    assert frames.picture().shape == (HEIGHT, WIDTH, 3)


def test_threads_change_nothing(tmp_path):
    path = write_clip(tmp_path / "a.mp4", PICTURES, options={"bf": "2"})
    one, two = read(path), read(path, threads=2)
    assert [f.time_s for f in one] == [f.time_s for f in two]
    np.testing.assert_array_equal(images(one), images(two))


def test_bare_stream_takes_its_rate(tmp_path):
    path = write_clip(tmp_path / "a.h264", PICTURES)
    np.testing.assert_allclose([f.time_s for f in read(path, rate_hz=50)], np.arange(24) / 50)


def test_rate_is_refused_where_there_are_stamps(tmp_path):
    path = write_clip(tmp_path / "a.mp4", PICTURES[:2])
    with pytest.raises(ParameterError, match=r"rate_hz = 30: must not be given for .*a\.mp4, which has"):
        lobula.frames.open(path, rate_hz=30)


def test_a_given_resizer_is_used(tmp_path):
    path = write_lossless(tmp_path / "a.mkv", PICTURES[:2], "yuv420p")
    made = []

    def resizer(*arguments):
        made.append(arguments)
        return AreaAverage(*arguments)

    np.testing.assert_array_equal(images(read(path, resizer=resizer)), images(read(path)))
    (height, width, crop, out_height, out_width, gain, offset) = made[0]
    assert (height, width, tuple(crop), out_height, out_width) == (HEIGHT, WIDTH, (4, 0, 88, 64), 72, 99)
    assert gain * 16 + offset == pytest.approx(0)
    assert gain * 235 + offset == pytest.approx(255)


def test_pixel_format_may_change_but_not_the_size(tmp_path):
    with lobula.frames.open(np.stack(PICTURES), **AS_IT_IS) as frames:
        sampler = frames._sampler
        sampler.adapt(as_frame(PICTURES[0], "yuv420p"), "array: frame 1")
        np.testing.assert_allclose(sampler(as_frame(PICTURES[0], "yuv420p")), expanded(PICTURES[:1])[0], atol=0.01)
    path = write_sizes(tmp_path / "a.avi", PICTURES[:3], PICTURES[3:6])
    assert len(read(path)) == 6  # the packets of six encoders, all of one size


def test_importing_frames_does_not_import_a_decoder():
    code = "import sys, lobula.frames; sys.exit('av' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_file_that_may_not_be_read(tmp_path, monkeypatch):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"a video")
    monkeypatch.setattr("lobula.frames.video.os.access", lambda name, mode: False)
    with pytest.raises(FrameSourceError, match=r"a\.mp4: no permission to read it$"):
        lobula.frames.open(path)
