"""Fig. 5 of the paper: spikes during the four courses at three speeds, in windows of equal length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ...report.count_plot import Counts, plot_boxes
from ...types import NEURONS
from .conditions import chosen, each_speed
from .courses import FOUR, NAMES, READINGS, SPEED_LABELS, course, speeds_text
from .fig5_claims import CLAIMS
from .figure import EXACTLY, LESS_NOISE, NOISELESS, Other, PaperFigure, Plan, about
from .levers import LEVERS
from .setups import setup_table
from .trials import MAIN, About, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

OTHERS: dict[str, Other] = {
    "noise of 0.75 grey": Other(world=LESS_NOISE),
    "no noise": Other(world=NOISELESS),
    "placed exactly": Other(EXACTLY),
    "placed exactly, no noise": Other(EXACTLY, NOISELESS),
    "ends at 2.5 cm": Other({"near_cm": 2.5}),
    "ends at 1.5 cm": Other({"near_cm": 1.5}),
    "passes at 4 cm": Other({"pass_cm": 4.0}),
    "passes at 8 cm": Other({"pass_cm": 8.0}),
    "passes at 10 cm": Other({"pass_cm": 10.0}),
}
"""Set-ups that show how far the result hangs on what the paper does not print."""


def shots(plan: Plan) -> Iterator[About]:
    """Yield four courses at six speeds for every seed; then the other set-ups, for the first seeds only."""
    yield from _courses(plan, MAIN)
    for setup, other in OTHERS.items():
        yield from _courses(other.plan(plan), setup)


def _courses(plan: Plan, setup: str) -> Iterator[About]:
    for reading in READINGS:
        for label, speed_cm_s in zip(SPEED_LABELS, reading.speeds_cm_s, strict=True):
            for seed in plan.seeds:
                for motion in FOUR:
                    yield About(
                        figure="fig5", course=course(motion, speed_cm_s, plan.courses, plan.world.body.radius_cm),
                        p=plan.courses, world=plan.world, seed=seed, label=label, reading=reading.name, setup=setup,
                    )  # fmt: skip


def draw(plan: Plan, trials: Sequence[Trial], preset: str) -> Drawing:
    """Draw box plots: a row for each speed label, a column for each course, both readings of the label beside."""
    own = chosen(trials, preset=preset, setup=MAIN)
    panels: dict[tuple[str, str], Counts] = {
        (label, motion): {
            (n, s.reading): [t.spikes[n] for t in s.of(motion)] for s in each_speed(own, [label]) for n in NEURONS
        }
        for label in SPEED_LABELS
        for motion in FOUR
    }
    rows = {label: f"{label}: spikes in {plan.courses.window_s:g} s" for label in SPEED_LABELS}
    return plot_boxes(
        panels,
        rows=rows,
        columns={motion: NAMES[motion] for motion in FOUR},
        groups={r.name: f"speeds read as {r.meaning}: {speeds_text(r)} cm/s" for r in READINGS},
        title=about(plan, preset),
    )


def words(plan: Plan, trials: Sequence[Trial]) -> Iterator[str]:
    """Yield what the page says of the set-up, and how far the counts hang on it."""
    p = plan.courses
    yield (
        "Courses as in Fig. 4, at the three speeds of the paper's labels in both readings. The spikes are those "
        f"of {p.window_s:g} s at every speed: the last of an approach, the first of a recession, the middle of a "
        "translation. A box is the middle half of the repeats, the line the median, the whiskers reach to the "
        "extremes, each  dot is one repeat. The axis is logarithmic above 1."
    )
    yield ""
    yield "## What the claims hang on"
    yield ""
    yield (
        f"The paper prints neither distances nor most constants. Above, an approach ends {p.near_cm:g} cm before the "
        f"lens, a translating robot passes at {p.pass_cm:g} cm, all are misplaced by up to {10 * p.misplaced_cm:g} mm "
        f"from repeat to repeat, and the sensor has noise of {plan.world.camera.noise_grey:g} grey levels. K_hs is the "
        "scale of the LPTCs (smaller: more sensitive), C_sig that of the LGMDs; the dead zone, 0.0001 in both presets, "
        "is the response of the DoG's inner field below which it has no sign. Share of the trials that show each "
        f"claim, with the first {min(plan.side_seeds, len(plan.seeds))} seeds, all speeds:"
    )
    yield ""
    yield from setup_table(CLAIMS, trials, [*OTHERS, *LEVERS])


FIGURE = PaperFigure(name="fig5", title="Spikes at three speeds", shots=shots, claims=CLAIMS, draw=draw, words=words)
