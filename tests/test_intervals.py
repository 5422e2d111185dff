"""Intervals against published values, closed forms and every draw there is."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from lobula.errors import ParameterError
from lobula.intervals import bootstrap, garwood, wilson


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"),
    [  # Newcombe, Statistics in Medicine 17:857, 1998, table I, method 3
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0000, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_wilson_against_newcombe(successes, trials, low, high):
    assert wilson(successes, trials) == pytest.approx((low, high), abs=5e-5)


def test_wilson_mirrors_and_stays_inside():
    for n in (1, 7, 11):
        for k in range(n + 1):
            low, high = wilson(k, n)
            assert 0 <= low <= k / n <= high <= 1
            assert wilson(n - k, n) == pytest.approx((1 - high, 1 - low))


def test_wilson_of_nothing_is_everything():
    assert wilson(0, 0) == (0.0, 1.0)


@pytest.mark.parametrize(("k", "n"), [(-1, 3), (4, 3)])
def test_wilson_refuses_nonsense(k, n):
    with pytest.raises(ParameterError, match="must be 0 <= successes <= trials"):
        wilson(k, n)


@pytest.mark.parametrize(
    ("count", "low", "high"),
    [  # 95 % limits of a Poisson mean as tabulated since Garwood 1936 (Pearson & Hartley, Biometrika Tables, table 40)
        (0, 0.0, 3.689),
        (1, 0.0253, 5.572),
        (2, 0.242, 7.225),
        (5, 1.623, 11.668),
        (10, 4.795, 18.390),
        (50, 37.11, 65.92),
    ],
)
def test_garwood_against_the_tables(count, low, high):
    assert garwood(count) == pytest.approx((low, high), abs=6e-3 if count == 50 else 6e-4)


def test_garwood_of_none_is_known_in_closed_form():
    assert garwood(0)[1] == pytest.approx(-math.log(0.025))  # exp(-mean) = 0.025


def test_garwood_refuses_a_negative_count():
    with pytest.raises(ParameterError, match="must be 0 or more"):
        garwood(-1)


def share(sums):
    return sums[:, 0] / (sums[:, 0] + sums[:, 1])


def mean(sums):  # of the first column, where the second holds ones
    return sums[:, 0] / sums[:, 1]


SEEDS = np.array([[9, 1], [7, 3], [8, 2], [4, 6]])


def test_bootstrap_against_every_draw():
    # four seeds have 4^4 = 256 equally likely draws; their exact 2.5 and 97.5 % points are the interval
    all_draws = np.array([SEEDS[list(rows)].sum(axis=0) for rows in itertools.product(range(4), repeat=4)])
    low, high = np.quantile(share(all_draws), [0.025, 0.975], method="inverted_cdf")
    assert bootstrap(SEEDS, share, resamples=200_000) == pytest.approx((low, high), abs=1e-9)


def test_bootstrap_of_a_mean_is_near_the_normal_interval():
    values = np.random.default_rng(5).normal(10, 2, 400)
    low, high = bootstrap(np.stack([values, np.ones(400)], axis=1), mean)
    reach = 1.96 * values.std() / math.sqrt(400)
    assert (low, high) == pytest.approx((values.mean() - reach, values.mean() + reach), abs=0.02)


def test_bootstrap_repeats_with_its_seed():
    assert bootstrap(SEEDS, share, seed=3) == bootstrap(SEEDS, share, seed=3)
    narrow = bootstrap(SEEDS, share, confidence=0.5)
    wide = bootstrap(SEEDS, share)
    assert wide[0] < narrow[0] < narrow[1] < wide[1]


def test_seeds_that_agree_leave_no_doubt():
    assert bootstrap([[3, 1]] * 5, share) == (0.75, 0.75)


def test_one_seed_tells_nothing_of_its_spread():
    assert all(math.isnan(x) for x in bootstrap([[3, 1]], share))
    assert all(math.isnan(x) for x in bootstrap([[0, 0], [0, 0]], share))


def test_seeds_without_events_are_left_out_of_the_rate_only():
    low, high = bootstrap([[0, 0], [1, 1]], share)
    assert (low, high) == (0.5, 0.5)


@pytest.mark.parametrize("bad", [[1, 2, 3], [], [[]]])
def test_bootstrap_refuses_what_is_no_table(bad):
    with pytest.raises(ParameterError, match=r"must be \(S, K\)"):
        bootstrap(bad, share)
