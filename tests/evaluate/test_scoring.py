"""The rules of scoring on traces made by hand, at 10 frames a second: frame n is at n / 10 s."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lobula.errors import ShapeError
from lobula.evaluate.labels import Label
from lobula.evaluate.scoring import score_clip
from lobula.evaluate.summary import summarise, totals
from lobula.types import TRACE_DTYPE


def trace(alarms, count, times_s=None, first=0):
    times_s = np.arange(first, first + count) / 10 if times_s is None else times_s
    rows = [(first + i, times_s[i], 0.5, 0.5, 0.0, 0.0, 0, 0, 0, 0, first + i in alarms, "ok") for i in range(count)]
    return np.array(rows, TRACE_DTYPE)


def hit(contact_frame=60, uncertainty_frames=1, **more):
    return Label(file="clip", contact_frame=contact_frame, uncertainty_frames=uncertainty_frames,
                 **{"kind": "crash", **more})  # fmt: skip


def miss(**more):
    return Label(file="clip", contact_frame=None, uncertainty_frames=0, **{"kind": "traffic", **more})


@pytest.mark.parametrize(
    ("start", "verdict"),
    [(39, "false"), (40, "hit"), (50, "hit"), (58, "hit"), (59, "late"), (60, "late"), (65, "late"), (66, "nothing")],
)
def test_the_window_reaches_from_two_seconds_to_two_frames_before_contact(start, verdict):
    score = score_clip(hit(), trace({start}, 100))
    counts = (score.hit, score.false_alarms, score.late)
    assert (
        counts
        == {"hit": (True, 0, 0), "false": (False, 1, 0), "late": (False, 0, 1), "nothing": (False, 0, 0)}[verdict]
    )
    assert score.frames == 66  # contact 60 + 5, and frame 0


def test_an_uncertain_contact_closes_the_window_earlier():
    label = hit(uncertainty_frames=6)
    assert score_clip(label, trace({54}, 100)).hit
    assert score_clip(label, trace({55}, 100)).late == 1


def test_lead_time_is_that_of_the_first_hit():
    score = score_clip(hit(), trace({45, 56}, 100))  # 1.1 s apart: two events
    assert score.lead_s == pytest.approx(1.5)
    assert len(score.alarms) == 2


def test_an_alarm_that_began_before_the_window_is_no_hit():
    score = score_clip(hit(), trace(set(range(35, 60)), 100))
    assert (score.hit, score.false_alarms) == (False, 1)


def test_a_restart_within_half_a_second_is_no_second_alarm():
    assert score_clip(miss(), trace({10, 11, 15, 30}, 100)).false_alarms == 2


def test_footage_before_the_window_and_length_of_the_window():
    score = score_clip(hit(), trace((), 100))
    assert score.footage_s == pytest.approx(4.0)  # 0 s to 4 s
    assert score.window_s == pytest.approx(1.8)  # 4 s to frame 58


def test_a_clip_that_begins_inside_the_window():
    score = score_clip(hit(contact_frame=15), trace((), 30))
    assert score.footage_s == 0.0
    assert score.window_s == pytest.approx(1.3)  # 0 s to frame 13


def test_a_contact_after_the_end_lies_on_the_line_of_the_last_frames():
    score = score_clip(hit(contact_frame=60, uncertainty_frames=5), trace({45}, 50))
    assert score.lead_s == pytest.approx(1.5)  # contact at 6.0 s though the last frame is at 4.9 s
    assert score.window_s == pytest.approx(1.0)  # 4.0 s to the end of the clip, 5.0 s
    assert score.footage_s == pytest.approx(4.0)


def test_a_clip_without_collision_counts_every_start_over_all_of_it():
    score = score_clip(miss(), trace({5, 50, 90}, 100))
    assert (score.false_alarms, score.hit, score.window_s) == (3, False, 0.0)
    assert score.footage_s == pytest.approx(10.0)  # the last frame lasts a tenth of a second too


def test_time_is_the_frames_own_not_number_over_rate():
    slow = np.concatenate([np.arange(30) / 10, 3.0 + np.arange(40) / 5])  # 10 Hz, then 5 Hz from frame 30 on
    score = score_clip(hit(contact_frame=50), trace({41}, 70, slow))
    assert score.lead_s == pytest.approx(1.8)  # 7.0 s - 5.2 s
    assert score_clip(hit(contact_frame=50), trace({39}, 70, slow)).false_alarms == 1  # 4.8 s: 2.2 s before


def test_a_trace_that_does_not_begin_at_frame_0():
    assert score_clip(hit(), trace({50}, 30, first=40)).lead_s == pytest.approx(1.0)


def test_an_empty_trace_is_refused():
    with pytest.raises(ShapeError, match="clip: the trace holds no frame"):
        score_clip(miss(), trace((), 0))


def test_totals_by_hand():
    scores = [
        score_clip(hit(), trace({50}, 100)),  # hit, lead 1.0 s, footage 4 s, window 1.8 s
        score_clip(hit(), trace({10, 45}, 100)),  # hit, lead 1.5 s, one false alarm, 4 s
        score_clip(hit(), trace((), 100)),  # miss, 4 s
        score_clip(miss(), trace({20}, 480)),  # one false alarm, 48 s
    ]
    t = totals(scores)
    assert (t.clips, t.collisions, t.hits, t.false_alarms) == (4, 3, 2, 2)
    assert t.minutes == pytest.approx(1.0)  # 4 + 4 + 4 + 48 s
    assert t.per_minute == pytest.approx(2.0)
    assert t.per_minute_interval == pytest.approx((0.242, 7.225), abs=1e-3)  # Poisson limits of 2, over one minute
    assert t.median_lead_s == pytest.approx(1.25)
    assert t.chance_hit_rate == pytest.approx(1 - math.exp(-2 / 60 * 1.8))
    # Wilson of 2 in 3, worked by hand: (0.6667 + 0.6402 -+ 1.96 sqrt(0.07407 + 0.10671)) / 2.2805
    assert t.hit_interval == pytest.approx((0.2077, 0.9385), abs=2e-4)


def test_near_misses_and_low_confidence_stand_apart():
    scores = [
        score_clip(hit(), trace({50}, 100)),
        score_clip(miss(event="NEAR MISS: cyclist"), trace({5, 50}, 100)),
        score_clip(hit(confidence="low"), trace((), 100)),
    ]
    summary = summarise(scores)
    assert (summary.headline.clips, summary.headline.false_alarms, summary.headline.collisions) == (1, 0, 1)
    assert list(summary.apart) == ["near miss", "low confidence"]
    assert summary.apart["near miss"].false_alarms == 2
    assert list(summary.classes) == ["crash"]


def test_classes_share_the_headlines_rate_of_chance():
    scores = [score_clip(hit(), trace((), 100)), score_clip(miss(), trace({20}, 560))]  # 1 in 4 + 56 s
    summary = summarise(scores)
    assert summary.classes["crash"].chance_hit_rate == pytest.approx(1 - math.exp(-1.8 / 60))
    assert summary.classes["crash"].per_minute == 0.0
    assert summary.classes["traffic"].chance_hit_rate is None


def test_no_footage_no_rate():
    t = totals([score_clip(hit(contact_frame=15), trace((), 30))])
    assert (t.per_minute, t.per_minute_interval, t.chance_hit_rate, t.median_lead_s) == (None, None, None, None)
