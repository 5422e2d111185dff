"""What the paper says of its Fig. 5, and what is counted as seeing it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from ...report.palette import LABELS
from ...types import NEURONS, Neuron
from .claims import Claim, Finding, finding
from .conditions import each_speed
from .counts import against_text, mean_text, share_text, spikes_text
from .courses import FOUR, NAMES, READINGS, SPEED_LABELS, Motion
from .trials import Trial

MUCH = 2.0
"""Much higher is at least this many times as high."""
SILENT_SHARE = 0.1
"""Inhibited are LPTCs that spike at most this share of the busier LGMD."""
FREQUENT = 4
"""Spikes of each LGMD within 200 ms that are a high frequency: what a collision takes."""
LGMDS: tuple[Neuron, ...] = ("lgmd1", "lgmd2")
PREFERRED: dict[Motion, Neuron] = {"translation_right": "lptc_r", "translation_left": "lptc_l"}


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
