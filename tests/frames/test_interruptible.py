"""Opening in a thread: results and failures come through, and what is left alone is let go of."""

import signal
import threading

import pytest

from lobula.frames.interruptible import interruptible


class SignalError(Exception):
    pass


def test_results_and_failures_come_through():
    assert interruptible(lambda: 7, pytest.fail) == 7
    with pytest.raises(ZeroDivisionError):
        interruptible(lambda: 1 // 0, pytest.fail)


def test_a_signal_does_not_wait_and_the_result_is_let_go():
    may_end, let_go = threading.Event(), []

    def handler(*_):
        raise SignalError

    def work():
        signal.raise_signal(signal.SIGUSR1)
        may_end.wait(10)
        return "opened"

    gone = threading.Event()

    def release(result):
        let_go.append(result)
        gone.set()

    former = signal.signal(signal.SIGUSR1, handler)
    try:
        with pytest.raises(SignalError):
            interruptible(work, release)
    finally:
        signal.signal(signal.SIGUSR1, former)
    assert let_go == []  # the work goes on
    may_end.set()
    assert gone.wait(10)
    assert let_go == ["opened"]
