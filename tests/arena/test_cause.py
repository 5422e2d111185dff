"""Causes of avoidances: the rules on hand-made pasts, with eyes and controllers whose answer is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from lobula.arena.cause import (
    TOLERANCE_TICKS,
    Cause,
    approach,
    counterfactual_cause,
    driven_on,
    geometric_cause,
    kind_of,
)
from lobula.arena.contact import WALL, obstacle_code
from lobula.arena.controller import ControllerError
from lobula.arena.events import NOTHING
from lobula.arena.sight import objects
from lobula.arena.world import CameraParams, LightParams, Obstacle, World

from .pasts import RATE_HZ, past_of

WORLD = World(camera=CameraParams(ahead_cm=1.0))
POST = obstacle_code(0)


class ListingEye:
    """Draws no picture but a list: (N, 1, B + K + 1), 1 for each body, obstacle and the wall that is there."""

    def __init__(self):
        self.calls = []

    def views(self, cameras, bodies, *, own, keys, light, shown, obstacles, walls):
        self.calls.append({"cameras": cameras, "bodies": bodies, "own": own, "keys": keys, "light": light})
        return np.concatenate([shown, obstacles, walls[:, None]], axis=1).astype(np.uint8)[:, None]


class Alarmed:
    """Alarms where ``rule`` of what is there holds: a set of codes; at every frame, or at ``at`` alone."""

    def __init__(self, rule, robots, at=None):
        self.rule, self.robots, self.at, self.asked = rule, robots, at, []

    def replay(self, state, images, times_s, turning):
        self.asked.append((state, times_s, turning))
        codes = [*range(self.robots), *(obstacle_code(k) for k in range(images.shape[2] - self.robots - 1)), WALL]
        there = [{code for code, on in zip(codes, image[0], strict=True) if on} for image in images]
        said = np.array([self.rule(found) for found in there])
        return said if self.at is None else said & (np.arange(len(said)) == self.at)


def cause_of(past, rule, world=WORLD, eye=None, controller=None):
    controller = controller or Alarmed(rule, past.poses.shape[1])
    about = objects(past, 0, world)
    return counterfactual_cause(past, 0, about, world, eye or ListingEye(), controller)


# robot 0 drives right from the middle; robot 1 is ahead on its left, 2 farther ahead on its right, 3 behind
FOUR = past_of((25, 27, 0, 8), (32, 29, 180, 8), (45, 25, 180, 8), (12, 27, 0, 8))


def test_the_object_whose_removal_removes_the_alarm():
    assert cause_of(FOUR, lambda there: 2 in there)[:2] == (2, "alone")
    assert cause_of(FOUR, lambda there: 1 in there)[:2] == (1, "alone")
    assert cause_of(FOUR, lambda there: WALL in there)[:2] == (WALL, "alone")


def test_an_obstacle_can_be_the_cause():
    world = World(camera=CameraParams(ahead_cm=1.0), obstacles=(Obstacle(x_cm=34, y_cm=22), Obstacle(x_cm=50, y_cm=30)))
    assert cause_of(FOUR, lambda there: obstacle_code(1) in there, world)[:2] == (obstacle_code(1), "alone")
    assert cause_of(FOUR, lambda there: POST in there, world)[:2] == (POST, "alone")


def test_distance_is_that_of_the_cause():
    # the pupil at (26, 27), robot 2 at (45, 25)
    assert cause_of(FOUR, lambda there: 2 in there).distance_cm == pytest.approx(math.hypot(19, 2) - 2)


def test_two_that_alarm_each_for_itself_go_to_the_nearest():
    assert cause_of(FOUR, lambda there: bool(there & {1, 2}))[:2] == (1, "together")


def test_two_that_alarm_only_as_a_pair_go_to_the_nearest():
    assert cause_of(FOUR, lambda there: {1, 2} <= there)[:2] == (1, "alone")


def test_an_alarm_that_nothing_removes_is_spurious():
    found = cause_of(FOUR, lambda there: True)
    assert found[:2] == (NOTHING, "none")
    assert math.isnan(found.distance_cm)


def test_what_is_far_does_not_save_a_spurious_alarm():
    # robots 1 and 2 each alarm by themselves, 2 stands 38 cm away: with all near removed the alarm persists
    far = past_of((15, 27, 0, 8), (25, 29, 180, 8), (55, 25, 180, 0))
    assert cause_of(far, lambda there: bool(there & {1, 2}))[:2] == (NOTHING, "none")
    assert cause_of(far, lambda there: 2 in there)[:2] == (2, "alone")


def test_the_nearest_is_tried_first_and_the_search_stops_there():
    eye = ListingEye()
    cause_of(FOUR, lambda there: 1 in there, eye=eye)
    assert len(eye.calls) == 1
    cause_of(FOUR, lambda there: 2 in there, eye=eye)
    assert len(eye.calls) == 1 + 2


def test_what_was_not_in_view_is_not_tried():
    # robot 3 is behind: it is only removed together with all others near
    assert cause_of(FOUR, lambda there: 3 in there)[:2] == (1, "together")


@pytest.mark.parametrize(
    ("shift", "found"),
    [(0, NOTHING), (-TOLERANCE_TICKS, NOTHING), (TOLERANCE_TICKS, NOTHING), (-TOLERANCE_TICKS - 1, 1)],
)
def test_an_alarm_that_only_moves_a_little_persists(shift, found):
    last = len(FOUR.times_s) - 1
    controller = Alarmed(lambda there: True, 4, at=last + shift)
    assert cause_of(FOUR, None, controller=controller).other == found


def test_the_replay_gets_the_very_frames_and_two_more():
    eye, controller = ListingEye(), Alarmed(lambda there: 1 in there, 4)
    past = FOUR._replace(turning=np.zeros((34, 4), bool) | (np.arange(34) < 3)[:, None])
    cause_of(past, None, eye=eye, controller=controller)
    (state, times_s, turning), call = controller.asked[0], eye.calls[0]
    assert state == "saved"
    frames = len(past.times_s)
    assert times_s[:frames].tolist() == past.times_s.tolist()
    assert times_s[frames:] == pytest.approx(past.times_s[-1] + np.array([1, 2]) / RATE_HZ)
    assert turning.tolist() == [True] * 3 + [False] * (frames - 1)
    assert (call["bodies"][:frames] == past.poses).all()
    assert (call["cameras"][:frames] == past.poses[:, 0]).all()
    assert (call["own"] == 0).all()
    assert call["keys"][:frames].tolist() == past.keys.tolist()
    assert len(set(call["keys"].tolist())) == frames + 2
    assert call["light"][:frames].tolist() == past.light.tolist()


def test_light_of_the_frames_that_never_came():
    world = World(
        camera=CameraParams(ahead_cm=1.0), light=LightParams(course="steps", step_gain=0.5, step_every_s=10.1)
    )
    eye = ListingEye()
    past = FOUR._replace(times_s=FOUR.times_s - FOUR.times_s[-1] + 10.1 - 1.5 / RATE_HZ)
    cause_of(past, lambda there: 1 in there, world, eye)
    # the last picture was taken at a gain of 1.1 in a light of 1: the camera's own gain is 1.1
    assert eye.calls[0]["light"][-2:] == pytest.approx([1.1, 0.55])


def test_held_velocities_are_driven_on():
    later = driven_on(FOUR, 0, WORLD, 2)
    assert later[:, 0, 0] == pytest.approx([25 + 8 / 30, 25 + 16 / 30])
    assert later[:, 1, 0] == pytest.approx([32 - 8 / 30, 32 - 16 / 30])
    assert (later[:, :, 2] == FOUR.poses[-1, :, 2]).all()


def test_driving_on_ends_where_it_would_touch():
    wall = past_of((67.7, 27, 0, 8))  # 0.3 cm from touching: one tick of 0.27 cm is free, the next is not
    assert driven_on(wall, 0, WORLD, 2)[:, 0, 0] == pytest.approx([67.7 + 8 / 30] * 2)
    pair = past_of((30, 27, 0, 8), (34.1, 27, 180, 8))
    assert driven_on(pair, 0, WORLD, 2)[:, 0, 0] == pytest.approx([30, 30])


@pytest.mark.parametrize("answer", [np.zeros(3, bool), np.zeros(36), None])
def test_a_replay_that_answers_nonsense_is_named(answer):
    controller = Alarmed(None, 4)
    controller.replay = lambda *_: answer
    with pytest.raises(
        ControllerError, match=r"controller Alarmed, replay of the alarm at 11.100 s: returned .* must be bool \(36,\)"
    ):
        cause_of(FOUR, None, controller=controller)


def test_a_replay_that_raises_is_named():
    controller = Alarmed(lambda there: 1 / 0, 4)
    with pytest.raises(ControllerError, match="raised ZeroDivisionError"):
        cause_of(FOUR, None, controller=controller)


def meets(*robots, turning=()):
    """Kind of robot 0's avoidance of robot 1, and the miss."""
    past = past_of(*robots, turning=turning)
    return kind_of(Cause(1, "alone", 1.0), past, 0, WORLD), approach(past, 0, 1, WORLD)[1]


@pytest.mark.parametrize(
    ("robots", "kind", "miss_cm"),
    [
        (((20, 27, 0, 8), (40, 27, 180, 8)), "AA", -4.0),  # head-on
        (((20, 27, 0, 8), (40, 17, 90, 8)), "AT", math.sqrt(50) - 4),  # crosses in front: least distance 10 / sqrt 2
        (((20, 27, 0, 8), (40, 7, 90, 8)), "AA", -4.0),  # on a collision course at right angles
        (((20, 27, 0, 10), (30, 27, 0, 6)), "AA", -4.0),  # catches up with a slower one in 1.5 s
        (((20, 27, 0, 7), (30, 27, 0, 6)), "AT", 3.0),  # too slowly: 3 of 10 cm in 3 s
        (((20, 27, 0, 6), (30, 27, 0, 10)), "AT", 6.0),  # drives away
        (((20, 27, 0, 6), (24.5, 27, 0, 10)), "AT", 0.5),  # drives away, from within the margin
        (((20, 27, 0, 8), (40, 31.9, 180, 8)), "AA", 0.9),  # a near miss inside the margin of 1 cm
        (((20, 27, 0, 8), (40, 32.1, 180, 8)), "AT", 1.1),  # and outside
        (((10, 27, 0, 6), (60, 27, 180, 6)), "AT", 10.0),  # head-on, but 50 - 36 cm apart after 3 s
        (((20, 27, 0, 8), (30, 27, 90, 0)), "AA", -4.0),  # stands in the way
    ],
)
def test_approaching_or_translating(robots, kind, miss_cm):
    got = meets(*robots)
    assert got[0] == kind
    assert got[1] == pytest.approx(miss_cm)


def test_a_robot_that_turns_has_no_velocity():
    # driving on it would hit; turning in place at (40, 7) it is passed at 20 cm
    assert meets((20, 27, 0, 8), (40, 7, 90, 8), turning=[(1, 0.1, 0.0)])[0] == "AT"


@settings(max_examples=100)
@given(st.tuples(*[st.floats(-25, 25)] * 2), st.floats(0, 360), st.floats(0, 10), st.floats(0, 10))
def test_approach_against_brute_force(place, heading_deg, own, speed):
    assume(math.hypot(*place) >= 4)  # bodies do not overlap
    past = past_of((35, 27, 0, own), (35 + place[0], 27 + place[1], heading_deg, speed))
    times = np.linspace(0, 3, 3001)[:, None]
    apart = past.poses[-1, 1, :2] - past.poses[-1, 0, :2] + times * (past.velocities_cm_s[1] - past.velocities_cm_s[0])
    distances = np.linalg.norm(apart, axis=1)
    approaching, miss_cm = approach(past, 0, 1, WORLD)
    assert miss_cm == pytest.approx(distances.min() - 4, abs=0.011)
    if abs(distances.min() - 5) > 0.02 and abs(distances[1] - distances[0]) > 1e-6:
        assert approaching == (distances.min() < 5 and distances[1] < distances[0])


@pytest.mark.parametrize(("other", "kind"), [(WALL, "AP"), (POST, "AP"), (NOTHING, "spurious"), (1, "AA"), (2, "AT")])
def test_kinds(other, kind):
    past = past_of((20, 27, 0, 8), (40, 27, 180, 8), (30, 40, 90, 8))
    assert kind_of(Cause(other, "alone", 1.0), past, 0, WORLD) == kind


def by_place(*robots, world=WORLD):
    past = past_of(*robots)
    return geometric_cause(past, 0, objects(past, 0, world), world)[:2]


def test_by_place_the_nearest_robot_in_view_comes_first():
    # the wall ahead is nearer than either of them
    found = by_place((60, 27, 0, 8), (65, 31, 180, 0), (66, 22, 180, 0))
    assert found == (1, "geometric")


def test_by_place_a_robot_beyond_20_cm_is_none():
    assert by_place((20, 27, 0, 8), (42.9, 27, 180, 8))[0] == 1  # 19.9 cm from the pupil
    assert by_place((20, 27, 0, 8), (43.1, 27, 180, 8))[0] == NOTHING


def test_by_place_a_robot_out_of_view_is_none():
    assert by_place((20, 27, 0, 0), (26, 39, 90, 20))[0] == NOTHING  # it has just left
    assert by_place((55, 27, 0, 8), (50, 27, 0, 8))[0] == WALL


def test_by_place_the_wall_counts_along_the_heading():
    assert by_place((49.1, 27, 0, 8))[0] == WALL  # 19.9 cm ahead of the pupil
    assert by_place((48.9, 27, 0, 8))[0] == NOTHING
    # 10 cm from the wall beside it, but 10 / sin 20 deg = 29 cm along its way
    assert by_place((30, 45, 20, 8))[0] == NOTHING


def test_by_place_the_nearer_of_wall_and_obstacle():
    world = World(camera=CameraParams(ahead_cm=1.0), obstacles=(Obstacle(x_cm=60, y_cm=27),))
    assert by_place((50, 27, 0, 8), world=world)[0] == POST
    assert by_place((62, 35, 0, 8), world=world)[0] == WALL
