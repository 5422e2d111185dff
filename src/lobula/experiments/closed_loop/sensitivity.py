"""What the success rates hang on besides the model: wall, noise, motors, the scoring margin, the frame rate."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...arena.world import World
from ...model.presets import preset
from ...report.plots import save_figure
from ...report.rate_plot import Rate
from ...report.sensitivity_plot import plot_sensitivity
from .paper_table import LABELS
from .scan import Results, ScanPlan, Variant, made_by, rate_cells, run_scan, write
from .scan_command import command

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAME = "sensitivity"
BASE, OWN = "paper", "lobula"

HALF_RANGES_GREY = (10.0, 20.0, 30.0, 45.0, 60.0)
"""Of the wall's stripes about their mean."""
STRIPES_TIMES = (0.5, 1.0, 2.0, 4.0)
NOISES_GREY = (0.0, 1.5, 3.0, 6.0)
MOTOR_NOISES = (0.0, 0.1, 0.3)
"""Random share of each wheel's speed in each frame."""
BENDS_PER_M = (0.0, 1.0, 3.0)
"""Each robot's path ahead is bent by a constant of its own within +- this: 3 is an arc of 33 cm radius."""
MARGINS_CM = (0.0, 1.0, 2.0, 3.0)
RATES_HZ = (15.0, 30.0, 60.0)


def settings() -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield what is changed in the arena: the lever, its value in words, and the settings."""
    wall = World().wall
    middle = (wall.dark_grey + wall.light_grey) / 2
    for half in HALF_RANGES_GREY:
        greys = {"dark_grey": middle - half, "light_grey": middle + half}
        yield "stripes, +- grey levels", f"{half:g}", {"wall": greys}
    for times in STRIPES_TIMES:
        widths = {"stripe_low_cm": times * wall.stripe_low_cm, "stripe_high_cm": times * wall.stripe_high_cm}
        words = f"{times * (wall.stripe_low_cm + wall.stripe_high_cm) / 2:g}"
        yield "width of stripes, cm", words, {"wall": widths}
    for noise in NOISES_GREY:
        yield "noise, grey levels", f"{noise:g}", {"camera": {"noise_grey": noise}}
    for share in MOTOR_NOISES:
        yield "noise of the motors, share", f"{share:g}", {"robots": {"motor_noise": share}}
    for bend in BENDS_PER_M:
        yield "bend of the paths, 1/m", f"{bend:g}", {"robots": {"curvature_per_m": bend}}
    for margin in MARGINS_CM:
        yield "margin of AA, cm", f"{margin:g}", {"scoring": {"margin_cm": margin}}
    for rate in RATES_HZ:
        yield "frames a second", f"{rate:g}", {"camera": {"rate_hz": rate}}


def variants() -> list[Variant]:
    """Return the paper's three models and our own in every arena."""
    models = {label: preset(BASE, neurons=neurons) for neurons, label in LABELS.items()} | {f"ours, {OWN}": preset(OWN)}
    return [
        Variant(base=label, series=lever, value=value, params=params, world=_changed(World(), changes))
        for lever, value, changes in settings()
        for label, params in models.items()
    ]


def _changed(world: World, changes: Mapping[str, Mapping[str, Any]]) -> World:
    """Return ``world`` with its groups changed; each group is checked as a whole."""
    groups = {name: replace(getattr(world, name), **values) for name, values in changes.items()}
    return replace(world, **groups)


def make(plan: ScanPlan, folder: Path, workers: int, advance: Callable[[], None] | None = None) -> Results:
    """Run the scan and write sensitivity.csv, sensitivity.md and a drawing for each number of robots."""
    chosen = variants()
    results = run_scan(NAME, chosen, plan, folder, workers=workers, advance=advance)
    for robots in plan.densities:
        drawing = draw(robots, plan, results)
        for suffix in (".svg", ".png"):
            save_figure(drawing, folder / f"{NAME}-{robots}{suffix}")
    write(folder / f"{NAME}.md", (f"{line}\n" for line in page(plan, chosen, results)))
    return results


def draw(robots: int, plan: ScanPlan, results: Results) -> Figure:
    """Draw SR1 and SR2 against every lever, a line for each model, with Wilson intervals."""
    panels: dict[tuple[str, str], dict[str, dict[str, Rate]]] = {}
    for (variant, count), found in results.items():
        if count != robots:
            continue
        score = found.score
        for name, value, ends in (("SR1", score.sr1, score.sr1_interval), ("SR2", score.sr2, score.sr2_interval)):
            line = panels.setdefault((name, variant.series), {}).setdefault(variant.base, {})
            line[variant.value] = Rate(100 * value, 100 * ends[0], 100 * ends[1])
    runs = f"{len(plan.seeds)} calibration seeds of {plan.minutes:g} simulated minutes"
    title = f"{robots} robots, presets {BASE} and {OWN}, {runs}"
    return plot_sensitivity({key: panels[key] for key in sorted(panels, key=lambda key: key[0])}, title=title)


def page(plan: ScanPlan, chosen: Sequence[Variant], results: Results) -> Iterator[str]:
    """Yield the lines of ``sensitivity.md``."""
    yield "# What the success rates hang on"
    yield ""
    yield made_by("sensitivity", plan, chosen)
    yield ""
    yield (
        "One setting of the arena is changed at a time; the rest is that of Table I. Intervals are Wilson's of 95 %, "
        "then, from five seeds on, those of a bootstrap over the seeds."
    )
    for robots in plan.densities:
        yield ""
        yield f"## {robots} robots"
        yield ""
        yield f"![Success rates against settings, {robots} robots]({NAME}-{robots}.png)"
        yield ""
        yield "| setting | value | model | SR1 | SR2 |"
        yield "|---|--:|---|---|---|"
        for (variant, count), found in results.items():
            if count == robots:
                cells = " | ".join(rate_cells(found))
                yield f"| {variant.series} | {variant.value} | {variant.base} | {cells} |"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the scan from a command line."""

    def run(plan: ScanPlan, folder: Path, workers: int, advance: Callable[[], None]) -> None:
        make(plan, folder, workers, advance)

    return command("SR1 and SR2 against settings of the arena.", variants(), run, arguments)


if __name__ == "__main__":
    sys.exit(main())
