"""Bodies for potential-flow solvers: panels, hydrostatics, measured and computed coefficients."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import pontoon as pt
from pontoon import potential_flow

from conftest import TANK_3D

#: Radius of a ball and depth of its water, m.
RADIUS, DEPTH = 0.15, 0.6

BALL = f"""
title = "A ball afloat"
dimension = 3
dp = 0.05
until = 0.1
gravity = 9.82

[[water]]
fill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [1.0, 1.0, {DEPTH}] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [1.0, 1.0, 0.9] }} }}

[[solid]]
name = "ball"
free = {{ density = 499.1, centre_offset = [0.0, 0.0, -0.05] }}
shape = {{ ball = {{ radius = {RADIUS} }} }}
at = {{ x = 0.5, y = 0.4, z = {DEPTH} }}

[model]
rho0 = 998.2
"""


def triangles(body: potential_flow.PanelledBody) -> np.ndarray:
    """Returns the corners of the panels of a file, m: (N, 3, 3)."""
    lines = body.mesh.read_text().splitlines()
    corners = np.array([line.split() for line in lines[4:]], dtype=float).reshape(int(lines[3]), 4, 3)
    assert np.array_equal(corners[:, 2], corners[:, 3]), "triangles"
    return corners[:, :3]


def test_a_ball_has_its_panels_mass_and_stiffness(tmp_path: Path) -> None:
    bodies = potential_flow.export_bodies(pt.Scene.from_toml(BALL), tmp_path / "bodies", panels=600)
    ball = bodies["ball"]
    assert (bodies.density, bodies.depth, bodies.gravity) == (998.2, DEPTH, 9.82)
    mass = 499.1 * 4.0 / 3.0 * math.pi * RADIUS**3
    assert ball.mass == pytest.approx(mass)
    assert ball.reference_point == pytest.approx([0.5, 0.4, -0.05]), "the centre of mass, from the still water"
    assert ball.inertia is not None and np.diag(ball.inertia) == pytest.approx(0.4 * mass * RADIUS**2)
    # The exact half ball; the derivative is a difference over 1e-4 of its size.
    assert ball.displaced_volume == pytest.approx(2.0 / 3.0 * math.pi * RADIUS**3, rel=1e-12)
    weight, plane = 998.2 * 9.82, math.pi * RADIUS**2
    assert ball.stiffness[2, 2] == pytest.approx(weight * plane, rel=1e-6)
    # A ball turns about its middle without a change of the buoyancy: the lever is that of the centre of mass.
    lever = weight * ball.displaced_volume * 0.05
    assert ball.stiffness[3, 3] == pytest.approx(lever, rel=1e-5)
    assert ball.stiffness[4, 4] == pytest.approx(lever, rel=1e-5)
    assert np.abs(ball.stiffness[[0, 1, 5]]).max() == 0.0

    corners = triangles(ball)
    # Twice the number would be another size of panels.
    assert 300 < len(corners) < 1200
    assert corners[:, :, 2].max() == 0.0, "cut at the still water"
    normal = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = corners.mean(axis=1)
    outward = middle - [0.5, 0.4, 0.0]
    assert (np.einsum("ij,ij->i", normal, outward) > 0.0).all(), "counter-clockwise seen from the water"
    # Chords lie within a ball of the same volume: 600 panels miss 1 % of the area.
    assert np.linalg.norm(normal, axis=1).sum() == pytest.approx(2.0 * math.pi * RADIUS**2, rel=0.02)
    assert (normal[:, 2] * middle[:, 2]).sum() == pytest.approx(ball.displaced_volume, rel=0.01)


def test_a_crate_has_the_stiffness_of_its_waterplane(tank_3d: pt.Scene, tmp_path: Path) -> None:
    bodies = potential_flow.export_bodies(tank_3d, tmp_path)
    crate, weight, volume = bodies["crate"], 1000.0 * 9.81, 0.4 * 0.3 * 0.1
    plane = 0.4 * 0.3
    assert crate.stiffness[2, 2] == pytest.approx(weight * plane, rel=1e-6)
    # Half of 0.2 m is under water: the centre of buoyancy lies 50 mm below the centre of mass.
    for i, (across, along) in ((3, (0.3, 0.4)), (4, (0.4, 0.3))):
        exact = weight * (along * across**3 / 12.0 - 0.05 * volume)
        assert crate.stiffness[i, i] == pytest.approx(exact, rel=1e-5)
    # Flat panels are exact.
    corners = triangles(crate)
    normal = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (normal[:, 2] * corners.mean(axis=1)[:, 2]).sum() == pytest.approx(volume, rel=1e-6)
    assert np.linalg.norm(normal, axis=1).sum() == pytest.approx(plane + 2.0 * 0.7 * 0.1, rel=1e-6)
    assert bodies.bodies.keys() == {"crate"}, "the tank is not free"


def test_what_has_no_panels_is_refused_with_a_remedy(tank: pt.Scene, tank_3d: pt.Scene, tmp_path: Path) -> None:
    with pytest.raises(pt.UsageError, match="2-D"):
        potential_flow.export_bodies(tank, tmp_path)
    with pytest.raises(pt.UsageError, match='did you mean "crate"'):
        potential_flow.export_bodies(tank_3d, tmp_path, solids=["crat"])
    with pytest.raises(pt.UsageError, match="panel"):
        potential_flow.export_bodies(tank_3d, tmp_path, panels=0)
    tank_3d["solid.crate.at"] = {"x": 0.5, "y": 0.3, "bottom": 0.7}
    with pytest.raises(pt.UsageError, match="no free solid"):
        potential_flow.export_bodies(tank_3d, tmp_path)
    with pytest.raises(pt.UsageError, match="reach into the water"):
        potential_flow.export_bodies(tank_3d, tmp_path, solids=["crate"])
    tank_3d["gravity"] = [1.0, 0.0, -9.81]
    with pytest.raises(pt.UsageError, match="gravity"):
        potential_flow.export_bodies(tank_3d, tmp_path)
    with pytest.raises(pt.FileError, match="no exported bodies"):
        potential_flow.PanelledBodies(tmp_path / "none")


def test_a_fit_recovers_mass_and_damping() -> None:
    # Uneven times, a second harmonic and a mean, as a run has them; the fit is exact up to round-off.
    omega, mass, damping, stiffness = 8.0, 3.0, 14.0, 690.0
    t = np.sort(np.random.default_rng(1).uniform(0.0, 3.0, 2000))
    x = 0.03 * np.sin(omega * t + 0.3)
    v = 0.03 * omega * np.cos(omega * t + 0.3)
    load = mass * omega**2 * x - damping * v - stiffness * x + 68.0 + 2.0 * np.cos(2.0 * omega * t)
    fitted = potential_flow.fit_forced_motion(t, x, load, omega, stiffness=stiffness)
    assert fitted.added_mass == pytest.approx(mass, rel=1e-9) and fitted.damping == pytest.approx(damping, rel=1e-9)
    assert fitted.mean_load == pytest.approx(68.0) and fitted.amplitude == pytest.approx(0.03)
    assert fitted.residual < 1e-9
    with pytest.raises(pt.UsageError, match="period"):
        potential_flow.fit_forced_motion(t, x, load, 1.0)
    with pytest.raises(pt.UsageError, match="does not move"):
        potential_flow.fit_forced_motion(t, 0.0 * x, load, omega)
    with pytest.raises(pt.UsageError, match="motion"):
        potential_flow.fit_forced_motion(t, x, load, omega, motion="heaven")


def test_a_driven_body_is_measured_from_its_probes(tank_3d: pt.Scene, tmp_path: Path) -> None:
    # The numbers of so short a run mean nothing; the fit of the series is that of the run.
    text = TANK_3D.replace("free = { density = 500.0 }", "FREE").replace('draft = "equilibrium"', "z = 0.5")
    text = text.replace(
        "FREE", 'driven = { along = [0.0, 0.0, 1.0], distance = { formula = "0.01*sin(80*t)" } }'
    )
    scene = pt.Scene.from_toml(text + '\n[[probe]]\nmotion = "crate"\n\n[[probe]]\nforce = "crate"\n')
    run = pt.run(scene, out=tmp_path / "run", report=False)
    body = potential_flow.export_bodies(scene, tmp_path / "bodies", solids=["crate"])["crate"]
    assert body.role == "driven" and body.mass is None and body.inertia is None
    measured = potential_flow.measure_forced_motion(run, body, 80.0)
    assert measured.amplitude == pytest.approx(0.01, rel=0.05) and measured.added_mass > 0.0
    with pytest.raises(pt.UsageError, match="rotation"):
        potential_flow.measure_forced_motion(run, body, 80.0, motion="roll")
    # Series of another solid are not those of the body, and means do not belong to the times of other readings.
    lid = replace(body, name="crat")
    with pytest.raises(pt.UsageError, match="0 probes of the motion of 'crat'"):
        potential_flow.measure_forced_motion(run, lid, 80.0)
    scene["probe.crate_force.average"] = True
    means = pt.run(scene, out=tmp_path / "means", report=False)
    with pytest.raises(pt.UsageError, match="same average"):
        potential_flow.measure_forced_motion(means, body, 80.0)


def test_capytaine_has_the_same_stiffness_and_the_coefficients_of_theory(tmp_path: Path) -> None:
    capytaine = pytest.importorskip("capytaine")
    bodies = potential_flow.export_bodies(pt.Scene.from_toml(BALL), tmp_path, panels=600)
    ball = bodies["ball"]
    # Another program's integrals over the same panels: the chords take 1 % off the waterplane.
    own = capytaine.FloatingBody(
        mesh=capytaine.load_mesh(str(ball.mesh)),
        dofs=capytaine.rigid_body_dofs(rotation_center=tuple(ball.reference_point)),
        center_of_mass=ball.reference_point,
        mass=ball.mass,
    )
    theirs = own.compute_hydrostatic_stiffness(rho=bodies.density, g=bodies.gravity).values
    assert np.abs(theirs - ball.stiffness).max() < 0.02 * ball.stiffness[2, 2]

    low = 0.8
    computed = bodies.solve([low, 8.0], motions=["surge", "heave", "pitch"])
    # Exact: tests/references/linear_waves.py. Capytaine has 3.17 and 14.8 with 480 flat panels, 4 % more.
    assert computed.added_mass("heave")[1] == pytest.approx(3.040, rel=0.06)
    assert computed.damping("heave")[1] == pytest.approx(14.25, rel=0.06)
    # In a long wave a body moves as the water of the surface: up and down with it, and to and fro by coth(k d), a quarter of a
    # period behind. The wave is 19 m long, 126 radii.
    heave, surge = computed.rao("heave"), computed.rao("surge")
    k = potential_flow.wave_number(low, DEPTH, bodies.gravity)
    assert heave.amplitude[0] == pytest.approx(1.0, abs=0.02) and abs(heave.phase[0]) < 3.0
    assert surge.amplitude[0] == pytest.approx(1.0 / math.tanh(k * DEPTH), rel=0.05)
    assert surge.phase[0] == pytest.approx(-90.0, abs=3.0) and surge.unit == "m/m"
    assert computed.rao("pitch").unit == "°/m"

    measured = potential_flow.ForcedMotion("heave", 8.0, 0.03, 3.2, 15.0, 0.0, 0.0)
    mass, damping = potential_flow.compare_forced_motions([measured], computed)
    assert mass.difference[0] == pytest.approx(3.2 / computed.added_mass("heave")[1] - 1.0)
    assert "kg/s" in str(damping) and len(mass.to_pandas()) == 1
    beside = potential_flow.compare_raos(heave, computed.rao("heave"))
    assert np.abs(beside.difference).max() < 1e-12
    with pytest.raises(pt.UsageError, match="m/m"):
        potential_flow.compare_raos(heave, computed.rao("pitch"))
    with pytest.raises(pt.UsageError, match="not computed"):
        computed.damping("sway")


def test_the_command_writes_the_same_files(tmp_path: Path) -> None:
    from pontoon._pontoon import main as command_line

    scene = tmp_path / "scene.toml"
    scene.write_text(BALL, encoding="utf-8")
    assert command_line(["pontoon", "export", str(scene), "--capytaine", str(tmp_path / "a"), "--panels", "200"]) == 0
    potential_flow.export_bodies(scene, tmp_path / "b", panels=200)
    for name in ("bodies.json", "ball.gdf"):
        assert (tmp_path / "a" / name).read_text() == (tmp_path / "b" / name).read_text()
