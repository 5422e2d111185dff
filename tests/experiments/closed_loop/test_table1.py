"""The table from runs of a few seconds: its files, its resume, and the command."""

from __future__ import annotations

import csv
import json

import pytest

from lobula.errors import ParameterError
from lobula.experiments.closed_loop import table1
from lobula.experiments.closed_loop.pool import run_jobs
from lobula.experiments.closed_loop.table_jobs import TablePlan, control_jobs, grouped, model_jobs
from lobula.model.presets import preset

from .hand_made import done

pytest.importorskip("matplotlib")

PLAN = TablePlan(
    presets={"paper": preset("paper")}, own={"lobula": preset("lobula")}, seeds=range(31, 33), minutes=0.03
)
TABLES = ("table1.csv", "table1-events.csv", "table1.json", "table1.md", "table1.png", "table1-walls.svg")
TIMES = ("seconds_eye", "seconds_network", "seconds_physics", "seconds_scoring")


def rows(folder, name="table1.csv"):
    with (folder / name).open() as file:
        return [{key: value for key, value in row.items() if key not in TIMES} for row in csv.DictReader(file)]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("table")
    steps = []
    return folder, table1.make(PLAN, folder, quick=True, advance=lambda: steps.append(1)), len(steps)


def test_every_job_is_a_row(made):
    folder, _, steps = made
    found = rows(folder)
    assert len(found) == steps == PLAN.job_count == 28
    assert {(row["model"], row["robots"], row["seed"]) for row in found} == {
        (model, robots, seed)
        for model in ("paper-lgmd2", "paper-lgmds", "paper-all", "lobula", "always-turn", "never-turn", "random-turn")
        for robots in ("4", "7")
        for seed in ("31", "32")
    }


def test_every_event_is_a_row(made):
    folder, _, _ = made
    events = rows(folder, "table1-events.csv")
    assert events
    for kind in ("CP", "AP", "AT"):
        assert sum(row["kind"] == kind for row in events) == sum(int(row[kind]) for row in rows(folder))


def test_document_and_page(made):
    folder, found, _ = made
    assert json.loads((folder / "table1.json").read_text()) == found
    assert all((folder / name).stat().st_size for name in TABLES)
    assert {"figure", "title", "command", "presets", "seeds", "claims"} <= set(found)
    page = (folder / "table1.md").read_text()
    assert "**A quick look, no result:**" in page
    assert "| 7 | the proposed model | 83.4 % |" in page
    claims = [*found["claims"], *found["beyond"]]
    assert {verdict["status"] for claim in claims for verdict in claim["verdicts"].values()} == {"undecided"}
    assert [list(claim["verdicts"]) for claim in found["beyond"]] == [["lobula"]] * 3
    assert "## Beyond the paper" in page
    log = [json.loads(line) for line in (folder / "runs.ndjson").read_text().splitlines()]
    assert [line["phase"] for line in log] == ["start", "end"]
    assert log[0]["seeds"] == [31, 32]
    assert {"date", "version", "code", "world", "presets", "own"} <= set(log[0])


def test_half_a_table_ends_like_a_whole_one(made, tmp_path, monkeypatch):
    monkeypatch.setattr(table1, "DRAWINGS", {"table1": table1.DRAWINGS["table1"]})  # one will do
    run_jobs(list(model_jobs(PLAN))[::2], tmp_path / "table1-jobs")
    table1.make(PLAN, tmp_path, quick=True)
    assert rows(tmp_path) == rows(made[0])
    assert (tmp_path / "table1.json").read_bytes() == (made[0] / "table1.json").read_bytes()
    assert (tmp_path / "table1.svg").read_bytes() == (made[0] / "table1.svg").read_bytes()


def test_random_turns_are_as_frequent_as_the_models(made):
    plan = TablePlan(presets={"paper": preset("paper")}, seeds=[1], densities=(4,))
    # 60 min of 4 robots, 600 turns of a second: 230 minutes of driving
    result = done("paper-all", 4, 1, AA=100, AP=300, CP=100, CR=50)
    rates = {job.model: job.driver.rate_per_min for job in control_jobs(plan, [result])}
    assert rates == {"always-turn": 0, "never-turn": 0, "random-turn": pytest.approx(400 / 230)}
    assert {job.minutes for job in control_jobs(plan, [result])} == {10.0}


def test_the_models_differ_in_who_decides_only():
    drivers = {job.model: job.driver for job in model_jobs(PLAN)}
    assert drivers.pop("lobula") == preset("lobula")
    assert {driver.decision.neurons for driver in drivers.values()} == {"lgmd2", "lgmds", "all"}
    assert len({(driver.lgmd1, driver.lgmd2, driver.lptc) for driver in drivers.values()}) == 1


def test_the_protocols_seeds():
    assert list(table1.seeds(table1.FIRST_SEED, table1.SEEDS)) == list(range(7001, 7011))
    with pytest.raises(ParameterError, match="--seeds 0"):
        table1.seeds(1, 0)


def test_groups_are_by_model_and_robots():
    assert set(grouped([done("a", 4), done("a", 7), done("a", 4, seed=2)])) == {("a", 4), ("a", 7)}
