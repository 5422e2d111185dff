"""Geometry of the arena, against hand work and brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.arena.geometry import (
    closest_approach,
    discs_in_view,
    incidence_deg,
    nearest_wall_in_view_cm,
    normal_ahead,
    points_in_view,
    pupils,
    touched_wall_normal,
    wall_ahead_cm,
    wrap_rad,
)
from lobula.arena.world import CameraParams, RoomParams

BOX = RoomParams()  # 70 x 55 cm
CIRCLE = RoomParams(shape="circle", radius_cm=30.0)
CAMERA = CameraParams()
HALF = math.radians(35.0)

metres = st.floats(-60, 60)
speeds = st.floats(-12, 12)
inside_box = st.tuples(st.floats(3, 67), st.floats(3, 52))
headings = st.floats(-10, 10)


def discs(*centres, pupil=(0.0, 0.0), heading=0.0, radii=2.0, heights=3.0):
    """Which discs a camera at ``pupil`` sees at one moment."""
    count = len(centres)
    seen = discs_in_view(
        np.array([pupil], float), np.array([heading]), np.array([centres], float).reshape(1, count, 2),
        np.broadcast_to(radii, count).astype(float), np.broadcast_to(heights, count).astype(float), CAMERA,
    )  # fmt: skip
    return seen[0].tolist()


@pytest.mark.parametrize(
    ("offset", "velocity", "distance", "time"),
    [
        ((20, 0), (-10, 0), 0.0, 2.0),  # head-on
        ((20, 5), (-10, 0), 5.0, 2.0),  # passes 5 cm beside
        ((20, -20), (0, 10), 20.0, 2.0),  # crosses in front
        ((20, 0), (10, 0), 20.0, 0.0),  # recedes: now is nearest
        ((40, 0), (-10, 0), 10.0, 3.0),  # too far for 3 s
        ((3, 4), (0, 0), 5.0, 0.0),  # side by side at one speed
        ((10, 0), (-2, 0), 4.0, 3.0),  # overtakes slowly
    ],
)
def test_closest_approach_by_hand(offset, velocity, distance, time):
    got = closest_approach(offset, velocity, 3.0)
    assert (float(got[0]), float(got[1])) == pytest.approx((distance, time))


@settings(max_examples=200)
@given(metres, metres, speeds, speeds)
def test_closest_approach_against_brute_force(x, y, vx, vy):
    times = np.linspace(0, 3, 6001)
    slow = np.hypot(x + vx * times, y + vy * times)
    distance, time = closest_approach((x, y), (vx, vy), 3.0)
    # within half a step of 0.5 ms at no more than 17 cm/s of a sample, and never above one
    assert slow.min() - 0.01 <= distance <= slow.min() + 1e-9
    assert 0 <= time <= 3
    assert distance == pytest.approx(math.hypot(x + vx * time, y + vy * time))


def test_many_approaches_at_once():
    distance, time = closest_approach([[20, 0], [20, 5]], [[-10, 0], [-10, 0]], 3.0)
    assert distance.tolist() == [0.0, 5.0]
    assert time.tolist() == [2.0, 2.0]


@given(headings)
def test_wrapped_angles_point_the_same_way(angle):
    wrapped = float(wrap_rad(angle))
    assert -math.pi <= wrapped < math.pi
    assert math.cos(wrapped - angle) == pytest.approx(1.0)


def test_the_pupil_sits_ahead():
    got = pupils([[10, 20, 0], [10, 20, math.pi / 2]], 1.33)
    assert got == pytest.approx(np.array([[11.33, 20], [10, 21.33]]))


@pytest.mark.parametrize(
    ("room", "point", "heading_deg", "distance"),
    [
        (BOX, (60, 20), 0, 10),
        (BOX, (60, 20), 180, 60),
        (BOX, (60, 20), -90, 20),
        (BOX, (60, 20), 60, 20),  # 10 / cos 60
        (BOX, (10, 50), 135, 5 * math.sqrt(2)),
        (CIRCLE, (30, 30), 77, 30),
        (CIRCLE, (40, 30), 0, 20),
        (CIRCLE, (40, 30), 180, 40),
        (CIRCLE, (48, 30), 90, 24),  # 18-24-30
    ],
)
def test_distance_to_the_wall_ahead(room, point, heading_deg, distance):
    assert wall_ahead_cm(room, point, math.radians(heading_deg)) == pytest.approx(distance)


@pytest.mark.parametrize(
    ("room", "point", "heading_deg", "normal_deg", "incidence"),
    [
        (BOX, (60, 20), 0, 0, 0),  # head-on
        (BOX, (60, 20), 30, 0, 30),  # oblique
        (BOX, (35, 5), -60, -90, 30),
        (BOX, (35, 50), 100, 90, 10),
        (BOX, (5, 30), 180, 180, 0),
        (CIRCLE, (30, 30), 50, 50, 0),  # from the centre every way is square
        (CIRCLE, (48, 30), 90, math.degrees(math.atan2(24, 18)), 90 - math.degrees(math.atan2(24, 18))),
    ],
)
def test_incidence_at_the_wall_ahead(room, point, heading_deg, normal_deg, incidence):
    normal = normal_ahead(room, point, math.radians(heading_deg))
    assert float(wrap_rad(normal - math.radians(normal_deg))) == pytest.approx(0, abs=1e-9)
    assert incidence_deg(math.radians(heading_deg), normal) == pytest.approx(incidence, abs=1e-6)


@pytest.mark.parametrize(
    ("room", "point", "normal_deg"),
    [(BOX, (68, 20), 0), (BOX, (30, 2), -90), (BOX, (2, 30), 180), (CIRCLE, (30, 58), 90), (CIRCLE, (2, 30), 180)],
)
def test_the_wall_that_is_touched(room, point, normal_deg):
    got = touched_wall_normal(room, point)
    assert incidence_deg(got, math.radians(normal_deg)) == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(
    ("heading_deg", "distance"),
    [
        (0, 10),  # the foot is straight ahead
        (30, 10),  # the foot lies 30 deg to the right, still in view
        (45, 10 / math.cos(math.radians(10))),  # the right edge of the view at 10 deg
        (180, 20 / math.sin(HALF)),  # away from it: the near side wall, at an edge of the view
    ],
)
def test_nearest_wall_in_view_of_a_box(heading_deg, distance):
    # 10 cm from the right wall, 20 from the lower one, 35 from the upper one
    assert nearest_wall_in_view_cm(BOX, (60, 20), math.radians(heading_deg), 70) == pytest.approx(distance)


@settings(max_examples=60)
@given(inside_box, headings, st.sampled_from([BOX, CIRCLE]))
def test_nearest_wall_in_view_against_brute_force(point, heading, room):
    if room is CIRCLE:
        point = (15 + point[0] * 0.4, 15 + point[1] * 0.5)
    ways = heading + np.linspace(-HALF, HALF, 2001)
    slow = min(wall_ahead_cm(room, point, way) for way in ways)
    fast = nearest_wall_in_view_cm(room, point, heading, 70)
    assert fast <= slow + 1e-9
    assert slow == pytest.approx(fast, rel=1e-4)


def test_points_in_view():
    points = [[10, 6.9], [10, 7.1], [10, -6.9], [-10, 0]]  # tan 35 deg = 0.7002
    assert points_in_view((0, 0), 0.0, points, 70).tolist() == [True, False, True, False]
    assert points_in_view((0, 0), math.pi, points, 70).tolist() == [False, False, False, True]


def test_a_disc_is_in_view_as_soon_as_its_edge_is():
    # at 10 cm a disc of 2 cm reaches 11.5 deg beyond its centre: 35 + 11.5 = 46.5 deg
    def at(deg):
        return discs((10 * math.cos(math.radians(deg)), 10 * math.sin(math.radians(deg))))[0]

    assert at(0)
    assert at(-45.5)
    assert at(45.5)
    assert not at(47.5)
    assert not at(180)


def test_a_nearer_disc_hides_what_is_behind_it():
    assert discs((8, 0), (20, 0)) == [True, False]
    assert discs((20, 0), (8, 0)) == [False, True]


def test_an_edge_that_looks_out_is_enough():
    # at 8 cm a disc hides up to 14.5 deg; one at (20, y) reaches 5.7 deg beyond its own bearing
    assert discs((8, 0), (20, 2.9)) == [True, False]  # to 13.9 deg
    assert discs((8, 0), (20, 3.6)) == [True, True]  # to 15.8 deg: two columns


def test_a_tall_cylinder_shows_over_a_robot_and_a_low_one_does_not_hide_it():
    assert discs((8, 0), (20, 0), heights=(3.0, 12.0)) == [True, True]  # tops at 1.4 / 6 and 10.4 / 18
    assert discs((8, 0), (60, 0), heights=(3.0, 12.0)) == [True, False]  # 1.4 / 6 and 10.4 / 58
    assert discs((8, 0), (20, 0), heights=(1.0, 3.0)) == [True, True]


def test_views_of_several_moments_stand_apart():
    got = discs_in_view(
        np.zeros((2, 2)), np.array([0.0, math.pi]), np.array([[[10.0, 0.0]], [[10.0, 0.0]]]), np.array([2.0]),
        np.array([3.0]), CAMERA,
    )  # fmt: skip
    assert got.tolist() == [[True], [False]]


def test_no_discs_no_view():
    assert discs() == []


def seen_column_by_column(pupil, heading, centres, radii, heights):
    """The definition, one ray at a time: the nearest disc shows, and behind it what stands higher in the picture."""
    seen = [False] * len(centres)
    for column in range(99):
        ray = heading - math.atan((column + 0.5 - 49.5) / 49.5 * math.tan(HALF))
        met = []
        for j, (centre, radius) in enumerate(zip(centres, radii, strict=True)):
            x, y = centre[0] - pupil[0], centre[1] - pupil[1]
            along, beside = x * math.cos(ray) + y * math.sin(ray), y * math.cos(ray) - x * math.sin(ray)
            if abs(beside) <= radius and along > 0:
                met.append((along - math.sqrt(radius**2 - beside**2), j))
        highest = -math.inf
        for depth, j in sorted(met):
            top = (heights[j] - CAMERA.above_floor_cm) / depth
            seen[j] = seen[j] or top > highest
            highest = max(highest, top)
    return seen


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_view_against_brute_force(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 9))
    heading, ways = rng.uniform(-9, 9), rng.uniform(-math.pi, math.pi, count)
    radii, heights = rng.uniform(1, 3, count), rng.choice([1.0, 3.0, 3.0, 12.0], count)
    reach = rng.uniform(3.5, 50, count)
    centres = np.stack([35 + reach * np.cos(ways), 27 + reach * np.sin(ways)], axis=1)
    slow = seen_column_by_column((35, 27), heading, centres, radii, heights)
    assert discs(*centres, pupil=(35, 27), heading=heading, radii=radii, heights=heights) == slow
