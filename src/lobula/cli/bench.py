"""``lobula bench``: this machine's figures."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ..errors import ParameterError
from . import options as o
from .call import new_app

app = new_app()


@app.command()
def bench(
    rounds: Annotated[int, typer.Option(metavar="N", help="rounds of each measurement")] = 7,
    json: o.Json = False,
) -> None:
    """Measure what a step, a block, many streams and a file take on this machine."""
    from ..bench import measure
    from .print_json import print_json

    if rounds < 1:
        raise ParameterError(f"--rounds {rounds}: must be 1 or more")
    figures = measure(rounds=rounds)
    if json:
        print_json(figures)
    else:
        print(_text(figures))


def _text(figures: dict[str, Any]) -> str:
    """The same numbers as a table."""
    from .table import table

    machine, streams, video = figures["machine"], figures["streams"], figures["video"]
    rows = [
        (f"{name} {size}", us["median"], us["best"])
        for name, of in (("step", "step_us"), ("block", "block_us"), ("NumPy step", "reference_step_us"))
        for size, us in figures[of].items()
    ]
    rows.append(
        (
            f"{streams['streams']} streams {streams['size']}, {streams['threads']} threads",
            streams["frame_us"]["median"],
            streams["frame_us"]["best"],
        )
    )
    if video is not None:
        rows += [
            (f"{video['clip']}, {what}", video[of]["median"], video[of]["best"])
            for what, of in (("decoded", "decode_us"), ("to decisions", "to_decision_us"))
        ]
    cells = [(what, f"{median:.1f}", f"{best:.1f}") for what, median, best in rows]
    heading = f"{machine['processor']}, {machine['cores']} cores, engine {figures['engine']} {machine['isa'] or ''}"
    return f"{heading.rstrip()}\n\n{table(('us_a_frame', 'median', 'best'), cells, right='median best')}"
