"""The arena as a PettingZoo environment."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from lobula import arena
from lobula.arena.world import CameraParams, RobotParams, RoomParams, World
from lobula.errors import MissingExtraError, ParameterError

try:
    from pettingzoo.test import parallel_api_test, parallel_seed_test

    from lobula.arena.environment import ArenaEnv
except ImportError:
    ArenaEnv = None

needs_pettingzoo = pytest.mark.skipif(ArenaEnv is None, reason="the extra pettingzoo is not installed")
SMALL = World(camera=CameraParams(width_px=33, height_px=24), robots=RobotParams(count=3))


def test_without_the_extra_the_message_tells_how_to_get_it(monkeypatch):
    monkeypatch.delitem(sys.modules, "lobula.arena.environment", raising=False)
    monkeypatch.setitem(sys.modules, "pettingzoo", None)
    with pytest.raises(MissingExtraError, match=r'pip install "lobula\[pettingzoo\]"'):
        import lobula.arena.environment  # noqa: F401  the import is the test
    monkeypatch.delitem(sys.modules, "lobula.arena.environment", raising=False)


@needs_pettingzoo
@pytest.mark.parametrize("actions", ["avoid", "wheels"])
class TestContract:
    def test_api(self, actions, recwarn):
        parallel_api_test(ArenaEnv(SMALL, actions=actions, minutes=0.02), num_cycles=60)
        assert not [str(one.message) for one in recwarn]

    def test_seeds(self, actions):
        parallel_seed_test(lambda: ArenaEnv(SMALL, actions=actions, minutes=0.02), num_cycles=60)


@needs_pettingzoo
class TestRun:
    def test_the_network_scores_as_in_arena_run(self):
        """Decisions made outside, on the observations, lead to the very run that ``arena.run`` has."""
        env, network = ArenaEnv(robots=4, minutes=0.15), arena.NetworkController()
        observations, infos = env.reset(seed=7)
        network.start(4, np.random.default_rng(0))
        while env.agents:
            images = np.stack([observations[agent][..., 0] for agent in env.agents])
            turning = np.array([infos[agent]["turning"] for agent in env.agents])
            said = network.step(images, env.simulation.time_s, turning)
            actions = {agent: int(avoid) for agent, avoid in zip(env.agents, said, strict=True)}
            observations, _, _, truncations, infos = env.step(actions)
        own = arena.run(robots=4, minutes=0.15, seed=7)
        assert all(truncations.values())
        assert (
            env.events[["tick", "robot", "geometric"]].tolist() == own.events[["tick", "robot", "geometric"]].tolist()
        )
        assert env.score.as_dict()["distance_cm"] == own.score.distance_cm
        assert len(own.events) > 3
        assert env.score.rule == "geometric"

    def test_rewards_are_the_way_less_contacts(self):
        env = ArenaEnv(robots=2, minutes=0.5, contact_cost_cm=7.0)
        env.reset(seed=3)
        total = dict.fromkeys(env.agents, 0.0)
        while env.agents:
            _, rewards, _, _, infos = env.step(dict.fromkeys(env.agents, 0))
            for agent, reward in rewards.items():
                total[agent] += reward
        for agent, info in infos.items():
            contacts = info["events"]["CR"] + info["events"]["CP"]
            assert contacts > 0
            assert total[agent] == pytest.approx(info["distance_cm"] - 7 * contacts)
        assert sum(info["events"]["CP"] for info in infos.values()) == env.score.cp
        assert sum(info["events"]["CR"] for info in infos.values()) == 2 * env.score.cr

    def test_every_reset_is_another_run_and_a_seed_brings_one_back(self):
        env = ArenaEnv(SMALL)
        starts = []
        for seed in (5, None, None, 5, None):
            env.reset(seed=seed)
            starts.append(env.simulation.pose.tolist())
        assert starts[0] == starts[3]
        assert starts[1] == starts[4]
        assert len({str(start) for start in starts}) == 3

    def test_avoiding_turns_and_is_told(self):
        env = ArenaEnv(SMALL)
        env.reset(seed=5)
        _, _, _, _, infos = env.step({"robot_0": 1, "robot_1": 0, "robot_2": 0})
        assert [info["turning"] for info in infos.values()] == [True, False, False]
        assert sum(infos["robot_0"]["events"].values()) == 1
        heading = env.simulation.pose[0, 2]
        for _ in range(40):
            env.step(dict.fromkeys(env.agents, 0))
        assert abs(env.simulation.pose[0, 2] - heading) > 0.5


@needs_pettingzoo
class TestWheels:
    def test_they_go_where_they_are_sent_and_stop_at_the_wall(self):
        env = ArenaEnv(replace(SMALL, robots=RobotParams(count=1)), actions="wheels", minutes=1)
        env.reset(seed=5)
        rewards = []
        heading = env.simulation.pose[0, 2]
        for _ in range(600):  # 20 s at 8 cm/s: longer than the room
            _, reward, _, _, infos = env.step({"robot_0": np.array([8.0, 8.0], np.float32)})
            rewards.append(reward["robot_0"])
        assert rewards[0] == pytest.approx(8 / 30)
        assert rewards[-1] == pytest.approx(0.0)
        assert infos["robot_0"]["events"]["CP"] == 1  # one touch, however long it pushes
        assert env.simulation.pose[0, 2] == heading
        _, reward, _, _, _ = env.step({"robot_0": np.array([-8.0, -8.0], np.float32)})
        assert reward["robot_0"] == pytest.approx(-8 / 30)


@needs_pettingzoo
class TestPicture:
    @pytest.mark.parametrize("shape", ["box", "circle"])
    def test_the_room_from_above(self, shape):
        env = ArenaEnv(replace(SMALL, room=RoomParams(shape=shape)), render_mode="rgb_array")
        env.reset(seed=5)
        picture = env.render()
        size_cm = (72, 57) if shape == "box" else (72, 72)
        assert (picture.shape, picture.dtype) == ((size_cm[1] * 8, size_cm[0] * 8, 3), np.uint8)
        for x, y, heading in env.simulation.pose:
            x, y = x + 1.5 * np.cos(heading + np.pi), y + 1.5 * np.sin(heading + np.pi)  # behind the middle: body
            row, column = int((size_cm[1] - 1 - y) * 8), int((x + 1) * 8)
            assert picture[row, column].tolist() == [139, 166, 201]

    def test_none_unless_asked_for(self):
        env = ArenaEnv(SMALL)
        env.reset(seed=5)
        assert env.render() is None


@needs_pettingzoo
class TestBadInput:
    @pytest.mark.parametrize(
        ("given", "words"),
        [
            ({"actions": "fly"}, "actions 'fly': must be one of avoid, wheels"),
            ({"render_mode": "human"}, "render_mode 'human': must be None or rgb_array"),
            ({"minutes": 0}, "minutes = 0: must be above 0"),
            ({"contact_cost_cm": float("nan")}, "contact_cost_cm = nan"),
            ({"robots": 0}, "RobotParams.count = 0"),
        ],
    )
    def test_arguments(self, given, words):
        with pytest.raises(ParameterError, match=words):
            ArenaEnv(**given)

    def test_no_room_for_the_robots(self):
        with pytest.raises(ParameterError):
            ArenaEnv(World(room=RoomParams(width_cm=10, depth_cm=10)), robots=9).reset(seed=5)

    def test_steps_that_cannot_be(self):
        env = ArenaEnv(SMALL, minutes=0.001)
        with pytest.raises(ParameterError, match="must be reset first"):
            env.step({})
        env.reset(seed=5)
        with pytest.raises(ParameterError, match="no action for robot_0"):
            env.step({})
        with pytest.raises(ParameterError, match="action 2 for robot_1"):
            env.step({"robot_0": 0, "robot_1": 2, "robot_2": 0})
        while env.agents:
            env.step(dict.fromkeys(env.agents, 0))
        with pytest.raises(ParameterError, match="has ended: must be reset"):
            env.step({})

    def test_wheels_out_of_range(self):
        env = ArenaEnv(SMALL, actions="wheels")
        env.reset(seed=5)
        with pytest.raises(ParameterError, match="robot_0: must be in Box"):
            env.step(dict.fromkeys(env.agents, np.array([99.0, 0.0], np.float32)))
