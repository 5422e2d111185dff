"""The machine and the versions that figures were measured with: a figure without them says little."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from .._version import __version__
from ..engine import library

OPTIONAL = ("scipy", "opencv-python-headless", "av")


def machine() -> dict[str, Any]:
    """Return processor, cores, load, system, versions, and the core's instruction set."""
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "load": round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None,
        "system": f"{platform.system()} {platform.machine()}",
        "isa": library.isa() if library.available() else None,
        "isas": list(library.isas()),
        "python": platform.python_version(),
        "lobula": __version__,
        "numpy": np.__version__,
        **{name: found for name in OPTIONAL if (found := _version(name))},
    }


def processor() -> str:
    """Return the name of the processor as the system gives it."""
    about = Path("/proc/cpuinfo")
    if about.exists():
        for line in about.read_text(encoding="utf-8", errors="replace").splitlines():
            key, _, value = line.partition(":")
            if key.strip() in ("model name", "Hardware", "Model") and value.strip():
                return value.strip()
    return platform.processor() or platform.machine()


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
