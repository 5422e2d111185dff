"""Which code made a number: what a resumed table must not mix."""

from __future__ import annotations

from ...source_hash import source_hash

PARTS = ("arena", "engine", "model")
"""Folders of the package on which the outcome of a run depends."""


def code_hash() -> str:
    """Return twelve hexadecimal digits that change when the arena, the model or the compiled core changes."""
    return source_hash(*PARTS)
