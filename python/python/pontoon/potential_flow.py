"""Linear potential flow beside a run: bodies of a scene for Capytaine, and its added mass, damping and RAO over measured ones.

>>> from pontoon import potential_flow                                      # doctest: +SKIP
>>> bodies = potential_flow.export_bodies("wigley", "hull")                 # doctest: +SKIP
>>> computed = bodies.solve(np.linspace(2.0, 10.0, 9))                      # doctest: +SKIP
>>> computed.added_mass("heave")                                            # doctest: +SKIP

Needs `capytaine`, an extra: pip install "pontoon-sph[capytaine]". Motions are named as the columns of a motion probe: surge, sway and
heave along x, y and z; roll, pitch and yaw about the axes through the reference point, the centre of mass of a free solid.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import FileError, usage
from .run import Rao, Run, Series
from .scene import Scene

if TYPE_CHECKING:
    import pandas
    import xarray

Floats = NDArray[np.float64]

#: The motions of a body, in the order of the rows and columns of its matrices.
MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")

#: The column of the load of each translation in the table of a force probe of a 3-D scene.
_LOADS = ("fx_N", "fy_N", "fz_N")


@dataclass(frozen=True)
class PanelledBody:
    """A body of a scene with panels on its surface below the still water. The origin of its frame lies in the still water.

    Attributes:
        name: name of the solid.
        role: "free", "driven" or "fixed".
        mesh: the file of its panels, in the format GDF.
        displaced_volume: volume of the displaced water, m³.
        centre_of_buoyancy: m: (3,).
        reference_point: the centre of mass of a free solid, the origin of the frame of another, m: (3,).
        mass: kg; None unless the solid is free.
        inertia: about the centre of mass along the axes of the scene, kg m²: (3, 3); None unless the solid is free.
        stiffness: hydrostatic stiffness about the reference point, N/m, N and N m: (6, 6), in the order of `MOTIONS`.
        enclosed_water: mass of the water inside of the hull, which moves with it and is not part of `mass`, kg.
    """

    name: str
    role: str
    mesh: Path
    displaced_volume: float
    centre_of_buoyancy: Floats
    reference_point: Floats
    mass: float | None
    inertia: Floats | None
    stiffness: Floats
    enclosed_water: float = 0.0


class PanelledBodies:
    """The folder that `export_bodies` or `pontoon export SCENE --capytaine FOLDER` wrote.

    Attributes:
        folder: the folder.
        title: caption of the scene.
        density: of the water, kg/m³.
        depth: of the still water, m. The bed counts as level.
        gravity: m/s².
        bodies: the bodies by the name of the solid.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        try:
            content: dict[str, Any] = json.loads((self.folder / "bodies.json").read_text(encoding="utf-8"))
        except OSError as why:
            what = f"{self.folder} holds no exported bodies: {why.strerror or why}"
            raise FileError(what, code="file-not-found", message=what, help="export_bodies writes them") from None
        water = content["water"]
        self.title = str(content["title"])
        self.density = float(water["density_kg_m3"])
        self.depth = float(water["depth_m"])
        self.gravity = float(water["gravity_m_s2"])
        self.bodies = {body["name"]: self._body(body) for body in content["bodies"]}

    def _body(self, content: dict[str, Any]) -> PanelledBody:
        inertia = content["inertia_kg_m2"]
        return PanelledBody(
            name=content["name"],
            role=content["role"],
            mesh=self.folder / content["mesh"],
            displaced_volume=content["displaced_volume_m3"],
            centre_of_buoyancy=np.array(content["centre_of_buoyancy_m"]),
            reference_point=np.array(content["reference_point_m"]),
            mass=content["mass_kg"],
            inertia=None if inertia is None else np.array(inertia),
            stiffness=np.array(content["hydrostatic_stiffness"]),
            enclosed_water=content.get("enclosed_water_kg", 0.0),
        )

    def __getitem__(self, solid: str) -> PanelledBody:
        """Returns the body of the solid with this name."""
        if solid not in self.bodies:
            raise usage(f"there is no body called {solid!r}", f"the bodies are: {', '.join(self.bodies)}")
        return self.bodies[solid]

    def solve(
        self,
        omega: ArrayLike,
        *,
        solid: str | None = None,
        motions: Sequence[str] = MOTIONS,
        direction: float = 0.0,
    ) -> PotentialFlow:
        """Computes radiation and diffraction of one body with Capytaine, as if it were alone in water of equal depth.

        A lid inside of the hull suppresses irregular frequencies.

        Args:
            omega: angular frequencies, rad/s: (N,).
            solid: the body; by default the only one.
            motions: the motions that are free, of `MOTIONS`.
            direction: direction in which the wave travels, rad from the x axis.
        """
        if solid is None and len(self.bodies) != 1:
            raise usage(f"there are {len(self.bodies)} bodies", f"name one of them as solid: {', '.join(self.bodies)}")
        body = self[next(iter(self.bodies)) if solid is None else solid]
        for motion in motions:
            _number(motion)
        try:
            import capytaine
            import xarray
        except ImportError:
            raise usage("capytaine is not installed", 'pip install "pontoon-sph[capytaine]"') from None

        frequencies = np.atleast_1d(np.asarray(omega, dtype=float))
        if not (frequencies > 0.0).all():
            raise usage("an angular frequency is not positive", "give frequencies above 0 rad/s")
        mesh = capytaine.load_mesh(str(body.mesh))
        hull = capytaine.FloatingBody(
            mesh=mesh,
            lid_mesh=mesh.generate_lid(),
            dofs=capytaine.rigid_body_dofs(rotation_center=tuple(body.reference_point)),
            name=body.name,
        ).with_only_dofs([motion.capitalize() for motion in motions])
        asked = xarray.Dataset(
            coords={
                "omega": frequencies,
                "wave_direction": [direction],
                "radiating_dof": list(hull.dofs),
                "water_depth": [self.depth],
                "rho": [self.density],
                "g": [self.gravity],
            }
        )
        dataset = capytaine.BEMSolver().fill_dataset(asked, hull, progress_bar=False, hydrostatics=False)
        return PotentialFlow(self, body, tuple(motions), direction, dataset)


class PotentialFlow:
    """Linear hydrodynamics of a body over frequency.

    Attributes:
        body: the body.
        motions: the motions that are free.
        omega: angular frequencies, rad/s: (N,).
        direction: direction in which the wave travels, rad from the x axis.
        dataset: what Capytaine returned, with its signs: exp(−iωt), amplitudes of a wave of 1 m.
    """

    def __init__(
        self,
        bodies: PanelledBodies,
        body: PanelledBody,
        motions: tuple[str, ...],
        direction: float,
        dataset: xarray.Dataset,
    ) -> None:
        self._bodies = bodies
        self.body, self.motions, self.direction, self.dataset = body, motions, direction, dataset
        self.omega: Floats = np.asarray(dataset.omega.values, dtype=float)

    def _matrix(self, name: str) -> Floats:
        """Returns a matrix of the data set over frequency: (N, M, M) in the order of `motions`."""
        order = [motion.capitalize() for motion in self.motions]
        matrix = self.dataset[name].sel(influenced_dof=order, radiating_dof=order)
        array: Floats = matrix.transpose("omega", "influenced_dof", "radiating_dof").values
        return array

    def _index(self, motion: str) -> int:
        if motion not in self.motions:
            raise usage(f"{motion!r} was not computed", f"the computed motions are: {', '.join(self.motions)}")
        return self.motions.index(motion)

    def added_mass(self, motion: str) -> Floats:
        """Returns the added mass (kg; kg m² of a rotation) of a motion: (N,)."""
        i = self._index(motion)
        return self._matrix("added_mass")[:, i, i]

    def damping(self, motion: str) -> Floats:
        """Returns the radiation damping (kg/s; kg m²/s of a rotation) of a motion: (N,)."""
        i = self._index(motion)
        return self._matrix("radiation_damping")[:, i, i]

    def exciting_load(self, motion: str) -> NDArray[np.complex128]:
        """Returns the load of a wave of 1 m amplitude on the fixed body (N; N m of a rotation): (N,), complex.

        Its phase is that by which the load leads the wave at the reference point.
        """
        self._index(motion)
        load = self.dataset.excitation_force.sel(influenced_dof=motion.capitalize()).isel(wave_direction=0)
        leading: NDArray[np.complex128] = np.conj(load.values * self._shift())
        return leading

    def _shift(self) -> NDArray[np.complex128]:
        """Returns the factor that moves the reference of the wave from the origin to the body: (N,)."""
        x, y, _ = self.body.reference_point
        along = x * math.cos(self.direction) + y * math.sin(self.direction)
        numbers = [wave_number(omega, self._bodies.depth, self._bodies.gravity) for omega in self.omega]
        shift: NDArray[np.complex128] = np.exp(-1j * np.array(numbers) * along)
        return shift

    def rao(self, motion: str) -> Rao:
        """Returns how a motion of the free body answers a wave: m/m, or degrees/m of a rotation, as `Run.rao`.

        The phase is positive if the motion leads the wave at the centre of mass. Nothing holds the body but water and weight.
        """
        i, body = self._index(motion), self.body
        if body.mass is None or body.inertia is None:
            raise usage(f"{body.name!r} is {body.role}: it has no mass and no RAO", "export a free solid")
        chosen = [_number(name) for name in self.motions]
        inertia = np.zeros((6, 6))
        inertia[:3, :3], inertia[3:, 3:] = (body.mass + body.enclosed_water) * np.eye(3), body.inertia
        inertia, stiffness = (matrix[np.ix_(chosen, chosen)] for matrix in (inertia, body.stiffness))
        omega = self.omega[:, None, None]
        impedance = stiffness - omega**2 * (inertia + self._matrix("added_mass"))
        # The sign of exp(iωt), as that of `exciting_load`.
        impedance = impedance + 1j * omega * self._matrix("radiation_damping")
        loads = np.stack([self.exciting_load(name) for name in self.motions], axis=1)
        answer = np.linalg.solve(impedance, loads[:, :, None])[:, i, 0]
        unit = 180.0 / math.pi if chosen[i] > 2 else 1.0
        return Rao(
            name="potential flow",
            motion=f"{body.name}.{motion}_{'deg' if chosen[i] > 2 else 'm'}",
            unit="°/m" if chosen[i] > 2 else "m/m",
            frequency=self.omega / (2.0 * math.pi),
            amplitude=unit * np.abs(answer),
            phase=np.degrees(np.angle(answer)),
            coherence=np.ones_like(self.omega),
        )


@dataclass(frozen=True)
class ForcedMotion:
    """What a run measured of a body that is driven to and fro.

    Attributes:
        motion: the motion, of `MOTIONS`.
        omega: angular frequency, rad/s.
        amplitude: of the motion, m or rad.
        added_mass: kg; kg m² of a rotation.
        damping: kg/s; kg m²/s of a rotation.
        mean_load: N; N m of a rotation.
        residual: root mean square of the load that the fit of two harmonics leaves, over that of the fit, –.
    """

    motion: str
    omega: float
    amplitude: float
    added_mass: float
    damping: float
    mean_load: float
    residual: float


@dataclass(frozen=True)
class Comparison:
    """Measured quantities and those of potential flow at the same frequency.

    Attributes:
        quantity: name with its unit.
        frequency: Hz: (N,).
        measured: (N,).
        computed: interpolated to the frequencies, NaN outside of the computed ones: (N,).
    """

    quantity: str
    frequency: Floats
    measured: Floats
    computed: Floats

    @property
    def difference(self) -> Floats:
        """Measured over computed, less 1: (N,)."""
        difference: Floats = self.measured / self.computed - 1.0
        return difference

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a table with a row for each frequency."""
        import pandas

        columns = {"frequency_hz": self.frequency, "measured": self.measured, "computed": self.computed}
        table: pandas.DataFrame = pandas.DataFrame({**columns, "difference": self.difference})
        table.attrs["quantity"] = self.quantity
        return table

    def plot(self, axes: Any) -> None:
        """Draws both over frequency into axes of matplotlib: the computed line, the measured points."""
        order = np.argsort(self.frequency)
        axes.plot(self.frequency[order], self.computed[order], marker="x", label="potential flow")
        axes.plot(self.frequency, self.measured, "o", label="measured")
        axes.set_xlabel("frequency (Hz)")
        axes.set_ylabel(self.quantity)
        axes.legend()

    def __str__(self) -> str:
        rows = zip(self.frequency, self.measured, self.computed, self.difference, strict=True)
        lines = [f"  {f:8.4g} Hz  {a:10.4g}  {b:10.4g}  {100.0 * d:+6.1f} %" for f, a, b, d in rows]
        return "\n".join([f"{self.quantity}: measured, potential flow, difference", *lines])


def export_bodies(
    scene: Scene | str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    solids: Sequence[str] = (),
    panels: int = 800,
) -> PanelledBodies:
    """Writes the panels of bodies below the still water and their properties, as `pontoon export SCENE --capytaine OUT`.

    Args:
        scene: a 3-D scene, a folder, a file, or the name of a scene that comes with the package.
        out: folder for the files.
        solids: names of the solids, driven and fixed ones too; by default all free ones.
        panels: about so many panels for each body; the time of a panel method grows with their square.

    Raises:
        UsageError: the scene is 2-D, gravity is not constant downwards, or a solid does not reach into the water.
        SceneError: the scene is wrong.
    """
    scene = scene if isinstance(scene, Scene) else Scene.read(scene)
    scene._native.export_bodies(os.fspath(out), list(solids), panels)
    return PanelledBodies(out)


def fit_forced_motion(
    t: ArrayLike,
    displacement: ArrayLike,
    load: ArrayLike,
    omega: float,
    *,
    motion: str = "heave",
    stiffness: float = 0.0,
    start: float | None = None,
) -> ForcedMotion:
    """Returns added mass and damping of a body that is driven to and fro, by least squares.

    Load and displacement are fitted by a mean, the harmonic of `omega` and the next one. With the amplitudes F and X of the first,
    F/X = ω² A − iω B − C.

    Args:
        t: times, s: (N,).
        displacement: of the motion, m or rad: (N,).
        load: of the water on the body along the motion, N or N m, without its weight: (N,).
        omega: angular frequency of the motion, rad/s.
        motion: its name.
        stiffness: hydrostatic stiffness C, N/m or N m.
        start: begin of the fit, s; by default all. The last whole number of periods is used.
    """
    times, x, f = (np.asarray(values, dtype=float) for values in (t, displacement, load))
    _number(motion)
    period = 2.0 * math.pi / omega
    whole = math.floor((times[-1] - (times[0] if start is None else start)) / period + 1e-9)
    if whole < 1:
        raise usage(f"the readings are shorter than a period of {period:.4g} s", "run longer, or begin earlier")
    chosen = times >= times[-1] - whole * period
    phase = omega * times[chosen]
    waves = [np.ones_like(phase), np.cos(phase), np.sin(phase), np.cos(2.0 * phase), np.sin(2.0 * phase)]
    basis = np.stack(waves, axis=1)
    coefficients = np.linalg.lstsq(basis, np.stack([x[chosen], f[chosen]], axis=1), rcond=None)[0]
    amplitude, answer = coefficients[1] - 1j * coefficients[2]
    if abs(amplitude) == 0.0:
        raise usage("the body does not move at this frequency", "give the angular frequency of its motion, rad/s")
    ratio = answer / amplitude
    fitted = basis @ coefficients[:, 1]
    return ForcedMotion(
        motion=motion,
        omega=omega,
        amplitude=float(abs(amplitude)),
        added_mass=float((ratio.real + stiffness) / omega**2),
        damping=float(-ratio.imag / omega),
        mean_load=float(coefficients[0, 1]),
        residual=float(np.linalg.norm(f[chosen] - fitted) / np.linalg.norm(fitted - coefficients[0, 1])),
    )


def measure_forced_motion(
    run: Run, body: PanelledBody, omega: float, *, motion: str = "heave", start: float | None = None
) -> ForcedMotion:
    """Returns added mass and damping of a driven solid from the motion and force probes of a 3-D run.

    Args:
        run: a run with the probes `motion = "NAME"` and `force = "NAME"` of the solid.
        body: the solid, as `export_bodies` gave it: its stiffness counts.
        omega: angular frequency of the motion, rad/s.
        motion: surge, sway or heave.
        start: begin of the fit, s. Exclude the ramp of the motion and the waves that walls reflect.
    """
    i = _number(motion)
    if i > 2:
        raise usage(f"{motion} is a rotation", "fit_forced_motion takes its angle and the moment about its axis")
    moved, load = (_series(run, body.name, *of) for of in (("motion", f"{motion}_m"), ("force", _LOADS[i])))
    if len(moved.t) != len(load.t) or not np.array_equal(moved.t, load.t):
        raise usage("motion and force were read at different times", "give both probes the same every")
    if moved._is_mean != load._is_mean:
        raise usage("one of motion and force is read as means, the other is not", "give both probes the same average")
    return fit_forced_motion(
        moved.t, moved.values, load.values, omega, motion=motion, stiffness=float(body.stiffness[i, i]), start=start
    )


def _series(run: Run, solid: str, kind: str, column: str) -> Series:
    """Returns the series with this column of the probe of this kind of the solid, by default the one without a name."""
    found = [str(probe["name"]) for probe in run._probes() if probe.get(kind) == solid]
    usual = solid if kind == "motion" else f"{solid}_{kind}"
    for names in ([name for name in found if name == usual], found):
        if len(names) == 1:
            return run.series[f"{names[0]}.{column}"]
    help = f'write one probe  {kind} = "{solid}"  without a name of its own into the scene'
    raise usage(f"the run has {len(found)} probes of the {kind} of {solid!r}", help)


def compare_forced_motions(measured: Sequence[ForcedMotion], computed: PotentialFlow) -> tuple[Comparison, Comparison]:
    """Returns added mass and damping of runs beside those of potential flow. All runs have the same motion."""
    if not measured:
        raise usage("there is no measured motion to compare", "fit_forced_motion and measure_forced_motion give some")
    motion = measured[0].motion
    if any(run.motion != motion for run in measured):
        raise usage("the runs have different motions", "compare each motion on its own")
    rotates = _number(motion) > 2
    omega = np.array([run.omega for run in measured])
    mass = np.array([run.added_mass for run in measured])
    damping = np.array([run.damping for run in measured])
    frequency = omega / (2.0 * math.pi)

    def beside(quantity: str, values: Floats, over_frequency: Floats) -> Comparison:
        return Comparison(quantity, frequency, values, _interpolated(omega, computed.omega, over_frequency))

    names = (f"added inertia in {motion} (kg m²)", f"damping in {motion} (kg m²/s)")
    if not rotates:
        names = (f"added mass in {motion} (kg)", f"damping in {motion} (kg/s)")
    return beside(names[0], mass, computed.added_mass(motion)), beside(names[1], damping, computed.damping(motion))


def compare_raos(measured: Rao, computed: Rao) -> Comparison:
    """Returns the amplitudes of an RAO of `Run.rao` beside those of `PotentialFlow.rao`."""
    if measured.unit != computed.unit:
        raise usage(f"an RAO in {measured.unit} is compared with one in {computed.unit}", "name the same motion")
    values = _interpolated(measured.frequency, computed.frequency, computed.amplitude)
    return Comparison(f"RAO of {measured.motion} ({measured.unit})", measured.frequency, measured.amplitude, values)


def wave_number(omega: float, depth: float, gravity: float = 9.81) -> float:
    """Returns the wave number k (1/m) with ω² = g k tanh(k d) for a depth d (m), by Newton's method."""
    k = omega * omega / gravity
    k = k / math.sqrt(math.tanh(min(k * depth, 50.0)))
    for _ in range(20):
        th = math.tanh(k * depth)
        k -= (gravity * k * th - omega * omega) / (gravity * th + gravity * k * depth * (1.0 - th * th))
    return k


def _number(motion: str) -> int:
    if motion not in MOTIONS:
        raise usage(f"there is no motion {motion!r}", f"the motions are: {', '.join(MOTIONS)}")
    return MOTIONS.index(motion)


def _interpolated(at: Floats, known: Floats, values: Floats) -> Floats:
    """Returns values at other frequencies, NaN outside of the known ones."""
    order = np.argsort(known)
    # Round-off at an end is inside.
    near = np.isclose(at, known[order[0]], rtol=1e-9) | np.isclose(at, known[order[-1]], rtol=1e-9)
    inside = near | ((at >= known[order[0]]) & (at <= known[order[-1]]))
    return np.where(inside, np.interp(at, known[order], values[order]), np.nan)
