"""Named settings: which mechanism is on, and where each value comes from."""

from __future__ import annotations

from typing import Any

from ..errors import ParameterError
from ..params import with_settings
from .network import NetworkParams

Settings = dict[str, Any]

LGMD2_PUBLISHED: Settings = {
    "on": {
        "centre_weight": 2.0, "nearest_weight": 0.5, "diagonal_weight": 0.25,
        "centre_ms": 15.0, "nearest_ms": 30.0, "diagonal_ms": 45.0, "bias": 1.0,
    },
    "change_ms": 90.0,
    "product_gain": 1.0,
}  # fmt: skip
PUBLISHED: dict[str, Settings] = {"published code: LGMD2-open-source": {"lgmd2": LGMD2_PUBLISHED}}
CALIBRATED = "calibrated on the synthetic battery at 30 Hz (docs/calibration.md)"
LGMD_ON_LAMINA: Settings = {
    "reads": "lamina",
    "grouping": {"threshold_grey": 0.1, "floor_grey": 1e-4},
    "sigmoid_grey": 0.0048,
}
ON_LAMINA: Settings = {"lgmd1": LGMD_ON_LAMINA, "lgmd2": LGMD_ON_LAMINA, "lptc": {"sigmoid_grey2": 0.002}}
IN_THE_ARENA = "calibrated in the arena, seeds 121 to 132 (docs/protocol.md)"
LGMD2_WITH_PATCHES: Settings = {
    "saturation": {"enabled": True, "limit_grey": 50.0},
    "lgmd2": {"grouping": {"threshold_grey": 5.0}, "coarse_gain": 8.0, "coarse_on_weight": 6.0, "sigmoid_grey": 2.0},
    "decision": {"neurons": "lgmd2"},
}
PRESETS: dict[str, dict[str, Settings]] = {
    "published": PUBLISHED,
    "paper": {**PUBLISHED, CALIBRATED: ON_LAMINA},
    "lobula": {**PUBLISHED, IN_THE_ARENA: LGMD2_WITH_PATCHES},
}
"""For each preset, the settings that differ from the declared defaults, by origin."""

BASES = ("published", "paper")
"""The presets of the paper's wiring, in which who decides can be selected."""

DEFAULT = "paper"
NAMES = ("default", *PRESETS)
NEURONS = ("all", "lgmds", "lgmd2")


def preset(name: str = "default", *, neurons: str | None = None) -> NetworkParams:
    """Return the settings of a preset: ``paper``, ``published``, ``lobula`` or ``default``.

    ``neurons`` selects who decides: ``all`` four, the two ``lgmds``, or ``lgmd2`` alone; without it, whoever does in
    the preset: all four in the paper's, LGMD-2 in ``lobula``.

    Raises
    ------
    ParameterError : an unknown preset or selection
    """
    if name not in NAMES:
        raise ParameterError(f"preset {name!r}: must be one of {', '.join(NAMES)}")
    if neurons is not None and neurons not in NEURONS:
        raise ParameterError(f"neurons {neurons!r}: must be one of {', '.join(NEURONS)}")
    params = NetworkParams()
    for origin, settings in PRESETS[DEFAULT if name == "default" else name].items():
        params = with_settings(params, settings, origin)
    if neurons is None:
        return params
    chosen: NetworkParams = with_settings(params, {"decision": {"neurons": neurons}}, "chosen by the caller")
    return chosen
