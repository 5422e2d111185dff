"""The ring: the last seconds in full, no more memory than allowed, always from a key frame on."""

from hypothesis import given
from hypothesis import strategies as st

from lobula.report.h264 import Coded
from lobula.report.ring import Ring, Slot

from .approach import reading


def slot(number, time_s, key, size=100):
    return Slot(number, reading(0)._replace(time_s=time_s), Coded(bytes(size), round(time_s * 90_000), key))


def filled(ring, count, rate_hz=10, size=100):
    for i in range(count):
        ring.add(slot(i, i / rate_hz, i % rate_hz == 0, size))
    return [s.number for s in ring]


def test_the_last_seconds_from_a_key_frame_on():
    # at 4.9 s: of the last 2 s frame 29 is the first, its group began at 20
    assert filled(Ring(2.0), 50) == list(range(20, 50))
    assert filled(Ring(0.0), 50) == list(range(40, 50))
    assert filled(Ring(99.0), 50) == list(range(50))


def test_what_lies_before_a_gap_goes_with_its_last_frame():
    ring = Ring(2.0)
    filled(ring, 15)
    ring.add(slot(15, 3.3, True))
    assert [s.number for s in ring] == list(range(10, 16))
    ring.add(slot(16, 3.5, False))
    assert [s.number for s in ring] == [15, 16]  # frame 14 was at 1.4 s


def test_memory_is_bounded_and_says_so():
    ring = Ring(10.0, most_bytes=2500)
    numbers = filled(ring, 100)
    assert ring.size_bytes <= 2500
    assert numbers == list(range(80, 100))
    assert ring.cut_short


def test_when_less_changes_again_nothing_is_cut_short():
    ring = Ring(1.0, most_bytes=2500)
    for i in range(40):
        ring.add(slot(i, i / 10, i % 10 == 0, size=400 if i < 20 else 10))
    assert not ring.cut_short
    assert [s.number for s in ring] == list(range(20, 40))


@given(
    st.lists(st.tuples(st.floats(0.001, 3.0), st.booleans(), st.integers(0, 900)), min_size=1, max_size=80),
    st.floats(0, 5),
)
def test_nothing_that_is_asked_for_is_missing_unless_it_is_said(steps, before_s):
    ring, time_s, all_slots = Ring(before_s, most_bytes=5000), 0.0, []
    for number, (step_s, key, size) in enumerate(steps):
        time_s += step_s
        one = slot(number, time_s, key or number == 0, size)
        all_slots.append(one)
        ring.add(one)
    held = list(ring)
    assert held == all_slots[-len(held) :]
    assert held[0].coded.key
    assert ring.size_bytes == sum(len(s.coded.data) for s in held)
    if not ring.cut_short:
        assert {s.number for s in all_slots if time_s - s.reading.time_s <= before_s} <= {s.number for s in held}
