"""How the claims fare when the robots are placed in other ways: a table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from .claims import Claim, judged
from .trials import MAIN, Trial


def setup_table(claims: Sequence[Claim], trials: Sequence[Trial], others: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a table in Markdown: for every set-up and preset the share of trials that show each claim.

    Of the main set-up those seeds are taken with which the others were run, so that the rows can be compared.
    """
    others = list(others)
    seeds = {t.seed for t in trials if t.setup != MAIN}
    compared = [t for t in trials if t.seed in seeds]
    yield f"| set-up | preset | {' | '.join(c.number for c in claims)} |"
    yield f"|---|---|{'--:|' * len(claims)}"
    for setup in (MAIN, *others):
        shares: dict[str, list[str]] = {}
        for v in judged(claims, compared, setup):
            shares.setdefault(v.preset, []).append(f"{100 * v.held / v.trials:.0f} %" if v.trials else "none")
        for preset, cells in shares.items():
            yield f"| {'as above' if setup == MAIN else setup} | {preset} | {' | '.join(cells)} |"
