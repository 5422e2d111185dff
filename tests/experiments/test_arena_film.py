"""Film and picture of a run: what they show is what the record holds."""

from __future__ import annotations

import av
import numpy as np
import pytest

from lobula import arena, preset
from lobula.arena.events import event_table
from lobula.arena.world import Obstacle, RobotParams, RoomParams, World
from lobula.errors import OutputError, ParameterError
from lobula.experiments import arena_film, arena_tale
from lobula.params import to_dict, with_settings
from lobula.report.arena_plan import ArenaPlan, Ground
from lobula.report.arena_view import ArenaView


@pytest.fixture(scope="module")
def record():
    return arena.run(minutes=0.05, seed=5, robots=3, record=True).record


def pictures(path):
    with av.open(str(path)) as film:
        return [(frame.time, frame.to_ndarray(format="rgb24")) for frame in film.decode(video=0)]


class TestFilm:
    def test_it_plays_as_long_as_the_part_at_its_speed(self, record, tmp_path):
        film = arena_film.save_film(record, tmp_path / "run.mp4", robot=1, start_s=1.0, end_s=1.2, speed=0.5)
        assert film == (tmp_path / "run.mp4", 6, 0.4, 0.5)
        shown = pictures(film.path)
        assert [round(15 * time_s) for time_s, _ in shown] == list(range(6))  # half as fast: 15 pictures a second
        assert shown[0][1].shape == (720, 1280, 3)

    def test_a_fast_one_leaves_frames_out(self, record, tmp_path):
        film = arena_film.save_film(record, tmp_path / "run.mp4", start_s=2.0, speed=4)
        assert (film.frames, film.duration_s) == (8, pytest.approx(8 / 30))  # every fourth of 30

    def test_the_robots_view_is_in_it(self, record, tmp_path):
        film = arena_film.save_film(record, tmp_path / "run.mp4", robot=2, end_s=0.2)
        _, picture = pictures(film.path)[3]
        view = record.views(2, 3, 4)[0].astype(float)
        # the pixels of the view are 4 x 4 in the film; a block's middle is hardly touched by the coding
        shown = picture[40:328, 870:1266, 1].reshape(72, 4, 99, 4)[:, 1:3, :, 1:3].mean(axis=(1, 3))
        assert np.corrcoef(view.ravel(), shown.ravel())[0, 1] > 0.97
        assert np.abs(view - shown).mean() < 6

    def test_a_long_run_is_shown_faster(self):
        frames, speed = arena_film.frames_of(60 * 60 * 30, 30.0)
        assert speed == 32  # an hour in 112 s; at 16 it would be 225 s
        assert len(frames) / 30 == 3600 / 32
        assert arena_film.frames_of(180 * 30, 30.0)[1] == 1

    def test_every_picture_is_told(self, record, tmp_path):
        told = []
        film = arena_film.save_film(record, tmp_path / "run.mp4", speed=16, advance=lambda: told.append(1))
        assert len(told) == film.frames

    def test_a_controller_without_potentials(self, tmp_path):
        mute = arena.run(controller=arena.NeverTurn(), minutes=0.02, seed=5, record=True).record
        assert arena_film.save_film(mute, tmp_path / "run.mp4", speed=6).frames == 6

    @pytest.mark.parametrize(
        ("asked", "words"),
        [
            ({"robot": 3}, "robot 3: must be one of 0..2"),
            ({"start_s": 2.0, "end_s": 1.0}, "from 2 s to 1 s: must be a part of the run, 0 to 3 s"),
            ({"start_s": 5.0}, "from 5 s to its end"),
            ({"speed": 0.0}, "speed 0.0: must be from 1/64 to 256"),
            ({"speed": float("nan")}, "speed nan"),
        ],
    )
    def test_what_there_is_not_is_refused(self, record, tmp_path, asked, words):
        with pytest.raises(ParameterError, match=words):
            arena_film.save_film(record, tmp_path / "run.mp4", **asked)
        assert not list(tmp_path.iterdir())

    def test_names(self, record, tmp_path):
        with pytest.raises(ParameterError, match=r"must end in \.mp4"):
            arena_film.save_film(record, tmp_path / "run.avi")
        with pytest.raises(ParameterError, match=r"must end in \.png"):
            arena_film.save_still(record, tmp_path / "run.jpg")
        with pytest.raises(OutputError, match="no such folder"):
            arena_film.save_film(record, tmp_path / "none" / "run.mp4")

    def test_a_film_that_is_cut_short_leaves_what_plays(self, record, tmp_path):
        left = iter(range(40))

        def advance():
            if next(left, None) is None:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            arena_film.save_film(record, tmp_path / "run.mp4", advance=advance)
        assert [path.name for path in tmp_path.iterdir()] == ["run.part.mp4"]
        assert len(pictures(tmp_path / "run.part.mp4")) >= 30  # of 41: at most about a second is lost


class TestTale:
    def test_where_events_are_drawn(self, record):
        rows = [
            {"tick": 9, "kind": "CR", "robot": 0, "other": 1},
            {"tick": 9, "kind": "AP", "robot": 1, "other": -1},
            {"tick": 80, "kind": "CP", "robot": 2, "other": -1},
        ]
        poses = record.poses.copy()
        poses[9, 0, :2], poses[9, 1, :2] = (10.0, 20.0), (14.0, 20.0)
        poses[80, 2, :2] = (40.0, 53.0)
        told = arena_tale.tell(replaced(record, poses=poses, events=event_table(rows)))
        assert told.marks.places_cm.tolist() == [[12.0, 20.0], [14.0, 20.0], [40.0, 55.0]]
        assert told.marks.frames.tolist() == [9, 9, 80]
        assert told.scores == ["SR1 -   SR2 -", "SR1 -   SR2 0 %", "SR1 100 %   SR2 0 %", "SR1 50 %   SR2 0 %"]

    def test_contacts_with_posts_and_a_round_wall(self, record):
        round_world = World(
            room=RoomParams(shape="circle", radius_cm=30), obstacles=(Obstacle(x_cm=30, y_cm=40, radius_cm=5),)
        )
        rows = [
            {"tick": 0, "kind": "CP", "robot": 0, "other": -2},
            {"tick": 0, "kind": "CP", "robot": 1, "other": -1},
        ]
        poses = record.poses.copy()
        poses[0, 0, :2], poses[0, 1, :2] = (30.0, 47.0), (58.0, 30.0)
        told = arena_tale.tell(replaced(record, world=round_world, poses=poses, events=event_table(rows)))
        assert told.marks.places_cm.tolist() == [[30.0, 45.0], [60.0, 30.0]]

    def test_what_drove_the_robots_is_told_by_the_records_settings(self, record):
        assert arena_tale.tell(record).title == "3 robots, seed 5, preset paper, neurons all"
        assert preset("paper") == arena_tale.network_of(record)
        own = with_settings(preset("paper"), {"lgmd2": {"spiking": {"threshold": 0.8}}}, "test")
        other = replaced(record, controller="NetworkController 0123456789ab", settings=to_dict(own))
        assert arena_tale.tell(other).title == "3 robots, seed 5, NetworkController 0123456789ab"
        assert arena_tale.tell_own(other, 0).thresholds["lgmd2"] == 0.8
        unknown = replaced(record, controller="RandomTurn 0123456789ab", settings={"rate_per_min": 3.0})
        assert arena_tale.tell(unknown).title == "3 robots, seed 5, RandomTurn 0123456789ab"
        assert arena_tale.tell_own(unknown, 0).thresholds["lgmd2"] == 0.7


class TestTopView:
    def test_a_robot_is_drawn_where_it_is(self, record):
        tale = arena_tale.tell(record)
        view, ground = ArenaView(tale.plan, tale.course, tale.marks, 600, 760), Ground(tale.plan, 600, 760)
        before, after = np.zeros((600, 760, 3), np.uint8), np.zeros((600, 760, 3), np.uint8)
        nobody = tale.course._replace(poses=np.full_like(tale.course.poses, 500.0))
        ArenaView(tale.plan, nobody, tale.marks, 600, 760).draw(before, 0)
        view.draw(after, 0)
        rows, columns = ground.px(*tale.course.poses[0, :, :2].T)
        for row, column in zip(rows, columns, strict=True):
            edge = after[round(row), round(column - 1.85 * ground.scale)].astype(int)
            assert np.abs(edge - before[round(row), round(column - 1.85 * ground.scale)]).max() > 40

    def test_up_is_up(self):
        plan = ArenaPlan(circle=False, size_cm=(70.0, 55.0), wall_grey=np.array([180.0]))
        ground = Ground(plan, 600, 760)
        (low, high), (left, right) = ground.px(np.array([0.0, 70.0]), np.array([0.0, 55.0]))
        assert low > high
        assert right - left == pytest.approx(70 * ground.scale)
        assert low - high == pytest.approx(55 * ground.scale)
        assert ground.floor.sum() == pytest.approx(70 * 55 * ground.scale**2, rel=0.01)

    def test_the_whole_run_as_a_picture(self, record, tmp_path):
        arena_film.save_still(record, tmp_path / "run.png", end_s=2)
        arena_film.save_still(record, tmp_path / "all.png")
        assert (tmp_path / "run.png").read_bytes() != (tmp_path / "all.png").read_bytes()
        with av.open(str(tmp_path / "all.png")) as picture:
            assert next(picture.decode(video=0)).to_ndarray(format="rgb24").shape == (720, 856, 3)

    def test_many_robots_in_an_odd_room(self, tmp_path):
        world = World(
            room=RoomParams(shape="circle", radius_cm=25), obstacles=(Obstacle(x_cm=25, y_cm=25),),
            robots=RobotParams(count=9),
        )  # fmt: skip
        run = arena.run(world, arena.RandomTurn(10), minutes=0.05, seed=8, record=True)
        arena_film.save_still(run.record, tmp_path / "run.png")


def replaced(record, **changes):
    fields = {name: getattr(record, name) for name in type(record).__dataclass_fields__}
    return type(record)(**{**fields, **changes})
