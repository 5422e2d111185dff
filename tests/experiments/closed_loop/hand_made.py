"""Results of jobs that never ran: events with known numbers."""

from __future__ import annotations

from dataclasses import replace

from lobula.arena import World
from lobula.arena.events import event_table
from lobula.arena.scoring import counts
from lobula.experiments.closed_loop.jobs import Control, Done, Job


def done(model="m", robots=4, seed=1, minutes=60.0, rows=(), **kinds):
    """A job with ``rows`` of events and, of each kind, so many more."""
    rows = [*rows, *({"kind": kind, "time_s": float(n)} for kind, many in kinds.items() for n in range(many))]
    events = event_table(rows)
    world = World()
    job = Job(
        name=f"{model}-{robots}-{seed}", model=model, seed=seed, minutes=minutes, driver=Control("never"),
        world=replace(world, robots=replace(world.robots, count=robots)),
    )  # fmt: skip
    score = counts(events, robot_minutes=robots * minutes, distance_cm=1000.0)
    return Done(job=job, score=score, events=events, seconds={"eye": 1.0})
