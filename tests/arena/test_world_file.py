"""A world goes through TOML unchanged; what is wrong in a file is said in one line."""

from pathlib import Path

import pytest

from lobula.arena.world import BodyParams, Obstacle, RoomParams, WallParams, World
from lobula.arena.world_file import load_world, parse_world, world_toml
from lobula.errors import ParameterError
from lobula.params import settings_hash

OTHER = World(
    room=RoomParams(shape="circle", radius_cm=40),
    wall=WallParams(dark_grey=100),
    body=BodyParams(bands_grey=(0, 20), bars=6),
    obstacles=(Obstacle(), Obstacle(x_cm=50, y_cm=50, pattern="plain")),
)


@pytest.mark.parametrize("world", [World(), OTHER])
def test_a_world_comes_back_from_its_toml(world: World) -> None:
    again = parse_world(world_toml(world), "test")
    assert again == world
    assert settings_hash(again) == settings_hash(world)


def test_what_a_file_does_not_name_is_as_in_the_paper(tmp_path: Path) -> None:
    path = tmp_path / "w.toml"
    path.write_text("[room]\nwidth_cm = 140\ndepth_cm = 80\n[[obstacles]]\nx_cm = 100\ny_cm = 40\nradius_cm = 3\n")
    world = load_world(path)
    assert world.room.size_cm == (140, 80)
    assert world.obstacles == (Obstacle(x_cm=100, y_cm=40, radius_cm=3),)
    assert world.robots == World().robots
    assert "w.toml" in world.room.source_of("width_cm")
    assert "w.toml" not in world.room.source_of("floor_grey")


def test_an_empty_file_is_the_papers_world() -> None:
    assert parse_world("", "test") == World()


def test_a_pattern_is_looked_for_beside_the_file(tmp_path: Path) -> None:
    path = tmp_path / "w.toml"
    path.write_text('[wall]\npattern = "file"\nfile = "bricks.png"\n')
    assert load_world(path).wall.file == str(tmp_path / "bricks.png")


def test_every_line_tells_meaning_and_range() -> None:
    line = next(line for line in world_toml(World()).splitlines() if line.startswith("width_cm"))
    assert line == "width_cm = 70.0  # length of the box along x; 8..2000 cm; paper Sec. III-B"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[rom]\nwidth_cm = 9", "unknown setting rom: did you mean room?"),
        ("[room]\nwidht_cm = 9", "unknown setting room.widht_cm: did you mean width_cm?"),
        ("[room]\nshape = 'hexagon'", "room.shape = 'hexagon': must be str one of box, circle"),
        ("[room]\nwidth_cm = -4", "room.width_cm = -4: must be float in [8, 2000] cm"),
        ("room = 5", "room = 5: is a group of settings, such as room.shape"),
        ("obstacles = 3", "obstacles = 3: must be tables, each under [[obstacles]]"),
        ("[[obstacles]]\nradius = 3", "unknown setting obstacles[0].radius: did you mean radius_cm?"),
        ("[[obstacles]]\n[[obstacles]]\nx_cm = 69", "obstacles[1]: radius 2.5 cm at (69, 27.5) cm: must lie inside"),
        ("[robots]\nspeed_low_cm_s = 20", "speed_low_cm_s = 20: must be at most speed_high_cm_s = 10"),
        ("[turn]\nlow_deg = 190", "low_deg = 190: must be at most high_deg = 180"),
        ("[camera]\nahead_cm = 2.5", "camera.ahead_cm = 2.5: must be less than body.radius_cm = 2"),
        ("[wall]\npattern = 'file'", "file = '': must name a picture"),
        ("[room\n", "is not TOML"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "w.toml"
    path.write_text(text)
    with pytest.raises(ParameterError) as caught:
        load_world(path)
    assert str(caught.value).startswith(f"world file {path}: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="No such file"):
        load_world(tmp_path / "w.toml")
