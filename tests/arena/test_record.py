"""A record tells every frame of a run, goes through a file unchanged, and every view can be drawn again from it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lobula import preset
from lobula.arena.controls import NeverTurn, RandomTurn
from lobula.arena.events import event_table
from lobula.arena.motion import STOP
from lobula.arena.network_controller import NetworkController
from lobula.arena.record import Record, Recorder, load_record
from lobula.arena.simulation import Simulation
from lobula.arena.snapshot import save_snapshot
from lobula.arena.world import CameraParams, LightParams, Obstacle, RobotParams, World
from lobula.errors import ParameterError
from lobula.model.network import NetworkParams
from lobula.params import with_settings

from .stand_ins import PlainEye, Scripted, assert_same_table, world_of

WORLD = World(
    robots=RobotParams(count=2), light=LightParams(course="flicker"), camera=CameraParams(auto_gain=True),
    obstacles=(Obstacle(),),
)  # fmt: skip


def recorded(sim: Simulation, ticks: int) -> tuple[Record, list[Any]]:
    recorder, seen = Recorder(sim), []
    for _ in range(ticks):
        pose = sim.pose.copy()
        tick = sim.tick()
        recorder.tick(tick)
        seen.append((pose, sim.images.copy(), tick.avoiding))
    return recorder.record(event_table([{"kind": "AP", "robot": 1, "other": -1}]), "test"), seen


@pytest.fixture(scope="module")
def run() -> tuple[Record, list[Any]]:
    return recorded(Simulation(WORLD, NetworkController(preset("published")), 3), 40)


def test_every_frame_is_there(run: tuple[Record, list[Any]]) -> None:
    record, seen = run
    np.testing.assert_array_equal(record.poses, [pose for pose, _, _ in seen])
    np.testing.assert_array_equal(record.alarms, [avoiding for _, _, avoiding in seen])
    np.testing.assert_allclose(record.times_s, np.arange(40) / 30)
    assert record.potentials is not None
    assert record.potentials.shape == (40, 2, 4)
    assert record.light.std() > 0


def test_every_view_can_be_drawn_again_to_the_bit(run: tuple[Record, list[Any]], tmp_path: Path) -> None:
    record, seen = run
    record.save(tmp_path / "run.npz")
    images = np.array([images for _, images, _ in seen])
    for again in (record, load_record(tmp_path / "run.npz")):
        np.testing.assert_array_equal(again.views(1), images[:, 1])
        np.testing.assert_array_equal(again.views(0, 7, 12), images[7:12, 0])
    with pytest.raises(ParameterError, match=r"robot 2: must be one of 0\.\.1"):
        record.views(2)


def test_it_goes_through_a_file_unchanged(run: tuple[Record, list[Any]], tmp_path: Path) -> None:
    record, _ = run
    record.save(tmp_path / "run.npz")
    again = load_record(tmp_path / "run.npz")
    for name in Record.__dataclass_fields__:
        first, second = getattr(record, name), getattr(again, name)
        if name == "events":
            assert_same_table(first, second)
        elif isinstance(first, np.ndarray):
            np.testing.assert_array_equal(first, second, strict=True)
        else:
            assert first == second


def test_it_tells_the_settings_of_what_drove_the_robots(run: tuple[Record, list[Any]], tmp_path: Path) -> None:
    record, _ = run
    record.save(tmp_path / "run.npz")
    settings = load_record(tmp_path / "run.npz").settings
    assert with_settings(NetworkParams(), settings, "record") == preset("published")
    assert recorded(Simulation(WORLD, RandomTurn(7), 3), 1)[0].settings == {"rate_per_min": 7.0}
    assert recorded(Simulation(WORLD, NeverTurn(), 3), 1)[0].settings is None


def test_alarms_and_phases_belong_to_their_frames() -> None:
    sim = Simulation(world_of(2), Scripted({3: [1]}), 0, eye=PlainEye())
    record, _ = recorded(sim, 10)
    assert np.argwhere(record.alarms).tolist() == [[3, 1]]
    assert np.flatnonzero(record.phases[:, 1] == STOP).tolist() == [4, 5, 6, 7, 8]  # at frame 9 it is over


def test_long_runs_and_controllers_without_potentials() -> None:
    sim = Simulation(world_of(), NeverTurn(), 0, eye=PlainEye())
    record, seen = recorded(sim, 2500)
    np.testing.assert_array_equal(record.poses, [pose for pose, _, _ in seen])
    assert record.potentials is None


def test_it_goes_on_from_a_saved_state() -> None:
    def begin() -> tuple[Simulation, Recorder]:
        sim = Simulation(world_of(2), NeverTurn(), 0, eye=PlainEye())
        return sim, Recorder(sim)

    sim, recorder = begin()
    for _ in range(20):
        recorder.tick(sim.tick())
    other_sim, other = begin()
    other_sim.resume(sim.snapshot())
    other.set_state(recorder.state())
    for s, r in ((sim, recorder), (other_sim, other)):
        for _ in range(20):
            r.tick(s.tick())
    np.testing.assert_array_equal(other.record(event_table(), "").poses, recorder.record(event_table(), "").poses)


def test_other_files_are_no_records(tmp_path: Path) -> None:
    save_snapshot(tmp_path / "other", {"a": 1})
    with pytest.raises(ParameterError, match="other: is no record of an arena run"):
        load_record(tmp_path / "other")
