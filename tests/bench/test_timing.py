import pytest

from lobula.bench.timing import Timing, interleaved, ratio


class Clock:
    """Stands still but for what contenders add."""

    def __init__(self):
        self.ns = 0

    def __call__(self):
        return self.ns

    def contender(self, frames, *costs_us):
        costs = list(costs_us)
        calls = iter(range(10**6))

        def work():
            self.ns += int(1000 * frames * costs[next(calls) % len(costs)])
            return frames

        return work


def test_time_per_frame_of_each_contender():
    clock = Clock()
    found = interleaved({"a": clock.contender(10, 5.0), "b": clock.contender(3, 40.0)}, 4, clock, at_least_ms=0.0)
    assert found["a"].rounds_us == [5.0] * 4
    assert found["b"].median_us == found["b"].best_us == 40.0
    assert ratio(found["b"], found["a"]) == 8.0


def test_a_turn_is_the_median_of_its_passes_and_one_pass_goes_before():
    clock = Clock()
    # unmeasured: 900; first turn: 1, 2, 30 us over 1000 frames, which fills 33 ms
    found = interleaved({"a": clock.contender(1000, 900.0, 1.0, 2.0, 30.0)}, 1, clock, at_least_ms=33.0)["a"]
    assert found.rounds_us == [2.0]
    assert found.best_us == 1.0


def test_ratio_pairs_what_ran_side_by_side():
    slow, fast = Timing([10.0, 40.0, 10.0], 10.0), Timing([1.0, 4.0, 1.0], 1.0)
    assert ratio(slow, fast) == 10.0


def test_a_clock_that_stands_still_ends():
    assert interleaved({"a": lambda: 1}, 1, lambda: 0, at_least_ms=1e-5)["a"].rounds_us == [pytest.approx(0.001)]
