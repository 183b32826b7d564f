//! Wind on bodies without water: speed, lever arm and the dry part.

use std::path::Path;

use crate::{
    math::{Vector, expression::Formula},
    scene::Scene,
    solid::{
        AIR_DENSITY, Constraints, Dim, HasEngine, SolidSpec, TimeFunction, WindSpec,
        constraint::assembly::tests::{DrySystem, bar, body, point},
    },
};

fn system<const D: usize>(level: f64) -> DrySystem<D>
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar::<D>("bar", 0.2, point(0.0, 0.0), false)];
    let velocity = (0..D).map(|i| if i == 0 { 10.0 } else { 0.0 });
    let wind = WindSpec::new(velocity, level).drag(1.2).on(0, &solids[0].shape);
    DrySystem::new(solids, Constraints { winds: vec![wind], ..Constraints::default() }, 0.0)
}

fn drifts<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // dV/dt = c (U − V)²: V = U − U/(1 + c U t), with the side of 0.2 m (0.02 m²).
    let mut air = system::<D>(-1.0);
    let area = if D == 2 { 0.2 } else { 0.02 };
    let c = 0.5 * 1.225 * 1.2 * area / body(&air.solids[0]).mass;
    air.run(1e-2, 10.0);
    let expected = 10.0 - 10.0 / (1.0 + c * 100.0);
    // The explicit force is of first order in c U Δt, 1e-3.
    let speed = air.now()[0].velocity[0];
    assert!((speed / expected - 1.0).abs() < 1e-3, "{D}-D: {speed} of {expected}");
    assert!(air.now()[0].spin.axial().iter().all(|spin| spin.abs() < 1e-12), "through the centre");
    // Half of it in the water: half the force, a quarter of the height above the centre, and it turns.
    let mut air = system::<D>(0.0);
    air.run(1e-3, 1e-3);
    let mass = body(&air.solids[0]).mass;
    let force = air.now()[0].velocity[0] * mass / 1e-3;
    assert!((force / (0.25 * 1.225 * 1.2 * area * 100.0) - 1.0).abs() < 1e-9, "{D}-D: {force}");
    let load = air.assembly.loads_on(0).forces;
    let torque = load.torque.axial().into_iter().map(f64::abs).fold(0.0, f64::max);
    assert!((torque / (0.05 * force) - 1.0).abs() < 1e-9, "{D}-D: {torque}");
    // All of it in the water: nothing.
    let mut air = system::<D>(0.1);
    air.run(1e-3, 0.1);
    assert_eq!(air.now()[0].velocity.norm(), 0.0);
}

#[test]
fn wind_moves_a_body_by_its_dry_area() {
    drifts::<2>();
    drifts::<3>();
}

#[test]
fn a_gust_follows_its_law() {
    let solids = vec![bar::<2>("bar", 0.2, point(0.0, 0.0), false)];
    let gust = TimeFunction::Formula(Formula::parse("10*t").unwrap());
    let wind = WindSpec::new([gust, TimeFunction::constant(0.0)], -1.0).on(0, &solids[0].shape);
    let mass = body(&solids[0]).mass;
    let mut air = DrySystem::new(solids, Constraints { winds: vec![wind], ..Constraints::default() }, 0.0);
    air.run(1e-3, 1.0);
    // ∫ ½ ρ A (10 t)² dt = ½ ρ A 100/3; the body's own speed, 0.2 m/s, takes some of it: 2 V̄/U is 3 %.
    let expected = 0.5 * 1.225 * 0.2 * 100.0 / 3.0 / mass;
    let speed: Vector<2> = air.now()[0].velocity;
    assert!(speed[0] < expected && speed[0] > 0.96 * expected, "{} of {expected}", speed[0]);
}

/// The load ½ ρ v² A of a wind of 10 m/s on a box of 0.3 m × 0.1 m in the lower of two basins, and on a dry bed beside the water: A is
/// 0.05 m over the water at its draft, and 0.1 m on the bed.
#[test]
fn wind_loads_bodies_below_the_highest_level() {
    let lower = "[[water]]\nfill = { box = { min = [0.84, 0.0], max = [1.6, 0.2] } }\n";
    for (water, bottom, area) in [(lower, 0.15, 0.05), ("", 0.0, 0.1)] {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [0.76, 0.4] }} }}\n{water}\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.6, 0.9] }} }}\n\
             [[solid]]\nname = \"wall\"\nfixed = true\nshape = {{ box = {{ size = [0.08, 0.8] }} }}\nat = {{ x = 0.8, bottom = 0.0 }}\n\
             [[solid]]\nname = \"b\"\nshape = {{ box = {{ size = [0.3, 0.1] }} }}\nat = {{ x = 1.2, bottom = {bottom} }}\n\
             free = {{ density = 500.0 }}\n[[wind]]\nvelocity = [10.0, 0.0]\non = [\"b\"]\n"
        );
        let built = Scene::parse(&text, Path::new(""), &[]).unwrap().build::<2>().unwrap().setup;
        let start: Vec<_> = built.solids.iter().map(SolidSpec::initial_kinematics).collect();
        let (_, load) = built.constraints.winds[0].loads_at(&start, 0.0).next().unwrap();
        let right = 0.5 * AIR_DENSITY * 100.0 * area;
        assert!((load.force[0] / right - 1.0).abs() < 1e-9, "{} N for {right} N", load.force[0]);
    }
}
