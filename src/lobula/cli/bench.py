"""``lobula bench``: this machine's figures."""

from __future__ import annotations

from typing import Annotated

import typer

from . import options as o
from .call import new_app

app = new_app()


@app.command()
def bench(
    rounds: Annotated[int, typer.Option(metavar="N", help="rounds of each measurement")] = 7,
    json: o.Json = False,
) -> None:
    """Measure what lobula takes on this machine."""
    from ..bench import measure
    from ..errors import ParameterError
    from .print_json import print_json

    if rounds < 1:
        raise ParameterError(f"--rounds {rounds}: must be 1 or more")
    figures = measure(rounds=rounds)
    print_json(figures)
