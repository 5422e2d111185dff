"""The coded pictures of a container, in the order they are stored, before any is decoded."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any

import av

from ..errors import FrameSourceError


def stamp_of(item: Any) -> int | None:
    """Return the presentation stamp of a packet or frame, its decoding stamp where it has none, or None."""
    stamp = item.pts if item.pts is not None else item.dts
    return None if stamp is None else int(stamp)


class Packets:
    """Iterates over the packets of one stream; the last ones are empty or None and ask the decoder for what it holds.

    A failure to read ends the iteration after that and is kept in ``failure``. A file is tried once more first,
    because a damaged spot can be followed by sound data.
    """

    def __init__(self, container: Any, stream: Any, name: str, *, try_again: bool) -> None:
        self.failure: FrameSourceError | None = None
        self._name = name
        self._container, self._stream = container, stream
        self._try_again = try_again
        self._held: deque[Any] = deque()
        self._fresh = self._demux()

    def __iter__(self) -> Iterator[Any]:
        return self

    def __next__(self) -> Any:
        return self._held.popleft() if self._held else next(self._fresh)

    def skip(self, start: float) -> tuple[bool, int]:
        """Read on until all that is shown before ``start`` has been read, and go back to the last key frame before it.

        Nothing is sought in the file, so numbers stay exact and no index is needed; what is skipped is not decoded.

        Returns
        -------
        jumped : whether packets were left out, so that the decoder must begin afresh
        before : packets read here that are shown before ``start``
        """
        held: deque[Any] = deque()
        jumped, before = False, 0
        for packet in self._fresh:
            stamp = None if packet is None else stamp_of(packet)
            if stamp is None or not packet.size:
                held.append(packet)
                continue
            before += stamp < start and not packet.is_discard
            if packet.is_keyframe and stamp <= start:
                held.clear()
                jumped = True
            held.append(packet)
            if (stamp if packet.dts is None else packet.dts) > start:
                break  # stored in decoding order: nothing later is shown earlier
        self._held = held
        return jumped, before

    def _demux(self) -> Iterator[Any]:
        packets = self._container.demux(self._stream)
        may_try = self._try_again
        while True:
            try:
                packet = next(packets)
            except StopIteration:
                return
            except av.error.ExitError:
                reason = "nothing came in time"
            except (av.FFmpegError, OSError) as error:
                if may_try:
                    may_try = False
                    packets = self._container.demux(self._stream)
                    continue
                reason = f"cannot be read further: {getattr(error, 'strerror', None) or error}"
            else:
                may_try = self._try_again
                yield packet
                continue
            self.failure = FrameSourceError(f"{self._name}: {reason}", on_the_way=True)
            yield None
            return
