//! Loads of joints and ropes in series, without water.

use crate::{
    geometry::Shape,
    math::{Bivector, Vector},
    solid::{
        Constraints, Dim, FreeBody, HasEngine, JointKind, JointSpec, Kinematics, LineEnd, Role, RopeSpec, SolidSpec,
        constraint::assembly::tests::{DrySystem, G, across, bar, body, point},
    },
};

/// A bar 0.2 m high at the height `up` (m) with `density` (kg/m³).
fn link<const D: usize>(name: &str, up: f64, density: f64) -> SolidSpec<D> {
    let mut solid = bar(name, 0.2, point(0.0, up), false);
    let shape = Shape::Box { size: Vector::from_fn(|i, _| if i == D - 1 { 0.2 } else { 0.1 }) };
    solid.role = Role::Free(FreeBody::from_density(&shape, density));
    solid
}

/// A chain of `count` light links below the ground, with a last link of `heavy` times their density.
fn links<const D: usize>(count: usize, heavy: f64) -> Vec<SolidSpec<D>> {
    let density = |i: usize| if i + 1 == count { 100.0 * heavy } else { 100.0 };
    (0..count).map(|i| link(&format!("link {i}"), -0.15 - 0.3 * i as f64, density(i))).collect()
}

fn solid_above(i: usize) -> Option<usize> {
    i.checked_sub(1)
}

/// Ropes 0.1 m long between the links.
fn ropes<const D: usize>(count: usize) -> Constraints<D> {
    let rope = |i: usize| {
        let at = -0.3 * i as f64;
        let ends = [
            LineEnd { solid: solid_above(i), at: point(0.0, if i == 0 { 0.0 } else { at + 0.05 }) },
            LineEnd { solid: Some(i), at: point(0.0, at - 0.05) },
        ];
        RopeSpec::new(format!("rope {i}"), ends)
    };
    Constraints { ropes: (0..count).map(rope).collect(), ..Constraints::default() }
}

/// Joints of one kind between the links.
fn joints<const D: usize>(count: usize, kind: JointKind) -> Constraints<D> {
    let joint = |i: usize| {
        let at = point(0.0, -0.3 * i as f64);
        JointSpec::new(format!("joint {i}"), kind, [solid_above(i), Some(i)], at, across())
    };
    Constraints { joints: (0..count).map(joint).collect(), ..Constraints::default() }
}

/// Weight (N) of each link with all links below it.
fn weights<const D: usize>(solids: &[SolidSpec<D>]) -> Vec<f64> {
    (0..solids.len()).map(|i| solids[i..].iter().map(|solid| body(solid).mass * G).sum()).collect()
}

fn hangs<const D: usize>(count: usize, heavy: f64, ties: impl Fn(usize) -> Constraints<D>)
where
    Dim<D>: HasEngine<D>,
{
    let solids = links(count, heavy);
    let exact = weights(&solids);
    let mut air = DrySystem::new(solids, ties(count), G);
    for (step, dt) in [1e-3; 300].into_iter().chain([2e-4, 1e-5, 1e-3, 7e-4, 1e-3]).enumerate() {
        air.step(dt);
        for (i, exact) in exact.iter().enumerate() {
            let load = match air.assembly.joints.is_empty() {
                true => air.assembly.rope_reading(i).tension,
                false => air.assembly.joint_reading(i).force.norm(),
            };
            // The engine moves the bodies by round-off, 1e-16 m; in the shortest step this is 1e-6 m/s², or 1e-7 G.
            assert!(
                (load / exact - 1.0).abs() < 1e-6,
                "{D}-D, {count} links, ratio {heavy}, step {step}, tie {i}: {load} N for {exact} N"
            );
        }
    }
}

#[test]
fn ropes_in_series_carry_the_weight_below_them_in_steps_of_any_length() {
    for (count, heavy) in [(2, 4.0), (2, 100.0), (6, 300.0), (3, 0.01)] {
        hangs::<2>(count, heavy, ropes);
        hangs::<3>(count, heavy, ropes);
    }
}

#[test]
fn joints_in_series_carry_the_weight_below_them_in_steps_of_any_length() {
    for kind in [JointKind::Hinge, JointKind::Fixed] {
        for (count, heavy) in [(2, 4.0), (2, 100.0), (4, 100.0)] {
            hangs::<2>(count, heavy, |count| joints(count, kind));
            hangs::<3>(count, heavy, |count| joints(count, kind));
        }
    }
}

#[test]
fn a_falling_chain_of_ropes_bears_nothing_until_the_upper_one_is_taut() {
    let solids = links::<2>(2, 100.0);
    let weight = weights(&solids)[1];
    let mut ties = ropes(2);
    ties.ropes[0] = ties.ropes[0].clone().max_length(0.15);
    let mut air = DrySystem::new(solids, ties, G);
    air.run(1e-3, 0.1);
    let tension = |air: &DrySystem<2>, i| air.assembly.rope_reading(i).tension;
    // The upper rope has 0.1 m of slack, which the chain falls through in √(2 0.1 m/g) = 0.143 s.
    assert!(tension(&air, 0) == 0.0 && tension(&air, 1).abs() < 1e-9 * weight, "free fall");
    air.run(1e-3, 0.16);
    let (low, exact) = (air.now()[1].centre[1], -0.15 - 0.3 - 0.1);
    assert!((low - exact).abs() < 1e-6, "{low} m for {exact} m");
    assert!((tension(&air, 1) / weight - 1.0).abs() < 1e-6, "{} N for {weight} N", tension(&air, 1));
}

/// Largest relative error of the load of a stone that swings about the origin on a tie, at 0.5 m, in steps of unlike lengths. It hangs on
/// a rope, or on a hinge at its end. Exact: T = m g cos φ + m r ω².
fn swings<const D: usize>(on_rope: bool) -> f64
where
    Dim<D>: HasEngine<D>,
{
    let mut stone = link::<D>("stone", -0.5, 1000.0);
    // A stone on a rope does not turn.
    if let Role::Free(body) = &mut stone.role {
        body.locked_rotations = [on_rope; 3];
    }
    let mass = body(&stone).mass;
    let ends = [LineEnd { solid: None, at: point(0.0, 0.0) }, LineEnd { solid: Some(0), at: point(0.0, -0.5) }];
    let hinge = JointSpec::new("hinge", JointKind::Hinge, [None, Some(0)], point(0.0, 0.0), across());
    let ties = match on_rope {
        true => Constraints { ropes: vec![RopeSpec::new("rope", ends)], ..Constraints::default() },
        false => Constraints { joints: vec![hinge], ..Constraints::default() },
    };
    let mut air = DrySystem::new(vec![stone], ties, G);
    let spin = Bivector::torque(&point(0.0, -1.0), &point(1.0, 0.0)) * 4.0;
    let turns = if on_rope { Bivector::zero() } else { spin };
    air.engine.set_velocity(0, &spin.velocity_at(&point(0.0, -0.5)), &turns);
    let mut worst = 0.0f64;
    for dt in [1e-3, 1e-3, 1e-3, 5e-4, 5e-4, 1e-3, 1e-3, 1e-4, 1e-3, 1e-5, 1e-3, 3e-4, 7e-4].repeat(8) {
        air.step(dt);
        let Kinematics { centre, velocity, .. } = air.now()[0];
        let r = centre.norm();
        let along = centre / r;
        let exact = mass * (along.dot(&point(0.0, -G)) + velocity.norm_squared() / r);
        let load = match on_rope {
            true => air.assembly.rope_reading(0).tension,
            false => -air.assembly.joint_reading(0).force.dot(&along),
        };
        worst = worst.max((load / exact - 1.0).abs());
    }
    worst
}

#[test]
fn ties_of_a_swinging_stone_carry_its_weight_and_centripetal_force_in_steps_of_any_length() {
    for on_rope in [false, true] {
        // The weight acts at the start of the step and the centripetal force at its end: φ' Δt = 0.4 % apart.
        for worst in [swings::<2>(on_rope), swings::<3>(on_rope)] {
            assert!(worst < 5e-3, "rope {on_rope}: {worst}");
        }
    }
}
