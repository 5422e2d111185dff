"""Confidence intervals of a share, of a count, and of whatever is made of counts summed over seeds."""

from __future__ import annotations

import math
from collections.abc import Callable
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ParameterError

Interval = tuple[float, float]

Statistic = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""Takes summed counts (N, K) to N values, such as ``lambda n: n[:, 0] / (n[:, 0] + n[:, 1])``."""

CONFIDENCE = 0.95
RESAMPLES = 10_000


def wilson(successes: int, trials: int, confidence: float = CONFIDENCE) -> Interval:
    """Return the Wilson score interval of the share ``successes / trials``; (0, 1) where nothing was tried.

    Raises
    ------
    ParameterError : not 0 <= successes <= trials

    Source: Wilson, J. Am. Stat. Assoc. 22:209, 1927.
    """
    if not 0 <= successes <= trials:
        raise ParameterError(f"wilson: {successes} of {trials}: must be 0 <= successes <= trials")
    if trials == 0:
        return 0.0, 1.0
    z = NormalDist().inv_cdf(0.5 + confidence / 2)
    share, z2 = successes / trials, z * z
    middle = share + z2 / (2 * trials)
    reach = z * math.sqrt(share * (1 - share) / trials + z2 / (4 * trials * trials))
    scale = 1 + z2 / trials
    # rounding must not leave 1e-18 where the interval touches its end
    low = 0.0 if successes == 0 else (middle - reach) / scale
    high = 1.0 if successes == trials else (middle + reach) / scale
    return low, high


def garwood(count: int, confidence: float = CONFIDENCE) -> Interval:
    """Return the exact interval of the mean of a Poisson variable that was observed once, as ``count``.

    The lower end is the mean at which ``count`` or more has the probability (1 - confidence) / 2; the upper end the
    one at which ``count`` or fewer has it.

    Raises
    ------
    ParameterError : a negative count

    Source: Garwood, Biometrika 28:437, 1936.
    """
    if count < 0:
        raise ParameterError(f"garwood: count {count}: must be 0 or more")
    tail = (1 - confidence) / 2
    top = count + 20.0 * math.sqrt(count + 1.0) + 20.0
    low = 0.0 if count == 0 else _rising_root(lambda mean: 1 - _at_most(count - 1, mean) - tail, top)
    return low, _rising_root(lambda mean: tail - _at_most(count, mean), top)


def bootstrap(
    counts: ArrayLike,
    statistic: Statistic,
    *,
    confidence: float = CONFIDENCE,
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> Interval:
    """Return the percentile interval of ``statistic`` of the counts summed over all seeds.

    Seeds, not single events, are drawn with replacement: what happens within one run hangs together.

    Parameters
    ----------
    counts : (S, K), K counts for each of S seeds
    statistic : takes the sums (N, K) to (N,); a draw in which it is NaN (nothing to divide by) is left out
    seed : of the draws: the same seed, the same interval

    Returns
    -------
    (NaN, NaN) with fewer than two seeds, or where every draw is NaN.

    Raises
    ------
    ParameterError : counts that are no table

    Source: Efron & Tibshirani, An Introduction to the Bootstrap, 1993, ch. 13.
    """
    table = np.asarray(counts, np.float64)
    if table.ndim != 2 or table.size == 0:
        raise ParameterError(f"bootstrap: counts of shape {table.shape}: must be (S, K), a row for each seed")
    seeds = len(table)
    # a draw is told by how often it takes each seed
    times = np.random.default_rng(seed).multinomial(seeds, np.full(seeds, 1 / seeds), resamples)
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.asarray(statistic(np.asarray(times @ table, np.float64)), np.float64)
    known = values[np.isfinite(values)]
    if seeds < 2 or not known.size:
        return math.nan, math.nan
    low, high = np.quantile(known, [(1 - confidence) / 2, (1 + confidence) / 2])
    return float(low), float(high)


def _at_most(count: int, mean: float) -> float:
    """Probability that a Poisson variable is ``count`` or less; each term by its logarithm, so none overflows."""
    if mean == 0:
        return 1.0
    return math.fsum(math.exp(k * math.log(mean) - mean - math.lgamma(k + 1)) for k in range(count + 1))


def _rising_root(f: Callable[[float], float], top: float) -> float:
    """Return where the rising function ``f`` crosses zero in [0, top], by halving."""
    low, high = 0.0, top
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (low, middle) if f(middle) > 0 else (middle, high)
    return (low + high) / 2
