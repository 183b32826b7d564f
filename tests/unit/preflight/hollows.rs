//! Unit tests of `src/preflight/hollows.rs`: hulls with an inside, from the scene to the findings.

use std::path::Path;

use crate::{
    preflight::{BodySummary, Preflight, preflight},
    scene::{BuiltScene, Scene},
    simulation::{Dimension, Simulation},
    solid::Dim,
};

/// The pre-flight of a scene, and the positions of its water (m).
fn judged<const D: usize>(text: &str) -> (Preflight, Vec<crate::math::Vector<D>>)
where
    Dim<D>: Dimension<D>,
{
    let BuiltScene { setup, plan, initial_water, .. } =
        Scene::parse(text, Path::new(""), &[]).unwrap().build::<D>().unwrap();
    let sim = Simulation::new(setup).unwrap();
    let found = preflight(&sim, &plan, initial_water, &[]);
    let water = sim.system().fluid().r.to_vec();
    (found, water)
}

/// An open barge of 144 kg/m, 1 m × 0.5 m, with walls of 0.1 m, its sections `more`, in 3 m of water 0.6 m deep.
fn barge(more: &str, dp: f64) -> (Preflight, Vec<crate::math::Vector<2>>) {
    judged::<2>(&format!(
        "dimension = 2\ndp = {dp}\nuntil = 1.0\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [3.0, 0.6] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [3.0, 1.0] }} }}\n\
         [[solid]]\nname = \"barge\"\nfree = {{ density = 800.0 }}\n\
         shape = {{ polygon = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.9, 0.5], [0.9, 0.1], [0.1, 0.1], [0.1, 0.5], [0.0, 0.5]] }}\n\
         at = {{ x = 1.0, draft = \"equilibrium\" }}\n{more}\n"
    ))
}

fn topics(found: &Preflight) -> Vec<&str> {
    found.findings.iter().map(|finding| finding.topic).collect()
}

/// Draft (m) at rest.
fn draft(body: &BodySummary) -> f64 {
    body.afloat.as_ref().map_or(f64::NAN, |rest| rest.draft_m)
}

#[test]
fn a_dry_barge_floats_on_its_outer_hull() {
    for dp in [0.02, 0.025] {
        let (found, water) = barge("dry = true", dp);
        let body = &found.bodies[0];
        let rest = body.afloat.as_ref().unwrap();
        // 144 kg/m over 1 m; KB = 0.072, BM = 1/(12 · 0.144), KG = (0.1 · 0.05 + 0.08 · 0.3)/0.18 m. The grid of the
        // hollow is exact on its flat faces, and misses a part of a cell in two corners.
        let gm = 0.072 + 1.0 / 12.0 / 0.144 - 0.029 / 0.18;
        assert!((rest.draft_m - 0.144).abs() < 5e-4, "draft {} m", rest.draft_m);
        assert!((body.draft_m - rest.draft_m).abs() < 1e-6 && (body.displaced_kg - 144.0).abs() < 1e-3);
        assert!((rest.tilts[0].gm_m - gm).abs() < 0.01 * gm, "GM {} m, exact {gm} m", rest.tilts[0].gm_m);
        assert!((rest.waterplane_m2 - 1.0).abs() < 1e-3, "{}", rest.waterplane_m2);
        let inside = water.iter().filter(|x| x[0] > 1.05 && x[0] < 1.95 && x[1] > 0.6 - 0.144 + 0.05).count();
        assert_eq!(inside, 0, "particles in the hull");
        // The water outside is as much as fits: 3 m × 0.6 m less 0.144 m².
        let area = water.len() as f64 * dp * dp;
        assert!((area - 1.656).abs() < 0.01 * 1.656, "{area} m²");
        assert!(
            !topics(&found)
                .iter()
                .any(|topic| ["water_inside", "hull_floods", "off_draft", "capsizes"].contains(topic))
        );
    }
}

#[test]
fn a_barge_that_the_sea_fills_is_reported_with_the_key_that_keeps_it_out() {
    let (found, _) = barge("", 0.02);
    let finding = found.findings.iter().find(|finding| finding.topic == "water_inside").unwrap();
    assert!(finding.mend.contains("dry = true") && finding.what.contains("water particles"), "{finding:?}");
    // Full of water it floats on its walls: 0.144 m² of 0.1 m² of floor and 0.2 m of walls.
    assert!((draft(&found.bodies[0]) - (0.1 + 0.044 / 0.2)).abs() < 1e-6);
    assert!(!topics(&barge("dry = false", 0.02).0).contains(&"water_inside"));
}

#[test]
fn water_by_the_name_of_the_hull_stays_in_it_and_weighs_on_it() {
    // Ballast 0.02 m deep at the draft of 0.16 m: 0.8 m × 0.02 m adds 16 kg/m to 144 kg/m. Its floor is at 0.54 m.
    let (found, water) = barge(
        "dry = true\n[[water]]\ninside = \"barge\"\nfill = { box = { min = [1.0, 0.0], max = [2.0, 0.56] } }",
        0.02,
    );
    let inside = water.iter().filter(|x| x[0] > 1.1 && x[0] < 1.9 && x[1] > 0.54).count();
    assert_eq!(inside, 40, "a row of particles");
    assert!(!topics(&found).contains(&"water_inside"), "{:?}", found.findings);
    assert!((found.bodies[0].draft_m - 0.16).abs() < 1e-3, "{}", found.bodies[0].draft_m);
    let rest = found.bodies[0].afloat.as_ref().unwrap();
    assert!((rest.draft_m - 0.16).abs() < 1e-3, "{}", rest.draft_m);
    // Outer waterplane less the free surface inside, over the displacement of barge and ballast:
    // 1/12 − 0.8³/12 over 0.16 m², and the moments of 0.16 m² at 0.08 m, 0.016 m² at 0.11 m and 144 kg/m at 0.1611 m.
    let gm = ((1.0 - 0.512) / 12.0 + 0.16 * 0.08 - 0.016 * 0.11 - 0.144 * 0.029 / 0.18) / 0.16;
    assert!((rest.tilts[0].gm_m - gm).abs() < 0.02 * gm, "GM {}, exact {gm}", rest.tilts[0].gm_m);
}

#[test]
fn a_hull_that_is_too_heavy_floods() {
    let scene = |more: &str| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.5, 0.6] }} }}\n\
             [[solid]]\nname = \"tub\"\nshape = {{ tank = {{ size = [0.5, 0.3], thickness = 0.1 }} }}\n\
             free = {{ density = 3500.0 }}\ndry = true\n{more}"
        )
    };
    // 0.7 m × 0.1 m of floor and 0.06 m² of walls: 455 kg/m, and 280 kg/m with the water at the rim.
    let error = Scene::parse(&scene("at = { x = 0.5, draft = \"equilibrium\" }"), Path::new(""), &[])
        .unwrap()
        .build::<2>()
        .err()
        .unwrap();
    assert!(error.to_string().contains("floods"), "{error}");
    let (found, _) = judged::<2>(&scene("at = { x = 0.5, y = 0.4 }"));
    assert!(found.bodies[0].support == "floods" && topics(&found).contains(&"hull_floods"), "{:?}", found.findings);
}

#[test]
fn closed_hollows_are_dry_unless_the_scene_fills_them() {
    // A closed ring of boxes, 0.4 m × 0.4 m outside and 0.3 m × 0.3 m inside: 0.07 m² of 1200 kg/m³ is 84 kg/m.
    let ring = |more: &str| {
        let side = |size: &str, at: &str| format!("{{ shape = {{ box = {{ size = {size} }} }}, at = {at} }}");
        let sides = [
            side("[0.4, 0.05]", "{ y = -0.175 }"),
            side("[0.4, 0.05]", "{ y = 0.175 }"),
            side("[0.05, 0.3]", "{ x = -0.175 }"),
            side("[0.05, 0.3]", "{ x = 0.175 }"),
        ];
        format!(
            "dimension = 2\ndp = 0.0125\nuntil = 1.0\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.6] }} }}\n\
             [[solid]]\nname = \"drum\"\nshape = {{ compound = [{}] }}\nfree = {{ density = 1200.0 }}\n{more}",
            sides.join(", ")
        )
    };
    let (found, water) = judged::<2>(&ring("at = { x = 0.5, draft = \"equilibrium\" }"));
    assert!((draft(&found.bodies[0]) - 0.21).abs() < 1e-3, "{}", draft(&found.bodies[0]));
    let inside = |water: &[crate::math::Vector<2>], y: f64| {
        water.iter().filter(|x| (x[0] - 0.5).abs() < 0.15 && (x[1] - y).abs() < 0.15).count()
    };
    assert_eq!(inside(&water, 0.59), 0);
    let (found, water) = judged::<2>(&ring("at = { x = 0.5, y = 0.3 }\ndry = false"));
    assert_eq!(inside(&water, 0.3), 24 * 24);
    assert_eq!(found.bodies[0].support, "bottom", "it is full of water");
    let named = "at = { x = 0.5, y = 0.3 }\n[[water]]\ninside = \"drum\"\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.3] } }";
    assert_eq!(inside(&judged::<2>(&ring(named)).1, 0.3), 24 * 12);
}

#[test]
fn a_key_that_has_no_effect_is_refused() {
    let text = "dimension = 2\ndp = 0.02\nuntil = 1.0\n\
                [[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.6] } }\n\
                [[solid]]\nname = \"box\"\nshape = { box = { size = [0.2, 0.2] } }\nat = { x = 0.5, y = 0.5 }\n\
                free = { density = 500.0 }\ndry = true\n";
    let error = Scene::parse(text, Path::new(""), &[]).unwrap().build::<2>().err().unwrap();
    assert!(error.to_string().contains("encloses no space"), "{error}");
}

#[test]
fn the_heel_of_a_hull_that_starts_turned_is_an_estimate() {
    let scene = |turn: &str| {
        judged::<2>(&format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [3.0, 0.6] }} }}\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [3.0, 1.0] }} }}\n\
             [[solid]]\nname = \"barge\"\ndry = true\nfree = {{ density = 800.0 }}\n\
             shape = {{ polygon = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.9, 0.5], [0.9, 0.1], [0.1, 0.1], [0.1, 0.5], [0.0, 0.5]] }}\n\
             at = {{ x = 1.0, draft = \"equilibrium\", angle_deg = {turn} }}\n"
        ))
        .0
    };
    let rest = |turn: &str| scene(turn).bodies[0].afloat.clone().unwrap();
    assert!(!rest("0.0").heel_is_estimate && rest("0.0").heel_deg.unwrap() < 0.01);
    let turned = rest("5.0");
    assert!(turned.heel_is_estimate && (turned.heel_deg.unwrap() - 5.0).abs() < 0.3, "{:?}", turned.heel_deg);
}

#[test]
fn water_inside_heaves_with_a_hull_and_lowers_its_metacentric_height() {
    let (found, _) = barge(
        "dry = true\n[[water]]\ninside = \"barge\"\nfill = { box = { min = [0.0, 0.0], max = [3.0, 0.58] } }",
        0.02,
    );
    let body = &found.bodies[0];
    let rest = body.afloat.as_ref().unwrap();
    let water = rest.enclosed_water_kg.unwrap();
    // Whole rows over 0.8 m.
    let all = 144.0 + water;
    assert!((rest.draft_m - 0.001 * all).abs() < 1e-3, "draft {} m with {water} kg of water", rest.draft_m);
    let heave = std::f64::consts::TAU * (all / 9810.0).sqrt();
    assert!((rest.heave_s - heave).abs() < 2e-3 * heave, "{} s, exact {heave} s", rest.heave_s);
    // Δ = 144 kg/m and the water; its free surface has I = 0.8³/12 m⁴/m.
    let (draft, depth) = (0.001 * all, water / 800.0);
    let heights = (144.0 * 0.029 / 0.18 + water * (0.1 + 0.5 * depth)) / all;
    let gm = 0.5 * draft + (1.0 - 0.8f64.powi(3)) / 12.0 / draft - heights;
    assert!((rest.tilts[0].gm_m - gm).abs() < 0.02 * gm, "GM {} m, exact {gm} m", rest.tilts[0].gm_m);
}

#[test]
fn a_dry_hull_with_sloping_sides_has_its_draft_waterplane_and_metacentric_height() {
    for dp in [0.04, 0.025] {
        let (found, _) = judged::<2>(&format!(
            "dimension = 2\ndp = {dp}\nuntil = 1.0\n\
             [[water]]\nfill = {{ box = {{ min = [-1.2, -1.0], max = [1.2, 0.0] }} }}\n\
             [[solid]]\nname = \"b\"\nfree = {{ mass = 60.0 }}\ndry = true\n\
             shape = {{ polygon = [[-0.5, 0.4], [0.0, 0.0], [0.5, 0.4], [0.42, 0.4], [0.0, 0.07], [-0.42, 0.4]] }}\n\
             at = {{ x = 0.0, draft = \"equilibrium\" }}\n"
        ));
        let rest = found.bodies[0].afloat.as_ref().unwrap();
        // d²/0.8 = 0.06 m². The centre of mass is that of the outer triangle less the inner one.
        let draft = (0.8f64 * 0.06).sqrt();
        let (breadth, outer, inner) = (2.0 * draft / 0.8, 0.5 * 0.4, 0.42 * 0.33);
        let kg = (outer * 0.8 / 3.0 - inner * (0.07 + 2.0 / 3.0 * 0.33)) / (outer - inner);
        let gm = breadth.powi(3) / 12.0 / 0.06 + 2.0 / 3.0 * draft - kg;
        assert!((rest.draft_m - draft).abs() < 1e-9, "draft {} m", rest.draft_m);
        // Differences over ±1e-4: their error is of that order squared.
        assert!((rest.waterplane_m2 / breadth - 1.0).abs() < 1e-6, "{} for {breadth}", rest.waterplane_m2);
        assert!((rest.tilts[0].gm_m / gm - 1.0).abs() < 1e-5, "GM {} m for {gm} m", rest.tilts[0].gm_m);
        assert!(!topics(&found).contains(&"turned_to_rest"), "a symmetric hull");
    }
}
