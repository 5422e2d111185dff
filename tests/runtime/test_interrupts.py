"""Signals come between frames or while waiting, never inside an output."""

from __future__ import annotations

import signal
import threading

import pytest

from lobula.runtime.interrupts import Interrupted, Interrupts, raised_at_once


@pytest.fixture(autouse=True)
def _handlers_are_put_back():
    before = [signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM)]
    yield
    assert [signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_during_work_waits_for_the_next_frame(number, code):
    done = []

    def work(interrupts):
        for item in interrupts.between(iter("abc")):
            signal.raise_signal(number)
            done.append(item)

    with Interrupts() as interrupts, pytest.raises(Interrupted) as stop:
        work(interrupts)
    assert done == ["a"]
    assert stop.value.exit_code == code
    assert str(stop.value) == number.name


def test_a_signal_while_waiting_comes_at_once():
    def waiting():
        yield "a"
        signal.raise_signal(signal.SIGINT)
        raise AssertionError("went on waiting")

    with Interrupts() as interrupts, pytest.raises(Interrupted):
        list(interrupts.between(waiting()))


def test_after_the_first_signal_the_second_is_the_systems():
    with Interrupts() as interrupts:
        for _ in interrupts.between(iter("a")):
            pass
        signal.raise_signal(signal.SIGINT)  # noted: nobody waits for a frame any more
        assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL


def test_in_another_thread_it_does_nothing():
    seen = []

    def work():
        with Interrupts() as interrupts:
            seen.extend(interrupts.between(iter("ab")))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(5)
    assert seen == ["a", "b"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_elsewhere_a_signal_is_raised_at_once(number):
    with raised_at_once(), pytest.raises(Interrupted) as stop:
        signal.raise_signal(number)
    assert stop.value.number == number


def test_a_run_inside_has_its_own_way_and_gives_it_back():
    with raised_at_once():
        outer = signal.getsignal(signal.SIGINT)
        with Interrupts():
            assert signal.getsignal(signal.SIGINT) != outer
        assert signal.getsignal(signal.SIGINT) == outer
