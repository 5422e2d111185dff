"""The network in NumPy and scipy.ndimage, as a competent researcher writes it.

Layer by layer as the model says it: float32 maps, every filter separable (``correlate1d``, ``uniform_filter``), every
buffer allocated once, ``out=`` everywhere. What the model does beside the network is left out, which favours this
baseline: looking for flashes and repeated frames, the window of the decision, frames off the model clock.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d, uniform_filter

from lobula.model.lamina.dog import gaussian_kernel
from lobula.model.medulla.lateral_inhibition import InhibitionParams
from lobula.model.network import NetworkParams

from .neurons import Neurons, Potentials

Map = NDArray[np.float32]


class NumpyScipyNetwork:
    """One stream. For presets whose LGMDs read the change, with every mechanism on and diagonal weights above 0."""

    def __init__(self, p: NetworkParams, shape: tuple[int, int]) -> None:
        self.p = p
        dog = p.lamina.dog
        self.inner = gaussian_kernel(dog.radius_px, dog.sigma_px)
        self.outer = gaussian_kernel(dog.radius_px * dog.surround, dog.sigma_px * dog.surround)
        self.residual = np.float32(p.lamina.on_off.residual)
        self.neurons = Neurons(p, shape[0] * shape[1])
        self.started = False

        def maps(count: int) -> list[Map]:
            return [np.zeros(shape, np.float32) for _ in range(count)]

        self.luma, self.before = maps(2)
        self.change, self.change_before = maps(2), maps(2)
        self.channels, self.channels_before = maps(2), maps(2)
        self.adapted, self.adapted_before = maps(2), maps(2)
        self.p_map, self.edges, self.e, self.i, self.row, self.work = maps(6)
        self.branches, self.summation = maps(2), maps(1)[0]
        self.mask, self.other = np.empty(shape, bool), np.empty(shape, bool)

    def step(self, image: NDArray[Any], time_s: float) -> Potentials:
        """Advance by one frame, (H, W) luminance 0..255; frames are one tick of the model clock apart."""
        self.luma, self.before = self.before, self.luma
        np.copyto(self.luma, image)
        if not self.started:
            self.started = True
            return Potentials(0.5, 0.5, 0.0, 0.0, (0, 0, 0, 0))
        np.subtract(self.luma, self.before, out=self.p_map)
        np.abs(self.p_map, out=self.work)
        arousal = self.neurons.arousal(float(self.work.mean()))
        self._difference_of_gaussians()
        self.channels, self.channels_before = self.channels_before, self.channels
        self._split(self.edges, self.channels, self.channels_before)
        self.change, self.change_before = self.change_before, self.change
        self._split(self.p_map, self.change, self.change_before)
        self.adapted, self.adapted_before = self.adapted_before, self.adapted
        self._adapt()
        lgmd1, lgmd2 = (self._lgmd(k, arousal[k]) for k in range(2))
        return self.neurons.step((lgmd1, lgmd2), self._net_motion())

    def _blur(self, kernel: Map, out: Map) -> None:
        correlate1d(self.p_map, kernel, axis=1, output=self.row, mode="nearest")
        correlate1d(self.row, kernel, axis=0, output=out, mode="nearest")

    def _difference_of_gaussians(self) -> None:
        e, i = self.e, self.i
        self._blur(self.inner, e)
        self._blur(self.outer, i)
        np.subtract(e, i, out=self.edges)
        np.abs(self.edges, out=self.edges)
        np.copysign(self.edges, e, out=self.edges)
        np.equal(np.greater_equal(e, 0, out=self.mask), np.greater_equal(i, 0, out=self.other), out=self.mask)
        np.multiply(self.edges, self.mask, out=self.edges)
        np.abs(e, out=e)
        np.multiply(self.edges, np.greater_equal(e, self.p.lamina.dog.dead_zone_grey, out=self.mask), out=self.edges)

    def _split(self, signal: Map, now: list[Map], before: list[Map]) -> None:
        np.maximum(signal, 0, out=now[0])
        np.subtract(now[0], signal, out=now[1])
        for x, x_before in zip(now, before, strict=True):
            np.add(x, np.multiply(x_before, self.residual, out=self.work), out=x)

    def _adapt(self) -> None:
        share = np.float32(self._kept(self.p.lamina.fdsr.rise_ms))
        for m, x, x_before in zip(self.adapted, self.channels, self.channels_before, strict=True):
            np.subtract(x, x_before, out=m)
            np.multiply(m, share, out=m)
            np.maximum(m, 0, out=m)

    def _lgmd(self, k: int, arousal: float) -> float:
        """Return the sum of the grouped cells of one LGMD."""
        p = self.neurons.lgmds[k]
        on, off = self.branches
        self._branch(0, p.on, arousal, on)
        self._branch(1, p.off, arousal, off)
        s, work = self.summation, self.work
        np.multiply(on, off, out=work)
        np.multiply(work, np.float32(p.product_gain), out=work)
        np.multiply(on, np.float32(p.on_gain), out=on)
        np.multiply(off, np.float32(p.off_gain), out=off)
        np.add(on, off, out=s)
        np.add(s, work, out=s)
        uniform_filter(s, 3, output=work, mode="nearest")
        omega = p.grouping.floor_grey + float(work.max()) / p.grouping.divisor
        np.multiply(s, work, out=work)
        np.greater_equal(work, np.float32(p.grouping.threshold_grey * omega), out=self.mask)
        np.multiply(work, self.mask, out=work)
        return float(work.sum()) / omega

    def _branch(self, channel: int, p: InhibitionParams, arousal: float, out: Map) -> None:
        """Write [E - w I]+ of one channel."""
        weights = (p.centre_weight, p.nearest_weight, p.diagonal_weight)
        delays = (p.centre_ms, p.nearest_ms, p.diagonal_ms)
        before = [w * self._kept(tau) for w, tau in zip(weights, delays, strict=True)]
        e = self.change[channel]
        self._rings(e, [w - b for w, b in zip(weights, before, strict=True)], out)
        self._rings(self.change_before[channel], before, self.i)
        np.add(out, self.i, out=out)
        np.multiply(out, np.float32(max(p.bias, arousal)), out=out)
        np.subtract(e, out, out=out)
        np.maximum(out, 0, out=out)

    def _rings(self, x: Map, weights: list[float], out: Map) -> None:
        """Write the 3 x 3 sum with three ring weights, as a separable filter and a correction at the centre.

        (d, n, d) x (d, n, d) / d has the diagonal d and the nearest n asked for, and n n / d in the middle.
        """
        centre, nearest, diagonal = weights
        correlate1d(x, [diagonal, nearest, diagonal], axis=1, output=self.row, mode="nearest")
        correlate1d(self.row, [1.0, nearest / diagonal, 1.0], axis=0, output=out, mode="nearest")
        np.add(out, np.multiply(x, np.float32(centre - nearest * nearest / diagonal), out=self.row), out=out)

    def _kept(self, tau_ms: float) -> float:
        """Return the share of the step before in a low-pass."""
        return tau_ms / (self.p.clock.period_ms + tau_ms)

    def _net_motion(self) -> float:
        """Return the sum of every correlator, rightward positive."""
        emd = self.p.lptc.emd
        total = 0.0
        for m, m_before in zip(self.adapted, self.adapted_before, strict=True):
            for span, tau in zip(emd.spans_px, emd.delays_ms, strict=True):
                rightward = np.einsum("yx,yx->", m_before[:, :-span], m[:, span:])
                leftward = np.einsum("yx,yx->", m[:, :-span], m_before[:, span:])
                total += self._kept(tau) * float(rightward - leftward)
        return total
