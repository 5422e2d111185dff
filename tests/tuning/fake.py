"""A task that needs no pictures: the best settings are planted, and every question is written down."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lobula.errors import ParameterError
from lobula.model.presets import preset
from lobula.tuning.plan import Budget, Plan
from lobula.tuning.space import axes
from lobula.tuning.split import Split
from lobula.tuning.tally import Objective

PLANTED = {"lgmd1.sigmoid_grey": 0.01, "lgmd2.sigmoid_grey": 0.003}
"""Best in the first objective and in the second; where one is right the other does not matter for its objective."""

VARY = ("lgmd1.sigmoid_grey=x4", "lgmd2.sigmoid_grey=x4")


@dataclass(frozen=True)
class FakeTally:
    """Sums of distances from what was planted, one for each name."""

    sums: tuple[float, ...]
    names: tuple[str, ...]

    @property
    def values(self):
        return tuple(total / len(self.names) for total in self.sums)

    @property
    def merit(self):
        return -sum(self.values)

    def as_dict(self):
        return {"names": list(self.names)}

    def __add__(self, other):
        sums = tuple(a + b for a, b in zip(self.sums, other.sums, strict=True))
        return FakeTally(sums, self.names + other.names)


@dataclass(frozen=True)
class FakeTask:
    """Names mean nothing but how far off everything is: ``off`` is added to each objective."""

    asked: Path
    splits: Mapping[str, Split]
    off: Mapping[str, float] = field(default_factory=dict)
    trouble: str = ""
    about: Mapping[str, Any] = field(default_factory=lambda: {"on": "fake", "held_out": "by hand"})
    identity: Mapping[str, Any] = field(default_factory=dict)

    @property
    def objectives(self):
        return tuple(Objective(name, "minimize", f"how far the {name} is off") for name in ("first", "second"))

    def measure(self, params, names):
        with self.asked.open("a") as file:
            file.write(f"{params.lgmd1.sigmoid_grey!r} {params.lgmd2.sigmoid_grey!r} {'+'.join(names)}\n")
        sigmoids = (params.lgmd1.sigmoid_grey, params.lgmd2.sigmoid_grey)
        if self.trouble == "refuse" or (self.trouble == "refuse some" and sigmoids[0] > 0.01):
            raise ParameterError("does not like it")
        if self.trouble == "die":
            os._exit(9)
        if self.trouble == "fault":
            raise ZeroDivisionError("bug")
        far = [abs(math.log(a / b)) for a, b in zip(sigmoids, PLANTED.values(), strict=True)]
        return FakeTally(tuple(sum(d + self.off.get(name, 0.0) for name in names) for d in far), tuple(names))

    def length_s(self, names):
        return float(len(names))


def fake_task(folder, **about):
    """One search on two things, two more held out."""
    return FakeTask(folder / "asked.txt", {"only": Split(("a", "b"), ("c", "d"))}, **about)


def folded_task(folder, **about):
    """A search over three things, and one without each of them."""
    names = ("a", "b", "c")
    folds = {f"without {x}": Split(tuple(n for n in names if n != x), (x,)) for x in names}
    return FakeTask(folder / "asked.txt", {"all": Split(names)} | folds, **about)


def plan(task, vary=VARY, **budget):
    base = preset("paper")
    return Plan(task=task, base=base, preset="paper", axes=axes(base, vary), budget=Budget(**budget))


def asked(folder):
    """What was measured, oldest first: both sigmoids and the names, as text."""
    return (folder / "asked.txt").read_text().splitlines()
