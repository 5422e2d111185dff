"""The whole network, step by step, as the presets wire it; no flash, no turning, no repeats."""

from __future__ import annotations

from dataclasses import dataclass, field

from .coarse import heard, saturated
from .decision import Step, decide, spike_count
from .dog import dog
from .emd import correlate, potentials, spans
from .lamina import CLOCK_MS, Rows, fdsr, on_off, share
from .lgmd import Rings, adaptation, competition, grouping, inhibition, looming, sigmoid, summation

SLOW = (60.0, 120.0, 180.0)
LOW = (1.0, 0.25, 0.125)


@dataclass(frozen=True)
class Lgmd:
    """The constants in which the two LGMDs differ."""

    on: Rings
    off: Rings
    change_ms: float
    thetas: tuple[float, float, float]


LGMDS = {
    "lgmd1": Lgmd(Rings(LOW, SLOW, 0.5), Rings(LOW, SLOW, 0.5), 10.0, (1.0, 1.0, 0.0)),
    "lgmd2": Lgmd(Rings((2.0, 0.5, 0.25), (15.0, 30.0, 45.0), 1.0), Rings(LOW, SLOW, 0.5), 90.0, (1.0, 1.0, 1.0)),
}


@dataclass(frozen=True)
class Wiring:
    """What a preset changes: the layer the LGMDs read, and the scales that go with it."""

    reads_lamina: bool
    threshold: float
    floor: float
    c_sig: float
    k_hs: float
    limit: float = 255.0
    side: int = 9
    noise: float = 1.0
    gains: tuple[float, float] = (0.0, 0.0)
    """What patches weigh for LGMD-1 and LGMD-2, and how many times those that brighten are taken off."""
    on_weights: tuple[float, float] = (0.0, 0.0)


PUBLISHED = Wiring(False, 30.0, 0.01, 1.0, 0.01)


@dataclass
class Oracle:
    """Feed it pictures in order; the maps of the last step lie in ``maps``."""

    wiring: Wiring = PUBLISHED
    neurons: str = "all"
    warm_up_s: float = 0.2
    history: list[Step] = field(default_factory=list)
    maps: dict[str, Rows] = field(default_factory=dict)

    def start(self, picture: Rows, time_s: float) -> None:
        """Take in the first picture."""
        nothing = [[0.0] * len(picture[0]) for _ in picture]
        self.luma, self.step_s, self.start_s = picture, time_s, time_s
        self.change, self.lamina, self.adapted = ((nothing, nothing) for _ in range(3))
        self.mean_change = 0.0
        self.raw = {"lgmd1": 0.5, "lgmd2": 0.5}
        self.u = dict(self.raw)

    def step(self, picture: Rows, time_s: float) -> dict[str, float]:
        """Take in the next picture; return the four potentials."""
        wiring = self.wiring
        dt_ms = (time_s - self.step_s) * 1000
        ticks = dt_ms / CLOCK_MS
        residual = 0.1**ticks
        p = [[(new - old) / ticks**0.75 for new, old in zip(*lines, strict=True)]
             for lines in zip(picture, self.luma, strict=True)]  # fmt: skip
        pixels = len(p) * len(p[0])
        mean_change = sum(abs(v) for line in p for v in line) / pixels
        patches = heard(p, wiring.side, wiring.noise)
        p = saturated(p, wiring.limit)
        la = dog(p)
        change, lamina = on_off(p, *self.change, residual), on_off(la, *self.lamina, residual)
        adapted = tuple(fdsr(now, before) for now, before in zip(lamina, self.lamina, strict=True))
        self.maps = {"change": p, "lamina": la, "adapted_on": adapted[0], "adapted_off": adapted[1]}
        now, before = (adapted, self.adapted) if wiring.reads_lamina else (change, self.change)
        on, off = zip(now, before, strict=True)
        for (name, lgmd), gain, on_weight in zip(LGMDS.items(), wiring.gains, wiring.on_weights, strict=True):
            a = share(lgmd.change_ms)
            arousal = (a * mean_change + (1 - a) * self.mean_change) / 20
            i_on, i_off = inhibition(*on, lgmd.on), inhibition(*off, lgmd.off)
            s_on = competition(on[0], i_on, max(lgmd.on.bias, arousal))
            s_off = competition(off[0], i_off, max(lgmd.off.bias, arousal))
            s = summation(s_on, s_off, lgmd.thetas)
            g = grouping(s, wiring.threshold, wiring.floor)
            raw = sigmoid(g, wiring.c_sig, looming(*patches, gain, on_weight))
            self.u[name] = adaptation(raw, self.raw[name], self.u[name], dt_ms)
            self.raw[name] = raw
            layers = {"inhibition_on": i_on, "inhibition_off": i_off, "summation": s, "grouped": g}
            self.maps |= {f"{name}_{layer}": rows for layer, rows in layers.items()}
        motions = [
            correlate(x, b, spans(ticks), [40.0, 30.0, 20.0, 10.0]) for x, b in zip(adapted, self.adapted, strict=True)
        ]
        self.maps["motion"] = [[(a + b) * ticks**0.75 for a, b in zip(*lines, strict=True)]
                               for lines in zip(*motions, strict=True)]  # fmt: skip
        right, left = potentials(sum(map(sum, self.maps["motion"])), pixels, wiring.k_hs)
        self.luma, self.step_s, self.mean_change = picture, time_s, mean_change
        self.change, self.lamina, self.adapted = change, lamina, adapted
        reading = {**self.u, "lptc_r": right, "lptc_l": left}
        self.spikes = tuple(spike_count(u, 0.7 if name in LGMDS else 0.2) for name, u in reading.items())
        if time_s - self.start_s >= self.warm_up_s - 0.001:
            self.history.append((time_s, self.spikes, ticks))
        self.collision = decide(self.history, time_s, self.neurons)
        return reading
