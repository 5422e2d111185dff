"""A trial of ``lobula tune``: settings measured on the synthetic battery, on one core."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from lobula.bench.timing import interleaved
from lobula.model.presets import preset
from lobula.stimuli.battery import battery
from lobula.tuning.battery_task import battery_cases, battery_task

from .figure import Figure

QUICK_MOVIES = 12


def figures(rounds: int, quick: bool) -> list[Figure]:
    """Time the part of the battery that is searched on, movies already made, network and scoring together."""
    cases = list(battery_cases())
    with tempfile.TemporaryDirectory() as folder:
        task = battery_task(Path(folder), cases[:QUICK_MOVIES] if quick else cases)
        names, params = task.splits["battery"].train, preset("paper")
        frames = sum(task.films[name].shape[0] for name in names)

        def trial() -> int:
            task.measure(params, names)
            return frames

        timing = interleaved({"trial": trial}, rounds, time.thread_time_ns)["trial"]
    trial_s = 1e-6 * timing.median_us * frames
    details = {
        "trial_us": timing.as_dict(), "movies": len(names), "of": sum(1 for _ in battery()), "frames": frames,
        "trials_per_s": round(1 / trial_s, 3),
    }  # fmt: skip
    return [
        Figure("lobula tune: the battery against real time, one core", task.length_s(names) / trial_s, "x", 20, None,
               details=details),
        Figure("lobula tune: trials on the battery, one core", 1 / trial_s, "1/s", details=details),
    ]  # fmt: skip
