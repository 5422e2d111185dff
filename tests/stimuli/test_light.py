"""Backgrounds, lamps, flashes, held pictures and gratings against what their formulas say."""

import math

import numpy as np
import pytest

from lobula import stimuli
from lobula.errors import ParameterError


def means(movie):
    return movie.images.astype(np.float64).mean(axis=(1, 2))


def test_still_is_still():
    movie = stimuli.still(scene="arena", noise_sigma=0.0)
    assert len(movie) == 91  # 0 to 3 s, both ends, at 30 Hz
    assert (movie.images == movie.images[0]).all()


@pytest.mark.parametrize("background", ["stripes", "blobs"])
def test_patterns_keep_their_mean_and_range(background):
    image = stimuli.still(background=background, background_contrast_grey=20.0, quantised=False).images[0]
    assert image.min() >= 155
    assert image.max() <= 195
    assert image.mean() == pytest.approx(175, abs=5)
    assert image.std() > 3
    assert np.ptp(image, axis=0).max() < 1e-3 if background == "stripes" else np.ptp(image, axis=0).max() > 5


def test_stripes_are_the_same_at_twice_the_size():
    small, large = (
        stimuli.still(background="stripes", width=99 * k, height=72 * k, quantised=False).images[0] for k in (1, 2)
    )
    assert small == pytest.approx(large.reshape(72, 2, 99, 2).mean(axis=(1, 3)), abs=1e-3)


def test_floor_begins_at_the_horizon():
    odd = stimuli.still(floor=True, height=25, width=33, quantised=False).images[0]
    assert (odd[:12] == 175).all()
    assert (odd[13:] == 95).all()
    assert odd[12] == pytest.approx((175 + 95) / 2)  # the horizon cuts the middle row in half


def test_flicker_follows_the_sinusoid():
    movie = stimuli.flicker(hz=2.5, amplitude=0.2, start_s=1.0, background_grey=100.0, quantised=False)
    t = movie.times_s
    expected = 100 * (1 + 0.2 * np.sin(2 * math.pi * 2.5 * (t - 1.0)) * (t >= 1.0))
    assert means(movie) == pytest.approx(expected, abs=1e-4)


def test_fast_lamps_alias():
    """At 30 Hz a 50 Hz lamp looks like one of 10 Hz run backwards, and a 60 Hz lamp is steady."""
    at_50, at_10, at_60 = (
        means(stimuli.flicker(hz=hz, phase_deg=p, quantised=False))
        for hz, p in ((50.0, 0.0), (10.0, 180.0), (60.0, 90.0))
    )
    assert at_50 == pytest.approx(at_10, abs=1e-3)
    assert np.ptp(at_60) < 1e-3


def test_flash_step_pulse_and_decay():
    plain = {"background_grey": 100.0, "at_s": 1.0, "duration_s": 2.0, "quantised": False}
    step = means(stimuli.flash(offset_grey=50.0, **plain))
    assert step[:30] == pytest.approx(100)
    assert step[30:] == pytest.approx(150)
    dark = means(stimuli.flash(offset_grey=0.0, gain=0.4, lasts_s=0.2, **plain))
    assert dark[30:36] == pytest.approx(40)
    assert dark[36:] == pytest.approx(100)
    fading = means(stimuli.flash(offset_grey=50.0, decay_s=0.5, **plain))
    assert fading[45] == pytest.approx(100 + 50 * math.exp(-1), abs=1e-3)


def test_flash_on_another_movie_clips_like_a_camera():
    movie = stimuli.looming(background_grey=200.0)
    lit = stimuli.with_flash(movie, at_s=2.0, gain=1.5)
    assert np.array_equal(lit.images[:60], movie.images[:60])
    assert lit.images[60, 0, 0] == 255
    assert lit.images[60, 36, 49] == 68  # 45 * 1.5 = 67.5, rounded to the even neighbour
    assert lit.contact_s == movie.contact_s
    assert lit.kind == "looming"
    assert lit.settings["flash_gain"] == 1.5


def test_flicker_on_another_movie():
    movie = stimuli.still(background_grey=100.0, rate_hz=40.0, quantised=False)
    lit = stimuli.with_flicker(movie, hz=10.0, amplitude=0.5)
    assert means(lit)[:4] == pytest.approx([100, 150, 100, 50], abs=1e-3)


def test_held_pictures():
    movie = stimuli.looming()
    held = stimuli.with_repeats(movie, every=3)
    for k in range(len(movie)):
        assert np.array_equal(held.images[k], movie.images[k - k % 3])
    assert np.array_equal(held.times_s, movie.times_s)


def test_noise_through_a_flickering_scene_is_the_sensor_s():
    """The lamp does not scale the sensor's noise: it is added after it."""
    movie = stimuli.flicker(
        hz=0.0, amplitude=1.0, phase_deg=90.0, background_grey=50.0, noise_sigma=3.0, duration_s=1.0, quantised=False
    )
    assert movie.images.mean() == pytest.approx(100, abs=0.1)
    assert movie.images.std() == pytest.approx(3.0, rel=0.03)


@pytest.mark.parametrize(
    "make",
    [
        lambda: stimuli.flicker(amplitude=1.5),
        lambda: stimuli.flash(gain=-1.0),
        lambda: stimuli.flash(offset_grey=300.0),
        lambda: stimuli.with_repeats(stimuli.still(), every=0),
        lambda: stimuli.noise(noise_sigma=1.0),
        lambda: stimuli.grating(contrast=2.0),
        lambda: stimuli.grating(direction="east"),
        lambda: stimuli.grating(period_px=8.0, period_deg=8.0),
        lambda: stimuli.grating(wave="saw"),
        lambda: stimuli.translating(direction="up"),
        lambda: stimuli.still(duration_s=-1.0),
    ],
)
def test_bad_numbers_are_refused(make):
    with pytest.raises(ParameterError):
        make()


@pytest.mark.parametrize("wave", ["sine", "square"])
def test_grating_moves_a_whole_period_in_one_cycle(wave):
    movie = stimuli.grating(period_px=12.0, temporal_hz=3.0, wave=wave, lead_s=0.0, quantised=False)
    assert movie.images[0] == pytest.approx(movie.images[10], abs=1e-2)  # 10 pictures are a third of a second
    assert movie.images[0][:, :-12] == pytest.approx(movie.images[0][:, 12:], abs=1e-2)
    assert movie.images[:, :, :96].mean(axis=(1, 2)) == pytest.approx(175, abs=1e-2)


@pytest.mark.parametrize(
    ("direction", "axis", "sign"), [("right", 1, 1), ("left", 1, -1), ("down", 0, 1), ("up", 0, -1)]
)
def test_grating_drifts_the_way_it_says(direction, axis, sign):
    """Three columns of twelve each picture: the second picture is the first one, rolled by three."""
    movie = stimuli.grating(
        direction=direction, period_px=12.0, temporal_hz=7.5, lead_s=0.0, width=48, height=36, quantised=False
    )
    assert movie.images[1] == pytest.approx(np.roll(movie.images[0], sign * 3, axis=axis), abs=1e-2)


def test_grating_pixel_holds_the_mean_of_its_area():
    """Square wave of period 4: two columns of 175 * 1.3 and two of 175 * 0.7; half a column later they mix."""
    movie = stimuli.grating(period_px=4.0, temporal_hz=3.75, contrast=0.3, wave="square", lead_s=0.0, quantised=False)
    assert movie.images[0, 0, :4] == pytest.approx([227.5, 227.5, 122.5, 122.5], abs=1e-3)
    assert movie.images[1, 0, :4] == pytest.approx([175.0, 227.5, 175.0, 122.5], abs=1e-3)


def test_grating_too_fine_for_the_pixels_is_grey():
    movie = stimuli.grating(period_px=1.0, quantised=False)
    assert movie.images == pytest.approx(175, abs=1e-2)
