"""Types of the native part of the package."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .simulation import JointReading, SpringReading

__all__ = [
    "BodyState",
    "BodyStep",
    "Lease",
    "Load",
    "NativeScene",
    "NativeSimulation",
    "bundled_scenes",
    "check_cases",
    "frame",
    "frame_times",
    "main",
    "resume",
    "statistics",
    "unit",
    "version",
    "write_report",
]

_Path = str | PathLike[str]
_Changes = Sequence[tuple[str, str]]
_Floats = NDArray[np.float64]

@final
class Load:
    """Force and torque of the water on a solid."""

    @property
    def force(self) -> _Floats:
        """Force, N (N/m in 2-D), without weight: (D,)."""
    @property
    def torque(self) -> Any:
        """Torque about the centre of the solid, N m (N m/m in 2-D): a number in 2-D, (3,) in 3-D."""

@final
class BodyState:
    """Position, motion and load of a solid."""

    @property
    def name(self) -> str:
        """Name."""
    @property
    def role(self) -> str:
        """ "fixed", "driven" or "free"."""
    @property
    def mass(self) -> float | None:
        """Mass of a free solid, kg (kg/m in 2-D); None of any other, and in a callback."""
    @property
    def position(self) -> _Floats:
        """World position of the origin of its frame, m: (D,)."""
    @property
    def centre(self) -> _Floats:
        """World position of its centre, m: (D,); the centre of mass of a free solid."""
    @property
    def velocity(self) -> _Floats:
        """Velocity of its centre, m/s: (D,)."""
    @property
    def spin(self) -> Any:
        """Spin, rad/s: a number in 2-D, (3,) in 3-D."""
    @property
    def rotation(self) -> Any:
        """Rotation: an angle (rad) in 2-D, a matrix (3, 3) in 3-D."""
    @property
    def load(self) -> Load:
        """Force and torque of the water."""

@final
class BodyStep:
    """The part of a step when the water has moved and the bodies have not."""

    @property
    def time(self) -> float:
        """Time at the start of the step, s."""
    @property
    def dt(self) -> float:
        """Length of the step, s."""
    @property
    def names(self) -> list[str]:
        """Names of the solids."""
    @property
    def loads(self) -> dict[str, Load]:
        """Loads of the water in this step, by the name of the solid."""
    def __getitem__(self, name: str, /) -> BodyState:
        """Returns a solid at the start of the step, with the load of this step."""
    def joint(self, name: str) -> JointReading:
        """Returns coordinate, rate and motor of a joint in the last step.

        Raises:
            UnknownNameError: there is no such joint.
        """
    def spring(self, name: str) -> SpringReading:
        """Returns length, tension and parameters of a spring in the last step.

        Raises:
            UnknownNameError: there is no such spring.
        """
    def push(
        self,
        name: str,
        force: ArrayLike | None = None,
        *,
        torque: ArrayLike | None = None,
        at: ArrayLike | None = None,
    ) -> None:
        """Pushes a free solid until the next call.

        Args:
            name: the solid.
            force: N (N/m in 2-D): (D,).
            torque: about its centre, N m (N m/m in 2-D): a number in 2-D, (3,) in 3-D.
            at: world point at which the force acts, m: (D,); by default its centre.

        Raises:
            UnknownNameError: there is no such solid.
            UsageError: it is not free, or a vector has another length or is not finite.
        """
    def drive(
        self,
        name: str,
        *,
        force: float | None = None,
        torque: float | None = None,
        position: float = 0.0,
        velocity: float = 0.0,
        stiffness: float = 0.0,
        damping: float = 0.0,
        max_force: float = ...,
    ) -> None:
        """Drives a hinge or a slider from the next step on, as `Simulation.drive`."""
    def set_spring(
        self,
        name: str,
        *,
        stiffness: float | None = None,
        damping: float | None = None,
        rest_length: float | None = None,
    ) -> None:
        """Changes a spring from the next step on, as `Simulation.set_spring`."""
    def set_motion(
        self,
        name: str,
        position: ArrayLike,
        rotation: ArrayLike,
        centre: ArrayLike,
        velocity: ArrayLike,
        spin: ArrayLike,
    ) -> None:
        """Sets the motion of a body of another program at the end of the step."""

@final
class Lease:
    """Holds the memory of the water still while it lives."""

@final
class NativeScene:
    @staticmethod
    def find(word: _Path, overrides: _Changes) -> NativeScene: ...
    @staticmethod
    def parse(text: str, folder: _Path, overrides: _Changes) -> NativeScene: ...
    def with_overrides(self, changes: _Changes) -> NativeScene: ...
    def with_solids(self, solids: Sequence[str]) -> NativeScene: ...
    def origin(self) -> tuple[str, str, str, list[tuple[str, str]]]: ...
    @property
    def title(self) -> str | None: ...
    @property
    def dimension(self) -> int: ...
    @property
    def dp(self) -> float: ...
    @property
    def until(self) -> float: ...
    def to_toml(self) -> str: ...
    def values(self) -> list[tuple[str, str, str]]: ...
    def check(self) -> None: ...
    def file(self, folder: _Path) -> PathLike[str]: ...
    def inspect(self, threads: int | None, timing: bool) -> str: ...
    def export_bodies(self, out: _Path, solids: Sequence[str], panels: int) -> PathLike[str]: ...
    def build(self, hosted: bool, threads: int | None) -> NativeSimulation: ...
    def run(
        self, out: _Path | None, threads: int | None, progress: Callable[..., object] | None
    ) -> tuple[PathLike[str], str, bool]: ...

@final
class NativeSimulation:
    def clock(self) -> tuple[float, float, int, float]: ...
    @property
    def dimension(self) -> int: ...
    @property
    def hosted(self) -> bool: ...
    @property
    def threads(self) -> int: ...
    def all_names(self) -> tuple[list[str], list[str], list[str]]: ...
    def advance(
        self, end: float, single: bool, control: Callable[[BodyStep], object] | None = None, every: float = 0.0
    ) -> None: ...
    def body(self, name: str) -> BodyState: ...
    def particles(self) -> int: ...
    def water(self, name: str) -> Any: ...
    def lease(self) -> Lease: ...
    def water_view(self, name: str) -> Any: ...
    def read_probes(self, scene: NativeScene | None = None) -> dict[str, dict[str, float]]: ...
    def contacts(self) -> list[tuple[str, str, float, list[float]]]: ...
    def events(self) -> list[str]: ...
    def time_spent(self) -> list[float]: ...
    def save(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...
    def add_solid(self, scene: NativeScene, solid: str) -> int: ...
    def restore_with_added(self, state: bytes, scene: NativeScene, added: Sequence[str]) -> None: ...
    def remove_solid(self, name: str) -> None: ...
    def push(self, name: str, force: Any, at: Any = None) -> None: ...
    def set_velocity(self, name: str, velocity: Any, spin: Any) -> None: ...
    def joint(self, name: str) -> list[float]: ...
    def drive(self, name: str, load: Sequence[float | None], rest: Sequence[float]) -> None: ...
    def release(self, name: str) -> None: ...
    def spring(self, name: str) -> list[float]: ...
    def set_spring(self, name: str, changes: Sequence[float | None]) -> list[float]: ...

def version() -> str: ...
def bundled_scenes() -> list[tuple[str, str, str]]: ...
def main(arguments: Sequence[str]) -> int: ...
def check_cases(names: Sequence[str]) -> None: ...
def resume(
    folder: _Path, guards: _Changes, threads: int | None, progress: Callable[..., object] | None
) -> tuple[PathLike[str], str, bool]: ...
def statistics(folder: _Path, series: str | None, start: float | None, end: float | None) -> str: ...
def write_report(folder: _Path) -> PathLike[str]: ...
def unit(column: str) -> str: ...
def frame_times(folder: _Path) -> list[float]: ...
def frame(folder: _Path, number: int, solids: bool) -> dict[str, Any]: ...
