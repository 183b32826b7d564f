"""Simulations: stepping, control, water arrays, probes, state."""

import copy
import gc
import multiprocessing
import os
import pickle
import signal
import threading
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pontoon as pt

from conftest import TANK, needs_signals


def state(sim: pt.Simulation) -> tuple[bytes, bytes]:
    """Returns positions and velocities of the water in the order of the particles' names, as bytes."""
    order = np.argsort(sim.water.id)
    return sim.water.position[order].tobytes(), sim.water.velocity[order].tobytes()


def test_stepping_gives_the_bits_of_a_run(tank: pt.Scene, tmp_path: Path) -> None:
    run = pt.run(tank, out=tmp_path / "run", report=False)
    for threads in (1, 2):
        with tank.build(threads=threads) as sim:
            sim.advance()
            assert sim.time == tank.until and sim.steps == run.manifest["steps"]
            last = {name: run.series[f"crate.{name}"].values[-1] for name in sim.sample()["crate"]}
            assert dict(sim.sample()["crate"]) == last


def test_single_steps_equal_an_advance(tank: pt.Scene) -> None:
    one, many = tank.build(threads=1), tank.build(threads=2)
    for _ in range(20):
        one.step()
    seen: list[int] = []
    # The control looks on; it changes nothing.
    while many.steps < 20:
        many.step(lambda h: seen.append(len(h.names)))
    assert state(one) == state(many) and seen == [2] * 20


def test_a_3d_simulation_has_three_components(tank_3d: pt.Scene) -> None:
    sim = tank_3d.build()
    sim.step()
    crate = sim["crate"]
    assert crate.position.shape == (3,) and crate.rotation.shape == (3, 3) and crate.spin.shape == (3,)
    assert sim.water.position.shape == (len(sim.water), 3)
    assert crate.mass == pytest.approx(500.0 * 0.4 * 0.3 * 0.2)
    # The water carries the weight of a crate on its draft; the first step is coarse.
    assert crate.load.force[2] == pytest.approx(9.81 * 12.0, rel=0.15)


def test_solids_are_read_by_name(tank: pt.Scene) -> None:
    sim = tank.build()
    assert list(sim.solids) == ["tank", "crate"] and len(sim.solids) == 2
    assert sim["crate"].role == "free" and sim["tank"].role == "fixed" and sim["tank"].mass is None
    assert sim["crate"].mass == pytest.approx(500.0 * 0.3 * 0.2)
    assert sim["crate"].centre[1] == pytest.approx(0.5, abs=1e-3), "half its height is under water"
    with pytest.raises(pt.UnknownNameError, match="crate"):
        sim["crat"]
    assert "crate" in sim.solids and "crat" not in sim.solids
    with pytest.raises(ValueError, match="velocity") as told:
        sim.set_velocity("crate", [1.0, 2.0, 3.0])
    assert isinstance(told.value, pt.UsageError) and told.value.help == "give 2 finite numbers"


def test_a_push_accelerates_by_force_over_mass(tank: pt.Scene) -> None:
    # Without gravity and far from the water nothing else acts.
    tank["gravity"] = 0.0
    tank["model.c0"] = 20.0
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.7}
    mass = 500.0 * 0.3 * 0.2
    with tank.build() as sim:
        sim.advance(0.05, control=lambda h: h.push("crate", [3.0, 0.0]))
        assert sim["crate"].velocity == pytest.approx([3.0 / mass * 0.05, 0.0], rel=1e-9, abs=1e-12)
        before, dt = sim["crate"].velocity[0], 0.0
        sim.push("crate", [6.0, 0.0])
        sim.step()
        dt = sim.dt
        assert sim["crate"].velocity[0] - before == pytest.approx(6.0 / mass * dt, rel=1e-9)
        sim.step()
        assert sim["crate"].velocity[0] - before == pytest.approx(6.0 / mass * dt, rel=1e-9), "for one step only"


def test_a_push_beside_the_centre_turns(tank: pt.Scene) -> None:
    tank["gravity"] = 0.0
    tank["model.c0"] = 20.0
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.7}
    inertia = 500.0 * 0.3 * 0.2 * (0.3**2 + 0.2**2) / 12.0
    sim = tank.build()

    def control(h: pt.BodyStep) -> None:
        h.push("crate", [0.0, 2.0], at=h["crate"].centre + [0.1, 0.0], torque=0.3)

    sim.step(control)
    assert sim["crate"].spin == pytest.approx((0.1 * 2.0 + 0.3) / inertia * sim.dt, rel=1e-6)


def test_a_push_acts_until_the_next_call(tank: pt.Scene) -> None:
    tank["gravity"] = 0.0
    tank["model.c0"] = 20.0
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.7}
    mass, times = 500.0 * 0.3 * 0.2, []

    def control(h: pt.BodyStep) -> None:
        times.append(h.time)
        h.push("crate", [3.0, 0.0])

    sim = tank.build()
    sim.advance(0.05, control=control, every=0.02)
    assert len(times) == 3 and np.diff(times) == pytest.approx(0.02, abs=sim.dt)
    assert sim["crate"].velocity[0] == pytest.approx(3.0 / mass * 0.05, rel=1e-9)
    sim.advance(0.1)
    assert sim["crate"].velocity[0] == pytest.approx(3.0 / mass * 0.05, rel=1e-9), "it ends with the advance"


def test_wrong_commands_are_refused(tank: pt.Scene) -> None:
    sim = tank.build()
    for wrong in (
        lambda h: h.push("tank", [1.0, 0.0]),
        lambda h: h.push("crat", [1.0, 0.0]),
        lambda h: h.push("crate", [1.0]),
        lambda h: h.push("crate", [1.0, float("nan")]),
        lambda h: h.push("crate", 1.0),
        lambda h: h.push("crate", torque=[1.0, 2.0]),
        lambda h: h.drive("hinge", force=1.0),
        lambda h: h.set_spring("line", stiffness=-1.0),
        lambda h: h["no"],
        lambda h: 1 / 0,
        lambda h: sim.time,
    ):
        steps = sim.steps
        with pytest.raises((pt.UsageError, ZeroDivisionError)):
            sim.advance(0.1, control=wrong)
        assert sim.steps == steps + 1, "the exception comes after its step"
    sim.advance(0.1)


def test_water_is_copied_and_viewed(tank: pt.Scene) -> None:
    sim = tank.build()
    sim.step()
    water = sim.water
    assert len(water) == len(water.id) == len(set(water.id.tolist()))
    assert water.velocity.shape == water.acceleration.shape == (len(water), 2)
    # Hydrostatic pressure at the deepest particles, half a spacing above the bottom.
    deep = water.position[:, 1] < 0.03
    assert water.pressure[deep].mean() == pytest.approx(9810.0 * 0.475, rel=0.05)
    kept = water.position
    kept[:] = 0.0
    assert water.position.max() > 0.4, "a copy is the user's"

    with water.view() as view:
        position = view.position
        assert np.array_equal(position, water.position) and np.array_equal(view.id, water.id)
        assert not position.flags.writeable and not position.flags.owndata
        with pytest.raises(ValueError):
            position[0, 0] = 1.0
        with pytest.raises(pt.UsageError, match="view of the water is open"):
            sim.step()
        with pytest.raises(pt.UsageError):
            sim.restore(b"")
    column = position[:, 1]
    del position
    with pytest.raises(pt.UsageError, match="view"):
        sim.step()
    del column
    with pytest.raises(pt.UsageError, match="closed"):
        view.position
    sim.step()


def test_a_view_keeps_the_memory_of_a_simulation_that_is_gone(tank: pt.Scene) -> None:
    sim = tank.build()
    with sim.water.view() as view:
        density = view.density
    before = density.copy()
    del sim, view
    gc.collect()
    assert np.array_equal(density, before)


def test_probes_are_read_at_any_time(tank: pt.Scene) -> None:
    sim = tank.build()
    sim.step()
    gauge = sim.read(pt.elevation(at=0.15))
    # The still level is 0.5 m; the crate displaces a part of the water, which was filled around it.
    assert gauge["level_m"] == pytest.approx(0.5, abs=0.03) and gauge["eta_m"] == pytest.approx(0.0, abs=0.01)
    assert float(sim.read(pt.pressure(at=[0.15, 0.2]))) == pytest.approx(9810.0 * 0.3, rel=0.05)
    assert set(sim.read(pt.velocity(at=[0.15, 0.2]))) == {"vx_mps", "vy_mps"}
    assert sim.read({"motion": "crate"})["heave_m"] == sim.sample()["crate"]["heave_m"]
    assert all(np.isfinite(list(sim.read(pt.energy()).values())))
    with pytest.raises(pt.UsageError, match="columns"):
        float(gauge)
    with pytest.raises(pt.SceneError, match="crate"):
        sim.read(pt.motion("crat"))
    with pytest.raises(pt.UsageError, match="records"):
        sim.read({"balance": "crate"})


@pytest.mark.parametrize(
    "probe",
    [
        pt.elevation(at=0.15),
        pt.runup("tank"),
        pt.energy(),
        # The lower side of the crate at the start.
        {"patch": {"solid": "crate", "box": {"min": [0.3, 0.54], "max": [0.7, 0.56]}}},
    ],
)
def test_a_probe_that_is_read_late_counts_from_the_start_as_one_of_the_scene(
    tank: pt.Scene, probe: dict[str, Any]
) -> None:
    tank["solid.crate.at"] = {"x": 0.5, "y": 0.65}
    alone = tank.build(threads=1)
    tank["probe"] = [probe]
    own = tank.build(threads=1)
    for sim in (alone, own):
        sim.advance(0.25)
    [known] = own.sample().values()
    read = alone.read(probe)
    assert read == known and own.read(probe) == known
    changes = [read[name] for name in read if name.startswith(("eta", "runup", "total", "p_max"))]
    assert all(abs(change) > 1e-3 for change in changes) and changes, "the crate has fallen into the water"
    # The start is the same after a restart.
    other = pickle.loads(pickle.dumps(alone))
    for sim in (alone, other):
        sim.step()
    assert other.read(probe) == alone.read(probe)


def test_calls_come_at_multiples_of_their_interval(tank: pt.Scene) -> None:
    times: list[float] = []
    sim = tank.build(threads=1)
    # Steps of about 1.4 ms: an interval that grew by a part of a step at each call would be 0.0027 s long.
    sim.advance(0.2, control=lambda h: times.append(h.time), every=0.002)
    assert np.array(times) == pytest.approx(0.002 * np.arange(len(times)), abs=2.0 * sim.step_limit)
    assert len(times) == pytest.approx(100, abs=1)


def test_records_of_the_scene_are_read(tank: pt.Scene) -> None:
    tank["probe"] = [{"balance": "crate"}, {"budget": True}]
    sim = tank.build()
    sim.advance(0.02)
    assert np.isfinite(list(sim.read({"balance": "crate"}).values())).all()
    sample = sim.sample()
    assert np.isfinite(list(sample["budget"].values())).all()


def test_save_restore_pickle_and_deepcopy_keep_every_bit(tank: pt.Scene) -> None:
    sim = tank.build()
    sim.advance(0.05)
    saved, others = sim.save(), [copy.deepcopy(sim), pickle.loads(pickle.dumps(sim))]
    sim.advance(0.1)
    there = state(sim)
    for other in others:
        assert other.time == 0.05
        other.advance(0.1)
        assert state(other) == there
    sim.restore(saved)
    assert sim.time == 0.05
    sim.advance(0.1)
    assert state(sim) == there
    for damaged in (b"", saved[:100], b"\xff" * 50):
        with pytest.raises(pt.RestartError):
            sim.restore(damaged)
    tank["dp"] = 0.04
    with pytest.raises(pt.RestartError):
        tank.build().restore(saved)


def test_solids_are_added_and_removed(tank: pt.Scene) -> None:
    sim = tank.build()
    particles = len(sim.water)
    ball = {
        "name": "ball",
        "free": {"density": 700.0},
        "shape": {"ball": {"radius": 0.08}},
        "at": {"x": 0.2, "y": 0.2},
    }
    displaced = sim.add_solid(ball)
    assert displaced > 0 and len(sim.water) == particles - displaced
    # The area of the ball over that of a particle, within what a coarse lattice gives.
    assert displaced == pytest.approx(np.pi * 0.08**2 / 0.05**2, abs=4)
    assert list(sim.solids) == ["tank", "crate", "ball"] and sim["ball"].role == "free"
    assert sim.read(pt.motion("ball"))["surge_m"] == 0.0 and "fx_N_per_m" in sim.read(pt.force("ball"))
    sim.advance(0.05, control=lambda h: h["ball"].load)
    other = pickle.loads(pickle.dumps(sim))
    sim.advance(0.1)
    other.advance(0.1)
    assert state(sim) == state(other)
    with pytest.raises(pt.SceneError):
        sim.add_solid(ball)
    sim.remove_solid("ball")
    sim.step()
    again = copy.deepcopy(sim)
    again.step()
    sim.step()
    assert state(sim) == state(again)


def test_a_state_from_before_a_change_of_solids_is_refused(tank: pt.Scene) -> None:
    ball = {"name": "ball", "free": {"density": 700.0}, "shape": {"ball": {"radius": 0.08}}, "at": [0.2, 0.2]}
    sim, twin = tank.build(), tank.build()
    for each in (sim, twin):
        each.advance(0.02)
    before = sim.save()
    for each in (sim, twin):
        each.add_solid(ball)
    with pytest.raises(pt.RestartError):
        sim.restore(before)
    assert state(sim) == state(twin) and list(sim.solids) == list(twin.solids)
    for each in (sim, twin):
        each.advance(0.04)
    assert state(sim) == state(twin), "the refusal changed nothing"
    with_ball = sim.save()
    sim.advance(0.06)
    sim.restore(with_ball)
    assert state(sim) == state(twin)
    sim.remove_solid("ball")
    with pytest.raises(pt.RestartError):
        sim.restore(with_ball)


@pytest.mark.parametrize("density", [700.0, 70.0, None])
def test_a_solid_added_after_a_restart_does_as_without_it(tank: pt.Scene, density: float | None) -> None:
    role = {"fixed": True} if density is None else {"free": {"density": density}}
    ball = {"name": "ball", "shape": {"ball": {"radius": 0.08}}, "at": [0.2, 0.2]} | role
    whole = tank.build()
    whole.advance(0.02)
    saved = whole.save()
    resumed, back = tank.build(), tank.build()
    back.advance(0.05)
    for each in (resumed, back):
        each.restore(saved)
    for each in (whole, resumed, back):
        assert each.add_solid(ball) > 0
    assert whole.save() == resumed.save() == back.save()
    for each in (whole, resumed, back):
        each.advance(0.06)
    assert whole.save() == resumed.save() == back.save()


def test_a_state_of_another_scene_is_refused_and_changes_nothing(tank: pt.Scene) -> None:
    sim, twin = tank.build(), tank.build()
    for each in (sim, twin):
        each.advance(0.02)
    before = sim.save()
    # The same solids in other water: the bodies alone would fit.
    other = pt.Scene.from_toml(TANK.replace("max = [1.0, 0.5]", "max = [1.0, 0.4]")).build()
    other.advance(0.05)
    with pytest.raises(pt.RestartError):
        sim.restore(other.save())
    assert sim.save() == before and state(sim) == state(twin)
    for each in (sim, twin):
        each.advance(0.06)
    assert state(sim) == state(twin)


@pytest.mark.parametrize(
    ("key", "value"),
    [("solid.crate.free.density", 520.0), ("model.c0", 40.0), ("gravity", 9.7), ("solid.crate.at", {"x": 0.51, "y": 0.5})],
)
def test_a_state_of_a_scene_with_as_many_particles_is_refused(tank: pt.Scene, key: str, value: Any) -> None:
    tank["solid.crate.at"] = {"x": 0.5, "y": 0.5}
    sim = tank.build()
    sim.advance(0.02)
    saved = sim.save()
    tank[key] = value
    other = tank.build()
    before = other.save()
    assert len(other.water) == len(sim.water), "the numbers alone would fit"
    with pytest.raises(pt.RestartError, match="another scene") as told:
        other.restore(saved)
    assert told.value.code == "other-setup" and other.save() == before


def test_a_state_is_restored_where_only_outputs_and_end_differ(tank: pt.Scene) -> None:
    sim = tank.build()
    sim.advance(0.02)
    later = tank.set(until=9.0, title="Another", frames="off", probe=[{"motion": "crate"}]).build()
    later.restore(sim.save())
    for each in (sim, later):
        each.advance(0.04)
    assert state(sim) == state(later)


def test_every_changed_byte_of_a_state_is_noticed(tank: pt.Scene) -> None:
    sim = tank.build()
    sim.advance(0.02)
    saved, twin = sim.save(), tank.build()
    for place in range(0, len(saved), max(1, len(saved) // 300)):
        with pytest.raises(pt.RestartError):
            sim.restore(saved[:place] + bytes([saved[place] ^ 0x10]) + saved[place + 1 :])
    twin.advance(0.02)
    assert sim.save() == saved == twin.save()


def test_times_that_are_no_numbers_are_refused(tank: pt.Scene) -> None:
    sim, hosted = tank.build(), tank.build_hosted()
    with pytest.raises(pt.UsageError, match="nan"):
        sim.advance(float("nan"))
    with pytest.raises(pt.UsageError, match="nan"):
        hosted.advance(float("nan"), lambda h: {})
    wrong: Any = 3
    with pytest.raises(TypeError):
        sim.add_solid(wrong)
    with pytest.raises(pt.UsageError, match="host"):
        hosted.step(lambda h: {"crate": wrong})


def test_a_step_that_a_function_keeps_stays_as_it_was(tank: pt.Scene) -> None:
    kept: list[pt.BodyStep] = []
    times: list[float] = []

    def keep_every_other(h: pt.BodyStep) -> None:
        times.append(h.time)
        if len(times) % 2:
            kept.append(h)

    tank.build().advance(0.05, control=keep_every_other)
    assert [h.time for h in kept] == times[::2] and len(kept) > 3
    assert all(h["crate"].name == "crate" and h["crate"].role == "free" for h in kept)


@pytest.mark.parametrize("keeps", ["steps", "arguments", "nothing"])
def test_each_call_gets_its_own_step(tank: pt.Scene, keeps: str) -> None:
    kept: list[Any] = []
    times: list[float] = []

    def control(*arguments: pt.BodyStep) -> None:
        times.append(arguments[0].time)
        kept.append({"steps": arguments[0], "arguments": arguments}.get(keeps))

    sim = tank.build()
    sim.advance(0.05, control=control)
    assert times == sorted(set(times)) and len(times) == sim.steps
    if keeps != "nothing":
        steps = kept if keeps == "steps" else [arguments[0] for arguments in kept]
        assert [h.time for h in steps] == times
        assert len({id(h) for h in steps}) == len(steps)
    # A function of C gets the tuple of the arguments itself.
    appended: list[pt.BodyStep] = []
    tank.build().advance(0.05, control=appended.append)
    assert [h.time for h in appended] == times


def test_commands_of_a_call_do_not_come_again(tank: pt.Scene) -> None:
    tank["gravity"] = 0.0
    tank["model.c0"] = 20.0
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.7}
    tank["spring"] = [
        {"name": "line", "between": ["crate"], "from": [0.5, 0.9], "to": [0.5, 0.95], "stiffness": 1.0, "length": 0.05}
    ]
    mass, pushed, calls = 500.0 * 0.3 * 0.2, 0.0, 0

    def control(h: pt.BodyStep) -> None:
        nonlocal pushed, calls
        calls += 1
        if calls % 2:
            h.push("crate", [3.0, 0.0])
            pushed += h.dt
        if calls == 1:
            h.set_spring("line", stiffness=0.0)

    sim = tank.build()
    sim.step(control)
    sim.set_spring("line", stiffness=1e-6)
    sim.advance(0.05, control=control)
    assert calls > 6 and sim["crate"].velocity[0] == pytest.approx(3.0 / mass * pushed, rel=1e-6)
    assert sim.spring("line").stiffness == 1e-6, "the command of the first call acted once"


def test_a_call_sees_the_start_of_the_step_and_its_loads(tank: pt.Scene) -> None:
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.45}
    sim, seen = tank.build(), []
    for _ in range(10):
        before = sim["crate"]
        sim.step(lambda h: seen.append((h["crate"], h.loads["crate"], h.time)))
        crate, load, _ = seen[-1]
        for own, other in ((crate.centre, before.centre), (crate.velocity, before.velocity)):
            assert np.array_equal(own, other)
        assert crate.rotation == before.rotation and crate.spin == before.spin
        assert np.array_equal(crate.load.force, load.force) and crate.load.torque == load.torque
        # The force of this step, with the weight, makes the velocity at its end.
        change = (load.force / 30.0 + [0.0, -9.81]) * sim.dt
        assert sim["crate"].velocity - before.velocity == pytest.approx(change, rel=1e-3, abs=1e-6)


def test_vectors_are_taken_from_lists_arrays_and_views(tank: pt.Scene) -> None:
    def pushed(force: Any) -> tuple[bytes, bytes]:
        sim = tank.build()
        sim.advance(0.02, control=lambda h: h.push("crate", force))
        return state(sim)

    there = pushed([3.0, -2.0])
    strided = np.array([3.0, 0.0, -2.0, 0.0])[::2]
    for same in ((3, -2), np.array([3.0, -2.0]), strided, np.array([3.0, -2.0], dtype=np.float32), np.array([3, -2])):
        assert pushed(same) == there
    for wrong in ([[3.0, -2.0]], np.zeros((1, 2)), np.zeros(3), np.array([np.inf, 0.0]), "ab", object()):
        with pytest.raises(pt.UsageError, match="2 finite numbers"):
            pushed(wrong)


def test_contacts_have_names_force_and_place(tank: pt.Scene) -> None:
    tank["solid.crate.free.density"] = 3000.0
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.0}
    sim = tank.build()
    sim.advance(0.2)
    contacts = sim.contacts()
    assert contacts and all(set(contact.between) == {"tank", "crate"} for contact in contacts)
    # The bed carries its weight less that of the water in its place, within 5 % of the pressure at the bed times its breadth.
    carried, pressed = 9.81 * (3000.0 - 1000.0) * 0.3 * 0.2, 9.81 * 1000.0 * 0.5 * 0.3
    assert sum(contact.normal_force for contact in contacts) == pytest.approx(carried, abs=0.05 * pressed)
    for contact in contacts:
        assert contact.at.shape == (2,) and abs(contact.at[1]) < 0.01 and 0.3 < contact.at[0] < 0.7


def test_events_tell_what_ended(tank: pt.Scene) -> None:
    line = {"name": "line", "between": ["crate"], "from": [0.5, 0.6], "to": [0.5, 0.9], "stiffness": 10.0}
    tank["spring"] = [line | {"until": 0.02}]
    sim = tank.build()
    assert sim.events() == []
    sim.advance(0.05)
    assert len(sim.events()) == 1 and "line" in sim.events()[0]


def test_force_and_torque_of_a_motor_are_one(tank: pt.Scene) -> None:
    tank["joint"] = [{"name": "hinge", "kind": "hinge", "between": ["crate"], "at": [0.5, 0.5]}]
    named, other = tank.build(), tank.build()
    named.drive("hinge", torque=3.0)
    other.drive("hinge", force=3.0)
    for sim in (named, other):
        sim.advance(0.02)
    assert state(named) == state(other) and named.joint("hinge").motor_force == pytest.approx(3.0)
    named.advance(0.04, control=lambda h: h.drive("hinge", torque=2.0))
    assert named.joint("hinge").motor_force == pytest.approx(2.0)
    with pytest.raises(pt.UsageError, match="two names"):
        named.drive("hinge", force=1.0, torque=1.0)
    with pytest.raises(pt.UsageError, match="two names"):
        named.step(lambda h: h.drive("hinge", force=1.0, torque=0.0))


def test_joints_are_driven_and_springs_changed(tank: pt.Scene) -> None:
    tank["joint"] = [{"name": "rail", "kind": "slider", "between": ["crate"], "at": [0.5, 0.5], "along": [0.0, 1.0]}]
    tank["spring"] = [
        {"name": "line", "between": ["crate"], "from": [0.5, 0.6], "to": [0.5, 1.5], "stiffness": 100.0, "length": 0.9}
    ]
    sim = tank.build()
    assert sim.joints == ["rail"] and sim.springs == ["line"]
    assert sim.spring("line").rest_length == pytest.approx(0.9)
    sim.set_spring("line", stiffness=50.0)
    assert sim.spring("line").stiffness == 50.0
    sim.drive("rail", force=20.0)
    sim.advance(0.05)
    raised = sim.joint("rail")
    assert raised.position > 0.0 and raised.motor_force == pytest.approx(20.0)
    assert raised.absorbed_power == pytest.approx(-20.0 * raised.rate)
    sim.advance(0.1, control=lambda h: h.drive("rail", damping=5000.0), every=0.01)
    assert abs(sim.joint("rail").rate) < 0.01, "a strong brake holds it"
    sim.advance(0.12, control=lambda h: h.set_spring("line", rest_length=0.8))
    assert sim.spring("line").rest_length == 0.8 and sim.spring("line").stiffness == 50.0
    sim.release("rail")
    sim.advance(0.15)
    assert sim.joint("rail").motor_force == 0.0
    with pytest.raises(pt.UsageError, match="rail"):
        sim.drive("rai")
    with pytest.raises(pt.UsageError):
        sim.set_spring("line", damping=-1.0)


def test_a_function_reads_joints_and_springs(tank: pt.Scene) -> None:
    tank["joint"] = [{"name": "rail", "kind": "slider", "between": ["crate"], "at": [0.5, 0.5], "along": [0.0, 1.0]}]
    tank["spring"] = [
        {"name": "line", "between": ["crate"], "from": [0.5, 0.6], "to": [0.5, 1.5], "stiffness": 100.0, "length": 0.9}
    ]
    sim, seen = tank.build(), []

    def brake(h: pt.BodyStep) -> None:
        seen.append((h.joint("rail"), h.spring("line")))
        h.drive("rail", force=20.0 - 50.0 * h.joint("rail").rate)

    for _ in range(20):
        before = (sim.joint("rail"), sim.spring("line"))
        sim.step(brake)
        assert seen[-1] == before, "what the last step left"
    rate = seen[-1][0].rate
    # The command of a step acts in the next one.
    assert rate > 0.0 and sim.joint("rail").motor_force == pytest.approx(20.0 - 50.0 * seen[-2][0].rate)
    for wrong in (lambda h: h.joint("rai"), lambda h: h.spring("lin")):
        with pytest.raises(pt.UnknownNameError, match="there is no"):
            sim.step(wrong)


def test_a_kept_step_takes_no_commands(tank: pt.Scene) -> None:
    kept: list[pt.BodyStep] = []
    sim = tank.build()
    sim.step(kept.append)
    with pytest.raises(pt.UsageError, match="over"):
        kept[0].push("crate", [1.0, 0.0])
    assert kept[0]["crate"].name == "crate"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_goes_on_to_the_same_bits(tank: pt.Scene) -> None:
    tank["probe"] = [{"balance": "crate"}, {"budget": True}]
    bundled = pt.Scene.read("still-tank")
    sim = tank.build(threads=2)
    sim.advance(0.02)
    # The common threads of this process are at work before the fork, too.
    saved, here = sim.save(), sim.sample()
    tank.inspect()

    def work(answer: Connection) -> None:
        assert sim.save() == saved and sim.sample() == here and sim.threads == 2
        fresh = tank.build(threads=2)
        fresh.restore(saved)
        for each in (sim, fresh):
            each.advance(0.05)
        tank.inspect()
        bundled.inspect()
        answer.send((sim.save(), fresh.save()))

    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=work, args=(sender,))
    child.start()
    try:
        assert receiver.poll(60.0), "the child does not hang"
        states = receiver.recv()
    finally:
        child.join(10.0)
        child.kill()
    sim.advance(0.05)
    assert states == (sim.save(), sim.save())
    bundled.inspect()


@needs_signals
def test_ctrl_c_in_an_advance_leaves_a_usable_simulation(tank: pt.Scene) -> None:
    tank["dp"] = 0.02
    sim = tank.build()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        sim.advance(100.0)
    timer.join()
    reached, steps = sim.time, sim.steps
    assert 0.0 < reached < 100.0
    twin = tank.build()
    while twin.steps < steps:
        twin.step()
    assert state(twin) == state(sim), "it stopped between two steps"
    sim.step()
    twin.step()
    assert state(twin) == state(sim)


def test_one_simulation_is_stepped_by_one_thread_at_a_time(tank: pt.Scene) -> None:
    tank["dp"] = 0.02
    sim = tank.build(threads=1)
    running = threading.Thread(target=sim.advance, args=(0.2,))
    running.start()
    refused = 0
    while running.is_alive():
        try:
            sim.step()
        except pt.UsageError as told:
            assert "being stepped" in str(told)
            refused += 1
    running.join()
    assert refused > 0 and sim.time >= 0.2


def test_many_worlds_step_in_threads_without_the_interpreter(tank: pt.Scene) -> None:
    alone = tank.build(threads=1)
    alone.advance(0.1)
    worlds = [tank.build(threads=1) for _ in range(8)]
    threads = [threading.Thread(target=world.advance, args=(0.1,)) for world in worlds]
    for thread in threads:
        thread.start()
    counted = 0
    while any(thread.is_alive() for thread in threads):
        counted += 1
    assert counted > 100, "this thread ran meanwhile"
    assert all(state(world) == state(alone) for world in worlds)


def test_a_callback_that_does_nothing_changes_nothing_and_is_timed(tank: pt.Scene) -> None:
    alone, called = tank.build(threads=1), tank.build(threads=1)
    alone.advance(0.05)
    begun: list[float] = []
    called.advance(0.05, control=lambda h: begun.append(h.time))
    assert state(called) == state(alone)
    # Once a step.
    assert len(set(begun)) == len(begun) == called.steps
    # The wall time from the end of the water's step to the answer of the function, as the simulation measures it.
    assert called.time_spent()["callbacks"] > 0.0 == alone.time_spent()["callbacks"]


def test_a_closed_simulation_says_so(tank: pt.Scene) -> None:
    with tank.build() as sim:
        sim.step()
    with pytest.raises(pt.UsageError, match="closed"):
        sim.step()
    assert "closed" in repr(sim)
    with pytest.raises(pt.UsageError, match="threads"):
        tank.build(threads=0)


def resident() -> int:
    """Returns the memory of this process, bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def grown(use: Callable[[], None], times: int) -> int:
    """Returns by how much the memory of this process grows over `times` uses, after 50 others, bytes."""
    for _ in range(50):
        use()
    gc.collect()
    before = resident()
    for _ in range(times):
        use()
    gc.collect()
    return resident() - before


#: Bound on the growth over many simulations: one takes about 1 MB, and the allocator may keep some pages.
GROWTH = 20e6

needs_proc = pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads /proc")


@needs_proc
def test_a_thousand_simulations_leave_no_memory_behind(tank: pt.Scene) -> None:
    def use() -> None:
        with tank.build(threads=1) as sim:
            sim.step(lambda h: h.push("crate", [1.0, 0.0]))
            with sim.water.view() as view:
                assert len(view.position)
            sim.save()

    assert grown(use, 1000) < GROWTH


@needs_proc
def test_a_thousand_dropped_simulations_leave_no_memory_behind(tank: pt.Scene) -> None:
    # Neither closed nor left: the last reference frees them.
    assert grown(lambda: tank.build(threads=1).step(), 1000) < GROWTH


@needs_proc
def test_a_thousand_copies_and_restored_states_leave_no_memory_behind(tank: pt.Scene) -> None:
    # 500 copies and 500 from pickle, each restored to a state and stepped.
    sim = tank.build(threads=1)
    sim.step()
    saved, pickled = sim.save(), pickle.dumps(sim)

    def use() -> None:
        for other in (copy.deepcopy(sim), pickle.loads(pickled)):
            other.step()
            other.restore(saved)
            other.step()
        sim.restore(sim.save())

    assert grown(use, 500) < GROWTH


@needs_proc
def test_a_thousand_hosted_simulations_leave_no_memory_behind(tank: pt.Scene) -> None:
    def use() -> None:
        sim = tank.build_hosted(threads=1)
        crate = sim["crate"]
        sim.step(lambda h: {"crate": pt.Motion(crate.position, h.loads["crate"].force * 0.0)})

    assert grown(use, 1000) < GROWTH


@needs_proc
def test_a_thousand_failed_calls_leave_no_memory_behind(tank: pt.Scene) -> None:
    sim = tank.build(threads=1)

    def wrong(h: pt.BodyStep) -> None:
        h.push("crat", [1.0, 0.0])

    def use() -> None:
        with pytest.raises(pt.UsageError):
            sim.step(wrong)

    assert grown(use, 1000) < GROWTH
