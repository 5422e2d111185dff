"""Calls are made in order by somebody else, whoever has to wait for them."""

from __future__ import annotations

import threading

from lobula.runtime.courier import Courier


def asleep():
    """A call that lasts until it is told to end, and what tells it; and what says that it began."""
    begun, woken = threading.Event(), threading.Event()

    def call():
        begun.set()
        woken.wait(30)

    return call, begun, woken


def test_in_order_and_all_of_them():
    made, courier = [], Courier("test")
    for number in range(1000):
        courier.send(lambda number=number: made.append(number))
    courier.close()
    assert made == list(range(1000))
    assert (courier.lost, courier.error) == (0, None)


def test_nobody_waits_and_the_oldest_are_lost():
    made, courier = [], Courier("test", most=3)
    call, begun, woken = asleep()
    courier.send(call)
    assert begun.wait(30)
    for number in range(10):
        courier.send(lambda number=number: made.append(number))
    assert courier.lost == 7
    woken.set()
    courier.close()
    assert made == [7, 8, 9]


def test_what_is_not_made_in_time_is_given_up_and_counted():
    made, courier = [], Courier("test")
    call, begun, woken = asleep()
    courier.send(call)
    courier.send(lambda: made.append(1))
    assert begun.wait(30)
    courier.close(0.01)
    assert courier.lost == 2
    woken.set()
    courier.close()
    assert made == []
    assert courier.lost == 2


def test_the_first_failure_is_the_last_call():
    made, courier = [], Courier("test")
    error = OSError("gone")

    def fail():
        raise error

    courier.send(fail)
    courier.send(lambda: made.append(1))
    courier.close()
    courier.send(lambda: made.append(2))
    assert courier.error is error
    assert made == []


def test_one_that_was_never_used_ends_at_once():
    courier = Courier("test")
    courier.close()
    assert courier.lost == 0
