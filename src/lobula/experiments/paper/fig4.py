"""Fig. 4 of the paper: four membrane potentials while a robot approaches, recedes and passes by either way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ...engine.network import Network
from ...report.course_plot import CourseColumn, plot_courses
from ...runtime.header import thresholds
from ...types import Neuron
from .claims import Claim, Finding, finding
from .conditions import chosen
from .counts import against_text, mean_text, peaks_text
from .courses import FOUR, NAMES, READINGS, SPEED_LABELS, Motion, course
from .figure import PaperFigure, Plan, about
from .stage import Film, Stage
from .trials import About, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

READING, LABEL, SPEED_CM_S = READINGS[0].name, SPEED_LABELS[1], READINGS[0].speeds_cm_s[1]
"""The paper does not say at which speed its example was taken: the middle one."""
BRIEF_S = 1.0
"""A burst within this long is brief."""
SHOWN: dict[Motion, tuple[float, ...]] = {
    "approach": (0.0, 0.8, 1.0),
    "recession": (0.0, 0.2, 1.0),
    "translation_right": (0.3, 0.5, 0.6),
    "translation_left": (0.3, 0.5, 0.6),
}
"""Which pictures are shown: shares of the time of motion."""
LGMDS: tuple[Neuron, ...] = ("lgmd1", "lgmd2")
LPTCS: tuple[Neuron, ...] = ("lptc_r", "lptc_l")


def shots(plan: Plan) -> Iterator[About]:
    """Yield the four courses at the middle speed, for every seed."""
    for seed in plan.seeds:
        for motion in FOUR:
            drive = course(motion, SPEED_CM_S, plan.courses, plan.world.body.radius_cm)
            yield About(
                figure="fig4", course=drive, p=plan.courses, world=plan.world, seed=seed, label=LABEL, reading=READING
            )


def _strongest(trials: Sequence[Trial]) -> Iterator[Finding]:
    approaches = chosen(trials, motion="approach")
    for motion in FOUR[1:]:
        others = chosen(trials, motion=motion)
        seen = [all(a.peak[n] > b.peak[n] for n in LGMDS) for a, b in zip(approaches, others, strict=True)]
        tell = partial(against_text, peaks_text, approaches, others, LGMDS)
        yield finding(f"against {NAMES[motion]}", seen, tell)


def _brief(trials: Sequence[Trial]) -> Iterator[Finding]:
    receding = chosen(trials, motion="recession")
    seen = [t.spikes_course["lgmd1"] > 0 and t.burst_s["lgmd1"] <= BRIEF_S for t in receding]
    yield finding("recession", seen, partial(_burst_text, receding))


def _burst_text(trials: Sequence[Trial]) -> str:
    spikes = mean_text(t.spikes_course["lgmd1"] for t in trials)
    return f"{spikes} spikes within {mean_text((t.burst_s['lgmd1'] for t in trials), 2)} s"


def _suppressed(trials: Sequence[Trial]) -> Iterator[Finding]:
    receding = chosen(trials, motion="recession")
    yield finding(
        "recession", [t.spikes_course["lgmd2"] == 0 for t in receding], partial(peaks_text, receding, ["lgmd2"])
    )


def _quiet(trials: Sequence[Trial]) -> Iterator[Finding]:
    for motion in FOUR[:2]:
        found = chosen(trials, motion=motion)
        seen = [t.spikes_course["lptc_r"] == t.spikes_course["lptc_l"] == 0 for t in found]
        yield finding(NAMES[motion], seen, partial(peaks_text, found, LPTCS))


def _one_sided(trials: Sequence[Trial], motion: Motion, own: Neuron, other: Neuron) -> Iterator[Finding]:
    found = chosen(trials, motion=motion)
    seen = [t.spikes_course[own] > 0 and t.spikes_course[other] == 0 for t in found]
    yield finding(NAMES[motion], seen, partial(peaks_text, found, LPTCS))


def _activated(trials: Sequence[Trial]) -> Iterator[Finding]:
    for motion in FOUR[2:]:
        found = chosen(trials, motion=motion)
        seen = [min(t.spikes_course[n] for n in LGMDS) > 0 for t in found]
        yield finding(NAMES[motion], seen, partial(peaks_text, found, LGMDS))


CLAIMS = (
    Claim(
        number="4.1",
        paper="Both LGMDs respond most strongly to the frontal approach.",
        rule="the potential of both peaks higher at the approach than in the other course",
        judge=_strongest,
    ),
    Claim(
        number="4.2",
        paper="LGMD-1 responds briefly to the recession.",
        rule=f"LGMD-1 crosses its threshold, and all its spikes lie within {BRIEF_S:g} s",
        judge=_brief,
    ),
    Claim(
        number="4.3",
        paper="LGMD-2 is rigorously suppressed by the recession.",
        rule="LGMD-2 never crosses its threshold",
        judge=_suppressed,
    ),
    Claim(
        number="4.4",
        paper="The LPTCs are quiet to movements in depth.",
        rule="neither LPTC ever crosses its threshold",
        judge=_quiet,
    ),
    Claim(
        number="4.5",
        paper="LPTC-R responds to rightward translation, positively.",
        rule="LPTC-R crosses its threshold and LPTC-L never does",
        judge=lambda trials: _one_sided(trials, "translation_right", "lptc_r", "lptc_l"),
    ),
    Claim(
        number="4.6",
        paper="LPTC-L responds to leftward translation, negatively.",
        rule="LPTC-L crosses its threshold and LPTC-R never does",
        judge=lambda trials: _one_sided(trials, "translation_left", "lptc_l", "lptc_r"),
    ),
    Claim(
        number="4.7",
        paper="The LGMDs are also activated by nearby translation in either direction.",
        rule="both LGMDs cross their thresholds",
        judge=_activated,
    ),
)


def draw(plan: Plan, trials: Sequence[Trial], preset: str) -> Drawing:
    """Draw the four courses: what was seen with the first seed, and the potentials with all seeds."""
    params, stage = plan.presets[preset], Stage(plan.world)
    network = Network(params)
    columns = []
    for motion in FOUR:
        drive = course(motion, SPEED_CM_S, plan.courses, plan.world.body.radius_cm)
        films = [stage.film(drive, plan.courses, seed) for seed in plan.seeds]
        columns.append(
            CourseColumn(
                title=NAMES[motion],
                images=films[0].images,
                traces=[_trace(network, film) for film in films],
                shown_s=[plan.courses.lead_s + share * drive.travel_s for share in SHOWN[motion]],
                moving_s=(plan.courses.lead_s, plan.courses.lead_s + drive.travel_s),
            )
        )
    return plot_courses(columns, thresholds(params), about(plan, preset))


def _trace(network: Network, film: Film) -> NDArray[Any]:
    network.reset()
    return network.run(film.images, film.times_s)


def words(plan: Plan, trials: Sequence[Trial]) -> Iterator[str]:
    """Yield what the page says of the set-up."""
    p = plan.courses
    yield (
        f"A still robot sees another one at {SPEED_CM_S:g} cm/s ({LABEL}, read as {READINGS[0].meaning}): it comes "
        f"from {p.far_cm:g} to {p.near_cm:g} cm before the lens, goes the same way back, or passes {p.pass_cm:g} "
        "cm away. Thick lines are the first seed, thin ones the others; dashed are the thresholds; grey is the "
        "time of motion."
    )


FIGURE = PaperFigure(
    name="fig4",
    title="Membrane potentials for four motions",
    shots=shots,
    claims=CLAIMS,
    draw=draw,
    words=words,
    levers=False,
)
