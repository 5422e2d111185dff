"""The shared library of the C core: found, loaded and checked once; or the reason why there is none."""

from __future__ import annotations

import ctypes
import os
from functools import cache

from ..errors import ParameterError
from .structures import SIGNATURES, CoreParams

ABI = 3
FILE = os.path.join(os.path.dirname(__file__), "liblobula.so")
"""Where ``pip install`` puts it, whatever the system calls its shared libraries."""


@cache
def _load() -> ctypes.CDLL | str:
    if not os.path.exists(FILE):
        return "it was not built: no C compiler was found when lobula was installed"
    try:
        library = ctypes.CDLL(FILE)
        for name, (result, arguments) in SIGNATURES.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        return f"{FILE} cannot be loaded: {error}"
    if library.lobula_abi() != ABI or library.lobula_params_size() != ctypes.sizeof(CoreParams):
        return f"{FILE} belongs to another version of lobula; install again"
    return library


def available() -> bool:
    """Whether the C core can be used here."""
    return not isinstance(_load(), str)


def why_not() -> str:
    """Why the C core cannot be used; empty where it can."""
    loaded = _load()
    return loaded if isinstance(loaded, str) else ""


def library() -> ctypes.CDLL:
    """Return the loaded library.

    Raises
    ------
    ParameterError : there is none; the message says why
    """
    loaded = _load()
    if isinstance(loaded, str):
        raise ParameterError(f"engine 'core': {loaded}; use engine='reference' or 'auto'")
    return loaded


def isas() -> tuple[str, ...]:
    """Return the instruction sets in this build that this processor runs, from the plainest up; empty without core."""
    if not available():
        return ()
    core, names = library(), []
    index = 0
    while (name := core.lobula_isa_name(index)) is not None:
        if core.lobula_isa_runs(index):
            names.append(name.decode())
        index += 1
    return tuple(names)


def isa() -> str:
    """Return the instruction set that networks made now will use; ``LOBULA_ISA`` in the environment overrules.

    Raises
    ------
    ParameterError : ``LOBULA_ISA`` names one that this build or processor has not
    """
    return str(library().lobula_isa_name(isa_index()), "ascii")


def isa_index() -> int:
    """Return the number of ``isa()`` in the core's table."""
    core = library()
    wanted = os.environ.get("LOBULA_ISA")
    if not wanted:
        return int(core.lobula_isa_best())
    index = 0
    while (name := core.lobula_isa_name(index)) is not None:
        if name.decode() == wanted and core.lobula_isa_runs(index):
            return index
        index += 1
    raise ParameterError(f"LOBULA_ISA={wanted}: must be one of {', '.join(isas())}")
