"""Geometry by hand: a pinhole with W / 2 columns to the edge of its half angle, and light as the mean over a pixel."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula import stimuli
from lobula.stimuli.moving_object import MovingObject, draw
from lobula.stimuli.view import wall

FOCAL_PX = 49.5 / math.tan(math.radians(35))  # 70.69 for 99 columns over 70 degrees
GREY, BEHIND = 45.0, 175.0


def area_px(images):
    """Covered area of a plain object on a plain wall, from the light that is missing."""
    return ((BEHIND - images.astype(np.float64)) / (BEHIND - GREY)).sum(axis=(-2, -1))


def middle_columns(images):
    """Mean column of the covered area, in pixels from the left border of the picture.

    The light of a part-covered pixel counts at its middle, so the mean is up to 1/8 px over the width off: 0.02 px.
    """
    covered = BEHIND - images.astype(np.float64)
    return (covered * (np.arange(images.shape[2]) + 0.5)).sum(axis=(1, 2)) / covered.sum(axis=(1, 2))


def test_width_and_height_in_pixels_at_each_distance():
    movie = stimuli.looming(object_cm=4.0, height_cm=3.0, speed_cm_s=8.0, quantised=False)
    covered = (BEHIND - movie.images.astype(np.float64)) / (BEHIND - GREY)
    for k in (0, 40, 80, 110):
        distance_cm = max(3.5, 30.0 - 8.0 * max(0.0, k / 30 - 0.5))
        assert covered[k, 36].sum() == pytest.approx(min(99.0, FOCAL_PX * 4.0 / distance_cm), abs=1e-3)
        assert covered[k, :, 49].sum() == pytest.approx(min(72.0, FOCAL_PX * 3.0 / distance_cm), abs=1e-3)


def test_contact_time_by_hand():
    assert stimuli.looming(speed_cm_s=8.0, start_cm=30.0).contact_s == pytest.approx(0.5 + 30 / 8)
    assert stimuli.looming(speed_cm_s=12.0, start_cm=24.0, lead_s=1.0).contact_s == pytest.approx(3.0)
    assert stimuli.receding().contact_s is None
    assert stimuli.translating().contact_s is None
    # 45 degrees, 30 cm away, to a point 3 cm ahead: the cosine rule gives the way
    way_cm = math.sqrt(30**2 + 3**2 - 2 * 30 * 3 * math.cos(math.radians(45)))
    assert stimuli.angular(angle_deg=45.0, speed_cm_s=6.0).contact_s == pytest.approx(0.5 + way_cm / 6)


def test_l_over_v_and_speed_say_the_same():
    by_ratio = stimuli.looming(l_over_v_ms=250.0, object_cm=4.0)  # 2 cm / 0.25 s
    assert by_ratio.settings["speed_cm_s"] == pytest.approx(8.0)
    assert np.array_equal(by_ratio.images, stimuli.looming(speed_cm_s=8.0).images)
    assert stimuli.looming(speed_cm_s=4.0, object_cm=6.0).settings["l_over_v_ms"] == pytest.approx(750.0)


def test_recession_is_the_approach_run_backwards():
    approach = stimuli.looming(lead_s=0.5, hold_s=0.5, start_cm=30.0, stop_cm=6.0, speed_cm_s=8.0)
    recession = stimuli.receding(lead_s=0.5, hold_s=0.5, start_cm=6.0, stop_cm=30.0, speed_cm_s=8.0)
    assert np.abs(recession.images.astype(int) - approach.images[::-1]).max() <= 1


def test_approach_grows_and_fills_the_view():
    movie = stimuli.looming(stop_cm=0.0, quantised=False)
    area = area_px(movie.images)
    assert (np.diff(area) >= -1e-2).all()
    assert area[-1] == pytest.approx(99 * 72)
    assert (movie.images[-1] == GREY).all()


@pytest.mark.parametrize(("direction", "sign"), [("right", 1), ("left", -1)])
def test_translation_moves_at_focal_length_times_speed_over_distance(direction, sign):
    movie = stimuli.translating(direction=direction, distance_cm=10.0, speed_cm_s=6.0, span_cm=4.0, quantised=False)
    assert movie.kind == f"translating_{direction}"
    moving = movie.images[16:50]
    steps = np.diff(middle_columns(moving))
    assert steps == pytest.approx(sign * FOCAL_PX * 6.0 / 10.0 / 30, abs=0.02)
    assert area_px(moving) == pytest.approx((FOCAL_PX / 10) ** 2 * 4.0 * 3.2, rel=1e-4)


@pytest.mark.parametrize("angle_deg", [-30.0, 30.0])
def test_angular_starts_at_its_bearing_and_ends_ahead(angle_deg):
    movie = stimuli.angular(angle_deg=angle_deg, quantised=False)
    middle = middle_columns(movie.images)
    assert middle[0] == pytest.approx(49.5 + FOCAL_PX * math.tan(math.radians(angle_deg)), abs=0.02)
    assert middle[-1] == pytest.approx(49.5, abs=1e-3)
    steps = np.diff(middle) * -np.sign(angle_deg)  # from the left (negative) it moves right
    assert steps.min() > -0.02
    assert steps.max() > 0.1


def test_frontal_angle_is_a_looming_that_stops_at_the_aim():
    ahead, straight = stimuli.angular(angle_deg=0.0, aim_cm=5.0), stimuli.looming(stop_cm=5.0)
    assert np.abs(ahead.images.astype(int) - straight.images).max() <= 1


def test_a_tenth_of_a_pixel_shows():
    thing = MovingObject()
    behind = wall(thing)
    shift_cm = 0.1 * 8.0 / FOCAL_PX
    change = draw(thing, behind, shift_cm, 8.0) - draw(thing, behind, 0.0, 8.0)
    rows = FOCAL_PX * 3.2 / 8.0
    assert np.abs(change[36]).max() == pytest.approx(13.0)  # a tenth of 130 grey levels
    assert change.sum() == pytest.approx(0.0, abs=1e-9)
    assert np.abs(change).sum() == pytest.approx(2 * 13.0 * rows)


@settings(max_examples=40, deadline=None)
@given(
    x_cm=st.floats(-6, 6),
    z_cm=st.floats(1, 60),
    shape=st.sampled_from(["box", "disc"]),
    object_cm=st.floats(0.5, 12),
    contrast=st.floats(0, 40),
)
def test_light_stays_between_object_and_wall(x_cm, z_cm, shape, object_cm, contrast):
    thing = MovingObject(shape=shape, object_cm=object_cm, object_contrast_grey=contrast, width=40, height=30)
    image = draw(thing, wall(thing), x_cm, z_cm)
    assert image.min() >= GREY - contrast - 1e-9
    assert image.max() <= BEHIND + 1e-9


@settings(max_examples=25, deadline=None)
@given(x_cm=st.floats(-2, 2), z_cm=st.floats(7, 40), width_cm=st.floats(1, 4), height_cm=st.floats(1, 4))
def test_area_of_box_and_disc(x_cm, z_cm, width_cm, height_cm):
    box_px = (FOCAL_PX / z_cm) ** 2 * width_cm * height_cm
    for shape, share in (("box", 1.0), ("disc", math.pi / 4)):
        thing = MovingObject(shape=shape, object_cm=width_cm, height_cm=height_cm)
        area = area_px(draw(thing, wall(thing), x_cm, z_cm))
        assert area == pytest.approx(share * box_px, rel=1e-9 if shape == "box" else 0.01)


def test_drawing_against_brute_force():
    """Every pixel split into 40 x 40 points, each either on the object or not."""
    for shape in ("box", "disc"):
        thing = MovingObject(shape=shape, width=32, height=24)
        focal = 16 / math.tan(math.radians(35))
        points_x = ((np.arange(32 * 40) + 0.5) / 40 - 16) / focal * 9.0
        points_y = ((np.arange(24 * 40) + 0.5) / 40 - 12) / focal * 9.0
        u, v = (points_x - 0.7) / 2.0, points_y[:, None] / 1.6
        inside = (np.abs(u) <= 1) & (np.abs(v) <= 1) if shape == "box" else u**2 + v**2 <= 1
        expected = BEHIND + (GREY - BEHIND) * inside.reshape(24, 40, 32, 40).mean(axis=(1, 3))
        assert draw(thing, wall(thing), 0.7, 9.0) == pytest.approx(expected, abs=130 * 0.03)


def test_texture_grows_with_the_object():
    """The mean light of each stripe is the same near and far; only its width changes."""
    thing = MovingObject(object_contrast_grey=40.0, object_stripes=4)
    row = {z: draw(thing, wall(thing), 0.0, z)[36] for z in (4.0, 8.0)}
    for stripe in range(4):
        inside = (stripe + 0.5) / 4 * 2 - 1
        near, far = (row[z][int(49.5 + inside * FOCAL_PX * 2 / z)] for z in (4.0, 8.0))
        assert near == pytest.approx(far)
    assert len({round(float(v), 6) for v in row[4.0]}) >= 4


def test_arena_object_stands_on_the_floor():
    """The box reaches from 2.2 cm below the lens to 1 cm above it, before wall and floor."""
    movie = stimuli.looming(
        scene="arena", noise_sigma=0.0, start_cm=20.0, background_contrast_grey=0.0, quantised=False
    )
    column = movie.images[0, :, 49]
    above_px, below_px = FOCAL_PX * 1.0 / 20, FOCAL_PX * 2.2 / 20
    assert (175.0 - column[:36]).sum() / 130 == pytest.approx(above_px, abs=1e-3)
    assert (95.0 - column[36:]).sum() / 50 == pytest.approx(below_px, abs=1e-3)
    assert movie.images[0, 0, 0] == 175
    assert movie.images[0, 71, 0] == 95
