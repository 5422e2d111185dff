"""Counts, potentials and shares as text, each with its interval."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache

import numpy as np

from ...intervals import bootstrap, wilson
from ...report.palette import LABELS
from ...types import Neuron
from .trials import Trial


def mean_text(values: Iterable[float], digits: int = 1) -> str:
    """Return the mean over the seeds and its 95 % bootstrap interval, such as ``12.3 (11.8 to 12.9)``."""
    return _mean_text(tuple(sorted(value for value in values if math.isfinite(value))), digits)


@lru_cache(maxsize=4096)
def _mean_text(values: tuple[float, ...], digits: int) -> str:
    """The same counts come again and again, ten zeros most often."""
    if not values:
        return "none"
    low, high = bootstrap(np.array(values)[:, None], lambda sums: sums[:, 0] / len(values))
    mean = _short(float(np.mean(values)), digits)
    return mean if math.isnan(low) else f"{mean} ({_short(low, digits)} to {_short(high, digits)})"


def share_text(held: int, trials: int) -> str:
    """Return a share and its 95 % Wilson interval, such as ``9 of 10 (60 to 98 %)``."""
    low, high = wilson(held, trials)
    return f"{held} of {trials} ({100 * low:.0f} to {100 * high:.0f} %)"


def spikes_text(trials: Sequence[Trial], neurons: Sequence[Neuron]) -> str:
    """Return the mean spikes within the window, neuron by neuron."""
    return ", ".join(f"{LABELS[n]} {mean_text(t.spikes[n] for t in trials)}" for n in neurons)


def peaks_text(trials: Sequence[Trial], neurons: Sequence[Neuron]) -> str:
    """Return the mean peak potential, neuron by neuron."""
    return ", ".join(f"{LABELS[n]} {mean_text((t.peak[n] for t in trials), 2)}" for n in neurons)


def against_text(
    text: Callable[[Sequence[Trial], Sequence[Neuron]], str],
    ours: Sequence[Trial],
    others: Sequence[Trial],
    neurons: Sequence[Neuron],
) -> str:
    """Return ``text`` of two courses that are compared."""
    return f"{text(ours, neurons)}, against {text(others, neurons)}"


def _short(value: float, digits: int) -> str:
    if abs(value) >= 100:
        return f"{value:.0f}"
    return f"{value:.0f}" if digits == 1 and value == round(value) else f"{value:.{digits}f}"
