"""A gymnasium environment and a policy search in plain NumPy: a pusher learns to damp the heave of a float.

The float is let go above its draft and bobs. The policy is a force in proportion to height and velocity; the search
climbs from no force at all. The best force opposes the velocity: the float comes to rest.

    python policy_search.py
"""

import numpy as np

import pontoon as pt
from pontoon.gym import FloatEnv

SCENE = """
title = "A float bobs"
dimension = 2
dp = 0.04
until = 1.6
frames = "off"

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.6, 0.4] } }

[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.6, 0.8] } }

[[solid]]
name = "float"
shape = { box = { size = [0.32, 0.16] } }
at = { x = 0.8, bottom = 0.36 }
free = { density = 500.0, locked = ["x", "turn"] }
"""


def environment() -> FloatEnv:
    """Returns an episode of 1.6 s: the action pushes the float by up to 100 N/m, the reward is for rest at the draft."""

    def reward(sim: pt.Simulation) -> float:
        body = sim["float"]
        height, speed = float(body.centre[1]) - 0.4, float(body.velocity[1])
        return -(height**2 / 0.01 + speed**2 / 0.1)

    return FloatEnv(
        pt.Scene.from_toml(SCENE),
        act={"float": pt.gym.Push(axis=1, limit=100.0)},
        see=[lambda sim: float(sim["float"].centre[1]) - 0.4, lambda sim: float(sim["float"].velocity[1])],
        reward=reward,
        dt=0.04,
        threads=1,
    )


def episode(env: FloatEnv, gains: np.ndarray) -> float:
    """Returns the sum of rewards of a policy: force over limit = gains · (height over 0.1 m, velocity over 0.3 m/s)."""
    seen, _ = env.reset(seed=0)
    total, done = 0.0, False
    while not done:
        action = np.clip(gains @ (seen / np.array([0.1, 0.3])), -1.0, 1.0)
        seen, reward, ended, cut, _ = env.step(np.array([action], dtype=np.float32))
        total, done = total + float(reward), ended or cut
    return total


def main() -> None:
    """Climbs for some episodes and checks what was learned."""
    env = environment()
    rng = np.random.default_rng(1)
    best = np.zeros(2)
    first = score = episode(env, best)
    for _ in range(14):
        tried = best + rng.normal(scale=0.4, size=2)
        reached = episode(env, tried)
        if reached > score:
            best, score = tried, reached
    print(f"return without force {first:.2f}, learned {score:.2f}, gains on height and velocity {best.round(2)}")
    assert score > 0.7 * first, "returns are negative: the policy halves nearly a third of the cost or more"
    assert best[1] < 0.0, "the force opposes the velocity"


if __name__ == "__main__":
    main()
