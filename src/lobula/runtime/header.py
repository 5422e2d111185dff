"""The first record of a run: what it reads, with which settings, and where each of them comes from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..frames.source import FrameSource
from ..model.network import NetworkParams
from ..model.presets import PRESETS, preset
from ..params import settings_hash, walk
from ..types import NEURONS, Neuron
from .events import Record

if TYPE_CHECKING:
    from .robot import RobotStream


def run_header(source: FrameSource, params: NetworkParams, *, preset: str, engine: str) -> Record:
    """Return the header that every output of a run is given.

    ``settings`` holds one row for each setting (path, value, unit, meaning, source), ``thresholds`` the potential at
    which each neuron starts to spike; the NDJSON output leaves both out.
    """
    return {
        "type": "header",
        "version": __version__,
        "preset": preset,
        "neurons": params.decision.neurons,
        "settings_hash": settings_hash(params),
        "engine": engine,
        "source": source.name,
        "width": source.width,
        "height": source.height,
        "fps": round(float(source.fps), 6),
        "thresholds": thresholds(params),
        "settings": setting_rows(params),
    }


def robot_header(robot: RobotStream) -> Record:
    """Return the header of a robot's run, as far as it says what it is: the engine is the robot.

    ``settings`` are those of the preset it names where the hash agrees, else none: the robot tells no more.
    """
    hello = robot.hello
    known = preset(hello.preset) if hello.preset in PRESETS else None
    same = known is not None and settings_hash(known) == hello.settings_hash
    return {
        "type": "header",
        "version": hello.version,
        "preset": hello.preset,
        "neurons": hello.neurons,
        "settings_hash": hello.settings_hash,
        "engine": "robot",
        "source": robot.name,
        "width": robot.width,
        "height": robot.height,
        "fps": round(float(robot.fps), 6),
        "thresholds": dict(zip(NEURONS, hello.thresholds, strict=True)),
        "settings": setting_rows(known) if known is not None and same else [],
    }


def thresholds(params: NetworkParams) -> dict[Neuron, float]:
    """Return the spiking threshold of each neuron, in the sign of its potential."""
    lptc = params.lptc.spiking.threshold
    return {
        "lgmd1": params.lgmd1.spiking.threshold,
        "lgmd2": params.lgmd2.spiking.threshold,
        "lptc_r": lptc,
        "lptc_l": -lptc,
    }


def setting_rows(params: NetworkParams) -> list[dict[str, Any]]:
    """Return one row for each setting, in the order they are declared."""
    rows = []
    for path, owner, name in walk(params):
        about = type(owner).__dataclass_fields__[name].metadata
        value = getattr(owner, name)
        rows.append({
            "path": path, "value": list(value) if isinstance(value, tuple) else value, "unit": about["unit"],
            "low": about["low"], "high": about["high"],
            "choices": None if about["choices"] is None else list(about["choices"]),
            "meaning": about["doc"], "source": owner.source_of(name),
        })  # fmt: skip
    return rows
