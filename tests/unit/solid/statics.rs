//! Unit tests of `src/solid/statics.rs`.

use super::*;
use crate::{
    geometry::Shape,
    solid::{ForceSpec, JointKind, JointSpec, Motor, Role, RopeSpec, SpringSpec},
};

const WATER: WaterAtRest = WaterAtRest { rho0: 1000.0, g: 10.0, level: 0.0 };

/// A box (width, height) of this density with its lowest point at `bottom` (m).
fn block(name: &str, size: [f64; 2], density: f64, [x, bottom]: [f64; 2]) -> SolidSpec<2> {
    let shape = Shape::Box { size: Vector::from(size) };
    SolidSpec::free(name, shape, density).at([x, bottom + 0.5 * size[1]])
}

/// The system of these solids over a bottom at −5 m, passed to `judge`.
fn at_rest(solids: &[SolidSpec<2>], constraints: &Constraints<2>, judge: impl Fn(&StaticSystem<2>)) {
    let body = |(solid, spec): (usize, &SolidSpec<2>)| StaticBody {
        solid,
        hull: Hull::new(&solids[solid].shape),
        body: match &solids[solid].role {
            Role::Free(body) => body,
            _ => panic!("free bodies"),
        },
        pose: spec.pose,
        bottom: -5.0,
        level: WATER.level,
    };
    let specs: Vec<&SolidSpec<2>> = solids.iter().collect();
    judge(&StaticSystem::new(solids.iter().enumerate().map(body).collect(), &specs, constraints, WATER));
}

/// Depth (m) of the lowest point of body `i` at rest.
fn draft(system: &StaticSystem<2>, i: usize) -> f64 {
    -system.bodies[i].hull.extent(&system.pose(i))[0]
}

#[test]
fn a_float_carries_the_clump_on_its_rope() {
    // 0.3 m × 400 kg/m³ × 0.15 m = 18 kg/m, and 2000 kg/m³ × 0.01 m² = 20 kg/m below it: 38 kg/m over 0.3 m.
    let solids = [block("float", [0.3, 0.15], 400.0, [0.0, -0.1]), block("clump", [0.1, 0.1], 3000.0, [0.0, -0.6])];
    for length in [0.4, 0.7] {
        let mut ties = Constraints::default();
        ties.ropes
            .push(RopeSpec::new("line", [LineEnd::on(0, [0.0, -0.1]), LineEnd::on(1, [0.0, -0.5])]).max_length(length));
        at_rest(&solids, &ties, |system| {
            // The rope stretches by 1e-5 of the draft that its load causes.
            assert!((draft(system, 0) - 38.0 / 300.0).abs() < 1e-5, "draft {}", draft(system, 0));
            assert_eq!((system.support(0), system.support(1)), (Support::Water, Support::Lines));
            assert!((system.tie_load(0) - 200.0).abs() < 1e-3 && (system.tie_load(1) + 200.0).abs() < 1e-3);
            // A rope that is slack at the start ends 0.7 m long.
            let apart = -0.1 - system.bodies[0].pose.position[1] + system.pose(0).position[1];
            let top = draft(system, 1) - 0.1;
            assert!((top + apart - length).abs() < 1e-5, "{top} {apart}");
            // The weight acts at the fastening: KG = (18 · 0.075 + 20 · 0)/38 above the keel.
            let t = 38.0 / 300.0;
            let gm = 0.5 * t + 0.3 * 0.3 / (12.0 * t) - 18.0 * 0.075 / 38.0;
            let found = system.metacentric_height(0, &[1.0]);
            assert!((found - gm).abs() < 1e-4, "GM {found}, exact {gm}");
        });
    }
}

#[test]
fn a_heavy_keel_bolted_under_a_light_deck_is_one_body() {
    // Deck 1 m × 0.2 m of 200 kg/m³ on a keel 0.2 m × 0.4 m of 1500 kg/m³: 40 + 120 = 160 kg/m.
    let solids = [block("deck", [1.0, 0.2], 200.0, [0.0, -0.1]), block("keel", [0.2, 0.4], 1500.0, [0.0, -0.5])];
    let mut ties = Constraints::default();
    ties.joints.push(JointSpec::new(
        "bolt",
        JointKind::Fixed,
        [Some(0), Some(1)],
        Vector::from([0.0, -0.1]),
        Vector::zeros(),
    ));
    at_rest(&solids, &ties, |system| {
        // The keel displaces 80 kg/m, the deck the other 80 over 1 m.
        assert!((draft(system, 0) - 0.08).abs() < 1e-9 && (draft(system, 1) - 0.48).abs() < 1e-9);
        assert!(system.support(0) == Support::Water && system.support(1) == Support::Water);
        // Heights above the foot of the keel.
        let kb = (80.0 * 0.2 + 80.0 * 0.44) / 160.0;
        let kg = (40.0 * 0.5 + 120.0 * 0.2) / 160.0;
        let gm = kb + 1.0 / 12.0 / 0.16 - kg;
        for i in 0..2 {
            let found = system.metacentric_height(i, &[1.0]);
            assert!((found - gm).abs() < 1e-5, "GM {found}, exact {gm}");
        }
        let (inertia, displaced) = system.inertia_and_displacement(0, &[1.0]);
        let exact = 40.0 * (1.04 / 12.0 + (0.5 - kg).powi(2)) + 120.0 * (0.2 / 12.0 + (0.2 - kg).powi(2));
        assert!((inertia / exact - 1.0).abs() < 1e-9 && (displaced - 160.0).abs() < 1e-6, "{inertia} {displaced}");
        let (mass, stiffness) = system.heaving_mass_and_stiffness(0);
        assert!((mass - 160.0).abs() < 1e-9 && stiffness == 0.0);
    });
}

#[test]
fn a_taut_spring_to_the_bed_pulls_a_buoy_deeper() {
    // 0.2 m × 0.2 m of 500 kg/m³; k = 1000 N/m², 0.1 m stretched at the start at a draft of 0.1 m.
    let solids = [block("buoy", [0.2, 0.2], 500.0, [0.0, -0.1])];
    let mut ties = Constraints::default();
    let ends = [LineEnd::on(0, [0.0, -0.1]), LineEnd::ground([0.0, -1.0])];
    ties.springs.push(SpringSpec::new("mooring", ends, 1000.0).rest_length(0.8).tension_only());
    at_rest(&solids, &ties, |system| {
        // 2000 N/m² of waterplane and 1000 of the spring share 100 N/m.
        assert!((draft(system, 0) - (0.1 + 100.0 / 3000.0)).abs() < 1e-9, "{}", draft(system, 0));
        let (mass, stiffness) = system.heaving_mass_and_stiffness(0);
        assert!((mass - 20.0).abs() < 1e-12 && (stiffness - 1000.0).abs() < 1e-9);
    });
}

#[test]
fn a_hinge_to_the_ground_holds_a_heavy_flap_and_an_untied_one_sinks() {
    let solids = [block("flap", [0.1, 0.5], 2000.0, [0.0, -0.6])];
    let mut ties = Constraints::default();
    at_rest(&solids, &ties, |system| assert_eq!(system.support(0), Support::Bottom));
    ties.joints.push(JointSpec::new(
        "foot",
        JointKind::Hinge,
        [None, Some(0)],
        Vector::from([0.0, -0.6]),
        Vector::zeros(),
    ));
    at_rest(&solids, &ties, |system| assert_eq!(system.support(0), Support::Held));
    // It has 50 kg/m more than the water that it displaces. A second joint takes an unknown part.
    let loads = |system: &StaticSystem<2>| system.overloads().iter().map(|own| own.load).collect::<Vec<_>>();
    ties.joints[0].lifetime.strength = 499.0;
    at_rest(&solids, &ties, |system| assert!((loads(system)[0] - 500.0).abs() < 1e-6, "{:?}", loads(system)));
    let second = JointSpec { name: "head".into(), ..ties.joints[0].clone() };
    ties.joints.push(second);
    at_rest(&solids, &ties, |system| assert!(loads(system).is_empty()));
    ties.joints.pop();
    ties.joints[0].lifetime.strength = 501.0;
    at_rest(&solids, &ties, |system| assert!(loads(system).is_empty()));
    // On an upright slider it heaves alone, and does not turn.
    ties.joints[0] =
        JointSpec::new("mast", JointKind::Slider, [None, Some(0)], Vector::from([0.0, -0.6]), Vector::from([0.0, 1.0]));
    let float = [block("float", [0.4, 0.2], 500.0, [0.0, -0.02])];
    at_rest(&float, &ties, |system| {
        assert!((draft(system, 0) - 0.1).abs() < 1e-9 && system.support(0) == Support::Water);
        assert!(system.is_tilt_locked(0, &[1.0]));
    });
}

#[test]
fn an_anchor_on_the_bottom_holds_a_buoy_down_or_stays_slack() {
    // Net buoyancy of the buoy is 200 N/m, the anchor's weight in water 500 N/m.
    let solids = [block("buoy", [0.2, 0.2], 500.0, [0.0, -1.0]), block("anchor", [0.5, 0.1], 2000.0, [0.0, -5.0])];
    let mut ties = Constraints::default();
    ties.ropes.push(RopeSpec::new("rope", [LineEnd::on(0, [0.0, -1.0]), LineEnd::on(1, [0.0, -4.9])]));
    at_rest(&solids, &ties, |system| {
        assert_eq!((system.support(0), system.support(1)), (Support::Lines, Support::Bottom));
        assert!((system.tie_load(0) - 200.0).abs() < 1e-2, "{}", system.tie_load(0));
    });
    ties.ropes[0].max_length = Some(6.0);
    at_rest(&solids, &ties, |system| {
        assert_eq!((system.support(0), system.support(1)), (Support::Water, Support::Bottom));
        assert!((draft(system, 0) - 0.1).abs() < 1e-9 && system.tie_load(0).abs() < 1e-9);
    });
}

/// On a guide at 30° to the horizontal, a level force F lifts with F cot 30°: 173.2 N/m over 10 kN/m² of waterplane of 1 m. A motor of
/// 50 N/m along the guide lifts with 50/sin 30° = 100 N/m.
#[test]
fn an_inclined_slider_turns_a_level_force_into_a_rise() {
    let solids = [block("float", [1.0, 0.4], 500.0, [0.0, -0.2])];
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let guide =
        JointSpec::new("g", JointKind::Slider, [None, Some(0)], Vector::from([0.0, 1.0]), Vector::from([cos, sin]));
    let force = ForceSpec::new("f", 0).force([100.0, 0.0]);
    for (joint, forces, lift) in [
        (guide.clone(), vec![force], 100.0 * cos / sin),
        (guide.motor(Motor::default().force(50.0)), vec![], 50.0 / sin),
    ] {
        at_rest(&solids, &Constraints { joints: vec![joint], forces, ..Constraints::default() }, |system| {
            let (rise, way) = (lift / 1e4, system.pose(0).position);
            assert!((way - Vector::from([rise * cos / sin, rise])).norm() < 1e-9, "{way:?}, rise {rise}");
            assert_eq!(system.support(0), Support::Water);
            // What heaves by 1 m moves by 2 m along the guide.
            assert!((system.heaving_mass_and_stiffness(0).0 - 4.0 * 200.0).abs() < 1e-9);
            let found = free_rest(system, 0).unwrap();
            assert!((found.drafts[0].1 - (0.2 - rise)).abs() < 1e-9 && found.periods.len() == 1, "{found:?}");
            let exact = std::f64::consts::TAU * (800.0f64 / 1e4).sqrt();
            assert!((found.periods[0] / exact - 1.0).abs() < 1e-6, "{found:?}, exact {exact} s");
        });
    }
}
