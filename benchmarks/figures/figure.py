"""One figure: a number, what it must be and what it aims at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal


@dataclass(frozen=True)
class Figure:
    """``value`` in ``unit`` against ``must`` and ``aim``; both None where a number is only told beside the others.

    ``size`` is the working size, where the details hold times at one.
    """

    name: str
    value: float
    unit: str
    must: float | None = None
    aim: float | None = None
    better: Literal["more", "less"] = "more"
    details: Mapping[str, Any] = field(default_factory=dict)
    size: str = ""

    def reaches(self, limit: float | None) -> bool | None:
        """Whether the value is at least as good as ``limit``; None where there is none."""
        if limit is None:
            return None
        return self.value >= limit if self.better == "more" else self.value <= limit

    def as_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "name": self.name, "size": self.size, "value": round(self.value, 4), "unit": self.unit,
            "better": self.better, "must": self.must, "aim": self.aim, "must_reached": self.reaches(self.must),
            "aim_reached": self.reaches(self.aim), "details": dict(self.details),
        }  # fmt: skip
