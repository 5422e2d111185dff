"""Fig. 5 of the paper: spikes during the four courses at three speeds, in windows of equal length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from ...report.count_plot import Counts, plot_boxes
from ...report.palette import LABELS
from ...types import NEURONS, Neuron
from .claims import Claim, Finding, finding
from .conditions import chosen, each_speed
from .counts import against_text, mean_text, share_text, spikes_text
from .courses import FOUR, NAMES, READINGS, SPEED_LABELS, Motion, course, speeds_text
from .figure import EXACTLY, LESS_NOISE, NOISELESS, Other, PaperFigure, Plan, about
from .levers import LEVERS
from .setups import setup_table
from .trials import MAIN, About, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

MUCH = 2.0
"""Much higher is at least this many times as high."""
SILENT_SHARE = 0.1
"""Inhibited are LPTCs that spike at most this share of the busier LGMD."""
FREQUENT = 4
"""Spikes of each LGMD within 200 ms that are a high frequency: what a collision takes."""
LGMDS: tuple[Neuron, ...] = ("lgmd1", "lgmd2")
PREFERRED: dict[Motion, Neuron] = {"translation_right": "lptc_r", "translation_left": "lptc_l"}

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


def _lptcs_far_above(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        for motion, own in PREFERRED.items():
            found = speed.of(motion)
            seen = [t.spikes[own] > 0 and t.spikes[own] >= MUCH * t.count("busier") for t in found]
            yield finding(f"{NAMES[motion]}, {speed.text}", seen, partial(spikes_text, found, (own, *LGMDS)))


def _lptcs_inhibited(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        for motion in FOUR[:2]:
            found = speed.of(motion)
            seen = [t.count("lptcs") <= SILENT_SHARE * t.count("busier") for t in found]
            yield finding(f"{NAMES[motion]}, {speed.text}", seen, partial(spikes_text, found, NEURONS))


def _frequent(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials, SPEED_LABELS[1:]):
        for motion in ("approach", *PREFERRED):
            found = speed.of(motion)
            seen = [min(t.fastest[n] for n in LGMDS) >= FREQUENT for t in found]
            yield finding(f"{NAMES[motion]}, {speed.text}", seen, partial(spikes_text, found, LGMDS))


def _more_when_faster(trials: Sequence[Trial]) -> Iterator[Finding]:
    speeds = {(s.reading, s.label): s for s in each_speed(trials)}
    for reading in READINGS:
        slow, fast = (speeds[reading.name, SPEED_LABELS[i]] for i in (0, -1))
        for motion in ("approach", *PREFERRED):
            before, after = slow.of(motion), fast.of(motion)
            seen = [all(b.spikes[n] > a.spikes[n] for n in LGMDS) for a, b in zip(before, after, strict=True)]
            tell = partial(against_text, spikes_text, after, before, LGMDS)
            yield finding(f"{NAMES[motion]}, {fast.text} against {slow.text}", seen, tell)


def _most_for_approach(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        approaches = speed.of("approach")
        for motion in FOUR[1:]:
            others = speed.of(motion)
            seen = [all(a.spikes[n] > b.spikes[n] for n in LGMDS) for a, b in zip(approaches, others, strict=True)]
            tell = partial(against_text, spikes_text, approaches, others, LGMDS)
            yield finding(f"against {NAMES[motion]}, {speed.text}", seen, tell)


def _fastest_for_approach(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        approaches = [min(t.fastest[n] for n in LGMDS) for t in speed.of("approach")]
        for motion in FOUR[1:]:
            others = [min(t.fastest[n] for n in LGMDS) for t in speed.of(motion)]
            seen = [a > b for a, b in zip(approaches, others, strict=True)]
            tell = partial(_rates_text, approaches, others)
            yield finding(f"against {NAMES[motion]}, {speed.text}", seen, tell)


def _rates_text(ours: Sequence[int], others: Sequence[int]) -> str:
    return f"{mean_text(ours)} in 200 ms, against {mean_text(others)}"


def _lgmd1_alone(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        found = speed.of("recession")
        seen = [t.spikes["lgmd1"] > 0 and t.spikes["lgmd2"] == t.count("lptcs") == 0 for t in found]
        yield finding(f"recession, {speed.text}", seen, partial(spikes_text, found, NEURONS))


def _same_pattern(trials: Sequence[Trial]) -> Iterator[Finding]:
    for reading in READINGS:
        speeds = [s for s in each_speed(trials) if s.reading == reading.name]
        for motion in FOUR:
            patterns = [[_pattern(t) for t in speed.of(motion)] for speed in speeds]
            seen = [len(set(of_seed)) == 1 for of_seed in zip(*patterns, strict=True)]
            tell = partial(_patterns_text, [speed.label for speed in speeds], patterns)
            yield finding(f"{NAMES[motion]}, {reading.name}", seen, tell)


def _pattern(t: Trial) -> str:
    """Whether the LGMDs or the LPTCs spike more, and which of the LGMDs are active."""
    if max(t.spikes.values()) == 0:
        return "silence"
    leader = "LPTCs lead" if t.count("lptcs") > t.count("busier") else "LGMDs lead"
    active = [LABELS[n] for n in LGMDS if t.spikes[n] > SILENT_SHARE * t.count("busier")]
    return f"{leader}, {' and '.join(active) or 'no LGMD'} active"


def _patterns_text(labels: Sequence[str], patterns: Sequence[Sequence[str]]) -> str:
    """The most frequent pattern at each speed."""
    common = (max(sorted(set(of_speed)), key=of_speed.count) for of_speed in patterns)
    return "; ".join(f"{label} {pattern}" for label, pattern in zip(labels, common, strict=True))


def _recession_excluded(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        found = speed.of("recession")
        seen = [t.lgmds_alarm_s is None for t in found]
        yield finding(f"recession, {speed.text}", seen, partial(_lgmd1_text, found))


def _lgmd1_text(trials: Sequence[Trial]) -> str:
    enough = sum(t.fastest["lgmd1"] >= FREQUENT for t in trials)
    return f"LGMD-1 by itself gives the {FREQUENT} spikes of a collision in {enough} of {len(trials)}"


def _competition(trials: Sequence[Trial]) -> Iterator[Finding]:
    for speed in each_speed(trials):
        for motion in ("approach", *PREFERRED):
            found = speed.of(motion)
            if motion == "approach":
                seen = [t.alarm_s is not None and t.alarm_s <= t.end_s for t in found]
            else:
                seen = [t.alarm_s is None for t in found]
            yield finding(f"{NAMES[motion]}, {speed.text}", seen, partial(_alarms_text, found))


def _alarms_text(trials: Sequence[Trial]) -> str:
    pair, all_four = (
        share_text(sum(getattr(t, name) is not None for t in trials), len(trials))
        for name in ("lgmds_alarm_s", "alarm_s")
    )
    return f"a collision for the LGMD pair in {pair}, for all four in {all_four}"


CLAIMS = (
    Claim(
        number="5.1",
        paper="At translation the LPTCs spike at a much higher rate than the LGMDs, at every speed.",
        rule=f"the LPTC of that direction spikes at least {MUCH:g} times as often as the busier LGMD",
        judge=_lptcs_far_above,
    ),
    Claim(
        number="5.2",
        paper="The LPTCs are rigorously inhibited by approach and recession.",
        rule=f"both together spike at most {100 * SILENT_SHARE:.0f} % as often as the busier LGMD",
        judge=_lptcs_inhibited,
    ),
    Claim(
        number="5.3",
        paper="The LGMDs spike at high frequency for the faster approaches and nearby translations.",
        rule=f"each LGMD gives at least {FREQUENT} spikes within 200 ms, at s80 and s120",
        judge=_frequent,
    ),
    Claim(
        number="5.4",
        paper="The LGMDs spike more when approach and translation are faster.",
        rule="each LGMD spikes more at s120 than at s40, with the same seed",
        judge=_more_when_faster,
    ),
    Claim(
        number="5.5",
        paper="The LGMDs respond most strongly to the approach.",
        rule="each LGMD spikes more at the approach than in the other course, with the same seed",
        judge=_most_for_approach,
    ),
    Claim(
        number="5.6",
        paper="The same, as a rate: the LGMDs respond most strongly to the approach.",
        rule=(
            "the slower of the two LGMDs spikes more in its fastest 200 ms than it does in the other course, with the "
            "same seed"
        ),
        judge=_fastest_for_approach,
    ),
    Claim(
        number="5.7",
        paper="Only LGMD-1 spikes at recession.",
        rule="LGMD-1 spikes, no other neuron does, not once",
        judge=_lgmd1_alone,
    ),
    Claim(
        number="5.8",
        paper="The four neurons behave consistently at all speeds.",
        rule=(
            "either the LPTCs or the LGMDs spike more at all three speeds, and the same LGMDs are active, with the "
            f"same seed; an LGMD below {100 * SILENT_SHARE:.0f} % of the other counts as silent"
        ),
        judge=_same_pattern,
    ),
    Claim(
        number="5.9",
        paper="The coordination of LGMD-1 and LGMD-2 excludes recession.",
        rule="the LGMD pair calls no collision",
        judge=_recession_excluded,
    ),
    Claim(
        number="5.10",
        paper="The competition with the LPTCs suppresses translation and leaves the frontal approach.",
        rule="all four neurons call a collision before the approach ends, and none at translation",
        judge=_competition,
    ),
)


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
