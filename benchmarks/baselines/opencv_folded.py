"""The network on OpenCV with all of the core's algebra: fewer passes than anyone would write without the core at hand.

Beyond ``opencv``:

- Each [E - w I] is one row of weights on the six maps of a channel, and both LGMDs' rows are one matrix product.
- Branches that come out alike, such as the OFF branches of both LGMDs, are computed once.
- The scale of the adaptation is a factor of the net motion, and is applied there.
- All spans of Eq. (3) together are the sum of M' (k * M), M' being M one step ago and zero outside the picture, where
  the antisymmetric kernel k holds the share of a span at +d and its negative at -d: one filter and one dot product.
"""

from __future__ import annotations

import cv2
import numpy as np

from lobula.model.network import NetworkParams

from .opencv import POSITIVE, Map, OpencvNetwork, group

ZERO = cv2.BORDER_CONSTANT


class FoldedOpencvNetwork(OpencvNetwork):
    """One stream. For the presets of ``OpencvNetwork``."""

    def __init__(self, p: NetworkParams, shape: tuple[int, int]) -> None:
        super().__init__(p, shape)
        emd = p.lptc.emd
        widest = max(emd.spans_px)
        self.emd_kernel = np.zeros((1, 2 * widest + 1), np.float32)
        for span, share in zip(emd.spans_px, self.span_shares, strict=True):
            self.emd_kernel[0, widest + span] += share
            self.emd_kernel[0, widest - span] -= share
        self.biases = [[lgmd.on.bias for lgmd in self.neurons.lgmds], [lgmd.off.bias for lgmd in self.neurons.lgmds]]
        self.at_rest = [self._weights(c, self.biases[c]) for c in range(2)]
        self.branches = np.zeros((2, 2, *shape), np.float32)  # channel, LGMD

    def _weights(self, channel: int, biases: list[float]) -> tuple[Map, Map]:
        """Return the weights of E - w I on the six maps of a channel, one row for each LGMD, alike rows once.

        Two orders: for the steps at which the present maps lie first, and for those at which they lie second.
        """
        weights = -np.array(biases)[:, None] * np.array([self.inhibition[k][channel] for k in range(2)])
        weights[:, 0] += 1.0
        weights = weights[: 1 if np.array_equal(*weights) else 2]
        return weights.astype(np.float32), np.roll(weights, 3, axis=1).astype(np.float32)

    def _net_motion(self) -> float:
        total = 0.0
        for now, before, m, m_before in self._channels():
            cv2.subtract(now, before, dst=self.work)
            cv2.threshold(self.work, 0, 0, POSITIVE, dst=m)
            cv2.filter2D(m, -1, self.emd_kernel, dst=self.work, borderType=ZERO)
            total += float(np.vdot(m_before, self.work))
        return total * self.rise_share**2

    def _lgmds(self, arousal: tuple[float, float]) -> tuple[float, float]:
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
            totals.append(group(p, on, off, self.work, self.mean))
        return totals[0], totals[1]
