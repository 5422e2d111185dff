"""One JSON document on standard output."""

from __future__ import annotations

import json
from typing import Any


def print_json(document: Any) -> None:
    """Print ``document``, indented, as text that every JSON reader takes: no NaN, no infinity."""
    print(json.dumps(document, indent=2, allow_nan=False))
