"""The queue against a plain list that keeps the newest of each kind."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.hooks.mailbox import Mailbox
from lobula.hooks.message import Message

steps = st.lists(st.sampled_from(["event", "summary", "reading", "take", "take and put back"]), max_size=60)


@settings(max_examples=50)
@given(steps, st.integers(1, 4), st.integers(1, 4))
def test_it_holds_the_newest_in_the_order_they_came(steps, events_kept, readings_kept):
    mailbox, model, lost = Mailbox(events_kept, readings_kept), [], 0
    for number, step in enumerate(steps):
        if not step.startswith("take"):
            message = Message(step, {"number": number})
            model.append(message)
            same = [m for m in model if (m.kind == "reading") == (step == "reading")]
            over = len(same) > (readings_kept if step == "reading" else events_kept)
            if over:
                model.remove(same[0])
                lost += 1
            assert mailbox.put(message) == over
        elif model:
            parcel = mailbox.take()
            assert parcel.message == model[0]
            if step == "take":
                model.pop(0)
            else:
                assert mailbox.put_back(parcel) == 0
        assert len(mailbox) == len(model)
        assert mailbox.dropped == lost
    mailbox.close()
    assert [mailbox.take().message for _ in list(model)] == model
    assert mailbox.take() is None


def test_what_is_put_back_into_a_full_mailbox_is_the_one_to_go():
    mailbox = Mailbox(2, 2)
    for number in range(2):
        mailbox.put(Message("event", {"number": number}))
    parcel = mailbox.take()
    mailbox.put(Message("event", {"number": 2}))
    assert mailbox.put_back(parcel) == 1
    assert [mailbox.take().message.record["number"] for _ in range(2)] == [1, 2]


def test_emptying_counts_what_was_in_it():
    mailbox = Mailbox(5, 5)
    for kind in ("event", "reading", "event"):
        mailbox.put(Message(kind, {}))
    assert (mailbox.empty(), mailbox.dropped, len(mailbox)) == (3, 3, 0)
