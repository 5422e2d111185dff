"""A run tick by tick: the same seed is the same run, it goes on from a snapshot, and its last second can be redone."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lobula import preset
from lobula.arena.controller import ControllerError
from lobula.arena.controls import AlwaysTurn, NeverTurn, RandomTurn
from lobula.arena.motion import FORWARD, STOP
from lobula.arena.network_controller import NetworkController
from lobula.arena.simulation import Simulation
from lobula.arena.snapshot import load_snapshot, save_snapshot
from lobula.arena.world import CameraParams, LightParams, RobotParams, RoomParams, World
from lobula.errors import ParameterError

from .stand_ins import Adder, PlainEye, Scripted, world_of

LIVELY = World(
    robots=RobotParams(count=5, curvature_per_m=1, motor_noise=0.05),
    light=LightParams(course="flicker"),
    camera=CameraParams(auto_gain=True),
)


def simulation(world: World = LIVELY, controller: Any = None, seed: int = 3, **settings: Any) -> Simulation:
    return Simulation(world, controller or Adder(), seed, eye=PlainEye(), **settings)


def story(sim: Simulation, ticks: int) -> list[Any]:
    """Everything that can be told from outside of the next ``ticks``."""
    told = []
    for _ in range(ticks):
        avoiding, contacts = sim.tick()
        told += [sim.pose.tobytes(), sim.images.tobytes(), avoiding.tobytes(), contacts, sim.robots.tobytes()]
    return told


class TestDeterminism:
    def test_the_same_seed_is_the_same_run(self) -> None:
        assert story(simulation(), 400) == story(simulation(), 400)

    def test_another_seed_is_another(self) -> None:
        assert story(simulation(), 5) != story(simulation(seed=4), 5)

    def test_runs_beside_each_other_do_not_meddle(self) -> None:
        alone = story(simulation(), 100)
        first, other, told = simulation(), simulation(seed=8), []
        for _ in range(100):
            told += story(first, 1)
            story(other, 1)
        assert told == alone

    def test_controllers_are_compared_from_the_same_start(self) -> None:
        first, second = simulation(controller=NeverTurn()), simulation(controller=RandomTurn(60))
        np.testing.assert_array_equal(first.pose, second.pose)
        assert first.motion.speeds_cm_s == second.motion.speeds_cm_s


class TestSnapshot:
    @pytest.mark.parametrize("at", [0, 1, 77, 200])
    def test_the_rest_is_the_same_from_any_tick(self, at: int, tmp_path: Path) -> None:
        sim = simulation()
        story(sim, at)
        kept = sim.snapshot()
        rest, past = story(sim, 150), sim.past(2)
        save_snapshot(tmp_path / "run.npz", kept)
        for snapshot in (kept, load_snapshot(tmp_path / "run.npz")):
            again = simulation().resume(snapshot)
            assert again.tick_count == at
            assert story(again, 150) == rest
            assert_alike(again.past(2), past)

    def test_a_past_that_begins_before_the_snapshot_is_there(self) -> None:
        sim = simulation()
        story(sim, 100)
        again = simulation().resume(sim.snapshot())
        story(sim, 1)
        story(again, 1)
        assert_alike(again.past(1), sim.past(1))

    def test_with_networks_and_the_true_eye(self, tmp_path: Path) -> None:
        world = World(robots=RobotParams(count=2))

        def begin() -> Simulation:
            return Simulation(world, NetworkController(preset("published")), 5)

        sim = begin()
        story(sim, 40)
        save_snapshot(tmp_path / "run.npz", sim.snapshot())
        rest = story(sim, 60)
        assert story(begin().resume(load_snapshot(tmp_path / "run.npz")), 60) == rest

    def test_of_another_world_or_seed_is_refused(self) -> None:
        kept = simulation().snapshot()
        with pytest.raises(ParameterError, match="snapshot of seed 3: must be of 4"):
            simulation(seed=4).resume(kept)
        with pytest.raises(ParameterError, match="snapshot of world"):
            simulation(replace(LIVELY, room=RoomParams(width_cm=80))).resume(kept)

    def test_a_controller_without_state_says_so(self) -> None:
        sim = simulation(controller=Scripted())
        story(sim, 3)
        with pytest.raises(ControllerError, match=r"Scripted: has no state\(\) and set_state\(\)"):
            sim.snapshot()
        with pytest.raises(ControllerError, match="Scripted"):
            sim.resume(simulation().snapshot())


def assert_alike(first: Any, second: Any) -> None:
    for name in first._fields:
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


class TestDecisions:
    def test_act_at_once_and_only_while_the_queue_is_empty(self) -> None:
        controller = Scripted({4: [1], 10: [0, 1], 33: [1], 34: [1]})
        sim = simulation(world_of(2), controller, poses=np.array([[20.0, 20, 0], [20, 30, 0]]))
        acted = [sim.tick().avoiding.tolist() for _ in range(40)]
        when = {tick: said for tick, said in enumerate(acted) if any(said)}
        assert when == {4: [False, True], 10: [True, False], 34: [False, True]}
        assert sim.pose[1, 0] == pytest.approx(20 + 4 * 0.3)  # no way since tick 4

    def test_the_controller_is_told_who_turns(self) -> None:
        controller = Scripted({4: [0]})
        sim = simulation(world_of(), controller)
        for _ in range(40):
            sim.tick()
        assert [tick for tick, turning in enumerate(controller.told) if turning[0]] == list(range(5, 34))

    def test_who_always_turns_gets_nowhere(self) -> None:
        sim = simulation(world_of(3), AlwaysTurn())
        start = sim.pose[:, :2].copy()
        turns = sum(int(sim.tick().avoiding.sum()) for _ in range(300))
        assert turns == 3 * 10  # one a second
        np.testing.assert_array_equal(sim.pose[:, :2], start)

    def test_a_contact_makes_robots_stop_and_turn(self) -> None:
        sim = simulation(world_of(), NeverTurn(), poses=np.array([[67.9, 20.0, 0.0]]))
        assert len(sim.tick().contacts) == 1
        assert sim.motion.phases == [STOP]
        for _ in range(30):
            assert sim.tick().contacts == ()
        assert sim.motion.phases == [FORWARD]

    def test_a_contact_in_its_episode_is_not_told_again(self) -> None:
        # a turn of 0 to 20 degrees: it runs into the wall again at once, and again
        world = world_of()
        world = replace(world, turn=replace(world.turn, low_deg=0, high_deg=20))
        sim = simulation(world, NeverTurn(), poses=np.array([[67.9, 20.0, 0.0]]))
        assert sum(len(sim.tick().contacts) for _ in range(100)) == 1
        assert sim.pose[0, 0] == pytest.approx(68)

    def test_seeing_twice_changes_nothing(self) -> None:
        first, second = simulation(), simulation()
        for _ in range(20):
            np.testing.assert_array_equal(first.see(), first.see())
            first.tick()
            second.tick()
        assert first.pose.tobytes() == second.pose.tobytes()


class TestPast:
    def redraw(self, sim: Simulation, past: Any, robot: int) -> np.ndarray:
        count = len(past.times_s)
        own = np.full(count, robot)
        return sim.eye.views(past.poses[:, robot], past.poses, own=own, keys=past.keys, light=past.light)

    @pytest.mark.parametrize("ticks", [1, 5, 31, 60, 131])
    def test_it_can_be_drawn_and_answered_again(self, ticks: int) -> None:
        sim = simulation()
        seen, said = [], []
        for _ in range(ticks):
            tick = sim.tick()
            seen.append(sim.images.copy())
            said.append(tick.avoiding)
        past = sim.past(3)
        first = past.first_tick
        assert first == max(0, min(ticks - 1 - 30 - k for k in range(8) if (ticks - 31 - k) % 8 == 0)) or first == 0
        np.testing.assert_array_equal(past.times_s, np.arange(first, ticks) / 30)
        images = self.redraw(sim, past, 3)
        np.testing.assert_array_equal(images, np.array(seen)[first:, 3])
        again = sim.controller.replay(past.state, images, past.times_s, past.turning[:, 3])
        np.testing.assert_array_equal(again & ~past.turning[:, 3], np.array(said)[first:, 3])
        assert past.potentials is None

    def test_the_state_is_a_second_old_and_little_more(self) -> None:
        sim = simulation()
        for tick in range(200):
            sim.tick()
            past = sim.past(0)
            assert past.first_tick == 0 or 30 <= tick - past.first_tick <= 37
            assert past.times_s[-1] == pytest.approx(tick / 30)

    def test_with_networks_and_the_true_eye(self) -> None:
        world = World(robots=RobotParams(count=2))
        sim = Simulation(world, NetworkController(preset("published")), 5)
        potentials, seen = [], []
        for _ in range(50):
            sim.tick()
            potentials.append(sim.controller.potentials)
            seen.append(sim.images.copy())
        past = sim.past(1)
        np.testing.assert_array_equal(self.redraw(sim, past, 1), np.array(seen)[past.first_tick :, 1])
        np.testing.assert_array_equal(past.potentials, np.array(potentials)[past.first_tick :])

    def test_velocities_are_those_at_the_frame(self) -> None:
        controller = Scripted({5: [0], 6: [1]})
        poses = np.array([[20.0, 20.0, 0.5], [20.0, 40.0, 1.0]])
        sim = simulation(world_of(2), controller, poses=poses)
        for _ in range(7):
            sim.tick()
        velocities = sim.past(0).velocities_cm_s  # robot 0 stands since tick 5, robot 1 alarms in this frame
        np.testing.assert_allclose(velocities, [[0, 0], [9 * np.cos(1), 9 * np.sin(1)]])

    def test_less_may_be_asked_for(self) -> None:
        sim = simulation()
        story(sim, 100)
        assert 9 <= 99 - sim.past(0, 0.3).first_tick <= 16


class TestStart:
    def test_no_room(self) -> None:
        with pytest.raises(ParameterError, match="no room"):
            simulation(World(robots=RobotParams(count=200)))

    @pytest.mark.parametrize(
        "poses",
        [[[1, 20, 0], [30, 30, 0]], [[30, 20, 0], [33, 20, 0]], [[30, 20, 0]], [[30, 20, np.nan], [40, 40, 0]],
         [[80, 20, 0], [30, 30, 0]]],
    )  # fmt: skip
    def test_poses_that_cannot_be(self, poses: list[list[float]]) -> None:
        with pytest.raises(ParameterError, match="poses"):
            simulation(world_of(2), poses=np.array(poses))

    def test_a_controller_that_does_not_start(self) -> None:
        class Broken(NeverTurn):
            def start(self, robots: int, rng: np.random.Generator) -> None:
                raise OSError("no such model")

        with pytest.raises(ControllerError, match="Broken, at the start: raised OSError: no such model"):
            simulation(controller=Broken())

    def test_a_controller_cannot_change_who_turns(self) -> None:
        class Meddles(NeverTurn):
            def step(self, images: Any, time_s: float, turning: Any) -> Any:
                turning[:] = True
                return turning

        with pytest.raises(ControllerError, match=r"Meddles, tick 0 .* read-only"):
            simulation(controller=Meddles()).tick()

    def test_a_controller_that_breaks_leaves_the_robots_where_they_are(self) -> None:
        class Broken(NeverTurn):
            def step(self, images: Any, time_s: float, turning: Any) -> Any:
                return super().step(images, time_s, turning) if time_s < 0.1 else None

        sim = simulation(controller=Broken())
        story(sim, 3)
        before = sim.pose.copy()
        with pytest.raises(ControllerError, match=r"Broken, tick 3 \(0\.100 s\): returned shape"):
            sim.tick()
        np.testing.assert_array_equal(sim.pose, before)
        assert sim.tick_count == 3
