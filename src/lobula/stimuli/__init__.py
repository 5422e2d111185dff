"""Synthetic movies with known answers: approach, recession, translation, gratings, flicker, flashes, stillness."""

from .battery import Case, Expectation, MovieFactory, battery
from .catalogue import CATALOGUE, keywords
from .grating import grating
from .lamp import with_flash, with_flicker, with_repeats
from .light import flash, flicker, noise, still
from .movie import Movie, mirrored
from .moving import angular, looming, receding, translating

__all__ = [
    "CATALOGUE",
    "Case",
    "Expectation",
    "Movie",
    "MovieFactory",
    "angular",
    "battery",
    "flash",
    "flicker",
    "grating",
    "keywords",
    "looming",
    "mirrored",
    "noise",
    "receding",
    "still",
    "translating",
    "with_flash",
    "with_flicker",
    "with_repeats",
]
