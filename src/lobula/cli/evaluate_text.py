"""Scored clips as text for people."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..evaluate.clips import Failure
from ..evaluate.scoring import ClipScore
from ..evaluate.summary import Summary, Totals
from .counted import counted
from .table import table

_CLIP_COLUMNS = ("clip", "class", "result", "lead_s", "alarms_s", "false", "minutes")
_CLASS_COLUMNS = ("class", "clips", "hits", "false", "minutes", "false/min")


def as_text(scores: Sequence[ClipScore], failures: Sequence[Failure], summary: Summary) -> str:
    """Return the table of clips, the table of classes and the headline."""
    counted = [s for s in scores if not s.label.apart]
    parts = [_clips(counted)]
    for why in summary.apart:
        parts.append(f"apart, {why}:\n{_clips([s for s in scores if s.label.apart == why])}")
    parts += [_classes(summary.classes.items()), _headline(summary.headline)]
    if failures:
        parts.append(f"could not be scored: {', '.join(f.label.file for f in failures)}")
    return "\n\n".join(parts)


def _clips(scores: Sequence[ClipScore]) -> str:
    return table(_CLIP_COLUMNS, [_clip(s) for s in scores], right="lead_s false minutes")


def _clip(s: ClipScore) -> tuple[object, ...]:
    result = "" if not s.label.collision else "HIT" if s.hit else "miss"
    if s.late:
        result += f" ({s.late} late)"
    starts = " ".join(f"{a.start_s:.2f}" for a in s.alarms)
    lead = "" if s.lead_s is None else f"{s.lead_s:.2f}"
    return s.label.file, s.label.kind, result, lead, starts, s.false_alarms, f"{s.footage_s / 60:.2f}"


def _classes(classes: Iterable[tuple[str, Totals]]) -> str:
    rows = []
    for kind, t in classes:
        hits = f"{t.hits}/{t.collisions}" if t.collisions else ""
        rate = "" if t.per_minute is None else f"{t.per_minute:.2f}"
        rows.append((kind, t.clips, hits, t.false_alarms, f"{t.minutes:.2f}", rate))
    return table(_CLASS_COLUMNS, rows, right="clips hits false minutes false/min")


def _headline(t: Totals) -> str:
    lines = []
    if t.collisions:
        low, high = t.hit_interval
        lead = "" if t.median_lead_s is None else f", median lead {t.median_lead_s:.2f} s"
        chance = (
            ""
            if t.chance_hit_rate is None
            else (f"\nchance: random alarms at the same rate would hit {t.chance_hit_rate:.0%}")
        )
        lines.append(
            f"hits {t.hits} of {counted(t.collisions, 'collision')} = {t.hits / t.collisions:.0%} "
            f"[{low:.0%}, {high:.0%}] (Wilson){lead}{chance}"
        )
    if t.per_minute is not None and t.per_minute_interval is not None:
        low, high = t.per_minute_interval
        lines.append(
            f"false alarms {t.false_alarms} in {t.minutes:.2f} min = {t.per_minute:.2f} a minute "
            f"[{low:.2f}, {high:.2f}] (exact Poisson)"
        )
    return "\n".join(lines)
