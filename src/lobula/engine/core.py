"""The network through the C core: same methods, same results, interchangeable state."""

from __future__ import annotations

import ctypes
import math
import struct
from collections.abc import Collection, Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..model.network import TAPS, NetworkParams
from ..model.state import NUMBERS, PLANES, TIMES, StateDict, check_state
from ..types import NEURONS, STATES, TRACE_DTYPE, Image, Reading, Spikes
from .library import isa_index, library
from .structures import Images, Net, Scalars, core_params

ALIGN = 64
Storage = Literal["float", "compact"]
STORAGES: tuple[Storage, ...] = ("float", "compact")
"""In the core's order. ``compact`` keeps the luma in bytes and all other planes as 16-bit floats, as a robot does."""
UINT8, FLOAT32 = np.dtype(np.uint8), np.dtype(np.float32)
TYPES = {UINT8: 0, FLOAT32: 1}
COPIED_BYTES = 1 << 18
"""Up to this size a picture is copied to a fixed place: cheaper than asking NumPy where it lies."""

READING = struct.Struct("=5d6i")
UNPACK_READING, NEW = READING.unpack, tuple.__new__

READING_DTYPE = np.dtype(
    [("time_s", np.float64), *((name, np.float64) for name in NEURONS), ("spikes", np.int32, 4),
     ("collision", np.int32), ("state", np.int32)]
)  # fmt: skip
"""``lobula_reading``."""

STATE_NAMES = np.array(STATES)

HEADER_BYTES = 16
"""Start of a state: magic number, ABI, instruction set and storage, the same for all that are exchangeable."""


class Memory:
    """``size`` bytes aligned for the core, and their address."""

    def __init__(self, size: int) -> None:
        self.size = size
        self._bytes = np.empty(size + ALIGN, np.uint8)
        self.address = -(-self._bytes.ctypes.data // ALIGN) * ALIGN


class Workspace(Memory):
    """What a network needs while it works; networks that take turns on one thread can share one."""

    def __init__(self, params: NetworkParams, shape: tuple[int, int], storage: Storage = "float") -> None:
        height, width = shape
        settings, core, kept = core_params(params), library(), STORAGES.index(storage)
        self.frames = int(core.lobula_block_frames(settings, width, height, kept))
        super().__init__(core.lobula_workspace_size(settings, width, height, kept, self.frames))


class CoreNetwork:
    """The network in C. ``step`` takes luminance (H, W), uint8 or float32 in 0..255, already checked.

    With ``storage`` ``compact`` floats are rounded to whole grey levels first.
    """

    def __init__(
        self,
        p: NetworkParams,
        shape: tuple[int, int],
        *,
        workspace: Workspace | None = None,
        storage: Storage = "float",
    ) -> None:
        self.p = p
        self.shape = height, width = shape
        self._core = library()
        self.storage: Storage = storage
        settings, kept = core_params(p), STORAGES.index(storage)
        self._state = Memory(self._core.lobula_state_size(settings, width, height, kept))
        self._net = Net(state=self._state.address)
        self.use(workspace or Workspace(p, shape, storage))
        if self._core.lobula_init(self._state.address, settings, width, height, kept, isa_index()):
            raise RuntimeError(f"the C core refuses {width} x {height} px with these settings")
        self._stages = {dtype: np.empty(shape, dtype) for dtype in TYPES}
        self._staged = {
            dtype: Images(pixels=stage.ctypes.data, row_bytes=stage.strides[0], type=TYPES[dtype])
            for dtype, stage in self._stages.items()
        }
        self._refs = {dtype: ctypes.byref(images) for dtype, images in self._staged.items()}
        self._copied = math.prod(shape) <= COPIED_BYTES
        self._reading = bytearray(READING.size)
        self._net_at = ctypes.addressof(self._net)
        # Arguments made once and a function that does not convert them: the call costs half.
        self._step = self._core["lobula_step"]
        self._time_s = ctypes.c_double()
        self._net_ref = ctypes.byref(self._net)
        self._reading_ref = ctypes.byref((ctypes.c_char * READING.size).from_buffer(self._reading))

    def use(self, workspace: Workspace) -> None:
        """Work in ``workspace`` from now on."""
        self._workspace = workspace
        self._net.workspace = workspace.address

    def reset(self) -> None:
        """Return to before the first frame."""
        self._core.lobula_reset(self._state.address)

    def in_range(self, image: NDArray[np.float32]) -> bool:
        """Whether all of ``image`` (H, W) lies in 0..255, told in one quick look; a doubtful case says no."""
        height, width = self.shape
        if self._copied:
            self._stages[FLOAT32][...] = image
            return bool(self._core.lobula_in_range(self._refs[FLOAT32], width, height))
        image, pictures = _images(image[None])
        return bool(self._core.lobula_in_range(ctypes.byref(pictures), width, height))

    def step(self, image: NDArray[Any], time_s: float, *, turning: bool = False, taps: Collection[str] = ()) -> Reading:
        """Advance by one frame. ``turning`` says that the camera itself turns: nothing is decided meanwhile."""
        if self.storage == "compact" and image.dtype != UINT8:
            image = _whole_grey(image)
        dtype = image.dtype
        if self._copied:
            self._stages[dtype][...] = image
            at: Any = self._refs[dtype]
        else:
            image, pictures = _images(image[None])
            at = ctypes.byref(pictures)
        maps = {name: np.empty(self.shape, np.float32) for name in taps} if taps else {}
        pointers = _pointers(maps) if taps else None
        self._time_s.value = time_s
        status = self._step(self._net_ref, at, self._time_s, 1 if turning else 0, self._reading_ref, pointers)
        if status:
            raise RuntimeError(f"the C core failed with code {status}")
        # Name by name, and without the detour of Reading(...) through Python: half the cost.
        now_s, lgmd1, lgmd2, lptc_r, lptc_l, s1, s2, s3, s4, collision, state = UNPACK_READING(self._reading)
        spikes = NEW(Spikes, (s1, s2, s3, s4))
        return NEW(Reading, (now_s, lgmd1, lgmd2, lptc_r, lptc_l, spikes, collision != 0, STATES[state], maps))

    def run_block(
        self, images: NDArray[Any], times_s: NDArray[np.float64], turning: NDArray[np.bool_] | None = None
    ) -> NDArray[Any]:
        """Advance by all of ``images`` (T, H, W) and return their readings, TRACE_DTYPE (T,); ``frame`` counts from 0.

        The same numbers as ``step`` on each in turn. Other Python threads run meanwhile.
        """
        count = len(images)
        if self.storage == "compact" and images.dtype != UINT8:
            images = _whole_grey(images)
        images, pictures = _images(images)
        times_s = np.ascontiguousarray(times_s, np.float64)
        turns = None if turning is None else np.ascontiguousarray(turning, np.uint8)
        readings = np.empty(count, READING_DTYPE)
        status = self._core.lobula_run(
            self._net_at, ctypes.byref(pictures), times_s.ctypes.data, None if turns is None else turns.ctypes.data,
            count, self._workspace.frames, readings.ctypes.data,
        )  # fmt: skip
        if status:
            raise RuntimeError(f"the C core failed with code {status}")
        return _trace(readings)

    def block(self) -> NDArray[np.uint8]:
        """Return a copy of everything it remembers as the core holds it, in one piece."""
        return np.frombuffer(ctypes.string_at(self._state.address, self._state.size), np.uint8)

    def put_block(self, block: NDArray[np.uint8]) -> None:
        """Continue from a ``block`` of a network with the same settings and size.

        Raises
        ------
        ParameterError : it comes from another build, processor, storage or size
        """
        block = np.ascontiguousarray(block, np.uint8)
        own = ctypes.string_at(self._state.address, HEADER_BYTES)
        if block.shape != (self._state.size,) or block[:HEADER_BYTES].tobytes() != own:
            raise ParameterError("the state of a network: was saved by another build, processor, storage or image size")
        ctypes.memmove(self._state.address, block.ctypes.data, self._state.size)

    def state_dict(self) -> StateDict:
        """Return a copy of everything it remembers; ``model.state.NAMES`` lists the entries."""
        state: StateDict = {}
        for number, name in enumerate(PLANES):
            state[name] = np.empty(self.shape, np.float32)
            self._core.lobula_get_plane(self._state.address, number, state[name].ctypes.data)
        now = Scalars()
        self._core.lobula_get_scalars(self._state.address, now)
        known = {"frame_s": now.has_frame, "turned_s": now.has_turned,
                 "held_s": now.has_held}  # fmt: skip
        state |= {name: getattr(now, name) if known.get(name, True) else math.nan for name in TIMES}
        numbers = [bool(now.still), bool(now.flashing)]
        for lgmd in (now.lgmd1, now.lgmd2):
            numbers += [lgmd.raw, lgmd.potential, lgmd.change_before]
        state |= dict(zip(NUMBERS, [*numbers, now.rightward, now.leftward], strict=True))
        state["window"] = np.empty((self._core.lobula_window_count(self._state.address), 4), np.float64)
        self._core.lobula_get_window(self._state.address, state["window"].ctypes.data)
        return state

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Continue from a ``state_dict`` of either engine, made with the same settings and size.

        Raises
        ------
        ParameterError, ShapeError : an entry that is missing or of another size
        """
        check_state(state, self.shape)
        for number, name in enumerate(PLANES):
            plane = np.ascontiguousarray(state[name], np.float32)
            self._core.lobula_set_plane(self._state.address, number, plane.ctypes.data)
        now = Scalars(
            still=bool(state["still"]),
            flashing=bool(state["flashing"]),
            rightward=state["lptc_r"],
            leftward=state["lptc_l"],
        )
        for name in TIMES:
            if not math.isnan(state[name]):
                setattr(now, name, float(state[name]))
        now.has_frame, now.has_turned, now.has_held = (
            not math.isnan(state[name]) for name in ("frame_s", "turned_s", "held_s")
        )
        for name, lgmd in (("lgmd1", now.lgmd1), ("lgmd2", now.lgmd2)):
            lgmd.raw, lgmd.potential = state[f"{name}_raw"], state[f"{name}_potential"]
            lgmd.change_before = state[f"{name}_change_before"]
        self._core.lobula_set_scalars(self._state.address, now)
        window = np.ascontiguousarray(state["window"], np.float64)
        window = window[-self._core.lobula_window_capacity(self._state.address) :]
        self._core.lobula_set_window(self._state.address, window.ctypes.data, len(window))


def _whole_grey(images: NDArray[Any]) -> NDArray[np.uint8]:
    """Return what a camera of bytes would give."""
    whole: NDArray[np.uint8] = np.rint(images).astype(np.uint8)
    return whole


def _images(images: NDArray[Any]) -> tuple[NDArray[Any], Images]:
    """Return ``images`` (T, H, W) with the pixels of each row side by side, and where they lie."""
    if images.strides[-1] != images.itemsize:
        images = np.ascontiguousarray(images)
    image_bytes, row_bytes, _ = images.strides
    return images, Images(
        pixels=images.ctypes.data, row_bytes=row_bytes, image_bytes=image_bytes, type=TYPES[images.dtype]
    )


def _pointers(maps: Mapping[str, Image]) -> Any:
    return (ctypes.c_void_p * len(TAPS))(*(maps[name].ctypes.data if name in maps else None for name in TAPS))


def _trace(readings: NDArray[Any]) -> NDArray[Any]:
    trace = np.empty(len(readings), TRACE_DTYPE)
    trace["frame"] = np.arange(len(readings))
    trace["time_s"] = readings["time_s"]
    for i, name in enumerate(NEURONS):
        trace[name] = readings[name]
        trace[f"spikes_{name}"] = readings["spikes"][:, i]
    trace["collision"] = readings["collision"]
    trace["state"] = STATE_NAMES[readings["state"]]
    return trace
