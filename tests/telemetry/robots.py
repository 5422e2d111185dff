"""A robot at the other end of a pseudo-terminal, that does as it is told."""

from __future__ import annotations

import os
import termios
import threading
import time
import tty
from collections.abc import Callable
from pathlib import Path

from lobula.telemetry import RobotReading
from lobula.types import Spikes

from . import oracle

RATE_HZ = 100


def reading(number: int, *, sequence: int | None = None, **other) -> RobotReading:
    """The reading of picture ``number``; an alarm in 60..79 of every 200, during which it stops."""
    alarm = 60 <= number % 200 < 80
    potentials = (0.75, 0.875, 0.0, -0.125) if alarm else (0.5, 0.5, 0.0, 0.0)
    told = {
        "sequence": (number if sequence is None else sequence) % 2**16, "frame": number,
        "time_ms": 1000 * number // RATE_HZ, "potentials": potentials, "spikes": Spikes(2, 3) if alarm else Spikes(),
        "collision": alarm, "state": "ok", "action": "stop" if alarm else "forward", "step_us": 2500,
    }  # fmt: skip
    return RobotReading(**{**told, **other})


def frame_of(told: RobotReading) -> bytes:
    """A reading as the oracle puts it on the line."""
    actions = {"forward": 0, "stop": 1, "turn_left": 2, "turn_right": 3, None: 255}
    states = {"ok": 0, "warming_up": 1, "stale": 2, "flash": 3, "turning": 4}
    return oracle.reading(
        sequence=told.sequence, frame=told.frame, time_ms=told.time_ms, potentials=told.potentials, spikes=told.spikes,
        state=states[told.state], collision=told.collision, action=actions[told.action], step_us=told.step_us,
    )  # fmt: skip


class Robot:
    """Both ends of a line. ``link`` is a name of it that stays, as udev gives one."""

    def __init__(self, folder: Path) -> None:
        self.link = folder / "robot"
        self._busy: list[threading.Thread] = []
        self._gone = False
        self.plug()

    @property
    def port(self) -> str:
        """What to give to lobula."""
        return f"serial:{self.link}"

    def plug(self) -> None:
        """Make the line, under the same name."""
        self._near, self._far = os.openpty()
        tty.setraw(self._far)
        self.link.symlink_to(os.ttyname(self._far))

    def unplug(self) -> None:
        """Take the line away."""
        self.link.unlink()
        os.close(self._near)
        os.close(self._far)

    def say(self, *frames: bytes) -> None:
        """Send bytes; waits while nobody reads them."""
        data = b"".join(frames)
        while data:
            data = data[os.write(self._near, data) :]

    def tell(self, first: int, last: int, **other) -> None:
        """Send readings first..last."""
        self.say(*(frame_of(reading(number, **other)) for number in range(first, last + 1)))

    def drive(self, first: int, last: int) -> None:
        """Send readings first..last at their own pace."""
        for number in range(first, last + 1):
            time.sleep(1 / RATE_HZ)
            self.tell(number, number)

    def heard(self) -> None:
        """Wait until somebody has opened the line: that one asks for breaks to be ignored, which nobody else did."""
        while not (self._gone or termios.tcgetattr(self._far)[0] & termios.IGNBRK):
            time.sleep(0.005)

    def then(self, *steps: Callable[[], object]) -> None:
        """Do all this in a thread, once somebody has opened the line."""

        def work() -> None:
            self.heard()
            for step in steps:
                step()

        self._busy.append(threading.Thread(target=work, daemon=True))
        self._busy[-1].start()

    def greet(self, **hello) -> None:
        """Say hello as soon as somebody has opened the line."""
        self.then(lambda: self.say(oracle.hello(**hello)))

    def close(self) -> None:
        """Be gone."""
        self._gone = True
        for thread in self._busy:
            thread.join(10)
        if self.link.is_symlink():
            self.unplug()
