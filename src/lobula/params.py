"""One setting, one line: value, unit, range, meaning and origin together.

The command's flags and help, the docs table, validation and the tuning ranges read the same line, so they cannot
disagree. Every start pays for what is imported here, so what only some calls need is imported by them.
"""

from __future__ import annotations

import typing
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from numbers import Integral, Real
from typing import Any

from .errors import ParameterError


def param(
    default: Any,
    unit: str,
    doc: str,
    *,
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] | None = None,
    source: str,
) -> Any:
    """Return a dataclass field that carries its own range [low, high] or choices, unit, meaning and origin."""
    about = {"unit": unit, "doc": doc, "low": low, "high": high, "choices": choices, "source": source}
    return field(default=default, metadata=about)


@dataclass(frozen=True, kw_only=True)
class Params:
    """Base of every parameter set: checks each field against its own kind and range when the object is made.

    What is kept is the kind's own plain value: 2 in a field of real numbers is 2.0, a NumPy scalar a Python number, a
    list a tuple. So equal settings read, hash and compare alike however they were given.

    ``origins`` names where a value came from when it is not the declared one: a preset, a file, the command line.
    """

    origins: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        for f in fields(self):
            if "source" in f.metadata:
                value = _plain(f"{type(self).__name__}.{f.name}", getattr(self, f.name), f.default, f.metadata)
                object.__setattr__(self, f.name, value)

    def source_of(self, name: str) -> str:
        """Where the value of field ``name`` comes from."""
        return self.origins.get(name) or str(type(self).__dataclass_fields__[name].metadata["source"])


def _plain(where: str, value: Any, default: Any, about: Mapping[str, Any]) -> Any:
    """Return ``value`` in the plain kind of ``default``, or say in one line what is allowed."""
    value = value.tolist() if hasattr(value, "tolist") else value  # NumPy's scalars and arrays
    if not isinstance(default, tuple):
        return _plain_item(where, value, value, type(default), about)
    kind = type(default[0])
    if not isinstance(value, list | tuple) or not value:
        raise ParameterError(f"{where} = {value!r}: must be a list of {kind.__name__} {_allowed(about)}".rstrip())
    return tuple(_plain_item(where, item, tuple(value), kind, about) for item in value)


def _plain_item(where: str, item: Any, value: Any, kind: type, about: Mapping[str, Any]) -> Any:
    """Return ``item``, which is ``value`` or one of its items, as ``kind``."""
    accepts = {int: Integral, float: Real}.get(kind, kind)
    low, high, choices = about["low"], about["high"], about["choices"]
    ok = isinstance(item, accepts) and (kind is bool or not isinstance(item, bool))
    ok = ok and (low is None or item >= low) and (high is None or item <= high)  # NaN is never ok
    if not (ok and (choices is None or item in choices)):
        raise ParameterError(f"{where} = {value!r}: must be {kind.__name__} {_allowed(about)}".rstrip())
    return kind(item) if choices is None else choices[choices.index(item)]


def _allowed(about: Mapping[str, Any]) -> str:
    if about["choices"]:
        return "one of " + ", ".join(about["choices"])
    if about["low"] is None and about["high"] is None:
        return ""
    return f"in [{about['low']}, {about['high']}] {about['unit']}"


def walk(params: Params, prefix: str = "") -> Iterator[tuple[str, Params, str]]:
    """Yield ``(path, owner, name)`` of every setting below ``params``, in the order they are declared."""
    for f in fields(params):
        value = getattr(params, f.name)
        if is_dataclass(value):
            yield from walk(typing.cast(Params, value), f"{prefix}{f.name}.")
        elif "source" in f.metadata:
            yield f"{prefix}{f.name}", params, f.name


def to_dict(params: Params) -> dict[str, Any]:
    """Return the settings as nested plain dictionaries, a list of them where there are several of a kind."""
    return {f.name: _plainly(getattr(params, f.name)) for f in fields(params) if f.name != "origins"}


def _plainly(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plainly(item) for item in value]
    return to_dict(typing.cast(Params, value)) if is_dataclass(value) else value


def with_settings(params: Params, settings: Mapping[str, Any], source: str, where: str = "") -> Any:
    """Return ``params`` with the nested ``settings`` replaced, each remembered as coming from ``source``.

    Raises
    ------
    ParameterError : a name that does not exist (the nearest one is suggested) or a value out of range
    """
    known = {f.name: f for f in fields(params) if f.name != "origins"}
    changed: dict[str, Any] = {}
    origins = dict(params.origins)
    for name, value in settings.items():
        if name not in known:
            raise ParameterError(f"unknown setting {where}{name}{nearest(name, known)}")
        current = getattr(params, name)
        if is_dataclass(current):
            if not isinstance(value, Mapping):
                first = next(f.name for f in fields(current) if f.name != "origins")
                raise ParameterError(
                    f"{where}{name} = {value!r}: is a group of settings, such as {where}{name}.{first}"
                )
            changed[name] = with_settings(typing.cast(Params, current), value, source, f"{where}{name}.")
        else:
            changed[name] = _plain(f"{where}{name}", value, known[name].default, known[name].metadata)
            origins[name] = source
    return replace(params, origins=origins, **changed)


def parse_setting(text: str) -> dict[str, Any]:
    """Turn ``lamina.dog.sigma_px=2`` into ``{"lamina": {"dog": {"sigma_px": 2}}}``.

    Raises
    ------
    ParameterError : the text is not ``path=value``
    """
    import json

    path, equals, raw = text.partition("=")
    if not equals or not path.strip() or not raw.strip():
        raise ParameterError(f"--set {text!r}: must be PATH=VALUE, such as lamina.dog.sigma_px=2")
    try:
        value = json.loads(raw)
    except json.JSONDecodeError:
        value = raw.strip()
    for name in reversed(path.strip().split(".")):
        value = {name: value}
    return typing.cast(dict[str, Any], value)


def settings_hash(params: Params) -> str:
    """Twelve hexadecimal digits that change when any value changes; stored in every output."""
    import hashlib
    import json

    return hashlib.sha256(json.dumps(to_dict(params), sort_keys=True).encode()).hexdigest()[:12]


def nearest(name: str, known: Iterable[str]) -> str:
    """Return the end of a message about an unknown ``name``: the known one nearest to it, or all of them."""
    import difflib

    known = list(known)
    longer = [other for other in known if name and other.startswith(name)]
    close = longer or difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return f": did you mean {close[0]}?" if close else f": known here are {', '.join(known)}"
