"""docs/selectivity.md and its pictures, made anew: ``python -m lobula.experiments.selectivity docs``.

What the synthetic battery shows of both base presets: claims, spikes, frame rates and ablations; and at what our own
preset alarms beside them. Only synthetic frames are drawn.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..engine.network import Network
from ..model.presets import BASES, preset
from ..report.plots import Scene, plot_scenes, save_figure
from ..stimuli import Movie, looming, receding, translating
from ..stimuli.battery import Case, battery
from .ablations import Cost, ablate
from .battery import RateChange, Scored, own_rate_changes, rate_changes, score
from .outcome import first_alarm

OWN = "lobula"
RATES_HZ = (15.0, 60.0, 120.0)
MOTIONS = {
    "looming": "approach", "angular": "approach from the side", "receding": "recession", "translating": "passing",
}  # fmt: skip
GROUPS = ("looming", "receding", "translating", "still", "noise", "flicker", "flash")
SPEEDS_CM_S = (4.0, 8.0, 12.0)


def main() -> None:
    """Write the page and its picture below the folder given on the command line."""
    parser = argparse.ArgumentParser(prog="python -m lobula.experiments.selectivity", description=__doc__)
    parser.add_argument("folder", type=Path, help="where selectivity.md and images/selectivity.png go")
    folder: Path = parser.parse_args().folder
    (folder / "images").mkdir(parents=True, exist_ok=True)
    draw(folder / "images" / "selectivity.png")
    (folder / "selectivity.md").write_text("\n".join(page()) + "\n", encoding="utf-8")


def draw(path: Path) -> None:
    """Draw the four motions of the paper's Fig. 4 with the default preset."""
    movies = {
        "approach": looming(scene="arena"),
        "recession": receding(scene="arena"),
        "passing rightward": translating(scene="arena", distance_cm=6.0),
        "passing leftward": translating(scene="arena", distance_cm=6.0, direction="left"),
    }
    save_figure(plot_scenes([_scene(title, movie) for title, movie in movies.items()]), path)


def _scene(title: str, movie: Movie) -> Scene:
    return Scene(title, list(movie.frames()), Network().run(movie.images, movie.times_s))


def page() -> Iterator[str]:
    """Yield the lines of the page."""
    yield "# What it answers to, and what it does not"
    yield ""
    yield "Made by `python -m lobula.experiments.selectivity docs`: every number below is measured by that command, on"
    yield "synthetic movies whose answer is known (`lobula.stimuli.battery`)."
    yield ""
    yield "![Membrane potentials and spikes for approach, recession and passing objects](images/selectivity.png)"
    scored = {name: score(preset(name)) for name in BASES}
    yield from _claims(scored)
    yield from _alarms()
    yield from _spikes(scored["paper"])
    yield from _rates(
        {name: list(rate_changes(preset(name), RATES_HZ)) for name in BASES}
        | {OWN: list(own_rate_changes(preset(OWN), RATES_HZ))}
    )
    yield from _ablations(ablate(preset("paper")))


def _claims(scored: dict[str, list[Scored]]) -> Iterator[str]:
    yield from ("", "## Claim by claim", "")
    yield "Movies on which the claim holds, of those it is made for. Approach and recession are claims on dark objects"
    yield "where LGMD-2 or a collision is concerned: a bright object that recedes darkens its edges and looks, to"
    yield "LGMD-2, like a dark one that approaches. LPTCs are silent below a tenth of the spikes of the busier LGMD."
    yield ""
    yield f"| movies | claim | {' | '.join(scored)} |"
    yield f"|---|---|{'--:|' * len(scored)}"
    tallies = {name: _tally(results) for name, results in scored.items()}
    for (group, claim), (_, total) in tallies["paper"].items():
        row = " | ".join(f"{tally[group, claim][0]}/{total}" for tally in tallies.values())
        yield f"| {group} | {claim} | {row} |"
    yield ""
    for name, results in scored.items():
        failing = [s for s in results if not all(c.holds for c in s.checks)]
        yield f"`{name}` fails a claim on {len(failing)} of {len(results)} movies:"
        yield ""
        for s in failing:
            claims = ", ".join(c.claim for c in s.checks if not c.holds)
            yield f"- {s.case.name}: not '{claims}'"
        yield ""
    yield "`default` is `paper`: it fails fewer."


def _alarms() -> Iterator[str]:
    yield from ("", "## Alarms, preset by preset", "")
    yield f"Movies with an alarm. In `{OWN}` LGMD-2 decides alone, so LGMD-2 alone of the other presets stands beside"
    yield "it. Objects pass near by, before a camera that stands still. From the side: from 30 or 45 degrees."
    yield ""
    deciders = {
        "`paper`, all four": preset("paper"),
        "`paper`, LGMD-2": preset("paper", neurons="lgmd2"),
        "`published`, LGMD-2": preset("published", neurons="lgmd2"),
        f"`{OWN}`": preset(OWN),
    }
    yield f"| movies | {' | '.join(deciders)} |"
    yield f"|---|{'--:|' * len(deciders)}"
    movies: dict[str, list[tuple[str, Movie]]] = {}
    for case in battery():
        movies.setdefault(_sort_of(case), []).append((case.name, case.movie(rate_hz=30.0)))
    light = []
    for sort, some in movies.items():
        alarmed = [[name for name, movie in some if first_alarm(movie, p) is not None] for p in deciders.values()]
        yield f"| {sort} | {' | '.join(f'{len(names)}/{len(some)}' for names in alarmed)} |"
        light += alarmed[-1] if sort in ("flicker", "flash") else []
    yield ""
    yield f"Changes of light at which `{OWN}` alarms: {', '.join(light) or 'none'}."


def _sort_of(case: Case) -> str:
    """Return the movie's kind in words."""
    about = case.expectation
    kind = about.kind.partition("_")[0]
    return f"{'dark' if about.dark else 'bright'} object, {MOTIONS[kind]}" if kind in MOTIONS else kind


def _tally(results: Iterable[Scored]) -> dict[tuple[str, str], tuple[int, int]]:
    held: Counter[tuple[str, str]] = Counter()
    made: Counter[tuple[str, str]] = Counter()
    for s in results:
        group = next((g for g in GROUPS if s.case.expectation.kind.startswith(g)), s.case.expectation.kind)
        for check in s.checks:
            made[group, check.claim] += 1
            held[group, check.claim] += check.holds
    return {key: (held[key], made[key]) for key in made}


def _spikes(results: list[Scored]) -> Iterator[str]:
    yield from ("", "## Spikes, preset `paper`, dark object on a plain wall", "")
    yield "| movie | speed cm/s | LGMD-1 | LGMD-2 | LPTC-R | LPTC-L | both LGMDs, best 200 ms | alarm s | contact s |"
    yield "|---|--:|--:|--:|--:|--:|--:|--:|--:|"
    named = {s.case.name: s for s in results}
    for kind in ("looming", "receding", "translating_right", "translating_left"):
        for speed in SPEEDS_CM_S:
            result = named[f"{kind}-dark-{speed:g}cm_s"].result
            counts = " | ".join(str(n) for n in result.spikes.values())
            alarm, contact = (f"{t:.2f}" if t is not None else "none" for t in (result.all_s, result.contact_s))
            yield f"| {kind} | {speed:g} | {counts} | {result.strongest} | {alarm} | {contact} |"


def _rates(changes: dict[str, list[RateChange]]) -> Iterator[str]:
    yield from ("", "## Other frame rates", "")
    yield "The same movies at 15, 60 and 120 Hz against 30 Hz, decided by all four neurons and by the LGMDs alone; in"
    yield f"`{OWN}` by LGMD-2, as it does."
    yield "Listed is every movie whose decision changes, or whose first alarm moves by more than 67 ms."
    for name, found in changes.items():
        yield from ("", f"`{name}`:", "", "| movie | rate Hz | decided by | alarm at 30 Hz | alarm at this rate |",
                    "|---|--:|---|--:|--:|")  # fmt: skip
        for c in found:
            before, now = (f"{t:.2f} s" if t is not None else "none" for t in (c.at_30_hz_s, c.at_rate_s))
            yield f"| {c.name} | {c.rate_hz:g} | {c.neurons} | {before} | {now} |"


def _ablations(costs: Iterable[Cost]) -> Iterator[str]:
    yield from ("", "## One mechanism off at a time, preset `paper`", "")
    yield "Thresholds and scales behind the cut are set anew so that one approach and one passing object drive the"
    yield "neurons as before; what is left is what the mechanism does for selectivity. Moving objects are dark ones."
    yield ""
    columns = ("off", "approaches seen", "recession: alarms", "LGMD-2 spikes", "passing: alarms",
               "still and noise: spikes", "flicker and flash: spikes", "alarms")  # fmt: skip
    yield f"| {' | '.join(columns)} |"
    yield "|---|--:|--:|--:|--:|--:|--:|--:|"
    for c in costs:
        yield (
            f"| {c.without} | {_of(c.approaches_seen)} | {_of(c.recession_alarms)} | {c.recession_lgmd2_spikes} | "
            f"{_of(c.translation_alarms)} | {c.noise_spikes} | {c.light_spikes} | {_of(c.light_alarms)} |"
        )


def _of(pair: tuple[int, int]) -> str:
    return f"{pair[0]}/{pair[1]}"


if __name__ == "__main__":
    main()
