//! A hull from a mesh: its draft by the formula of its lines, by its mesh, and as the water gives it.
//!
//! A Wigley hull displaces 4/9 L B T below its waterline. The scene `wigley` gives it the mass of so much water.
//!
//! `cargo run --release --example mesh_body`, about a minute.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::path::Path;

use pontoon::{
    Result,
    geometry::Shape,
    probe::{ElevationProbe, Probe},
    scene::Scene,
    simulation::Simulation,
};

/// Length, breadth and draft of the hull's lines, m.
const LINES: [f64; 3] = [1.2, 0.36, 0.15];

/// Height of the waterline above the keel in the mesh: its z = 0, m.
const KEEL: f64 = -LINES[2];

fn main() -> Result<()> {
    let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/wigley"), &[])?;
    let (dp, until) = (scene.dp, scene.until);
    let mut sim = Simulation::new(scene.build::<3>()?.setup)?;
    let find = |sim: &Simulation<3>| sim.system().solids().iter().position(|solid| solid.spec.name == "hull");
    let hull = find(&sim).unwrap_or_default();
    let start = sim.system().solids()[hull].kinematics.pose.position[2];
    if let Shape::Mesh { mesh, .. } = &sim.system().solids()[hull].spec.shape {
        let volume = mesh.volume_properties();
        println!(
            "{} facets, {:.6} m³, centroid {:.4} m above the waterline",
            mesh.facets().len(),
            volume.volume,
            volume.centroid[2]
        );
    }
    // Water beside the hull, halfway to the wall; means over the second half.
    let gauge = ElevationProbe::new(sim.system(), &[0.3, 0.1])?;
    let (mut draft, mut weight) = (0.0, 0.0);
    let still = 0.42;
    while sim.time() < until {
        sim.step_to(until)?;
        if sim.time() > 0.5 * until {
            let height = sim.system().solids()[hull].kinematics.pose.position[2];
            draft += (gauge.sample(&sim)[0] - height - KEEL) * sim.dt();
            weight += sim.dt();
        }
    }
    let by_lines = LINES[2];
    println!("{:24} {:>10} {:>12} {:>8}", "", "draft (m)", "off by (mm)", "(dp)");
    for (name, draft) in
        [("by its lines", by_lines), ("by its mesh", still - start - KEEL), ("in the water", draft / weight)]
    {
        let off = draft - by_lines;
        println!("{name:24} {draft:10.4} {:12.2} {:8.3}", 1e3 * off, off / dp);
        assert!(off.abs() < 0.5 * dp, "within half a spacing of its lines");
    }
    Ok(())
}
