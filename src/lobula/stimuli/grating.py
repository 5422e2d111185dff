"""A grating that drifts across the whole view: the classic stimulus of the motion detectors."""

from __future__ import annotations

import math
from typing import Literal, Unpack

import numpy as np

from ..errors import ParameterError
from .movie import Movie
from .view import Luminance, View, ViewSettings, film, given, require_between


def grating(
    *,
    direction: Literal["right", "left", "down", "up"] = "right",
    period_px: float | None = None,
    period_deg: float | None = None,
    temporal_hz: float = 2.0,
    contrast: float = 0.3,
    wave: Literal["sine", "square"] = "sine",
    lead_s: float = 0.5,
    duration_s: float = 2.0,
    **settings: Unpack[ViewSettings],
) -> Movie:
    """Return a grating that stands for ``lead_s``, then drifts for ``duration_s``.

    A point sees ``temporal_hz`` periods a second. The period is given in columns or in degrees at the middle of the
    view (default 15 deg). Around ``background_grey`` the light swings by the share ``contrast``, its Michelson
    contrast. Each pixel holds the exact mean over its area. The wall's pattern and the floor are not drawn;
    ``settings``: see ``View``.

    Raises
    ------
    ParameterError : a number out of range, or both ``period_px`` and ``period_deg``
    """
    view = given(View(), settings)
    if direction not in ("right", "left", "down", "up"):
        raise ParameterError(f"stimuli.grating: direction {direction!r}: must be right, left, down or up")
    if wave not in ("sine", "square"):
        raise ParameterError(f"stimuli.grating: wave {wave!r}: must be sine or square")
    if period_px is not None and period_deg is not None:
        raise ParameterError("stimuli.grating: give period_px or period_deg, not both")
    if period_px is None:
        degrees = 15.0 if period_deg is None else period_deg
        require_between("stimuli.grating: period_deg", degrees, 0.1, 80.0, "deg")
        period_px = view.focal_px * math.tan(math.radians(degrees))
    require_between("stimuli.grating: period_px", period_px, 0.01, 1e5, "px")
    require_between("stimuli.grating: temporal_hz", temporal_hz, 0.0, 1000.0, "Hz")
    require_between("stimuli.grating: contrast", contrast, 0.0, 1.0, "")
    require_between("stimuli.grating: lead_s", lead_s, 0.0, 600.0, "s")
    sign = 1.0 if direction in ("right", "down") else -1.0
    sideways = direction in ("right", "left")
    edges = np.arange((view.width if sideways else view.height) + 1) / period_px

    def light(time_s: float) -> Luminance:
        turns = edges - sign * temporal_hz * max(time_s - lead_s, 0.0)
        if wave == "sine":
            area = -np.cos(2 * math.pi * turns) / (2 * math.pi)
        else:
            phase = turns % 1.0  # +1 for half a turn, then -1: its integral is a triangle
            area = np.minimum(phase, 1 - phase)
        line = view.background_grey * (1 + contrast * np.diff(area) * period_px)
        return np.broadcast_to(line if sideways else line[:, None], (view.height, view.width))

    own = {
        "direction": direction,
        "period_px": period_px,
        "temporal_hz": temporal_hz,
        "contrast": contrast,
        "wave": wave,
        "lead_s": lead_s,
        "duration_s": duration_s,
    }
    return film(view, lead_s + duration_s, light, kind="grating", settings=own)
