"""The events of a run as lines for people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..runtime.sinks import Picture
from ..types import Reading
from .counted import counted
from .progress import Say


class Narrator:
    """A sink that says what happens, through ``say``."""

    def __init__(self, say: Say) -> None:
        self._say = say
        self._started: dict[int, float] = {}

    def open(self, header: Mapping[str, Any]) -> None:
        """Say what is looked at."""
        self._say(
            f"{header['source']}: {header['width']} x {header['height']} px, preset {header['preset']}, "
            f"neurons {header['neurons']}, settings {header['settings_hash']}, engine {header['engine']}"
        )

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Say nothing."""

    def event(self, record: Mapping[str, Any]) -> None:
        """Say when something starts, and of a collision, a lost source or a hook's trouble when it ended."""
        at = f"{record['time_s']:8.3f} s  frame {record['frame']:<6}"
        if record["type"] == "hook":
            self._say(f"{at} hook {record['hook']}: {_hook_text(record)}")
        elif record["type"] == "motor":
            self._say(f"{at} wheels: {record['action'].replace('_', ' ')}")
        elif record["type"] == "source":
            text = _source_text(record)
            if text:
                self._say(f"{at} {text}")
        elif record["type"] == "state":
            if record["phase"] == "start":
                self._say(f"{at} {str(record['state']).replace('_', ' ')}")
        elif record["phase"] == "start":
            self._started[record["id"]] = record["time_s"]
            potentials = f"LGMD-1 {record['lgmd1']:.2f}, LGMD-2 {record['lgmd2']:.2f}"
            self._say(f"{at} COLLISION {record['id']}: {potentials}")
        else:
            lasted_s = record["time_s"] - self._started.pop(record["id"])
            self._say(
                f"{at} collision {record['id']} over after {lasted_s:.2f} s, peak at frame {record['peak_frame']}"
            )

    def close(self, summary: Mapping[str, Any]) -> None:
        """Say how it ended; of a run that looked at nothing the reason says it all."""
        if not summary["frames"]:
            return
        text = (
            f"{summary['status'].replace('_', ' ')}: {counted(summary['frames'], 'frame')}, "
            f"{counted(summary['collisions'], 'collision')}"
        )
        if summary["dropped"]:
            text += f", {summary['dropped']} dropped"
        if summary["damaged"]:
            text += f", {summary['damaged']} damaged"
        self._say(f"{text}, {summary['ms_per_frame']:.3f} ms a frame (worst {summary['ms_worst']:.1f})")
        if "latency_ms" in summary:
            text = f"{summary['latency_ms']:.1f} ms from capture to decision (worst {summary['latency_ms_worst']:.1f})"
            self._say(text + (f"; {_away(summary)}" if summary["lost"] else ""))
        elif summary.get("lost"):
            self._say(_away(summary))
        for hook in summary.get("hooks", ()):
            if hook["dropped"]:
                self._say(f"hook {hook['hook']}: {hook['sent']} sent, {hook['dropped']} lost: {hook['problem']}")


def _source_text(record: Mapping[str, Any]) -> str:
    """What became of a source; of many tries the first, second, fourth, eighth and so on are told."""
    if record["phase"] == "lost":
        return f"source lost: {record['reason']}"
    if record["phase"] == "back":
        return f"source back after {record['away_s']:.1f} s, at try {record['attempt']}"
    if record["phase"] == "resized":
        return f"pictures are {record['width']} x {record['height']} px now: the network begins anew"
    if record["phase"] == "restarted":
        return "the robot was switched on anew"
    if record["phase"] == "settings":
        return f"the robot has other settings now: preset {record['preset']}, settings {record['settings_hash']}"
    attempt = record["attempt"]
    return "" if attempt & (attempt - 1) else f"try {attempt} failed: {record['reason']}"


def _away(summary: Mapping[str, Any]) -> str:
    return f"lost {counted(summary['lost'], 'time')}, away {summary['away_s']:.1f} s"


def _hook_text(record: Mapping[str, Any]) -> str:
    if record["phase"] == "start":
        return str(record["problem"])
    return f"works again, {counted(record['dropped'], 'message')} lost"
