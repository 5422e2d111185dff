"""What people would try instead, on labelled clips: ``python -m lobula.evaluate.clip_baselines LABELS.csv --out DIR``.

Plain frame difference, the divergence of OpenCV's DIS optical flow and the two older models, each with its threshold
chosen on other groups of clips than it is scored on; beside them lobula's presets, with nothing chosen. All of them are
scored by the code and rules of ``lobula evaluate``.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .._version import __version__
from ..landing import whole_file, writing
from ..model.presets import preset
from ..params import settings_hash
from ..runtime.script import counter, run_script
from .choosing import Candidates, choose_apart
from .contenders import FIXED, WHO, Gathered, gather
from .groups import folds
from .labels import Label, read_labels
from .scoring import ClipScore
from .signals import DIFFERENCES, DIVERGENCES, load_opencv
from .summary import skill, totals

NAME = "clip_baselines"


class Row(NamedTuple):
    """One contender: what it is, how its clips were scored, and what was chosen for them, from and to."""

    name: str
    scores: Sequence[ClipScore]
    chosen: str


def counted(labels: Sequence[Label]) -> list[Label]:
    """Return the labels that count in the headline of ``lobula evaluate``."""
    return [label for label in labels if not label.apart]


def rows(labels: Sequence[Label], found: Gathered, where: str) -> Iterator[Row]:
    """Yield the contenders: presets as they are, then what has its threshold chosen on other groups.

    After each kind comes the one whose variant is chosen in the same way, too.

    Raises
    ------
    ParameterError : clips that cannot be cross-validated
    """
    for name, by_clip in found.fixed.items():
        yield Row(f"preset `{name}`", [by_clip[label.file] for label in labels], "nothing")
    kinds = {
        "frame difference": DIFFERENCES,
        "DIS flow": DIVERGENCES,
        "older models": _OLDER,
        "all four": (WHO["all"],),
    }
    for kind, beginnings in kinds.items():
        own = {name: table for name, table in found.candidates.items() if name.startswith(beginnings)}
        for name, table in own.items():
            yield _chosen(labels, name, table, where)
        if len(own) > 1:
            every = {f"{name} {value}": by_clip for name, table in own.items() for value, by_clip in table.items()}
            yield _chosen(labels, f"{kind}: which of these is chosen, too", every, where)._replace(chosen="")


_OLDER = (WHO["lgmd2"], WHO["lgmds"])


def table(contenders: Sequence[Row]) -> str:
    """Return the rows as a Markdown table."""
    lines = [
        "| contender | chosen | hits | false alarms a minute | median lead | hits by chance | above chance |",
        "|---|---|--:|--:|--:|--:|--:|",
    ]
    for row in contenders:
        t = totals(row.scores)
        low, high = t.hit_interval
        per_minute, interval = t.per_minute or 0.0, t.per_minute_interval or (0.0, 0.0)
        lead = "" if t.median_lead_s is None else f"{t.median_lead_s:.2f} s"
        lines.append(
            f"| {row.name} | {row.chosen} | {t.hits} of {t.collisions} [{low:.0%}, {high:.0%}] | {per_minute:.1f} "
            f"[{interval[0]:.1f}, {interval[1]:.1f}], {t.false_alarms} | {lead} | {t.chance_hit_rate or 0:.0%} "
            f"| {skill(row.scores):.0%} |"
        )
    return "\n".join(lines)


def document(labels: Path, contenders: Sequence[Row]) -> dict[str, Any]:
    """Return everything as plain dictionaries, lists and numbers: for each contender every clip."""
    return {
        "version": __version__,
        "labels": str(labels),
        "presets": {name: settings_hash(preset(name)) for name in FIXED},
        "contenders": [
            {
                "name": row.name,
                "chosen": row.chosen,
                "clips": [
                    {"file": s.label.file, "group": s.label.group, "hit": s.hit if s.label.collision else None,
                     "lead_s": None if s.lead_s is None else round(s.lead_s, 6), "false_alarms": s.false_alarms}
                    for s in row.scores
                ],
            }
            for row in contenders
        ],
    }  # fmt: skip


def _chosen(labels: Sequence[Label], name: str, candidates: Candidates, where: str) -> Row:
    chosen = choose_apart(labels, candidates, where)
    places = sorted(list(candidates).index(value) for value in chosen.candidates.values())
    first, last = (list(candidates)[place] for place in (places[0], places[-1]))
    return Row(name, chosen.scores, first if first == last else f"{first} to {last}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all contenders, write the table, print it, and return the exit code, as ``run_script``."""
    parser = argparse.ArgumentParser(prog=f"python -m lobula.evaluate.{NAME}", description=__doc__)
    parser.add_argument("labels", type=Path, metavar="LABELS.csv", help="what happens in each clip; needs groups")
    parser.add_argument("--clips", type=Path, required=True, metavar="DIR", help="folder of the clips")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the table")
    given = parser.parse_args(arguments)
    return run_script(lambda: compare(given.labels, given.clips, given.out), "nothing is written")


def compare(file: Path, clips: Path, folder: Path) -> None:
    """Run all contenders on the clips of a file of labels, write the table into ``folder`` and print it.

    Raises
    ------
    MissingExtraError : without OpenCV
    ParameterError : labels that do not do
    FrameSourceError : a clip cannot be read
    OutputError : the table cannot be written
    """
    load_opencv()
    labels, where = counted(read_labels(file)), f"labels {file}"
    folds(labels, len(labels), where)  # says now, not after minutes, what cannot be cross-validated
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    found = gather(labels, clips, counter(len(labels), "clips"))
    contenders = list(rows(labels, found, where))
    for ending, text in {
        "md": table(contenders),
        "json": json.dumps(document(file, contenders), indent=1, allow_nan=False),
    }.items():
        with whole_file(folder / f"{NAME}.{ending}") as temporary:
            temporary.write_text(f"{text}\n", encoding="utf-8")
    print(table(contenders))


if __name__ == "__main__":
    sys.exit(main())
