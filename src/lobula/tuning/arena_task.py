"""Calibration runs of the arena: some seeds to search on, others to score."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..arena.world import World
from ..errors import ParameterError
from .split import Split
from .task import ArenaTask

SEEDS, HELD_OUT_SEEDS = range(201, 203), range(251, 255)
MINUTES = 2.0
ROBOTS = (4, 7)
MOST_MINUTES = 1000.0
MOST_SEEDS = 1000

HOW = "other seeds: wall, places, speeds, turns and noise are all different"


def arena_task(
    seeds: Sequence[int] = SEEDS,
    held_out: Sequence[int] = HELD_OUT_SEEDS,
    minutes: float = MINUTES,
    robots: Sequence[int] = ROBOTS,
    world: World | None = None,
) -> ArenaTask:
    """Return the task: every seed with every number of robots, ``minutes`` of simulated time each.

    Raises
    ------
    ParameterError : seeds of the tests (7000 to 7999), seeds in both parts, none or too many; minutes or robots out of
        range
    """
    if not 0 < minutes <= MOST_MINUTES:
        raise ParameterError(f"{minutes:g} simulated minutes: must be above 0 and at most {MOST_MINUTES:g}")
    for part in (seeds, held_out):
        if len(part) > MOST_SEEDS:
            raise ParameterError(f"{len(part)} seeds: must be at most {MOST_SEEDS}")
    room = World() if world is None else world
    for count in robots:
        replace(room.robots, count=count)  # says now, not at the first trial, that there may not be so many
    runs = {_name(seed, count): (seed, count) for seed in (*seeds, *held_out) for count in robots}
    parts = [tuple(_name(seed, count) for seed in part for count in robots) for part in (seeds, held_out)]
    about = {"on": "arena", "seeds": list(seeds), "held_out_seeds": list(held_out), "simulated_minutes": minutes,
             "robots": list(robots), "held_out": HOW}  # fmt: skip
    return ArenaTask(runs, {"arena": Split(parts[0], parts[1])}, about, minutes, room)


def _name(seed: int, robots: int) -> str:
    return f"seed {seed}, {robots} robots"
