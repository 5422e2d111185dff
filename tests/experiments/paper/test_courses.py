"""Courses and films: where the robot is, how large it looks and when it is looked at, all by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.arena.world import CameraParams, RoomParams, World
from lobula.errors import ParameterError
from lobula.experiments.paper import fig4, fig5, fig6
from lobula.experiments.paper.courses import FOUR, READINGS, CourseParams, angular, course
from lobula.experiments.paper.figure import Plan
from lobula.experiments.paper.stage import Stage

P = CourseParams()
EXACT = CourseParams(misplaced_cm=0.0)
QUIET = World(camera=CameraParams(noise_grey=0.0))
FOCAL_PX = 99 / 2 / math.tan(math.radians(35))  # 70.7


def place(drive, time_s, p=P):
    return drive.places(np.array([time_s]), p)[0]


@pytest.mark.parametrize(
    ("motion", "at_start", "after_1_s", "at_end"),
    [
        ("approach", (32, 0), (24, 0), (5.5, 0)),  # gaps of 30 and 3.5 cm, and a radius of 2
        ("recession", (5.5, 0), (13.5, 0), (32, 0)),
        ("translation_right", (8, -13.25), (8, -5.25), (8, 13.25)),
        ("translation_left", (8, 13.25), (8, 5.25), (8, -13.25)),
    ],
)
def test_where_it_is_at_8_cm_s(motion, at_start, after_1_s, at_end) -> None:
    drive = course(motion, 8.0, P, 2.0)
    assert place(drive, 0.0) == pytest.approx(at_start)  # still for half a second
    assert place(drive, 0.5) == pytest.approx(at_start)
    assert place(drive, 1.5) == pytest.approx(after_1_s)
    assert place(drive, 99.0) == pytest.approx(at_end)
    assert drive.travel_s == pytest.approx(26.5 / 8)


def test_radial_keeps_its_bearing_and_stops_at_the_gap() -> None:
    drive = angular(-60.0, 10.0, P, 2.0)
    for time_s in (0.0, 1.0, 99.0):
        ahead, right = place(drive, time_s)
        assert math.degrees(math.atan2(right, ahead)) == pytest.approx(-60)
    assert math.hypot(*drive.end) == pytest.approx(2.0 + 2.0)
    assert math.hypot(*drive.start) == pytest.approx(2.0 + 2.0 + 20.0)


def test_across_ends_on_the_axis_at_its_angle() -> None:
    drive = angular(30.0, 10.0, CourseParams(angular_line="across"), 2.0)
    assert drive.end == pytest.approx((4.0, 0.0))
    assert drive.start == pytest.approx((4 + 20 * math.cos(math.pi / 6), 10.0))


def test_both_lines_are_the_same_from_straight_ahead() -> None:
    across = angular(0.0, 8.0, CourseParams(angular_line="across"), 2.0)
    assert angular(0.0, 8.0, P, 2.0) == across


@pytest.mark.parametrize(
    ("motion", "window_s"),
    [("approach", (2.2125, 3.8125)), ("recession", (0.5, 2.1)), ("translation_right", (1.35625, 2.95625))],
)
def test_windows_are_the_last_the_first_and_the_middle(motion, window_s) -> None:
    assert course(motion, 8.0, P, 2.0).window_s(P) == pytest.approx(window_s)  # it moves from 0.5 to 3.8125 s


def test_windows_are_equally_long_and_lie_within_the_motion_at_every_speed() -> None:
    for speed in (v for reading in READINGS for v in reading.speeds_cm_s):
        for motion in FOUR:
            drive = course(motion, speed, P, 2.0)
            low, high = drive.window_s(P)
            assert high - low == pytest.approx(1.6)
            assert low >= 0.5 - 1e-9
            assert high <= 0.5 + drive.travel_s + 1e-9


def dark_columns(image):
    """Columns of the horizon's row in which nothing but the body, of grey 45, is seen."""
    return np.flatnonzero(image[35] == 45)


def test_it_looks_as_large_as_it_is() -> None:
    p = CourseParams(near_cm=2.0, misplaced_cm=0.0)
    film = Stage(QUIET).film(course("approach", 10.0, p, 2.0), p, 1)
    first, last = film.images[0], film.images[-1]
    # a cylinder of radius 2 whose centre is d away fills asin(2 / d) to either side: 3.58 and 30 degrees
    for image, half_deg in ((first, math.degrees(math.asin(2 / 32))), (last, 30.0)):
        reach_px = FOCAL_PX * math.tan(math.radians(half_deg))
        seen = dark_columns(image)
        assert seen[0] == math.ceil(49.5 - reach_px)
        assert seen[-1] == math.floor(49.5 + reach_px) - 1
    # 3 cm high, seen from 1.6 cm: at the rim, 2 cm ahead, its foot and head are out of view; far away they are not
    rows = np.flatnonzero(first[:, 49] == 45)
    assert rows[0] == math.ceil(36 - FOCAL_PX * 1.4 / 30)
    assert rows[-1] == math.floor(36 + FOCAL_PX * 1.6 / 30) - 1


def test_rightward_is_towards_growing_columns_and_from_the_left_is_seen_on_the_left() -> None:
    stage = Stage(QUIET)
    film = stage.film(course("translation_right", 8.0, EXACT, 2.0), EXACT, 1)
    middles = [np.mean(dark_columns(image)) for image in film.images if len(dark_columns(image)) > 20]
    assert len(middles) > 10
    assert np.all(np.diff(middles) >= 0)
    left = stage.film(angular(-30.0, 8.0, EXACT, 2.0), EXACT, 1)
    assert dark_columns(left.images[0]).mean() == pytest.approx(49.5 - FOCAL_PX * math.tan(math.pi / 6), abs=1.5)


@pytest.mark.parametrize(("angle", "seen"), [(-75.0, False), (-60.0, True), (60.0, True), (75.0, False)])
def test_beyond_60_degrees_nothing_comes_into_view(angle, seen) -> None:
    # its near edge is asin(2 / 4) = 30 degrees inwards of the bearing, and the view ends at 35
    film = Stage(QUIET).film(angular(angle, 16.4, EXACT, 2.0), EXACT, 1)
    assert bool((film.images[0] != film.images[-1]).any()) is seen


def test_one_seed_is_one_wall_one_noise_and_one_misplacement() -> None:
    stage, drive = Stage(World()), course("approach", 16.4, P, 2.0)
    film = stage.film(drive, P, 3)
    assert np.array_equal(film.images, Stage(World()).film(drive, P, 3).images)
    assert not np.array_equal(film.images, stage.film(drive, P, 4).images)
    quiet = Stage(QUIET)
    receding = quiet.film(course("recession", 16.4, P, 2.0), P, 3)
    assert np.array_equal(quiet.film(drive, P, 3).images[-1], receding.images[0])  # the same place before the same wall


def test_hashes_tell_scenes_apart() -> None:
    drive = course("approach", 16.4, P, 2.0)
    hashes = {Stage(w).film(drive, p, 1).scene_hash for w in (World(), QUIET) for p in (P, EXACT)}
    assert len(hashes) == 4


def test_a_course_through_the_wall_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"course from .* must stay 2 cm from the walls of 30 x 55 cm"):
        Stage(World(room=RoomParams(width_cm=30.0))).film(course("approach", 8.0, P, 2.0), P, 1)


def test_what_is_filmed() -> None:
    plan = Plan(presets={}, seeds=range(3), side_seeds=1)
    assert len(list(fig4.shots(plan))) == 4 * 3
    main, side = 4 * 6 * 3, 4 * 6 * len(fig5.OTHERS)
    assert len(list(fig5.shots(plan))) == main + side
    main, side = 11 * 6 * 3, 11 * 2 * len(fig6.OTHERS)
    assert len(list(fig6.shots(plan))) == main + side
    stage = Stage(World())
    for about in fig6.shots(plan):  # the farthest to the side fit into the arena
        if about.seed == 0 and about.label == "s80" and abs(about.course.angle_deg) == 75:
            assert len(stage.film(about.course, about.p, 0).images)
