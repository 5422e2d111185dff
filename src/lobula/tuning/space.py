"""What is searched: settings with a range each, picked by name or pattern."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any, Literal

from ..errors import ParameterError
from ..model.network import NetworkParams
from ..params import nearest, walk, with_settings

Value = float | int | str | bool

DECADES = 100.0
"""A range whose ends are this many times apart is searched on a logarithmic scale."""

DIGITS = 4
"""Significant digits of a value that is tried: what is written into a file is what was measured."""

DEFAULT = "default"
_LGMD = ("sigmoid_grey=x4", "grouping.threshold_grey=x4")
_PATCHES = ("coarse_gain=x4", "coarse_on_weight=x4")
_DECISION = ("decision.collision_spikes=1..12", "decision.window_ms=100..500")
_LPTC = ("lptc.sigmoid_grey2=x4", "decision.lptc_weight=0..4")


@dataclass(frozen=True, kw_only=True)
class Axis:
    """One setting that is searched.

    low, high : ends of its range, both within; 0 where ``choices`` holds what it may be
    log : searched evenly in its logarithm
    start : its value in the settings the search begins with
    """

    path: str
    kind: Literal["int", "float", "choice"]
    unit: str
    start: Value
    low: float = 0.0
    high: float = 0.0
    log: bool = False
    choices: tuple[Value, ...] = ()

    def clipped(self, value: Value) -> Value:
        """Return ``value`` as it is tried: of ``DIGITS`` significant digits, within the range."""
        if self.kind == "choice" or isinstance(value, str):
            return value
        inside = min(max(float(value), self.low), self.high)
        if self.kind == "int":
            return round(inside)
        return min(max(float(f"{inside:.{DIGITS}g}"), self.low), self.high)

    @property
    def range_text(self) -> str:
        """The range in words."""
        if self.kind == "choice":
            return " | ".join(
                str(choice).lower() if isinstance(choice, bool) else str(choice) for choice in self.choices
            )
        return f"{self.low:g}..{self.high:g} {self.unit}".rstrip() + (", log" if self.log else "")


def default_vary(params: NetworkParams) -> list[str]:
    """Return what is searched where nobody says it: the scales and thresholds that the decision of ``params`` hangs on.

    Those of neurons that have no say in it are left out.
    """
    neurons = ("lgmd2",) if params.decision.neurons == "lgmd2" else ("lgmd1", "lgmd2")
    texts = []
    for neuron in neurons:
        lgmd = getattr(params, neuron)
        texts += [f"{neuron}.{name}" for name in (*_LGMD, *(_PATCHES if lgmd.coarse_gain else ()))]
    return [*texts, *_DECISION, *(_LPTC if params.decision.neurons == "all" else ())]


def axes(params: NetworkParams, vary: Sequence[str] = ()) -> tuple[Axis, ...]:
    """Return the axes that the texts ``vary`` ask for, in the order of the settings.

    Each is ``PATH``, ``PATH=LOW..HIGH`` or ``PATH=xFACTOR``, and PATH may be a pattern such as ``lptc.*``: a pattern
    takes numbers only, a path in full also truth values and choices. ``default`` stands for ``default_vary``. Where two
    texts name the same setting the later one holds. The range is the one written beside the setting, LOW..HIGH within
    it, or what lies within FACTOR of the present value.

    Raises
    ------
    ParameterError : a name that does not exist, or a range that is none
    """
    known = {path: (owner, name) for path, owner, name in walk(params)}
    found: dict[str, Axis] = {}
    for text in _expanded(params, vary or (DEFAULT,)):
        pattern, equals, about = text.partition("=")
        for path in _matching(pattern.strip(), known, text):
            owner, name = known[path]
            axis = _whole(path, getattr(owner, name), type(owner).__dataclass_fields__[name].metadata)
            found[path] = _narrowed(axis, about.strip(), text) if equals else axis
    return tuple(found[path] for path in known if path in found)


def settings_at(params: NetworkParams, values: Mapping[str, Value], origin: str) -> NetworkParams:
    """Return ``params`` with the settings ``values`` by path, each remembered as coming from ``origin``."""
    nested: dict[str, Any] = {}
    for path, value in values.items():
        *groups, name = path.split(".")
        inner = nested
        for group in groups:
            inner = inner.setdefault(group, {})
        inner[name] = value
    changed: NetworkParams = with_settings(params, nested, origin)
    return changed


def _expanded(params: NetworkParams, vary: Sequence[str]) -> Iterator[str]:
    for text in vary:
        yield from default_vary(params) if text.strip() == DEFAULT else (text,)


def _matching(pattern: str, known: Mapping[str, tuple[Any, str]], text: str) -> list[str]:
    """Return the paths that ``pattern`` names; a pattern passes over what cannot be searched, a full path does not."""
    if pattern in known:
        return [pattern]
    if not re.search(r"[*?[]", pattern):
        raise ParameterError(f"--vary {text}: no such setting{nearest(pattern, known)}")
    matched = [path for path in known if fnmatchcase(path, pattern)]
    if not matched:
        raise ParameterError(f"--vary {text}: matches no setting; `lobula config show` lists them")
    numbers = [path for path in matched if _is_number_with_range(*known[path])]
    if not numbers:
        raise ParameterError(f"--vary {text}: matches no number with a range; name truth values and choices in full")
    return numbers


def _is_number_with_range(owner: Any, name: str) -> bool:
    about = type(owner).__dataclass_fields__[name].metadata
    value = getattr(owner, name)
    return isinstance(value, int | float) and not isinstance(value, bool) and None not in (about["low"], about["high"])


def _whole(path: str, value: Any, about: Mapping[str, Any]) -> Axis:
    """Return the axis over all that is allowed."""
    if isinstance(value, bool) or about["choices"]:
        choices = (False, True) if isinstance(value, bool) else tuple(about["choices"])
        return Axis(path=path, kind="choice", unit=about["unit"], start=value, choices=choices)
    if isinstance(value, tuple):
        raise ParameterError(f"--vary {path}: is a list of numbers: must be a single one")
    low, high = about["low"], about["high"]
    if low is None or high is None:
        raise ParameterError(f"--vary {path}: has no range beside it: must have one to be searched")
    kind: Literal["int", "float"] = "int" if isinstance(value, int) else "float"
    return _scaled(Axis(path=path, kind=kind, unit=about["unit"], start=value, low=float(low), high=float(high)))


def _narrowed(axis: Axis, text: str, asked: str) -> Axis:
    if axis.kind == "choice":
        raise ParameterError(f"--vary {asked}: {axis.path} is one of {axis.range_text}: must be named without a range")
    factor = re.fullmatch(r"x(.+)", text)
    if factor:
        times = _number(factor[1], asked)
        start = float(axis.start)
        if not (times > 1 and start > 0):
            raise ParameterError(
                f"--vary {asked}: {axis.path} is {axis.start:g}: xFACTOR must be above 1, of a setting above 0"
            )
        low, high = max(axis.low, start / times), min(axis.high, start * times)
        if axis.kind == "int":
            low, high = float(math.ceil(low)), float(math.floor(high))
        narrowed = replace(axis, low=float(f"{low:.{DIGITS}g}"), high=float(f"{high:.{DIGITS}g}"), log=low > 0)
        narrowed = replace(narrowed, low=max(axis.low, narrowed.low), high=min(axis.high, narrowed.high))
    else:
        low_text, dots, high_text = text.partition("..")
        if not dots:
            raise ParameterError(f"--vary {asked}: must be PATH, PATH=LOW..HIGH or PATH=xFACTOR")
        narrowed = _scaled(replace(axis, low=_number(low_text, asked), high=_number(high_text, asked)))
        if not axis.low <= narrowed.low <= narrowed.high <= axis.high:
            raise ParameterError(
                f"--vary {asked}: must be LOW..HIGH in {axis.low:g}..{axis.high:g} {axis.unit}".rstrip()
            )
        if axis.kind == "int" and not (narrowed.low.is_integer() and narrowed.high.is_integer()):
            raise ParameterError(f"--vary {asked}: {axis.path} is a whole number: LOW and HIGH must be, too")
    if narrowed.low >= narrowed.high:
        raise ParameterError(f"--vary {asked}: nothing between {narrowed.low:g} and {narrowed.high:g}: must be a range")
    return narrowed


def _scaled(axis: Axis) -> Axis:
    """Return ``axis`` with the scale that suits its range."""
    return replace(axis, log=axis.low > 0 and axis.high >= DECADES * axis.low)


def _number(text: str, asked: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ParameterError(f"--vary {asked}: {text!r} is no number: must be PATH, PATH=LOW..HIGH or PATH=xFACTOR")
    return value
