"""Every movie by its name, and the keywords each takes."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any

from ..errors import ParameterError
from ..params import to_dict
from .grating import grating
from .light import flash, flicker, noise, still
from .movie import Movie
from .moving import angular, looming, receding, translating
from .moving_object import MovingObject
from .view import View

CATALOGUE: dict[str, Callable[..., Movie]] = {
    "looming": looming,
    "receding": receding,
    "translating_right": partial(translating, direction="right"),
    "translating_left": partial(translating, direction="left"),
    "angular": angular,
    "grating": grating,
    "flicker": flicker,
    "flash": flash,
    "still": still,
    "noise": noise,
}
"""Name of a kind -> the function that makes it, all keywords optional."""

_MOVING = ("looming", "receding", "translating_right", "translating_left", "angular")


def keywords(name: str) -> dict[str, Any]:
    """Return the keywords that ``CATALOGUE[name]`` takes, with their defaults, the movie's own first.

    ``None`` means that the docstring says what is taken.

    Raises
    ------
    ParameterError : no such movie
    """
    if name not in CATALOGUE:
        raise ParameterError(f"stimulus {name!r}: must be one of {', '.join(CATALOGUE)}")
    signature = inspect.signature(CATALOGUE[name]).parameters.values()
    own = {p.name: p.default for p in signature if p.kind is p.KEYWORD_ONLY}
    if name.startswith("translating"):
        del own["direction"]
    settings = MovingObject if name in _MOVING else View
    shared = to_dict(settings())
    if name == "noise":
        del shared["noise_sigma"]
    return own | {"scene": "plain"} | shared
