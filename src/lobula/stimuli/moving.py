"""One object that moves before a still wall: approach, recession, translation, approach at an angle."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Literal, Unpack

from ..errors import ParameterError
from .movie import Movie
from .moving_object import MovingObject, ObjectSettings, draw
from .view import Luminance, film, given, require_between, wall

Path = Callable[[float], tuple[float, float]]
"""Seconds of travel -> (x_cm to the right of the optical axis, z_cm ahead of the lens)."""


def looming(
    *,
    l_over_v_ms: float | None = None,
    speed_cm_s: float | None = None,
    start_cm: float = 30.0,
    stop_cm: float = 3.5,
    offset_cm: float = 0.0,
    **settings: Unpack[ObjectSettings],
) -> Movie:
    """Return a frontal approach at constant speed.

    Give ``speed_cm_s`` (default 8) or ``l_over_v_ms``, half the width over the speed. The object comes from
    ``start_cm`` to ``stop_cm`` (0: into the lens, it fills the view) and stays there. ``contact_s`` is when it is, or
    would have been, at distance 0: ``lead_s + start_cm / speed_cm_s``. ``offset_cm`` moves its path to the right.
    ``settings``: see ``MovingObject`` and ``View``.

    Raises
    ------
    ParameterError : a number out of range, or both ``l_over_v_ms`` and ``speed_cm_s``

    Source: paper Sec. III, the frontal approach; l/|v| as in the looming literature.
    """
    thing = _object(settings)
    if l_over_v_ms is not None:
        if speed_cm_s is not None:
            raise ParameterError("stimuli.looming: give l_over_v_ms or speed_cm_s, not both")
        require_between("stimuli.looming: l_over_v_ms", l_over_v_ms, 0.1, 1e5, "ms")
        speed_cm_s = thing.object_cm / 2 / (l_over_v_ms / 1000)
    speed = _speed("looming", 8.0 if speed_cm_s is None else speed_cm_s)
    require_between("stimuli.looming: start_cm", start_cm, 0.1, 1e4, "cm")
    require_between("stimuli.looming: stop_cm", stop_cm, 0.0, start_cm, "cm")
    require_between("stimuli.looming: offset_cm", offset_cm, -1e4, 1e4, "cm")
    own = {
        "speed_cm_s": speed,
        "l_over_v_ms": thing.object_cm / 2 / speed * 1000,
        "start_cm": start_cm,
        "stop_cm": stop_cm,
        "offset_cm": offset_cm,
    }
    return _film(
        thing,
        "looming",
        lambda u: (offset_cm, start_cm - speed * u),
        (start_cm - stop_cm) / speed,
        own,
        touch_s=start_cm / speed,
    )


def receding(
    *,
    speed_cm_s: float = 8.0,
    start_cm: float = 3.5,
    stop_cm: float = 30.0,
    offset_cm: float = 0.0,
    **settings: Unpack[ObjectSettings],
) -> Movie:
    """Return a recession: the object starts near, at ``start_cm``, and backs away to ``stop_cm``.

    The same geometry as ``looming`` run backwards. ``settings``: see ``MovingObject`` and ``View``.

    Raises
    ------
    ParameterError : a number out of range

    Source: paper Sec. III.
    """
    speed = _speed("receding", speed_cm_s)
    require_between("stimuli.receding: stop_cm", stop_cm, 0.1, 1e4, "cm")
    require_between("stimuli.receding: start_cm", start_cm, 0.0, stop_cm, "cm")
    require_between("stimuli.receding: offset_cm", offset_cm, -1e4, 1e4, "cm")
    own = {"speed_cm_s": speed, "start_cm": start_cm, "stop_cm": stop_cm, "offset_cm": offset_cm}
    return _film(
        _object(settings), "receding", lambda u: (offset_cm, start_cm + speed * u), (stop_cm - start_cm) / speed, own
    )


def translating(
    *,
    direction: Literal["right", "left"] = "right",
    speed_cm_s: float = 8.0,
    distance_cm: float = 8.0,
    span_cm: float = 14.0,
    **settings: Unpack[ObjectSettings],
) -> Movie:
    """Return an object that passes by at constant depth ``distance_cm``, from ``span_cm`` on one side to the other.

    Its kind is ``translating_right`` or ``translating_left``. ``settings``: see ``MovingObject`` and ``View``.

    Raises
    ------
    ParameterError : a number out of range

    Source: paper Sec. III, nearby translation.
    """
    if direction not in ("right", "left"):
        raise ParameterError(f"stimuli.translating: direction {direction!r}: must be right or left")
    speed = _speed("translating", speed_cm_s)
    require_between("stimuli.translating: distance_cm", distance_cm, 0.1, 1e4, "cm")
    require_between("stimuli.translating: span_cm", span_cm, 0.0, 1e4, "cm")
    sign = 1.0 if direction == "right" else -1.0
    own = {"direction": direction, "speed_cm_s": speed, "distance_cm": distance_cm, "span_cm": span_cm}
    return _film(
        _object(settings),
        f"translating_{direction}",
        lambda u: (sign * (speed * u - span_cm), distance_cm),
        2 * span_cm / speed,
        own,
    )


def angular(
    *,
    angle_deg: float = -30.0,
    speed_cm_s: float = 8.0,
    start_cm: float = 30.0,
    aim_cm: float = 3.0,
    **settings: Unpack[ObjectSettings],
) -> Movie:
    """Return an approach from the side, along a straight line that ends right before the camera.

    The object starts ``start_cm`` away at bearing ``angle_deg`` (negative: from the left, so it moves rightward
    across the view; positive: from the right) and heads for the point ``aim_cm`` straight ahead, where it stops:
    ``contact_s`` is that moment. A line to the lens itself would keep its bearing and not cross the view at all.
    ``settings``: see ``MovingObject`` and ``View``.

    Raises
    ------
    ParameterError : a number out of range

    Source: paper Sec. III, angular approaches.
    """
    speed = _speed("angular", speed_cm_s)
    require_between("stimuli.angular: angle_deg", angle_deg, -80.0, 80.0, "deg")
    require_between("stimuli.angular: start_cm", start_cm, 0.1, 1e4, "cm")
    require_between("stimuli.angular: aim_cm", aim_cm, 0.0, start_cm, "cm")
    bearing = math.radians(angle_deg)
    x0, z0 = start_cm * math.sin(bearing), start_cm * math.cos(bearing)
    travel_s = math.hypot(x0, z0 - aim_cm) / speed

    def path(u: float) -> tuple[float, float]:
        done = u / travel_s if travel_s else 1.0
        return x0 * (1 - done), z0 + (aim_cm - z0) * done

    own = {"angle_deg": angle_deg, "speed_cm_s": speed, "start_cm": start_cm, "aim_cm": aim_cm}
    return _film(_object(settings), "angular", path, travel_s, own, touch_s=travel_s)


def _object(settings: ObjectSettings) -> MovingObject:
    return given(MovingObject(), settings)


def _speed(name: str, speed_cm_s: float) -> float:
    return require_between(f"stimuli.{name}: speed_cm_s", speed_cm_s, 0.01, 1e4, "cm/s")


def _film(
    thing: MovingObject, kind: str, path: Path, travel_s: float, own: Mapping[str, Any], *, touch_s: float | None = None
) -> Movie:
    behind = wall(thing)
    drawn: dict[tuple[float, float], Luminance] = {}  # the last picture: the object often stands still

    def light(time_s: float) -> Luminance:
        place = path(min(max(time_s - thing.lead_s, 0.0), travel_s))
        if place not in drawn:
            drawn.clear()
            drawn[place] = draw(thing, behind, *place)
        return drawn[place]

    return film(
        thing,
        thing.lead_s + travel_s + thing.hold_s,
        light,
        kind=kind,
        settings=own,
        contact_s=None if touch_s is None else thing.lead_s + touch_s,
    )
