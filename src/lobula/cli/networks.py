"""The network a command runs."""

from __future__ import annotations

from ..model.network import NetworkParams, ReferenceNetwork
from ..types import Frame, Reading


class _Reference:
    engine = "reference"

    def __init__(self, params: NetworkParams) -> None:
        self._params = params
        self._network: ReferenceNetwork | None = None

    def step(self, frame: Frame, *, turning: bool = False) -> Reading:
        if self._network is None:
            h, w = frame.image.shape
            self._network = ReferenceNetwork(self._params, (h, w))
        return self._network.step(frame.image, frame.time_s, turning=turning)

    def reset(self) -> None:
        if self._network is not None:
            self._network.reset()


def make_network(params: NetworkParams, engine: str, scale_kernels: bool) -> _Reference:
    return _Reference(params)
