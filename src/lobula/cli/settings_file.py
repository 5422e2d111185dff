"""Settings files: TOML, the names of ``lobula config show``, every number with its unit, range and origin."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import ParameterError


def read_settings(path: Path) -> dict[str, Any]:
    """Return the settings of a TOML file as nested dictionaries.

    Raises
    ------
    ParameterError : no such file, or not TOML
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        reason = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise ParameterError(f"settings file {path}: {reason}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ParameterError(f"settings file {path}: is not TOML: {error}") from error


def settings_toml(rows: Sequence[Mapping[str, Any]], preset: str) -> str:
    """Return a commented TOML document of ``rows`` (as ``setting_rows`` gives them), grouped by layer."""
    groups: dict[str, list[str]] = {}
    for row in rows:
        owner, _, name = row["path"].rpartition(".")
        groups.setdefault(owner, []).append(f"{name} = {toml_value(row['value'])}  # {remark(row)}")
    lines = [
        "# Settings of lobula. Lines may be left out: the preset's value holds then.",
        "",
        f"preset = {json.dumps(preset)}",
    ]
    for owner, settings in groups.items():
        lines += ["", f"[{owner}]", *settings]
    return "\n".join(lines) + "\n"


def remark(row: Mapping[str, Any]) -> str:
    """Return meaning, allowed values and origin of a setting in one line."""
    allowed = allowed_values(row)
    return f"{row['meaning']}{f'; {allowed}' if allowed else ''}; {row['source']}"


def allowed_values(row: Mapping[str, Any]) -> str:
    """Return what a setting may be: its choices, or its range and unit."""
    if row["choices"]:
        return "|".join(row["choices"])
    if row["low"] is None and row["high"] is None:
        return "true|false" if isinstance(row["value"], bool) else str(row["unit"])
    return f"{row['low']:g}..{row['high']:g} {row['unit']}".rstrip()


def toml_value(value: Any) -> str:
    """Return a number, truth value, text or list as TOML writes it."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    return json.dumps(value)
