"""Rigid bodies that float, collide and are driven in water: δ-SPH for the water, rapier for the bodies.

>>> import pontoon as pt
>>> run = pt.run("raft")                                                    # doctest: +SKIP

`run` runs a scene with its files; `Scene.build` gives a `Simulation` that is stepped, controlled and read.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ._errors import Error, Fault, FileError, RestartError, SceneError, UnknownNameError, UsageError
from ._pontoon import BodyState, BodyStep, Load, version
from .probes import (
    contact,
    elevation,
    energy,
    flow,
    force,
    joint,
    motion,
    pressure,
    rope,
    runup,
    spring,
    velocity,
)
from .run import Frame, Progress, Rao, Run, Series, Statistic, resume, run, scenes
from .scene import Finding, Inspection, Scene
from .simulation import (
    Contact,
    HostedSimulation,
    JointReading,
    Motion,
    Reading,
    Simulation,
    SpringReading,
    WaterView,
)
from .study import Study, study, validate

if TYPE_CHECKING:
    from . import gym as gym
    from . import potential_flow as potential_flow

__version__ = version()

__all__ = [
    "BodyState",
    "BodyStep",
    "Contact",
    "Error",
    "Fault",
    "FileError",
    "Finding",
    "Frame",
    "HostedSimulation",
    "Inspection",
    "JointReading",
    "Load",
    "Motion",
    "Progress",
    "Rao",
    "Reading",
    "RestartError",
    "Run",
    "Scene",
    "SceneError",
    "Series",
    "Simulation",
    "SpringReading",
    "Study",
    "Statistic",
    "UnknownNameError",
    "UsageError",
    "WaterView",
    "contact",
    "elevation",
    "energy",
    "flow",
    "force",
    "joint",
    "motion",
    "pressure",
    "resume",
    "rope",
    "run",
    "runup",
    "scenes",
    "spring",
    "study",
    "validate",
    "velocity",
]


def __getattr__(name: str) -> Any:
    # Modules that need other packages are imported when they are used.
    if name in ("gym", "potential_flow"):
        return import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
