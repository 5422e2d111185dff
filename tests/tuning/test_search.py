"""A search finds what was planted, goes on after any end as if nothing had been, and sees nothing that is held out."""

from __future__ import annotations

import errno
import json
import multiprocessing
from dataclasses import replace

import pytest

from lobula.errors import OutputError, ParameterError
from lobula.runtime.interrupts import Interrupted
from lobula.tuning.identity import identity, require_same
from lobula.tuning.journal import JOURNAL, ROUND, Search, opened
from lobula.tuning.plan import Scored
from lobula.tuning.results import worse_held_out
from lobula.tuning.search import tune

from .fake import PLANTED, FakeTask, asked, fake_task, folded_task, plan


@pytest.fixture(autouse=True, scope="module")
def _workers_that_have_everything_loaded():
    multiprocessing.set_forkserver_preload([FakeTask.__module__])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("lobula.tuning.crew.get_context", lambda kind: multiprocessing.get_context("forkserver"))
        yield


def run(folder, task=None, *, advance=None, **budget):
    folder.mkdir(exist_ok=True)
    chosen = plan(task or fake_task(folder), **budget)
    with opened(folder) as journal:
        return tune(chosen, journal, advance=advance)


def stop_after(count):
    """Return what to call for each trial: it ends the search after ``count`` of them, as a signal would."""
    left = iter(range(count - 1, -1, -1))

    def step():
        if next(left) == 0:
            raise Interrupted(15)

    return step


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A search of 40 trials that nobody interrupted."""
    return run(tmp_path_factory.mktemp("whole"), trials=40)


def begins(whole, found, count):
    """Whether ``found`` has the first ``count`` trials of ``whole``: a trial hangs on those before it only."""
    return list(found.trials["only"]) == list(whole.trials["only"][:count]) and len(found.trials["only"]) == count


class TestFinding:
    def test_the_planted_optimum_is_found(self, whole):
        first, second = (whole.best.values[path] for path in PLANTED)
        assert first == pytest.approx(0.01, rel=0.25)
        assert second == pytest.approx(0.003, rel=0.25)
        assert whole.best.merit > -0.35
        assert whole.preset.values == pytest.approx((0.734, 0.470), abs=1e-3)  # ln(0.01 / 0.0048), ln(0.0048 / 0.003)

    def test_it_is_told_where_the_best_does_worse_on_what_was_held_out(self, whole):
        def told(ours, its):
            held_out = {whole.best.number: Scored(ours, {})}
            return worse_held_out(replace(whole, held_out=held_out, preset_held_out=Scored(its, {})))

        assert told((0.5, 0.2), (0.5, 0.3)) == []
        assert told((0.5, 0.2), (0.4, 0.3)) == ["how far the first is off, 0.5 against 0.4"]
        assert len(told((0.5, 0.4), (0.4, 0.3))) == 2
        assert worse_held_out(replace(whole, held_out={}, preset_held_out=None)) == []

    def test_the_first_trial_is_what_it_begins_with(self, whole):
        assert whole.trials["only"][0].values == dict.fromkeys(PLANTED, 0.0048)

    def test_the_front_is_what_nothing_beats(self, whole):
        points = {trial.number: trial.objectives for trial in whole.trials["only"]}
        beaten = {
            n for n, p in points.items()
            if any(all(a <= b for a, b in zip(q, p, strict=True)) and q != p for q in points.values())
        }  # fmt: skip
        assert {trial.number for trial in whole.front} == set(points) - beaten
        assert whole.best in whole.front

    def test_values_have_four_digits_and_lie_in_the_range(self, whole):
        for trial in whole.trials["only"]:
            for value in trial.values.values():
                assert value == float(f"{value:.4g}")
                assert 0.0012 <= value <= 0.0192

    def test_another_seed_is_another_search(self, whole, tmp_path):
        other = run(tmp_path / "other", trials=3, seed=1)
        assert other.trials["only"][1] != whole.trials["only"][1]


class TestGoingOn:
    @pytest.mark.parametrize("count", [1, 15, 16, 17])
    def test_an_interrupted_search_ends_as_one_that_was_not(self, whole, tmp_path, count):
        with pytest.raises(Interrupted):
            run(tmp_path, trials=20, advance=stop_after(count))
        found = run(tmp_path, trials=20)
        assert begins(whole, found, 20)
        assert found.speed.trials == 20 - count

    def test_a_longer_search_goes_on_from_a_shorter_one(self, whole, tmp_path):
        run(tmp_path, trials=5)
        assert begins(whole, run(tmp_path, trials=18), 18)
        found = run(tmp_path, trials=40)
        assert begins(whole, found, 40)
        assert (found.held_out, found.best) == (whole.held_out, whole.best)

    def test_two_workers_find_the_same(self, whole, tmp_path):
        assert begins(whole, run(tmp_path, trials=18, workers=2), 18)

    def test_nothing_is_measured_twice(self, tmp_path):
        run(tmp_path, trials=8)
        before = asked(tmp_path)
        found = run(tmp_path, trials=8)
        assert asked(tmp_path) == before
        assert found.speed.trials == 0
        assert found.speed.trials_per_s is None

    def test_a_torn_line_is_taken_off(self, whole, tmp_path):
        with pytest.raises(Interrupted):
            run(tmp_path, trials=20, advance=stop_after(7))
        with (tmp_path / JOURNAL).open("ab") as journal:
            journal.write(b'{"op_code":5,"worker_id":"x')
        (tmp_path / f"{JOURNAL}.lock").symlink_to("nowhere")  # the lock of a killed process
        assert begins(whole, run(tmp_path, trials=20), 20)

    def test_a_trial_that_was_half_asked_for_is_given_up(self, tmp_path):
        chosen = plan(fake_task(tmp_path), trials=20)
        with opened(tmp_path) as journal:
            require_same(identity(chosen.task, chosen.base, chosen.axes, 0), journal.path)
            search = Search(journal, "only", 0, chosen.axes, chosen.task.objectives, 0)
            search._study.ask({path: search._distributions[path] for path in list(PLANTED)[:1]})
        found = run(tmp_path, trials=20)
        assert [trial.number for trial in found.trials["only"]] == list(range(1, 20))

    def test_a_full_disk_loses_what_was_under_way(self, whole, tmp_path, monkeypatch):
        from optuna.storages.journal import JournalFileBackend

        write, calls = JournalFileBackend.append_logs, []

        def full(self, logs):
            calls.append(logs)
            if len(calls) < 110:
                return write(self, logs)
            with open(self._file_path, "ab") as file:  # as far as it went
                file.write(json.dumps(logs[0]).encode()[:20])
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(JournalFileBackend, "append_logs", full)
        with pytest.raises(OutputError, match=r"cannot write .*journal\.log: the disk is full"):
            run(tmp_path, trials=20)
        monkeypatch.setattr(JournalFileBackend, "append_logs", write)
        done = len(asked(tmp_path))
        found = run(tmp_path, trials=20)
        assert begins(whole, found, 20)
        assert 0 < 20 - done <= found.speed.trials <= 20 - done + 1


class TestRefusing:
    @pytest.mark.parametrize(
        ("other", "words"),
        [
            ({"seed": 7}, "another seed (0, not 7)"),
            ({"vary": ("lgmd1.sigmoid_grey=x3", "lgmd2.sigmoid_grey=x4")}, "another searched"),
        ],
    )
    def test_another_search_in_the_same_folder(self, tmp_path, other, words):
        run(tmp_path, trials=1)
        with opened(tmp_path) as journal, pytest.raises(ParameterError) as refused:
            tune(plan(fake_task(tmp_path), trials=1, **other), journal)
        assert words in str(refused.value)
        assert "must go on as it began, or in another folder" in str(refused.value)

    def test_other_things_to_measure_on(self, tmp_path):
        run(tmp_path, trials=1)
        with pytest.raises(ParameterError, match="another measured on"):
            run(tmp_path, fake_task(tmp_path, identity={"films": "others"}), trials=1)

    def test_two_at_once(self, tmp_path):
        with opened(tmp_path), pytest.raises(ParameterError, match="another search is at work there"), opened(tmp_path):
            pass

    def test_a_journal_that_is_none(self, tmp_path):
        (tmp_path / JOURNAL).write_text("Monday: rain\n")
        with pytest.raises(ParameterError, match="is no journal of a search"), opened(tmp_path):
            pass

    def test_a_journal_of_somebody_else(self, tmp_path):
        import optuna

        backend = optuna.storages.journal.JournalFileBackend(str(tmp_path / JOURNAL))
        optuna.create_study(storage=optuna.storages.JournalStorage(backend), study_name="theirs")
        with pytest.raises(ParameterError, match=r"holds journal\.log without search\.json"):
            run(tmp_path, trials=1)

    def test_settings_that_cannot_be_measured_are_given_up(self, tmp_path):
        found = run(tmp_path, fake_task(tmp_path, trouble="refuse some"), trials=20)
        given_up = [trial for trial in found.trials["only"] if trial.problem]
        assert given_up
        assert all(trial.values["lgmd1.sigmoid_grey"] > 0.01 for trial in given_up)
        assert {trial.problem for trial in given_up} == {"does not like it"}
        assert len(found.trials["only"]) == 20

    def test_no_settings_can_be_measured(self, tmp_path):
        with pytest.raises(ParameterError, match="no settings could be measured; the last one: does not like it"):
            run(tmp_path, fake_task(tmp_path, trouble="refuse"), trials=2)

    def test_a_worker_that_is_killed(self, tmp_path):
        with pytest.raises(OutputError, match="a worker was killed; what was finished by then is kept"):
            run(tmp_path, fake_task(tmp_path, trouble="die"), trials=1, workers=2)

    def test_a_fault_in_a_worker_keeps_its_traceback(self, tmp_path):
        with pytest.raises(RuntimeError, match="ZeroDivisionError: bug"):
            run(tmp_path, fake_task(tmp_path, trouble="fault"), trials=1, workers=2)

    @pytest.mark.parametrize(
        ("budget", "words"),
        [
            ({"trials": 0}, "0 trials: must be 1 to"),
            ({"minutes": 0.0}, "0 minutes: must be above 0"),
            ({"minutes": float("nan")}, "nan minutes"),
            ({"workers": 0}, "workers = 0: must be 1 to 256"),
            ({"seed": -1}, "seed -1: must be 0 or more"),
        ],
    )
    def test_a_budget_that_is_none(self, tmp_path, budget, words):
        with pytest.raises(ParameterError, match=words):
            plan(fake_task(tmp_path), **budget)


class TestHoldingOut:
    def test_a_search_asks_for_its_own_part_only(self, whole, tmp_path):
        run(tmp_path, trials=20)
        questions = [line.split()[-1] for line in asked(tmp_path)]
        assert set(questions[:20]) == {"a+b"}
        assert "c+d" in questions[20:]  # the front, afterwards

    def test_what_is_held_out_does_not_move_the_search(self, whole, tmp_path):
        found = run(tmp_path, fake_task(tmp_path, off={"c": 100.0}), trials=40)
        assert begins(whole, found, 40)
        assert found.best == whole.best
        assert found.held_out != whole.held_out
        far = [value + 50 for value in whole.held_out[whole.best.number].values]  # the mean of 0 and 100
        assert found.held_out[found.best.number].values == pytest.approx(far)

    def test_each_fold_is_scored_by_settings_found_without_it(self, tmp_path):
        (tmp_path / "1").mkdir()
        (tmp_path / "2").mkdir()
        plain = run(tmp_path / "1", folded_task(tmp_path / "1"), trials=3)
        other = run(tmp_path / "2", folded_task(tmp_path / "2", off={"a": 100.0}), trials=3)
        assert plain.trials["without a"] == other.trials["without a"]
        assert plain.trials["without b"] != other.trials["without b"]
        for found in (plain, other):
            assert not found.held_out
            assert sorted(found.cross_validated.about["names"]) == ["a", "b", "c"]
        mean = [
            sum(t.objectives[i] for name, t in plain.chosen.items() if name != "all") / 3 for i in (0, 1)
        ]  # without an offset every name is alike, so a held-out score is the score searched by
        assert plain.cross_validated.values == pytest.approx(mean)
        assert [len(some) for some in plain.trials.values()] == [3] * 4

    def test_the_clock_leaves_each_search_with_a_result(self, tmp_path):
        found = run(tmp_path, folded_task(tmp_path), minutes=1e-9)
        assert [len(some) for some in found.trials.values()] == [1] * 4
        assert found.best.number == 0

    def test_a_round_is_asked_for_before_any_of_it_is_measured(self, tmp_path):
        chosen = plan(fake_task(tmp_path), trials=3)
        with opened(tmp_path) as journal:
            search = Search(journal, "only", 0, chosen.axes, chosen.task.objectives, 0)
            assert len(search.next_round(3)) == 3
            assert len(search.next_round(100)) == ROUND
