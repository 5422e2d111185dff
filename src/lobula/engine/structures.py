"""The C core's structures, field by field as ``core/include/lobula.h`` has them."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, Structure, c_double, c_int32, c_ssize_t, c_void_p
from dataclasses import fields
from typing import Any

from ..model.network import NetworkParams
from ..params import Params

MAX_SPANS = 8
NOT_IN_CORE = {"origins", "turning_deg_s"}
"""Settings the core has no use for: where a value comes from, and what ``Network`` turns into a flag."""


class ClockParams(Structure):
    _fields_ = [
        (n, c_double)
        for n in (
            "period_ms",
            "change_exponent",
            "max_gap_ms",
            "repeats",
            "repeat_hold_ms",
            "repeat_mean_grey",
            "repeat_max_grey",
        )
    ]


class FlashParams(Structure):
    _fields_ = [
        (n, c_double)
        for n in ("enabled", "min_change_grey", "min_coverage", "trim", "min_explained", "min_gain", "max_gain")
    ]


class SaturationParams(Structure):
    _fields_ = [("enabled", c_double), ("limit_grey", c_double)]


class CoarseParams(Structure):
    _fields_ = [("patch_px", c_double), ("floor_grey", c_double)]


class DogParams(Structure):
    _fields_ = [(n, c_double) for n in ("enabled", "radius_px", "sigma_px", "surround", "dead_zone_grey")]


class OnOffParams(Structure):
    _fields_ = [("residual", c_double)]


class FdsrParams(Structure):
    _fields_ = [("enabled", c_double), ("rise_ms", c_double)]


class LaminaParams(Structure):
    _fields_ = [("dog", DogParams), ("on_off", OnOffParams), ("fdsr", FdsrParams)]


class InhibitionParams(Structure):
    _fields_ = [
        (n, c_double)
        for n in (
            "centre_weight",
            "nearest_weight",
            "diagonal_weight",
            "centre_ms",
            "nearest_ms",
            "diagonal_ms",
            "bias",
        )
    ]


class GroupingParams(Structure):
    _fields_ = [(n, c_double) for n in ("enabled", "threshold_grey", "floor_grey", "divisor")]


class SfaParams(Structure):
    _fields_ = [(n, c_double) for n in ("enabled", "tau_ms", "growth")]


class SpikingParams(Structure):
    _fields_ = [("gain", c_double), ("threshold", c_double)]


class LgmdParams(Structure):
    _fields_ = [
        ("reads", c_double), ("on", InhibitionParams), ("off", InhibitionParams),
        *((n, c_double) for n in (
            "neighbour_px", "change_scale_grey", "change_ms", "on_gain", "off_gain", "product_gain")),
        ("grouping", GroupingParams), ("coarse_gain", c_double), ("coarse_on_weight", c_double),
        ("sigmoid_grey", c_double), ("sfa", SfaParams), ("spiking", SpikingParams),
    ]  # fmt: skip


class EmdParams(Structure):
    _fields_ = [("spans", c_double), ("spans_px", c_double * MAX_SPANS), ("delays_ms", c_double * MAX_SPANS)]


class LptcParams(Structure):
    _fields_ = [("emd", EmdParams), ("sigmoid_grey2", c_double), ("spiking", SpikingParams)]


class DecisionParams(Structure):
    _fields_ = [
        (n, c_double)
        for n in ("neurons", "window_ms", "collision_spikes", "lptc_weight", "end_ms", "warm_up_ms", "after_turn_ms")
    ]


class CoreParams(Structure):
    """``lobula_params``."""

    _fields_ = [
        ("clock", ClockParams), ("flash", FlashParams), ("saturation", SaturationParams), ("coarse", CoarseParams),
        ("lamina", LaminaParams), ("lgmd1", LgmdParams), ("lgmd2", LgmdParams), ("lptc", LptcParams),
        ("decision", DecisionParams),
    ]  # fmt: skip


def core_params(params: NetworkParams) -> CoreParams:
    """Return the settings as the core reads them, matched by name."""
    filled = CoreParams()
    _fill(filled, params)
    filled.lptc.emd.spans = len(params.lptc.emd.spans_px)
    return filled


def _fill(into: Any, params: Params) -> None:
    for f in fields(params):
        if f.name in NOT_IN_CORE:
            continue
        value = getattr(params, f.name)
        if isinstance(value, Params):
            _fill(getattr(into, f.name), value)
        elif isinstance(value, tuple):
            getattr(into, f.name)[: len(value)] = value
        else:
            choices = f.metadata["choices"]
            if f.name not in {name for name, *_ in into._fields_}:
                raise AttributeError(f"the C core has no setting {type(params).__name__}.{f.name}")
            setattr(into, f.name, choices.index(value) if choices else value)


class Images(Structure):
    """``lobula_images``: where one picture or a block of them lies."""

    _fields_ = [
        ("pixels", c_void_p), ("row_bytes", c_ssize_t), ("image_bytes", c_ssize_t), ("type", c_int32),
        ("reserved", c_int32),
    ]  # fmt: skip


class Net(Structure):
    """``lobula_net``: the memory of one network."""

    _fields_ = [("state", c_void_p), ("workspace", c_void_p)]


class LgmdScalars(Structure):
    _fields_ = [("raw", c_double), ("potential", c_double), ("change_before", c_double)]


class Scalars(Structure):
    """``lobula_scalars``."""

    _fields_ = [
        *((n, c_double) for n in ("frame_s", "tick_s", "step_s", "started_s", "turned_s", "held_s")),
        *((n, c_int32) for n in ("has_frame", "has_turned", "has_held", "still", "flashing")),
        ("lgmd1", LgmdScalars), ("lgmd2", LgmdScalars), ("rightward", c_double), ("leftward", c_double),
    ]  # fmt: skip


class ResizeSpec(Structure):
    """``lobula_resize_spec``."""

    _fields_ = [
        *((n, c_int32) for n in (
            "source_width", "source_height", "crop_x", "crop_y", "crop_width", "crop_height", "out_width",
            "out_height")),
        ("gain", c_double), ("offset", c_double),
    ]  # fmt: skip


SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "lobula_abi": (ctypes.c_int, []),
    "lobula_params_size": (ctypes.c_size_t, []),
    "lobula_isa_name": (ctypes.c_char_p, [ctypes.c_int]),
    "lobula_isa_runs": (ctypes.c_int, [ctypes.c_int]),
    "lobula_isa_best": (ctypes.c_int, []),
    "lobula_state_size": (ctypes.c_size_t, [POINTER(CoreParams), *[ctypes.c_int] * 3]),
    "lobula_workspace_size": (ctypes.c_size_t, [POINTER(CoreParams), *[ctypes.c_int] * 4]),
    "lobula_block_frames": (ctypes.c_int, [POINTER(CoreParams), *[ctypes.c_int] * 3]),
    "lobula_init": (ctypes.c_int, [c_void_p, POINTER(CoreParams), *[ctypes.c_int] * 4]),
    "lobula_reset": (ctypes.c_int, [c_void_p]),
    "lobula_step": (ctypes.c_int, [c_void_p, c_void_p, c_double, ctypes.c_int, c_void_p, c_void_p]),
    "lobula_run": (ctypes.c_int, [c_void_p, c_void_p, c_void_p, c_void_p, ctypes.c_int64, ctypes.c_int, c_void_p]),
    "lobula_in_range": (ctypes.c_int, [c_void_p, ctypes.c_int, ctypes.c_int]),
    "lobula_get_plane": (ctypes.c_int, [c_void_p, ctypes.c_int, c_void_p]),
    "lobula_set_plane": (ctypes.c_int, [c_void_p, ctypes.c_int, c_void_p]),
    "lobula_get_scalars": (ctypes.c_int, [c_void_p, POINTER(Scalars)]),
    "lobula_set_scalars": (ctypes.c_int, [c_void_p, POINTER(Scalars)]),
    "lobula_window_capacity": (ctypes.c_int, [c_void_p]),
    "lobula_window_count": (ctypes.c_int, [c_void_p]),
    "lobula_get_window": (ctypes.c_int, [c_void_p, c_void_p]),
    "lobula_set_window": (ctypes.c_int, [c_void_p, c_void_p, ctypes.c_int]),
    "lobula_resize_size": (ctypes.c_size_t, [POINTER(ResizeSpec)]),
    "lobula_resize_init": (ctypes.c_int, [c_void_p, POINTER(ResizeSpec), ctypes.c_int]),
    "lobula_resize": (ctypes.c_int, [c_void_p, c_void_p, c_void_p]),
}
"""Result and arguments of every function of the core."""
