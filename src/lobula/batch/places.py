"""Where things lie in the folder that a batch writes into."""

from __future__ import annotations

from pathlib import Path

MARK = ".batch"
"""The folder by which the output of a batch is known: what is under way, and what was learnt about the clips."""


def manifest_path(out: Path) -> Path:
    """Return the manifest: one line for each clip that was finished, ever; only added to."""
    return out / "manifest.ndjson"


def table_path(out: Path) -> Path:
    """Return the table of the last call: one row for each of its clips."""
    return out / "clips.csv"


def summary_path(out: Path) -> Path:
    """Return the summary of the last call."""
    return out / "summary.json"


def settings_path(out: Path, settings: str) -> Path:
    """Return the list of the settings whose hash is ``settings``."""
    return out / settings / "settings.json"


def contents_path(out: Path) -> Path:
    """Return the list of the files whose content is known."""
    return out / MARK / "contents.ndjson"


def work_folder(out: Path) -> Path:
    """Return the folder of the clips that are under way."""
    return out / MARK / "work"


def make_places(out: Path) -> None:
    """Make the folders of a batch in ``out``, where they are not there."""
    work_folder(out).mkdir(parents=True, exist_ok=True)
