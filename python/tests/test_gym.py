"""The environment of gymnasium."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pontoon as pt

gymnasium = pytest.importorskip("gymnasium")


def still(sim: pt.Simulation) -> float:
    """Returns a reward for a crate at rest."""
    return -abs(float(sim["crate"].velocity[1]))


@pytest.fixture
def railed(tank: pt.Scene) -> pt.Scene:
    """A crate on a vertical rail, whose motor pulls with 60 N at most."""
    rail = {"name": "rail", "kind": "slider", "between": ["crate"], "at": [0.5, 0.5], "along": [0.0, 1.0]}
    tank["joint"] = [rail | {"motor": {"force": 0.0, "strongest": 60.0}}]
    return tank


def test_the_environment_keeps_the_rules_of_gymnasium(tank: pt.Scene) -> None:
    from gymnasium.utils.env_checker import check_env

    from pontoon.gym import FloatEnv, Push

    env = FloatEnv(
        tank,
        act={"crate": Push(axis=1, limit=50.0)},
        see=[(pt.elevation(at=0.2), "eta_m"), lambda sim: float(sim["crate"].velocity[1])],
        reward=still,
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


def test_a_torque_turns_the_crate(tank: pt.Scene) -> None:
    from pontoon.gym import FloatEnv, Torque

    def spin(share: float) -> float:
        env = FloatEnv(
            tank, act={"crate": Torque(5.0)}, see=[lambda sim: float(sim["crate"].spin)], reward=still, dt=0.02
        )
        env.reset(seed=1)
        return float(env.step(np.array([share], dtype=np.float32))[0][0])

    assert spin(1.0) > spin(0.0) > spin(-1.0)


def test_a_word_for_a_joint_is_its_motor_in_the_scene(railed: pt.Scene) -> None:
    from pontoon.gym import Action, Drive, FloatEnv

    def seen(action: Action | str) -> np.ndarray:
        env = FloatEnv(railed, act={"rail": action}, see=["heave", "eta", "crate.vy_mps"], reward=still, dt=0.05)
        first, _ = env.reset(seed=1)
        after = env.step(np.array([0.5], dtype=np.float32))[0]
        assert env.sim.joint("rail").motor_force == pytest.approx(30.0), "half of the largest force of the scene"
        assert first[0] == 0.0 and after.shape == (3,) and after[0] == np.float32(env.sim.sample()["crate"]["heave_m"])
        return after

    assert np.array_equal(seen("force"), seen(Drive(60.0))) and seen("force")[0] > 0.0


def test_a_motor_follows_a_velocity(railed: pt.Scene) -> None:
    from pontoon.gym import Drive, FloatEnv

    env = FloatEnv(
        railed,
        act={"rail": Drive(0.2, mode="velocity", damping=5000.0)},
        see=[lambda sim: sim.joint("rail").rate],
        reward=still,
        dt=0.1,
    )
    env.reset(seed=1)
    # A strong motor holds the speed against some newtons of water.
    assert env.step(np.array([0.5], dtype=np.float32))[0][0] == pytest.approx(0.1, abs=0.01)


def test_what_does_not_fit_is_told_at_construction(railed: pt.Scene) -> None:
    from pontoon.gym import Action, Drive, FloatEnv, Push, Torque

    wrong: list[tuple[str, Action | str, str]] = [
        ("rai", "force", "rail"),
        ("crat", Push(1, 1.0), "crate"),
        ("tank", Push(1, 1.0), "free"),
        ("crate", Drive(1.0), "Push"),
        ("crate", Push(2, 1.0), "axis"),
        ("crate", Torque(1.0, axis=3), "axis"),
        ("rail", Push(1, 1.0), "Drive"),
        ("rail", "torque", "force"),
        ("rail", Drive(1.0, mode="speed"), "mode"),
    ]
    for name, action, told in wrong:
        with pytest.raises(pt.UsageError, match=told):
            FloatEnv(railed, act={name: action}, see=[], reward=still, dt=0.1)
    for seen, told in (("heav", "heave"), ("m", "heave"), ((pt.elevation(at=0.2), "eta"), "eta_m")):
        with pytest.raises(pt.UnknownNameError, match=told):
            FloatEnv(railed, act={}, see=[seen], reward=still, dt=0.1)
    with pytest.raises(pt.UsageError, match="interval"):
        FloatEnv(railed, act={}, see=[], reward=still, dt=0.0)
    railed["joint.rail.motor"] = {"damping": 1.0}
    with pytest.raises(pt.UsageError, match="strongest"):
        FloatEnv(railed, act={"rail": "force"}, see=[], reward=still, dt=0.1)


def test_the_environment_of_the_guide_is_one() -> None:
    guide = (Path(__file__).parents[2] / "docs" / "how-to" / "use-from-python.md").read_text(encoding="utf-8")
    blocks = [part.split("```")[0] for part in guide.split("```python")[1:]]
    block = next(block for block in blocks if "FloatEnv" in block)
    names: dict[str, Any] = {"pt": pt}
    exec(block, names)
    env = names["env"]
    env.reset(seed=1)
    assert env.observation_space.contains(env.step(env.action_space.sample())[0])
