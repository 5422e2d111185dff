"""The network tuned on OpenCV: every pass is one call into a reused buffer, and algebra saves passes.

The algebra changes nothing but rounding:

- [E - w I]+ needs three maps of a channel, now and one step ago: the channel, its 3 x 3 sum, and the sum over the four
  nearest cells. They are made once for both LGMDs; each [E - w I] is then one row of weights on six maps.
- Branches that come out alike, such as the OFF branches of both LGMDs, are computed once.
- The scale of the adaptation is a factor of the net motion, and is applied there.
- All spans of Eq. (3) together are the sum of M' (k * M), M' being M one step ago and zero outside the picture, where
  the antisymmetric kernel k holds the share of a span at +d and its negative at -d: one filter and one dot product.

As in the NumPy baseline, flashes, repeated frames, the decision's window and frames off the model clock are left out,
which favours this baseline.
"""

from __future__ import annotations

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

EDGE, ZERO = cv2.BORDER_REPLICATE, cv2.BORDER_CONSTANT
NEAREST = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], np.float32)
POSITIVE = cv2.THRESH_TOZERO


class OpencvNetwork:
    """One stream. For presets whose LGMDs read the change, at neighbour distance 1, with every mechanism on."""

    def __init__(self, p: NetworkParams, shape: tuple[int, int]) -> None:
        self.p = p
        dog = p.lamina.dog
        self.inner = gaussian_kernel(dog.radius_px, dog.sigma_px)
        self.outer = gaussian_kernel(dog.radius_px * dog.surround, dog.sigma_px * dog.surround)
        self.neurons = Neurons(p, shape[0] * shape[1])
        self.started = False
        self._prepare(p.clock.period_ms)

        def maps(*count: int) -> Map:
            return np.zeros((*count, *shape), np.float32)

        self.luma, self.before, self.change, self.e, self.i, self.work, self.mean = maps(7)
        self.mask, self.other = np.empty((2, *shape), np.uint8)
        self.halves = maps(2)
        self.channels, self.channels_before = maps(2), maps(2)
        self.adapted, self.adapted_before = maps(2), maps(2)
        self.sums = maps(2, 2, 3)  # channel, step (the two take turns), map
        self.phase = 0
        self.branches = maps(2, 2)  # channel, LGMD

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

    def _prepare(self, dt_ms: float) -> None:
        """Work out the weights and kernels."""
        self.residual = self.p.lamina.on_off.residual
        rise_ms = self.p.lamina.fdsr.rise_ms
        self.rise_share = rise_ms / (dt_ms + rise_ms)
        emd = self.p.lptc.emd
        widest = max(emd.spans_px)
        self.emd_kernel = np.zeros((1, 2 * widest + 1), np.float32)
        for span, tau in zip(emd.spans_px, emd.delays_ms, strict=True):
            share = tau / (dt_ms + tau)
            self.emd_kernel[0, widest + span] += share
            self.emd_kernel[0, widest - span] -= share
        lgmds = self.neurons.lgmds
        self.biases = [[lgmd.on.bias for lgmd in lgmds], [lgmd.off.bias for lgmd in lgmds]]
        self.inhibition = [
            np.array([_ring_weights(p, dt_ms) for p in channel])
            for channel in zip(*((lgmd.on, lgmd.off) for lgmd in lgmds), strict=True)
        ]
        self.at_rest = [self._weights(c, self.biases[c]) for c in range(2)]

    def _weights(self, channel: int, biases: list[float]) -> tuple[Map, Map]:
        """Return the weights of E - w I on the six maps of a channel, one row for each LGMD, alike rows once.

        Two orders: for the steps at which the present maps lie first, and for those at which they lie second.
        """
        weights = -np.array(biases)[:, None] * self.inhibition[channel]
        weights[:, 0] += 1.0
        weights = weights[: 1 if np.array_equal(*weights) else 2]
        return weights.astype(np.float32), np.roll(weights, 3, axis=1).astype(np.float32)

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

    def _net_motion(self) -> float:
        """Advance the lamina's channels and their adaptation; return the sum of every correlator."""
        self.channels, self.channels_before = self.channels_before, self.channels
        self.adapted, self.adapted_before = self.adapted_before, self.adapted
        total = 0.0
        for half, now, before, m, m_before in zip(
            self.halves, self.channels, self.channels_before, self.adapted, self.adapted_before, strict=True
        ):
            cv2.scaleAdd(before, self.residual, half, dst=now)
            cv2.subtract(now, before, dst=self.work)
            cv2.threshold(self.work, 0, 0, POSITIVE, dst=m)
            cv2.filter2D(m, -1, self.emd_kernel, dst=self.work, borderType=ZERO)
            total += float(np.vdot(m_before, self.work))
        return total * self.rise_share**2

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
        branches: list[Map] = []
        for c in range(2):
            biases = [max(bias, a) for bias, a in zip(self.biases[c], arousal, strict=True)]
            weights = (self.at_rest[c] if biases == self.biases[c] else self._weights(c, biases))[self.phase]
            out = self.branches[c, : len(weights)]
            flat = out.reshape(len(weights), -1)
            np.matmul(weights, self.sums[c].reshape(6, -1), out=flat)
            cv2.threshold(flat, 0, 0, POSITIVE, dst=flat)
            branches.append(out)
        totals = []
        for k, p in enumerate(self.neurons.lgmds):
            on, off = (branch[min(k, len(branch) - 1)] for branch in branches)
            totals.append(_group(p, on, off, self.work, self.mean))
        return totals[0], totals[1]


def _ring_weights(p: InhibitionParams, dt_ms: float) -> list[float]:
    """Return the weights of I on the three maps now, then one step ago."""
    rings = ((p.centre_weight, p.centre_ms), (p.nearest_weight, p.nearest_ms), (p.diagonal_weight, p.diagonal_ms))
    now = [w * dt_ms / (dt_ms + tau) for w, tau in rings]
    steps = (now, [w - n for (w, _), n in zip(rings, now, strict=True)])
    # The 3 x 3 sum brings the diagonals, but the centre and the nearest too.
    return [x for centre, nearest, diagonal in steps for x in (centre - diagonal, diagonal, nearest - diagonal)]


def _group(p: LgmdParams, on: Map, off: Map, s: Map, mean: Map) -> float:
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
