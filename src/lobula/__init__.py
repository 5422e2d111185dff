"""lobula watches one camera and says, in time, that something is going to hit it.

    import lobula

    net, alarm = lobula.Network(), False
    for frame in lobula.open("clip.mp4"):
        before, alarm = alarm, net.step(frame).collision
        if alarm and not before:
            print(f"collision at {frame.time_s:.2f} s")

Importing lobula does nothing else: each name below is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ._version import __version__

if TYPE_CHECKING:
    from . import stimuli
    from .engine.network import Network
    from .errors import LobulaError
    from .model.network import NetworkParams
    from .model.presets import preset
    from .runtime.opening import open
    from .types import Frame, Reading, Spikes

__all__ = [
    "Frame",
    "LobulaError",
    "Network",
    "NetworkParams",
    "Reading",
    "Spikes",
    "__version__",
    "open",
    "preset",
    "stimuli",
]

_HOMES = {
    "Frame": "types",
    "LobulaError": "errors",
    "Network": "engine.network",
    "NetworkParams": "model.network",
    "Reading": "types",
    "Spikes": "types",
    "open": "runtime.opening",
    "preset": "model.presets",
}
_MODULES = ("stimuli",)


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f".{name}", __name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    globals()[name] = value  # found at once the next time
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
