"""Tracks and their score as text for people, as JSON, and as the lines of a CSV file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from .counted import counted
from .table import table

if TYPE_CHECKING:
    from ..experiments.tracked import Scored

_COLUMNS = ("robot", "found", "bridged", "distance_cm", "error_mm", "error_deg")
_EVENT_COLUMNS = (
    "tick", "time_s", "kind", "robot", "other", "distance_cm", "miss_cm", "incidence_deg", "seen", "seen_by_other",
)  # fmt: skip


def as_text(summary: dict[str, Any], score: dict[str, Any] | None) -> str:
    """Return the table of robots, what was left out, and the score."""
    rows = [
        (
            robot["id"],
            f"{robot['found_share']:.1%}",
            f"{robot['bridged_share']:.1%}",
            f"{robot['distance_cm']:.1f}",
            _number(robot["error_mm"]),
            _number(robot["error_deg"]),
        )
        for robot in summary["robots"]
    ]
    rate = f" at {summary['rate_hz']:.4g} Hz" if summary["rate_hz"] else ""
    words = [
        f"{counted(len(rows), 'robot')} in {counted(summary['frames'], 'frame')}{rate}, room {summary['room']} cm: "
        f"{summary['found_share']:.1%} found; standard error {_number(summary['error_mm'])} mm, "
        f"{_number(summary['error_deg'])} deg"
    ]
    if summary["calibration_error_mm"] is not None:
        words.append(f"the reference points are missed by {summary['calibration_error_mm']:.2f} mm (root mean square)")
    if summary["left_out"]:
        words.append("left out: " + ", ".join(f"{why}: {count}" for why, count in summary["left_out"].items()))
    parts = [table(_COLUMNS, rows, right="found bridged distance_cm error_mm error_deg"), "\n".join(words)]
    if score is not None:
        parts.append(_score(score))
    return "\n\n".join(parts)


def score_dict(scored: Scored) -> dict[str, Any]:
    """Return the score for JSON. There is one rule only, so the second column of the arena's score is left out."""
    score = {name: value for name, value in scored.score.as_dict().items() if not name.startswith("geometric_")}
    return score | {"answers_to_contacts": scored.answers}


def event_lines(scored: Scored) -> Iterator[str]:
    """Yield the lines of a CSV file, an event each; ``other`` in words, the columns of potentials left out."""
    from ..arena.events import name_of

    yield ",".join(_EVENT_COLUMNS) + "\n"
    for event in scored.events:
        cells = []
        for name in _EVENT_COLUMNS:
            value = event[name].item()
            if name == "other":
                cells.append(name_of(value))
            elif isinstance(value, float):
                cells.append("" if value != value else f"{value:.4f}")
            else:
                cells.append(str(int(value) if isinstance(value, bool) else value))
        yield ",".join(cells) + "\n"


def _score(score: dict[str, Any]) -> str:
    kinds = ("CR", "CP", "AA", "AT", "AP", "spurious")
    lines = [", ".join(f"{kind} {score[kind]}" for kind in kinds) + f" in {score['robot_minutes']:.2f} robot-minutes"]
    for name, means in (("SR1", "AP/(AP+CP)"), ("SR2", "AA/(AA+AT+CR)")):
        if score[name] is None:
            lines.append(f"{name} = {means}: nothing to count")
        else:
            low, high = score[f"{name}_low"], score[f"{name}_high"]
            lines.append(f"{name} = {means} = {score[name]:.1%} (95 %: {low:.1%} to {high:.1%})")
    lines.append(f"turns that came with a contact: {score['answers_to_contacts']}; causes by the geometric rule")
    return "\n".join(lines)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"
