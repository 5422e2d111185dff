"""Images in memory, and in a file of arrays, go through unchanged."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import lobula.frames
from lobula.errors import FrameSourceError, ParameterError, ShapeError, TimeError

IMAGES = np.random.default_rng(0).integers(0, 256, (4, 72, 99), np.uint8)


@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_working_size_goes_through_unchanged(dtype):
    times_s = [0.5, 0.6, 0.8, 1.5]
    with lobula.frames.open(IMAGES.astype(dtype), times_s=times_s) as frames:
        got = list(frames)
        assert (frames.name, frames.frame_count, frames.live, frames.fps) == ("array", 4, False, 3.0)
    assert [f.time_s for f in got] == times_s
    assert got[0].image.dtype == dtype
    np.testing.assert_array_equal(np.stack([f.image for f in got]), IMAGES)


def test_float64_becomes_float32():
    with lobula.frames.open(IMAGES.astype(float)) as frames:
        assert next(frames).image.dtype == np.float32


def test_other_sizes_are_averaged_and_range_is_full():
    images = np.repeat(np.repeat(IMAGES, 2, axis=1), 2, axis=2)
    for given in (images, images.astype(np.float32)):
        with lobula.frames.open(given) as frames:
            np.testing.assert_allclose(next(frames).image, IMAGES[0], atol=1e-3)


def test_rate_and_default_rate():
    with lobula.frames.open(IMAGES, rate_hz=60) as frames:
        np.testing.assert_allclose([f.time_s for f in frames], np.arange(4) / 60)
    with lobula.frames.open(list(IMAGES)) as frames:
        np.testing.assert_allclose([f.time_s for f in frames], np.arange(4) / 30)


def test_a_movie_brings_its_times():
    movie = SimpleNamespace(images=IMAGES, times_s=np.array([0, 0.1, 0.2, 0.4]))
    with lobula.frames.open(movie) as frames:
        assert [f.time_s for f in frames] == [0, 0.1, 0.2, 0.4]


def test_a_picture_of_it():
    with lobula.frames.open(IMAGES.astype(np.float32)) as frames:
        next(frames)
        np.testing.assert_array_equal(frames.picture(), np.repeat(IMAGES[0][:, :, None], 3, axis=2))


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"times_s": [0, 1, 2]}, ShapeError, r"times_s of shape \(3,\): must be \(4,\)"),
        ({"times_s": [0, 1, 1, 2]}, TimeError, "array: frame 2: time stands still"),
        ({"times_s": [0, 1, float("nan"), 2]}, TimeError, "frame 2"),
        ({"times_s": [0, 1, 2, 3], "rate_hz": 3}, ParameterError, "only one of them"),
    ],
)
def test_refuses_times(arguments, error, message):
    with pytest.raises(error, match=message):
        lobula.frames.open(IMAGES, **arguments)


@pytest.mark.parametrize(
    ("images", "message"),
    [
        (IMAGES[0], "must be \\(T, H, W\\)"),
        (np.zeros((2, 72, 99, 3), np.uint8), "shape"),
        (IMAGES / 255, "look like 0..1"),
        (np.full((2, 72, 99), np.nan), "NaN"),
        (IMAGES.astype(int), "dtype int64"),
        (IMAGES[:, :10], "at least 32 x 24"),
    ],
)
def test_refuses_images(images, message):
    with pytest.raises(ShapeError, match=message):
        lobula.frames.open(images)


class TestFile:
    def test_what_numpy_saved(self, tmp_path):
        np.savez(tmp_path / "a.npz", images=IMAGES, times_s=[0.5, 0.75, 1.0, 2.0])
        with lobula.frames.open(tmp_path / "a.npz") as frames:
            assert (frames.name, frames.frame_count, frames.live) == (str(tmp_path / "a.npz"), 4, False)
            got = list(frames)
        assert [f.time_s for f in got] == [0.5, 0.75, 1.0, 2.0]
        np.testing.assert_array_equal(np.stack([f.image for f in got]), IMAGES)

    def test_a_rate_takes_the_place_of_its_times(self, tmp_path):
        np.savez_compressed(tmp_path / "a.npz", images=IMAGES, times_s=[0.5, 0.75, 1.0, 2.0])
        with lobula.frames.open(str(tmp_path / "a.npz"), rate_hz=60) as frames:
            np.testing.assert_allclose([f.time_s for f in frames], np.arange(4) / 60)

    def test_without_times(self, tmp_path):
        np.savez(tmp_path / "a.npz", images=IMAGES)
        with lobula.frames.open(tmp_path / "a.npz") as frames:
            np.testing.assert_allclose([f.time_s for f in frames], np.arange(4) / 30)

    @pytest.mark.parametrize(
        ("content", "error", "message"),
        [
            ({"a": np.zeros(3)}, FrameSourceError, r"a\.npz: holds no images: must be a file of numpy\.savez with"),
            ({"trace": np.zeros(3)}, FrameSourceError, r"; a trace is for lobula plot and serve$"),
            ({"images": np.array([None])}, FrameSourceError, r"a\.npz: not such a file: must be"),
            (
                {"images": IMAGES, "times_s": np.array(list("abcd"))},
                FrameSourceError,
                r"a\.npz: not such a file: must be",
            ),
            ({"images": IMAGES[0]}, ShapeError, r"a\.npz: .*must be \(T, H, W\)"),
            ({"images": IMAGES, "times_s": np.zeros(3)}, ShapeError, r"a\.npz: times_s of shape \(3,\)"),
            ({"images": IMAGES, "times_s": np.zeros(4)}, TimeError, r"a\.npz: frame 1: time stands still"),
        ],
    )
    def test_refuses_other_arrays(self, content, error, message, tmp_path):
        np.savez(tmp_path / "a.npz", **content)
        with pytest.raises(error, match=message):
            lobula.frames.open(tmp_path / "a.npz")

    @pytest.mark.parametrize("data", [b"", b"no archive", b"PK\x03\x04 cut off"])
    def test_refuses_other_files(self, data, tmp_path):
        (tmp_path / "a.npz").write_bytes(data)
        with pytest.raises(FrameSourceError, match=r"a\.npz: not such a file: must be"):
            lobula.frames.open(tmp_path / "a.npz")


@pytest.mark.parametrize(("rate_hz", "stride", "told"), [(30, 1, False), (8, 1, False), (30, 4, True), (5, 1, True)])
def test_too_few_pictures_a_second_are_told(rate_hz, stride, told):
    with lobula.frames.open(IMAGES, rate_hz=rate_hz, stride=stride) as frames:
        assert [note.startswith("array: ") and "too few to rely on" in note for note in frames.notes] == [True] * told
