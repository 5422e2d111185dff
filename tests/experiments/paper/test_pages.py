"""Documents and pages: what they say of trials made by hand."""

from __future__ import annotations

import json
import re

import pytest

import lobula
from lobula.experiments.paper import fig5, fig6
from lobula.experiments.paper.claims import judged
from lobula.experiments.paper.counts import mean_text, share_text
from lobula.experiments.paper.figure import Plan
from lobula.experiments.paper.pages import as_text, document, figure_page, gathered_page
from lobula.experiments.paper.setups import setup_table

from .made import angles, four_courses, where

PLAN = Plan(presets={"paper": lobula.preset("paper")}, seeds=range(201, 211))


@pytest.fixture(scope="module")
def trials():
    """All as the paper says, but for translation at the slowest speed."""
    return where(
        four_courses("fig5"), lambda t: t.label == "s40" and t.motion == "translation_right",
        spikes={"lgmd1": 20, "lgmd2": 20, "lptc_r": 5, "lptc_l": 0},
    )  # fmt: skip


@pytest.fixture(scope="module")
def found(trials):
    return document(fig5.FIGURE, PLAN, list(judged(fig5.CLAIMS, trials)), "scene")


def test_the_document_is_plain_and_complete(found) -> None:
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    (first,) = (claim for claim in found["claims"] if claim["number"] == "5.1")
    of = first["verdicts"]["paper"]
    assert (of["status"], of["held"], of["trials"]) == ("holds in part", 100, 120)  # 2 of 12 conditions fail
    assert of["ours"] == "100 of 120 (76 to 89 %)"  # Wilson: 0.7565 and 0.8894
    assert of["reason"]
    assert sum(one["held"] == 0 for one in of["conditions"]) == 2
    assert found["seeds"] == list(range(201, 211))
    assert len(found["claims"]) == len(fig5.CLAIMS)


def test_reasons_are_given_for_what_fails_only(found) -> None:
    for claim in found["claims"]:
        of = claim["verdicts"]["paper"]
        assert not (of["status"] == "holds" and of["reason"])


def test_the_page_shows_every_claim_with_its_numbers(found, trials) -> None:
    text = as_text(figure_page(fig5.FIGURE, PLAN, trials, found, {"paper": "fig5.png"}))
    assert text.startswith("# Fig. 5: ")
    assert "![Spikes at three speeds, preset paper](fig5.png)" in text
    for claim in fig5.CLAIMS:
        assert f"### {claim.number}\n" in text
        assert f"| {claim.number} | {claim.paper} |" in text
    assert "| translation rightward, s40 = 4 cm/s | 0/10 | LPTC-R 5 (5 to 5), LGMD-1 20 (20 to 20)" in text
    assert all(len(line) <= 120 for line in text.splitlines() if line[:1] not in "|#!")


@pytest.mark.parametrize(
    ("plan", "options"),
    [
        (Plan(presets=dict.fromkeys(("paper", "published")), seeds=range(10)), ""),
        (Plan(presets=dict.fromkeys(("paper", "published")), seeds=range(2), side_seeds=1), " --quick"),
        (Plan(presets=dict.fromkeys(("paper", "published")), seeds=range(3), side_seeds=1), " --quick --seeds 3"),
        (Plan(presets={"published": None}, seeds=range(4)), " --seeds 4 --preset published"),
    ],
)
def test_the_command_is_the_one_that_makes_it_so(plan, options) -> None:
    assert plan.command("fig5") == f"lobula reproduce fig5 --out DIR{options}"


def test_gathered_claim_by_claim(found) -> None:
    other = found | {"figure": "table1", "title": "Closed loop", "command": "lobula reproduce table1 --out DIR"}
    text = as_text(gathered_page([found, other], "paper/"))
    assert "| Fig. 5: Spikes at three speeds | `lobula reproduce fig5 --out DIR --preset paper` | `paper`: " in text
    assert "## Table 1\n" in text
    assert "](paper/fig5.png)" in text
    assert "](paper/table1.md)" in text
    assert "- 5.1, `paper`: " in text


def test_other_set_ups_in_a_table(trials) -> None:
    near = where(trials, lambda t: True, setup="nearer")
    lines = list(setup_table(fig5.CLAIMS[:2], [*trials, *(t for t in near if t.seed < 5)], ["nearer"]))
    assert lines[2:] == ["| as above | paper | 83 % | 100 % |", "| nearer | paper | 83 % | 100 % |"]


@pytest.mark.parametrize(
    ("values", "text"),
    [([], "none"), ([3], "3"), ([4, 4, 4], "4 (4 to 4)"), ([float("nan"), 2], "2")],
)
def test_means(values, text) -> None:
    assert mean_text(values) == text


def test_means_have_an_interval_around_them() -> None:
    text = mean_text([1, 2, 3, 4, 5])
    mean, low, high = (float(number) for number in re.findall(r"[\d.]+", text))
    assert mean == 3
    assert 1 < low < 3 < high < 5


def test_shares() -> None:
    assert share_text(9, 10) == "9 of 10 (60 to 98 %)"  # Wilson, by hand: 0.596 and 0.982


def test_figures_are_drawn_of_the_trials(trials) -> None:
    pytest.importorskip("matplotlib")
    trials = [t for t in trials if t.seed < 2]
    assert len(fig5.draw(PLAN, trials, "paper").axes) == 12  # three speeds, four courses
    assert len(fig6.draw(PLAN, [t for t in angles() if t.seed < 2], "paper").axes) == 7  # the plan and six speeds
