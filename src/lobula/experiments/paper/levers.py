"""Constants of the network that the paper does not print and on which its claims hang: other values, to be compared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ...model.network import NetworkParams
from ...params import with_settings

K_HS = (0.0005, 0.001, 0.002, 0.004, 0.01)
C_SIG_TIMES = (2, 4)
DEAD_ZONE_GREY = (0.5, 1.0)

LEVERS = (
    *(f"K_hs {value:g}" for value in K_HS),
    *(f"C_sig x {times}" for times in C_SIG_TIMES),
    *(f"dead zone {grey:g}" for grey in DEAD_ZONE_GREY),
)
"""Names of the changes, in the order of the tables."""


def pulled(presets: Mapping[str, NetworkParams]) -> Iterator[tuple[str, str, NetworkParams]]:
    """Yield (change, preset, settings) for every change of every preset; a value it has already is left out."""
    source = "to see what hangs on it"
    for name, params in presets.items():
        for value in K_HS:
            if value != params.lptc.sigmoid_grey2:
                yield f"K_hs {value:g}", name, with_settings(params, {"lptc": {"sigmoid_grey2": value}}, source)
        for times in C_SIG_TIMES:
            changed: dict[str, Any] = {
                neuron: {"sigmoid_grey": times * getattr(params, neuron).sigmoid_grey} for neuron in ("lgmd1", "lgmd2")
            }
            yield f"C_sig x {times}", name, with_settings(params, changed, source)
        for grey in DEAD_ZONE_GREY:
            changed = {"lamina": {"dog": {"dead_zone_grey": grey}}}
            yield f"dead zone {grey:g}", name, with_settings(params, changed, source)
