"""The grid behind the calibrated values of the ``paper`` preset: ``python -m lobula.experiments.calibration``.

For each triple of T_g, C_sig and K_hs: how many claims fail over the synthetic battery at 30 Hz, and which.
docs/calibration.md tells how the choice was made from it.
"""

from __future__ import annotations

import argparse
from collections import Counter
from itertools import product

from ..model.network import NetworkParams
from ..model.presets import preset
from ..params import with_settings
from .battery import score

THRESHOLDS_GREY = (0.1, 0.15, 0.2)
SIGMOIDS_GREY = (0.004, 0.0046, 0.0048, 0.005, 0.006)
SIGMOIDS_GREY2 = (0.0015, 0.002, 0.0025, 0.003)


def candidate(threshold_grey: float, sigmoid_grey: float, sigmoid_grey2: float) -> NetworkParams:
    """Return the ``paper`` preset with these T_g, C_sig and K_hs."""
    lgmd = {"grouping": {"threshold_grey": threshold_grey}, "sigmoid_grey": sigmoid_grey}
    settings = {"lgmd1": lgmd, "lgmd2": lgmd, "lptc": {"sigmoid_grey2": sigmoid_grey2}}
    params: NetworkParams = with_settings(preset("paper"), settings, "calibration grid")
    return params


def failures(params: NetworkParams) -> Counter[str]:
    """Return how often each claim fails over the battery at 30 Hz."""
    return Counter(check.claim for s in score(params) for check in s.checks if not check.holds)


def main() -> None:
    """Print the grid as a Markdown table."""
    parser = argparse.ArgumentParser(prog="python -m lobula.experiments.calibration", description=__doc__)
    parser.add_argument("--threshold", type=float, nargs="+", default=THRESHOLDS_GREY, help="T_g, grey")
    parser.add_argument("--sigmoid", type=float, nargs="+", default=SIGMOIDS_GREY, help="C_sig, grey")
    parser.add_argument("--lptc-sigmoid", type=float, nargs="+", default=SIGMOIDS_GREY2, help="K_hs, grey^2")
    grid = parser.parse_args()
    print("| T_g | C_sig | K_hs | claims that fail | which |\n|--:|--:|--:|--:|---|")
    for point in product(grid.threshold, grid.sigmoid, grid.lptc_sigmoid):
        failed = failures(candidate(*point))
        which = ", ".join(f"{claim}: {count}" for claim, count in failed.most_common())
        print("| " + " | ".join(f"{x:g}" for x in point) + f" | {failed.total()} | {which} |", flush=True)


if __name__ == "__main__":
    main()
