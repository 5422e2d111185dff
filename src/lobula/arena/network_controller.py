"""The network as a controller: a network for each robot, and its collision signal is the alarm."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engine.network import Network, chosen_engine, chosen_storage
from ..model.network import NetworkParams
from ..model.presets import preset
from ..types import Reading
from .controller import Bools


class NetworkController:
    """Runs a ``lobula.Network`` for each robot.

    Parameters
    ----------
    params : the settings of all of them; the default preset where nothing is given
    engine, storage : as ``lobula.Network`` has them; ``compact`` is the robot's arithmetic
    """

    def __init__(self, params: NetworkParams | None = None, *, engine: str = "auto", storage: str = "float") -> None:
        self.params = preset() if params is None else params
        self.engine = chosen_engine(engine)
        self.storage = chosen_storage(storage, self.engine)
        self.start(0, np.random.default_rng(0))

    def start(self, robots: int, rng: np.random.Generator) -> None:
        """Make a network for each of ``robots``; the network knows no chance."""
        self._networks = [self._network() for _ in range(robots)]
        self._spare = self._network()
        self.readings: list[Reading] = []
        """What each robot's network said last."""

    def _network(self) -> Network:
        return Network(self.params, engine=self.engine, storage=self.storage)

    @property
    def potentials(self) -> NDArray[np.float64] | None:
        """(R, 4), the potentials of the last step in the order of ``NEURONS``; None before the first."""
        return np.array([reading[1:5] for reading in self.readings]) if self.readings else None

    def step(self, images: NDArray[np.uint8], time_s: float, turning: Bools) -> Bools:
        """Return whose network signals a collision."""
        self.readings = [
            network.step(image, time_s, turning=turns)
            for network, image, turns in zip(self._networks, images, turning.tolist(), strict=True)
        ]
        return np.array([reading.collision for reading in self.readings], np.bool_)

    def state(self, robot: int) -> dict[str, Any]:
        """Return a copy of everything the robot's network remembers."""
        return self._networks[robot].snapshot()

    def set_state(self, robot: int, state: Any) -> None:
        """Go on from ``state``."""
        self._networks[robot].restore(state)

    def replay(self, state: Any, images: NDArray[np.uint8], times_s: NDArray[np.float64], turning: Bools) -> Bools:
        """Return the collision signal (T,) to ``images`` (T, H, W), from ``state`` on."""
        self._spare.restore(state)
        said: Bools = self._spare.run(images, times_s, turning=turning)["collision"]
        return said
