"""An event in a few words, for logs that people read."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_WORDS = ("type", "hook", "id", "state", "phase", "status")


def said(record: Mapping[str, Any]) -> str:
    """Return an event or the summary as text, such as ``collision 1 start`` or ``source lost: no answer``."""
    words = " ".join(str(record[key]) for key in _WORDS if record.get(key)).replace("_", " ")
    why = record.get("reason") or record.get("problem")
    return f"{words}: {why}" if why else words


def warns(record: Mapping[str, Any]) -> bool:
    """Whether it is a collision that starts or a source that is lost."""
    return (record["type"], record.get("phase")) in (("collision", "start"), ("source", "lost"))
