"""What the network takes, on both engines: every dtype and stride; and what it refuses, without a trace."""

from __future__ import annotations

import numpy as np
import pytest

from lobula import Frame, Network
from lobula.errors import ParameterError, ShapeError, TimeError

from .films import growing, noise

SHAPE = (36, 52)
GREY = np.full(SHAPE, 120, np.uint8)
FILM = growing(*SHAPE, frames=12)
NOT_LUMINANCE = r"NaN or infinity|must lie in 0\.\.255"


def steps(net, images, times_s=FILM.times_s):
    return [net.step(image, time_s) for image, time_s in zip(images, times_s, strict=True)]


def potentials(readings):
    return [list(r[1:5]) for r in readings]


def run(net, images, times_s=FILM.times_s):
    """The potentials of a block, as ``potentials`` gives those of its readings."""
    trace = net.run(images, times_s)
    return np.array([trace[name] for name in ("lgmd1", "lgmd2", "lptc_r", "lptc_l")]).T.tolist()


def views():
    wide = noise(40, 100, seed=5, frames=6).images
    reals = wide.astype(np.float32)
    return {
        "crop": wide[:, 2:38, 7:71], "every-second": wide[:, ::1, 1::3], "upside-down": wide[:, ::-1],
        "mirrored": wide[:, :, ::-1], "transposed": wide.transpose(0, 2, 1), "fortran": np.asfortranarray(wide),
        "real-crop": reals[:, 5:37, 7:71], "real-mirrored": reals[:, :, ::-1], "backwards": wide[::-1],
        "the-same": np.broadcast_to(wide[0], wide.shape), "rows-apart": np.repeat(wide, 3, axis=1)[:, 1::3],
    }  # fmt: skip


class TestInput:
    def test_frames_bring_their_time(self, net):
        one = [net.step(Frame(image, t / 30, t)) for t, image in enumerate(FILM.images)]
        net.reset()
        assert one == steps(net, FILM.images)

    @pytest.mark.parametrize("dtype", [np.uint8, np.float16, np.float32, np.float64, ">f4"])
    def test_every_dtype_means_the_same(self, net, dtype):
        film = noise(*SHAPE, seed=4, frames=12)
        expected = steps(net, film.images)
        net.reset()
        assert steps(net, film.images.astype(dtype)) == expected
        net.reset()
        assert run(net, film.images.astype(dtype)) == potentials(expected)

    @pytest.mark.parametrize("name", views())
    def test_pixels_that_do_not_lie_side_by_side(self, net, name):
        images = views()[name]
        times_s = np.arange(len(images)) / 30
        tidy = steps(net, np.ascontiguousarray(images), times_s)
        for way in (lambda: potentials(steps(net, images, times_s)), lambda: run(net, images, times_s)):
            net.reset()
            assert way() == potentials(tidy)

    def test_views_and_dtypes_in_turn(self, net):
        expected = steps(net, FILM.images)
        given = []
        for t, image in enumerate(FILM.images):
            wide = np.zeros((3 * SHAPE[0], 2 * SHAPE[1] + 3), (np.uint8, np.float32)[t % 2])
            view = wide[1::3, 2:-1:2] if t % 3 else wide[: SHAPE[0], ::-1][:, : SHAPE[1]]
            view[...] = image
            given.append(view)
        net.reset()
        assert steps(net, given) == expected

    def test_pictures_are_not_written_to(self, net):
        images = FILM.images.astype(np.float32)
        before = images.copy()
        images.flags.writeable = False
        steps(net, images)
        net.reset()
        net.run(images, FILM.times_s)
        assert np.array_equal(images, before)

    @pytest.mark.parametrize(
        ("image", "says"),
        [
            (np.zeros((*SHAPE, 3), np.uint8), "colour"),
            (np.zeros((1, 1), np.uint8), "at least 32 x 24"),
            (np.zeros((0, 0), np.uint8), "at least"),
            (np.zeros(SHAPE, np.int32), "astype"),
            (np.full(SHAPE, np.nan, np.float32), "NaN"),
            (np.full(SHAPE, 300.0), "0..255"),
            (np.zeros((3, *SHAPE), np.uint8), "must be"),
            ("picture", "must be"),
        ],
        ids=lambda value: value if isinstance(value, str) else None,
    )
    def test_bad_images_are_refused_in_one_line(self, net, image, says):
        with pytest.raises(ShapeError, match=says) as caught:
            net.step(image, 0.0)
        assert "\n" not in str(caught.value)

    @pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, -0.5, 255.5])
    def test_one_bad_pixel_is_found_wherever_it_is(self, net, bad):
        image = GREY.astype(np.float32)
        net.step(image, 0.0)
        for place in ((0, 0), (-1, -1), (20, 33)):
            image[...] = GREY
            image[place] = bad
            for started in (net, Network(engine=net.engine)):
                with pytest.raises(ShapeError, match=NOT_LUMINANCE):
                    started.step(image, 0.1)
                with pytest.raises(ShapeError, match=NOT_LUMINANCE):
                    started.run(image[None], [0.1])
        image[place] = -0.0  # black, all the same
        net.step(image, 0.1)

    def test_a_picture_in_0_to_1_is_refused_until_daylight_was_seen(self, net):
        image = np.linspace(0, 1, SHAPE[0] * SHAPE[1], dtype=np.float32).reshape(SHAPE)
        with pytest.raises(ShapeError, match=r"look like 0\.\.1: must be 0\.\.255; use image \* 255"):
            net.step(image, 0.0)
        with pytest.raises(ShapeError, match=r"look like 0\.\.1: must be 0\.\.255"):
            net.run(image[None], [0.0])
        net.step(255 * image, 0.0)
        net.step(image, 0.1)  # dark after daylight is dark

    def test_what_was_refused_leaves_no_trace(self, net):
        expected = steps(net, FILM.images)
        net.reset()
        readings = []
        for t, image in enumerate(FILM.images):
            for bad in (np.full(SHAPE, np.nan, np.float32), np.zeros((72, 99), np.uint8), np.zeros(SHAPE, np.int64)):
                with pytest.raises(ShapeError):
                    net.step(bad if t else np.zeros((3, 3)), 99.0)
            readings.append(net.step(image, t / 30))
            with pytest.raises(TimeError):
                net.step(image, t / 30)
        assert readings == expected

    def test_another_size_is_refused_by_name(self, net):
        net.step(GREY, 0.0)
        with pytest.raises(ShapeError, match=r"32 x 24 px after 52 x 36 .*; reset\(\) starts anew"):
            net.step(np.zeros((24, 32), np.uint8), 0.1)
        with pytest.raises(ShapeError, match=r"32 x 24 px after 52 x 36 .*; reset\(\) starts anew"):
            net.run(np.zeros((2, 24, 32), np.uint8), [0.1, 0.2])
        net.step(GREY, 0.1)

    @pytest.mark.parametrize("time_s", [0.5, 0.4, float("nan"), float("inf"), None])
    def test_times_that_do_not_increase(self, net, time_s):
        net.step(GREY, 0.5)
        with pytest.raises(TimeError):
            net.step(GREY, time_s)

    def test_blocks_are_checked_before_anything_is_taken_in(self, net):
        images, times_s = FILM.images, FILM.times_s
        expected = net.run(images, times_s)
        net.reset()
        for wrong in (times_s[::-1], np.zeros(12), np.full(12, np.nan)):
            with pytest.raises(TimeError, match="frame"):
                net.run(images, wrong)
        with pytest.raises(ShapeError, match="times_s"):
            net.run(images, times_s[:-1])
        with pytest.raises(ShapeError, match="turning"):
            net.run(images, times_s, turning=[True])
        with pytest.raises(ShapeError):
            net.run(images[0], times_s)
        with pytest.raises(ShapeError, match=r"0\.\.1"):
            net.run(images / 255, times_s)
        with pytest.raises(ParameterError, match="threads"):
            net.run(images, times_s, threads=0)
        assert net.run(images, times_s).tolist() == expected.tolist()
        with pytest.raises(TimeError, match="frame 0"):
            net.run(images, times_s)

    @pytest.mark.parametrize("taps", [("motion", "soul"), "motion"])
    def test_unknown_maps(self, net, taps):
        with pytest.raises(ParameterError, match="tap"):
            net.step(GREY, 0.0, taps=taps)
