//! Equilibrium of floating bodies in three dimensions: combined list and trim, and concave solids. Upright single shapes are in
//! `buoyancy`, lists in two dimensions in `equilibrium`.

use std::path::Path;

use pontoon::{
    Result,
    math::{Pose, Vector},
    scene::Scene,
    simulation::{Setup, Simulation},
    solid::{FreeBody, Role, SolidSpec, hydrostatics::equilibrium_height},
};

use super::concave_solids::l_prism;
use crate::common::time_mean;

const DP: f64 = 0.05;

/// A pool of 18 × 16 dp with water 7 dp deep and a hull with the keys `hull`.
fn pool(hull: &str) -> Result<Setup<3>> {
    let text = format!(
        "dimension = 3\ndp = {DP}\nuntil = 10.0\nmodel.viscosity.artificial.alpha = 0.1\n\
         [[water]]\nfill = {{ box = {{ min = [0, 0, 0], max = [0.9, 0.8, 0.35] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.9, 0.8, 0.56] }} }}\n\
         [[solid]]\nname = \"hull\"\n{hull}"
    );
    Ok(Scene::parse(&text, Path::new(""), &[])?.build::<3>()?.setup)
}

/// Angles (rad) of the x and y axes of the body above the horizontal.
fn inclination(pose: &Pose<3>) -> [f64; 2] {
    let up = pose.rotation.row(2);
    [0, 1].map(|axis| up[axis].atan2(up[2]))
}

/// Time means from `from` to `until` (s) of the inclinations (rad) and of the height of the frame of the hull (m).
fn mean(sim: &mut Simulation<3>, from: f64, until: f64) -> Result<[f64; 3]> {
    time_mean(sim, from, until, |sim| {
        let pose = sim.system().solids()[1].kinematics.pose;
        let [x, y] = inclination(&pose);
        [x, y, pose.position[2]]
    })
}

/// Inclinations (rad) at which the centre of buoyancy is vertically below the centre of mass.
fn hydrostatic_inclination(hull: &SolidSpec<3>) -> Result<[f64; 2]> {
    let Role::Free(body) = &hull.role else { panic!("a free body") };
    let mut turn = [0.0; 3];
    let mut pose = Pose::identity();
    // Each iteration reduces the lever to 0.6 at most: the factor is 5 rad/m, the metacentric heights are 0.09 m and 0.15 m.
    for _ in 0..80 {
        pose = Pose::rotated(Vector::zeros(), &turn);
        pose.position[2] += equilibrium_height(&hull.shape, &pose, body.mass, 1000.0, 0.0)?;
        let lever = hull.shape.submerged_volume(&pose, 0.0).1 - pose.point(&body.centre);
        turn[0] += 5.0 * lever[1];
        turn[1] -= 5.0 * lever[0];
    }
    Ok(inclination(&pose))
}

#[test]
fn a_hull_with_a_centre_of_mass_off_both_axes_lists_and_trims_by_the_hydrostatic_angles() -> Result<()> {
    // 12 × 10 × 6 dp, half under water.
    let words = "shape = { box = { size = [0.6, 0.5, 0.3] } }\nat = { x = 0.45, y = 0.4, draft = \"equilibrium\", turn_deg = [0, 0, 0] }\n\
                 free = { density = 500, centre_offset = [0.02, 0.0125, -0.03] }";
    let mut sim = Simulation::new(pool(words)?)?;
    let exact = hydrostatic_inclination(&sim.system().solids()[1].spec)?.map(f64::to_degrees);
    // The hull starts upright; its period is 1.2 s.
    let [x, y, _] = mean(&mut sim, 0.75, 2.0)?;
    let found = [x, y].map(f64::to_degrees);
    // As in two dimensions, the levels at both ends, 12 and 10 dp apart, are resolved to a quarter of a dp. The angles are 7.2 and
    // 7.4 degrees; measured: 0.9 and 1.2 less.
    for ((exact, found), long) in exact.into_iter().zip(found).zip([12.0, 10.0]) {
        let bound = f64::to_degrees(0.25 / long);
        assert!(exact < -5.0 && (found - exact).abs() < bound, "{found} degrees, hydrostatics {exact}");
    }
    Ok(())
}

#[test]
fn an_l_shaped_raft_floats_level_at_its_draft_as_a_compound_and_as_a_mesh() -> Result<()> {
    // Legs 4 dp broad, 12 and 10 dp long, 6 dp high, half under water.
    let words = "shape = { compound = [{ shape = { box = { size = [0.6, 0.2, 0.3] } }, at = { x = 0.3, y = 0.1, z = 0.15 } },\n\
                 { shape = { box = { size = [0.2, 0.3, 0.3] } }, at = { x = 0.1, y = 0.35, z = 0.15 } }] }\n\
                 at = { x = 0.15, y = 0.15, bottom = 0.2 }\nfree = { density = 500 }";
    for as_mesh in [false, true] {
        let mut setup = pool(words)?;
        if as_mesh {
            let shape = l_prism([0.6, 0.5, 0.3], 0.2);
            let role = Role::Free(FreeBody::from_density(&shape, 500.0));
            (setup.solids[1].shape, setup.solids[1].role) = (shape, role);
        }
        let [x, y, height] = mean(&mut Simulation::new(setup)?, 0.5, 1.0)?;
        // On the lattice: the tenth of a dp of the project, and as much over the length. Measured: 0.004 dp and 0.13 degrees.
        assert!((height - 0.2).abs() < 0.1 * DP, "as a mesh: {as_mesh}: {height} m, Archimedes 0.2 m");
        let most = 0.1 / 10.0;
        assert!(x.abs().max(y.abs()) < most, "as a mesh: {as_mesh}: inclinations {x} and {y} rad");
    }
    Ok(())
}
