"""The first record of a run: what it reads, with which settings, and where each of them comes from."""

from __future__ import annotations

from typing import Any

from .._version import __version__
from ..frames.source import FrameSource
from ..model.network import NetworkParams
from ..params import settings_hash, walk
from ..types import Neuron
from .events import Record


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
