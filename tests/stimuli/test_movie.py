"""The value itself: its frames, the mirror, and that nothing in it depends on chance or on the frame rate."""

import json
import pickle

import numpy as np
import pytest

from lobula import stimuli
from lobula.errors import ParameterError

MAKERS = sorted(stimuli.CATALOGUE)
MOVING = ["looming", "receding", "translating_right", "translating_left", "angular"]


@pytest.mark.parametrize("kind", MAKERS)
def test_every_kind_keeps_the_contract(kind):
    movie = stimuli.CATALOGUE[kind](scene="arena", width=40, height=30)
    assert movie.kind == kind
    assert movie.images.dtype == np.uint8
    assert movie.images.shape == (len(movie), 30, 40)
    assert movie.times_s.shape == (len(movie),)
    assert np.allclose(np.diff(movie.times_s), 1 / 30)
    frames = list(movie.frames())
    assert [f.index for f in frames] == list(range(len(movie)))
    assert frames[-1].time_s == movie.times_s[-1]
    assert np.array_equal(frames[3].image, movie.images[3])
    for name in stimuli.keywords(kind):
        assert name in movie.settings or name in ("scene", "sigma", "period_deg")


@pytest.mark.parametrize("kind", MAKERS)
def test_same_seed_same_movie(kind):
    settings = {"scene": "arena", "width": 40, "height": 30}
    first, again, other = (stimuli.CATALOGUE[kind](**settings, seed=s) for s in (3, 3, 4))
    assert np.array_equal(first.images, again.images)
    assert not np.array_equal(first.images, other.images)


@pytest.mark.parametrize("kind", [k for k in MAKERS if k != "noise"])
def test_rates_see_the_same_motion_at_common_times(kind):
    settings = {"scene": "arena", "noise_sigma": 0.0, "width": 40, "height": 30}
    slow, fast = (stimuli.CATALOGUE[kind](**settings, rate_hz=hz) for hz in (30, 120))
    assert np.allclose(fast.times_s[::4][: len(slow)], slow.times_s)
    difference = np.abs(fast.images[::4][: len(slow)].astype(int) - slow.images)
    assert difference.max() <= 1  # a rounding tie may fall either way
    assert slow.contact_s == fast.contact_s


@pytest.mark.parametrize("kind", MOVING)
def test_stillness_before_and_after(kind):
    movie = stimuli.CATALOGUE[kind](background="stripes", lead_s=0.4, hold_s=0.2, speed_cm_s=20.0)
    changes = np.abs(np.diff(movie.images.astype(int), axis=0)).sum(axis=(1, 2))
    at_rest = (movie.times_s[1:] <= 0.4 + 1e-9) | (movie.times_s[:-1] >= movie.times_s[-1] - 0.2 + 1 / 30)
    assert not changes[at_rest].any()
    assert changes[~at_rest].sum() > 0


def test_mirror_swaps_pictures_and_words():
    movie = stimuli.translating(direction="right", scene="arena")
    twin = stimuli.mirrored(movie)
    assert twin.kind == "translating_left"
    assert twin.settings["direction"] == "left"
    assert np.array_equal(twin.images, np.flip(movie.images, axis=2))
    back = stimuli.mirrored(twin)
    assert back.kind == movie.kind
    assert back.settings["mirrored"] is False
    assert np.array_equal(back.images, movie.images)


def test_mirror_of_rightward_is_leftward():
    right, left = (stimuli.translating(direction=d) for d in ("right", "left"))
    assert np.array_equal(stimuli.mirrored(right).images, left.images)
    from_left, from_right = (stimuli.angular(angle_deg=a) for a in (-30.0, 30.0))
    twin = stimuli.mirrored(from_left)
    assert twin.settings["angle_deg"] == 30.0
    assert np.abs(twin.images.astype(int) - from_right.images).max() <= 1


def test_unquantised_movie_rounds_to_the_camera_s():
    fine, coarse = (stimuli.looming(quantised=q, speed_cm_s=20.0) for q in (False, True))
    assert fine.images.dtype == np.float32
    assert np.abs(fine.images - coarse.images).max() <= 0.5 + 1e-4


def test_sensor_noise_has_the_stated_spread():
    movie = stimuli.noise(sigma=4.0, background_grey=128.0, duration_s=1.0, quantised=False)
    assert movie.images.std() == pytest.approx(4.0, rel=0.02)
    assert movie.images.mean() == pytest.approx(128.0, abs=0.05)
    pixel_to_pixel = np.corrcoef(movie.images[0].ravel(), movie.images[1].ravel())[0, 1]
    assert abs(pixel_to_pixel) < 0.05


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"width": 8}, "width"),
        ({"widht": 99}, "did you mean width"),
        ({"scene": "moon"}, "plain, arena"),
        ({"noise_sigma": float("nan")}, "noise_sigma"),
        ({"background": "tartan"}, "stripes"),
        ({"rate_hz": 0}, "rate_hz"),
        ({"speed_cm_s": 0.0}, "speed_cm_s"),
        ({"l_over_v_ms": 50.0, "speed_cm_s": 8.0}, "not both"),
        ({"stop_cm": 40.0}, "stop_cm"),
        ({"offset_cm": float("nan")}, "offset_cm"),
        ({"l_over_v_ms": -1.0}, "l_over_v_ms"),
        ({"shape": "star"}, "box, disc"),
        ({"speed_cm_s": 0.01, "start_cm": 9000.0}, "duration_s"),
    ],
)
def test_bad_settings_are_refused_in_one_line(settings, message):
    with pytest.raises(ParameterError, match=message) as caught:
        stimuli.looming(**settings)
    assert "\n" not in str(caught.value)


def test_unknown_movie_is_refused():
    with pytest.raises(ParameterError, match="looming"):
        stimuli.keywords("loming")


@pytest.mark.parametrize("kind", MAKERS)
def test_movie_travels_between_processes_and_its_settings_into_json(kind):
    movie = stimuli.CATALOGUE[kind](width=40, height=30)
    assert np.array_equal(pickle.loads(pickle.dumps(movie)).images, movie.images)
    assert json.loads(json.dumps(dict(movie.settings), allow_nan=False)) == dict(movie.settings)
