"""One course, filmed by the arena's eye from one seed and shown to the network: a trial, and a table of them."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arena.world import World
from ...engine.network import Network
from ...model.decision import Decision, DecisionParams
from ...params import settings_hash
from ...types import NEURONS, Neuron, Spikes
from .courses import Course, CourseParams
from .stage import Film

MAIN = "main"
FASTEST_S = 0.2
"""The fastest spiking is looked for over the length of the network's own decision window."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """What four neurons made of one course.

    Attributes
    ----------
    label, reading : the paper's name of the speed, and how it was read
    setup : which way of placing the robots, ``MAIN`` where there is one
    settings_hash, scene_hash : of the network, and of the arena and the courses
    spikes : by neuron, within the window that is equal for all courses and speeds
    spikes_course : by neuron, over the whole course
    fastest : by neuron, the most spikes within 200 ms
    peak : by neuron, the potential farthest from rest, in its own sign
    burst_s : by neuron, from its first to its last spike; 0 without one
    alarm_s, lgmds_alarm_s : when all four neurons, or the LGMDs alone, first called a collision; None: never
    end_s : when the motion ended
    """

    figure: str
    preset: str
    settings_hash: str
    scene_hash: str
    motion: str
    setup: str
    angle_deg: float
    label: str
    reading: str
    speed_cm_s: float
    seed: int
    spikes: dict[Neuron, int]
    spikes_course: dict[Neuron, int]
    fastest: dict[Neuron, int]
    peak: dict[Neuron, float]
    burst_s: dict[Neuron, float]
    alarm_s: float | None
    lgmds_alarm_s: float | None
    end_s: float

    def count(self, name: str) -> int:
        """Spikes in the window of a neuron, of the ``busier`` LGMD, of the ``lesser`` one, or of both ``lptcs``."""
        s = self.spikes
        counts: dict[str, int] = {str(neuron): spikes for neuron, spikes in s.items()}
        counts["busier"] = max(s["lgmd1"], s["lgmd2"])
        counts["lesser"] = min(s["lgmd1"], s["lgmd2"])
        counts["lptcs"] = s["lptc_r"] + s["lptc_l"]
        return counts[name]


@dataclass(frozen=True, kw_only=True)
class About:
    """What a trial is a trial of: everything but the preset that saw it."""

    figure: str
    course: Course
    p: CourseParams
    world: World
    seed: int
    label: str
    reading: str
    setup: str = MAIN


def trial(about: About, film: Film, preset: str, network: Network) -> Trial:
    """Show ``film`` to ``network``, from rest, and note what it did."""
    network.reset()
    trace = network.run(film.images, film.times_s)
    times_s = trace["time_s"]
    low_s, high_s = about.course.window_s(about.p)
    inside = (times_s > low_s) & (times_s <= high_s + 1.5 * film.tick_s)  # the answer comes a frame later
    return Trial(
        figure=about.figure,
        preset=preset,
        settings_hash=settings_hash(network.params),
        scene_hash=film.scene_hash,
        motion=about.course.motion,
        setup=about.setup,
        angle_deg=about.course.angle_deg,
        label=about.label,
        reading=about.reading,
        speed_cm_s=about.course.speed_cm_s,
        seed=about.seed,
        spikes={n: int(trace[f"spikes_{n}"][inside].sum()) for n in NEURONS},
        spikes_course={n: int(trace[f"spikes_{n}"].sum()) for n in NEURONS},
        fastest={n: _fastest(times_s, trace[f"spikes_{n}"]) for n in NEURONS},
        peak={n: float(trace[n][np.abs(trace[n]).argmax()]) for n in NEURONS},
        burst_s={n: _burst_s(times_s[trace[f"spikes_{n}"] > 0]) for n in NEURONS},
        alarm_s=first_alarm_s(trace, replace(network.params.decision, neurons="all")),
        lgmds_alarm_s=first_alarm_s(trace, replace(network.params.decision, neurons="lgmds")),
        end_s=about.p.lead_s + about.course.travel_s,
    )


def first_alarm_s(trace: NDArray[Any], p: DecisionParams) -> float | None:
    """Return when the decision ``p`` first calls a collision on the spikes of ``trace``; None: never.

    What decides feeds nothing back, so one run of the network tells what every selection of its neurons decides.
    """
    near_s = p.window_ms / 1000
    busy_s = trace["time_s"][trace["spikes_lgmd2"] > 0]
    if not busy_s.size:  # without LGMD-2 nothing is ever decided
        return None
    decided = (trace["state"] == "ok") & (trace["time_s"] >= busy_s[0] - near_s)
    decided &= trace["time_s"] <= busy_s[-1] + near_s
    columns = [trace["time_s"], *(trace[f"spikes_{n}"] for n in NEURONS)]
    decision = Decision(p)
    for time_s, *spikes in zip(*(column[decided].tolist() for column in columns), strict=True):
        decision.step(time_s, Spikes(*spikes), 1.0)
        if decision.collision(time_s):
            return float(time_s)
    return None


def as_csv(trials: Iterable[Trial]) -> str:
    """Return a table with one row a trial; a dictionary becomes one column for each neuron."""
    rows = [_flat(trial) for trial in trials]
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]) if rows else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _flat(trial: Trial) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for name, value in asdict(trial).items():
        if isinstance(value, dict):
            row |= {f"{name}_{neuron}": _plain(item) for neuron, item in value.items()}
        else:
            row[name] = _plain(value)
    return row


def _plain(value: Any) -> Any:
    if value is None:
        return ""
    return round(value, 6) if isinstance(value, float) else value


def _burst_s(fired_s: NDArray[np.float64]) -> float:
    return float(fired_s[-1] - fired_s[0]) if fired_s.size else 0.0


def _fastest(times_s: NDArray[np.float64], spikes: NDArray[np.int32]) -> int:
    first = np.searchsorted(times_s, times_s - FASTEST_S + 1e-3)
    total = np.concatenate(([0], np.cumsum(spikes)))
    return int((total[1:] - total[first]).max(initial=0))
