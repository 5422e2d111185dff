"""Intervals against published values."""

from __future__ import annotations

import math

import pytest

from lobula.errors import ParameterError
from lobula.evaluate.intervals import garwood, wilson


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
