"""The labels of a set of clips: what happens in each, and when."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import ParameterError

REQUIRED = ("file", "collision")
CONTACT = ("contact_frame", "contact_uncertainty_frames")
"""Needed where a row has a collision."""

OPTIONAL = ("event", "class", "confidence", "group", "split")

_TRUTH = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}


@dataclass(frozen=True, kw_only=True)
class Label:
    """One clip.

    Attributes
    ----------
    file : its path below the folder of clips
    contact_frame : number of the frame in which the camera is touched, from 0; None where nothing touches it
    uncertainty_frames : the contact lies within this many frames of ``contact_frame``
    kind : class of the clip: its own column, or the words of ``event`` before the first colon, comma or bracket
    event : what happens, in words
    confidence : of whoever labelled it: high, medium, low, or nothing
    group : clips of one source, such as one camera or one day, which are alike; empty where nobody said
    split : what the clip may be used for: "test" keeps it out of every search
    """

    file: str
    contact_frame: int | None
    uncertainty_frames: int
    kind: str
    event: str = ""
    confidence: str = ""
    group: str = ""
    split: str = ""

    @property
    def collision(self) -> bool:
        """Whether the camera is hit."""
        return self.contact_frame is not None

    @property
    def apart(self) -> str:
        """Why the clip does not count in the headline; empty where it does."""
        if self.event.upper().startswith("NEAR MISS"):
            return "near miss"
        return "low confidence" if self.confidence.lower() == "low" else ""


def read_labels(path: str | Path) -> list[Label]:
    """Return the labels of a CSV file with a heading, in its order; docs/labels.md describes it.

    Raises
    ------
    ParameterError : no such file, a column missing, or a value that is not what its column holds, with its line
    """
    path = Path(path)
    try:
        with path.open(newline="", encoding="utf-8-sig") as text:
            rows = csv.DictReader(text)
            _require_columns(rows.fieldnames, REQUIRED, f"labels {path}")
            labels = [_label(row, f"labels {path}: line {rows.line_num}") for row in rows]
    except OSError as error:
        reason = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise ParameterError(f"labels {path}: {reason}") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise ParameterError(f"labels {path}: is not CSV: {error}") from error
    if not labels:
        raise ParameterError(f"labels {path}: no rows: must name at least one clip")
    seen: set[str] = set()
    for label in labels:
        if label.file in seen:
            raise ParameterError(f"labels {path}: {label.file} is there twice: must be one row for each clip")
        seen.add(label.file)
    return labels


def _require_columns(there: Iterable[str] | None, needed: Sequence[str], where: str) -> None:
    if there is None:
        raise ParameterError(f"{where}: is empty: must have a heading with {', '.join(REQUIRED)}")
    names = list(there)
    missing = [name for name in needed if name not in names]
    if missing:
        other = next((mark for mark in (";", "\t") if len(names) == 1 and mark in names[0]), None)
        hint = "" if other is None else f"; its columns are parted by {other!r}: must be commas"
        raise ParameterError(
            f"{where}: lacks the column {', '.join(missing)}: must have {', '.join(REQUIRED)}, and "
            f"{', '.join(CONTACT)} where collision is 1; may have {', '.join(OPTIONAL)}{hint}"
        )


def _label(row: Mapping[str, str | None], where: str) -> Label:
    cells = {name: (row.get(name) or "").strip() for name in (*REQUIRED, *CONTACT, *OPTIONAL)}
    if not cells["file"]:
        raise ParameterError(f"{where}: no file: must name a clip")
    hit = _TRUTH.get(cells["collision"].lower())
    if hit is None:
        raise ParameterError(f"{where}: collision = {cells['collision']!r}: must be 1 or 0 (or yes, no, true, false)")
    contact_frame, uncertainty_frames = None, 0
    if hit:
        _require_columns(row, CONTACT, where)
        contact_frame = _whole(cells["contact_frame"], "contact_frame", where)
        uncertainty_frames = _whole(cells["contact_uncertainty_frames"], "contact_uncertainty_frames", where)
    elif cells["contact_frame"]:
        raise ParameterError(f"{where}: contact_frame = {cells['contact_frame']!r}: must be empty where collision is 0")
    kind = cells["class"] or re.split("[:,(]", cells["event"])[0].strip() or ("COLLISION" if hit else "NO COLLISION")
    return Label(
        file=cells["file"],
        contact_frame=contact_frame,
        uncertainty_frames=uncertainty_frames,
        kind=kind,
        event=cells["event"],
        confidence=cells["confidence"],
        group=cells["group"],
        split=cells["split"],
    )


def _whole(text: str, column: str, where: str) -> int:
    if not re.fullmatch(r"\d+", text):
        raise ParameterError(f"{where}: {column} = {text!r}: must be a whole number of frames, 0 or more")
    return int(text)
