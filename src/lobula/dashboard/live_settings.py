"""The settings that may be changed while the detector runs: which they are, their present values, who made them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

from ..errors import ParameterError
from ..model.network import NetworkParams
from ..params import nearest, settings_hash, with_settings
from ..runtime.header import setting_rows, thresholds

SOURCE = "dashboard"
"""Origin of a value that was set here, as ``lobula config show`` would name it."""

LABELS: Mapping[str, tuple[str, str]] = {
    "decision.collision_spikes": ("alarm", "Spikes for an alarm"),
    "decision.lptc_weight": ("alarm", "Weight of translation"),
    "decision.window_ms": ("alarm", "Window"),
    "decision.neurons": ("alarm", "Who decides"),
    "lgmd1.spiking.threshold": ("spiking", "LGMD-1 threshold"),
    "lgmd2.spiking.threshold": ("spiking", "LGMD-2 threshold"),
    "lptc.spiking.threshold": ("spiking", "LPTC threshold"),
    "lgmd1.sigmoid_grey": ("sigmoid", "LGMD-1 C_sig"),
    "lgmd2.sigmoid_grey": ("sigmoid", "LGMD-2 C_sig"),
    "lptc.sigmoid_grey2": ("sigmoid", "LPTC K_hs"),
    "lgmd1.spiking.gain": ("more", "LGMD-1 K_sp"),
    "lgmd2.spiking.gain": ("more", "LGMD-2 K_sp"),
    "lptc.spiking.gain": ("more", "LPTC K_sp"),
    "decision.end_ms": ("more", "Alarm lasts"),
    "decision.warm_up_ms": ("more", "Warm-up"),
    "decision.turning_deg_s": ("more", "Turning from"),
    "decision.after_turn_ms": ("more", "After a turn"),
}
"""Setting -> its group on the page and what it is called there. What the network remembers does not hang on them, so
they can change between two frames."""

_SLIDERS: Mapping[str, tuple[float, float]] = {
    "decision.collision_spikes": (1, 20),
    "decision.lptc_weight": (0, 4),
    "decision.turning_deg_s": (1, 360),
}
"""Where the useful stretch is shorter than the allowed one; the number beside the slider takes all that is allowed."""

_DECADES = 30.0  # a slider of a sigmoid reaches from the start value over this to the start value times this


class LiveSettings:
    """The present ``params``, one immutable value: any thread reads it, viewers replace it through ``change``."""

    def __init__(self, params: NetworkParams, preset: str) -> None:
        self.preset = preset
        self.params = self.start = params
        self.version = 0
        self._lock = threading.Lock()
        self._listeners: list[Callable[[], None]] = []

    def listen(self, listener: Callable[[], None]) -> None:
        """Have ``listener`` called after every change, by the thread that made it."""
        self._listeners.append(listener)

    def change(self, values: Mapping[str, Any]) -> None:
        """Set each path of ``values``, all or none.

        Raises
        ------
        ParameterError : a setting that is not one of these, or a value that is not allowed
        """
        nested: dict[str, Any] = {}
        for path, value in values.items():
            if path not in LABELS:
                raise ParameterError(f"setting {path}: cannot be changed here{nearest(path, LABELS)}")
            *groups, name = path.split(".")
            inner = nested
            for group in groups:
                inner = inner.setdefault(group, {})
            inner[name] = value
        with self._lock:
            self._take(with_settings(self.params, nested, SOURCE))

    def restore(self) -> None:
        """Go back to the settings of the start."""
        with self._lock:
            self._take(self.start)

    def described(self) -> list[dict[str, Any]]:
        """Return one entry a setting for the page: group, label, range, meaning, slider, value at the start."""
        entries = []
        rows = {row["path"]: row for row in setting_rows(self.start)}
        for path, (group, label) in LABELS.items():
            row = rows[path]
            about = {key: row[key] for key in ("path", "unit", "low", "high", "choices", "meaning", "source")}
            entries.append({
                **about, "group": group, "label": label, "start": row["value"],
                "whole": isinstance(row["value"], int), "slider": _slider(path, row),
            })  # fmt: skip
        return entries

    def values(self) -> dict[str, Any]:
        """Return what changes: the present values, the spiking thresholds, the settings hash, the version."""
        params, version = self.params, self.version
        present = {row["path"]: row["value"] for row in setting_rows(params) if row["path"] in LABELS}
        return {
            "version": version,
            "values": present,
            "thresholds": thresholds(params),
            "settings_hash": settings_hash(params),
        }

    def _take(self, params: NetworkParams) -> None:
        if params == self.params:
            return
        self.params = params
        self.version += 1
        for listener in self._listeners:
            listener()


def changes(before: NetworkParams, after: NetworkParams) -> dict[str, tuple[Any, Any]]:
    """Return the settings of ``LABELS`` that differ: path -> value before and after."""
    was, now = ({row["path"]: row["value"] for row in setting_rows(p)} for p in (before, after))
    return {path: (was[path], now[path]) for path in LABELS if was[path] != now[path]}


def _slider(path: str, row: Mapping[str, Any]) -> dict[str, Any] | None:
    """Ends and kind of the slider of a setting; None where it has choices instead."""
    if row["choices"] is not None:
        return None
    low, high, value = row["low"], row["high"], row["value"]
    if ".sigmoid_" in path:
        return {"low": max(low, value / _DECADES), "high": min(high, value * _DECADES), "log": True}
    low, high = _SLIDERS.get(path, (low, high))
    return {"low": min(low, value), "high": max(high, value), "log": False}
