"""The hooks of a run: what is typed for them, how they are made, and where they stand among its outputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import ParameterError

if TYPE_CHECKING:
    from ..hooks import Hook
    from ..runtime.events import Record
    from ..runtime.sinks import Sink

HookTargets = Annotated[
    list[str] | None,
    typer.Option(
        "--hook", metavar="TARGET", help="where events go: tcp:HOST:PORT, mqtt://HOST/TOPIC, ...; may be repeated"
    ),
]
HookRate = Annotated[
    float | None, typer.Option(metavar="HZ", help="readings a second to hooks that carry them; 0 for events alone")
]


def make_hooks(targets: Sequence[str], readings_hz: float | None) -> list[Hook]:
    """Return the hook of each target, with ``--hook-rate`` looked at as well.

    Raises
    ------
    ParameterError : a target that is unknown, wrong or given twice; a rate that is no rate, or is for no hook
    MissingExtraError : the library of a hook is not installed
    """
    if readings_hz is not None and not 0 <= readings_hz < math.inf:
        raise ParameterError(f"--hook-rate {readings_hz:g}: must be 0 or more readings a second")
    if not targets:
        if readings_hz is not None:
            raise ParameterError(f"--hook-rate {readings_hz:g}: must have a --hook to go with")
        return []
    from ..hooks import make_hook

    hooks: list[Hook] = []
    for number, target in enumerate(targets):
        hook = make_hook(target)
        if target in targets[:number]:
            raise ParameterError(f"--hook {hook.name}: given twice: must be another target")
        hooks.append(hook)
    if readings_hz is not None and not any("reading" in hook.kinds for hook in hooks):
        names = ", ".join(hook.name for hook in hooks)
        raise ParameterError(f"--hook-rate {readings_hz:g}: must have a hook that carries readings, {names} does not")
    return hooks


def hook_files(hooks: Sequence[Hook]) -> dict[str, Path | None]:
    """Return what the hooks write, for ``check_files``."""
    return {f"hook {number}": hook.path for number, hook in enumerate(hooks, 1)}


def with_hooks(
    reader: Sink, hooks: Sequence[Hook], readings_hz: float | None, also: Callable[[Record], None] | None = None
) -> list[Sink]:
    """Return the hooks and the reader of the run, who is told how they fare, as sinks; ``also`` hears of that too."""
    if not hooks:
        return [reader]
    from ..hooks import PostOffice, Telling

    office = PostOffice(hooks, readings_hz)
    return [office, Telling(reader, office, also)]
