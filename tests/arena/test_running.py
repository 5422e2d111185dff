"""A whole run from one call; whatever ends it, nothing is lost, and taken up again it comes to the same."""

import os
import pickle
import signal
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lobula import preset
from lobula.arena import course
from lobula.arena.controller import ControllerError
from lobula.arena.controls import NeverTurn, RandomTurn
from lobula.arena.course import Run
from lobula.arena.network_controller import NetworkController
from lobula.arena.running import RunInterrupted, run
from lobula.arena.snapshot import save_snapshot
from lobula.arena.world import CameraParams, RobotParams, RoomParams, World
from lobula.errors import ParameterError

from ..engine.engines import needs_core
from .stand_ins import assert_same_table

SMALL = World(
    room=RoomParams(width_cm=30, depth_cm=30),
    robots=RobotParams(count=3),
    camera=CameraParams(width_px=32, height_px=24, ahead_cm=1),
)
MINUTES = 0.3
TICKS = 540


class Fails(RandomTurn):
    """Turns by chance until ``at`` frames were seen; then does something else, once."""

    def __init__(self, at: int, how: Any) -> None:
        super().__init__(20)
        self.at, self.how, self.frames = at, how, 0

    def step(self, images: np.ndarray, time_s: float, turning: np.ndarray) -> Any:
        self.frames += 1
        if self.frames == self.at + 1:
            return self.how()
        return super().step(images, time_s, turning)


def fails() -> None:
    raise ValueError("lost the weights")


def interrupts() -> None:
    raise KeyboardInterrupt


@pytest.fixture(autouse=True)
def _short_stretches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(course, "SNAPSHOT_MINUTES", 0.1)


def go(controller: Any = None, **settings: Any) -> Run:
    settings = {"minutes": MINUTES, "seed": 2, "record": True} | settings
    return run(SMALL, controller or RandomTurn(20), **settings)


@pytest.fixture(scope="module")
def whole() -> Run:
    return run(SMALL, RandomTurn(20), minutes=MINUTES, seed=2, record=True)


def assert_same(first: Run, second: Run) -> None:
    assert first.score == second.score
    assert_same_table(first.events, second.events)
    assert first.record is not None
    assert second.record is not None
    np.testing.assert_array_equal(first.record.poses, second.record.poses)
    np.testing.assert_array_equal(first.record.alarms, second.record.alarms)


def go_for(seed: int) -> Run:
    return go(seed=seed)


class TestWhole:
    def test_it_tells_what_it_was_and_what_happened(self, whole: Run) -> None:
        assert whole.finished
        assert whole.minutes == pytest.approx(MINUTES)
        assert whole.robot_frames == 3 * TICKS
        assert whole.controller.startswith("RandomTurn ")
        assert set(whole.seconds) == {"eye", "network", "physics", "scoring"}
        assert whole.score.robot_minutes == pytest.approx(3 * MINUTES)
        assert whole.record is not None
        assert len(whole.record.poses) == TICKS
        ways = np.abs(np.diff(whole.record.poses[..., 0] + 1j * whole.record.poses[..., 1], axis=0)).sum()
        assert whole.score.distance_cm == pytest.approx(ways, rel=0.01)
        assert set(whole.events["kind"]) >= {"CR", "CP"}
        assert len(whole.events) >= whole.record.alarms.sum()

    def test_the_same_seed_is_the_same_run(self, whole: Run) -> None:
        assert_same(go(), whole)

    def test_other_processes_come_to_the_same(self, whole: Run) -> None:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            other, same = pool.map(go_for, [5, 2])  # after another run in the same process too
        assert_same(same, whole)
        assert other.score != whole.score

    def test_the_number_of_robots_may_be_given_beside_the_world(self) -> None:
        assert run(SMALL, NeverTurn(), minutes=0.01, robots=2).world.robots.count == 2

    def test_progress_is_told_once_a_second(self) -> None:
        told: list[tuple[float, float]] = []
        go(progress=lambda done, of: told.append((done, of)))
        assert [done for done, _ in told] == pytest.approx(np.arange(1, 19) / 60)
        assert {of for _, of in told} == {MINUTES}

    @pytest.mark.parametrize("minutes", [0, -1, float("nan"), float("inf")])
    def test_minutes_are_a_number_above_nothing(self, minutes: float) -> None:
        with pytest.raises(ParameterError, match="minutes = "):
            go(minutes=minutes)


class TestFailures:
    @pytest.mark.parametrize("at", [0, 100, 350])
    @pytest.mark.parametrize("how", [fails, lambda: [np.nan] * 3])
    def test_a_controller_that_breaks_loses_nothing(self, whole: Run, at: int, how: Any) -> None:
        with pytest.raises(ControllerError, match=rf"controller Fails, tick {at} ") as caught:
            go(Fails(at, how))
        part = caught.value.run
        assert not part.finished
        assert part.minutes == pytest.approx(at / 1800)
        assert part.record is not None
        assert whole.record is not None
        np.testing.assert_array_equal(part.record.poses, whole.record.poses[:at])
        assert_same_table(part.events, whole.events[: len(part.events)])
        assert_same(go(Fails(10**9, None), resume=part.snapshot), whole)

    def test_an_interrupt_within_a_tick(self, whole: Run) -> None:
        with pytest.raises(RunInterrupted) as caught:
            go(Fails(350, interrupts))
        assert caught.value.run.minutes == pytest.approx(350 / 1800)
        assert_same(go(Fails(10**9, None), resume=caught.value.run.snapshot), whole)

    @pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
    def test_a_signal_ends_the_run_between_two_ticks(self, whole: Run, number: int, tmp_path: Path) -> None:
        def stop(done: float, of: float) -> None:
            if done == pytest.approx(7 / 60):
                os.kill(os.getpid(), number)

        path, before = tmp_path / "run.npz", signal.getsignal(number)
        with pytest.raises(RunInterrupted) as caught:
            go(progress=stop, checkpoint=path)
        assert caught.value.number == number
        assert isinstance(caught.value, KeyboardInterrupt)
        assert pickle.loads(pickle.dumps(caught.value)).run.minutes == caught.value.run.minutes
        assert caught.value.run.minutes == pytest.approx(7 / 60)
        assert signal.getsignal(number) is before
        for kept in (caught.value.run.snapshot, path, str(path)):
            assert_same(go(resume=kept), whole)

    def test_again_and_again(self, whole: Run, tmp_path: Path) -> None:
        path, resume = tmp_path / "run.npz", None
        for at in (130, 200, 170):
            with pytest.raises(ControllerError):
                go(Fails(at, fails), checkpoint=path, resume=resume)
            resume = path
        result = go(Fails(10**9, None), checkpoint=path, resume=resume)
        assert_same(result, whole)

    def test_a_disk_that_is_full_does_not_end_the_run(self, whole: Run, tmp_path: Path) -> None:
        with pytest.warns(RuntimeWarning, match=r"checkpoint: cannot write .*no.run: .*; the run goes on"):
            assert_same(go(checkpoint=tmp_path / "no" / "run"), whole)

    def test_a_controller_without_state(self, tmp_path: Path) -> None:
        class Forgets:
            def start(self, robots: int, rng: np.random.Generator) -> None: ...

            def step(self, images: np.ndarray, time_s: float, turning: np.ndarray) -> Any:
                return np.zeros(len(turning), bool)

        assert go(Forgets(), minutes=0.05).finished
        with pytest.raises(ControllerError, match="Forgets: has no state"):
            go(Forgets(), checkpoint=tmp_path / "run.npz")
        assert not list(tmp_path.iterdir())


class TestResume:
    def test_a_finished_run_is_there_at_once_and_may_be_made_longer(self, whole: Run, tmp_path: Path) -> None:
        path = tmp_path / "run.npz"
        first = go(minutes=0.1, checkpoint=path)
        assert first.finished
        again = run(controller=RandomTurn(20), resume=path, record=True)
        assert again.minutes == pytest.approx(0.1)
        assert_same(again, first)
        assert again.seconds == first.seconds
        assert_same(run(controller=RandomTurn(20), minutes=MINUTES, resume=path, record=True), whole)

    def test_what_does_not_belong_together_is_refused(self, tmp_path: Path) -> None:
        path = tmp_path / "run.npz"
        go(minutes=0.05, checkpoint=path, record=False)
        with pytest.raises(ParameterError, match=r"checkpoint of RandomTurn .*: must be .* that, not NeverTurn$"):
            run(controller=NeverTurn(), resume=path)
        with pytest.raises(ParameterError, match=r"not RandomTurn \w{12}: rate_per_min was 20\.0, is 30\.0$"):
            run(controller=RandomTurn(30), resume=path)
        with pytest.raises(ParameterError, match="without a record"):
            run(controller=RandomTurn(20), resume=path, record=True)
        with pytest.raises(ParameterError, match="snapshot of seed 2: must be of 3"):
            run(controller=RandomTurn(20), resume=path, seed=3)
        with pytest.raises(ParameterError, match=r"another world: .* in that: room\.width_cm was 30\.0, is 70"):
            run(World(), RandomTurn(20), resume=path)
        save_snapshot(tmp_path / "other.npz", {"a": 1})
        with pytest.raises(ParameterError, match="is no checkpoint of a run, but holds a"):
            run(controller=RandomTurn(20), resume=tmp_path / "other.npz")
        with pytest.raises(ParameterError, match="cannot be read"):
            run(controller=RandomTurn(20), resume=tmp_path / "missing.npz")

    @pytest.mark.parametrize(
        "other", [{"controller": NeverTurn()}, {"seed": 3}, {"robots": 2}, {"record": True}, {"minutes": 0.0}]
    )
    def test_a_checkpoint_that_is_refused_stays_as_it_is(self, other: dict[str, Any], tmp_path: Path) -> None:
        path = tmp_path / "run.npz"
        go(minutes=0.02, checkpoint=path, record=False)
        before = path.read_bytes()
        with pytest.raises(ParameterError):
            run(**({"controller": RandomTurn(20), "checkpoint": path, "resume": path} | other))
        assert path.read_bytes() == before

    def test_other_settings_of_the_network_are_refused_by_name(self, tmp_path: Path) -> None:
        path = tmp_path / "run.npz"
        first, second = preset("paper"), preset("paper", neurons="lgmd2")
        run(SMALL, NetworkController(first), minutes=0.01, checkpoint=path)
        with pytest.raises(ParameterError, match=r"not NetworkController .*: decision\.neurons was 'all', is"):
            run(controller=NetworkController(second), minutes=0.02, resume=path)
        assert run(controller=NetworkController(first), minutes=0.02, resume=path).finished

    @needs_core
    def test_another_storage_is_refused(self, tmp_path: Path) -> None:
        path = tmp_path / "run.npz"
        run(SMALL, NetworkController(storage="compact"), minutes=0.01, checkpoint=path)
        with pytest.raises(ParameterError, match=r"checkpoint of NetworkController \w+ compact: must be resumed with"):
            run(controller=NetworkController(), minutes=0.02, resume=path)
