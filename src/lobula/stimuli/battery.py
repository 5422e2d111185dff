"""The synthetic battery: named movies that the network must tell apart, with the facts about each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from .catalogue import CATALOGUE, keywords
from .movie import Movie
from .view import SCENES

DEPTH_AND_PASSING = ("looming", "receding", "translating_right", "translating_left")
NEARBY_CM = 6.0
"""Distance of the passing objects: at 8 cm the slowest one moves 1 px a frame and excites no pair of LGMDs."""
SPEEDS_CM_S = (4.0, 8.0, 12.0)
POLARITIES: dict[str, dict[str, float]] = {
    "dark": {"object_grey": 45.0, "background_grey": 175.0},
    "bright": {"object_grey": 175.0, "background_grey": 45.0},
}
BACKGROUNDS: dict[str, dict[str, Any]] = {
    "stripes": {"background": "stripes"},
    "blobs": {"background": "blobs", "background_deg": 6.0, "background_contrast_grey": 30.0},
    "arena": {"scene": "arena"},
}


@dataclass(frozen=True, kw_only=True)
class Expectation:
    """What is known of a movie before any network sees it.

    Attributes
    ----------
    kind : as ``Movie.kind``
    dark : the object is darker than what lies behind it, or the flash takes light away; None for the other kinds
    speed_cm_s : speed of the object, None where there is none
    background : plain, stripes, blobs or arena
    noise_sigma : sensor noise, grey levels
    object_cm : width of the object, None where there is none
    contrast_grey : luminance step between object and background, or size of the change of light where that is known
    angle_deg : bearing from which an angular approach starts, negative from the left; None otherwise
    """

    kind: str
    dark: bool | None = None
    speed_cm_s: float | None = None
    background: str = "plain"
    noise_sigma: float = 0.0
    object_cm: float | None = None
    contrast_grey: float | None = None
    angle_deg: float | None = None


@dataclass(frozen=True)
class MovieFactory:
    """Makes one movie of the battery at any frame rate: ``factory(rate_hz=30.0)``."""

    kind: str
    settings: tuple[tuple[str, Any], ...]

    def __call__(self, rate_hz: float = 30.0, **changes: Any) -> Movie:
        """Return the movie at ``rate_hz``; ``changes`` replace keywords, such as ``width`` and ``height``."""
        return CATALOGUE[self.kind](**dict(self.settings) | {"rate_hz": rate_hz} | changes)


class Case(NamedTuple):
    """One line of the battery."""

    name: str
    expectation: Expectation
    movie: MovieFactory


def battery() -> Iterator[Case]:
    """Yield the cases, each name once, always in the same order; no movie is made until its factory is called.

    Moving objects: four kinds at three speeds in both polarities; then, at 8 cm/s and dark unless the name says
    otherwise, backgrounds, noise, sizes, contrasts, texture, approaches to the very lens, and at an angle. Then
    stillness, noise, flicker and flashes.
    """
    yield from _moving()
    for angle_deg in (-45.0, -30.0, 30.0, 45.0):
        side = "left" if angle_deg < 0 else "right"
        yield _object_case("angular", f"from_{side}-{abs(angle_deg):.0f}deg", angle_deg=angle_deg, scene="arena")
    yield from _still_scenes()


def _moving() -> Iterator[Case]:
    for polarity, greys in POLARITIES.items():
        for speed in SPEEDS_CM_S:
            for kind in DEPTH_AND_PASSING:
                yield _object_case(kind, f"{polarity}-{speed:g}cm_s", speed_cm_s=speed, **greys)
    for kind in DEPTH_AND_PASSING:
        for name, settings in BACKGROUNDS.items():
            yield _object_case(kind, name, **settings)
        yield _object_case(kind, "noise", noise_sigma=1.5)
        for object_cm in (2.5, 6.0):
            yield _object_case(kind, f"{object_cm:g}cm", object_cm=object_cm, height_cm=0.8 * object_cm)
        for label, grey in (("low_contrast", 145.0), ("high_contrast", 5.0)):
            yield _object_case(kind, label, object_grey=grey)
    yield _object_case("looming", "textured", object_contrast_grey=30.0)
    yield _object_case("looming", "disc", shape="disc", height_cm=4.0)
    yield _object_case("looming", "fills_view", stop_cm=0.5)


def _object_case(kind: str, label: str, **settings: Any) -> Case:
    settings.setdefault("speed_cm_s", 8.0)
    if kind.startswith("translating"):
        settings.setdefault("distance_cm", NEARBY_CM)
    about = _about(kind, settings)
    facts = Expectation(
        kind=kind,
        dark=about["object_grey"] < about["background_grey"],
        speed_cm_s=about["speed_cm_s"],
        background=about["background"],
        noise_sigma=about["noise_sigma"],
        object_cm=about["object_cm"],
        contrast_grey=abs(about["background_grey"] - about["object_grey"]),
        angle_deg=about.get("angle_deg"),
    )
    return Case(f"{kind}-{label}", facts, MovieFactory(kind, tuple(settings.items())))


def _still_scenes() -> Iterator[Case]:
    yield _light_case("still", "plain")
    yield _light_case("still", "arena", scene="arena")
    for sigma in (1.5, 4.0):
        facts = Expectation(kind="noise", noise_sigma=sigma)
        yield Case(f"noise-{sigma:g}", facts, MovieFactory("noise", (("sigma", sigma),)))
    for hz, amplitude in ((1.0, 0.1), (3.0, 0.1), (10.0, 0.05), (10.0, 0.2), (50.0, 0.1), (59.0, 0.1), (100.0, 0.1)):
        yield _light_case("flicker", f"{hz:g}hz-{100 * amplitude:g}pct", scene="arena", hz=hz, amplitude=amplitude)
    for label, offset_grey in (("bright", 60.0), ("dark", -60.0)):
        for background in ("plain", "arena"):
            where = {"scene": background, "offset_grey": offset_grey}
            yield _light_case("flash", f"{label}-step-{background}", **where)
            yield _light_case("flash", f"{label}-pulse-{background}", lasts_s=0.2, **where)
    yield _light_case("flash", "bright-decay-arena", scene="arena", offset_grey=60.0, decay_s=0.3)
    yield _light_case("flash", "lamp_off-arena", scene="arena", offset_grey=0.0, gain=0.4)


def _light_case(kind: str, label: str, **settings: Any) -> Case:
    about = _about(kind, settings)
    dark = about["offset_grey"] < 0 or about["gain"] < 1 if kind == "flash" else None
    facts = Expectation(
        kind=kind,
        dark=dark,
        background=about["background"],
        noise_sigma=about["noise_sigma"],
        contrast_grey=abs(about.get("offset_grey", 0.0)) or None,
    )
    return Case(f"{kind}-{label}", facts, MovieFactory(kind, tuple(settings.items())))


def _about(kind: str, settings: dict[str, Any]) -> dict[str, Any]:
    """Every keyword of the movie with the value it ends up with; an arena names itself as the background."""
    scene = settings.get("scene", "plain")
    about = keywords(kind) | SCENES[scene] | settings
    return about if scene == "plain" else about | {"background": scene}
