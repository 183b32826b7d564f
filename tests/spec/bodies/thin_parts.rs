//! Parts thinner than dp: one layer of boundary particles in their middle, with the loads of their own volume.

use pontoon::{Result, simulation::Simulation};

use crate::common::{scene_simulation, time_mean};

const DP: f64 = 0.01;
const RHO_G: f64 = 9810.0;

/// A tank 0.7 m long of water 0.35 m deep, with this solid.
fn tank_with(solid: &str) -> Result<Simulation<2>> {
    scene_simulation(&format!(
        "dimension = 2\ndp = {DP}\nuntil = 2.0\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [0.7, 0.35] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.7, 0.5] }} }}\n\
         [[solid]]\nname = \"body\"\n{solid}\n"
    ))
}

#[test]
fn a_hull_with_a_keel_of_0_4_dp_floats_at_the_draft_of_archimedes() -> Result<()> {
    // 0.3 m wide, with a keel 0.2 m deep that would be lifted as one dp thick: 0.4 dp too little draft.
    let (wide, keel, thick, mass) = (0.3, 0.2, 0.4 * DP, 15.4);
    let draft = keel + (mass / 1000.0 - thick * keel) / wide;
    // In the middle between two columns of water, and a third of dp aside.
    for aside in [0.0, 0.3] {
        let x = 0.355 + aside * DP;
        let (left, right) = (0.5 * (wide - thick), 0.5 * (wide + thick));
        let mut sim = tank_with(&format!(
            "shape = {{ polygon = {{ points = [[0.0, 0.2], [{left}, 0.2], [{left}, 0.0], [{right}, 0.0], [{right}, 0.2], \
             [0.3, 0.2], [0.3, 0.3], [0.0, 0.3]] }} }}\nat = {{ x = {}, draft = \"equilibrium\" }}\n\
             free = {{ mass = {mass}, locked = [\"x\", \"turn\"] }}",
            x - 0.5 * wide,
        ))?;
        let water = sim.system().fluid().len() as f64 * DP * DP;
        // The level of the water with what it makes way for: the hull below it, and dp in place of the keel.
        let way = (draft - keel) * wide + keel * DP;
        let [bottom] = time_mean(&mut sim, 0.7, 1.5, |sim| [sim.system().solids()[1].kinematics.pose.position[1]])?;
        let error = ((water + way) / 0.7 - draft - bottom) / DP;
        assert!(error.abs() < if aside == 0.0 { 0.1 } else { 0.3 }, "aside {aside} dp: {error} dp");
    }
    Ok(())
}

#[test]
fn a_thin_plate_is_lifted_by_the_weight_of_its_own_volume() -> Result<()> {
    for (size, at) in [([0.4, 0.002], [0.35, 0.175]), ([0.004, 0.2], [0.355, 0.18])] {
        let mut sim = tank_with(&format!(
            "shape = {{ box = {{ size = [{}, {}] }} }}\nat = {{ x = {}, y = {} }}\nfixed = true",
            size[0], size[1], at[0], at[1]
        ))?;
        let [lift] = time_mean(&mut sim, 0.1, 0.3, |sim| [sim.system().solids()[1].load.force[1]])?;
        // The layer would be lifted as one dp thick; 3 % of that is the error of a plate of dp.
        let (own, layer) = (RHO_G * size[0] * size[1], RHO_G * size[0].max(size[1]) * DP);
        assert!((lift - own).abs() < 0.03 * layer, "{size:?}: {lift} of {own} N/m; the layer {layer} N/m");
    }
    Ok(())
}
