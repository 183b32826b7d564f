"""Bodies of another program: forces out, motions in."""

from collections.abc import Callable

import numpy as np
import pytest

import pontoon as pt

from conftest import TANK, TANK_3D


def test_a_body_of_another_program_moves_as_one_of_the_own(tank: pt.Scene) -> None:
    # Two integrators of one body: a symplectic Euler step, as rapier does.
    own, hosted = tank.build(), tank.build_hosted()
    mass, gravity = own["crate"].mass, np.array([0.0, -9.81])
    assert mass is not None
    inertia = mass * (0.3**2 + 0.2**2) / 12.0
    start = hosted["crate"]
    position, velocity, angle, spin = start.position, start.velocity, float(start.rotation), float(start.spin)

    def host(h: pt.BodyStep) -> dict[str, pt.Motion]:
        nonlocal position, velocity, angle, spin
        load = h.loads["crate"]
        velocity = velocity + h.dt * (load.force / mass + gravity)
        spin += h.dt * load.torque / inertia
        position = position + h.dt * velocity
        angle += h.dt * spin
        return {"crate": pt.Motion(position, velocity, angle, spin)}

    own.advance(0.1)
    hosted.advance(0.1, host)
    assert hosted.time == own.time == 0.1
    # The motions differ by the steps of the integrators only: far below the 3 mm that the crate has moved.
    assert hosted["crate"].centre == pytest.approx(own["crate"].centre, abs=1e-5)
    assert hosted["crate"].velocity == pytest.approx(own["crate"].velocity, abs=1e-3)


def test_a_body_in_3d_takes_matrices_and_quaternions() -> None:
    scene = pt.Scene.from_toml(TANK_3D)
    half = np.sqrt(0.5)
    quaternion = np.array([half, 0.0, 0.0, half])
    matrix = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for rotation in (quaternion, matrix):
        sim = scene.build_hosted()
        at = sim["crate"].position + [0.0, 0.0, 0.001]
        sim.step(lambda h: {"crate": pt.Motion(at, [0.0, 0.0, 1.0], rotation, [0.0, 0.0, 2.0])})
        assert sim["crate"].rotation == pytest.approx(matrix, abs=1e-12)
        assert sim["crate"].position == pytest.approx(at) and sim["crate"].spin == pytest.approx([0.0, 0.0, 2.0])


def test_a_body_without_motion_is_named() -> None:
    sim = pt.Scene.from_toml(TANK).build_hosted()
    with pytest.raises(pt.UsageError, match="crate"):
        sim.step(lambda h: {})
    with pytest.raises(pt.UsageError):
        sim.step(lambda h: {"crat": pt.Motion([0.0, 0.0], [0.0, 0.0])})
    with pytest.raises(pt.UsageError, match="velocity"):
        sim.step(lambda h: {"crate": pt.Motion(h["crate"].position, [0.0, 0.0, 0.0])})


def test_an_advance_takes_the_steps_of_single_ones(tank: pt.Scene) -> None:
    single, whole = tank.build_hosted(), tank.build_hosted()
    start = single["crate"].position
    times: tuple[list[float], list[float]] = ([], [])

    def host(seen: list[float]) -> Callable[[pt.BodyStep], dict[str, pt.Motion]]:
        def heave(h: pt.BodyStep) -> dict[str, pt.Motion]:
            seen.append(h.time)
            end = h.time + h.dt
            return {"crate": pt.Motion(start + [0.0, 0.01 * np.sin(9.0 * end)], [0.0, 0.09 * np.cos(9.0 * end)])}

        return heave

    while single.time < 0.05:
        single.step(host(times[0]), until=0.05)
    whole.advance(0.05, host(times[1]))
    assert times[0] == times[1] and single.time == whole.time == 0.05
    assert single.save() == whole.save()


def test_an_exception_of_the_host_ends_an_advance(tank: pt.Scene) -> None:
    sim, calls = tank.build_hosted(), 0

    def host(h: pt.BodyStep) -> dict[str, pt.Motion]:
        nonlocal calls
        calls += 1
        if calls == 3:
            raise LookupError("in the host")
        return {"crate": pt.Motion(h["crate"].position, [0.0, 0.0])}

    with pytest.raises(LookupError, match="in the host"):
        sim.advance(0.1, host)
    assert calls == 3 and sim.steps == 2


def test_hosted_is_an_option_of_build(tank: pt.Scene) -> None:
    assert isinstance(tank.build(hosted=True), pt.HostedSimulation)
    assert isinstance(tank.build(hosted=False), pt.Simulation)


def test_constraints_belong_to_the_other_program(tank: pt.Scene) -> None:
    tank["spring"] = [{"name": "line", "between": ["crate"], "from": [0.5, 0.6], "to": [0.5, 1.5], "stiffness": 100.0}]
    with pytest.raises(pt.SceneError):
        tank.build_hosted()
