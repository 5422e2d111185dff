"""The rule: AND of the LGMDs, OR of the LPTCs, the comparator, the window, the end."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.decision import decide, rule

from lobula.errors import ParameterError
from lobula.model.decision import Decision, DecisionParams
from lobula.types import Spikes

from .pictures import few
from .stamps import HABITS, written

FRAME_S = 1 / 30
NEURONS = ("all", "lgmds", "lgmd2")


def told(trains, neurons="all", weight=1.0, frame_s=FRAME_S, **settings):
    """Whether the rule holds at each step of (LGMD-1, LGMD-2, LPTC-R, LPTC-L) spikes."""
    decision = Decision(DecisionParams(neurons=neurons, **settings))
    held = []
    for k, spikes in enumerate(trains):
        decision.step(k * frame_s, Spikes(*spikes), weight)
        held.append(decision.held_s == k * frame_s)
    return held


def test_golden_four_spikes_in_the_window():
    assert told([(1, 1)] * 5) == [False, False, False, True, True]
    assert told([(2, 2), (1, 1), (1, 1)]) == [False, False, True]
    assert told([(2, 2), (1, 1), (0, 0)]) == [False] * 3


def test_golden_one_step_is_never_enough():
    assert told([(9, 9), (0, 0), (1, 1)]) == [False, False, True]
    assert told([(9, 9)], "lgmd2") == [False]


def test_golden_two_steps_must_hold_both():  # LGMD-1 in one step and LGMD-2 in another is no agreement, twice
    assert told([(4, 0), (0, 4), (4, 4)], "lgmds") == [False] * 3
    assert told([(4, 0), (1, 4), (4, 4)], "lgmds") == [False, False, True]


def test_golden_and_of_the_lgmds():  # A is the smaller sum: 3 for all but the last
    assert told([(9, 2), (9, 1)], "lgmds") == [False, False]
    assert told([(2, 9), (1, 9)], "lgmds") == [False, False]
    assert told([(2, 9), (2, 9)], "lgmds") == [False, True]


def test_golden_lgmd2_alone_does_not_ask_lgmd1():
    assert told([(0, 2), (0, 2)], "lgmd2") == [False, True]
    assert told([(0, 2), (0, 2)], "lgmds") == [False, False]
    assert told([(9, 2), (9, 1)], "lgmd2") == [False, False]


@pytest.mark.parametrize(("right", "left"), [(1, 0), (0, 1)])
def test_golden_or_of_the_lptcs_and_the_comparator(right, left):  # A = 4 beats B = 3 and not B = 4
    assert told([(2, 2, 3 * right, 3 * left), (2, 2)])[1]
    assert not told([(2, 2, 4 * right, 4 * left), (2, 2)])[1]
    assert told([(2, 2, 4 * right, 4 * left), (2, 2)], "lgmds")[1]
    assert told([(2, 2, 4 * right, 4 * left), (2, 2)], "lgmd2")[1]


def test_golden_lptcs_count_by_step():  # the larger of the two in each step: 2 + 2 = 4, though each has only 2
    assert not told([(2, 2, 2, 0), (2, 2, 0, 2)])[1]
    assert told([(2, 2, 2, 2), (2, 2, 1, 1)])[1]


def test_golden_weight_of_the_lptcs():
    assert told([(2, 2, 7, 0), (2, 2)], lptc_weight=0.5)[1]  # 4 > 3.5
    assert not told([(2, 2, 8, 0), (2, 2)], lptc_weight=0.5)[1]
    assert told([(2, 2, 99, 0), (2, 2)], lptc_weight=0.0)[1]


def test_golden_window_of_six_frames():
    """Spikes of 0 ms still count at 166.7 ms and no longer at 200 ms."""
    assert told([(2, 2), *[(0, 0)] * 4, (2, 2)])[-1]
    assert not told([(2, 2), *[(0, 0)] * 5, (2, 2)])[-1]


def test_golden_edge_of_the_window():
    assert told([(2, 2), (2, 2)], frame_s=0.198)[1]
    assert not told([(2, 2), (2, 2)], frame_s=0.2)[1]


def test_golden_long_steps_count_more():
    # 15 Hz: each spike counts for two ticks
    assert told([(1, 1), (1, 1)], weight=2.0, frame_s=1 / 15) == [False, True]
    assert told([(1, 1), (1, 1, 4, 0)], weight=2.0, frame_s=1 / 15) == [False, False]


def test_golden_sums_are_rounded_to_whole_spikes():
    assert told([(2, 2), (2, 2)], weight=0.99)[1]  # 0.99 is one tick: 4
    assert told([(3, 3), (2, 2)], weight=0.7)[1]  # 0.75 each: 3.75 counts as 4
    assert not told([(2, 2), (2, 2)], weight=0.84)[1]  # 0.75 each: 3
    assert told([(1, 1), (2, 2), (4, 4)], weight=0.5)[2]  # 3.5 counts as 4


def test_golden_a_collision_lasts_200_ms_after_the_rule():
    decision = Decision(DecisionParams())
    assert not decision.collision(0.0)
    for t in (0.0, 0.05):
        decision.step(t, Spikes(2, 2), 1.0)
    assert [decision.collision(t) for t in (0.05, 0.15, 0.2485, 0.25)] == [True, True, True, False]


def test_golden_a_collision_starts_again():
    decision = Decision(DecisionParams())
    seen = []
    for k in range(24):
        decision.step(k * 0.05, Spikes(2, 2) if k in (0, 1, 12, 13) else Spikes(), 1.0)
        seen.append(decision.collision(k * 0.05 + 0.001))
    # held from 0.05 to 0.15, while both pairs of spikes lie in the window, and again from 0.65 to 0.75
    assert seen == [1 <= k <= 6 or 13 <= k <= 18 for k in range(24)]


def test_golden_clear_empties_the_window_and_lets_a_collision_end():
    decision = Decision(DecisionParams())
    for t in (0.0, 0.03):
        decision.step(t, Spikes(2, 2), 1.0)
    decision.clear()
    assert decision.evidence(0.03) == (0, 0)
    assert decision.collision(0.1)
    decision.step(0.06, Spikes(3, 3), 1.0)
    assert decision.held_s == 0.03


def test_reset_really_resets():
    decision = Decision(DecisionParams())
    told = []
    for _ in range(2):
        decision.reset()
        assert not decision.collision(0.0)
        told.append([])
        for k in range(5):
            decision.step(k * FRAME_S, Spikes(1, 1), 1.0)
            told[-1].append(decision.collision(k * FRAME_S))
    assert told[0] == told[1] == [False, False, False, True, True]


counts = st.sampled_from([0, 0, 0, 1, 1, 2, 3])
trains = st.lists(st.tuples(st.tuples(counts, counts, counts, counts), st.integers(10, 120)), min_size=1, max_size=25)
"""Spikes of a step and the milliseconds to it; whole ones, so no stamp falls on an edge by rounding."""


@few
@given(trains, st.sampled_from(NEURONS), st.integers(1, 6))
def test_agrees_with_the_oracle(train, neurons, needed):
    decision = Decision(DecisionParams(neurons=neurons, collision_spikes=needed))
    history, time_ms = [], 0
    for spikes, interval_ms in train:
        time_ms += interval_ms
        now_s, weight = (time_ms + 0.25) / 1000, interval_ms * 3 / 100
        history.append((now_s, spikes, weight))
        decision.step(now_s, Spikes(*spikes), weight)
        assert (decision.held_s == now_s) == rule(history, now_s, neurons, needed)
        assert decision.collision(now_s) == decide(history, now_s, neurons, needed)


@pytest.mark.parametrize("hz", [10, 12, 12.5, 15, 16, 20, 23.976, 24, 25, 29.97, 30, 40])
@pytest.mark.parametrize("seed", range(3))
def test_the_rounding_of_stamps_decides_nothing(hz, seed):
    """The rule and the collision, frame by frame, for the same spikes under any habit of writing stamps."""
    rng = np.random.default_rng(seed)
    trains = [Spikes(*map(int, rng.choice([0, 0, 0, 0, 1, 2], 4))) for _ in range(400)]
    told = set()
    for habit in HABITS:
        decision, seen, before = Decision(DecisionParams()), [], None
        for spikes, t in zip(trains, written(hz, len(trains), habit), strict=True):
            if before is not None:
                decision.step(t, spikes, (t - before) * 30)
            before = t
            seen.append((decision.held_s == t, decision.collision(t)))
        told.add(tuple(seen))
    assert len(told) == 1
    assert len(set(told.pop())) == 3  # it is seen to hold, to last, and to be over


def test_golden_a_rule_that_holds_now_is_a_collision():
    decision = Decision(DecisionParams(end_ms=0.0))
    for t in (0.0, 0.05):
        decision.step(t, Spikes(2, 2), 1.0)
    assert [decision.collision(t) for t in (0.05, 0.06)] == [True, False]


@few
@given(trains)
def test_the_full_network_is_the_strictest(train):
    trains = [spikes for spikes, _ in train]
    strict, middle, loose = (told(trains, neurons) for neurons in NEURONS)
    assert all(a <= b <= c for a, b, c in zip(strict, middle, loose, strict=True))


@few
@given(trains)
def test_lptcs_never_raise_a_collision(train):
    assert not any(told([(0, 0, *spikes[2:]) for spikes, _ in train]))


def test_silence_on_nothing():
    assert not any(told([(0, 0)] * 20, collision_spikes=1))


@pytest.mark.parametrize(
    ("name", "bad"),
    [("neurons", "lgmd1"), ("window_ms", 29.0), ("collision_spikes", 0), ("collision_spikes", 4.5),
     ("lptc_weight", -1.0), ("end_ms", math.nan), ("warm_up_ms", -1.0), ("turning_deg_s", 0.0),
     ("after_turn_ms", 2001.0)],
)  # fmt: skip
def test_rejects(name, bad):
    with pytest.raises(ParameterError, match=rf"DecisionParams\.{name} = "):
        DecisionParams(**{name: bad})
