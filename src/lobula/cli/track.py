"""``lobula track``: robots in a recording from above, by their ID patterns; and a sheet of such patterns to print."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

from .._version import __version__
from ..errors import ParameterError
from . import options as o
from .call import new_app

app = new_app()

SHEET_IDS = "0-6,46-49"
"""What a sheet holds if nothing else is asked for: seven robots and four corners."""


@app.command()
def track(
    video: Annotated[
        str | None, typer.Argument(metavar="VIDEO", help="video from above, folder of pictures, or pattern")
    ] = None,
    room: Annotated[
        str | None, typer.Option(metavar="WxD|circle:R", help="plan of the floor in cm, such as 70x55 or circle:35")
    ] = None,
    corners: Annotated[
        str | None,
        typer.Option(metavar="X,Y,...", help="px of the room's corners: that at the origin, next along x, and round"),
    ] = None,
    corner_ids: Annotated[
        str | None, typer.Option(metavar="ID,...", help="four ID patterns that lie on the corners, in that order")
    ] = None,
    points: Annotated[
        Path | None, typer.Option(metavar="FILE.csv", help="known points x_px,y_px,x_cm,y_cm; 8 or more fit the lens")
    ] = None,
    px_per_cm: Annotated[
        float | None, typer.Option(metavar="S", help="scale of a camera far above, the room in the picture's middle")
    ] = None,
    corners_height: Annotated[
        float | None, typer.Option(metavar="CM", help="height of corners or points over the floor")
    ] = None,
    camera_height: Annotated[
        float | None, typer.Option(metavar="CM", help="lens over the floor: puts right that the discs lie higher")
    ] = None,
    world: Annotated[
        Path | None, typer.Option(metavar="FILE.toml", help="arena file: room, obstacles, the robots and their cameras")
    ] = None,
    ids: Annotated[str | None, typer.Option(metavar="0-6,9", help="the robots' ids; else all that are seen")] = None,
    disc: Annotated[float | None, typer.Option(metavar="CM", help="diameter of the white discs; 4")] = None,
    height: Annotated[float | None, typer.Option(metavar="CM", help="height of the discs over the floor; 3")] = None,
    max_gap: Annotated[float, typer.Option(metavar="S", help="longest gap that is bridged")] = 0.5,
    out: Annotated[Path, typer.Option(metavar="FILE.csv", help="the tracks")] = Path("tracks.csv"),
    picture: Annotated[
        Path | None, typer.Option(metavar="FILE.png", help="a frame with room and robots drawn in: does it fit?")
    ] = None,
    score: Annotated[bool, typer.Option("--score", help="count contacts and avoidances as in the arena")] = False,
    events: Annotated[
        Path | None, typer.Option(metavar="FILE.csv", help="write contacts and avoidances, one a row")
    ] = None,
    start: o.Start = None,
    end: o.End = None,
    stride: o.Stride = 1,
    rate: o.Rate = None,
    print_sheet: Annotated[
        Path | None,
        typer.Option("--print", metavar="FILE.pdf|png", help="write ID patterns to print, A4 in true size, and stop"),
    ] = None,
    json: o.Json = False,
) -> None:
    """Find robots in a recording from above by their ID patterns: positions, headings, their errors; and score them."""
    from ..arena.world_file import load_world
    from ..overhead import TrackParams, frame_count, tracks_csv
    from ..overhead import track as find
    from .destinations import check_files
    from .print_json import print_json
    from .progress import say, screen
    from .track_request import marker_of, parse_ids, reference_of, room_of
    from .track_text import as_text, event_lines, score_dict

    if print_sheet is not None:
        _print(print_sheet, ids or SHEET_IDS, disc, json)
        return
    if video is None:
        raise ParameterError("track: no VIDEO: must be a recording from above; --print FILE makes ID patterns")
    base = None if world is None else load_world(world)
    plan, marker = room_of(room, base), marker_of(disc, height, base)
    reference = reference_of(corners, corner_ids, points, px_per_cm, corners_height, camera_height)
    wanted = None if ids is None else parse_ids(ids, "--ids")
    params = TrackParams(max_gap_s=max_gap)
    outputs = {"--out": out, "--picture": picture, "--events": events}
    check_files(outputs, {"source": video, "file of points": points, "world file": world})
    opening: dict[str, Any] = {"start_s": start, "end_s": end, "stride": stride, "rate_hz": rate}
    with screen(frame_count(video, **opening), "frames") as here:
        tracks = find(video, plan, reference, marker=marker, params=params, ids=wanted, advance=here.advance, **opening)
    _write(out, tracks_csv(tracks.rows))
    if picture is not None and tracks.draw is not None:
        from ..report.png import write_png

        write_png(picture, tracks.draw())
    scored = None
    if score or events is not None:
        from ..experiments.tracked import score_tracks, world_of

        scored = score_tracks(tracks, world_of(plan, base))
        if events is not None:
            _write(events, event_lines(scored))
    summary, numbers = tracks.summary(), None if scored is None else score_dict(scored)
    for note in tracks.notes:
        say(f"lobula: {note}")
    if json:
        print_json({"version": __version__, "tracks": str(out), **summary, "score": numbers})
    else:
        print(as_text(summary, numbers))
    if tracks.stopped is not None:
        raise tracks.stopped


def _print(path: Path, ids: str, disc_cm: float | None, json: bool) -> None:
    from ..landing import whole_file
    from ..overhead.sheet import sheet
    from .destinations import check_files
    from .print_json import print_json
    from .progress import say
    from .track_request import marker_of, parse_ids

    check_files({"--print": path})
    marker = marker_of(disc_cm, None, None)
    numbers = parse_ids(ids, "--ids")
    data = sheet(numbers, path.suffix.lower(), marker)
    with whole_file(path) as temporary:
        temporary.write_bytes(data)
    if json:
        print_json({"sheet": str(path), "ids": numbers, "disc_cm": marker.disc_cm, "square_cm": marker.side_cm})
    else:
        say(f"{path}: {len(numbers)} ID patterns, discs of {marker.disc_cm:g} cm; print at 100 %, check the ruler")


def _write(path: Path, lines: Iterable[str]) -> None:
    from ..landing import whole_file

    with whole_file(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.writelines(lines)
