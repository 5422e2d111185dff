"""The network tuned on OpenCV: every pass is one call into a reused buffer, and neighbours are summed once.

Low-pass and 3 x 3 filter commute, so the sums over a cell's neighbours are made once for both LGMDs; what follows them
is cell by cell. ``opencv_folded`` goes further.

As in the NumPy baseline, flashes, repeated frames, the decision's window and frames off the model clock are left out,
which favours this baseline.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lobula.model.lamina.dog import gaussian_kernel
from lobula.model.medulla.lateral_inhibition import InhibitionParams
from lobula.model.network import NetworkParams
from lobula.model.neurons.lgmd import LgmdParams

from .neurons import Neurons, Potentials

Map = NDArray[np.float32]

EDGE = cv2.BORDER_REPLICATE
NEAREST = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], np.float32)
POSITIVE = cv2.THRESH_TOZERO


class OpencvNetwork:
    """One stream. For presets whose LGMDs read the change, at neighbour distance 1, with every mechanism on."""

    def __init__(self, p: NetworkParams, shape: tuple[int, int]) -> None:
        self.p = p
        dog = p.lamina.dog
        self.inner = gaussian_kernel(dog.radius_px, dog.sigma_px)
        self.outer = gaussian_kernel(dog.radius_px * dog.surround, dog.sigma_px * dog.surround)
        self.residual = p.lamina.on_off.residual
        self.neurons = Neurons(p, shape[0] * shape[1])
        self.started = False
        dt_ms = p.clock.period_ms
        self.rise_share = _kept(p.lamina.fdsr.rise_ms, dt_ms)
        self.span_shares = [_kept(tau, dt_ms) for tau in p.lptc.emd.delays_ms]
        self.inhibition = [[_ring_weights(q, dt_ms) for q in (lgmd.on, lgmd.off)] for lgmd in self.neurons.lgmds]

        def maps(*count: int) -> Map:
            return np.zeros((*count, *shape), np.float32)

        self.luma, self.before, self.change, self.e, self.i, self.work, self.mean = maps(7)
        self.mask, self.other = np.empty((2, *shape), np.uint8)
        self.halves = maps(2)
        self.channels, self.channels_before = maps(2), maps(2)
        self.adapted, self.adapted_before = maps(2), maps(2)
        self.sums = maps(2, 2, 3)  # channel, step (the two take turns), map: itself, its 3 x 3 sum, its nearest four
        self.phase = 0
        self.on, self.off = maps(2)

    def step(self, image: NDArray[Any], time_s: float) -> Potentials:
        """Advance by one frame, (H, W) luminance 0..255; frames are one tick of the model clock apart."""
        self.luma, self.before = self.before, self.luma
        np.copyto(self.luma, image)
        if not self.started:
            self.started = True
            return Potentials(0.5, 0.5, 0.0, 0.0, (0, 0, 0, 0))
        cv2.subtract(self.luma, self.before, dst=self.change)
        arousal = self.neurons.arousal(cv2.norm(self.change, cv2.NORM_L1) / self.change.size)
        self._difference_of_gaussians()
        net_motion = self._net_motion()
        self._excite()
        return self.neurons.step(self._lgmds(arousal), net_motion)

    def _difference_of_gaussians(self) -> None:
        """Write [LA]+ and [-LA]+."""
        e, i, (on, off) = self.e, self.i, self.halves
        cv2.sepFilter2D(self.change, -1, self.inner, self.inner, dst=e, borderType=EDGE)
        cv2.sepFilter2D(self.change, -1, self.outer, self.outer, dst=i, borderType=EDGE)
        cv2.absdiff(e, i, dst=self.work)
        dead_zone = np.float32(self.p.lamina.dog.dead_zone_grey)
        zero = np.float32(0)
        self.halves.fill(0)
        mask, other = self.mask.view(np.bool_), self.other.view(np.bool_)
        np.greater_equal(e, dead_zone, out=mask)
        np.greater_equal(i, zero, out=other)
        cv2.copyTo(self.work, cv2.bitwise_and(self.mask, self.other, dst=self.mask), on)
        np.less_equal(e, -dead_zone, out=mask)
        np.less(i, zero, out=other)
        cv2.copyTo(self.work, cv2.bitwise_and(self.mask, self.other, dst=self.mask), off)

    def _channels(self) -> Iterator[tuple[Map, Map, Map, Map]]:
        """Advance the lamina's ON and OFF; yield each with its past, and the maps of its adaptation, now and past."""
        self.channels, self.channels_before = self.channels_before, self.channels
        self.adapted, self.adapted_before = self.adapted_before, self.adapted
        for half, now, before, m, m_before in zip(
            self.halves, self.channels, self.channels_before, self.adapted, self.adapted_before, strict=True
        ):
            cv2.scaleAdd(before, self.residual, half, dst=now)
            yield now, before, m, m_before

    def _net_motion(self) -> float:
        """Return the sum of every correlator, rightward positive."""
        total = 0.0
        for now, before, m, m_before in self._channels():
            cv2.addWeighted(now, self.rise_share, before, -self.rise_share, 0.0, dst=m)
            cv2.threshold(m, 0, 0, POSITIVE, dst=m)
            for span, share in zip(self.p.lptc.emd.spans_px, self.span_shares, strict=True):
                left, right, work = m[:, :-span], m[:, span:], self.work[:, span:]
                cv2.multiply(m_before[:, :-span], right, dst=work)
                rightward = cv2.sumElems(work)[0]
                cv2.multiply(left, m_before[:, span:], dst=work)
                total += share * (rightward - cv2.sumElems(work)[0])
        return total

    def _excite(self) -> None:
        """Advance the LGMDs' channels and sum their neighbours."""
        before, self.phase = self.phase, 1 - self.phase
        cv2.threshold(self.change, 0, 0, POSITIVE, dst=self.halves[0])
        cv2.subtract(self.halves[0], self.change, dst=self.halves[1])
        for half, sums in zip(self.halves, self.sums, strict=True):
            channel, square, nearest = sums[self.phase]
            cv2.scaleAdd(sums[before, 0], self.residual, half, dst=channel)
            cv2.boxFilter(channel, -1, (3, 3), dst=square, normalize=False, borderType=EDGE)
            cv2.filter2D(channel, -1, NEAREST, dst=nearest, borderType=EDGE)

    def _lgmds(self, arousal: tuple[float, float]) -> tuple[float, float]:
        """Return the sums of the grouped cells of both."""
        totals = []
        for k, p in enumerate(self.neurons.lgmds):
            for c, (branch, out) in enumerate(((p.on, self.on), (p.off, self.off))):
                self._branch(c, max(branch.bias, arousal[k]), self.inhibition[k][c], out)
            totals.append(group(p, self.on, self.off, self.work, self.mean))
        return totals[0], totals[1]

    def _branch(self, channel: int, bias: float, weights: list[float], out: Map) -> None:
        """Write [E - w I]+ of one channel."""
        now, before = self.sums[channel, self.phase], self.sums[channel, 1 - self.phase]
        own, *others = ((-bias * a, -bias * b) for a, b in zip(weights[:3], weights[3:], strict=True))
        cv2.addWeighted(now[0], 1.0 + own[0], before[0], own[1], 0.0, dst=out)
        for x, x_before, (a, b) in zip(now[1:], before[1:], others, strict=True):
            cv2.addWeighted(x, a, x_before, b, 0.0, dst=self.work)
            cv2.add(out, self.work, dst=out)
        cv2.threshold(out, 0, 0, POSITIVE, dst=out)


def _kept(tau_ms: float, dt_ms: float) -> float:
    """Return the share of the step before in a low-pass."""
    return tau_ms / (dt_ms + tau_ms)


def _ring_weights(p: InhibitionParams, dt_ms: float) -> list[float]:
    """Return the weights of I on the three maps now, then one step ago."""
    rings = ((p.centre_weight, p.centre_ms), (p.nearest_weight, p.nearest_ms), (p.diagonal_weight, p.diagonal_ms))
    past = [w * _kept(tau, dt_ms) for w, tau in rings]
    steps = ([w - b for (w, _), b in zip(rings, past, strict=True)], past)
    # The 3 x 3 sum brings the diagonals, but the centre and the nearest too.
    return [x for centre, nearest, diagonal in steps for x in (centre - diagonal, diagonal, nearest - diagonal)]


def group(p: LgmdParams, on: Map, off: Map, s: Map, mean: Map) -> float:
    """Return the sum of the grouped cells; ``s`` and ``mean`` are written over."""
    if p.on_gain == p.off_gain == 1.0:
        cv2.add(on, off, dst=s)
    else:
        cv2.addWeighted(on, p.on_gain, off, p.off_gain, 0.0, dst=s)
    if p.product_gain:
        cv2.multiply(on, off, dst=mean, scale=p.product_gain)
        cv2.add(s, mean, dst=s)
    cv2.boxFilter(s, -1, (3, 3), dst=mean, normalize=True, borderType=EDGE)
    omega = p.grouping.floor_grey + cv2.norm(mean, cv2.NORM_INF) / p.grouping.divisor
    cv2.multiply(s, mean, dst=s)
    cv2.threshold(s, p.grouping.threshold_grey * omega, 0, POSITIVE, dst=s)
    return float(cv2.sumElems(s)[0]) / omega
