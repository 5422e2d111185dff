"""A whole run from one call; interrupted at any time, it can be taken up again to the same result."""

from __future__ import annotations

import os
import signal
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..errors import ParameterError
from ..runtime.interrupts import Interrupted, Interrupts
from .controller import Controller, ControllerError
from .course import KIND, Course, Progress, Run
from .network_controller import NetworkController
from .simulation import Simulation
from .snapshot import load_snapshot
from .world import World
from .world_file import parse_world

MOST_MINUTES = 100_000.0


class RunInterrupted(KeyboardInterrupt):
    """A run that a signal ended; ``run`` is what was done, ``number`` the signal's."""

    def __init__(self, run: Run, number: int) -> None:
        super().__init__(f"interrupted after {run.minutes:.2f} simulated minutes")
        self.run, self.number = run, number

    def __reduce__(self) -> tuple[type[RunInterrupted], tuple[Run, int]]:
        return type(self), (self.run, self.number)  # so that it travels between processes


def run(
    world: World | None = None,
    controller: Controller | None = None,
    *,
    minutes: float | None = None,
    seed: int | None = None,
    robots: int | None = None,
    record: bool = False,
    progress: Progress | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    resume: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    engine: str = "auto",
) -> Run:
    """Let robots drive in ``world`` and count what happens.

    Parameters
    ----------
    world : the arena; the paper's where nothing is given
    controller : pictures in, decisions out, see ``controller``; the default network where nothing is given
    minutes : of simulated time; 60 where nothing is given
    seed : of all chance; 0 where nothing is given
    robots : their number, instead of the world's
    record : keep every frame, see ``record.Record``
    progress : called once a simulated second
    checkpoint : a file that is written every 5 simulated minutes and at the end, whatever ends the run
    resume : such a file, or the ``snapshot`` of a ``Run``: go on from there. World, seed and minutes are those of
        that run where they are not given; the controller must be given again
    engine : of the eye: ``core``, ``reference`` or ``auto``

    Raises
    ------
    ParameterError : a world without room for its robots, a checkpoint of another run
    ControllerError : the controller raised or returned nonsense. Its ``run`` is what was done so far; it can be
        resumed, from the last snapshot
    RunInterrupted : Ctrl-C or SIGTERM, taken between two ticks. Its ``run`` is what was done so far
    """
    kept = load_snapshot(resume) if isinstance(resume, str | os.PathLike) else resume
    if kept is not None:
        if kept.get("kind") != KIND:
            raise ParameterError(f"resume: is no checkpoint of a run, but holds {', '.join(kept) or 'nothing'}")
        world = parse_world(kept["world"], "checkpoint") if world is None else world
        seed = kept["seed"] if seed is None else seed
        minutes = kept["minutes"] if minutes is None else minutes
    world = World() if world is None else world
    if robots is not None:
        world = replace(world, robots=replace(world.robots, count=robots))
    minutes = 60.0 if minutes is None else minutes
    if not 0 < minutes <= MOST_MINUTES:
        raise ParameterError(f"minutes = {minutes!r}: must be above 0 and at most {MOST_MINUTES:g}")
    simulation = Simulation(world, controller or NetworkController(), 0 if seed is None else seed, engine=engine)
    course = Course(simulation, minutes, record=record, checkpoint=checkpoint)
    if kept is None:
        course.keep()
    else:
        course.resume(kept)
    try:
        with Interrupts() as interrupts:
            for _ in interrupts.between(iter(range(simulation.tick_count, course.ticks))):
                course.tick(progress)
    except Interrupted as stop:
        course.keep()
        raise RunInterrupted(course.result(), stop.number) from None
    except KeyboardInterrupt:  # from within a tick, which is lost
        raise RunInterrupted(course.result(), signal.SIGINT) from None
    except ControllerError as error:
        error.run = course.result()
        raise
    course.keep()
    return course.result()
