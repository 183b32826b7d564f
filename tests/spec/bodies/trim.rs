//! Bodies at rest afloat in space: list and trim together, and solids that are not convex. Single shapes upright are in `buoyancy`,
//! lists in the plane in `equilibrium`.

use std::path::Path;

use pontoon::{
    Result,
    math::{Pose, Vector},
    scene::Scene,
    simulation::{Setup, Simulation},
    solid::{FreeBody, Role, SolidSpec, hydrostatics::equilibrium_height},
};

use super::concave_solids::angle;

const DP: f64 = 0.05;

/// A pool of 18 × 16 dp with water 7 dp deep and the free solid of these words.
fn pool(words: &str) -> Result<Setup<3>> {
    let text = format!(
        "dimension = 3\ndp = {DP}\nuntil = 10.0\nmodel.viscosity.artificial.alpha = 0.1\n\
         [[water]]\nfill = {{ box = {{ min = [0, 0, 0], max = [0.9, 0.8, 0.35] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.9, 0.8, 0.56] }} }}\n\
         [[solid]]\nname = \"hull\"\n{words}"
    );
    Ok(Scene::parse(&text, Path::new(""), &[])?.build::<3>()?.setup)
}

/// How far (rad) its own x and y axes rise above the level: against it an end that lies deep is negative.
fn rise(pose: &Pose<3>) -> [f64; 2] {
    let up = pose.rotation.row(2);
    [0, 1].map(|axis| up[axis].atan2(up[2]))
}

/// Means over the time from `from` to `until` (s) of how its axes rise (rad) and of how high the frame of the hull is (m).
fn mean(sim: &mut Simulation<3>, from: f64, until: f64) -> Result<[f64; 3]> {
    let (mut sums, mut weight) = ([0.0; 3], 0.0);
    while sim.time() < until {
        sim.step_to(until)?;
        if sim.time() > from {
            let pose = sim.system().solids()[1].kinematics.pose;
            let [x, y] = rise(&pose);
            sums.iter_mut().zip([x, y, pose.position[2]]).for_each(|(sum, now)| *sum += now * sim.dt());
            weight += sim.dt();
        }
    }
    Ok(sums.map(|sum| sum / weight))
}

/// How its axes rise (rad) where buoyancy is right below the centre of mass.
fn trimmed(hull: &SolidSpec<3>) -> Result<[f64; 2]> {
    let Role::Free(body) = &hull.role else { panic!("a free body") };
    let mut turn = [0.0; 3];
    let mut pose = Pose::identity();
    // Each round leaves 0.6 of the lever at most: 5 rad/m of its metacentric heights, 0.09 m and 0.15 m.
    for _ in 0..80 {
        pose = Pose::rotated(Vector::zeros(), &turn);
        pose.position[2] += equilibrium_height(&hull.shape, &pose, body.mass, 1000.0, 0.0)?;
        let lever = hull.shape.submerged_volume(&pose, 0.0).1 - pose.point(&body.centre);
        turn[0] += 5.0 * lever[1];
        turn[1] -= 5.0 * lever[0];
    }
    Ok(rise(&pose))
}

#[test]
fn a_hull_with_its_weight_aside_of_both_axes_lists_and_trims_as_hydrostatics_says() -> Result<()> {
    // 12 × 10 × 6 dp, half under water.
    let words = "shape = { box = { size = [0.6, 0.5, 0.3] } }\nat = { x = 0.45, y = 0.4, draft = \"equilibrium\" }\n\
                 free = { density = 500, centre_offset = [0.02, 0.0125, -0.03] }";
    let mut sim = Simulation::new(pool(words)?)?;
    let exact = trimmed(&sim.system().solids()[1].spec)?.map(f64::to_degrees);
    // It starts upright; a swing takes 1.2 s.
    let [x, y, _] = mean(&mut sim, 0.75, 2.0)?;
    let found = [x, y].map(f64::to_degrees);
    // As in the plane: the levels of both ends, 12 and 10 dp apart, are known to a quarter of a dp. 7.2 and 7.4 degrees; found: 0.9 and
    // 1.2 too little.
    for ((exact, found), long) in exact.into_iter().zip(found).zip([12.0, 10.0]) {
        let bound = f64::to_degrees(0.25 / long);
        assert!(exact < -5.0 && (found - exact).abs() < bound, "{found} degrees, hydrostatics {exact}");
    }
    Ok(())
}

#[test]
fn a_raft_like_an_l_rests_level_at_its_draft_drawn_by_blocks_or_by_facets() -> Result<()> {
    // Legs 4 dp broad, 12 and 10 dp long, 6 dp high, half under water.
    let words = "shape = { compound = [{ shape = { box = { size = [0.6, 0.2, 0.3] } }, at = { x = 0.3, y = 0.1, z = 0.15 } },\n\
                 { shape = { box = { size = [0.2, 0.3, 0.3] } }, at = { x = 0.1, y = 0.35, z = 0.15 } }] }\n\
                 at = { x = 0.15, y = 0.15, bottom = 0.2 }\nfree = { density = 500 }";
    for drawn in [false, true] {
        let mut setup = pool(words)?;
        if drawn {
            let shape = angle([0.6, 0.5, 0.3], 0.2);
            let role = Role::Free(FreeBody::from_density(&shape, 500.0));
            (setup.solids[1].shape, setup.solids[1].role) = (shape, role);
        }
        let [x, y, height] = mean(&mut Simulation::new(setup)?, 0.5, 1.0)?;
        // On the lattice: the project's tenth of a dp, and as much over its length. Found: 0.004 dp and 0.13 degrees.
        assert!((height - 0.2).abs() < 0.1 * DP, "by facets: {drawn}: {height} m, Archimedes 0.2 m");
        let most = 0.1 / 10.0;
        assert!(x.abs().max(y.abs()) < most, "by facets: {drawn}: it rises by {x} and {y} rad along its axes");
    }
    Ok(())
}
