"""The arena as a PettingZoo environment: a rule that steers two wheels to where more of the floor is free.

Needs the extra ``pettingzoo``.
"""

import numpy as np

from lobula.arena.environment import ArenaEnv

env = ArenaEnv(robots=4, actions="wheels", minutes=0.5)
observations, infos = env.reset(seed=3)
gained, stuck = dict.fromkeys(env.agents, 0.0), dict.fromkeys(env.agents, False)

while env.agents:
    actions = {}
    for agent in env.agents:
        picture = observations[agent][..., 0]
        floor = (picture > 80) & (picture < 120)  # robots are darker, the wall is lighter
        left, right = floor[:, :50].mean(), floor[:, 49:].mean()
        free = np.clip(((left + right) / 2 - 0.2) / 0.2, 0, 1)  # half of the view where nothing is near
        turn = 10 * free * (right - left) - 4 * (1 - free)  # where nothing is free, to the left
        wheels = [8 * free + turn, 8 * free - turn]
        if stuck[agent]:
            wheels = [-6.0, -3.0]
        actions[agent] = np.clip(wheels, -10, 10).astype(np.float32)
    observations, rewards, terminations, truncations, infos = env.step(actions)
    for agent, reward in rewards.items():
        gained[agent] += reward
        stuck[agent] = reward == 0  # it touches something: what it sees need not tell

for agent, info in infos.items():
    events = info["events"]
    print(f"{agent}: {gained[agent]:.0f} gained, {info['distance_cm']:.0f} cm, {events['CR']} CR, {events['CP']} CP")
