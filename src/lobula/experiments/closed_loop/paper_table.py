"""Table I of the paper: success rates in percent, by robots and by who decides."""

from __future__ import annotations

from typing import NamedTuple

LABELS = {"lgmd2": "LGMD-2 only", "lgmds": "LGMD-1 & LGMD-2", "all": "the proposed model"}
"""The paper's three models by the neurons that decide, in its order."""

DENSITIES = (4, 7)


class PaperRates(NamedTuple):
    """SR1 and SR2, percent."""

    sr1: float
    sr2: float


PAPER = {
    (4, "lgmd2"): PaperRates(96.7, 80.0),
    (4, "lgmds"): PaperRates(88.1, 73.9),
    (4, "all"): PaperRates(90.3, 87.3),
    (7, "lgmd2"): PaperRates(95.0, 75.2),
    (7, "lgmds"): PaperRates(81.7, 67.8),
    (7, "all"): PaperRates(83.4, 90.6),
}
"""Source: paper Table I."""
