"""How much of what a frame rate does is chance: the battery's moving objects, begun at several parts of a frame.

    python -m lobula.experiments.phases

An edge that advances less than a pixel a frame excites on some frames and not on others, so a first alarm depends on
when, within a frame, the motion began. Rates are therefore compared by means over such phases. Takes some minutes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..model.network import NetworkParams
from ..model.presets import BASES, preset
from ..stimuli.battery import Case, battery
from ..stimuli.catalogue import keywords
from .outcome import outcome

RATE_HZ, SLOW_HZ = 30.0, 15.0
FINE, COARSE = 8, 4
"""Phases of a frame of 30 Hz, for one rate against itself and for two rates."""
TOLERANCE_S = 0.067


class Alarms(NamedTuple):
    """First alarms of one movie begun at each phase, s after the motion began to be due; None where there is none."""

    all_s: Sequence[float | None]
    lgmds_s: Sequence[float | None]


def alarms(case: Case, params: NetworkParams, rate_hz: float, phases: int) -> Alarms:
    """Run ``case`` with its motion later by 0, 1/phases, ... of a 30 Hz frame."""
    lead_s = float((keywords(case.movie.kind) | dict(case.movie.settings))["lead_s"])
    found = []
    for phase in range(phases):
        later_s = phase / phases / RATE_HZ
        result = outcome(case.movie(rate_hz=rate_hz, lead_s=lead_s + later_s), params)
        found.append([None if at is None else at - later_s for at in (result.all_s, result.lgmds_s)])
    return Alarms(*zip(*found, strict=True))


def spread_s(found: Sequence[float | None]) -> float:
    """Return the time from the first to the last of the alarms; NaN without any."""
    times = [at for at in found if at is not None]
    return max(times) - min(times) if times else float("nan")


def shift_s(slow: Sequence[float | None], usual: Sequence[float | None]) -> float:
    """Return how much later the alarms of ``slow`` come in the mean; NaN where either has none."""
    means = [np.mean([at for at in one if at is not None]) if any(at is not None for at in one) else np.nan
             for one in (slow, usual)]  # fmt: skip
    return float(means[0] - means[1])


def differ(slow: Sequence[float | None], usual: Sequence[float | None]) -> int:
    """Return at how many phases only one of the two has an alarm."""
    return sum((a is None) != (b is None) for a, b in zip(slow, usual, strict=True))


def page() -> Iterable[str]:
    """Yield the lines of the comparison, in Markdown."""
    cases = [case for case in battery() if case.expectation.kind.startswith(("translating", "angular"))
             or (case.expectation.dark and case.expectation.kind in ("looming", "receding"))]  # fmt: skip
    for name in BASES:
        params = preset(name)
        own = [spread_s(alarms(c, params, RATE_HZ, FINE).all_s) for c in cases if c.expectation.kind == "looming"]
        yield f"preset `{name}`"
        yield ""
        yield (
            f"{RATE_HZ:g} Hz against itself, {FINE} phases: the alarms of an approach lie "
            f"{1000 * np.nanmedian(own):.0f} ms apart in the median of {len(own)} movies, "
            f"{1000 * np.nanmax(own):.0f} at most"
        )
        pairs = [(c, alarms(c, params, SLOW_HZ, COARSE), alarms(c, params, RATE_HZ, COARSE)) for c in cases]
        groups = {
            "approaches": [(a, b) for c, a, b in pairs if c.expectation.kind == "looming"],
            "passing and receding": [(a, b) for c, a, b in pairs if c.expectation.kind not in ("looming", "angular")],
            "angular approaches": [(a, b) for c, a, b in pairs if c.expectation.kind == "angular"],
        }
        shifts = np.array([shift_s(a.all_s, b.all_s) for a, b in groups["approaches"]])
        yield (
            f"{SLOW_HZ:g} against {RATE_HZ:g} Hz, {COARSE} phases: approaches alarm {1000 * np.nanmean(shifts):+.0f} "
            f"ms later in the mean, root mean square {1000 * np.sqrt(np.nanmean(shifts**2)):.0f}, beyond "
            f"{1000 * TOLERANCE_S:.0f} ms {(np.abs(shifts) > TOLERANCE_S).sum()} of {len(shifts)} movies"
        )
        yield ""
        yield "| decided otherwise | all four | the LGMDs alone | of |"
        yield "|---|--:|--:|--:|"
        for title, both in groups.items():
            four = sum(differ(a.all_s, b.all_s) for a, b in both)
            lgmds = sum(differ(a.lgmds_s, b.lgmds_s) for a, b in both)
            yield f"| {title} | {four} | {lgmds} | {COARSE * len(both)} |"
        yield ""


if __name__ == "__main__":
    for line in page():
        print(line)
