"""Settings as C: one macro for each, with its unit, meaning and origin beside it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .._version import __version__
from ..model.network import NetworkParams
from ..params import Params, settings_hash, walk

NOT_ON_A_ROBOT = ("decision.turning_deg_s",)
"""Settings the C core has no use for: whoever turns the robot says so itself."""

HEADER = """\
/* The settings and the size of one network: preset {preset}, {width} x {height} px, settings {settings}.
 *
 * Written by `lobula export c` of lobula {version}: do not edit, export again. Each macro is named after the setting's
 * path (`lobula config show` lists them); its comment says what it means, its unit, and in brackets where the value
 * comes from. Whole numbers, switches (0 or 1) and choices (counted from 0) are integers, all others floats. */
#ifndef LOBULA_CONFIG_H
#define LOBULA_CONFIG_H

#define LOBULA_VERSION "{version}"
#define LOBULA_PRESET "{preset}"
#define LOBULA_SETTINGS_HASH "{settings}"
#define LOBULA_WIDTH {width}
#define LOBULA_HEIGHT {height}

{macros}

#endif
"""


def config_header(params: NetworkParams, preset: str, width: int, height: int) -> str:
    """Return ``lobula_config.h`` for these settings and a picture of ``width`` x ``height`` px.

    ``preset`` is the name of what the settings started from; ``settings_hash`` in the header tells them apart.
    """
    return HEADER.format(
        version=__version__, preset=preset, settings=settings_hash(params), width=width, height=height,
        macros="\n".join(_macros(params)),
    )  # fmt: skip


def macro_name(path: str) -> str:
    """Return the macro of a setting: ``lamina.dog.sigma_px`` is ``LOBULA_LAMINA_DOG_SIGMA_PX``."""
    return f"LOBULA_{path.replace('.', '_').upper()}"


def _macros(params: NetworkParams) -> Iterator[str]:
    for path, owner, name in walk(params):
        if path in NOT_ON_A_ROBOT:
            continue
        value = getattr(owner, name)
        if path == "lptc.emd.spans_px":
            yield f"#define {macro_name('lptc.emd.spans')} {len(value)} /* how many pairs of cells there are */"
            yield f"#define {macro_name('lptc.emd.widest_px')} {max(value)} /* the largest distance, px */"
        yield f"#define {macro_name(path)} {_c_value(owner, name, value)} /* {_remark(owner, name, value)} */"


def _c_value(owner: Params, name: str, value: Any) -> str:
    """A value as a C constant; a list of them in braces."""
    choices = type(owner).__dataclass_fields__[name].metadata["choices"]
    if choices:
        return str(choices.index(value))
    if isinstance(value, tuple):
        return f"{{{', '.join(_c_value(owner, name, item) for item in value)}}}"
    return f"{value!r}f" if isinstance(value, float) else str(int(value))


def _remark(owner: Params, name: str, value: Any) -> str:
    """What a setting means, its unit and origin, fit to stand in a comment."""
    about = type(owner).__dataclass_fields__[name].metadata
    chosen = f"{value}; " if about["choices"] else ""
    unit = f", {about['unit']}" if about["unit"] else ""
    text = f"{chosen}{about['doc']}{unit} ({owner.source_of(name)})"
    return " ".join(text.replace("*/", "* /").replace("/*", "/ *").split())
