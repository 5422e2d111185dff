"""Jobs: any number of workers gives the same files, and nothing finished is done twice."""

from __future__ import annotations

import signal
from dataclasses import replace

import numpy as np
import pytest

from lobula.arena import World, course, running
from lobula.errors import ParameterError
from lobula.experiments.closed_loop import jobs as jobs_module
from lobula.experiments.closed_loop.code_hash import code_hash
from lobula.experiments.closed_loop.jobs import Control, Job, result_path
from lobula.experiments.closed_loop.pool import run_jobs
from lobula.model.presets import preset
from lobula.runtime.interrupts import Interrupted

WORLD = World(robots=replace(World().robots, count=2))


def job(seed, minutes=0.05, driver=None):
    driver = preset() if driver is None else driver
    return Job(name=f"m-{seed}", model="m", world=WORLD, seed=seed, minutes=minutes, driver=driver)


JOBS = [job(1), job(2), job(3, driver=Control("random", 20.0))]


@pytest.fixture(scope="module")
def one_worker(tmp_path_factory):
    return run_jobs(JOBS, tmp_path_factory.mktemp("one"))


def same(a, b):
    return a.score == b.score and all(
        np.array_equal(a.events[name], b.events[name], equal_nan=a.events[name].dtype.kind == "f")
        for name in a.events.dtype.names
    )


def test_two_workers_make_what_one_makes(one_worker, tmp_path):
    steps = []
    two = run_jobs(JOBS, tmp_path, workers=2, advance=lambda: steps.append(1))
    assert [d.job.name for d in two] == ["m-1", "m-2", "m-3"]
    assert all(map(same, one_worker, two))
    assert len(steps) == 3
    assert {path.suffix for path in tmp_path.iterdir()} == {".npz"}


def test_a_result_is_that_of_the_run(one_worker):
    assert one_worker[0].score == running.run(WORLD, seed=1, minutes=0.05).score


def test_what_is_finished_is_not_done_again(one_worker, tmp_path, monkeypatch):
    run_jobs(JOBS[:2], tmp_path)
    before = result_path(JOBS[0], tmp_path).stat().st_mtime_ns
    worked = []
    real = jobs_module.work
    monkeypatch.setattr(
        "lobula.experiments.closed_loop.pool.work", lambda one, *rest: (worked.append(one.seed), real(one, *rest))
    )
    again = run_jobs(JOBS, tmp_path)
    assert worked == [3]
    assert result_path(JOBS[0], tmp_path).stat().st_mtime_ns == before
    assert all(map(same, one_worker, again))


@pytest.mark.parametrize("number", [0, 2])
def test_interrupted_in_the_middle_of_a_job_it_ends_the_same(one_worker, tmp_path, monkeypatch, number):
    real = course.Course.tick

    def tick(self, progress):
        real(self, progress)
        if self.simulation.tick_count == 40:
            signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(course.Course, "tick", tick)
    with pytest.raises(Interrupted, match="SIGTERM") as stopped:
        run_jobs([JOBS[number]], tmp_path)
    assert stopped.value.exit_code == 143
    assert [path.suffix for path in tmp_path.iterdir()] == [".checkpoint"]
    monkeypatch.undo()
    (found,) = run_jobs([JOBS[number]], tmp_path)
    assert same(found, one_worker[number])
    assert [path.suffix for path in tmp_path.iterdir()] == [".npz"]


@pytest.mark.parametrize(
    ("other", "name"),
    [
        (job(1, minutes=0.04), "minutes"),
        (job(1, driver=preset("published")), "driver"),
        (replace(job(1), world=replace(WORLD, robots=replace(WORLD.robots, count=3))), "world"),
    ],
)
def test_results_of_other_settings_are_not_mixed_in(tmp_path, other, name):
    run_jobs([job(1)], tmp_path)
    with pytest.raises(ParameterError, match=f"was made with {name}"):
        run_jobs([other], tmp_path)


def test_results_of_other_code_are_not_mixed_in(tmp_path, monkeypatch):
    run_jobs([job(1)], tmp_path)
    monkeypatch.setattr("lobula.experiments.closed_loop.pool.code_hash", lambda: "0" * 12)
    with pytest.raises(ParameterError, match=f"was made with code {code_hash()}, not 000000000000"):
        run_jobs([job(1)], tmp_path)


def test_workers_out_of_range(tmp_path):
    with pytest.raises(ParameterError, match="workers = 0: must be 1 to"):
        run_jobs(JOBS, tmp_path, workers=0)
