"""The report page as text: what happened first, then the curves, then everything that made them."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from ..types import NEURONS
from .page_style import SCRIPT, style
from .page_svg import traces_html
from .palette import LABELS, STATE_LABELS, thresholds


@dataclass
class Event:
    """A collision or a state other than ok, from its start until its end, which may not have come."""

    name: str
    number: int | None
    frame: int
    start_s: float
    facts: dict[str, Any]
    end_s: float | None = None
    jpeg: bytes | None = None


class Report(NamedTuple):
    """All that the page shows. ``trace_name`` and ``video_name`` are files beside the page."""

    header: Mapping[str, Any]
    summary: Mapping[str, Any]
    events: Sequence[Event]
    trace: NDArray[np.void]
    trace_name: str
    video_name: str | None


_SETTING_COLUMNS = ("path", "value", "unit", "meaning", "source")
_SHOWN_ELSEWHERE = {"type", "settings", "width", "height", "thresholds", "problems"}


def page_html(report: Report) -> str:
    """Return the page: one HTML document, no scripts, styles, fonts or pictures from elsewhere."""
    header = report.header
    source = str(header.get("source", "unknown source"))
    name = source if "://" in source else Path(source).name or source
    body = "".join(
        (
            f'<header><p class="over">lobula report</p><h1>{escape(name)}</h1>{_status(report.summary)}</header>',
            _cards(report),
            _video_and_events(report),
            _section("Potentials", traces_html(report.trace, thresholds(header))),
            _section("Run", _facts(header, report.summary)),
            _settings(header.get("settings", ())),
            f'<footer><p>Every frame is in <a href="{_link(report.trace_name)}">{escape(report.trace_name)}</a>. '
            "lobula is not a certified safety device.</p></footer>",
        )
    )
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(name)} · lobula report</title><style>{style()}</style></head>\n"
        f"<body><main>{body}</main>{SCRIPT if report.video_name else ''}</body></html>\n"
    )


def _section(title: str, inside: str) -> str:
    return f"<section><h2>{escape(title)}</h2>{inside}</section>\n"


def _status(summary: Mapping[str, Any]) -> str:
    status = str(summary.get("status", "ended without a summary")).replace("_", " ")
    if status == "ok":
        return ""
    words = ". ".join([f"This run was not completed: {status}", *map(str, summary.get("problems", ()))])
    return f'<p class="warning" role="status">{escape(words)}</p>'


def _cards(report: Report) -> str:
    summary, trace = report.summary, report.trace
    duration_s = summary.get("duration_s")
    if duration_s is None:
        duration_s = float(trace["time_s"][-1] - trace["time_s"][0]) if len(trace) else 0.0
    collisions = sum(event.name == "collision" for event in report.events)
    cards = [
        ("collision" if collisions == 1 else "collisions", str(collisions)),
        ("frames", str(summary.get("frames", len(trace)))),
        ("duration", f"{duration_s:.1f} s"),
    ]
    if summary.get("dropped"):
        cards.append(("dropped frames", str(summary["dropped"])))
    if "ms_per_frame" in summary:
        cards.append(("per frame", f"{summary['ms_per_frame']:.2f} ms"))
    first = "card alarm" if collisions else "card"
    return (
        '<div class="cards">'
        + "".join(
            f'<div class="{"card" if number else first}"><b>{escape(value)}</b><span>{escape(label)}</span></div>'
            for number, (label, value) in enumerate(cards)
        )
        + "</div>\n"
    )


def _video_and_events(report: Report) -> str:
    events = _section("Events", _events(report))
    if report.video_name is None:
        return events
    start_s = float(report.trace["time_s"][0]) if len(report.trace) else 0.0
    video = f'<video controls preload="metadata" data-start="{start_s:.6f}" src="{_link(report.video_name)}"></video>'
    return f'<div class="pair">{_section("Video", video)}{events}</div>'


def _events(report: Report) -> str:
    if not report.events:
        return '<p class="none">No collision, and every reading was ok.</p>'
    items = "".join(_event(event, report.video_name is not None) for event in report.events)
    return f'<ol class="events">{items}</ol>'


def _event(event: Event, seekable: bool) -> str:
    kind = "alarm" if event.name == "collision" else "state"
    title = {"collision": "collision", **STATE_LABELS}.get(event.name, event.name).capitalize()
    number = "" if event.number is None else f" {event.number}"
    start = f"{event.start_s:.3f} s"
    if seekable:
        start = f'<button type="button" data-seek="{event.start_s:.6f}">{start}</button>'
    until = "to the end of the run"
    if event.end_s is not None:
        until = f"to {event.end_s:.3f} s, {event.end_s - event.start_s:.3f} s long"
    peak = f", peak at frame {int(event.facts['peak_frame'])}" if "peak_frame" in event.facts else ""
    # + 0.0 turns the -0.0 of a resting LPTC-L into 0.0
    values = "".join(
        f'<span class="{n}">{LABELS[n]} {round(event.facts[n], 2) + 0.0:.2f}</span>'
        for n in NEURONS
        if n in event.facts
    )
    return (
        f'<li class="{kind}">{_picture(event)}<div><h3>{escape(title)}{number}</h3><p>{start} {until}</p>'
        f'<p>frame {event.frame}{peak}</p><p class="values">{values}</p></div></li>'
    )


def _picture(event: Event) -> str:
    if event.jpeg is None:
        return '<div class="blank">no picture</div>'
    data = base64.b64encode(event.jpeg).decode()
    return f'<img alt="frame {event.frame}" src="data:image/jpeg;base64,{data}">'


def _facts(header: Mapping[str, Any], summary: Mapping[str, Any]) -> str:
    rows = {key: value for key, value in header.items() if key not in _SHOWN_ELSEWHERE}
    if "width" in header and "height" in header:
        rows["working size"] = f"{header['width']} x {header['height']} px"
    rows["thresholds"] = ", ".join(f"{LABELS[n]} {level:g}" for n, level in thresholds(header).items())
    rows.update((key, value) for key, value in summary.items() if key not in _SHOWN_ELSEWHERE)
    return (
        "<dl>"
        + "".join(
            f"<div><dt>{escape(str(key).replace('_', ' '))}</dt><dd>{escape(_plain(value))}</dd></div>"
            for key, value in rows.items()
            if value is not None
        )
        + "</dl>"
    )


def _settings(settings: Iterable[Mapping[str, Any]]) -> str:
    rows = list(settings)
    if not rows:
        return ""
    head = "".join(f'<th scope="col">{column}</th>' for column in _SETTING_COLUMNS)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(_plain(row.get(column, '')))}</td>" for column in _SETTING_COLUMNS) + "</tr>"
        for row in rows
    )
    return (
        f"<section><details><summary><h2>Settings ({len(rows)})</h2></summary>"
        f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'
        "</details></section>\n"
    )


def _plain(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, list | tuple):
        return ", ".join(map(_plain, value))
    if isinstance(value, float):
        return f"{value:g}"
    return json.dumps(value, default=str)


def _link(name: str) -> str:
    return escape(quote(name))
