"""The paper's claims, and how a run decides whether each one holds.

A claim is looked at under several conditions (a course, a speed). Under each one every seed either shows it or does
not: the share of seeds that do has a Wilson interval.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from ...intervals import wilson
from .trials import MAIN, Trial

Status = Literal["holds", "holds in part", "does not hold"]

HELD_SHARE = 0.9
"""A claim holds under a condition that shows it in at least this share of the seeds."""
PART_SHARE = 0.5
"""A claim does not hold if fewer than this share of all its trials show it."""


class Finding(NamedTuple):
    """A claim under one condition: in how many of how many trials it was seen; ``tell`` gives the numbers behind it.

    The numbers have bootstrap intervals, which take time: they are asked for where they are shown.
    """

    condition: str
    held: int
    trials: int
    tell: Callable[[], str]

    @property
    def share(self) -> float:
        """Share of the trials that show it; 0 without a trial."""
        return self.held / self.trials if self.trials else 0.0

    @property
    def holds(self) -> bool:
        """Whether the claim holds under this condition."""
        return self.trials > 0 and self.share >= HELD_SHARE


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One thing the paper says.

    ``paper`` tells what it says, ``rule`` what is counted as seeing it in one trial.
    """

    number: str
    paper: str
    rule: str
    judge: Callable[[Sequence[Trial]], Iterable[Finding]]


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What one preset's trials say of one claim."""

    number: str
    paper: str
    rule: str
    preset: str
    findings: tuple[Finding, ...]

    @property
    def held(self) -> int:
        """Trials that show the claim, over all conditions."""
        return sum(f.held for f in self.findings)

    @property
    def trials(self) -> int:
        """All trials the claim was looked at in."""
        return sum(f.trials for f in self.findings)

    @property
    def status(self) -> Status:
        """Holds: under every condition. Does not hold: in fewer than half of all trials. Else: in part."""
        if self.findings and all(f.holds for f in self.findings):
            return "holds"
        return "holds in part" if self.trials and self.held / self.trials >= PART_SHARE else "does not hold"

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson interval of the share of all trials that show the claim."""
        return wilson(self.held, self.trials)


def judged(claims: Iterable[Claim], trials: Sequence[Trial], setup: str = MAIN) -> Iterator[Verdict]:
    """Judge every claim for every preset, by the trials that were made in ``setup``."""
    by_preset: dict[str, list[Trial]] = {}
    for one in trials:
        if one.setup == setup:
            by_preset.setdefault(one.preset, []).append(one)
    for claim in claims:
        for preset, own in by_preset.items():
            yield Verdict(
                number=claim.number, paper=claim.paper, rule=claim.rule, preset=preset,
                findings=tuple(claim.judge(own)),
            )  # fmt: skip


def finding(condition: str, seen: Iterable[bool], tell: Callable[[], str]) -> Finding:
    """Count the trials in which a claim was seen."""
    flags = list(seen)
    return Finding(condition, sum(flags), len(flags), tell)
