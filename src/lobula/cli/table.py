"""Rows as aligned columns of plain text: read well on a terminal, in a pipe and in a bug report."""

from __future__ import annotations

from collections.abc import Sequence


def table(columns: Sequence[str], rows: Sequence[Sequence[object]], right: str = "") -> str:
    """Return a heading and ``rows``, each column as wide as its widest cell.

    ``right`` names the columns, separated by spaces, whose cells are set to the right.
    """
    cells = [[str(cell) for cell in row] for row in (columns, *rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(columns))]
    to_right = [name in right.split() for name in columns]
    lines = (
        "  ".join(c.rjust(w) if r else c.ljust(w) for c, w, r in zip(row, widths, to_right, strict=True)).rstrip()
        for row in cells
    )
    return "\n".join(lines)
