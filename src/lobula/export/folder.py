"""A preset and a size as a folder that any C99 compiler takes."""

from __future__ import annotations

from pathlib import Path
from string import Template

from .._version import __version__
from ..model.network import NetworkParams
from ..params import settings_hash
from .config_header import config_header
from .memory import require_size, state_bytes
from .sources import CONFIG, c_sources

EXAMPLE = "main.c"
"""The file that the user makes his own; it is not written over."""

OPTIONAL = ("motor", "telemetry")
"""Parts of the folder that the network does not need."""

TEMPLATE = Path(__file__).with_name("template")


def c_folder(params: NetworkParams, preset: str, width: int, height: int, command: str) -> dict[str, str]:
    """Return name -> text of every file of the folder.

    Parameters
    ----------
    params, preset : the settings, and the name of what they started from
    width, height : size of the robot's picture, px
    command : what was called, for the README

    Raises
    ------
    ParameterError : a size that the core does not take
    SourcesError : a package without its C sources
    """
    require_size(width, height)
    sources = c_sources()
    optional = [f"`{name}.c`" for name in OPTIONAL if f"{name}.c" in sources]
    words = {
        "width": width, "height": height, "preset": preset, "settings": settings_hash(params), "version": __version__,
        "command": command, "state_bytes": state_bytes(params, width, height), "optional": " and ".join(optional),
    }  # fmt: skip
    return {
        **sources,
        CONFIG: config_header(params, preset, width, height),
        EXAMPLE: _template(EXAMPLE),
        "README.md": Template(_template("README.md")).substitute(words),
    }


def _template(name: str) -> str:
    return (TEMPLATE / name).read_text(encoding="utf-8")
