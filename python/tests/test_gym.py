"""The environment of gymnasium."""

import numpy as np
import pytest

import pontoon as pt

gymnasium = pytest.importorskip("gymnasium")


def test_the_environment_keeps_the_rules_of_gymnasium(tank: pt.Scene) -> None:
    from gymnasium.utils.env_checker import check_env

    from pontoon.gym import FloatEnv, Push, Torque

    env = FloatEnv(
        tank,
        act={"crate": Push(axis=1, limit=50.0), "tank": Torque(limit=0.0)},
        see=[(pt.elevation(at=0.2), "eta_m"), lambda sim: float(sim["crate"].velocity[1])],
        reward=lambda sim: -abs(float(sim["crate"].velocity[1])),
        dt=0.05,
        threads=1,
    )
    with pytest.raises(pt.UsageError, match="free"):
        env.reset(seed=1)
        env.step(np.zeros(2, dtype=np.float32))
    env = FloatEnv(
        tank,
        act={"crate": Push(axis=1, limit=50.0)},
        see=[(pt.elevation(at=0.2), "eta_m"), lambda sim: float(sim["crate"].velocity[1])],
        reward=lambda sim: -abs(float(sim["crate"].velocity[1])),
        dt=0.05,
        threads=1,
    )
    check_env(env, skip_render_check=True)
    first = [env.reset(seed=1)[0], *(env.step(np.array([0.5], dtype=np.float32))[0] for _ in range(3))]
    again = [env.reset(seed=1)[0], *(env.step(np.array([0.5], dtype=np.float32))[0] for _ in range(3))]
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True)), "episodes repeat to the bit"
    cut = False
    while not cut:
        _, _, ended, cut, details = env.step(np.array([0.0], dtype=np.float32))
    assert not ended and details["time"] == pytest.approx(tank.until)
    env.close()


def test_a_push_up_raises_the_crate(tank: pt.Scene) -> None:
    from pontoon.gym import FloatEnv, Push

    def reached(share: float) -> float:
        env = FloatEnv(
            tank,
            act={"crate": Push(axis=1, limit=100.0)},
            see=[lambda sim: float(sim["crate"].centre[1])],
            reward=lambda sim: 0.0,
            dt=0.1,
            start=lambda sim, rng: sim.set_velocity("crate", [0.0, 0.01 * rng.random()]),
        )
        env.reset(seed=3)
        return float(env.step(np.array([share], dtype=np.float32))[0][0])

    assert reached(1.0) > reached(0.0) + 0.002 > reached(-1.0) + 0.004


def test_unknown_names_are_told(tank: pt.Scene) -> None:
    from pontoon.gym import Drive, FloatEnv

    with pytest.raises(pt.UsageError, match="hinge"):
        FloatEnv(tank, act={"hinge": Drive(1.0)}, see=[], reward=lambda sim: 0.0, dt=0.1)
    with pytest.raises(pt.UsageError, match="interval"):
        FloatEnv(tank, act={}, see=[], reward=lambda sim: 0.0, dt=0.0)
