"""The jobs of Table I: three models, two densities, all seeds; and controllers that do not look, for comparison."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ...arena.world import World
from ...model.network import NetworkParams
from ...params import with_settings
from .jobs import Control, Done, Job
from .paper_table import DENSITIES, LABELS
from .tables import Group, group

CONTROLS = {"always": "always-turn", "never": "never-turn", "random": "random-turn"}
"""Kinds of ``Control`` and their names in the table."""

CONTROL_SHARE = 6
"""Controls run a sixth of the time: their rates are far from everything else."""

Groups = Mapping[tuple[str, int], Group]
"""Results by model and robots."""


@dataclass(frozen=True, kw_only=True)
class TablePlan:
    """What is run: base presets by name, seeds, simulated minutes of each run, the arena, and our own models by name.

    Of a base preset the paper's three models are run, of our own only what they are.
    """

    presets: Mapping[str, NetworkParams]
    own: Mapping[str, NetworkParams] = field(default_factory=dict)
    seeds: Sequence[int]
    minutes: float = 60.0
    densities: Sequence[int] = DENSITIES
    world: World = field(default_factory=World)

    @property
    def model_count(self) -> int:
        """Models and controls."""
        return len(self.presets) * len(LABELS) + len(self.own) + len(CONTROLS)

    @property
    def job_count(self) -> int:
        """Jobs of the whole table."""
        return self.model_count * len(self.densities) * len(self.seeds)


def model_name(preset: str, neurons: str) -> str:
    """Return the name of a model in files and tables."""
    return f"{preset}-{neurons}"


def model_jobs(plan: TablePlan) -> Iterator[Job]:
    """Yield the jobs of every model, density and seed."""
    for preset, params in plan.presets.items():
        for neurons in LABELS:
            selected = with_settings(params, {"decision": {"neurons": neurons}}, "chosen by the table")
            for robots, seed in _cells(plan):
                yield _job(plan, model_name(preset, neurons), selected, robots, seed, plan.minutes)
    for name, params in plan.own.items():
        for robots, seed in _cells(plan):
            yield _job(plan, name, params, robots, seed, plan.minutes)


def control_jobs(plan: TablePlan, results: Iterable[Done]) -> Iterator[Job]:
    """Yield the jobs of the controls; random turns are as frequent as those of the first preset's proposed model.

    ``results`` are those of the models: each random job takes its rate from that of the same robots and seed.
    """
    like = model_name(next(iter(plan.presets)), "all")
    rates = {(done.job.robots, done.job.seed): _turns_per_minute(done) for done in results if done.job.model == like}
    for kind, name in CONTROLS.items():
        for robots, seed in _cells(plan):
            control = Control(kind, rates[robots, seed] if kind == "random" else 0.0)
            yield _job(plan, name, control, robots, seed, plan.minutes / CONTROL_SHARE)


def grouped(results: Iterable[Done]) -> Groups:
    """Return the results by model and robots."""
    sorted_out: dict[tuple[str, int], list[Done]] = {}
    for done in results:
        sorted_out.setdefault((done.job.model, done.job.robots), []).append(done)
    return {key: group(some) for key, some in sorted_out.items()}


def _cells(plan: TablePlan) -> Iterator[tuple[int, int]]:
    for robots in plan.densities:
        for seed in plan.seeds:
            yield robots, seed


def _job(plan: TablePlan, model: str, driver: NetworkParams | Control, robots: int, seed: int, minutes: float) -> Job:
    world = replace(plan.world, robots=replace(plan.world.robots, count=robots))
    return Job(name=f"{model}-{robots}-{seed}", model=model, world=world, seed=seed, minutes=minutes, driver=driver)


def _turns_per_minute(done: Done) -> float:
    """Avoidances in a minute of driving ahead: the time of every turn, after contacts too, is taken off."""
    score, turn = done.score, done.job.world.turn
    avoided = score.aa + score.at + score.ap + score.spurious
    turns = avoided + score.cp + 2 * score.cr
    driving = score.robot_minutes - turns * (turn.stop_s + turn.turn_s) / 60
    return avoided / driving if driving > 0 else 0.0
