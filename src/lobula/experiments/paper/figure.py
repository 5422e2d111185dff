"""What every figure of the open-loop tests has in common: its trials, its claims, its picture and its words."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from ...arena.world import World
from ...engine.network import Network
from ...model.network import NetworkParams
from ...params import settings_hash, with_settings
from .claims import Claim
from .courses import CourseParams
from .levers import pulled
from .stage import Stage
from .trials import MAIN, About, Trial, trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing


SEEDS, SIDE_SEEDS = 10, 5
QUICK_SEEDS, QUICK_SIDE_SEEDS = 2, 1
PRESETS = ("paper", "published")


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is run: the presets by name, the seeds, the arena and the courses.

    ``side_seeds`` of the seeds also run the set-ups that are there for comparison.
    """

    presets: Mapping[str, NetworkParams]
    seeds: Sequence[int]
    side_seeds: int = SIDE_SEEDS
    world: World = field(default_factory=World)
    courses: CourseParams = field(default_factory=CourseParams)

    def command(self, name: str) -> str:
        """Return what makes the figure ``name`` so, as it is typed."""
        words, usual = ["lobula", "reproduce", name, "--out", "DIR"], SEEDS
        if self.side_seeds == QUICK_SIDE_SEEDS:
            words, usual = [*words, "--quick"], QUICK_SEEDS
        if len(self.seeds) != usual:
            words += ["--seeds", str(len(self.seeds))]
        if tuple(self.presets) != PRESETS:
            words += ["--preset", *self.presets]
        return " ".join(words)


@dataclass(frozen=True, kw_only=True)
class PaperFigure:
    """One figure of the paper.

    ``shots`` lists what is filmed, ``claims`` what the paper says of it, ``draw`` draws it for one preset, and
    ``words`` yields what its page says besides the claims; ``levers`` says whether other constants are compared.
    """

    name: str
    title: str
    shots: Callable[[Plan], Iterator[About]]
    claims: Sequence[Claim]
    draw: Callable[[Plan, Sequence[Trial], str], Drawing]
    words: Callable[[Plan, Sequence[Trial]], Iterator[str]]
    levers: bool = True


EXACTLY: Mapping[str, Any] = {"misplaced_cm": 0.0}
NOISELESS: Mapping[str, Any] = {"camera": {"noise_grey": 0.0}}
LESS_NOISE: Mapping[str, Any] = {"camera": {"noise_grey": 0.75}}


class Other(NamedTuple):
    """Another way to set up the robots: settings of the courses and of the arena that differ from the plan's."""

    courses: Mapping[str, Any] = MappingProxyType({})
    world: Mapping[str, Any] = MappingProxyType({})

    def plan(self, plan: Plan) -> Plan:
        """Return ``plan`` with these settings, for its first ``side_seeds`` seeds."""
        source = "to see what hangs on it"
        return replace(
            plan,
            seeds=plan.seeds[: plan.side_seeds],
            courses=with_settings(plan.courses, self.courses, source),
            world=with_settings(plan.world, self.world, source),
        )


def run(figure: PaperFigure, plan: Plan, advance: Callable[[], None] | None = None) -> list[Trial]:
    """Film every course of ``figure`` once and show it to every preset; ``advance`` is called after each film.

    The first ``side_seeds`` seeds of the main set-up are shown to the presets with other constants too.
    """
    trials: list[Trial] = []
    stages: dict[str, Stage] = {}
    networks = {name: Network(params) for name, params in plan.presets.items()}
    others = [(change, name, Network(params)) for change, name, params in pulled(plan.presets)]
    for about in figure.shots(plan):
        stage = stages.setdefault(settings_hash(about.world), Stage(about.world))
        film = stage.film(about.course, about.p, about.seed)
        trials += [trial(about, film, name, network) for name, network in networks.items()]
        if figure.levers and about.setup == MAIN and about.seed in plan.seeds[: plan.side_seeds]:
            trials += [trial(replace(about, setup=change), film, name, network) for change, name, network in others]
        if advance is not None:
            advance()
    return trials


def about(plan: Plan, preset: str) -> str:
    """Return the line that stands over a drawing: which settings, how many repeats."""
    return f"preset {preset}, settings {settings_hash(plan.presets[preset])}, {len(plan.seeds)} repeats"
