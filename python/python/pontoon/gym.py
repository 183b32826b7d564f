"""An environment of gymnasium: a simulation with actions, observations and a reward. It needs the extra `gym`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ._errors import Fault, usage
from ._pontoon import BodyStep
from .probes import Probe
from .scene import Scene
from .simulation import Simulation

Vector = NDArray[np.float32]
Observation = Callable[[Simulation], float]


@dataclass(frozen=True)
class Push:
    """A force on a free solid, at its centre.

    Attributes:
        axis: 0 for x, 1 for y, 2 for z.
        limit: force of the action 1, N (N/m in 2-D).
    """

    axis: int
    limit: float


@dataclass(frozen=True)
class Torque:
    """A torque on a free solid about its centre.

    Attributes:
        limit: torque of the action 1, N m (N m/m in 2-D).
        axis: 0 for x, 1 for y, 2 for z; of no meaning in 2-D.
    """

    limit: float
    axis: int = 2


@dataclass(frozen=True)
class Drive:
    """The force of the motor of a hinge or a slider, or its set points.

    Attributes:
        limit: value of the action 1: N or N m (per metre in 2-D), m or rad, m/s or rad/s.
        mode: "force", "position" or "velocity".
        stiffness, damping: of the motor; see `Simulation.drive`.
        max_force: largest force.
    """

    limit: float
    mode: str = "force"
    stiffness: float = 0.0
    damping: float = 0.0
    max_force: float = float("inf")


Action = Push | Torque | Drive


class FloatEnv(gymnasium.Env[Vector, Vector]):
    """A simulation as an environment of gymnasium.

    Each action lies between −1 and 1 and acts for `dt`; the observation is a vector. An episode is cut at the end of
    the scene; a fault of the computation ends it, with `info["fault"]`.

    Args:
        scene: the scene; each episode starts from its start.
        act: what each action does, by the name of a solid (`Push`, `Torque`) or a joint (`Drive`).
        see: what is observed: functions of the simulation, or probes with the column that is read.
        reward: a function of the simulation after each interval.
        dt: simulated time between two actions, s.
        ended: a function that tells whether the episode ends; by default it never does.
        start: called with the simulation and the random generator at each reset, to vary the start.
        threads: number of threads; many environments in parallel take one each.
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        scene: Scene,
        *,
        act: Mapping[str, Action],
        see: Sequence[Observation | tuple[Probe, str]],
        reward: Observation,
        dt: float,
        ended: Callable[[Simulation], bool] | None = None,
        start: Callable[[Simulation, np.random.Generator], None] | None = None,
        threads: int | None = None,
    ) -> None:
        if not dt > 0.0:
            raise usage(f"dt = {dt} s is no interval between actions", "give more than 0")
        self.sim = scene.build(threads=threads)
        known = {*self.sim.solids, *self.sim.joints}
        for name in act:
            if name not in known:
                raise usage(f"nothing to act on is called {name!r}", f"known: {', '.join(sorted(known))}")
        self._act, self._see, self._reward, self._dt = dict(act), list(see), reward, dt
        self._ended, self._start, self._until = ended, start, scene.until
        self._first, self._dimension = self.sim.save(), self.sim.dimension
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (len(act),), np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (len(see),), np.float32)

    def _observe(self) -> Vector:
        read = [see(self.sim) if callable(see) else self.sim.read(see[0])[see[1]] for see in self._see]
        return np.array(read, dtype=np.float32)

    def _apply(self, h: BodyStep, action: Vector) -> None:
        dimension = self._dimension
        for (name, act), share in zip(self._act.items(), action.tolist(), strict=True):
            if isinstance(act, Push):
                h.push(name, [act.limit * share if axis == act.axis else 0.0 for axis in range(dimension)])
            elif isinstance(act, Torque):
                turn = act.limit * share
                h.push(name, torque=turn if dimension == 2 else [turn if i == act.axis else 0.0 for i in range(3)])
            else:
                point = {act.mode: act.limit * share}
                h.drive(name, stiffness=act.stiffness, damping=act.damping, max_force=act.max_force, **point)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Starts an episode; returns the observation and an empty dictionary."""
        super().reset(seed=seed)
        self.sim.restore(self._first)
        if self._start is not None:
            self._start(self.sim, self.np_random)
        return self._observe(), {}

    def step(self, action: Vector) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """Acts for an interval; returns observation, reward, whether the episode ended or was cut, and details."""
        chosen = np.clip(np.asarray(action, dtype=np.float32).ravel(), -1.0, 1.0)
        until = min(self.sim.time + self._dt, self._until)
        try:
            self.sim.advance(until, control=lambda h: self._apply(h, chosen), every=math.inf)
        except Fault as fault:
            return self._observe(), self._reward(self.sim), True, False, {"fault": fault}
        ended = self._ended is not None and self._ended(self.sim)
        return self._observe(), self._reward(self.sim), ended, self.sim.time >= self._until, {"time": self.sim.time}

    def close(self) -> None:
        """Frees the memory of the simulation."""
        self.sim.close()
