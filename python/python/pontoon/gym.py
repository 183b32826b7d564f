"""An environment of gymnasium: a simulation with actions, observations and a reward. It needs the extra `gym`.

>>> env = pontoon.gym.FloatEnv(scene, act={"hinge": "torque"}, see=["heave", "eta"], reward=f, dt=0.05)   # doctest: +SKIP
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ._errors import Fault, UnknownNameError, unknown, usage
from ._pontoon import BodyStep
from .probes import Probe
from .run import full_name
from .scene import Scene
from .simulation import Simulation

Vector = NDArray[np.float32]
Observation = Callable[[Simulation], float]


@dataclass(frozen=True)
class Push:
    """A force on a free solid, at its centre.

    Attributes:
        axis: 0 for x, 1 for y, 2 for z; the last axis of a scene is vertical.
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
        mode: "force" or "torque", which mean the same, "position" or "velocity".
        stiffness, damping: of the motor; see `Simulation.drive`. A position needs a stiffness, a velocity a damping.
        max_force: largest force, N or N m (per metre in 2-D).
    """

    limit: float
    mode: str = "force"
    stiffness: float = 0.0
    damping: float = 0.0
    max_force: float = float("inf")


Action = Push | Torque | Drive

#: Kinds of joints with a motor.
_HINGES, _SLIDERS = ("hinge", "revolute"), ("slider", "prismatic")


class FloatEnv(gymnasium.Env[Vector, Vector]):
    """A simulation as an environment of gymnasium.

    Each action lies between −1 and 1 and acts for `dt`; the observation is a vector. An episode is cut at the end of
    the scene; a fault of the computation ends it, with `info["fault"]`.

    Args:
        scene: the scene; each episode starts from its start.
        act: what each action does, by the name of a free solid (`Push`, `Torque`) or of a joint (`Drive`). "torque" of a hinge
            and "force" of a slider stand for a `Drive` with the limit that the scene gives to the motor:
            `motor = { torque = 0.0, strongest = 20.0 }` has the limit 20 N m.
        see: what is observed: columns of the probes of the scene ("buoy.heave_m", or a unique part such as "heave" or "eta"),
            functions of the simulation, or probes with the column that is read.
        reward: a function of the simulation after each interval.
        dt: simulated time between two actions, s.
        ended: a function that tells whether the episode ends; by default it never does.
        start: called with the simulation and the random generator at each reset, to vary the start.
        threads: number of threads; many environments in parallel take one each.

    Raises:
        UnknownNameError: `act` or `see` names what the scene does not have; `help` has the nearest.
        UsageError: an action does not fit its solid or joint, or `dt` is not positive.
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        scene: Scene,
        *,
        act: Mapping[str, Action | str],
        see: Sequence[str | Observation | tuple[Probe, str]],
        reward: Observation,
        dt: float,
        ended: Callable[[Simulation], bool] | None = None,
        start: Callable[[Simulation, np.random.Generator], None] | None = None,
        threads: int | None = None,
    ) -> None:
        if not dt > 0.0:
            raise usage(f"dt = {dt} s is no interval between actions", "give more than 0")
        self.sim = scene.build(threads=threads)
        self._act = {name: self._checked(scene, name, action) for name, action in act.items()}
        self._see, self._reward, self._dt = [self._reader(seen) for seen in see], reward, dt
        self._ended, self._start, self._until = ended, start, scene.until
        self._first, self._dimension = self.sim.save(), self.sim.dimension
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (len(act),), np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (len(see),), np.float32)

    def _checked(self, scene: Scene, name: str, action: Action | str) -> Action:
        """Returns the action of a solid or a joint, whose limit the scene has if it is a word."""
        if name in self.sim.joints:
            return _joint_action(scene, name, action)
        if name not in self.sim.solids:
            raise unknown("solid or joint", name, [*self.sim.solids, *self.sim.joints])
        role = self.sim[name].role
        if role != "free":
            raise usage(f"solid {name!r} is {role}: forces have no effect on it", "act on a free solid or on a joint")
        if not isinstance(action, (Push, Torque)):
            raise usage(f"{name!r} is a solid, and {action!r} does not act on it", "give it a Push or a Torque")
        axes = 3 if isinstance(action, Torque) else self.sim.dimension
        if action.axis not in range(axes):
            raise usage(f"{action!r} has no such axis", f"give an axis from 0 to {axes - 1}")
        return action

    def _reader(self, seen: str | Observation | tuple[Probe, str]) -> Observation:
        """Returns the function that reads what is seen."""
        if isinstance(seen, str):
            sample = self.sim.sample().items()
            known = {f"{name}.{column}": (name, column) for name, reading in sample for column in reading}
            name, column = known[full_name(seen, known)]
            return lambda sim: sim.sample()[name][column]
        if callable(seen):
            return seen
        probe, wanted = seen
        columns = self.sim.read(probe)
        if wanted not in columns:
            raise unknown("column", wanted, columns)
        return lambda sim: sim.read(probe)[wanted]

    def _observe(self) -> Vector:
        return np.array([read(self.sim) for read in self._see], dtype=np.float32)

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


def _joint_action(scene: Scene, name: str, action: Action | str) -> Drive:
    """Returns the motor command of a joint, whose limit the scene has if it is a word."""
    kind = scene[f"joint.{name}.kind"]
    if kind not in _HINGES + _SLIDERS:
        raise usage(f"joint {name!r} is of the kind {kind!r}: it has no motor", "act on a hinge or a slider")
    load = "torque" if kind in _HINGES else "force"
    if isinstance(action, Drive):
        if action.mode not in ("force", "torque", "position", "velocity"):
            raise unknown("mode of a Drive", action.mode, ["force", "torque", "position", "velocity"])
        return action
    if action != load:
        what = f"{action!r} does not act on joint {name!r}, a {kind}"
        raise usage(what, f'give {load!r}, or a Drive for positions and velocities')
    try:
        limit = float(scene[f"joint.{name}.motor.strongest"])
    except UnknownNameError:
        what = f"the scene has no largest load of the motor of joint {name!r}"
        raise usage(what, f'give its motor `strongest`, or Drive(limit=…) in place of {load!r}') from None
    return Drive(limit, max_force=limit)
