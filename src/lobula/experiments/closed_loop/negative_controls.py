"""Arenas in which something is missing: no motion, light that flickers or steps, walls without a pattern."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from ...arena.world import LightParams, World
from ...intervals import garwood
from ...model.presets import BASES, preset
from .paper_table import LABELS
from .scan import Results, ScanPlan, Variant, made_by, rate_cells, run_scan, write
from .scan_command import command
from .tables import Group

NAME, OWN = "negative-controls", "lobula"

LIGHTS = {
    "steady light": LightParams(),
    "flicker": LightParams(course="flicker"),
    "slow flicker": LightParams(course="flicker", flicker_hz=2.0, flicker_amplitude=0.2),
    "light steps": LightParams(course="steps"),
}
STILL, DRIVING, PLAIN = "still robots", "driving robots", "driving robots, walls without a pattern"


def worlds() -> Iterator[tuple[str, str, World]]:
    """Yield what the robots do, the light, and the arena."""
    world = World()
    still = replace(world, robots=replace(world.robots, speed_low_cm_s=0.0, speed_high_cm_s=0.0))
    plain = replace(world, wall=replace(world.wall, pattern="plain"))
    for light, course in LIGHTS.items():
        yield STILL, light, replace(still, light=course)
    for light, course in LIGHTS.items():
        yield DRIVING, light, replace(world, light=course)
    yield PLAIN, "steady light", plain


def variants() -> list[Variant]:
    """Return the paper's three models on both base presets, and our own, in every arena."""
    models = {f"{base}: {label}": preset(base, neurons=n) for base in BASES for n, label in LABELS.items()}
    models |= {f"ours, {OWN}": preset(OWN)}
    return [
        Variant(base=name, series=what, value=light, params=params, world=world)
        for what, light, world in worlds()
        for name, params in models.items()
    ]


def make(plan: ScanPlan, folder: Path, workers: int, advance: Callable[[], None] | None = None) -> Results:
    """Run the controls and write negative-controls.csv and negative-controls.md."""
    chosen = variants()
    results = run_scan(NAME, chosen, plan, folder, workers=workers, advance=advance)
    write(folder / f"{NAME}.md", (f"{line}\n" for line in page(plan, chosen, results)))
    return results


def page(plan: ScanPlan, chosen: Sequence[Variant], results: Results) -> Iterator[str]:
    """Yield the lines of ``negative-controls.md``."""
    yield "# Where there is nothing to avoid, and where there is nothing to see"
    yield ""
    yield made_by("negative_controls", plan, chosen)
    yield ""
    yield (
        "*Turns* are alarms that made a robot turn, per minute of one robot, with an exact Poisson interval of 95 %. "
        "Robots that stand still have nothing to avoid: what turns them is noise, light, or the turns of others. Walls "
        "without a pattern are avoided by their edges alone."
    )
    for robots in plan.densities:
        yield ""
        yield f"## {robots} robots"
        yield ""
        yield "| robots and walls | light | model | turns | of nothing near | SR1 | SR2 |"
        yield "|---|---|---|---|--:|---|---|"
        for (variant, count), found in results.items():
            if count == robots:
                cells = " | ".join(rate_cells(found))
                yield (
                    f"| {variant.series} | {variant.value} | {variant.base} | {turns_text(found)} "
                    f"| {found.score.spurious} | {cells} |"
                )


def turns_text(found: Group) -> str:
    """Return the alarms per robot-minute with their interval."""
    score = found.score
    turns = score.aa + score.at + score.ap + score.spurious
    low, high = (end / score.robot_minutes for end in garwood(turns))
    return f"{turns / score.robot_minutes:.2f} ({low:.2f} to {high:.2f})"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the controls from a command line."""

    def run(plan: ScanPlan, folder: Path, workers: int, advance: Callable[[], None]) -> None:
        make(plan, folder, workers, advance)

    return command("Arenas in which something is missing.", variants(), run, arguments)


if __name__ == "__main__":
    sys.exit(main())
