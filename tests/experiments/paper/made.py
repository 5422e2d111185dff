"""Trials made by hand: what four neurons would do if the paper were right in everything."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from lobula.experiments.paper.courses import FOUR, READINGS, SPEED_LABELS
from lobula.experiments.paper.fig6 import ANGLES_DEG
from lobula.experiments.paper.trials import MAIN, Trial
from lobula.types import NEURONS

SEEDS = range(10)

IDEAL = {
    "approach": {"lgmd1": 60, "lgmd2": 60, "lptc_r": 0, "lptc_l": 0},
    "recession": {"lgmd1": 8, "lgmd2": 0, "lptc_r": 0, "lptc_l": 0},
    "translation_right": {"lgmd1": 20, "lgmd2": 20, "lptc_r": 400, "lptc_l": 0},
    "translation_left": {"lgmd1": 20, "lgmd2": 20, "lptc_r": 0, "lptc_l": 400},
}


def made(figure: str, motion: str, spikes: dict[str, int], **changes: Any) -> Trial:
    """Return a trial in which the neurons gave ``spikes``, half of the LGMDs' within 200 ms."""
    signs = {"lgmd1": 0.7, "lgmd2": 0.7, "lptc_r": 0.2, "lptc_l": -0.2}
    quiet = {"lgmd1": 0.5, "lgmd2": 0.5, "lptc_r": 0.0, "lptc_l": 0.0}
    given: dict[str, Any] = {
        "figure": figure, "preset": "paper", "settings_hash": "s", "scene_hash": "w", "motion": motion, "setup": MAIN,
        "angle_deg": 0.0, "label": "s80", "reading": "motor", "speed_cm_s": 10.9, "seed": 0,
        "spikes": spikes, "spikes_course": spikes, "fastest": {n: spikes[n] // 2 for n in NEURONS},
        "peak": {n: signs[n] + 0.001 * spikes[n] * (1 if signs[n] > 0 else -1) if spikes[n] else quiet[n]
                 for n in NEURONS},
        "burst_s": dict.fromkeys(NEURONS, 0.3),
        "alarm_s": 2.0 if motion == "approach" else None,
        "lgmds_alarm_s": None if motion == "recession" else 2.0,
        "end_s": 3.0,
    }  # fmt: skip
    return Trial(**given | changes)


def four_courses(figure: str) -> list[Trial]:
    """Return ideal trials of the four courses at all speeds; the LGMDs spike more when it is faster."""
    trials = []
    for reading in READINGS:
        for step, (label, speed) in enumerate(zip(SPEED_LABELS, reading.speeds_cm_s, strict=True)):
            at = {"label": label, "reading": reading.name, "speed_cm_s": speed}
            for motion in FOUR:
                spikes = {n: c + 3 * step * bool(c) for n, c in IDEAL[motion].items()}
                trials += [made(figure, motion, spikes, seed=seed, **at) for seed in SEEDS]
    return trials


def angles() -> list[Trial]:
    """Return ideal trials of the angular approaches: LGMDs fall with the angle, the LPTC of the side rises."""
    trials = []
    for reading in READINGS:
        for label, speed in zip(SPEED_LABELS, reading.speeds_cm_s, strict=True):
            for angle in ANGLES_DEG:
                lgmds, lptc = int(60 - 0.7 * abs(angle)), int(abs(angle))
                spikes = {"lgmd1": lgmds, "lgmd2": lgmds, "lptc_r": lptc * (angle < 0), "lptc_l": lptc * (angle > 0)}
                trials += [
                    made("fig6", "angular", spikes, seed=seed, angle_deg=angle, label=label, reading=reading.name,
                         speed_cm_s=speed)
                    for seed in SEEDS
                ]  # fmt: skip
    return trials


def where(trials: list[Trial], wanted: Callable[[Trial], bool], **changes: Any) -> list[Trial]:
    """Return ``trials`` in which those that are ``wanted`` have ``changes``."""
    return [replace(t, **changes) if wanted(t) else t for t in trials]
