"""The files of the page, read once at the start: a request can name these and nothing else."""

from __future__ import annotations

from importlib.resources import files

from ..report.palette import DARK, LIGHT, Theme

_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}


def page_files() -> dict[str, tuple[str, bytes]]:
    """Return every file of the page by its name, with its media type; ``theme.css`` has the colours of the reports."""
    found = {"theme.css": ("text/css; charset=utf-8", theme_css().encode())}
    for file in files(__package__).joinpath("assets").iterdir():
        media = _TYPES.get(f".{file.name.rpartition('.')[2]}")
        if media is not None:
            found[file.name] = f"{media}; charset=utf-8", file.read_bytes()
    return found


def theme_css() -> str:
    """Return the style sheet with the colours: light, dark where the system says so, or as the page's switch says."""
    light, dark = _variables(LIGHT), _variables(DARK)
    return (
        f":root{{color-scheme:light;{light}}}\n"
        f"@media (prefers-color-scheme:dark){{:root{{color-scheme:dark;{dark}}}}}\n"
        f':root[data-theme="light"]{{color-scheme:light;{light}}}\n'
        f':root[data-theme="dark"]{{color-scheme:dark;{dark}}}\n'
    )


def _variables(theme: Theme) -> str:
    inks = {"ground": theme.ground, "panel": theme.panel, "line": theme.line, "text": theme.text, "dim": theme.dim}
    inks |= {"hit": theme.collision, **theme.neurons}
    inks |= {f"state-{name}": colour for name, colour in theme.states.items()}
    return "".join(f"--{name}:{colour};" for name, colour in inks.items())
