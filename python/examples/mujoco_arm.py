"""An arm in MuJoCo presses a float under water: MuJoCo moves the bodies, the water takes their motions and gives forces.

In each step the water gives the float a force and a torque, and MuJoCo goes on by the step of the water. Pressed with a
force F, the float lies deeper by F/(ρ g A).

    python mujoco_arm.py
"""

import mujoco
import numpy as np

import pontoon as pt

#: Edge lengths of the float, m; it floats on half its height.
SIZE = (0.32, 0.32, 0.16)
#: Torque of the arm (N m) and its length (m); it presses with torque over length.
TORQUE, LENGTH = 12.0, 0.4
#: Time at which the arm begins to press, and end, s.
PRESS, UNTIL = 1.2, 3.2
#: Depth of the water, m, and edge of the tank, m.
DEPTH, TANK = 0.32, 0.8

SCENE = f"""
title = "A float under an arm"
dimension = 3
dp = 0.04
until = {UNTIL}

[[water]]
fill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [{TANK}, {TANK}, {DEPTH}] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [{TANK}, {TANK}, 0.6] }} }}

[[solid]]
name = "float"
shape = {{ box = {{ size = {list(SIZE)} }} }}
at = {{ x = {TANK / 2}, y = {TANK / 2}, bottom = {DEPTH - SIZE[2] / 2} }}
free = {{ density = 500.0 }}
"""

ARM = f"""
<mujoco>
  <option gravity="0 0 -9.81" integrator="Euler"/>
  <worldbody>
    <body name="float" pos="{TANK / 2} {TANK / 2} {DEPTH}">
      <joint name="guide" type="slide" axis="0 0 1"/>
      <geom type="box" size="{SIZE[0] / 2} {SIZE[1] / 2} {SIZE[2] / 2}" density="500" friction="0.1"/>
    </body>
    <body name="arm" pos="{TANK / 2 - LENGTH} {TANK / 2} {DEPTH + SIZE[2] / 2 + 0.04}" gravcomp="1">
      <joint name="shoulder" type="hinge" axis="0 1 0" damping="0.5"/>
      <geom type="capsule" fromto="0 0 0 {LENGTH} 0 0" size="0.01" density="500" contype="0" conaffinity="0"/>
      <geom type="sphere" pos="{LENGTH} 0 0" size="0.02" density="500" friction="0.1"/>
    </body>
  </worldbody>
  <actuator><motor joint="shoulder" gear="1"/></actuator>
</mujoco>
"""


def main() -> None:
    """Presses the float and compares its draft with hydrostatics."""
    model = mujoco.MjModel.from_xml_string(ARM)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    body = data.body("float")
    water = pt.Scene.from_toml(SCENE).build_hosted()

    def host(h: pt.BodyStep) -> dict[str, pt.Motion]:
        load = h.loads["float"]
        data.xfrc_applied[body.id] = np.concatenate([load.force, load.torque])
        data.ctrl[0] = TORQUE if h.time > PRESS else -1.0
        model.opt.timestep = h.dt
        mujoco.mj_step(model, data)
        # Poses belong to the positions at the end of the step.
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        velocity = np.array([0.0, 0.0, data.qvel[0]])
        return {"float": pt.Motion(body.xpos.copy(), velocity, body.xmat.reshape(3, 3).copy(), np.zeros(3))}

    drafts: dict[bool, list[float]] = {False: [], True: []}
    while water.time < UNTIL:
        water.step(host, until=UNTIL)
        pressed = water.time > PRESS
        # Means over the last 0.6 s of both parts.
        if water.time > (UNTIL if pressed else PRESS) - 0.6:
            surface = np.mean([water.read(pt.elevation(at=[x, 0.1]))["level_m"] for x in (0.1, 0.4, 0.7)])
            drafts[pressed].append(float(surface - body.xpos[2] + SIZE[2] / 2))
    alone, pressed_draft = (float(np.mean(drafts[pressed])) for pressed in (False, True))
    force = TORQUE / LENGTH
    theory = force / (1000.0 * 9.81 * SIZE[0] * SIZE[1])
    print(f"draft alone {alone:.4f} m (theory {SIZE[2] / 2:.4f} m)")
    print(f"pressed by {force:.1f} N: deeper by {pressed_draft - alone:.4f} m (theory {theory:.4f} m)")
    # A fifth of a spacing: the float still bobs, and the lattice is coarse.
    assert abs(pressed_draft - alone - theory) < 0.2 * 0.04


if __name__ == "__main__":
    main()
