"""The hooks of a run, from what was typed after ``--hook``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import ParameterError

if TYPE_CHECKING:
    from ..hooks import Hook


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
