"""A detector of one's own, set on every robot of the arena, beside the network and beside chance."""

import numpy as np

from lobula import arena


class MuchMoves:
    """Avoid when the picture has changed by more than 8 grey levels on average, for three frames on end."""

    def __init__(self):
        self.before = None
        self.frames = 0

    def step(self, image, time_s, turning):
        now, before = image.astype(np.int16), self.before
        self.before = now
        moves = before is not None and np.abs(now - before).mean() > 8 and not turning
        self.frames = self.frames + 1 if moves else 0
        return self.frames >= 3


for name, controller in {
    "own detector": arena.EachRobot(MuchMoves),
    "the network": arena.NetworkController(),
    "chance": arena.RandomTurn(rate_per_min=10),
}.items():
    score = arena.run(controller=controller, minutes=1, seed=3).score
    print(
        f"{name}: {score.cr} contacts with robots, {score.cp} with the wall; "
        f"avoided {score.aa} approaching robots, {score.at} others, {score.ap} times the wall; "
        f"turned {score.spurious} times for nothing; SR1 {score.sr1:.0%}, SR2 {score.sr2:.0%}"
    )
