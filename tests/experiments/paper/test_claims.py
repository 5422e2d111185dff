"""Claims judged on trials made by hand: what must hold holds, and each claim fails on what speaks against it."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from lobula.experiments.paper import fig4, fig5, fig6
from lobula.experiments.paper.claims import Claim, Finding, Verdict, judged
from lobula.experiments.paper.reasons import REASONS
from lobula.experiments.paper.trials import Trial

from .made import angles, four_courses, made, where

IDEAL = {
    "fig4": [t for t in four_courses("fig4") if t.speed_cm_s == 10.9],
    "fig5": four_courses("fig5"),
    "fig6": angles(),
}
CLAIMS = {"fig4": fig4.CLAIMS, "fig5": fig5.CLAIMS, "fig6": fig6.CLAIMS}


def statuses(figure: str, trials: list[Trial]) -> dict[str, str]:
    return {v.number: v.status for v in judged(CLAIMS[figure], trials)}


def verdict(*shown: tuple[int, int]) -> Verdict:
    findings = tuple(Finding("", held, trials, str) for held, trials in shown)
    return Verdict(number="1", paper="", rule="", preset="paper", findings=findings)


@pytest.mark.parametrize(
    ("shown", "status"),
    [
        ([(9, 10), (10, 10)], "holds"),
        ([(8, 10), (10, 10)], "holds in part"),
        ([(0, 10), (10, 10)], "holds in part"),  # half of all
        ([(0, 10), (9, 10)], "does not hold"),
        ([(0, 0)], "does not hold"),  # nothing was tried
        ([], "does not hold"),
    ],
)
def test_status(shown: list[tuple[int, int]], status: str) -> None:
    assert verdict(*shown).status == status


def test_the_share_is_of_all_trials_and_its_interval_is_wilsons() -> None:
    v = verdict((3, 5), (5, 5))
    assert (v.held, v.trials) == (8, 10)
    assert v.interval == pytest.approx((0.4902, 0.9433), abs=1e-4)  # 8 of 10 in Wilson's own form, by hand


@pytest.mark.parametrize("figure", CLAIMS)
def test_everything_holds_if_the_paper_is_right_in_everything(figure: str) -> None:
    found = statuses(figure, IDEAL[figure])
    assert set(found.values()) == {"holds"}
    assert list(found) == [claim.number for claim in CLAIMS[figure]]


def motion(*names: str) -> Callable[[Trial], bool]:
    return lambda t: t.motion in names


TRANSLATIONS = ("translation_right", "translation_left")


@pytest.mark.parametrize(
    ("figure", "wanted", "spikes", "failing"),
    [
        # all silent: nothing that is to spike does
        ("fig4", motion("recession"), (0, 0, 0, 0), {"4.2"}),
        ("fig4", motion("recession"), (8, 1, 0, 0), {"4.3"}),
        ("fig4", motion("approach"), (60, 60, 1, 0), {"4.4"}),
        ("fig4", motion("translation_right"), (20, 20, 400, 1), {"4.5"}),
        ("fig4", motion("translation_left"), (20, 20, 400, 0), {"4.6"}),
        ("fig4", motion(*TRANSLATIONS), (20, 0, 0, 0), {"4.5", "4.6", "4.7"}),
        ("fig5", motion(*TRANSLATIONS), (20, 20, 39, 39), {"5.1", "5.4"}),
        ("fig5", motion("approach", "recession"), (60, 60, 5, 5), {"5.2", "5.4", "5.5", "5.6", "5.7"}),
        ("fig5", motion("approach"), (20, 20, 0, 0), {"5.4", "5.5", "5.6"}),
        ("fig5", motion("recession"), (8, 1, 0, 0), {"5.7"}),
        ("fig6", lambda t: abs(t.angle_deg) >= 45, (0, 0, 0, 0), {"6.1", "6.2", "6.3", "6.6"}),
        ("fig6", lambda t: t.angle_deg < 0, (10, 10, 0, 20), {"6.1", "6.2", "6.6"}),
        ("fig6", lambda t: t.angle_deg > 0, (10, 10, 20, 0), {"6.1", "6.3", "6.6"}),
        ("fig6", lambda t: t.angle_deg == 0, (10, 10, 12, 0), {"6.4", "6.5"}),
    ],
)
def test_each_claim_fails_on_what_speaks_against_it(
    figure: str, wanted: Callable[[Trial], bool], spikes: tuple[int, ...], failing: set[str]
) -> None:
    changed = dict(zip(("lgmd1", "lgmd2", "lptc_r", "lptc_l"), spikes, strict=True))
    halves = {n: c // 2 for n, c in changed.items()}
    trials = where(IDEAL[figure], wanted, spikes=changed, spikes_course=changed, fastest=halves)
    found = statuses(figure, trials)
    assert {number for number, status in found.items() if status != "holds"} == failing


@pytest.mark.parametrize(
    ("changes", "failing"),
    [
        ({"burst_s": {"lgmd1": 1.2}}, "4.2"),
        ({"peak": {"lgmd1": 0.96, "lgmd2": 0.5, "lptc_r": 0.0, "lptc_l": 0.0}}, "4.1"),
    ],
)
def test_a_long_or_a_strong_answer_to_recession_counts_against_the_paper(
    changes: dict[str, dict[str, float]], failing: str
) -> None:
    found = statuses("fig4", where(IDEAL["fig4"], motion("recession"), **changes))
    assert {number for number, status in found.items() if status != "holds"} == {failing}


def test_decisions_are_claims_too() -> None:
    late = where(IDEAL["fig5"], motion("approach"), alarm_s=3.1)
    assert statuses("fig5", late)["5.10"] == "holds in part"
    passing = where(IDEAL["fig5"], motion(*TRANSLATIONS), alarm_s=1.0)
    assert statuses("fig5", passing)["5.10"] == "does not hold"  # two of three courses
    leaving = where(IDEAL["fig5"], motion("recession"), lgmds_alarm_s=1.0)
    assert statuses("fig5", leaving)["5.9"] == "does not hold"


def test_another_pattern_at_one_speed_is_inconsistent() -> None:
    slow = where(
        IDEAL["fig5"], lambda t: t.motion in TRANSLATIONS and t.label == "s40",
        spikes={"lgmd1": 20, "lgmd2": 20, "lptc_r": 5, "lptc_l": 5},
    )  # fmt: skip
    found = statuses("fig5", slow)
    assert found["5.8"] == "holds in part"
    assert found["5.1"] == "holds in part"


def test_presets_and_set_ups_are_judged_apart() -> None:
    claim = Claim(
        number="0", paper="", rule="", judge=lambda trials: [Finding("", len(trials), len(trials), str)],
    )  # fmt: skip
    spikes = dict.fromkeys(("lgmd1", "lgmd2", "lptc_r", "lptc_l"), 0)
    trials = [
        made("fig5", "approach", spikes), made("fig5", "approach", spikes, preset="published"),
        made("fig5", "approach", spikes, setup="near"),
    ]  # fmt: skip
    assert [(v.preset, v.trials) for v in judged([claim], trials)] == [("paper", 1), ("published", 1)]
    assert [(v.preset, v.trials) for v in judged([claim], trials, "near")] == [("paper", 1)]


def test_reasons_are_given_for_claims_that_there_are() -> None:
    numbers = {claim.number for claims in CLAIMS.values() for claim in claims}
    assert {number for number, _ in REASONS} <= numbers
    assert {preset for _, preset in REASONS} == {"paper", "published"}
