"""The public network: checks what comes in, then runs the C core, or the NumPy reference where there is none."""

from __future__ import annotations

import math
import warnings
from collections.abc import Collection, Mapping, Sequence
from numbers import Real
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from ..checks import require_images, require_later, require_not_unit_range
from ..errors import ParameterError, ShapeError, TimeError
from ..model.network import TAPS, NetworkParams, ReferenceNetwork
from ..model.presets import preset
from ..model.scaling import scaled
from ..model.state import StateDict
from ..types import NEURONS, TRACE_DTYPE, Frame, Reading
from .core import FLOAT32, STORAGES, UINT8, CoreNetwork, Storage, Workspace
from .library import available, library, why_not

Engine = Literal["auto", "core", "reference"]
ENGINES: tuple[Engine, ...] = ("auto", "core", "reference")


def chosen_engine(engine: str) -> Literal["core", "reference"]:
    """Return the engine that ``engine`` means here; ``auto`` is the core where it can be used.

    Raises
    ------
    ParameterError : an unknown engine, or ``core`` where there is none
    """
    if engine not in ENGINES:
        raise ParameterError(f"engine {engine!r}: must be one of {', '.join(ENGINES)}")
    if engine == "reference":
        return "reference"
    if engine == "core":
        library()
        return "core"
    if available():
        return "core"
    # one text from one line: Python shows it once in a process
    warnings.warn(
        f"lobula runs on its NumPy reference, about 40 times slower than its C core: {why_not()}",
        RuntimeWarning,
        stacklevel=2,
    )
    return "reference"


def chosen_storage(storage: str, engine: str) -> Storage:
    """Return how the planes are kept.

    Raises
    ------
    ParameterError : an unknown storage, or ``compact`` with the reference, which knows floats only
    """
    if storage not in STORAGES:
        raise ParameterError(f"storage {storage!r}: must be one of {', '.join(STORAGES)}")
    if storage == "compact" and engine == "reference":
        raise ParameterError("storage 'compact': is the robot's arithmetic: must go with engine 'core'")
    return "compact" if storage == "compact" else "float"


class Network:
    """The four neurons and their decision, from luminance frames.

    Parameters
    ----------
    params : the settings, for example ``preset("published")``; the default preset where nothing is given
    engine : ``core`` (C), ``reference`` (NumPy), or ``auto``: the core where it was built
    scale_kernels : let the kernels grow with pictures wider than 99 px, see ``model.scaling``
    storage : ``float``, or ``compact``: the robot's arithmetic, with pictures in bytes and all other planes as 16-bit
        floats; float pictures are rounded to whole grey levels

    The first frame sets the size; ``reset`` forgets it.
    """

    def __init__(
        self,
        params: NetworkParams | None = None,
        *,
        engine: str = "auto",
        scale_kernels: bool = False,
        storage: str = "float",
    ) -> None:
        if not isinstance(params, NetworkParams | None):
            raise ParameterError(f'Network: params = {params!r}: must be NetworkParams, such as lobula.preset("paper")')
        self.params = preset() if params is None else params
        self.scale_kernels = scale_kernels
        self.engine = chosen_engine(engine)
        self.storage = chosen_storage(storage, self.engine)
        self.reset()

    def reset(self) -> None:
        """Return to before the first frame, of any size."""
        self.shape: tuple[int, int] | None = None
        self._streams: list[CoreNetwork | ReferenceNetwork] = []
        self._last_s: list[float | None] = []
        self._frames: list[int] = []

    def step(
        self,
        image: NDArray[Any] | Frame,
        time_s: float | None = None,
        *,
        turning: bool = False,
        yaw_rate_deg_s: float | None = None,
        taps: Collection[str] = (),
    ) -> Reading:
        """Advance by one frame and return what the network says of it.

        Parameters
        ----------
        image : (H, W) luminance 0..255, uint8 or float; or a ``Frame``, which brings its time
        time_s : the frame's own stamp, s, later than the one before
        turning : the camera itself turns: nothing is decided meanwhile
        yaw_rate_deg_s : says the same where it is larger than ``decision.turning_deg_s``
        taps : maps to return with the reading, of ``model.network.TAPS``

        Raises
        ------
        ShapeError : an image that the network does not read, or of another size than the first
        TimeError : a time that does not increase
        ParameterError : an unknown tap, or a yaw rate that is no finite number
        """
        if isinstance(image, Frame):
            time_s, image = image.time_s, image.image
        if type(image) is not np.ndarray or image.dtype is not UINT8 or image.shape != self.shape:
            image = self._checked(image)
        if not self._streams:
            self._start(image.shape, 1)
        elif len(self._streams) > 1:
            raise ParameterError(
                f"Network.step: the network runs {len(self._streams)} streams: must be one; reset() starts anew"
            )
        last_s = self._last_s[0]
        if type(time_s) is not float or last_s is None or not last_s < time_s < np.inf:
            if time_s is None:
                raise TimeError("Network.step: time_s is missing: must be the frame's stamp in seconds")
            time_s = require_later(time_s, last_s, "Network.step")
        if taps:
            _require_taps(taps)
        if yaw_rate_deg_s is not None:
            if not (isinstance(yaw_rate_deg_s, Real) and math.isfinite(yaw_rate_deg_s)):
                raise ParameterError(f"Network.step: yaw_rate_deg_s = {yaw_rate_deg_s!r}: must be a finite number")
            turning = turning or abs(yaw_rate_deg_s) > self.params.decision.turning_deg_s
        reading = self._streams[0].step(image, time_s, turning=turning, taps=taps)
        self._last_s[0] = time_s
        self._frames[0] += 1
        return reading

    def run(
        self,
        images: NDArray[Any],
        times_s: NDArray[np.float64] | Sequence[float],
        *,
        turning: NDArray[np.bool_] | Sequence[bool] | None = None,
        threads: int = 1,
    ) -> NDArray[Any]:
        """Advance by a block of frames, the fast way; the same numbers as ``step`` on each.

        Parameters
        ----------
        images : (T, H, W), or (S, T, H, W) for S streams that know nothing of each other, luminance 0..255
        times_s : (T,), or (S, T); (T,) serves all streams
        turning : the same shape as ``times_s``
        threads : streams to work on at the same time

        Returns
        -------
        A table, TRACE_DTYPE, (T,) or (S, T). ``frame`` counts from the first frame since the start or ``reset``: a
        movie in several blocks gives the same table as in one.

        Raises
        ------
        ShapeError, TimeError : as ``step``; nothing has been taken in then
        """
        images = require_images(images, (3, 4), "Network.run")
        block = images if images.ndim == 4 else images[None]
        count, length = block.shape[:2]
        shape = (int(block.shape[2]), int(block.shape[3]))
        if self.shape is None:
            for stream in block:
                require_not_unit_range(stream[0], "Network.run")
        elif shape != self.shape:
            raise ShapeError(
                f"Network.run: {shape[1]} x {shape[0]} px after {self.shape[1]} x {self.shape[0]} (width "
                "x height): every frame must have the size of the first; reset() starts anew"
            )
        if threads < 1:
            raise ParameterError(f"Network.run: threads = {threads}: must be at least 1")
        times = _per_frame(times_s, np.float64, count, length, images.ndim, "times_s")
        turns = None if turning is None else _per_frame(turning, np.bool_, count, length, images.ndim, "turning")
        fresh = len(self._streams) != count
        for i in range(count):
            _require_increasing(times[i], None if fresh else self._last_s[i])
        if fresh:
            self._start(shape, count)
        trace = np.empty((count, length), TRACE_DTYPE)
        if self.engine == "core" and count > 1 and threads > 1:
            from concurrent.futures import ThreadPoolExecutor  # a third of the start-up, and seldom needed

            with ThreadPoolExecutor(min(threads, count)) as pool:
                lanes = [range(i, count, threads) for i in range(min(threads, count))]
                list(pool.map(lambda lane: self._run_streams(lane, block, times, turns, trace), lanes))
        else:
            self._run_streams(range(count), block, times, turns, trace)
        return trace if images.ndim == 4 else trace[0]

    def state_dict(self) -> StateDict:
        """Return a copy of everything the network remembers, as plain arrays and numbers; ready for ``numpy.savez``.

        Raises
        ------
        ParameterError : before the first frame, or with several streams
        """
        if len(self._streams) != 1:
            raise ParameterError(f"Network.state_dict: {len(self._streams)} streams: must have taken in frames of one")
        return {**self._streams[0].state_dict(), "frames": self._frames[0]}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Continue from a ``state_dict`` of either engine, made with the same settings.

        Raises
        ------
        ParameterError, ShapeError : an entry that is missing or of the wrong size
        """
        for name in ("luma", "frames"):
            if name not in state:
                raise ParameterError(f"Network.load_state_dict: no entry {name!r}: must be what state_dict() returned")
        luma = require_images(np.asarray(state["luma"], np.float32), (2,), "Network.load_state_dict: luma")
        state = {name: value.item() if np.ndim(value) == 0 and hasattr(value, "item") else value
                 for name, value in state.items()}  # fmt: skip
        self._start((int(luma.shape[0]), int(luma.shape[1])), 1)
        self._streams[0].load_state_dict(state)
        self._frames[0] = int(state["frames"])
        self._last_s[0] = None if np.isnan(state["frame_s"]) else float(state["frame_s"])

    def snapshot(self) -> StateDict:
        """Return a copy of everything the network remembers, three times as quickly as ``state_dict``.

        Also before the first frame. Plain arrays and numbers, for this build of lobula on this kind of processor only.

        Raises
        ------
        ParameterError : with several streams
        """
        if not self._streams:
            return {}
        stream = self._streams[0]
        if len(self._streams) > 1 or not isinstance(stream, CoreNetwork):
            return self.state_dict()
        height, width = stream.shape
        return {
            "block": stream.block(), "height": height, "width": width, "frames": self._frames[0],
            "last_s": self._last_s[0],
        }  # fmt: skip

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        """Continue from a ``snapshot`` made with the same settings.

        Raises
        ------
        ParameterError : it was made by another engine, storage or build
        """
        if not snapshot:
            self.reset()
        elif "block" not in snapshot:
            self.load_state_dict(snapshot)
        elif self.engine != "core":
            raise ParameterError("Network.restore: a snapshot of engine 'core': must be one of 'reference'")
        else:
            shape = (int(snapshot["height"]), int(snapshot["width"]))
            if self.shape != shape or len(self._streams) != 1:
                self._start(shape, 1)
            cast(CoreNetwork, self._streams[0]).put_block(snapshot["block"])
            last_s = snapshot["last_s"]
            self._frames[0], self._last_s[0] = int(snapshot["frames"]), None if last_s is None else float(last_s)

    def _checked(self, given: NDArray[Any]) -> NDArray[Any]:
        shape = self.shape
        if type(given) is np.ndarray and given.dtype == FLOAT32 and given.shape == shape and len(self._streams) == 1:
            stream = self._streams[0]
            if isinstance(stream, CoreNetwork) and stream.in_range(given):
                return given
        image = require_images(given, (2,), "Network.step")
        if shape is None:
            require_not_unit_range(image, "Network.step")
        elif image.shape != shape:
            raise ShapeError(
                f"Network.step: {image.shape[1]} x {image.shape[0]} px after {shape[1]} x {shape[0]} "
                "(width x height): every frame must have the size of the first; reset() starts anew"
            )
        return image

    def _start(self, shape: tuple[int, ...], streams: int) -> None:
        height, width = shape
        self.shape = (height, width)
        params = scaled(self.params, width) if self.scale_kernels else self.params
        if self.engine == "core":
            workspace = Workspace(params, self.shape, self.storage)
            self._streams = [
                CoreNetwork(params, self.shape, workspace=workspace, storage=self.storage) for _ in range(streams)
            ]
        else:
            self._streams = [ReferenceNetwork(params, self.shape) for _ in range(streams)]
        self._last_s = [None] * streams
        self._frames = [0] * streams

    def _run_streams(
        self, which: range, block: NDArray[Any], times: NDArray[np.float64], turns: NDArray[np.bool_] | None,
        trace: NDArray[Any],
    ) -> None:  # fmt: skip
        """Take each stream through all its frames before the next: its state stays in the cache."""
        workspace: Workspace | None = None
        for i in which:
            stream = self._streams[i]
            turn = None if turns is None else turns[i]
            if isinstance(stream, CoreNetwork):
                workspace = workspace or (
                    Workspace(stream.p, stream.shape, stream.storage) if len(which) < len(block) else None
                )
                if workspace is not None:
                    stream.use(workspace)
                trace[i] = stream.run_block(block[i], times[i], turn)
            else:
                trace[i] = _run_reference(stream, block[i], times[i], turn)
            trace[i]["frame"] += self._frames[i]
            self._frames[i] += block.shape[1]
            self._last_s[i] = float(times[i, -1])


def _run_reference(
    stream: ReferenceNetwork, images: NDArray[Any], times_s: NDArray[np.float64], turning: NDArray[np.bool_] | None
) -> NDArray[Any]:
    trace = np.empty(len(images), TRACE_DTYPE)
    for t, image in enumerate(images):
        r = stream.step(image, float(times_s[t]), turning=turning is not None and bool(turning[t]))
        potentials = tuple(getattr(r, name) for name in NEURONS)
        trace[t] = (t, r.time_s, *potentials, *r.spikes, r.collision, r.state)
    return trace


def _per_frame(values: Any, dtype: Any, streams: int, length: int, ndim: int, name: str) -> NDArray[Any]:
    a = np.asarray(values, dtype)
    if a.shape != (length,) and (ndim == 3 or a.shape != (streams, length)):
        wanted = f"({length},)" if ndim == 3 else f"({length},) or ({streams}, {length})"
        raise ShapeError(f"Network.run: {name} has shape {a.shape}: must be {wanted}, one for each frame")
    return np.broadcast_to(a, (streams, length))


def _require_increasing(times_s: NDArray[np.float64], last_s: float | None) -> None:
    before = times_s[0] - 1.0 if last_s is None else last_s
    steps = np.diff(times_s, prepend=before)
    if not (np.isfinite(times_s).all() and (steps > 0).all()):
        wrong = int(np.argmin(np.isfinite(times_s) & (steps > 0)))
        previous = last_s if wrong == 0 else float(times_s[wrong - 1])
        require_later(float(times_s[wrong]), previous, f"Network.run: frame {wrong}")


def _require_taps(taps: Collection[str]) -> None:
    if isinstance(taps, str):
        raise ParameterError(f"Network.step: taps = {taps!r}: must be a list of names, such as ({taps!r},)")
    for name in taps:
        if name not in TAPS:
            raise ParameterError(f"Network.step: unknown tap {name!r}: must be of {', '.join(TAPS)}")
