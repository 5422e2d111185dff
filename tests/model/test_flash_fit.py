"""A change of light, told from a thing that comes near: what the fit finds in two pictures."""

import math

import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.model.retina import FlashParams, change_statistics, find_flash, frame_difference
from lobula.stimuli import looming

from .pictures import noise

P = FlashParams()


def find(image, previous, p=P):
    previous = previous.astype(np.float32)
    return find_flash(image, previous, change_statistics(image, previous), p)


@pytest.mark.parametrize(
    ("gain", "offset"),
    [(1.0, 40.0), (1.0, -30.0), (1.5, 0.0), (0.5, 0.0), (0.25, 20.0), (2.0, -25.0), (1.2, 10.0), (0.7, 90.0)],
)
def test_golden_gain_and_offset_come_back(gain, offset):
    previous = noise(0, (24, 32), 40, 110)
    light = find(previous * np.float32(gain) + np.float32(offset), previous)
    assert light == pytest.approx((gain, offset), abs=1e-3)
    image = previous * np.float32(gain) + np.float32(offset)
    assert np.abs(frame_difference(image, previous, 1.0, light)).max() < 1e-3


def test_golden_what_moves_in_front_is_left_out():
    # 40 grey more light, and a sixteenth of the picture goes dark by 140: the mean change is 37.5 + 8.75 = 46.25, and
    # 140 is more than three times that
    previous = noise(0, (24, 32), 150, 200)
    image = previous + np.float32(40)
    image[:, :2] = previous[:, :2] - np.float32(140)
    light = find(image, previous)
    assert light == pytest.approx((1.0, 40.0), abs=1e-3)
    change = frame_difference(image, previous, 1.0, light)
    assert change[:, :2] == pytest.approx(-180, abs=0.01)  # the thing itself stays in the change
    assert change[:, 2:] == pytest.approx(0, abs=0.01)


def test_golden_blank_picture_is_taken_for_an_offset():
    previous = np.full((24, 32), 100, np.float32)
    assert find(previous * np.float32(1.3), previous) == pytest.approx((1.0, 30.0), abs=1e-4)


def test_rounding_and_noise_do_not_hide_a_flash():
    rng = np.random.default_rng(0)
    previous = np.rint(noise(0, (72, 99), 60, 120))
    image = np.rint(1.3 * previous + 12 + rng.normal(0, 2, previous.shape)).astype(np.uint8)
    assert find(image, previous) == pytest.approx((1.3, 12), abs=0.6)


def test_golden_thing_that_jumps_near_is_no_flash():
    """A tenth of the picture at 45 before a wall of 175; then seven tenths, and a grey less on all else.

    Where 45 was is 44 now; where 175 was are two parts of 45 and one of 174, on average 88. So the gain is 44 / 130,
    which explains two thirds of the squared change, but of the new picture's variance only 5 %.
    """
    previous = np.full((20, 40), 175, np.float32)
    previous[:2] = 45
    image = previous.copy()
    image[:14] = 45
    image[[0, 1, 14, 15, 16, 17, 18, 19]] -= 1
    about = change_statistics(image, previous)
    assert about.darker == 1
    assert find(image, previous) is None
    assert find(image, previous, FlashParams(min_explained=0.0)) == pytest.approx((44 / 130, 28.77), abs=0.01)


@pytest.mark.parametrize("offset", [-60.0, -12.0, 12.0, 60.0])
def test_light_on_a_blank_noisy_wall_is_a_flash(offset):
    previous, image = (np.rint(np.random.default_rng(k).normal(120, 1.5, (72, 99))) for k in range(2))
    assert find(image + np.float32(offset), previous) == pytest.approx((1.0, offset), abs=0.2)


def test_small_or_partial_changes_are_no_flash():
    previous = noise(0, (24, 32), 50, 150)
    assert find(previous + np.float32(0.99), previous) is None
    assert find(previous + np.float32(1.01), previous) is not None
    for rows, found in ((19, False), (20, True)):  # 19 / 24 = 0.79 of the picture, 20 / 24 = 0.83
        image = previous.copy()
        image[:rows] += 30
        assert (find(image, previous) is not None) == found


def test_half_up_half_down_is_no_flash():
    previous = noise(0, (24, 32), 50, 150)
    image = previous + np.where(np.arange(32) < 16, 30, -30).astype(np.float32)
    assert find(image, previous) is None


def test_another_picture_is_no_flash():
    assert find(noise(1, (24, 32), 130, 255), noise(0, (24, 32), 0, 120)) is None


@pytest.mark.parametrize("gain", [0.19, 5.1])
def test_gains_no_lamp_has(gain):
    previous = noise(0, (24, 32), 10, 45)
    assert find(previous * np.float32(gain), previous) is None


def test_still_picture_is_no_flash():
    previous = noise(0, (24, 32))
    assert find(previous, previous) is None


def test_switched_off():
    previous = noise(0, (24, 32), 50, 150)
    assert find(previous + np.float32(40), previous, FlashParams(enabled=False)) is None


def pairs(movie):
    """Pictures of an approach as slower cameras, or faster objects, would show them: up to a jump from afar to near."""
    for k in range(len(movie)):
        for later in range(k + 1, len(movie)):
            if (later - k) in (1, 2, 3, 5, 8, 13, 21):
                yield movie.images[later], movie.images[k]


@pytest.mark.parametrize("greys", [(45.0, 175.0), (175.0, 45.0), (0.0, 255.0), (255.0, 0.0)])
@pytest.mark.parametrize("background", ["plain", "stripes", "blobs"])
def test_approach_that_fills_the_view_is_no_flash(greys, background):
    movie = looming(object_grey=greys[0], background_grey=greys[1], background=background,
                    background_contrast_grey=30.0, background_deg=5.0, start_cm=20.0, stop_cm=0.5, speed_cm_s=20.0,
                    noise_sigma=1.5, lead_s=0.0, hold_s=0.0, shape="disc", height_cm=4.0)  # fmt: skip
    assert (np.abs(movie.images[-1] - greys[0]) < 20).all()  # nothing else is seen at the end
    assert len(list(pairs(movie))) > 50
    assert not any(find(image, previous) for image, previous in pairs(movie))


@pytest.mark.parametrize("object_cm", [1.0, 3.0, 12.0])
@pytest.mark.parametrize("stripes", [0.0, 40.0])
@pytest.mark.parametrize("size", [(32, 24), (99, 72)])
def test_size_texture_and_picture_size_do_not_matter(object_cm, stripes, size):
    movie = looming(object_cm=object_cm, height_cm=0.8 * object_cm, object_contrast_grey=stripes, start_cm=20.0,
                    stop_cm=0.2, speed_cm_s=15.0, lead_s=0.0, hold_s=0.0, width=size[0], height=size[1])  # fmt: skip
    assert not any(find(image, previous) for image, previous in pairs(movie))


def test_inputs_are_not_modified():
    previous = noise(0, (24, 32), 50, 150)
    image = previous + np.float32(40)
    copies = previous.copy(), image.copy()
    find(image, previous)
    assert np.array_equal(previous, copies[0])
    assert np.array_equal(image, copies[1])


@pytest.mark.parametrize(
    ("name", "bad"),
    [("enabled", None), ("min_change_grey", 0.0), ("min_coverage", 0.4), ("trim", 0.5), ("min_explained", math.nan),
     ("min_gain", 0.0), ("max_gain", 0.9)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"FlashParams\.{name} = "):
        FlashParams(**{name: bad})
