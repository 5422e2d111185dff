"""What ``lobula tune`` found as settings files: one for the best trial, one for each of the front."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..landing import whole_file, writing
from ..model.presets import preset as named_preset
from ..params import settings_hash
from ..runtime.header import setting_rows
from .settings_file import settings_toml
from .tune_text import held_out_text, score_text

if TYPE_CHECKING:
    from ..tuning.journal import Trial
    from ..tuning.plan import Found

BEST, FRONT = "best.toml", "front"


def write_presets(found: Found, folder: Path) -> None:
    """Write the settings of the best trial and of the front; files of an earlier front are removed.

    Raises
    ------
    OutputError : one of them cannot be written
    """
    texts = {folder / FRONT / f"trial-{trial.number:04d}.toml": _toml(found, trial) for trial in found.front}
    with writing(folder / FRONT):
        (folder / FRONT).mkdir(exist_ok=True)
        for path in (folder / FRONT).glob("trial-*.toml"):
            if path not in texts:
                path.unlink()
    for path, text in {folder / BEST: _toml(found, found.best), **texts}.items():
        with whole_file(path) as temporary:
            temporary.write_text(text, encoding="utf-8")


def _toml(found: Found, trial: Trial) -> str:
    """Return the settings of ``trial`` that are not the preset's, below what is to be known of them."""
    params = found.plan.settings(trial)
    plain = {row["path"]: row["value"] for row in setting_rows(named_preset(found.plan.preset))}
    changed = [row for row in setting_rows(params) if row["value"] != plain[row["path"]]]
    lines = "".join(f"# {line}\n" for line in _provenance(found, trial, settings_hash(params)))
    return lines + settings_toml(changed, found.plan.preset)


def _provenance(found: Found, trial: Trial, digest: str) -> Iterator[str]:
    plan, about = found.plan, found.plan.task.about
    search, some = next(iter(found.trials.items()))
    yield f"Settings {digest}, found by lobula tune: trial {trial.number} of {len(some)}, seed {plan.budget.seed}."
    yield f"lobula {found.identity['version']}, code {found.identity['code']}."
    yield f"Begun with: preset {plan.preset}, settings {settings_hash(plan.base)}."
    yield f"Searched on: {_told(about, search)}."
    yield f"Held out: {about['held_out']}."
    yield f"Score on what was searched on: {score_text(trial.objectives or (), trial.about or {})}."
    yield held_out_text(found, trial)
    yield "Searched:"
    for axis in plan.axes:
        yield f"  {axis.path}: {axis.range_text}"


def _told(about: Any, search: str) -> str:
    """Return what ``about`` says of what was searched on, in one line."""
    told = {name: value for name, value in about.items() if name not in ("on", "held_out", "left_out") and value}
    words = ", ".join(f"{name.replace('_', ' ')} {_plain(value)}" for name, value in told.items())
    return f"{about['on']}, {search}; {words}" if about["on"] == "clips" else f"{about['on']}; {words}"


def _plain(value: Any) -> str:
    return " ".join(map(str, value)) if isinstance(value, list | tuple) else str(value)
