"""Small robots in a room, each with a camera and a controller: the paper's arena, or one of your own.

    from lobula import arena

    result = arena.run(minutes=5, seed=3)
    print(result.score)

Each name below is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .controller import Controller, ControllerError
    from .controls import AlwaysTurn, NeverTurn, RandomTurn
    from .course import Run
    from .each_robot import EachRobot
    from .eye import Eye
    from .network_controller import NetworkController
    from .record import Record, load_record
    from .running import RunInterrupted, run
    from .scene import Scene, build_scene
    from .scoring import Score
    from .simulation import Simulation
    from .world import World
    from .world_file import load_world, world_toml

__all__ = [
    "AlwaysTurn",
    "Controller",
    "ControllerError",
    "EachRobot",
    "Eye",
    "NetworkController",
    "NeverTurn",
    "RandomTurn",
    "Record",
    "Run",
    "RunInterrupted",
    "Scene",
    "Score",
    "Simulation",
    "World",
    "build_scene",
    "load_record",
    "load_world",
    "run",
    "world_toml",
]

_HOMES = {
    "AlwaysTurn": "controls",
    "Controller": "controller",
    "ControllerError": "controller",
    "EachRobot": "each_robot",
    "Eye": "eye",
    "NetworkController": "network_controller",
    "NeverTurn": "controls",
    "RandomTurn": "controls",
    "Record": "record",
    "Run": "course",
    "RunInterrupted": "running",
    "Scene": "scene",
    "Score": "scoring",
    "Simulation": "simulation",
    "World": "world",
    "build_scene": "scene",
    "load_record": "record",
    "load_world": "world_file",
    "run": "running",
    "world_toml": "world_file",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    globals()[name] = value  # found at once the next time
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
