"""The network over every labelled clip."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import LobulaError
from ..report.trace import trace_row
from ..runtime.opening import open as open_frames
from ..types import TRACE_DTYPE, Frame, Reading
from .labels import Label
from .scoring import ClipScore, last_frame, score_clip


class Stepper(Protocol):
    """What is asked of a network."""

    def step(self, image: Frame, /) -> Reading:
        """Advance by one frame."""


class Failure(NamedTuple):
    """A clip that could not be scored, and why."""

    label: Label
    message: str


def score_clips(
    labels: Sequence[Label], folder: Path, make_network: Callable[[], Stepper], **view: Any
) -> Iterator[ClipScore | Failure]:
    """Run a fresh network over each clip of ``folder`` and yield its score, or why there is none, in order.

    ``view`` goes to ``lobula.open``: the working size and how a picture is brought to it.
    """
    for label in labels:
        try:
            yield score_clip(label, clip_trace(folder / label.file, make_network(), last_frame(label), **view))
        except LobulaError as error:
            yield Failure(label, str(error))


def clip_trace(path: Path, network: Stepper, last: int | None = None, **view: Any) -> NDArray[np.void]:
    """Return the trace, (n,) TRACE_DTYPE, of ``network`` over the clip at ``path`` up to frame number ``last``.

    Raises
    ------
    FrameSourceError : the clip cannot be read to its end
    """
    rows = []
    with open_frames(path, **view) as frames:
        for frame in frames:
            if last is not None and frame.index > last:
                break
            rows.append(trace_row(frame.index, network.step(frame)))
    return np.array(rows, TRACE_DTYPE)
