"""What a robot had before its eyes, in hand-made geometry."""

from __future__ import annotations

import pytest

from lobula.arena.contact import WALL, obstacle_code
from lobula.arena.sight import could_see, objects, seen_lately
from lobula.arena.world import CameraParams, Obstacle, RoomParams, ScoringParams, World

from .pasts import past_of

WORLD = World(camera=CameraParams(ahead_cm=1.0))
POST = World(camera=CameraParams(ahead_cm=1.0), obstacles=(Obstacle(x_cm=35, y_cm=27, radius_cm=2.0),))
ROUND = World(room=RoomParams(shape="circle", radius_cm=30), camera=CameraParams(ahead_cm=1.0))


def by_code(past, world=WORLD, robot=0):
    return {one.other: one for one in objects(past, robot, world)}


def test_objects_come_nearest_first_with_their_distances():
    # the pupil is at (21, 27): 13 cm to robot 1's surface, 8 to robot 2's, 27 to the side walls in view
    past = past_of((20, 27, 0, 8), (36, 27, 180, 8), (31, 27, 90, 0))
    found = objects(past, 0, WORLD)
    assert [one.other for one in found] == [2, 1, WALL]
    assert [one.distance_cm for one in found[:2]] == pytest.approx([8.0, 13.0])
    assert found[2].distance_cm == pytest.approx(27 / 0.573576, rel=1e-5)  # at the edge of the view: sin 35 deg


def test_a_robot_behind_is_an_object_but_not_in_view():
    found = by_code(past_of((20, 27, 0, 8), (10, 27, 0, 8)))
    assert not found[1].in_view
    assert not found[1].in_view_now
    assert found[1].distance_cm == pytest.approx(9.0)


def test_a_robot_that_has_left_the_view_was_in_it():
    # it crosses in front of a standing robot, 5 cm ahead of the pupil, at 20 cm/s: now 12 cm aside, a second ago -8
    found = by_code(past_of((20, 27, 0, 0), (26, 39, 90, 20)))
    assert found[1].in_view
    assert not found[1].in_view_now


def test_only_the_last_second_counts():
    # 1.5 s ago it was 5 cm ahead and 5 aside, in view; a second ago 10 aside: its edge at 63.4 - 10.3 deg, out of it
    past = past_of((20, 27, 0, 0), (26, 47, 90, 10), seconds=2.0)
    assert not by_code(past)[1].in_view
    longer = World(camera=CameraParams(ahead_cm=1.0), scoring=ScoringParams(back_s=2.0))
    assert by_code(past, longer)[1].in_view


def test_the_wall_is_always_in_view_and_its_angle_is_that_of_the_wall_ahead():
    found = by_code(past_of((60, 27, 30, 8)))
    assert found[WALL].in_view
    assert found[WALL].incidence_deg == pytest.approx(30)
    assert by_code(past_of((30, 30, 77, 8)), ROUND)[WALL].incidence_deg == pytest.approx(0, abs=1e-6)


def test_incidence_of_a_robot_lies_between_heading_and_the_way_to_it():
    found = by_code(past_of((20, 27, 0, 8), (31, 37, 0, 8)))  # 10 ahead of the pupil, 10 aside
    assert found[1].incidence_deg == pytest.approx(45)


def test_obstacles_are_objects_with_their_codes():
    found = by_code(past_of((20, 27, 0, 8), (45, 27, 180, 0)), POST)
    assert found[obstacle_code(0)].distance_cm == pytest.approx(12.0)
    assert found[obstacle_code(0)].in_view_now
    assert not found[1].in_view_now  # right behind it


def test_nobody_sees_itself():
    assert not seen_lately(past_of((20, 27, 0, 8), (30, 27, 0, 8)), 1, WORLD).any(axis=0)[1]


def test_head_on_both_could_see_it_coming():
    past = past_of((30, 27, 0, 8), (34.2, 27, 180, 8))
    assert could_see(past, 0, 1, (32.1, 27), WORLD)
    assert could_see(past, 1, 0, (32.1, 27), WORLD)


def test_struck_from_behind_only_the_striker_could_see_it():
    past = past_of((30, 27, 0, 10), (34.2, 27, 0, 6))
    assert could_see(past, 0, 1, (32.1, 27), WORLD)
    assert not could_see(past, 1, 0, (32.1, 27), WORLD)


def test_who_turns_cannot_see():
    past = past_of((30, 27, 0, 8), (34.2, 27, 180, 8), turning=[(0, 0.3, 0.0)])
    assert not could_see(past, 0, 1, (32.1, 27), WORLD)
    assert could_see(past, 1, 0, (32.1, 27), WORLD)


def test_what_was_in_view_only_during_a_turn_was_not_seen():
    # robot 1 crosses the view of robot 0 in passing: in view until 0.3 s ago, while robot 0 turned
    passing = (26, 38, 90, 20)
    assert could_see(past_of((20, 27, 0, 0), passing), 0, 1, (21, 29), WORLD)
    assert not could_see(past_of((20, 27, 0, 0), passing, turning=[(0, 1.0, 0.2)]), 0, 1, (21, 29), WORLD)


def test_a_wall_met_head_on_was_seen():
    assert could_see(past_of((67.9, 27, 0, 8)), 0, WALL, (69.9, 27), WORLD)


def test_a_wall_met_sideways_after_a_turn_was_not_seen():
    # it drives along the wall, touching it on its left, and has only just ended its turn
    along = (40, 53, 0, 1.0)
    assert not could_see(past_of(along, turning=[(0, 1.1, 0.2)]), 0, WALL, (40, 55), WORLD)
    # at 8 cm/s a second ago the place lay 7 cm ahead of the pupil and 2 aside: in view
    assert could_see(past_of((40, 53, 0, 8.0)), 0, WALL, (40, 55), WORLD)


def test_an_obstacle_is_seen_like_a_robot():
    ahead, behind = past_of((31, 27, 0, 8)), past_of((39, 27, 0, 0.5))
    assert could_see(ahead, 0, obstacle_code(0), (33, 27), POST)
    assert not could_see(behind, 0, obstacle_code(0), (37, 27), POST)
