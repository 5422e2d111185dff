"""The arena as a PettingZoo environment: every robot an agent that sees its own picture.

    from lobula.arena.environment import ArenaEnv

    env = ArenaEnv(minutes=1)
    observations, infos = env.reset(seed=3)

Needs the extra ``pettingzoo``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import MissingExtraError, ParameterError, pip_install
from .contact import Contact
from .controller import Bools
from .events import KINDS
from .plan_picture import plan_picture
from .running import MOST_MINUTES
from .scorer import Scorer
from .scoring import Score
from .simulation import Simulation, Tick
from .wheels import WheelMotion
from .world import World

try:
    from gymnasium import spaces
    from pettingzoo import ParallelEnv
except ImportError as error:
    raise MissingExtraError(
        f"lobula.arena.environment needs gymnasium and pettingzoo: {pip_install('pettingzoo')}"
    ) from error

ACTIONS = ("avoid", "wheels")
RENDER_MODES = ("rgb_array",)


class _Commanded:
    """Stands where a controller would: decisions come from outside."""

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Needs nothing."""

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Bools:
        """Return no for every robot."""
        return np.zeros(len(turning), np.bool_)


class ArenaEnv(ParallelEnv[str, NDArray[np.uint8], Any]):
    """Robots in ``world``, named ``robot_0``, ``robot_1``, ...; a step is one camera frame.

    Observation: what the robot sees, (H, W, 1) uint8.

    Action "avoid": 0 goes on, 1 stops and turns by chance to either side, as in ``arena.run``; ignored while the robot
    stops or turns, and after a contact it turns by itself. Action "wheels": speeds of the left and right wheel, (2,)
    float32 in cm/s within +- ``world.robots.speed_high_cm_s``; what a robot touches stops it, nothing turns it.

    Reward: the way driven ahead in this step in cm (backwards counts below 0), less ``contact_cost_cm`` for each
    contact that the robot drove into or that another drove into it.

    Info: ``turning``, whether the next "avoid" would be ignored; ``distance_cm``, driven so far; ``events``, how many
    of each kind (CR, CP, AA, AT, AP, spurious) it took part in since the reset. Causes are by the geometric rule.

    All agents are truncated after ``minutes``; none ever terminates. ``reset(seed=n)`` begins the very run that
    ``arena.run(seed=n)`` has: the same places, speeds, stripes, noise and turns; ``reset()`` draws the next.

    Parameters
    ----------
    world : the arena; the paper's where nothing is given
    robots : their number, instead of the world's
    actions : "avoid" or "wheels"
    minutes : of simulated time
    contact_cost_cm : what a contact costs
    render_mode : "rgb_array": ``render`` returns the room from above, (H, W, 3) uint8
    engine : of the eye: ``core``, ``reference`` or ``auto``

    Raises
    ------
    ParameterError : an argument out of its range, a world without room for its robots
    """

    def __init__(
        self, world: World | None = None, *, robots: int | None = None, actions: str = "avoid", minutes: float = 1.0,
        contact_cost_cm: float = 20.0, render_mode: str | None = None, engine: str = "auto",
    ) -> None:  # fmt: skip
        if actions not in ACTIONS:
            raise ParameterError(f"actions {actions!r}: must be one of {', '.join(ACTIONS)}")
        if render_mode is not None and render_mode not in RENDER_MODES:
            raise ParameterError(f"render_mode {render_mode!r}: must be None or {RENDER_MODES[0]}")
        if not 0 < minutes <= MOST_MINUTES:
            raise ParameterError(f"minutes = {minutes!r}: must be above 0 and at most {MOST_MINUTES:g}")
        if not np.isfinite(contact_cost_cm):
            raise ParameterError(f"contact_cost_cm = {contact_cost_cm!r}: must be finite")
        world = world or World()
        if robots is not None:
            world = replace(world, robots=replace(world.robots, count=robots))
        self.world = world
        self.actions, self.minutes, self.contact_cost_cm = actions, minutes, contact_cost_cm
        self.render_mode, self.engine = render_mode, engine
        self.metadata = {
            "name": "lobula_arena_v0", "render_modes": list(RENDER_MODES), "is_parallelizable": True,
            "render_fps": self.world.camera.rate_hz,
        }  # fmt: skip
        self.possible_agents = [f"robot_{number}" for number in range(self.world.robots.count)]
        self.agents: list[str] = []
        camera, fastest = self.world.camera, self.world.robots.speed_high_cm_s
        shape = (camera.height_px, camera.width_px, 1)
        self.observation_spaces = {agent: spaces.Box(0, 255, shape, np.uint8) for agent in self.possible_agents}
        self.action_spaces = {
            agent: spaces.Discrete(2) if actions == "avoid" else spaces.Box(-fastest, fastest, (2,), np.float32)
            for agent in self.possible_agents
        }
        self._ticks = max(1, round(minutes * 60 * camera.rate_hz))
        self._seeds = np.random.default_rng()
        self._simulation: Simulation | None = None

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return the agent's space of pictures."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return the agent's space of actions."""
        return self.action_spaces[agent]

    @property
    def simulation(self) -> Simulation:
        """The run under way; look, but change nothing.

        Raises
        ------
        ParameterError : before the first ``reset``
        """
        if self._simulation is None:
            raise ParameterError("ArenaEnv: no run yet: must be reset first")
        return self._simulation

    @property
    def score(self) -> Score:
        """The score since the reset."""
        self._require_run()
        return self._scorer.score()

    @property
    def events(self) -> NDArray[Any]:
        """The events since the reset, ``arena.events.EVENT_DTYPE``."""
        self._require_run()
        return self._scorer.events

    def reset(
        self, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.uint8]], dict[str, dict[str, Any]]]:
        """Begin a new run and return what everybody sees, and the infos; there are no ``options``."""
        if seed is not None:
            self._seeds = np.random.default_rng(seed)
        else:
            seed = int(self._seeds.integers(10_000, 2**31))
        simulation = Simulation(self.world, _Commanded(), seed, engine=self.engine)
        if self.actions == "wheels":
            chance = simulation.chance
            simulation.motion = WheelMotion(self.world, simulation.pose, chance.robots, chance.motors)
        self._simulation, self._scorer = simulation, Scorer(simulation)
        self._counts = [dict.fromkeys(KINDS, 0) for _ in self.possible_agents]
        self.agents = list(self.possible_agents)
        return self._observations(), self._infos()

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        dict[str, NDArray[np.uint8]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:
        """Go through one camera frame; return observations, rewards, terminations, truncations and infos.

        Raises
        ------
        ParameterError : before ``reset`` or after the end, or an action missing or not in its space
        """
        simulation = self.simulation
        if not self.agents:
            raise ParameterError("ArenaEnv.step: the run has ended: must be reset first")
        avoiding = self._command(actions) & ~simulation.motion.turning
        before = simulation.pose.copy()
        contacts = simulation.move(avoiding)
        self._scorer.tick(Tick(avoiding, contacts))
        rewards = self._rewards(before, contacts)
        self._count(int(avoiding.sum()) + len(contacts))
        ended = simulation.tick_count >= self._ticks
        now = self.agents
        observations, infos = self._observations(), self._infos()
        if ended:
            self.agents = []
        return observations, rewards, dict.fromkeys(now, False), dict.fromkeys(now, ended), infos

    def render(self) -> NDArray[np.uint8] | None:
        """Return the room from above, (H, W, 3) uint8, where ``render_mode`` is "rgb_array"."""
        if self.render_mode is None:
            return None
        return plan_picture(self.world, self.simulation.pose, self.simulation.motion.turning)

    def close(self) -> None:
        """Do nothing: no window, no file is open."""

    def _require_run(self) -> None:
        _ = self.simulation

    def _command(self, actions: Mapping[str, Any]) -> Bools:
        """Pass the actions on; return who is to avoid."""
        for agent in self.agents:
            if agent not in actions:
                raise ParameterError(f"ArenaEnv.step: no action for {agent}: must be one for each of the agents")
            if not self.action_spaces[agent].contains(actions[agent]):
                raise ParameterError(
                    f"ArenaEnv.step: action {actions[agent]!r} for {agent}: must be in {self.action_spaces[agent]}"
                )
        if self.actions == "avoid":
            return np.array([bool(actions[agent]) for agent in self.agents])
        motion = self.simulation.motion
        assert isinstance(motion, WheelMotion)
        motion.command(np.array([actions[agent] for agent in self.agents], np.float64))
        return np.zeros(len(self.agents), np.bool_)

    def _rewards(self, before: NDArray[np.float64], contacts: tuple[Contact, ...]) -> dict[str, float]:
        way, heading = self.simulation.pose[:, :2] - before[:, :2], before[:, 2]
        rewards = way[:, 0] * np.cos(heading) + way[:, 1] * np.sin(heading)
        for contact in contacts:
            for robot in (contact.robot, contact.other):
                if robot >= 0:  # not the wall, nor an obstacle
                    rewards[robot] -= self.contact_cost_cm
        return dict(zip(self.agents, rewards.tolist(), strict=True))

    def _count(self, number: int) -> None:
        """Note the newest events with everybody who took part."""
        for event in self._scorer.newest(number):
            kind, other = str(event["kind"]), int(event["other"])
            self._counts[event["robot"]][kind] += 1
            if kind == "CR":
                self._counts[other][kind] += 1

    def _observations(self) -> dict[str, NDArray[np.uint8]]:
        images = self.simulation.see()[..., None]
        return dict(zip(self.agents, images, strict=True))

    def _infos(self) -> dict[str, dict[str, Any]]:
        motion = self.simulation.motion
        columns = zip(self.agents, motion.turning.tolist(), motion.distances_cm, self._counts, strict=True)
        return {
            agent: {"turning": turns, "distance_cm": driven, "events": dict(counts)}
            for agent, turns, driven, counts in columns
        }
