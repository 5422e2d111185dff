"""What drives the robots: pictures in, "avoid now" out, for all robots at once. Write your own with these two methods.

class Startled:
    def start(self, robots, rng):
        self.before = None

    def step(self, images, time_s, turning):
        now = images.mean(axis=(1, 2))
        before, self.before = self.before, now
        return now < 0.9 * before if before is not None else np.zeros(len(images), bool)

arena.run(controller=Startled())
"""

from __future__ import annotations

from typing import Any, Protocol, TypeGuard, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ..errors import LobulaError
from ..params import Params, to_dict

Bools = NDArray[np.bool_]


class ControllerError(LobulaError, RuntimeError):
    """A controller that raised, or that returned something other than a decision for each robot.

    ``run`` is what was done before, a ``course.Run``, where ``arena.run`` raised it.
    """

    run: Any = None


class Controller(Protocol):
    """What every controller does. One with settings keeps them in an attribute ``params``, see ``settings_of``."""

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Make ready for a run with ``robots`` robots; all its chance should come from ``rng``."""

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Any:
        """Return (R,) bool: which robots are to avoid now.

        Parameters
        ----------
        images : (R, H, W), what each robot sees; a new array in each tick
        time_s : the time of these pictures
        turning : (R,), robots that stop and turn; decisions for them are ignored
        """


@runtime_checkable
class KeepsState(Protocol):
    """A controller whose state can be saved: needed to resume a run."""

    def state(self, robot: int) -> Any:
        """Return what it remembers for ``robot``: numbers, texts, arrays, lists and dictionaries of them.

        It is kept, never changed; make it quick, it is called several times a second.
        """

    def set_state(self, robot: int, state: Any) -> None:
        """Continue with ``robot`` from ``state``."""


@runtime_checkable
class Replays(KeepsState, Protocol):
    """A controller that can be asked what it would have said: needed for the causes of its alarms."""

    def replay(self, state: Any, images: NDArray[np.uint8], times_s: NDArray[np.float64], turning: Bools) -> Bools:
        """Return what it says (T,) to ``images`` (T, H, W) of one robot from ``state`` on; the run stays as it is."""


def can_replay(controller: Controller) -> TypeGuard[Replays]:
    """Whether the controller can be asked again."""
    return isinstance(controller, Replays)


def keeps_state(controller: Controller) -> TypeGuard[KeepsState]:
    """Whether the controller's state can be saved."""
    return isinstance(controller, KeepsState)


def settings_of(controller: Controller) -> dict[str, Any] | None:
    """Return the settings that the controller keeps in ``params``, as plain dictionaries; None where it has none.

    Records hold them, and a run is resumed only with the same.
    """
    params = getattr(controller, "params", None)
    return to_dict(params) if isinstance(params, Params) else None


def require_controller(controller: Any) -> None:
    """Check that it is one.

    Raises
    ------
    ControllerError : a class instead of an object, or a method missing
    """
    if isinstance(controller, type):
        name = controller.__name__
        raise ControllerError(f"controller {name}: is a class: must be an object, {name}()")
    missing = [name for name in ("start", "step") if not callable(getattr(controller, name, None))]
    if missing:
        raise ControllerError(
            f"controller {type(controller).__name__}: has no {'() and no '.join(missing)}(): must have "
            "start(robots, rng) and step(images, time_s, turning); a detector for one camera goes into EachRobot"
        )


def decide(controller: Controller, images: NDArray[np.uint8], time_s: float, turning: Bools, tick: int) -> Bools:
    """Return the controller's decisions (R,), checked.

    Raises
    ------
    ControllerError : it raised, or returned anything but a truth value for each robot
    """
    try:
        said = controller.step(images, time_s, turning)
    except Exception as error:
        raise ControllerError(f"{_where(controller, tick, time_s)}: raised {type(error).__name__}: {error}") from error
    if type(said) is np.ndarray and said.dtype == np.bool_ and said.shape == turning.shape:
        return said
    return _checked(said, len(turning), _where(controller, tick, time_s))


def _checked(said: Any, robots: int, where: str) -> Bools:
    wanted = f"must be {robots} truth values, one for each robot"
    try:
        values = np.asarray(said)
    except ValueError as error:
        raise ControllerError(f"{where}: returned {_short(said)}: {wanted}") from error
    if values.shape != (robots,):
        raise ControllerError(f"{where}: returned shape {values.shape}: {wanted}")
    if values.dtype.kind not in "biuf":
        raise ControllerError(f"{where}: returned {_short(said)}: {wanted}")
    wrong = np.flatnonzero((values != 0) & (values != 1))  # NaN is neither
    if wrong.size:
        raise ControllerError(f"{where}, robot {wrong[0]}: returned {values[wrong[0]]}: {wanted}")
    return values.astype(np.bool_)


def _where(controller: Controller, tick: int, time_s: float) -> str:
    return f"controller {type(controller).__name__}, tick {tick} ({time_s:.3f} s)"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
