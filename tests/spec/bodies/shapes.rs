//! Shapes that become meshes or polygons: volume, boundary particles, errors.

use std::{f64::consts::PI, path::Path};

use pontoon::{error::Result, scene::Scene, simulation::Simulation};

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

/// A wall along `points` with the keys `more`, in water 1 m deep, at a place.
fn wall(points: &str, more: &str, at: &str) -> Scene {
    let text = format!(
        "dimension = 2\ndp = 0.04\nuntil = 1.0\nwater = [{{ fill = {{ box = {{ min = [-1.2, -1.0], max = [1.2, 0.0] }} }} }}]\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [2.4, 1.4] }} }}\nat = [-1.2, -1.0]\n\
         [[solid]]\nname = \"b\"\nfree = {{ density = 900.0 }}\nshape = {{ polyline = {{ points = {points}, {more} }} }}\n\
         at = {{ x = 0.0, {at} }}\n"
    );
    Scene::parse(&text, Path::new(""), &[]).expect("a readable scene")
}

/// Height (m) of the origin of the wall's frame at the start.
fn height(scene: &Scene) -> f64 {
    scene.layout::<2>().expect("a sound scene").solids[1].pose.position[1]
}

#[test]
fn a_turned_wall_has_its_lowest_point_at_its_bottom() {
    // Turned by 45° one leg lies level, with its far side 0.06 m below the corner of the line, which is the origin.
    for angle in [45.0, -45.0] {
        let scene = wall(
            "[[-0.3, 0.3], [0.0, 0.0], [0.3, 0.3]]",
            "thickness = 0.06",
            &format!("bottom = -0.8, angle_deg = {angle}"),
        );
        assert!((height(&scene) + 0.74).abs() < 1e-12, "{angle}: {}", height(&scene));
    }
}

#[test]
fn a_ring_has_its_height_and_its_draft_at_any_angle() {
    // 72 corners: turned by a multiple of 5° it is the same ring, whose far corners are 0.35 m + 0.05 m/cos 2.5° from its middle.
    let points: Vec<String> = (0..=72)
        .map(|k| (PI / 36.0 * f64::from(k % 72)).sin_cos())
        .map(|(sine, cosine)| format!("[{}, {}]", 0.35 * cosine, 0.35 * sine))
        .collect();
    let points = format!("[{}]", points.join(", "));
    for angle in [0.0, 10.0, 45.0] {
        let on_bed = wall(&points, "thickness = 0.05", &format!("bottom = -0.8, angle_deg = {angle}"));
        let exact = -0.8 + 0.35 + 0.05 / 2.5f64.to_radians().cos();
        assert!((height(&on_bed) - exact).abs() < 1e-12, "{angle}: {}", height(&on_bed));
    }
    let drafts = [0.0, 10.0, 45.0].map(|angle| {
        let found = common::preflight_report(&wall(
            &points,
            "thickness = 0.05",
            &format!("draft = \"equilibrium\", angle_deg = {angle}"),
        ));
        found.bodies[0].draft_m
    });
    // The search for the equilibrium stops at 1e-14 of the height.
    assert!(drafts.iter().all(|draft| (draft - drafts[0]).abs() < 1e-9), "{drafts:?}");
}
