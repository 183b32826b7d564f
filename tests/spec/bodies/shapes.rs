//! Shapes that become meshes or polygons: volume, boundary particles, errors.

use std::f64::consts::PI;

use pontoon::{error::Result, simulation::Simulation};

use crate::common;

fn scene(dimension: usize, shape: &str) -> String {
    let (water, tank, at) = match dimension {
        2 => ("[1.2, 0.6]", "[1.2, 0.9]", "x = 0.6, y = 0.3"),
        _ => ("[1.2, 1.2, 0.6]", "[1.2, 1.2, 0.9]", "x = 0.6, y = 0.6, z = 0.3"),
    };
    let origin = vec!["0"; dimension].join(", ");
    format!(
        "dimension = {dimension}\ndp = 0.05\nuntil = 1.0\nwater = [{{ fill = {{ box = {{ min = [{origin}], max = {water} }} }} }}]\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = {tank} }} }}\n\
         [[solid]]\nname = \"body\"\nfree = {{ density = 500 }}\nat = {{ {at} }}\nshape = {{ {shape} }}"
    )
}

/// Volume of the body, and the number of its boundary particles.
fn body<const D: usize>(sim: &Simulation<D>) -> (f64, usize) {
    let solid = &sim.system().solids()[1];
    (solid.spec.shape.volume_properties().volume, solid.boundary.len())
}

#[test]
fn shapes_have_their_volume_and_boundary_particles() -> Result<()> {
    let cone = PI * 0.04 * 0.3 / 3.0;
    for (shape, volume) in [
        ("ellipsoid = { radii = [0.3, 0.2, 0.15] }", 4.0 / 3.0 * PI * 0.009),
        ("cone = { radius = 0.2, length = 0.3 }", cone),
        ("cone = { radius = 0.2, length = 0.3, axis = \"x\" }", cone),
        ("frustum = { radius_bottom = 0.0, radius_top = 0.2, length = 0.3 }", cone),
        ("frustum = { radius_bottom = 0.2, radius_top = 0.1, length = 0.3, axis = \"y\" }", PI * 0.1 * 0.07),
        ("wedge = { size = [0.4, 0.3, 0.2] }", 0.012),
        (
            "prism = { points = [[0, 0], [0.3, 0], [0.3, 0.15], [0.15, 0.15], [0.15, 0.3], [0, 0.3]], length = 0.4 }",
            0.027,
        ),
        ("torus = { radius = 0.3, tube_radius = 0.1 }", 2.0 * PI * PI * 0.003),
    ] {
        let (found, particles) = body(&common::scene_simulation::<3>(&scene(3, shape))?);
        assert!((found / volume - 1.0).abs() < 1e-9, "{shape}: {found}, exact {volume}");
        assert!(particles > 20, "{shape}: {particles} boundary particles");
    }
    for (shape, area) in [("ellipsoid = { radii = [0.3, 0.2] }", PI * 0.06), ("wedge = { size = [0.4, 0.2] }", 0.04)] {
        let (found, particles) = body(&common::scene_simulation::<2>(&scene(2, shape))?);
        assert!((found / area - 1.0).abs() < 1e-9, "{shape}: {found}, exact {area}");
        assert!(particles > 10, "{shape}: {particles} boundary particles");
    }
    Ok(())
}
