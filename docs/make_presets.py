"""Write the table of docs/presets.md from the presets themselves: ``python docs/make_presets.py``.

A test compares the page with what this makes, so the two cannot drift apart.
"""

from __future__ import annotations

from pathlib import Path

from lobula.model.network import NetworkParams
from lobula.model.presets import DEFAULT, PRESETS, preset
from lobula.params import Params, walk

PAGE = Path(__file__).with_name("presets.md")
BEGIN, END = "<!-- made by make_presets.py: begin -->\n", "<!-- made by make_presets.py: end -->\n"

MECHANISMS = {
    "clock": "Model clock",
    "flash": "Flash: global changes of light",
    "saturation": "Retina: saturation of the change",
    "lamina.dog": "Lamina: difference of Gaussians (DoG)",
    "lamina.on_off": "Lamina: ON and OFF channels",
    "lamina.fdsr": "Lamina: fast-depolarising slow-repolarising adaptation (FDSR)",
    "coarse": "Coarse patches of the retina's change",
    "lgmd1": "LGMD-1",
    "lgmd1.on": "LGMD-1: inhibition in the ON channel",
    "lgmd1.off": "LGMD-1: inhibition in the OFF channel",
    "lgmd1.grouping": "LGMD-1: grouping",
    "lgmd1.sfa": "LGMD-1: spike frequency adaptation (SFA)",
    "lgmd1.spiking": "LGMD-1: spikes",
    "lgmd2": "LGMD-2",
    "lgmd2.on": "LGMD-2: raised inhibition in the ON channel",
    "lgmd2.off": "LGMD-2: inhibition in the OFF channel",
    "lgmd2.grouping": "LGMD-2: grouping",
    "lgmd2.sfa": "LGMD-2: spike frequency adaptation (SFA)",
    "lgmd2.spiking": "LGMD-2: spikes",
    "lptc": "LPTC-R and LPTC-L",
    "lptc.emd": "LPTCs: elementary motion detectors (EMD)",
    "lptc.spiking": "LPTCs: spikes",
    "decision": "Decision: gates and comparator",
}
"""Group of settings -> the mechanism they belong to."""


def table() -> str:
    """Return one table: every mechanism, whether it is on, its settings, and the origin of each value."""
    presets = {name: preset(name) for name in sorted(PRESETS, key=lambda name: name != DEFAULT)}
    chosen = {name: dict(_settings(params)) for name, params in presets.items()}
    titles = [f"`{name}`{' (default)' if name == DEFAULT else ''}" for name in chosen]
    lines = [
        f"| setting | {' | '.join(titles)} | unit | meaning | where the value comes from |",
        f"|---|{'---:|' * len(titles)}---|---|---|",
    ]
    for group, title in MECHANISMS.items():
        own = {
            name: {path: at for path, at in settings.items() if path.rpartition(".")[0] == group}
            for name, settings in chosen.items()
        }
        states = [_state(group, own[name], presets[name]) for name in presets]
        lines.append(f"| **{title}** | {' | '.join(states)} | | | |")
        for path in next(iter(own.values())):
            owners = {name: of[path] for name, of in own.items()}
            lines.append(_row(path, owners))
    return "\n".join(lines) + "\n"


def page(text: str) -> str:
    """Return the text of the page with its table made afresh."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{table()}\n{END}{after}"


def _settings(params: NetworkParams) -> list[tuple[str, tuple[Params, str]]]:
    return [(path, (owner, name)) for path, owner, name in walk(params)]


def _state(group: str, own: dict[str, tuple[Params, str]], params: NetworkParams) -> str:
    """Whether the mechanism is on; of an LGMD, what it reads; of the patches, who hears them."""
    if group == "coarse":
        heard = [title for title, lgmd in (("LGMD-1", params.lgmd1), ("LGMD-2", params.lgmd2)) if lgmd.coarse_gain]
        return f"**on, heard by {' and '.join(heard)}**" if heard else "**off**"
    values = {path.removeprefix(f"{group}."): getattr(*at) for path, at in own.items()}
    if "reads" in values:
        return f"**on, reads the {values['reads']}**"
    return "**on**" if values.get("enabled", True) else "**off**"


def _row(path: str, owners: dict[str, tuple[Params, str]]) -> str:
    values = [_value(getattr(*at)) for at in owners.values()]
    sources: dict[str, list[str]] = {}
    for name, (owner, setting) in owners.items():
        sources.setdefault(owner.source_of(setting), []).append(f"`{name}`")
    if len(sources) == 1:
        source = next(iter(sources))
    else:
        source = "; ".join(f"{text} ({', '.join(names)})" for text, names in sources.items())
    owner, name = next(iter(owners.values()))
    about = type(owner).__dataclass_fields__[name].metadata
    return f"| `{path}` | {' | '.join(values)} | {about['unit']} | {about['doc']} | {source} |"


def _value(value: object) -> str:
    if isinstance(value, tuple):
        return ", ".join(_value(item) for item in value)
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:.5g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
