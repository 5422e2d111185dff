"""The controller that knows everything: whom it turns for, in poses made by hand, and runs of a few seconds."""

from __future__ import annotations

import csv
import math
from dataclasses import replace

import numpy as np
import pytest

from lobula.arena import World
from lobula.errors import ParameterError
from lobula.experiments.closed_loop.ceiling import RULES, main
from lobula.experiments.closed_loop.informed import Rule, drive, robot_comes, wall_comes

WORLD = World()
"""70 x 55 cm, radius 2 cm, margin 1 cm (5 cm between centres), 70 degrees from 1.33 cm ahead of the centre."""

SOON = Rule(horizon_s=0.7)
RIGHT, UP, LEFT = 0.0, math.pi / 2, math.pi


def world_of(robots, **motion):
    return replace(WORLD, robots=replace(WORLD.robots, count=robots, **motion))


def comes(*robots, rule=SOON):
    """Of robots (x, y, heading, speed)."""
    poses = np.array([robot[:3] for robot in robots], float)
    speeds = np.array([robot[3] for robot in robots], float)
    velocities = speeds[:, None] * np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    return robot_comes(poses, velocities, WORLD, rule).tolist()


class TestRobots:
    # head-on at 16 cm/s: 5 cm between centres are reached 0.4 s from 11.4 cm
    @pytest.mark.parametrize(("apart_cm", "turns"), [(8.0, True), (11.3, True), (11.5, False)])
    def test_head_on(self, apart_cm, turns):
        head_on = (20, 27, RIGHT, 8), (20 + apart_cm, 27, LEFT, 8)
        assert comes(*head_on, rule=Rule(horizon_s=0.4)) == [turns, turns]

    def test_one_that_stands_is_come_upon_by_who_drives_and_sees_it(self):
        assert comes((20, 27, RIGHT, 8), (27, 27, RIGHT, 0)) == [True, False]

    def test_receding(self):
        assert comes((20, 27, RIGHT, 6), (25, 27, RIGHT, 10)) == [False, False]

    def test_receding_within_the_margin(self):
        assert comes((20, 27, RIGHT, 6), (24.5, 27, RIGHT, 10)) == [False, False]

    # opposite lanes, 8 cm ahead: the gap in passing is the way between the lanes less two radii
    @pytest.mark.parametrize(("lanes_cm", "turns"), [(4.9, True), (5.1, False)])
    def test_passing_within_and_outside_the_margin(self, lanes_cm, turns):
        assert comes((20, 27, RIGHT, 8), (28, 27 + lanes_cm, LEFT, 8)) == [turns, turns]

    def test_only_its_edge_in_view(self):
        # from the pupil 6.67 ahead, 4.9 aside: the centre at 36.3 degrees, the near edge at 22
        lanes = (20, 27, RIGHT, 8), (28, 31.9, LEFT, 8)
        assert comes(*lanes, rule=replace(SOON, sight="edge")) == [True, True]
        assert comes(*lanes, rule=replace(SOON, sight="centre")) == [False, False]

    def test_beyond_the_view(self):
        # crossing at right angles, equally far from where the ways meet. From the pupil 4.67 ahead, 6 aside: the
        # centre at 52.1 degrees, the near edge at 36.8
        crossing = (20, 27, RIGHT, 8), (26, 21, UP, 8)
        assert comes(*crossing) == [False, False]
        assert comes(*crossing, rule=replace(SOON, sight="around")) == [True, True]

    def test_headings_beyond_half_a_turn(self):
        assert comes((20, 27, RIGHT + 2 * math.pi, 8), (28, 27, LEFT - 2 * math.pi, 8)) == [True, True]

    def test_a_robot_alone(self):
        assert comes((20, 27, RIGHT, 8)) == [False]


class TestWall:
    @pytest.mark.parametrize(
        ("pose", "turns"),
        [
            ((63.1, 27, RIGHT), True),  # 4.9 cm before it touches
            ((62.9, 27, RIGHT), False),
            ((6.9, 27, LEFT), True),
            ((35, 48.1, UP), True),
            ((35, 6.9, -UP), True),
            ((63.1, 27, LEFT), False),
            ((66, 27, UP), False),  # along it
            ((64.6, 27, math.pi / 4), True),  # 3.4 cm to go towards it: 4.8 along the way
            ((64.4, 27, math.pi / 4), False),  # 3.6: 5.1
        ],
    )
    def test_of_the_box(self, pose, turns):
        assert wall_comes(np.array([pose]), WORLD, 5.0).tolist() == [turns]

    @pytest.mark.parametrize(("x", "turns"), [(63.1, True), (62.9, False)])
    def test_of_the_circle(self, x, turns):
        circle = replace(WORLD, room=replace(WORLD.room, shape="circle"))
        assert wall_comes(np.array([(x, 35.0, RIGHT)]), circle, 5.0).tolist() == [turns]


class TestDrive:
    def test_two_head_on_avoid_each_other(self):
        # 20 cm apart at 16 cm/s they would touch after a second; after two both have turned and driven on
        world = world_of(2, speed_low_cm_s=8.0, speed_high_cm_s=8.0)
        poses = np.array([(25, 27, RIGHT), (45, 27, LEFT)], float)
        score, reasons = drive(world, SOON, 5, 1.0 / 60, poses)
        assert (score.aa, score.at, score.ap, score.cr, score.rule) == (2, 0, 0, 0, "geometric")
        assert (reasons.aa, reasons.at, reasons.ap, reasons.cr) == (2, 0, 0, 0)

    def test_a_turn_from_the_wall_with_a_robot_in_view(self):
        # robot 0: 4.8 cm before it touches the wall, aslant; robot 1, 13 cm off in its view, drives away
        world = world_of(2, speed_low_cm_s=8.0, speed_high_cm_s=8.0)
        poses = np.array([(65.6, 20, math.pi / 3), (66, 33, UP)], float)
        score, reasons = drive(world, SOON, 5, 0.1 / 60, poses)
        assert (score.aa, score.at, score.ap) == (0, 1, 0)
        assert (reasons.aa, reasons.at, reasons.ap) == (0, 0, 1)

    def test_the_same_seed_gives_the_same_counts(self):
        assert drive(world_of(7), SOON, 55, 0.1) == drive(world_of(7), SOON, 55, 0.1)

    @pytest.mark.parametrize("minutes", [0.0, -1.0, math.nan])
    def test_minutes_that_are_none(self, minutes):
        with pytest.raises(ParameterError, match="must be above 0"):
            drive(WORLD, SOON, 1, minutes)


class TestCommand:
    def test_it_writes_table_and_page(self, tmp_path, capsys):
        out = tmp_path / "c"
        arguments = ["--seeds", "2", "--first-seed", "51", "--minutes", "0.05", "--robots", "2", "3"]
        assert main(["--out", str(out), *arguments]) == 0
        assert capsys.readouterr().out.strip() == str(out)
        assert {path.name for path in out.iterdir()} == {"ceiling.csv", "ceiling.md", "runs.ndjson"}
        with (out / "ceiling.csv").open() as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == len(RULES) * 2 * 2
        assert {row["seed"] for row in rows} == {"51", "52"}
        assert all(row["CR"] == row["reasons_CR"] and row["reasons_AT"] == "0" for row in rows)
        page = (out / "ceiling.md").read_text()
        assert page.count("\n| 0.7 s |") == 6
        assert "calibration seeds 51 to 52, 0.05 simulated minutes" in page
        assert "by place alone" in page

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["--first-seed", "7001"], "must not be among 7000 to 7999"),
            (["--seeds", "0"], "--seeds 0: must be 1 or more"),
        ],
    )
    def test_what_is_refused(self, arguments, message, tmp_path, capsys):
        assert main(["--out", str(tmp_path / "no"), *arguments]) == 2
        assert message in capsys.readouterr().err
        assert not (tmp_path / "no").exists()
