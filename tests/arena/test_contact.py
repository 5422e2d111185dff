"""Robots stop exactly where they touch, never overlap, stay in the room; a touch is counted once an episode."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.arena.contact import (
    WALL,
    Contact,
    Episodes,
    Surroundings,
    obstacle_code,
    until_apart,
    until_beyond,
    until_out,
)
from lobula.arena.controls import NeverTurn, RandomTurn
from lobula.arena.motion import FORWARD, STOP, TURN
from lobula.arena.simulation import Simulation
from lobula.arena.world import Obstacle, RobotParams, RoomParams, TurnParams, World

from .stand_ins import PlainEye, Scripted, world_of

NUMBERS = st.floats(-10, 10)
ROUND = RoomParams(shape="circle", radius_cm=25)


def simulation(world: World, poses: list[tuple[float, float, float]], controller: object = None) -> Simulation:
    return Simulation(world, controller or NeverTurn(), 1, poses=np.array(poses), eye=PlainEye())


def until_contact(sim: Simulation, most: int = 400) -> Contact:
    for _ in range(most):
        contacts = sim.tick().contacts
        if contacts:
            return contacts[0]
    raise AssertionError("no contact")


class TestMoments:
    def test_head_on(self) -> None:
        assert until_apart(10 + 0j, -2 + 0j, 4) == pytest.approx(3)

    def test_to_one_side(self) -> None:
        # 3-4-5: at x = 4 beside by 3 the distance is 5
        assert until_apart(10 + 3j, -2 + 0j, 5) == pytest.approx(3)

    def test_passing_and_parting_never(self) -> None:
        assert until_apart(10 + 6j, -2 + 0j, 5) == math.inf
        assert until_apart(10 + 0j, 2 + 0j, 5) == math.inf
        assert until_apart(5 + 0j, 1j, 5) == math.inf  # along the edge

    def test_touching_and_closing_in_is_now(self) -> None:
        assert until_apart(5 - 1e-15 + 0j, -2 + 1j, 5) == 0

    @given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, st.floats(0.1, 5))
    def test_it_is_the_first_moment_at_that_distance(
        self, x: float, y: float, u: float, v: float, reach: float
    ) -> None:
        apart, closing = complex(x, y), complex(u, v)
        if abs(apart) <= reach * (1 + 1e-9) or abs(closing) < 1e-3:
            return
        t = until_apart(apart, closing, reach)
        moments = np.linspace(0, min(t, 100), 500)
        assert np.abs(apart + moments * closing).min() >= reach * (1 - 1e-6)
        if t < math.inf:
            assert abs(apart + t * closing) == pytest.approx(reach, rel=1e-6)

    def test_out_of_a_circle(self) -> None:
        assert until_out(0j, 2j, 5) == pytest.approx(2.5)
        assert until_out(3 + 0j, 2j, 5) == pytest.approx(2)  # 3-4-5
        assert until_out(5 + 0j, 1 + 1j, 5) == 0
        assert until_out(5 + 0j, -2 + 0j, 5) == pytest.approx(5)  # straight across
        assert until_out(1 + 1j, 0j, 5) == math.inf

    def test_beyond_a_side(self) -> None:
        assert until_beyond(1, 2, 5) == pytest.approx(2)
        assert until_beyond(1, -2, 5) == pytest.approx(3)
        assert until_beyond(5, 1, 5) == 0
        assert until_beyond(1, 0, 5) == math.inf


class TestTouch:
    def test_the_wall_is_met_where_the_edge_reaches_it(self) -> None:
        sim = simulation(world_of(), [(60.05, 20.0, 0.0)])
        contact = until_contact(sim)
        assert sim.pose[0].tolist() == pytest.approx([68, 20, 0])
        assert contact.robot == 0
        assert contact.other == WALL
        assert contact.direction_rad == 0
        assert contact.time_s == pytest.approx(7.95 / 9)
        assert sim.motion.distances_cm[0] == pytest.approx(7.95)
        assert sim.motion.phases == [STOP]

    @pytest.mark.parametrize(
        ("heading", "direction"), [(math.pi / 2, math.pi / 2), (-2.0, -math.pi / 2), (3.0, math.pi)]
    )
    def test_each_side_of_the_box(self, heading: float, direction: float) -> None:
        contact = until_contact(simulation(world_of(), [(30.0, 25.0, heading)]))
        assert abs(contact.direction_rad) == pytest.approx(abs(direction))
        assert contact.heading_rad == pytest.approx(heading)

    def test_a_round_wall(self) -> None:
        sim = simulation(world_of(room=ROUND), [(25.0, 25.0, 1.0)])
        contact = until_contact(sim)
        assert math.hypot(sim.pose[0, 0] - 25, sim.pose[0, 1] - 25) == pytest.approx(23)
        assert contact.direction_rad == pytest.approx(1.0)

    def test_an_obstacle(self) -> None:
        world = world_of(obstacles=(Obstacle(x_cm=5, y_cm=5), Obstacle(x_cm=40, y_cm=22)))
        sim = simulation(world, [(30.0, 20.0, 0.0)])
        contact = until_contact(sim)
        assert contact.other == obstacle_code(1)
        x = 40 - math.sqrt(4.5**2 - 2**2)
        assert sim.pose[0, :2].tolist() == pytest.approx([x, 20])
        assert contact.direction_rad == pytest.approx(math.atan2(2, 40 - x))

    def test_two_that_meet_stop_and_turn_and_count_once(self) -> None:
        sim = simulation(world_of(2), [(30.0, 20.0, 0.0), (39.9, 20.0, math.pi)])
        for _ in range(9):  # 5.4 of the 5.9 cm between them
            assert sim.tick().contacts == ()
        contacts = sim.tick().contacts
        assert [(c.robot, c.other) for c in contacts] == [(0, 1)]
        assert contacts[0].time_s == pytest.approx(5.9 / 18)
        assert sim.pose[:, 0].tolist() == pytest.approx([32.95, 36.95])
        assert sim.motion.phases == [STOP, STOP]

    def test_one_that_turns_is_run_into_and_goes_on_turning(self) -> None:
        sim = simulation(world_of(2), [(30.0, 20.0, 0.0), (40.0, 20.0, 0.0)], Scripted({8: [1]}))
        contact = until_contact(sim)
        assert contact.robot == 0
        assert sim.motion.phases == [STOP, TURN]
        while sim.motion.phases[1] != FORWARD:
            sim.tick()
        assert sim.tick_count == 8 + 30  # as without the contact

    def test_three_in_a_row_touch_within_one_tick(self) -> None:
        sim = simulation(world_of(3), [(30.0, 20.0, 0.0), (34.1, 20.0, 0.0), (38.2, 20.0, math.pi)])
        contacts = sim.tick().contacts
        assert [(c.robot, c.other) for c in contacts] == [(1, 2), (0, 1)]
        assert np.diff(sim.pose[:, 0]).tolist() == pytest.approx([4, 4])

    def test_driving_off_along_a_wall_is_no_contact(self) -> None:
        sim = simulation(world_of(), [(20.0, 2.0, 0.0)])
        for _ in range(60):
            assert sim.tick().contacts == ()

    def test_a_bent_path_meets_the_wall_where_its_arc_does(self) -> None:
        world = World(robots=RobotParams(count=1, speed_low_cm_s=10, speed_high_cm_s=10, curvature_per_m=10))
        sim = simulation(world, [(40.0, 27.0, 0.3)])
        bend = sim.motion._bends_per_cm[0]
        until_contact(sim)
        ways = np.linspace(0, 100, 1_000_001)
        x = 40 + (np.sin(0.3 + bend * ways) - math.sin(0.3)) / bend
        y = 27 - (np.cos(0.3 + bend * ways) - math.cos(0.3)) / bend
        first = np.argmax((x < 2) | (x > 68) | (y < 2) | (y > 53))
        assert first > 0
        assert math.hypot(*(sim.pose[0, :2] - (x[first], y[first]))) < 0.01


class TestInvariants:
    @settings(max_examples=20, deadline=None)
    @given(
        st.integers(0, 2**31), st.integers(2, 9), st.sampled_from(["box", "circle"]), st.booleans(), st.booleans(),
        st.floats(0, 0.9),
    )  # fmt: skip
    def test_no_overlap_and_nobody_leaves(
        self, seed: int, robots: int, shape: str, obstacles: bool, bent: bool, pause_s: float
    ) -> None:
        room = RoomParams(shape=shape, width_cm=30, depth_cm=26, radius_cm=16)
        world = World(
            room=room,
            robots=RobotParams(count=robots, speed_high_cm_s=60, curvature_per_m=15 * bent, motor_noise=0.2 * bent),
            turn=TurnParams(stop_s=pause_s / 3, turn_s=0.1 + pause_s, low_deg=20),
            obstacles=(Obstacle(x_cm=12, y_cm=13), Obstacle(x_cm=19, y_cm=17)) if obstacles else (),
        )
        try:
            sim = Simulation(world, RandomTurn(20), seed, eye=PlainEye())
        except ValueError:
            return  # no room for so many
        width, depth = room.size_cm
        for _ in range(150):
            sim.tick()
            places = sim.pose[:, 0] + 1j * sim.pose[:, 1]
            apart = np.abs(places[:, None] - places)[~np.eye(robots, dtype=bool)]
            assert apart.min() >= 4 - 1e-6
            if shape == "circle":
                assert np.abs(places - complex(width / 2, depth / 2)).max() <= 14 + 1e-6
            else:
                assert places.real.min() >= 2 - 1e-6
                assert places.real.max() <= width - 2 + 1e-6
                assert places.imag.min() >= 2 - 1e-6
                assert places.imag.max() <= depth - 2 + 1e-6
            for one in world.obstacles:
                assert np.abs(places - complex(one.x_cm, one.y_cm)).min() >= 4.5 - 1e-6

    def test_nobody_gains_speed(self) -> None:
        world = World(room=RoomParams(width_cm=30, depth_cm=30), robots=RobotParams(count=6))
        sim = Simulation(world, NeverTurn(), 5, eye=PlainEye())
        before = sim.pose.copy()
        for _ in range(600):
            turning = sim.motion.turning
            sim.tick()
            ways = np.hypot(*(sim.pose - before)[:, :2].T)
            assert (ways <= np.array(sim.motion.speeds_cm_s) / 30 + 1e-9).all()
            assert not ways[turning].any()
            before = sim.pose.copy()


def test_the_mean_way_across_the_room_is_that_of_geometry() -> None:
    # Cauchy: from the edge inward, by the cosine law, the mean chord of a convex region is pi area / perimeter
    world, rng, ways = world_of(), np.random.default_rng(4), []
    width, depth = 66.0, 51.0  # where a robot's centre can be: 2 cm off each wall
    sides = [(2 + 2j, 1, width), (68 + 2j, 1j, depth), (68 + 53j, -1, width), (2 + 53j, -1j, depth)]
    for _ in range(600):
        corner, direction, length = sides[rng.choice(4, p=[each[2] / (2 * (width + depth)) for each in sides])]
        along, off = rng.uniform(0, length), math.asin(rng.uniform(-1, 1))
        heading = cmath.phase(direction * 1j) + off
        around, place = Surroundings(world, 1), corner + along * direction
        chord, way = [complex(0.3 * math.cos(heading), 0.3 * math.sin(heading))], 0.0
        while True:
            shares, touches = around.hold_up(around.near([place], chord), [place], chord)
            place, way = place + shares[0] * chord[0], way + 0.3 * shares[0]
            if touches and way > 0:
                break
        ways.append(way)
    expected = math.pi * width * depth / (2 * (width + depth))  # 45.2 cm; 48.4 for a robot of no size
    assert np.mean(ways) == pytest.approx(expected, abs=4 * np.std(ways) / math.sqrt(len(ways)))


class TestEpisodes:
    def episodes(self) -> Episodes:
        world = world_of(2)
        return Episodes(world, Surroundings(world, 2))

    def stay(self, episodes: Episodes, gap_cm: float, ticks: int) -> None:
        for _ in range(ticks):
            episodes.step([10 + 10j, 14 + gap_cm + 10j])

    def test_touches_of_one_episode_are_one(self) -> None:
        episodes = self.episodes()
        assert episodes.begin(0, 1)
        assert not episodes.begin(1, 0)

    @pytest.mark.parametrize(("gap_cm", "ticks", "new"), [(0.6, 14, False), (0.6, 15, True), (0.4, 300, False)])
    def test_it_ends_after_half_a_second_half_a_centimetre_apart(self, gap_cm: float, ticks: int, new: bool) -> None:
        episodes = self.episodes()
        episodes.begin(0, 1)
        self.stay(episodes, gap_cm, ticks)
        assert episodes.begin(0, 1) == new

    def test_coming_near_again_starts_the_half_second_anew(self) -> None:
        episodes = self.episodes()
        episodes.begin(0, 1)
        self.stay(episodes, 0.6, 10)
        self.stay(episodes, 0.4, 1)
        self.stay(episodes, 0.6, 10)
        assert not episodes.begin(0, 1)

    def test_the_wall_and_a_robot_are_two_episodes(self) -> None:
        episodes = self.episodes()
        assert episodes.begin(0, 1)
        assert episodes.begin(0, 2)
        assert episodes.begin(1, 2)

    def test_a_saved_state_goes_on(self) -> None:
        first, second = self.episodes(), self.episodes()
        first.begin(0, 1)
        self.stay(first, 0.6, 10)
        second.set_state(first.state())
        self.stay(second, 0.6, 5)
        assert second.begin(0, 1)
