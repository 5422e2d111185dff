"""What a run found, as a document for programs and as pages for people."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ..._version import __version__
from ...params import settings_hash
from .claims import HELD_SHARE, PART_SHARE, Verdict
from .counts import share_text
from .figure import PaperFigure, Plan
from .reasons import reason
from .trials import Trial

Document = Mapping[str, Any]
"""The verdicts of one figure or table: what ``FIGURE.json`` holds and what ``paper.md`` is made of.

``paper.md`` needs of it: figure, title, command, seeds, presets (name to settings hash), and claims, each with number,
paper and, by preset, verdicts: status, ours (text) and reason.
"""

WIDTH = 118

RULE = (
    f"A claim *holds* if under every condition at least {100 * HELD_SHARE:.0f} % of the trials show it; it *does not "
    f"hold* if fewer than {100 * PART_SHARE:.0f} % of all its trials do; otherwise it holds *in part*. Intervals are "
    "of 95 %: Wilson for shares, bootstrap over seeds for means. Those of pooled shares are somewhat too narrow, "
    "because all trials of a seed have the same wall."
)


def document(figure: PaperFigure, plan: Plan, verdicts: Sequence[Verdict], scene_hash: str) -> dict[str, Any]:
    """Return the verdicts as plain dictionaries, lists and numbers."""
    claims: dict[str, dict[str, Any]] = {}
    for v in verdicts:
        claim = claims.setdefault(
            v.number, {"number": v.number, "paper": v.paper, "rule": v.rule, "verdicts": {}}
        )  # fmt: skip
        claim["verdicts"][v.preset] = {
            "status": v.status,
            "ours": share_text(v.held, v.trials),
            "held": v.held,
            "trials": v.trials,
            "interval": [round(end, 6) for end in v.interval],
            "reason": reason(v.number, v.preset) if v.status != "holds" else "",
            "conditions": [
                {"condition": f.condition, "held": f.held, "trials": f.trials, "numbers": f.tell()} for f in v.findings
            ],
        }
    return {
        "version": __version__,
        "figure": figure.name,
        "title": figure.title,
        "command": plan.command(figure.name),
        "presets": {name: settings_hash(params) for name, params in plan.presets.items()},
        "scene_hash": scene_hash,
        "seeds": list(plan.seeds),
        "claims": list(claims.values()),
    }


def figure_page(
    figure: PaperFigure, plan: Plan, trials: Sequence[Trial], found: Document, pictures: Mapping[str, str]
) -> Iterator[str]:
    """Yield the lines of ``FIGURE.md``. ``pictures`` names the drawing of each preset."""
    yield f"# {_numbered(figure.name)}: {figure.title}"
    yield ""
    presets = ", ".join(f"preset `{name}` `{settings}`" for name, settings in found["presets"].items())
    yield (
        f"Made by `{found['command']}`, lobula {found['version']}, seeds {_range(found['seeds'])}, arena and courses "
        f"`{found['scene_hash']}`, {presets}. It leaves every trial in `{figure.name}.csv`. Robots, wall and camera "
        "are rendered."
    )
    for preset, picture in pictures.items():
        yield ""
        yield f"![{figure.title}, preset {preset}]({picture})"
    yield ""
    yield from figure.words(plan, trials)
    yield ""
    yield "## Claims"
    yield ""
    yield RULE
    yield ""
    yield from claims_table(found)
    for claim in found["claims"]:
        yield from _claim(claim)


def claims_table(found: Document) -> Iterator[str]:
    """Yield a table in Markdown: each claim of the paper, and its status and share for each preset."""
    presets = list(found["presets"])
    yield f"| claim | the paper says | {' | '.join(f'preset `{name}`' for name in presets)} |"
    yield f"|---|---|{'---|' * len(presets)}"
    for claim in found["claims"]:
        cells = [_cell(claim["verdicts"].get(name)) for name in presets]
        yield f"| {claim['number']} | {claim['paper']} | {' | '.join(cells)} |"


def _cell(found: Mapping[str, Any] | None) -> str:
    return "" if found is None else f"**{found['status']}**: {found['ours']}"


def _claim(claim: Mapping[str, Any]) -> Iterator[str]:
    yield ""
    yield f"### {claim['number']}"
    yield ""
    yield f"The paper: {claim['paper']} Seen in a trial if {claim['rule']}."
    for preset, of in claim["verdicts"].items():
        yield ""
        reason = f" {of['reason']}" if of["reason"] else ""
        yield f"`{preset}`: **{of['status']}**, in {of['ours']}.{reason}"
        yield ""
        yield "| condition | trials | mean of ours (95 %) |"
        yield "|---|--:|---|"
        for one in of["conditions"]:
            yield f"| {one['condition']} | {one['held']}/{one['trials']} | {one['numbers']} |"


def gathered_page(documents: Sequence[Document], details: str = "") -> Iterator[str]:
    """Yield the lines of ``paper.md``: every claim, claim by claim, with what makes it and how it fares.

    ``details`` is the folder of the figures and their pages as seen from this one, with its slash; empty: beside it.
    """
    yield "# The paper, claim by claim"
    yield ""
    yield (
        "What Fu and Yue (2020) say of their model, each claim tried with the network of this package. The presets "
        "differ in what the paper does not print. Made by the commands below."
    )
    yield ""
    yield RULE
    yield ""
    yield "| figure | command | claims that hold |"
    yield "|---|---|---|"
    for found in documents:
        yield f"| {_numbered(found['figure'])}: {found['title']} | `{found['command']}` | {_tally(found)} |"
    for found in documents:
        yield ""
        yield f"## {_numbered(found['figure'])}"
        yield ""
        yield f"![{found['title']}]({details}{found['figure']}.png)"
        yield ""
        presets = ", ".join(f"`{name}` `{settings}`" for name, settings in found["presets"].items())
        yield (
            f"Seeds {_range(found['seeds'])}; presets {presets}. Drawn: preset `{next(iter(found['presets']))}`. "
            f"[Every condition, with its numbers]({details}{found['figure']}.md)."
        )
        yield ""
        yield from claims_table(found)
        reasons = list(_reasons(found))
        if reasons:
            yield ""
            yield "What is missing, and why:"
            yield ""
            yield from reasons


def _reasons(found: Document) -> Iterator[str]:
    """Yield a list in Markdown: each reason once, with the claims and presets it is given for."""
    given: dict[str, dict[str, list[str]]] = {}
    for claim in found["claims"]:
        for preset, of in claim["verdicts"].items():
            if of["reason"]:
                given.setdefault(of["reason"], {}).setdefault(preset, []).append(claim["number"])
    for reason_text, presets in given.items():
        for_whom = "; ".join(f"{', '.join(numbers)}, `{preset}`" for preset, numbers in presets.items())
        yield f"- {for_whom}: {reason_text}"


def _tally(found: Document) -> str:
    parts = []
    for preset in found["presets"]:
        statuses = [claim["verdicts"][preset]["status"] for claim in found["claims"] if preset in claim["verdicts"]]
        parts.append(
            f"`{preset}`: {statuses.count('holds')} of {len(statuses)}, {statuses.count('holds in part')} in part"
        )
    return "; ".join(parts)


def _numbered(name: str) -> str:
    for kind, word in (("fig", "Fig. "), ("table", "Table ")):
        if name.startswith(kind):
            return word + name.removeprefix(kind)
    return name


def _range(seeds: Sequence[int]) -> str:
    return f"{seeds[0]}" if len(seeds) == 1 else f"{seeds[0]} to {seeds[-1]}"


def as_text(lines: Iterable[str]) -> str:
    """Return a page: prose and lists wrapped, tables, headings and pictures left as they are."""
    wrapped = []
    for line in lines:
        inside = line[:1] in "|#!" or len(line) <= WIDTH
        indent = "  " if line.startswith("- ") else ""
        wrapped += [line] if inside else textwrap.wrap(
            line, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
        )  # fmt: skip
    return "\n".join(wrapped) + "\n"
