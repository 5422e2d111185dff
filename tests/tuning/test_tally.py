"""Objectives and the rule by which one of the front is picked, by hand."""

from __future__ import annotations

import json
import math

import pytest

from lobula.arena.scoring import Score
from lobula.errors import ParameterError
from lobula.evaluate.labels import Label
from lobula.evaluate.scoring import ClipScore
from lobula.tuning.tally import ArenaTally, FilmTally


def scored(collision, lead_s=None, false_alarms=0, footage_s=30.0):
    label = Label(file="x", contact_frame=90 if collision else None, uncertainty_frames=0, kind="k")
    return ClipScore(label=label, frames=90, alarms=(), lead_s=lead_s, false_alarms=false_alarms, late=0,
                     footage_s=footage_s, window_s=2.0 if collision else 0.0)  # fmt: skip


class TestFilms:
    tally = FilmTally((scored(True, 1.2), scored(True, 0.6), scored(True), scored(False, None, 2)))

    def test_objectives(self):
        missed, per_minute, lead_s = self.tally.values
        assert missed == pytest.approx(1 / 3)
        assert per_minute == pytest.approx(1.0)  # 2 in 4 times 30 s
        assert lead_s == pytest.approx(0.6)  # (1.2 + 0.6 + 0) / 3

    def test_merit_is_the_hit_rate_above_chance(self):
        chance = 1 - math.exp(-1.0 / 60 * 2.0)  # one a minute, windows of 2 s
        assert self.tally.merit == pytest.approx(2 / 3 - chance)

    def test_two_add_up_as_if_they_had_been_one(self):
        first, second = FilmTally(self.tally.scores[:1]), FilmTally(self.tally.scores[1:])
        assert first + second == self.tally

    def test_it_goes_into_json(self):
        about = json.loads(json.dumps(self.tally.as_dict(), allow_nan=False))
        assert (about["hits"], about["collisions"], about["false_alarms"], about["minutes"]) == (2, 3, 2, 2.0)

    @pytest.mark.parametrize(
        ("scores", "says"),
        [
            ((scored(False),), "no collision among 1 movies or clips"),
            ((scored(True, footage_s=0.0),), "no footage in which an alarm would be false"),
        ],
    )
    def test_nothing_to_search_by(self, scores, says):
        with pytest.raises(ParameterError, match=says):
            _ = FilmTally(scores).values


class TestArena:
    def test_objectives(self):
        tally = ArenaTally(Score(cr=1, cp=1, aa=6, at=3, ap=3, robot_minutes=2.0))
        assert tally.values == pytest.approx((0.25, 0.4))  # 1 - 3/4, 1 - 6/10
        assert tally.merit == pytest.approx(0.75 + 0.6)
        assert tally.as_dict()["SR1"] == 0.75

    def test_where_nothing_was_met_the_rate_counts_as_none(self):
        tally = ArenaTally(Score())
        assert tally.values == (1.0, 1.0)
        assert json.dumps(tally.as_dict(), allow_nan=False)

    def test_two_runs_add_up(self):
        one = ArenaTally(Score(aa=1, cr=1))
        assert (one + one).score.aa == 2
