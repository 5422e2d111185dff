"""Worlds as TOML files: what a file does not name is as in the paper's arena.

[room]
shape = "circle"
radius_cm = 40

[[obstacles]]
x_cm = 40
y_cm = 40
"""

from __future__ import annotations

import json
import os
import tomllib
from dataclasses import replace
from pathlib import Path

from ..errors import ParameterError
from ..params import Params, walk, with_settings
from .world import Obstacle, World


def load_world(path: str | os.PathLike[str]) -> World:
    """Return the world of a TOML file. A wall pattern's picture is looked for beside it.

    Raises
    ------
    ParameterError : no such file, no TOML, an unknown setting (the nearest is suggested), or one out of its range
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "is no text"
        raise ParameterError(f"world file {path}: {reason}") from error
    world = parse_world(text, f"world file {path}")
    if world.wall.file:
        world = replace(world, wall=replace(world.wall, file=str(path.parent / world.wall.file)))
    return world


def parse_world(text: str, source: str) -> World:
    """Return the world that TOML ``text`` describes; ``source`` names it in messages and as its settings' origin.

    Raises
    ------
    ParameterError : as ``load_world``
    """
    try:
        settings = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ParameterError(f"{source}: is not TOML: {error}") from error
    given = settings.pop("obstacles", [])
    try:
        if not isinstance(given, list) or not all(isinstance(each, dict) for each in given):
            raise ParameterError(f"obstacles = {given!r}: must be tables, each under [[obstacles]]")
        obstacles = tuple(
            with_settings(Obstacle(), each, source, f"obstacles[{number}].") for number, each in enumerate(given)
        )
        world: World = replace(with_settings(World(), settings, source), obstacles=obstacles)
        return world
    except ParameterError as error:
        raise ParameterError(f"{source}: {error}") from error


def world_toml(world: World) -> str:
    """Return all settings of ``world`` as TOML, each with its meaning, range and origin; ``parse_world`` reads it."""
    lines = ["# A world of lobula's arena. Lines may be left out: the value of the paper's arena holds then."]
    group = ""
    for path, owner, name in walk(world):
        if path.split(".")[0] != group:
            group = path.split(".")[0]
            lines += ["", f"[{group}]"]
        lines.append(_line(owner, name))
    for obstacle in world.obstacles:
        lines += ["", "[[obstacles]]", *(_line(owner, name) for _, owner, name in walk(obstacle))]
    return "\n".join(lines) + "\n"


def _line(owner: Params, name: str) -> str:
    about = type(owner).__dataclass_fields__[name].metadata
    allowed = "|".join(about["choices"] or ())
    if about["low"] is not None:
        allowed = f"{about['low']:g}..{about['high']:g} {about['unit']}".rstrip()
    remark = "; ".join(part for part in (about["doc"], allowed, owner.source_of(name)) if part)
    value = getattr(owner, name)
    return f"{name} = {json.dumps(list(value) if isinstance(value, tuple) else value)}  # {remark}"
