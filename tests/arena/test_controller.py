"""What a controller returns is checked; what it raises is told with tick and time."""

from typing import Any

import numpy as np
import pytest

from lobula.arena.controller import ControllerError, can_replay, decide, keeps_state
from lobula.arena.controls import NeverTurn

from .stand_ins import Adder, Scripted

IMAGES = np.zeros((3, 24, 32), np.uint8)
TURNING = np.zeros(3, bool)


class Says:
    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def start(self, robots: int, rng: np.random.Generator) -> None: ...

    def step(self, images: np.ndarray, time_s: float, turning: np.ndarray) -> Any:
        if isinstance(self.answer, BaseException):
            raise self.answer
        return self.answer


@pytest.mark.parametrize(
    "answer", [np.array([True, False, True]), [True, False, True], (1, 0, 1), np.array([1.0, 0.0, 1.0])]
)
def test_truth_values_of_any_kind_are_taken(answer: Any) -> None:
    said = decide(Says(answer), IMAGES, 0.1, TURNING, 3)
    assert said.dtype == np.bool_
    assert said.tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (None, "returned shape ()"),
        (True, "returned shape ()"),
        ([True, False], "returned shape (2,)"),
        (np.zeros((3, 1), bool), "returned shape (3, 1)"),
        ([0.0, np.nan, 1.0], "robot 1: returned nan"),
        ([0, 0, 2], "robot 2: returned 2"),
        ([0.3, 0, 1], "robot 0: returned 0.3"),
        (["left", "right", "none"], "returned ['left', 'right', 'none']"),
        ([[True], [True, False], []], "returned [[True], [True, False], []]"),
        ([None, None, None], "returned [None, None, None]"),
    ],
)
def test_nonsense_is_named_with_tick_time_and_robot(answer: Any, message: str) -> None:
    with pytest.raises(ControllerError) as caught:
        decide(Says(answer), IMAGES, 0.1, TURNING, 3)
    text = str(caught.value)
    assert text.startswith("controller Says, tick 3 (0.100 s)")
    assert message in text
    assert text.endswith("must be 3 truth values, one for each robot")


def test_what_it_raises_is_told_and_kept() -> None:
    error = ZeroDivisionError("division by zero")
    with pytest.raises(ControllerError, match=r"tick 3 \(0\.100 s\): raised ZeroDivisionError: division by zero") as c:
        decide(Says(error), IMAGES, 0.1, TURNING, 3)
    assert c.value.__cause__ is error


def test_an_interrupt_is_no_fault_of_the_controller() -> None:
    with pytest.raises(KeyboardInterrupt):
        decide(Says(KeyboardInterrupt()), IMAGES, 0.1, TURNING, 3)


def test_what_a_controller_can_do() -> None:
    assert not keeps_state(Scripted())
    assert not can_replay(Scripted())
    assert keeps_state(Adder())
    assert can_replay(Adder())
    assert can_replay(NeverTurn())
