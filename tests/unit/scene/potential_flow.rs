//! Unit tests of `src/scene/potential_flow.rs`.

use std::path::Path;

use super::*;

/// The body of a dry tub of 1 m × 1 m × 0.8 m with walls and a floor of 0.2 m, 0.5 m deep in water of 1 m, with
/// `more`.
fn tub(more: &str) -> PanelledBody {
    let wall =
        |size: &str, at: &str| format!("{{ shape = {{ box = {{ size = [{size}] }} }}, at = {{ {at}, z = 0.5 }} }}");
    let walls = [
        wall("0.2, 1.0, 0.6", "x = -0.4"),
        wall("0.2, 1.0, 0.6", "x = 0.4"),
        wall("0.6, 0.2, 0.6", "y = -0.4"),
        wall("0.6, 0.2, 0.6", "y = 0.4"),
    ];
    let text = format!(
        "dimension = 3\ndp = 0.05\nuntil = 1.0\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [3.0, 3.0, 1.0] }} }}\n{more}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [3.0, 3.0, 2.0] }} }}\n\
         [[solid]]\nname = \"tub\"\ndry = true\nfree = {{ mass = 356.0 }}\nat = {{ x = 1.5, y = 1.5, draft = 0.5 }}\n\
         shape = {{ compound = [{{ shape = {{ box = {{ size = [1.0, 1.0, 0.2] }} }}, at = {{ z = 0.1 }} }}, {}] }}\n",
        walls.join(", ")
    );
    let scene = Scene::parse(&text, Path::new(""), &[]).unwrap();
    PanelledScene::new(&scene, &[], 200).unwrap().bodies.remove(0)
}

/// Panels, volume and centre of buoyancy are those of the outside water, 1 m × 1 m × 0.5 m, with and without water inside.
#[test]
fn water_inside_a_hull_does_not_change_what_it_displaces() {
    let water = "[[water]]\ninside = \"tub\"\nfill = { box = { min = [1.2, 1.2, 0.7], max = [1.8, 1.8, 1.1] } }";
    for body in [tub(""), tub(water)] {
        let height = body.centre_of_buoyancy_m[2];
        assert!((body.displaced_volume_m3 - 0.5).abs() < 1e-9 && (height + 0.25).abs() < 1e-9, "{height}");
        // The hull is of boxes: its panels enclose it up to round-off.
        assert!((body.panel_volume_m3 - 0.5).abs() < 1e-9, "{}", body.panel_volume_m3);
    }
}

#[test]
fn water_inside_a_hull_rises_with_it_and_runs_to_its_lower_side() {
    let weight = 9810.0;
    let stiffness = |more: &str| {
        let body = tub(more);
        (body.hydrostatic_stiffness, body.enclosed_water_kg)
    };
    let (empty, none) = stiffness("");
    assert!(none.is_none() && (empty[2][2] - weight).abs() < 1e-3 * weight, "C33 = {}", empty[2][2]);
    let water = "[[water]]\ninside = \"tub\"\nfill = { box = { min = [1.2, 1.2, 0.7], max = [1.8, 1.8, 1.1] } }";
    let (filled, own) = stiffness(water);
    // 0.36 m² up to 0.4 m above the floor at 0.7 m.
    assert!((filled[2][2] - weight).abs() < 1e-3 * weight, "C33 = {}", filled[2][2]);
    assert!((own.unwrap() - 144.0).abs() < 1.5, "{own:?}");
    // About the same point its weight at 0.9 m adds −W (z_w − z_ref), and its free surface −ρ g 0.6⁴/12.
    let inside = 1000.0 * 0.36 * 0.6;
    let whole = 1000.0 * 0.8 - inside;
    let reference = 0.5 + (800.0 * 0.4 - inside * 0.5) / whole;
    let change = -9.81 * 144.0 * (0.9 - reference) - weight * 0.6f64.powi(4) / 12.0;
    let found = filled[3][3] - empty[3][3];
    assert!((found - change).abs() < 0.03 * change.abs(), "C44 changes by {found}; exact {change}");
}
