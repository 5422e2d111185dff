"""Avoidances of translating robots against contacts with robots, for other constants and rules of the same wiring.

A model that turns for everything has many AT and few CR; one that its LPTCs hold back has it the other way round. Each
lever moves along such a curve; what is wanted lies to its lower left.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model.network import NetworkParams
from ...model.presets import BASES, preset
from ...params import with_settings
from ...report.plots import save_figure
from ...report.trade_plot import plot_trade
from .scan import Results, ScanPlan, Variant, made_by, rate_cells, run_scan, write
from .scan_command import command
from .table_plots import trade_point
from .tables import Group

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAME = "trade-off"

WHO = {"lgmd2": "LGMD-2 alone", "lgmds": "the LGMD pair"}
C_SIG_TIMES = (1.0, 1.5, 2.0, 3.0)
K_HS_TIMES = (0.3, 1.0, 3.0, 10.0)
PATCHES_TIMES: Mapping[str, Sequence[float]] = {
    "coarse_gain": (0.0, 0.5, 1.0, 2.0),
    "coarse_on_weight": (0.0, 0.5, 1.0, 2.0),
}
"""Of our own preset: how loud the coarse patches are, and what brightening takes off."""
LIMITS_GREY = (25.0, 35.0, 50.0, 70.0, 100.0)
"""Of its saturation."""
DECISIONS: Mapping[str, Sequence[float]] = {
    "lptc_weight": (0.0, 0.5, 1.0, 2.0, 4.0),
    "window_ms": (100.0, 200.0, 333.0, 500.0),
    "collision_spikes": (2, 4, 6, 8),
}
"""Settings of the decision and the values tried; those of a preset are among them."""
OWN = "lobula"
BASES_AND_OWN = (*BASES, OWN)


def variants() -> list[Variant]:
    """Return all levers at all their values, on both base presets and on our own."""
    of_bases = [variant for base in BASES for variant in _of_base(base, preset(base))]
    return [*of_bases, *_of_own(preset(OWN))]


def _of_base(base: str, params: NetworkParams) -> Iterator[Variant]:
    for neurons, words in WHO.items():
        yield _changed(base, params, words, "", {"decision": {"neurons": neurons}})
    yield from _sigmoids(base, params)
    for times in K_HS_TIMES:
        scale = {"lptc": {"sigmoid_grey2": times * params.lptc.sigmoid_grey2}}
        yield _changed(base, params, "K_hs", f"x{times:g}", scale)
    for name, values in DECISIONS.items():
        for value in values:
            yield _changed(base, params, name, f"{value:g}", {"decision": {name: value}})


def _of_own(params: NetworkParams) -> Iterator[Variant]:
    yield from _sigmoids(OWN, params)
    for name, factors in PATCHES_TIMES.items():
        for times in factors:
            changed = {"lgmd2": {name: times * getattr(params.lgmd2, name)}}
            yield _changed(OWN, params, name, f"x{times:g}", changed)
    for limit in LIMITS_GREY:
        yield _changed(OWN, params, "saturation", f"{limit:g} grey", {"saturation": {"limit_grey": limit}})
    yield _changed(OWN, params, "saturation", "none", {"saturation": {"enabled": False}})
    for value in DECISIONS["collision_spikes"]:
        yield _changed(OWN, params, "collision_spikes", f"{value:g}", {"decision": {"collision_spikes": value}})


def _sigmoids(base: str, params: NetworkParams) -> Iterator[Variant]:
    for times in C_SIG_TIMES:
        sigmoid = {n: {"sigmoid_grey": times * getattr(params, n).sigmoid_grey} for n in ("lgmd1", "lgmd2")}
        yield _changed(base, params, "C_sig", f"x{times:g}", sigmoid)


def _changed(base: str, params: NetworkParams, series: str, value: str, settings: Mapping[str, Any]) -> Variant:
    return Variant(base=base, series=series, value=value, params=with_settings(params, settings, "trade-off"))


def make(plan: ScanPlan, folder: Path, workers: int, advance: Callable[[], None] | None = None) -> Results:
    """Run the scan and write trade-off.csv, trade-off.md and a drawing for each base preset."""
    chosen = variants()
    results = run_scan(NAME, chosen, plan, folder, workers=workers, advance=advance)
    for base in BASES_AND_OWN:
        drawing = draw(base, plan, results)
        for suffix in (".svg", ".png"):
            save_figure(drawing, folder / f"{NAME}-{base}{suffix}")
    write(folder / f"{NAME}.md", (f"{line}\n" for line in page(plan, chosen, results)))
    return results


def draw(base: str, plan: ScanPlan, results: Results) -> Figure:
    """Draw AT against CR, a line for each lever, for one base preset."""
    panels: dict[str, dict[str, list[Any]]] = {f"{robots} robots": {} for robots in plan.densities}
    for (variant, robots), found in results.items():
        if variant.base == base:
            points = panels[f"{robots} robots"].setdefault(variant.series, [])
            points.append(trade_point(found.score, variant.value))
    title = f"preset {base}, {len(plan.seeds)} calibration seeds of {plan.minutes:g} simulated minutes"
    return plot_trade(panels, x="CR per robot-hour", y="AT per robot-hour", title=title)


def page(plan: ScanPlan, chosen: Sequence[Variant], results: Results) -> Iterator[str]:
    """Yield the lines of ``trade-off.md``."""
    yield "# Avoiding too much against touching"
    yield ""
    yield made_by("trade_off", plan, chosen)
    yield ""
    yield (
        "AT and CR are per robot-hour. A variant is on the *front* if no other one of the same table has fewer of one "
        "and not more of the other. All else is as the preset has it; `lptc_weight` 0 is the LGMD pair, `coarse_gain` "
        "times 0 our own preset without its patches. Intervals "
        "of the rates are Wilson's of 95 %, then, from five seeds on, those of a bootstrap over the seeds."
    )
    for base in BASES_AND_OWN:
        yield ""
        yield f"## Preset `{base}`"
        yield ""
        yield f"![AT against CR, preset {base}]({NAME}-{base}.png)"
        for robots in plan.densities:
            own = [(v, found) for (v, count), found in results.items() if (v.base, count) == (base, robots)]
            yield ""
            yield f"### {robots} robots"
            yield ""
            yield "| lever | value | AT | CR | front | SR1 | SR2 |"
            yield "|---|--:|--:|--:|---|---|---|"
            best = front([found for _, found in own])
            for (variant, found), on_front in zip(own, best, strict=True):
                at, cr = _per_hour(found)
                cells = " | ".join(rate_cells(found))
                mark = "yes" if on_front else ""
                yield f"| {variant.series} | {variant.value} | {at:.1f} | {cr:.1f} | {mark} | {cells} |"


def front(groups: Sequence[Group]) -> list[bool]:
    """Return which of ``groups`` no other one beats in AT and CR per robot-hour at once."""
    points = [_per_hour(found) for found in groups]
    return [not any(at <= a and cr <= c and (at, cr) != (a, c) for at, cr in points) for a, c in points]


def _per_hour(found: Group) -> tuple[float, float]:
    score = found.score
    hours = score.robot_minutes / 60
    return score.at / hours, score.cr / hours


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the scan from a command line."""

    def run(plan: ScanPlan, folder: Path, workers: int, advance: Callable[[], None]) -> None:
        make(plan, folder, workers, advance)

    return command("AT against CR for other constants and rules.", variants(), run, arguments)


if __name__ == "__main__":
    sys.exit(main())
