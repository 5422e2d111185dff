"""The scene of any row of a recording: its picture, its maps, why it did or did not alarm there."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

from ..engine.network import Network
from ..errors import LobulaError
from ..frames.jpeg import Jpeg
from ..runtime.explanation import conditions_at
from ..types import Frame
from .analysis import CHECK_ROWS, Analysis, Pass
from .recording import BLOCK, Cursor
from .scene import MapPacket, MapScale, Scene, box_of

_PICTURES = 256


class RecordedScenes:
    """Gives the scenes of a recording that ``analysis`` runs over. For one thread, the same for all viewers."""

    def __init__(self, analysis: Analysis) -> None:
        self._analysis = analysis
        self._pictures, self._images = Cursor(analysis.recording), Cursor(analysis.recording)
        self._jpeg, self._scale = Jpeg(), MapScale()
        self._jpegs: OrderedDict[int, tuple[bytes, tuple[float, float, float, float]]] = OrderedDict()
        self._pass: Pass | None = None
        self._network: Network | None = None
        self._next = 0

    def key(self, row: int, map_name: str | None) -> tuple[Any, ...]:
        """The row, the map, and the way through the recording that has come as far as that row."""
        now = self._analysis.current
        return row, map_name, now.number if row < now.rows else None

    def at(self, row: int, map_name: str | None) -> Scene:
        """Return the scene of ``row``; without map and reasons while the analysis has not come so far."""
        row = max(0, min(row, len(self._analysis.recording) - 1))
        time_s, _ = self._analysis.recording.stamp(row)
        jpeg, box = self._picture(row)
        now = self._analysis.current
        if row >= now.rows:
            return Scene(row, time_s, jpeg, box, {}, [])
        maps, why = self._look(now, row, time_s, map_name)
        return Scene(row, time_s, jpeg, box, maps, why)

    def close(self) -> None:
        """Let go of the files."""
        self._pictures.close()
        self._images.close()

    def _picture(self, row: int) -> tuple[bytes, tuple[float, float, float, float]]:
        if row in self._jpegs:
            self._jpegs.move_to_end(row)
            return self._jpegs[row]
        source = self._analysis.recording.source
        try:
            decoded = self._pictures.decoded(row)
        except LobulaError:  # the file has gone since it was read: the traces are still worth showing
            return b"", (0.0, 0.0, 1.0, 1.0)
        found = self._jpeg(decoded), box_of(decoded.layout, source.width, source.height)
        self._jpegs[row] = found
        if len(self._jpegs) > _PICTURES:
            self._jpegs.popitem(last=False)
        return found

    def _look(
        self, now: Pass, row: int, time_s: float, map_name: str | None
    ) -> tuple[dict[str, MapPacket], list[dict[str, Any]]]:
        """Bring the network to ``row``, from where it stands or from a state kept before it."""
        if self._network is None or now is not self._pass or not 0 <= row - self._next < CHECK_ROWS:
            self._next, state = now.before(row)
            self._pass, self._network = now, Network(now.params, engine=self._analysis.engine)
            self._network.restore(state)
        try:
            while self._next < row:
                self._run_to(row)
            block = self._images.block(row // BLOCK)
        except LobulaError:
            self._network = None
            return {}, []
        i = row - block.first
        turning = self._analysis.turning(block.times_s[i : i + 1], now.params)
        taps = () if map_name is None else (map_name,)
        reading = self._network.step(
            Frame(block.images[i], time_s), turning=turning is not None and bool(turning[0]), taps=taps
        )
        self._next = row + 1
        maps = {name: self._scale(name, image) for name, image in reading.taps.items()}
        return maps, [c._asdict() for c in conditions_at(time_s, now.params, self._network.state_dict())]

    def _run_to(self, row: int) -> None:
        """Run the rest of the block that the network stands in, or up to ``row``."""
        assert self._network is not None
        assert self._pass is not None
        block = self._images.block(self._next // BLOCK)
        wanted = slice(self._next - block.first, min(row, block.first + len(block.times_s)) - block.first)
        times_s = block.times_s[wanted]
        self._network.run(block.images[wanted], times_s, turning=self._analysis.turning(times_s, self._pass.params))
        self._next += len(times_s)
