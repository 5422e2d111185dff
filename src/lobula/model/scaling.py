"""Kernels for pictures wider than the ones they were made for."""

from __future__ import annotations

from dataclasses import replace

from .network import NetworkParams

DESIGN_WIDTH = 99
"""Width of the paper's camera, px, for which the kernels are given."""


def scaled(params: NetworkParams, width: int) -> NetworkParams:
    """Return ``params`` with kernels that cover the same part of a picture ``width`` px wide.

    With s = width / 99, rounded and at least 1: radius and sigma of the DoG, the spans of the EMDs, the distance
    of the neighbours in inhibition and grouping and the coarse patches, all in px, times s. Nothing else changes.

    Raises
    ------
    ParameterError : a kernel that would grow beyond its range
    """
    s = max(1, round(width / DESIGN_WIDTH))
    if s == 1:
        return params
    dog, emd = params.lamina.dog, params.lptc.emd
    dog = replace(dog, radius_px=s * dog.radius_px, sigma_px=s * dog.sigma_px)
    emd = replace(emd, spans_px=tuple(s * span for span in emd.spans_px))
    lgmd1, lgmd2 = (replace(q, neighbour_px=s * q.neighbour_px) for q in (params.lgmd1, params.lgmd2))
    return replace(
        params,
        lamina=replace(params.lamina, dog=dog),
        lptc=replace(params.lptc, emd=emd),
        lgmd1=lgmd1,
        lgmd2=lgmd2,
        coarse=replace(params.coarse, patch_px=s * params.coarse.patch_px),
    )
