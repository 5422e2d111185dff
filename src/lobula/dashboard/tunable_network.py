"""The detector's network, whose settings may change between two frames and whose maps can be looked at."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from ..engine.network import Network
from ..model.network import NetworkParams
from ..runtime.explanation import conditions_at
from ..types import Frame, Reading
from .live_settings import LiveSettings
from .pace import Pace


class TunableNetwork:
    """A network for the live loop that follows ``settings`` and taps the maps in ``wanted()``.

    ``on_change`` is called with the settings before and after, by the detector's thread, once they hold. ``work`` and
    ``latency`` tell how long a frame took, and how long after its capture it was decided upon.
    """

    def __init__(
        self,
        settings: LiveSettings,
        *,
        engine: str = "auto",
        wanted: Callable[[], frozenset[str]],
        on_change: Callable[[NetworkParams, NetworkParams], None],
    ) -> None:
        self._settings = settings
        self._network = Network(settings.params, engine=engine)
        self.engine = self._network.engine
        self._wanted = wanted
        self._on_change = on_change
        self.work, self.latency = Pace(), Pace()

    def step(self, image: Frame, /, *, yaw_rate_deg_s: float | None = None) -> Reading:
        """Advance by one frame, with the settings as they are now."""
        if self._settings.params is not self._network.params:
            self._follow()
        begun_s = time.monotonic()
        reading = self._network.step(image, yaw_rate_deg_s=yaw_rate_deg_s, taps=self._wanted())
        done_s = time.monotonic()
        self.work.add(done_s - begun_s)
        if image.captured_s is not None:
            self.latency.add(done_s - image.captured_s)
        return reading

    def reset(self) -> None:
        """Return to before the first frame."""
        self._network.reset()

    def why(self, time_s: float) -> list[dict[str, Any]]:
        """Return the parts of the rule as they stand after the last frame, at ``time_s``; none before the first."""
        if self._network.shape is None:
            return []
        return [c._asdict() for c in conditions_at(time_s, self._network.params, self._network.state_dict())]

    def _follow(self) -> None:
        """Take on the present settings and go on from where the network is."""
        before, params = self._network.params, self._settings.params
        network = Network(params, engine=self.engine)
        if self._network.shape is not None:
            network.load_state_dict(self._network.state_dict())
        self._network = network
        self._on_change(before, params)
