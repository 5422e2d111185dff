"""Scores of hand-made event tables."""

from __future__ import annotations

import csv
import io
import json
import math

import numpy as np
import pytest

from lobula.arena.events import event_table
from lobula.arena.scoring import Score, Tally, by_incidence, counts, over_time, tally, total
from lobula.errors import ParameterError
from lobula.intervals import wilson


def events(**kinds):
    """A table with so many events of each kind, one a second, and the same by the geometric rule."""
    rows = [kind for kind, number in kinds.items() for _ in range(number)]
    return event_table([{"time_s": float(t), "kind": kind, "geometric": kind} for t, kind in enumerate(rows)])


def test_rates_by_the_papers_formulas():
    score = Tally(cr=10, cp=5, aa=80, at=10, ap=95)
    assert score.sr1 == 0.95
    assert score.sr2 == 0.8
    assert score.sr1_interval == wilson(95, 100)
    assert score.sr2_interval == wilson(80, 100)


def test_a_run_without_events_has_no_rates():
    score = counts(event_table())
    assert math.isnan(score.sr1)
    assert math.isnan(score.sr2)
    assert math.isnan(score.spurious_per_robot_minute)
    assert score.sr1_interval == (0.0, 1.0)
    flat = score.as_dict()
    assert flat["SR1"] is None
    assert flat["spurious_per_robot_minute"] is None
    assert flat["CR"] == 0


def test_each_kind_is_counted_under_its_own_name():
    got = tally(events(CR=1, CP=2, AA=3, AT=4, AP=5, spurious=6))
    assert got == Tally(cr=1, cp=2, aa=3, at=4, ap=5, spurious=6)


def test_the_geometric_column_is_counted_beside():
    table = events(AA=2, AP=3)
    table["geometric"] = ["AT", "AA", "AP", "AP", "spurious"]
    score = counts(table)
    assert (score.aa, score.at, score.ap, score.spurious) == (2, 0, 3, 0)
    assert score.geometric == Tally(aa=1, at=1, ap=2, spurious=1)


def test_unseen_contacts_stay_in_the_headline_and_are_told_apart():
    table = events(CR=4, CP=3, AA=6, AP=7)
    table["seen"][:4], table["seen_by_other"][:4] = [True, True, False, False], [True, False, True, False]
    table["seen"][4:7] = [True, True, False]
    score = counts(table)
    assert (score.cr, score.unseen_cr, score.cr_views) == (4, 1, 4)
    assert (score.cp, score.unseen_cp) == (3, 1)
    assert score.sr2 == pytest.approx(6 / 10)
    assert score.sr2_seen == pytest.approx(6 / 9)
    assert score.sr1_seen == pytest.approx(7 / 9)


def test_runs_add_up():
    one = counts(events(CR=1, AA=3), robot_minutes=4.0, distance_cm=100.0)
    two = counts(events(AP=2, spurious=5), robot_minutes=6.0, distance_cm=50.0)
    both = total([one, two])
    assert both == one + two
    assert (both.cr, both.aa, both.ap, both.spurious) == (1, 3, 2, 5)
    assert (both.robot_minutes, both.distance_cm) == (10.0, 150.0)
    assert both.geometric == Tally(cr=1, aa=3, ap=2, spurious=5)
    assert both.spurious_per_robot_minute == 0.5
    # Garwood's limits of 5 events are 1.623 and 11.668
    assert both.spurious_interval == pytest.approx((0.1623, 1.1668), abs=1e-4)


def test_scores_by_different_rules_do_not_mix():
    with pytest.raises(ParameterError, match="must be by the same rule"):
        total([Score(), Score(rule="geometric")])
    with pytest.raises(ParameterError, match="must be at least one"):
        total([])


def test_as_dict_goes_into_json_and_csv():
    flat = counts(events(AP=9, CP=1), robot_minutes=2.0).as_dict()
    assert json.loads(json.dumps(flat, allow_nan=False)) == flat
    assert flat["SR1"] == 0.9
    assert (flat["SR1_low"], flat["SR1_high"]) == wilson(9, 10)
    assert flat["geometric_SR1"] == 0.9
    assert flat["rule"] == "counterfactual"
    text = io.StringIO()
    writer = csv.DictWriter(text, flat)
    writer.writeheader()
    writer.writerow(flat)
    assert len(text.getvalue().splitlines()) == 2


def test_rates_over_elapsed_time():
    table = events(AP=3, CP=1)  # at 0, 1, 2 and 3 s
    assert [t.sr1 for t in over_time(table, [0.5, 2.0, 10.0])] == [1.0, 1.0, 0.75]


def test_wall_contacts_by_angle_and_lptc_state():
    table = events(CP=5, AP=1)
    table["incidence_deg"] = [3.0, 40.0, 44.0, 70.0, 90.0, 10.0]
    table["lptc_r"] = [0.0, 0.25, 0.1, np.nan, 0.0, 0.9]
    table["lptc_l"] = [-0.1, 0.0, -0.1, np.nan, -0.2, 0.0]
    got = by_incidence(table)
    assert got.edges_deg.tolist() == [0, 15, 30, 45, 60, 75, 90]
    assert got.active.tolist() == [0, 0, 1, 0, 0, 1]
    assert got.quiet.tolist() == [1, 0, 1, 0, 0, 0]
    assert got.unknown.tolist() == [0, 0, 0, 0, 1, 0]
    avoided = by_incidence(table, "AP", edges_deg=(0, 45, 90))
    assert avoided.active.tolist() == [1, 0]
