"""The command ``lobula``: one file for each verb, loaded only when it is called.

The list below is all that ``lobula --help`` needs, so help comes at once: no numpy, no video library, no typer.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from .._version import __version__

VERBS = {
    "demo": "see it work: no camera, no window; who spiked when, and a picture",
    "run": "watch a clip, a camera or a pipe: collisions, traces, annotated video, report",
    "serve": "show it in a browser, live or replayed: picture, traces, events; thresholds changed live",
    "batch": "many clips on all cores or a cluster; what is done already is not done again",
    "evaluate": "score labelled clips: hits, lead times, false alarms a minute",
    "arena": "several robots in a room: contacts, avoidances, success rates",
    "reproduce": "the paper's figures made again, and which of its claims hold",
    "plot": "draw a saved trace",
    "explain": "why it did, or did not, alarm at a given moment",
    "stimulus": "write a synthetic movie with a known answer as a clip",
    "tune": "search settings on movies, clips or the arena, with a held-out score",
    "track": "find robots in a recording from above by their ID patterns, and score them",
    "export": "settings as a folder of C for a robot",
    "bench": "measure this machine",
    "config": "show every setting and its origin; make or check a settings file",
    "doctor": "what was found on this machine, what is missing and how to get it",
}
"""Verb -> one line; the module of the same name holds its ``app``."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command with ``argv`` (default: the process's own) and return its exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    first = arguments[0] if arguments else "--help"
    if first in ("-h", "--help"):
        print(help_text())
        return 0
    if first == "--version":
        print(f"lobula {__version__}")
        return 0
    if first not in VERBS:
        from difflib import get_close_matches

        close = get_close_matches(first, VERBS, n=1, cutoff=0.5)
        hint = f"did you mean {close[0]}?" if close else f"must be one of {', '.join(VERBS)}"
        print(f"lobula: unknown command {first}: {hint}", file=sys.stderr)
        return 2
    from .call import call

    return call(first, arguments[1:])


def help_text() -> str:
    """Return what ``lobula --help`` prints."""
    width = max(map(len, VERBS))
    lines = "\n".join(f"  {verb:{width}}  {about}" for verb, about in VERBS.items())
    return (
        "Usage: lobula VERB [ARGUMENTS]\n\n"
        "Watches one camera and says, in time, that something is going to hit it.\n\n"
        f"Verbs:\n{lines}\n\n"
        "`lobula VERB --help` says what a verb takes; every verb has --json. `lobula --version` says which this is.\n"
        "Exit codes: 0 done; 1 demo did not see what it must, or a fault of lobula's own; 2 the request or its input\n"
        "was wrong; 3 the source or an output failed on the way; 4 some clips of evaluate or batch failed;\n"
        "130 or 143 interrupted."
    )
