"""Simulations: stepped, controlled, read, changed, saved."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from types import TracebackType
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _toml
from ._errors import usage
from ._pontoon import BodyState, BodyStep, Lease, NativeScene, NativeSimulation
from .probes import Probe
from .scene import Scene

Floats = NDArray[np.float64]
S = TypeVar("S", bound="_Stepped")


class Reading(dict[str, float]):
    """The columns of a probe with their values. `float(reading)` is the value of a probe with one column."""

    def __float__(self) -> float:
        if len(self) != 1:
            raise usage(f"the probe has {len(self)} columns, not one", f"choose one of: {', '.join(self)}")
        return next(iter(self.values()))


class Contact(NamedTuple):
    """A contact of two solids in the last step.

    Attributes:
        between: names of both solids.
        normal_force: sum of the normal forces, N (N/m in 2-D).
        at: point of action, m: (D,).
    """

    between: tuple[str, str]
    normal_force: float
    at: Floats


class JointReading(NamedTuple):
    """What a joint felt in the last step.

    Attributes:
        position: coordinate from the start, m or rad.
        rate: its rate, m/s or rad/s.
        motor_force: force of the motor, N or N m (per metre in 2-D).
        absorbed_energy: energy that the motor took from the solids since the start, J (J/m in 2-D).
    """

    position: float
    rate: float
    motor_force: float
    absorbed_energy: float

    @property
    def absorbed_power(self) -> float:
        """Power that the motor takes from the solids now, W (W/m in 2-D)."""
        return -self.motor_force * self.rate


class SpringReading(NamedTuple):
    """A spring in the last step and its parameters; forces are per metre in 2-D.

    Attributes:
        length: m.
        tension: N; negative where it pushes.
        stiffness: N/m.
        damping: N s/m.
        rest_length: m.
    """

    length: float
    tension: float
    stiffness: float
    damping: float
    rest_length: float


class WaterView:
    """Read-only arrays on the memory of the water, without a copy.

    While the view is open, or one of its arrays is alive, the simulation refuses to step: its arrays would move. After
    `close` the view gives no more arrays.
    """

    def __init__(self, native: NativeSimulation) -> None:
        self._native = native
        self._lease: Lease | None = native.lease()

    def _array(self, name: str) -> Any:
        if self._lease is None:
            raise usage("this view of the water is closed", "open another with sim.water.view()")
        return self._native.water_view(name)

    @property
    def position(self) -> Floats:
        """Positions, m: (N, D)."""
        array: Floats = self._array("position")
        return array

    @property
    def velocity(self) -> Floats:
        """Velocities, m/s: (N, D)."""
        array: Floats = self._array("velocity")
        return array

    @property
    def density(self) -> Floats:
        """Densities, kg/m³: (N,)."""
        array: Floats = self._array("density")
        return array

    @property
    def id(self) -> NDArray[np.uint32]:
        """Names of the particles for life: (N,). The order of particles changes from step to step."""
        array: NDArray[np.uint32] = self._array("id")
        return array

    def close(self) -> None:
        """Closes the view. Arrays that are still in use hold the simulation until they are gone."""
        self._lease = None

    def __enter__(self) -> WaterView:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Water:
    """The water of a simulation. Each attribute is a copy; the order of particles changes from step to step."""

    def __init__(self, native: NativeSimulation) -> None:
        self._native = native

    def __len__(self) -> int:
        return self._native.particles()

    @property
    def position(self) -> Floats:
        """Positions, m: (N, D)."""
        array: Floats = self._native.water("position")
        return array

    @property
    def velocity(self) -> Floats:
        """Velocities, m/s: (N, D)."""
        array: Floats = self._native.water("velocity")
        return array

    @property
    def density(self) -> Floats:
        """Densities, kg/m³: (N,)."""
        array: Floats = self._native.water("density")
        return array

    @property
    def pressure(self) -> Floats:
        """Pressures, Pa: (N,)."""
        array: Floats = self._native.water("pressure")
        return array

    @property
    def acceleration(self) -> Floats:
        """Accelerations at the last force pass, m/s²: (N, D)."""
        array: Floats = self._native.water("acceleration")
        return array

    @property
    def id(self) -> NDArray[np.uint32]:
        """Names of the particles for life: (N,)."""
        array: NDArray[np.uint32] = self._native.water("id")
        return array

    def view(self) -> WaterView:
        """Opens read-only arrays on the memory of the water, to be used in a `with` block."""
        return WaterView(self._native)


class Solids(Mapping[str, BodyState]):
    """The solids of a simulation by name, as they are now."""

    def __init__(self, native: NativeSimulation) -> None:
        self._native = native

    def __getitem__(self, name: str) -> BodyState:
        return self._native.body(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._native.all_names()[0])

    def __len__(self) -> int:
        return len(self._native.all_names()[0])


class _Stepped:
    """What all simulations have."""

    _hosted = False

    def __init__(self, scene: Scene, *, threads: int | None = None) -> None:
        self._scene = scene.copy()
        self._threads = threads
        self._added: list[str] = []
        self._probes: dict[str, NativeScene] = {}
        self._own: NativeSimulation | None = scene._native.build(self._hosted, threads)

    @property
    def _native(self) -> NativeSimulation:
        if self._own is None:
            raise usage("the simulation is closed", "build another from its scene")
        return self._own

    def __enter__(self: S) -> S:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Frees the memory of the simulation."""
        self._own = None

    @property
    def scene(self) -> Scene:
        """A copy of the scene."""
        return self._scene.copy()

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._native.clock()[0]

    @property
    def dt(self) -> float:
        """Length of the last step, s."""
        return self._native.clock()[1]

    @property
    def steps(self) -> int:
        """Number of steps so far."""
        return self._native.clock()[2]

    @property
    def step_limit(self) -> float:
        """Longest step that the present state allows, s."""
        return self._native.clock()[3]

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._native.dimension

    @property
    def threads(self) -> int:
        """Number of threads. It changes the speed, never the result."""
        return self._native.threads

    @property
    def water(self) -> Water:
        """The water."""
        return Water(self._native)

    @property
    def solids(self) -> Solids:
        """The solids by name."""
        return Solids(self._native)

    def __getitem__(self, name: str) -> BodyState:
        """Returns the solid called `name`, as it is now."""
        return self._native.body(name)

    def read(self, probe: Probe) -> Reading:
        """Reads a probe now, as `sim.read(pt.elevation(at=1.2))["eta_m"]`.

        Returns the values by column; a value is NaN where there is nothing to measure. Displacements, rises of the water and
        potential energies count from the start of the scene, displacements of a solid added later from this reading.

        Args:
            probe: a dictionary with the keys of a `[[probe]]` section; `pt.elevation` and others make them.

        Raises:
            SceneError: the probe is wrong.
            UsageError: it reads records that the scene does not ask for.
        """
        text = _toml.value(probe)
        scene = self._probes.get(text)
        if scene is None:
            # The probe stands alone in a scene like this one, so that the program checks it.
            alone = [("check", "[]"), ("statistic", "[]"), ("probe", f"[{text}]")]
            scene = self._scene._native.with_overrides(alone[:2])
            scene = scene.with_solids(self._added) if self._added else scene
            scene = self._probes[text] = scene.with_overrides(alone[2:])
        return Reading(next(iter(self._native.read_probes(scene).values())))

    def sample(self) -> dict[str, Reading]:
        """Reads all probes of the scene now, by the name of the probe. Cumulative columns count from here."""
        return {name: Reading(columns) for name, columns in self._native.read_probes(None).items()}

    def events(self) -> list[str]:
        """Beginnings and ends of joints, springs, ropes and solids, and rollbacks, as sentences."""
        return self._native.events()

    def time_spent(self) -> dict[str, float]:
        """Wall time so far (s): all steps, and of them neighbour lists, pairs, bodies, callbacks."""
        return dict(zip(("steps", "lists", "pairs", "bodies", "callbacks"), self._native.time_spent(), strict=True))

    def save(self) -> bytes:
        """Returns the state, from which `restore` goes on to the same bits."""
        return self._native.save()

    def restore(self, state: bytes) -> None:
        """Returns to a saved state of this simulation, or of one built alike with the same solids added and removed.

        Raises:
            RestartError: the state was saved before a solid was added or removed, is damaged or belongs to another scene.
                The simulation is as before.
        """
        self._native.restore(state)

    def add_solid(self, solid: Mapping[str, Any]) -> int:
        """Adds a solid between two steps, and returns the number of water particles that it displaced.

        Args:
            solid: the keys of a `[[solid]]` section, as `{"name": "crate", "free": {"density": 300},
                "shape": {"box": {"size": [0.2, 0.2]}}, "at": [1.0, 0.6]}`.

        Raises:
            SceneError: the solid is wrong, or overlaps another by more than 0.05 dp. Nothing has changed then.
        """
        text = _toml.section(solid)
        displaced = self._native.add_solid(self._scene._native, text)
        self._added.append(text)
        return displaced

    def remove_solid(self, name: str) -> None:
        """Removes a solid to which nothing is tied. Its name stays in use."""
        self._native.remove_solid(name)

    def __getstate__(self) -> dict[str, Any]:
        state = {"scene": self._scene, "threads": self._threads, "added": list(self._added), "state": self.save()}
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._scene, self._threads, self._added = state["scene"], state["threads"], list(state["added"])
        self._probes = {}
        self._own = self._scene._native.build(self._hosted, self._threads)
        self._own.restore_with_added(state["state"], self._scene._native, self._added)

    def __repr__(self) -> str:
        if self._own is None:
            return f"<{type(self).__name__}, closed>"
        time, _, steps, _ = self._own.clock()
        return f"<{type(self).__name__} of {self._scene.title!r}: t = {time:.6g} s, {steps} steps>"


class Simulation(_Stepped):
    """Water and solids moving through time; a context manager that frees the memory at its end.

    The interpreter's lock is released while it steps. `pickle` and `copy.deepcopy` keep the state to the bit.
    """

    def step(self, control: Callable[[BodyStep], object] | None = None) -> None:
        """Goes on by one step of the largest allowed length.

        Args:
            control: called between water and bodies; see `advance`.

        Raises:
            Fault: a particle or body left the valid range again after a rollback.
        """
        self._native.advance(math.inf, True, control, 0.0)

    def advance(
        self,
        until: float | None = None,
        *,
        control: Callable[[BodyStep], object] | None = None,
        every: float | None = None,
    ) -> None:
        """Goes on to the time `until`, by default that of the scene.

        Signals are looked at every 0.05 s: Ctrl-C raises KeyboardInterrupt between two steps, and the simulation can
        go on. An exception of `control` is raised after its step.

        Args:
            until: simulated time at the end, s.
            control: called with a `BodyStep` when the water has moved and the bodies have not: reads loads and
                motions, pushes bodies, drives joints, changes springs. Pushes act until the next call. It runs in a
                thread of the simulation.
            every: interval of the calls after that in the first step, s; by default each step.

        Raises:
            Fault: a particle or body left the valid range again after a rollback.
        """
        if every is not None and not every >= 0.0:
            raise usage(f"every = {every} s is no interval", "give 0 or more")
        end = self._scene.until if until is None else float(until)
        if math.isnan(end):
            raise usage("until = nan is no time", "give seconds")
        self._native.advance(end, False, control, 0.0 if every is None else float(every))

    def push(self, name: str, force: ArrayLike, *, at: ArrayLike | None = None) -> None:
        """Pushes a free solid with `force` (N; N/m in 2-D) at a world point (m), by default its centre, in the next step."""
        place = None if at is None else np.asarray(at, dtype=float).tolist()
        self._native.push(name, np.asarray(force, dtype=float).tolist(), place)

    def set_velocity(self, name: str, velocity: ArrayLike, spin: ArrayLike = 0.0) -> None:
        """Gives a free solid a velocity of its centre of mass (m/s) and a spin (rad/s; a number in 2-D), at once."""
        turn = np.asarray(spin, dtype=float)
        if turn.ndim == 0 and self.dimension == 3:
            turn = np.full(3, float(turn)) if float(turn) == 0.0 else turn
        self._native.set_velocity(name, np.asarray(velocity, dtype=float).tolist(), turn.tolist())

    def contacts(self) -> list[Contact]:
        """Contacts of solids in the last step."""
        return [Contact((a, b), force, np.array(at)) for a, b, force, at in self._native.contacts()]

    @property
    def joints(self) -> list[str]:
        """Names of the joints."""
        return self._native.all_names()[1]

    @property
    def springs(self) -> list[str]:
        """Names of the springs."""
        return self._native.all_names()[2]

    def joint(self, name: str) -> JointReading:
        """Coordinate, rate and motor of a joint in the last step."""
        return JointReading(*self._native.joint(name))

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
        max_force: float = math.inf,
    ) -> None:
        """Drives a hinge or a slider from now on with F = force + stiffness (position − x) + damping (velocity − ẋ).

        Units are N, m of a slider and N m, rad of a hinge (forces per metre in 2-D); |F| is at most `max_force`. `torque` is
        another name of `force`.

        Raises:
            UnknownNameError: there is no such joint.
            UsageError: both `force` and `torque` are given, or a number is not finite or negative where it must not be.
        """
        self._native.drive(name, [force, torque], [position, velocity, stiffness, damping, max_force])

    def release(self, name: str) -> None:
        """Gives a joint back to the motor that it has in the scene, or to none."""
        self._native.release(name)

    def spring(self, name: str) -> SpringReading:
        """Length, tension and parameters of a spring."""
        length, tension = self._native.spring(name)
        return SpringReading(length, tension, *self._native.set_spring(name, [None, None, None]))

    def set_spring(
        self,
        name: str,
        *,
        stiffness: float | None = None,
        damping: float | None = None,
        rest_length: float | None = None,
    ) -> None:
        """Changes stiffness (N/m), damping (N s/m) or rest length (m) of a spring from now on."""
        self._native.set_spring(name, [stiffness, damping, rest_length])


class Motion(NamedTuple):
    """Motion of a body that another program moves, at the end of a step.

    Attributes:
        position: world position of the origin of its frame, m: (D,).
        velocity: of its centre of mass, m/s: (D,).
        rotation: an angle (rad) in 2-D; a matrix (3, 3) or a quaternion (w, x, y, z) in 3-D; by default none.
        spin: rad/s: a number in 2-D, (3,) in 3-D; by default 0.
        centre: world position of its centre of mass, m: (D,); by default that of the solid in the scene.
    """

    position: ArrayLike
    velocity: ArrayLike
    rotation: ArrayLike | None = None
    spin: ArrayLike | None = None
    centre: ArrayLike | None = None


class HostedSimulation(_Stepped):
    """Water around bodies that another program moves: forces out, motions in.

    It does not roll back after an alarm, because the other program cannot.
    """

    _hosted = True

    def __init__(self, scene: Scene, *, threads: int | None = None) -> None:
        super().__init__(scene, threads=threads)
        self._arms: dict[str, Floats] = {}

    def __setstate__(self, state: dict[str, Any]) -> None:
        super().__setstate__(state)
        self._arms = {}

    def step(self, host: Callable[[BodyStep], Mapping[str, Motion]], *, until: float = math.inf) -> None:
        """Goes on by one step, not past the time `until` (s).

        Args:
            host: called when the water has moved: takes `h.loads` and `h.dt`, moves its bodies by that time, and
                returns the motion of each free solid by name.

        Raises:
            UsageError: a free solid has no motion, or one that is not finite.
        """
        self._native.advance(float(until), True, self._exchange(host), 0.0)

    def advance(self, until: float, host: Callable[[BodyStep], Mapping[str, Motion]]) -> None:
        """Steps with `host` to the time `until` (s). Signals and exceptions are those of `Simulation.advance`.

        Raises:
            UsageError: as `step`.
        """
        if math.isnan(until):
            raise usage("until = nan is no time", "give seconds")
        self._native.advance(float(until), False, self._exchange(host), 0.0)

    def _exchange(self, host: Callable[[BodyStep], Mapping[str, Motion]]) -> Callable[[BodyStep], None]:
        """Returns the function that calls `host` in a step and sets the motions that it returns."""

        def exchange(step: BodyStep) -> None:
            motions = host(step)
            if not isinstance(motions, Mapping) or not all(isinstance(motion, Motion) for motion in motions.values()):
                raise usage(f"the host has returned {motions!r}", "return a dictionary: a Motion by the name of each solid")
            for name, motion in motions.items():
                self._set(step, name, motion)

        return exchange

    def _set(self, step: BodyStep, name: str, motion: Motion) -> None:
        dimension = self.dimension
        rotation = _matrix(motion.rotation, dimension)
        position = np.asarray(motion.position, dtype=float)
        if motion.centre is None:
            arm = self._arms.get(name)
            if arm is None:
                state = step[name]
                arm = _matrix(state.rotation, dimension).T @ (state.centre - state.position)
                self._arms[name] = arm
            centre = position + rotation @ arm
        else:
            centre = np.asarray(motion.centre, dtype=float)
        spin: Any = motion.spin
        if spin is None:
            spin = 0.0 if dimension == 2 else np.zeros(3)
        step.set_motion(
            name,
            position.tolist(),
            rotation.ravel().tolist(),
            centre.tolist(),
            np.asarray(motion.velocity, dtype=float).tolist(),
            np.asarray(spin, dtype=float).tolist(),
        )


def _matrix(rotation: ArrayLike | None, dimension: int) -> Floats:
    """Returns a rotation matrix from an angle, a matrix or a quaternion."""
    if rotation is None:
        return np.eye(dimension)
    given = np.asarray(rotation, dtype=float)
    if given.ndim == 2:
        return given
    if dimension == 2 and given.size == 1:
        c, s = math.cos(float(given.ravel()[0])), math.sin(float(given.ravel()[0]))
        return np.array([[c, -s], [s, c]])
    if given.shape != (4,):
        help = "give an angle in 2-D, a matrix (3, 3) or a quaternion (w, x, y, z) in 3-D"
        raise usage(f"a rotation has no shape {given.shape}", help)
    w, x, y, z = (given / np.linalg.norm(given)).tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )

