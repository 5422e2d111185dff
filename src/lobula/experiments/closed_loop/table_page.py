"""Table I for people: the paper's numbers beside ours, what stands behind them, and claim by claim what holds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...arena.scoring import Score
from ...params import settings_hash
from .beyond_claims import RULE as BEYOND_RULE
from .paper_table import PAPER
from .table_claims import RULE
from .table_jobs import CONTROL_SHARE, Groups, TablePlan
from .table_plots import Model, controls, models, own_models
from .tables import Group, contrast, interval_text, sr1, sr2

Document = Mapping[str, Any]

TEST_SEEDS = range(7000, 8000)
"""The protocol's: all others are for calibration."""

PROTOCOL_MINUTES = 60.0


def page(plan: TablePlan, groups: Groups, found: Document, pictures: Mapping[str, str]) -> Iterator[str]:
    """Yield the lines of ``table1.md``; ``pictures`` are the files of the drawings and what they show."""
    yield "# Table I: success rates in the arena"
    yield ""
    yield from _warning(plan, bool(found["quick"]))
    yield from _made_by(plan, groups, found)
    first, *others = pictures.items()
    yield from _picture(*first)
    yield ""
    yield "## Success rates"
    yield ""
    yield from _rates(plan, groups)
    yield ""
    yield "## What was counted"
    yield ""
    yield from _counts(plan, groups)
    yield ""
    yield "## What else the rates hang on"
    yield ""
    yield from _beside(plan, groups)
    yield ""
    yield "## Differences between models, paired by seed"
    yield ""
    yield from _differences(plan, groups)
    for name, about in others:
        yield from _picture(name, about)
    yield ""
    yield "## Claims"
    yield ""
    yield RULE
    yield ""
    yield from _claims(found["claims"], [f"preset `{name}`" for name in plan.presets])
    if plan.own:
        yield ""
        yield "## Beyond the paper"
        yield ""
        yield BEYOND_RULE
        yield ""
        yield from _claims(found["beyond"], [f"preset `{name}`" for name in plan.own])


def _warning(plan: TablePlan, quick: bool) -> Iterator[str]:
    if quick:
        yield (
            f"**A quick look, no result:** {plan.minutes:g} simulated minutes a run instead of an hour, seeds for "
            "calibration. The protocol asks for an hour on each of ten test seeds."
        )
        yield ""
    elif any(seed not in TEST_SEEDS for seed in plan.seeds):
        yield "**No result of the protocol:** these seeds are for calibration; test seeds begin with 7001."
        yield ""
    elif plan.minutes != PROTOCOL_MINUTES:
        yield f"**No result of the protocol:** it asks for an hour of each, not {plan.minutes:g} minutes."
        yield ""


def _made_by(plan: TablePlan, groups: Groups, found: Document) -> Iterator[str]:
    worlds = {done.job.robots: settings_hash(done.job.world) for group in groups.values() for done in group.results}
    yield (
        f"Made by `{found['command']}`, lobula {found['version']}, code `{found['code']}`, seeds "
        f"{plan.seeds[0]} to {plan.seeds[-1]}, {plan.minutes:g} simulated minutes for each model, number of robots and "
        f"seed. Arena {', '.join(f'`{worlds[robots]}` with {robots} robots' for robots in sorted(worlds))}; "
        + ", ".join(f"preset `{name}` `{value}`" for name, value in found["presets"].items())
        + ". Every job is a row of `table1.csv`, every contact and avoidance one of `table1-events.csv`."
    )
    yield ""
    yield (
        "SR1 = AP/(AP+CP), SR2 = AA/(AA+AT+CR). CR, CP: contacts with robots and with the periphery, each counted, "
        "seen or not. AA, AT, AP: avoidances of approaching robots, of translating robots, of the periphery; spurious: "
        "of nothing near. The cause of an avoidance is what must be left out of the pictures of the last second for "
        "the alarm to go away. Intervals are of 95 %."
    )


def _picture(name: str, about: str) -> Iterator[str]:
    yield ""
    yield f"![{about}]({name})"
    yield ""
    yield f"{about}."


def _rates(plan: TablePlan, groups: Groups) -> Iterator[str]:
    yield "In brackets Wilson's interval, then that of a bootstrap over the seeds."
    yield ""
    yield "| robots | model | SR1, paper | SR1, ours | SR2, paper | SR2, ours |"
    yield "|--:|---|--:|---|--:|---|"
    for robots in plan.densities:
        for model in (*models(plan), *controls()):
            group = groups[model.key, robots]
            theirs = PAPER.get((robots, model.neurons or ""))
            score = group.score
            ours = (
                _rate(score.sr1, score.sr1_interval, group, sr1),
                _rate(score.sr2, score.sr2_interval, group, sr2),
            )
            paper = ("", "") if theirs is None else (f"{theirs.sr1} %", f"{theirs.sr2} %")
            yield f"| {robots} | {model.label} | {paper[0]} | {ours[0]} | {paper[1]} | {ours[1]} |"
    yield ""
    yield (
        f"The last three do not look; they ran {plan.minutes / CONTROL_SHARE:.3g} minutes a seed. Random turns are as "
        "frequent, in a minute of driving, as the avoidances of the proposed model with the same seed."
    )


def _rate(value: float, wilson: tuple[float, float], group: Group, statistic: Any) -> str:
    if value != value:
        return "nothing to count"
    over_seeds = contrast("", [group], statistic, "")
    low, high = (100 * end for end in wilson)
    return f"**{100 * value:.1f} %** ({low:.1f} to {high:.1f}) {interval_text(over_seeds.low, over_seeds.high)}"


def _counts(plan: TablePlan, groups: Groups) -> Iterator[str]:
    yield "| robots | model | CR | CP | AA | AT | AP | spurious | robot-hours |"
    yield "|--:|---|--:|--:|--:|--:|--:|--:|--:|"
    for robots, model, score in _scores(plan, groups):
        numbers = (score.cr, score.cp, score.aa, score.at, score.ap, score.spurious)
        cells = " | ".join(str(number) for number in numbers)
        yield f"| {robots} | {model.label} | {cells} | {score.robot_minutes / 60:.3g} |"


def _beside(plan: TablePlan, groups: Groups) -> Iterator[str]:
    yield (
        "*Unseen*: contacts that no robot in them could have seen coming, because it turned or the other one was never "
        "in view in the last second; *seen only*: rates without them. *By place*: causes by the nearest thing in view "
        "alone, no picture drawn again: by that rule a robot that always turns has a fine SR1, so it is no headline."
    )
    yield ""
    yield (
        "| robots | model | spurious a robot-minute | m driven an hour | unseen CR | unseen CP | SR1, SR2 seen only "
        "| SR1, SR2 by place |"
    )
    yield "|--:|---|---|--:|--:|--:|--:|--:|"
    for robots, model, score in _scores(plan, groups):
        low, high = score.spurious_interval
        hours = score.robot_minutes / 60
        yield (
            f"| {robots} | {model.label} | {score.spurious_per_robot_minute:.3f} ({low:.3f} to {high:.3f}) "
            f"| {score.distance_cm / 100 / hours:.0f} | {_share(score.unseen_cr, score.cr)} "
            f"| {_share(score.unseen_cp, score.cp)} | {_pair(score.sr1_seen, score.sr2_seen)} "
            f"| {_pair(score.geometric.sr1, score.geometric.sr2)} |"
        )


def _differences(plan: TablePlan, groups: Groups) -> Iterator[str]:
    yield "| robots | the first less the second | SR1, points | SR2, points |"
    yield "|--:|---|---|---|"
    for preset in plan.presets:
        three = list(models(plan, preset))
        words = f", {preset}" if len(plan.presets) > 1 else ""
        for robots in plan.densities:
            pairs = [(three[2], three[0]), (three[2], three[1]), (three[1], three[0])]
            pairs += [(own, other) for own in own_models(plan) for other in three]
            for first, second in pairs:
                pair = [groups[first.key, robots], groups[second.key, robots]]
                cells = [_difference(pair, rate) for rate in (sr1, sr2)]
                yield f"| {robots} | {first.label} less {second.label}{words} | {cells[0]} | {cells[1]} |"


def _difference(pair: Sequence[Group], rate: Any) -> str:
    return contrast("", pair, lambda a, b: rate(a) - rate(b), "").numbers.replace("  ", " ")


def _claims(claims: Sequence[Document], columns: Sequence[str]) -> Iterator[str]:
    yield f"| claim | what is claimed | {' | '.join(columns)} |"
    yield f"|---|---|{'---|' * len(columns)}"
    for claim in claims:
        cells = [f"**{of['status']}**: {of['ours']}" for of in claim["verdicts"].values()]
        yield f"| {claim['number']} | {claim['paper']} | {' | '.join(cells)} |"
    for claim in claims:
        yield ""
        yield f"### {claim['number']}"
        yield ""
        yield f"{claim['paper']} Right if {claim['rule']}."
        for preset, of in claim["verdicts"].items():
            yield ""
            yield f"`{preset}`: **{of['status']}**, {of['ours']}. {of['reason']}".rstrip()
            yield ""
            yield "| condition | ours (95 %) | |"
            yield "|---|---|---|"
            for one in of["conditions"]:
                yield f"| {one['condition']} | {one['numbers']} | {one['verdict']} |"


def _scores(plan: TablePlan, groups: Groups) -> Iterator[tuple[int, Model, Score]]:
    for robots in plan.densities:
        for model in (*models(plan), *controls()):
            yield robots, model, groups[model.key, robots].score


def _share(part: int, whole: int) -> str:
    return f"{100 * part / whole:.0f} %" if whole else "none"


def _pair(*shares: float) -> str:
    return ", ".join("none" if share != share else f"{100 * share:.1f} %" for share in shares)
