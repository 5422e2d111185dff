"""A tiny battery and a tiny arena: the search finds what trying everything finds, and its results say what they are."""

from __future__ import annotations

import csv
import json

import pytest

from lobula.errors import ParameterError
from lobula.model.presets import preset
from lobula.stimuli.battery import battery
from lobula.tuning.arena_task import arena_task
from lobula.tuning.battery_task import battery_task
from lobula.tuning.journal import opened
from lobula.tuning.plan import Budget, Plan
from lobula.tuning.results import document, held_out_of, write_results
from lobula.tuning.search import tune
from lobula.tuning.space import axes, settings_at

SPIKES = "decision.collision_spikes"
NAMES = (
    "looming-dark-12cm_s", "looming-arena",
    "translating_right-dark-12cm_s", "translating_left-dark-12cm_s",
    "translating_right-arena", "translating_left-arena",
)  # fmt: skip


def cases(*names):
    return [case for case in battery() if case.name in names]


@pytest.fixture(scope="module")
def task(tmp_path_factory):
    return battery_task(tmp_path_factory.mktemp("films"), cases(*NAMES))


@pytest.fixture(scope="module")
def found(task, tmp_path_factory):
    """The paper preset without its LPTCs' veto and so deaf that it never alarms, its two values searched."""
    folder = tmp_path_factory.mktemp("found")
    base = settings_at(preset("paper"), {SPIKES: 100, "decision.lptc_weight": 0.0}, "spoilt")
    wanted = axes(base, [f"{SPIKES}=1..100", "decision.lptc_weight=0..2"])
    plan = Plan(task=task, base=base, preset="paper", axes=wanted, budget=Budget(trials=40))
    with opened(folder) as journal:
        return tune(plan, journal), folder


def test_it_finds_what_trying_everything_finds(found, task):
    search, _ = found
    train = task.splits["battery"].train
    assert search.preset.values[0] == 1.0  # deaf: both approaches missed
    tried = [
        task.measure(settings_at(search.plan.base, {SPIKES: n, "decision.lptc_weight": w}, "tried"), train)
        for n in (1, 2, 4, 8, 16) for w in (0.0, 0.5, 1.0, 2.0)
    ]  # fmt: skip
    assert search.best.merit >= max(tally.merit for tally in tried) == 1.0  # every hit, no false alarm
    assert search.best.objectives[:2] == (0.0, 0.0)
    assert search.best.values[SPIKES] <= 16


def test_the_optimum_holds_on_what_was_held_out(found):
    search, _ = found
    scored = held_out_of(search, search.best)
    assert scored.about["clips"] == 3
    assert scored.values[0] == 0.0  # the preset paper sees it too


def test_its_measure_is_what_it_says(found, task):
    search, _ = found
    again = task.measure(search.plan.settings(search.best), task.splits["battery"].train)
    assert again.values == search.best.objectives
    assert again.as_dict() == search.best.about


def test_the_document(found):
    search, _ = found
    about = json.loads(json.dumps(document(search), allow_nan=False))
    assert about["measured_on"]["on"] == "battery"
    assert about["begun_with"]["preset"] == "paper"
    assert about["searched"][1] == {"path": "decision.lptc_weight", "range": "0..2", "begun_with": 0.0}
    assert about["trials"] == {"battery": {"measured": 40, "given_up": 0}}
    assert about["best"]["searched_on"]["hits"] == 1
    assert about["best"]["held_out"]["collisions"] == 1
    assert about["speed"]["trials"] == 40
    assert about["speed"]["times_real_time_per_core"] > 0
    assert set(about["parts"]["battery"]["train"]) == set(NAMES) - set(about["parts"]["battery"]["held_out"])


def test_the_files(found):
    search, folder = found
    pytest.importorskip("matplotlib", reason="the extra plot is not installed")
    write_results(search, folder)
    assert json.loads((folder / "tuning.json").read_text()) == json.loads(json.dumps(document(search)))
    assert (folder / "front.png").read_bytes().startswith(b"\x89PNG")
    assert "</svg>" in (folder / "front.svg").read_text()
    with (folder / "trials.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 40
    assert {int(row["trial"]) for row in rows if row["front"] == "1"} == {trial.number for trial in search.front}
    best = rows[search.best.number]
    assert int(best[SPIKES]) == search.best.values[SPIKES]
    assert float(best["missed"]) == 0.0


def test_a_battery_without_an_approach_is_refused(tmp_path):
    with pytest.raises(ParameterError, match="search battery: no collision among 1 movies"):
        battery_task(tmp_path, cases("still-plain"))


def test_the_arena_is_measured_as_it_is_run():
    from lobula.arena import NetworkController, World, run

    task = arena_task([41], [42], 0.05, [4, 2])
    base = preset("lobula")
    tally = task.measure(base, task.splits["arena"].train)
    runs = [run(World(), NetworkController(base), seed=41, minutes=0.05, robots=n).score for n in (4, 2)]
    assert tally.score == runs[0] + runs[1]


def test_a_search_in_the_arena(tmp_path):
    task = arena_task([41], [42], 0.05, [4])
    plan = Plan(
        task=task, base=preset("lobula"), preset="lobula", axes=axes(preset("lobula")), budget=Budget(trials=2)
    )  # fmt: skip
    with opened(tmp_path) as journal:
        found = tune(plan, journal)
    assert [len(trial.objectives) for trial in found.trials["arena"]] == [2, 2]
    assert set(found.held_out) == {trial.number for trial in found.front}
    about = document(found)
    assert about["best"]["held_out"]["robot_minutes"] == pytest.approx(0.2)
    pytest.importorskip("matplotlib", reason="the extra plot is not installed")
    write_results(found, tmp_path)
