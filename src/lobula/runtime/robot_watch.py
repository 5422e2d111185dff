"""Follows a robot's own decisions: nothing is decided here, but silence is told, and what its wheels do."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..telemetry import Action
from ..types import Reading
from .events import Record, motor_record
from .loop import Outcome, follow, polled
from .outputs import Outputs
from .robot import RobotFrame, RobotStream
from .service import Listener
from .tally import Tally
from .watch import SourceWatch


def follow_robot(
    robot: RobotStream,
    outputs: Outputs,
    header: Record,
    *,
    on_frame: Callable[[], None] | None = None,
    listeners: Sequence[Listener] = (),
) -> Outcome:
    """Hand what ``robot`` decides to ``outputs`` until it is told to stop, as ``runtime.loop.run`` does with a camera.

    ``header`` is that of ``robot_header``.
    """

    def watched(tally: Tally) -> RobotWatch:
        return RobotWatch(robot, tally)

    return follow(robot, polled(robot), watched, None, outputs, header, on_frame, listeners)


class RobotWatch(SourceWatch[RobotFrame]):
    """Turns the readings and the silence of one robot into readings and records."""

    def __init__(self, robot: RobotStream, tally: Tally) -> None:
        super().__init__(robot, tally)
        self._action: Action | None = None

    def frame(self, frame: RobotFrame) -> tuple[Reading, list[Record]]:
        """Return the reading as the robot gave it and the records of what it starts or ends."""
        records = self._arrival(frame.time_s)
        self._tally.count(frame, frame.step_s, None)
        if frame.action != self._action and frame.action is not None:
            records.append(motor_record(frame.action, frame.index, frame.time_s))
        self._action = frame.action
        return frame.reading, records + self._tally.log.step(frame.index, frame.reading)
