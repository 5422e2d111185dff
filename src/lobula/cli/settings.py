"""The settings of a call: preset, then file, then ``--set``, then ``--neurons``, then ``--sensitivity``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import ParameterError
from ..model.network import NetworkParams
from ..model.presets import preset as named_preset
from ..model.sensitivity import with_sensitivity
from ..params import parse_setting, with_settings
from .settings_file import read_settings


class Chosen(NamedTuple):
    """The name of the preset that everything started from, and what came of it."""

    preset: str
    params: NetworkParams


def choose(
    preset: str | None = None,
    neurons: str | None = None,
    config: Path | None = None,
    settings: Sequence[str] = (),
    sensitivity: float | None = None,
) -> Chosen:
    """Return the settings that the options ask for; each step overrides the ones before it.

    Raises
    ------
    ParameterError : an unknown name, with the nearest one that exists, or a value out of range
    """
    table = {} if config is None else read_settings(config)
    base = table.pop("preset", "default") if preset is None else preset
    table.pop("preset", None)
    if not isinstance(base, str):
        raise ParameterError(f"settings file {config}: preset = {base!r}: must be the name of a preset")
    params = named_preset(base)
    if config is not None:
        try:
            params = with_settings(params, table, f"file {config.name}")
        except ParameterError as error:
            raise ParameterError(f"settings file {config}: {error}") from error
    for text in settings:
        params = with_settings(params, parse_setting(text), "command line")
    if neurons is not None:
        params = with_settings(params, {"decision": {"neurons": neurons}}, "command line")
    if sensitivity is not None:
        params = with_sensitivity(params, sensitivity)
    return Chosen(base, params)
