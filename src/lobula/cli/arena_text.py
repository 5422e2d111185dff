"""A run of the arena as text for people, and as one record for programs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..runtime.interrupts import Interrupted
from .counted import counted
from .table import table

if TYPE_CHECKING:
    from ..arena.course import Run
    from ..arena.scoring import Score, Tally
    from .settings import Chosen

KINDS = ("CR", "CP", "AA", "AT", "AP", "spurious")
RATES = (("SR1", "AP/(AP+CP)"), ("SR2", "AA/(AA+AT+CR)"))


def as_text(done: Run) -> str:
    """Return the table of counts, the rates, what stands beside them, and how fast it went."""
    score = done.score
    rows = [(_by(score), *_counts(score))]
    if score.rule == "counterfactual":
        rows.append(("by place alone", *_counts(score.geometric)))
    return "\n".join(
        [
            f"{counted(done.world.robots.count, 'robot')}, {done.minutes:.2f} simulated minutes, seed {done.seed}",
            table(("cause of a turn", *KINDS), rows, right=" ".join(KINDS)),
            "",
            *_rates(score.as_dict()),
            f"contacts that no robot in them could have seen coming: {score.unseen_cr} of {score.cr} with robots, "
            f"{score.unseen_cp} of {score.cp} with the wall",
            f"without them: SR1 {_percent(score.sr1_seen)}, SR2 {_percent(score.sr2_seen)}",
            f"turns because of nothing: {_per_minute(score)} a robot-minute; driven {score.distance_cm / 100:.1f} m",
            _speed(done),
        ]
    )


def record(done: Run, chosen: Chosen, failure: BaseException | None, said: dict[str, Any] | None = None) -> str:
    """Return the run in one line of JSON: where it came from, the score, and the time each part took.

    ``said`` tells what else was written.
    """
    from ..params import settings_hash

    stopped = isinstance(failure, Interrupted) or not (failure or done.finished)
    status = "interrupted" if stopped else "failed" if failure else "ok"
    return json.dumps(
        {
            "type": "summary",
            "status": status,
            "problems": [str(failure)] if failure else [],
            "version": __version__,
            "preset": chosen.preset,
            "neurons": chosen.params.decision.neurons,
            "settings_hash": settings_hash(chosen.params),
            "world_hash": settings_hash(done.world),
            "seed": done.seed,
            "robots": done.world.robots.count,
            "minutes": round(done.minutes, 6),
            **done.score.as_dict(),
            "robot_frames": done.robot_frames,
            "seconds": {part: round(spent, 3) for part, spent in done.seconds.items()},
            **(said or {}),
        },
        allow_nan=False,
    )


def refusal(error: BaseException) -> str:
    """Return the record of a run that never began, so that a program always reads exactly one."""
    status = "interrupted" if isinstance(error, Interrupted) else "refused"
    return json.dumps({"type": "summary", "status": status, "problems": [str(error)], "minutes": 0.0})


def _by(score: Score) -> str:
    return "by leaving it out" if score.rule == "counterfactual" else "by place alone"


def _counts(tally: Tally) -> list[int]:
    return [tally.cr, tally.cp, tally.aa, tally.at, tally.ap, tally.spurious]


def _rates(score: dict[str, Any]) -> list[str]:
    lines = []
    for name, means in RATES:
        if score[name] is None:
            lines.append(f"{name} = {means}: nothing to count")
        else:
            low, high = score[f"{name}_low"], score[f"{name}_high"]
            lines.append(f"{name} = {means} = {score[name]:.1%} (95 %: {low:.1%} to {high:.1%})")
    return lines


def _percent(share: float) -> str:
    return "-" if share != share else f"{share:.1%}"


def _per_minute(score: Score) -> str:
    low, high = score.spurious_interval
    rate = score.spurious_per_robot_minute
    return "-" if rate != rate else f"{rate:.2f} ({low:.2f} to {high:.2f})"


def _speed(done: Run) -> str:
    spent = sum(done.seconds.values())
    if not spent:
        return "no frame was seen"
    parts = ", ".join(f"{part} {seconds / spent:.0%}" for part, seconds in done.seconds.items())
    return f"{done.robot_frames} robot-frames in {spent:.1f} s, {done.robot_frames / spent:.0f} a second: {parts}"
