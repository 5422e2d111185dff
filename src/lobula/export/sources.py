"""The C sources that a robot needs: exact copies of the core's own."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from ..errors import LobulaError

INSTALLED = Path(__file__).with_name("c")
"""Where an installed package has them, side by side: setup.py puts them there."""

CHECKOUT = Path(__file__).parents[3]
"""Where a checkout has its folder ``core`` and its licence."""

LIST = "core/robot/files.txt"
CONFIG = "lobula_config.h"


class SourcesError(LobulaError, OSError):
    """The C sources are not where they belong."""


@cache
def c_sources() -> dict[str, str]:
    """Return name -> text of the C files that go into the folder as they are, and ``LICENSE``.

    Raises
    ------
    SourcesError : a package without its C sources
    """
    if INSTALLED.is_dir():
        paths = sorted(INSTALLED.iterdir())
    else:
        paths = [CHECKOUT / line for line in _listed()] + [CHECKOUT / "LICENSE"]
    try:
        return {path.name: path.read_text(encoding="utf-8") for path in paths}
    except OSError as error:
        raise SourcesError(f"the C sources of lobula are not complete: {error.strerror}: {error.filename}") from error


def _listed() -> list[str]:
    try:
        return (CHECKOUT / LIST).read_text(encoding="utf-8").split()
    except OSError as error:
        raise SourcesError(
            f"this lobula came without its C sources: neither {INSTALLED} nor {CHECKOUT / LIST} is there"
        ) from error
