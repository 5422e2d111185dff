"""The arena as settings: room, walls, robots, how they turn, the light, their cameras, the rules of scoring.

``World()`` is the paper's arena; ``world_file.load_world`` reads another from TOML. Positions are (x, y) in cm, x to
the right, y up, from the lower left corner of the room (of the square around it, where the room is round). Headings
are in rad, counter-clockwise from x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..params import Params, param


@dataclass(frozen=True, kw_only=True)
class RoomParams(Params):
    """Shape and size of the floor, and the greys below and above the wall."""

    shape: str = param("box", "", "plan of the room", choices=("box", "circle"), source="paper Sec. III-B")
    width_cm: float = param(70.0, "cm", "length of the box along x", low=8, high=2000, source="paper Sec. III-B")
    depth_cm: float = param(55.0, "cm", "length of the box along y", low=8, high=2000, source="paper Sec. III-B")
    radius_cm: float = param(35.0, "cm", "radius of the circle", low=4, high=1000, source="chosen")
    floor_grey: float = param(95.0, "grey", "luminance of the floor", low=0, high=255, source="chosen")
    above_grey: float = param(200.0, "grey", "luminance over the wall's edge", low=0, high=255, source="chosen")

    @property
    def size_cm(self) -> tuple[float, float]:
        """Extent along x and y."""
        if self.shape == "box":
            return self.width_cm, self.depth_cm
        return 2 * self.radius_cm, 2 * self.radius_cm

    @property
    def perimeter_cm(self) -> float:
        """Length of the wall."""
        if self.shape == "box":
            return 2 * (self.width_cm + self.depth_cm)
        return 2 * math.pi * self.radius_cm


@dataclass(frozen=True, kw_only=True)
class WallParams(Params):
    """The wall and the vertical stripes on it; obstacles may carry the same stripes."""

    height_cm: float = param(12.0, "cm", "height of the wall", low=0.1, high=500, source="chosen")
    pattern: str = param(
        "stripes", "", "random stripes, their mean grey, or a strip from a file",
        choices=("stripes", "plain", "file"), source="a reading of the authors' arena videos",
    )  # fmt: skip
    stripe_low_cm: float = param(0.6, "cm", "narrowest stripe", low=0.05, high=100,
                                 source="a reading of the authors' arena videos")  # fmt: skip
    stripe_high_cm: float = param(0.8, "cm", "widest stripe", low=0.05, high=100,
                                  source="a reading of the authors' arena videos")  # fmt: skip
    dark_grey: float = param(150.0, "grey", "darkest stripe", low=0, high=255, source="chosen")
    light_grey: float = param(210.0, "grey", "lightest stripe", low=0, high=255, source="chosen")
    file: str = param("", "", "picture whose middle row is the luminance once round the room", source="chosen")

    def __post_init__(self) -> None:
        super().__post_init__()
        _ordered(self, "stripe_low_cm", "stripe_high_cm")
        _ordered(self, "dark_grey", "light_grey")
        if (self.pattern == "file") != bool(self.file):
            raise ParameterError(
                f"WallParams.file = {self.file!r}: must name a picture with pattern 'file', and only then"
            )


@dataclass(frozen=True, kw_only=True)
class BodyParams(Params):
    """What a robot is and looks like from the side: an upright cylinder."""

    radius_cm: float = param(2.0, "cm", "radius of the disc", low=0.5, high=50, source="paper Sec. III-A")
    height_cm: float = param(3.0, "cm", "height", low=0.1, high=100, source="paper Sec. III-A")
    grey: float = param(45.0, "grey", "luminance of the body", low=0, high=255, source="chosen")
    bands_grey: tuple[float, ...] = param(
        (0.0,), "grey", "added to it in level bands of equal height, from the floor up", low=-255, high=255,
        source="chosen",
    )  # fmt: skip
    bars: int = param(0, "", "upright bars around the body, evenly spaced, each as wide as the gap after it; 0: none",
                      low=0, high=64, source="chosen")  # fmt: skip
    bars_grey: float = param(40.0, "grey", "added to the body within the bars", low=-255, high=255, source="chosen")


@dataclass(frozen=True, kw_only=True)
class Obstacle(Params):
    """A fixed upright cylinder."""

    x_cm: float = param(35.0, "cm", "centre along x", low=0, high=2000, source="chosen")
    y_cm: float = param(27.5, "cm", "centre along y", low=0, high=2000, source="chosen")
    radius_cm: float = param(2.5, "cm", "radius", low=0.1, high=500, source="a reading of the authors' arena videos")
    height_cm: float = param(12.0, "cm", "height", low=0.1, high=500, source="chosen")
    pattern: str = param("stripes", "", "the wall's stripes, or one grey", choices=("stripes", "plain"),
                         source="a reading of the authors' arena videos")  # fmt: skip
    grey: float = param(180.0, "grey", "luminance where plain", low=0, high=255, source="chosen")


@dataclass(frozen=True, kw_only=True)
class RobotParams(Params):
    """How many robots, and how they drive ahead."""

    count: int = param(4, "", "robots in the room", low=1, high=256, source="paper Sec. III-B: 4 and 7")
    speed_low_cm_s: float = param(6.0, "cm/s", "slowest robot of a run", low=0, high=100, source="paper Sec. III-B")
    speed_high_cm_s: float = param(10.0, "cm/s", "fastest robot of a run", low=0, high=100, source="paper Sec. III-B")
    track_cm: float = param(4.8, "cm", "distance between the wheels", low=0.5, high=100, source="ColiasWebots, CAD")
    curvature_per_m: float = param(
        0.0, "1/m", "mismatch of the motors: each robot's path ahead is bent by a constant within +- this", low=0,
        high=20, source="chosen",
    )  # fmt: skip
    motor_noise: float = param(
        0.0, "", "random share of each wheel's speed in each tick, standard deviation", low=0, high=1, source="chosen"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        _ordered(self, "speed_low_cm_s", "speed_high_cm_s")


@dataclass(frozen=True, kw_only=True)
class TurnParams(Params):
    """What a robot does on an alarm or a contact: stop, turn in place to a random side, drive on."""

    stop_s: float = param(0.2, "s", "standing still before the turn", low=0, high=10, source="published code: robot")
    turn_s: float = param(0.8, "s", "length of the turn", low=0.01, high=10, source="published code: robot")
    low_deg: float = param(120.0, "deg", "smallest turn", low=0, high=360, source="the authors' group: 150 +- 30 deg")
    high_deg: float = param(180.0, "deg", "largest turn", low=0, high=360, source="the authors' group: 150 +- 30 deg")

    def __post_init__(self) -> None:
        super().__post_init__()
        _ordered(self, "low_deg", "high_deg")


@dataclass(frozen=True, kw_only=True)
class LightParams(Params):
    """The light of the room over time: a gain on all luminance."""

    course: str = param("steady", "", "how it goes", choices=("steady", "flicker", "steps"), source="chosen")
    flicker_hz: float = param(10.0, "Hz", "frequency of the flicker", low=0, high=1000, source="chosen")
    flicker_amplitude: float = param(0.1, "", "share of the light that comes and goes", low=0, high=1, source="chosen")
    step_every_s: float = param(5.0, "s", "time from one step to the next", low=0.1, high=3600, source="chosen")
    step_gain: float = param(0.7, "", "gain in every other stretch", low=0, high=10, source="chosen")

    def gain(self, times_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the factor on all luminance at ``times_s``, of its shape; 1 where the light is steady."""
        if self.course == "flicker":
            return 1 + self.flicker_amplitude * np.sin(2 * math.pi * self.flicker_hz * times_s)
        if self.course == "steps":
            stretch = np.floor(times_s / self.step_every_s + 1e-9)  # a frame taken at the very step shows it
            return np.where(stretch % 2 == 1, self.step_gain, 1.0)
        return np.ones_like(times_s)


@dataclass(frozen=True, kw_only=True)
class CameraParams(Params):
    """The camera on each robot; it looks straight ahead, level, through square pixels."""

    width_px: int = param(99, "px", "columns", low=32, high=1920, source="paper Sec. III-A")
    height_px: int = param(72, "px", "rows", low=24, high=1080, source="paper Sec. III-A")
    fov_deg: float = param(70.0, "deg", "horizontal field of view", low=10, high=150, source="paper Sec. III-A")
    ahead_cm: float = param(1.33, "cm", "pupil ahead of the robot's centre", low=0, high=50,
                            source="ColiasWebots, CAD")  # fmt: skip
    above_floor_cm: float = param(1.6, "cm", "pupil over the floor", low=0.05, high=100, source="ColiasWebots, CAD")
    rate_hz: float = param(30.0, "Hz", "frames a second; each is one tick of the arena", low=5, high=240,
                           source="paper Sec. III-A")  # fmt: skip
    noise_grey: float = param(1.5, "grey", "sensor noise, standard deviation", low=0, high=100, source="chosen")
    blur_px: float = param(0.0, "px", "blur of the optics, standard deviation", low=0, high=10, source="chosen")
    auto_gain: bool = param(False, "", "let a gain follow the light, towards pictures of one mean", source="chosen")
    auto_gain_grey: float = param(128.0, "grey", "that mean", low=1, high=255, source="chosen")
    auto_gain_ms: float = param(200.0, "ms", "time constant of the gain", low=0, high=60000, source="chosen")


@dataclass(frozen=True, kw_only=True)
class ScoringParams(Params):
    """The rules by which contacts and avoidances are counted."""

    margin_cm: float = param(1.0, "cm", "a robot that would pass nearer than two radii and this approaches", low=0,
                             high=50, source="project rule")  # fmt: skip
    horizon_s: float = param(3.0, "s", "how far ahead the closest approach is looked for", low=0.1, high=60,
                             source="project rule")  # fmt: skip
    near_cm: float = param(20.0, "cm", "what is farther away causes no avoidance", low=0.1, high=1000,
                           source="project rule")  # fmt: skip
    back_s: float = param(1.0, "s", "how much before an alarm is rendered again", low=0.1, high=10,
                          source="project rule")  # fmt: skip
    separation_cm: float = param(0.5, "cm", "a contact ends when the two are farther apart", low=0, high=50,
                                 source="project rule")  # fmt: skip
    separation_s: float = param(0.5, "s", "for this long", low=0, high=60, source="project rule")


@dataclass(frozen=True, kw_only=True)
class World(Params):
    """Everything that stays the same during a run. ``World()`` is the paper's arena.

    Raises
    ------
    ParameterError : a setting out of its range, or settings that do not fit together
    """

    room: RoomParams = field(default_factory=RoomParams)
    wall: WallParams = field(default_factory=WallParams)
    body: BodyParams = field(default_factory=BodyParams)
    robots: RobotParams = field(default_factory=RobotParams)
    turn: TurnParams = field(default_factory=TurnParams)
    light: LightParams = field(default_factory=LightParams)
    camera: CameraParams = field(default_factory=CameraParams)
    scoring: ScoringParams = field(default_factory=ScoringParams)
    obstacles: tuple[Obstacle, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "obstacles", tuple(self.obstacles))
        if self.camera.ahead_cm >= self.body.radius_cm:
            raise ParameterError(
                f"camera.ahead_cm = {self.camera.ahead_cm:g}: must be less than body.radius_cm = "
                f"{self.body.radius_cm:g}: the pupil sits inside the body's outline"
            )
        if self.camera.above_floor_cm >= self.wall.height_cm:
            raise ParameterError(
                f"camera.above_floor_cm = {self.camera.above_floor_cm:g}: must be less than wall.height_cm = "
                f"{self.wall.height_cm:g}"
            )
        for number, obstacle in enumerate(self.obstacles):
            if not isinstance(obstacle, Obstacle):
                raise ParameterError(f"obstacles[{number}] = {obstacle!r}: must be an Obstacle")
            if self.wall_gap_cm(obstacle.x_cm, obstacle.y_cm) < obstacle.radius_cm:
                raise ParameterError(
                    f"obstacles[{number}]: radius {obstacle.radius_cm:g} cm at ({obstacle.x_cm:g}, "
                    f"{obstacle.y_cm:g}) cm: must lie inside the room, {self.room_text}"
                )

    @property
    def tick_s(self) -> float:
        """Time from one frame to the next."""
        return 1.0 / self.camera.rate_hz

    @property
    def room_text(self) -> str:
        """The room's plan in words, for messages."""
        width, depth = self.room.size_cm
        return f"{width:g} x {depth:g} cm" if self.room.shape == "box" else f"a circle of radius {width / 2:g} cm"

    def wall_gap_cm(self, x_cm: float, y_cm: float) -> float:
        """Return the distance of a point from the nearest wall; negative outside the room."""
        width, depth = self.room.size_cm
        if self.room.shape == "circle":
            return width / 2 - math.hypot(x_cm - width / 2, y_cm - depth / 2)
        return min(x_cm, width - x_cm, y_cm, depth - y_cm)


def _ordered(params: Params, low: str, high: str) -> None:
    a, b = getattr(params, low), getattr(params, high)
    if a > b:
        raise ParameterError(f"{type(params).__name__}.{low} = {a:g}: must be at most {high} = {b:g}")
