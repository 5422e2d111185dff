"""Many scored clips as a few numbers, each with its count and its interval."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..intervals import Interval, garwood, wilson
from .scoring import ClipScore


@dataclass(frozen=True, kw_only=True)
class Totals:
    """What a group of clips adds up to.

    Attributes
    ----------
    hit_interval : 95 % Wilson interval of ``hits / collisions``
    median_lead_s : of the hits; None without one
    per_minute, per_minute_interval : false alarms; 95 % exact Poisson (Garwood) interval; None without footage
    chance_hit_rate : share of the collisions that alarms at random times, as many a minute as the false ones, would
        hit: the mean of 1 - exp(-rate * window) over the clips with a collision; None where it cannot be told
    """

    clips: int
    collisions: int
    hits: int
    hit_interval: Interval
    median_lead_s: float | None
    false_alarms: int
    minutes: float
    per_minute: float | None
    per_minute_interval: Interval | None
    chance_hit_rate: float | None


def chance_hit_rate(scores: Sequence[ClipScore], rate_per_s: float | None = None) -> float | None:
    """Return the share of the collisions that alarms at random times would hit; None where it cannot be told.

    ``rate_per_s`` is that of the alarms; by default that of the false ones.
    """
    footage_s = math.fsum(s.footage_s for s in scores)
    if rate_per_s is None and footage_s:
        rate_per_s = sum(s.false_alarms for s in scores) / footage_s
    windows_s = [s.window_s for s in scores if s.label.collision]
    if rate_per_s is None or not windows_s:
        return None
    return statistics.fmean(-math.expm1(-rate_per_s * window_s) for window_s in windows_s)


def skill(scores: Sequence[ClipScore]) -> float:
    """Return the hit rate above that of as many alarms at random times: one number to choose by."""
    hits = [s.hit for s in scores if s.label.collision]
    return sum(hits) / max(1, len(hits)) - (chance_hit_rate(scores) or 0.0)


def totals(scores: Sequence[ClipScore], rate_per_s: float | None = None) -> Totals:
    """Add ``scores`` up. ``rate_per_s`` of false alarms is used for the chance hit rate; by default the group's own."""
    with_collision = [s for s in scores if s.label.collision]
    leads_s = [s.lead_s for s in with_collision if s.lead_s is not None]
    false_alarms, footage_s = sum(s.false_alarms for s in scores), math.fsum(s.footage_s for s in scores)
    minutes = footage_s / 60
    chance = chance_hit_rate(scores, rate_per_s)
    low, high = garwood(false_alarms)
    return Totals(
        clips=len(scores),
        collisions=len(with_collision),
        hits=len(leads_s),
        hit_interval=wilson(len(leads_s), len(with_collision)),
        median_lead_s=statistics.median(leads_s) if leads_s else None,
        false_alarms=false_alarms,
        minutes=minutes,
        per_minute=false_alarms / minutes if minutes else None,
        per_minute_interval=(low / minutes, high / minutes) if minutes else None,
        chance_hit_rate=chance,
    )


@dataclass(frozen=True, kw_only=True)
class Summary:
    """``headline`` over the clips that count, ``classes`` of them, and ``apart`` those that do not, by the reason."""

    headline: Totals
    classes: dict[str, Totals]
    apart: dict[str, Totals]


def summarise(scores: Iterable[ClipScore]) -> Summary:
    """Group the scores; the chance hit rate everywhere takes the headline's rate of false alarms."""
    scores = list(scores)
    counted = [s for s in scores if not s.label.apart]
    headline = totals(counted)
    rate_per_s = None if headline.per_minute is None else headline.per_minute / 60
    classes = {
        kind: totals([s for s in counted if s.label.kind == kind], rate_per_s)
        for kind in dict.fromkeys(s.label.kind for s in counted)
    }
    apart = {
        why: totals([s for s in scores if s.label.apart == why], rate_per_s)
        for why in dict.fromkeys(s.label.apart for s in scores)
        if why
    }
    return Summary(headline=headline, classes=classes, apart=apart)
