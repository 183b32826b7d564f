use super::*;
use crate::solid::mooring::{
    forces::BedPlane,
    sample::{self, GRAVITY, down, material},
};

fn air<const D: usize>(line: &MooringLine<D>) -> Vec<NodeSurroundings<D>> {
    line.state.x.iter().map(sample::air).collect()
}

fn momentum<const D: usize>(line: &MooringLine<D>) -> Vector<D> {
    let of = |(i, v): (usize, &Vector<D>)| *v * (line.material.mass * line.share(i) + line.bodies[i].mass);
    line.state.v.iter().enumerate().map(of).sum()
}

/// A line that nothing holds falls as a point does, whatever it does within: its momentum is M g t to round-off.
#[test]
fn a_free_line_falls_with_the_momentum_of_its_weight() {
    let damped = LineMaterial { damping: 0.5, bending: 0.01, ..material() };
    let ends = [[0.0, 0.0, 1.0].into(), [0.9, 0.3, 1.2].into()];
    let mut line = MooringLine::<3>::straight(damped, 0.8, 12, ends);
    line.held = [false; 2];
    line.state.v[3] = [0.5, -0.2, 0.1].into();
    line.bodies[5].mass = 0.03;
    let (start, near) = (momentum(&line), air(&line));
    for _ in 0..200 {
        line.advance([Vector::zeros(); 2], 1e-3, &near, &down());
    }
    let expected = start + down::<3>() * ((0.1 * 0.8 + 0.03) * 0.2);
    assert!((momentum(&line) - expected).norm() < 1e-12, "{}", momentum(&line));
}

/// A hanging line with held ends: what its ends bear is its weight and what changes its momentum.
#[test]
fn the_forces_on_the_ends_balance_weight_and_momentum() {
    let damped = LineMaterial { damping: 0.5, ..material() };
    let mut line = MooringLine::<2>::straight(damped, 1.2, 15, [[0.0, 0.0].into(), [1.0, 0.3].into()]);
    let near = air(&line);
    let weight = down::<2>() * (0.1 * 1.2);
    let mut impulse = Vector::zeros();
    let start = momentum(&line);
    for k in 1..=300 {
        let t = f64::from(k) * 1e-3;
        let end = [1.0 + 0.05 * (9.0 * t).sin(), 0.3 + 0.04 * (7.0 * t).sin()];
        let forces = line.advance([[0.0, 0.0].into(), end.into()], 1e-3, &near, &down());
        impulse += (weight - forces[0] - forces[1]) * 1e-3;
    }
    let gap = momentum(&line) - start - impulse;
    assert!(gap.norm() < 1e-13, "impulse and momentum differ by {gap}");
}

/// A stiff pendulum of one segment with its mass at the free end swings with the period of a mathematical one, enlarged by
/// 1 + θ²/16, within 1e-3.
#[test]
fn a_pendulum_has_its_period() {
    let (length, angle) = (0.8, 0.1f64);
    let bob = Vector::from([length * angle.sin(), -length * angle.cos()]);
    let light = LineMaterial { mass: 1e-4, stiffness: 2e4, ..material() };
    let mut line = MooringLine::<2>::straight(light, length, 1, [Vector::zeros(), bob]);
    line.held = [true, false];
    line.bodies[1].mass = 1.0;
    let near = air(&line);
    let (dt, mut crossings) = (2e-3, Vec::new());
    for k in 1..3000 {
        let before = line.state.x[1][0];
        line.advance([Vector::zeros(); 2], dt, &near, &down());
        let now = line.state.x[1][0];
        if before > 0.0 && now <= 0.0 {
            crossings.push(dt * (f64::from(k) - now / (now - before)));
        }
    }
    let period = (crossings[2] - crossings[0]) / 2.0;
    let exact = std::f64::consts::TAU * (length / GRAVITY).sqrt() * (1.0 + angle * angle / 16.0);
    assert!((period / exact - 1.0).abs() < 1e-3, "{period} s, not {exact} s");
}

/// J₀(x) of Bessel by its series.
fn bessel(x: f64) -> f64 {
    let terms = (1..20).scan(1.0, |term, k| {
        *term *= -0.25 * x * x / f64::from(k * k);
        Some(*term)
    });
    1.0 + terms.sum::<f64>()
}

/// Relative error of the period of the slowest swing of a chain of 1 m that hangs in air, in `segments` segments.
///
/// Its shape is J₀(j √(s/L)) at the height s above its lower end, with J₀(j) = 0 (Daniel Bernoulli 1738); its period is
/// 4π/j √(L/g).
fn swing_error(segments: usize) -> f64 {
    const ROOT: f64 = 2.404_825_557_695_773;
    let material = LineMaterial { stiffness: 2e4, ..material() };
    let mut line = MooringLine::<2>::straight(material, 1.0, segments, [Vector::zeros(), [0.0, -1.0].into()]);
    line.held = [true, false];
    let (length, weight, stiffness) = (line.state.segment, line.material.mass * GRAVITY, line.material.stiffness);
    let below = |i: usize| (segments - i) as f64 * length;
    let shape = |i: usize| bessel(ROOT * below(i).sqrt());
    for i in 1..=segments {
        // The tension of the segment above bears what is below its middle.
        line.state.x[i][0] = 1e-5 * shape(i);
        line.state.x[i][1] = line.state.x[i - 1][1] - length * (1.0 + weight * (below(i) + 0.5 * length) / stiffness);
    }
    // The part of the motion in this shape, without the faster swings.
    let swing =
        |line: &MooringLine<2>| (1..=segments).map(|i| line.share(i) * shape(i) * line.state.x[i][0]).sum::<f64>();
    let (near, dt, mut crossings) = (air(&line), 2e-3, Vec::new());
    for k in 1..2000 {
        let before = swing(&line);
        line.advance([Vector::zeros(); 2], dt, &near, &down());
        let now = swing(&line);
        if before > 0.0 && now <= 0.0 {
            crossings.push(dt * (f64::from(k) - now / (now - before)));
        }
    }
    let exact = 2.0 * std::f64::consts::TAU / ROOT / GRAVITY.sqrt();
    (crossings[1] - crossings[0]) / exact - 1.0
}

/// A hanging chain swings with its period, in second order in the length of a segment.
#[test]
fn a_hanging_chain_swings_with_its_period() {
    let [coarse, fine] = [20, 40].map(swing_error);
    let order = (coarse / fine).log2();
    println!("errors {coarse:.2e} and {fine:.2e}, order {order:.2}");
    assert!(fine.abs() < 1.5e-3 && (1.7..2.2).contains(&order), "errors {coarse}, {fine}, order {order}");
}

/// Change of the energy of a swinging chain over its motion, with steps of `part` of the limit.
fn energy_error(part: f64) -> f64 {
    let mut line = MooringLine::<2>::straight(material(), 1.0, 10, [Vector::zeros(), [0.7, -0.7].into()]);
    line.held = [true, false];
    let near = air(&line);
    let dt = part * line.step_limit();
    let total = |line: &MooringLine<2>| line.energies(&near, &down()).iter().sum::<f64>();
    let (start, mut worst, mut motion) = (total(&line), 0.0f64, 0.0f64);
    for _ in 0..(0.5 / dt) as usize {
        line.advance([Vector::zeros(); 2], dt, &near, &down());
        worst = worst.max((total(&line) - start).abs());
        motion = motion.max(line.energies(&near, &down())[0]);
    }
    worst / motion
}

/// Without losses a swinging chain keeps its energy within 1 %, and the error falls with the square of the step.
#[test]
fn a_chain_without_losses_keeps_its_energy() {
    let errors = [1.0, 0.5, 0.25].map(energy_error);
    println!("energy: {errors:?}");
    assert!(errors[0] < 0.01, "{errors:?}");
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!((1.5..2.6).contains(&order), "order {order}: {errors:?}");
}

/// A point that falls through water reaches the speed at which drag bears its weight less buoyancy: across the line, a straight
/// level line falls at √(2 (m − ρ A) g/(ρ d C_d)).
#[test]
fn a_level_line_sinks_at_the_speed_of_its_drag() {
    let ends = [[0.0, 0.0].into(), [1.0, 0.0].into()];
    let mut line = MooringLine::<2>::straight(material(), 1.0, 10, ends);
    line.held = [false; 2];
    let current = Vector::from([0.0, 0.05]);
    let near = vec![NodeSurroundings { water_velocity: current, wet: 1.0, bed: None }; 11];
    for _ in 0..2000 {
        line.advance([Vector::zeros(); 2], 1e-3, &near, &down());
    }
    let m = material();
    let speed = (2.0 * (m.mass - m.displaced()) * GRAVITY / (m.water_density * m.diameter * m.drag[0])).sqrt();
    let fall = line.state.v[5] - current;
    assert!((fall[1] / -speed - 1.0).abs() < 1e-6 && fall[0].abs() < 1e-9, "{fall}, not {speed} m/s");
}

/// The first step from rest in water has the acceleration of the weight less buoyancy over the mass with added mass.
#[test]
fn added_mass_slows_the_start() {
    let mut line = MooringLine::<2>::straight(material(), 1.0, 10, [[0.0, 0.0].into(), [1.0, 0.0].into()]);
    line.held = [false; 2];
    let near = vec![NodeSurroundings { water_velocity: Vector::zeros(), wet: 1.0, bed: None }; 11];
    line.advance([Vector::zeros(); 2], 1e-6, &near, &down());
    let m = material();
    let expected = -(m.mass - m.displaced()) * GRAVITY / (m.mass + m.displaced()) * 1e-6;
    assert!((line.state.v[5][1] / expected - 1.0).abs() < 1e-9, "{}", line.state.v[5]);
}

/// A line that slides over a bed with the friction coefficient μ slows down by μ g from the way on at which friction is whole, and
/// then swings about its grip.
#[test]
fn friction_slows_what_slides() {
    let rough = LineMaterial { bed_stiffness: 1e6, bed_damping: 1e4, bed_friction: 0.4, ..material() };
    let mut line = MooringLine::<2>::straight(rough.clone(), 1.0, 10, [[0.0, 0.0].into(), [1.0, 0.0].into()]);
    line.held = [false; 2];
    let sunk = rough.mass * GRAVITY / (rough.bed_stiffness * rough.diameter);
    line.state.x.iter_mut().for_each(|x| x[1] = -sunk);
    line.state.v.iter_mut().for_each(|v| v[0] = 1.0);
    let bed = BedPlane { point: Vector::zeros(), normal: [0.0, 1.0].into() };
    let near = vec![NodeSurroundings { bed: Some(bed), ..NodeSurroundings::air() }; 11];
    for _ in 0..100 {
        line.advance([Vector::zeros(); 2], 1e-3, &near, &down());
    }
    let expected = 1.0 - 0.4 * GRAVITY * 0.1;
    assert!((line.state.v[5][0] / expected - 1.0).abs() < 5e-3, "{} m/s", line.state.v[5][0]);
    for _ in 0..400 {
        line.advance([Vector::zeros(); 2], 1e-3, &near, &down());
    }
    // The swing has at most the energy of the bed at the limit: v = μ g √(m/(k d)).
    let swing = 0.4 * GRAVITY * (rough.mass / (rough.bed_stiffness * rough.diameter)).sqrt();
    assert!(line.state.v[5][0].abs() < 1.01 * swing, "it stops; {} m/s", line.state.v[5][0]);
}

/// A bending line with hinged ends under its weight sags by 5 w L⁴/(384 EI).
#[test]
fn a_stiff_line_bends_as_a_beam() {
    let beam = LineMaterial { bending: 20.0, stiffness: 1e5, ..material() };
    let mut line = MooringLine::<2>::straight(beam, 1.0, 40, [[0.0, 0.0].into(), [1.0, 0.0].into()]);
    let left = line.find_rest(&sample::air, &down());
    let sag = -line.state.x[20][1];
    let exact = 5.0 * 0.1 * GRAVITY / (384.0 * 20.0);
    // Between fixed hinges the sag stretches the line; its tension bears less than 1 %.
    assert!(left < 1e-6 && (sag / exact - 1.0).abs() < 0.01, "sag {sag} m, not {exact} m; {left}");
}

/// A broken segment carries nothing, and both parts stay with their ends.
#[test]
fn a_broken_line_hangs_from_both_ends() {
    let damped = LineMaterial { damping: 0.2, ..material() };
    let mut line = MooringLine::<2>::straight(damped, 1.0, 10, [[0.0, 0.0].into(), [1.1, 0.0].into()]);
    line.state.broken = Some(4);
    let near = air(&line);
    for _ in 0..100 {
        line.advance([[0.0, 0.0].into(), [1.1, 0.0].into()], 1e-3, &near, &down());
    }
    assert_eq!(line.tension(4), 0.0);
    assert!(line.state.x[5][0] > line.state.x[4][0] + 0.2, "the ends part");
}

/// What a line without weight gains in momentum, the water loses: with drag, added mass, point masses, and ends that are held and jerked,
/// to round-off.
#[test]
fn the_impulses_of_the_water_are_those_of_the_line() {
    let ends = [[0.0, 0.0, 1.0].into(), [0.9, 0.3, 1.2].into()];
    let mut line =
        MooringLine::<3>::straight(LineMaterial { damping: 0.5, bending: 0.01, ..material() }, 0.8, 12, ends);
    line.held = [true, false];
    line.bodies[5] = NodeBody { mass: 0.03, volume: 2e-5, drag_area: 1e-3, added_mass: 0.5 };
    line.water_impulses = Some(vec![Vector::zeros(); 13]);
    let around = |i: usize| {
        let share = i as f64 / 12.0;
        NodeSurroundings { water_velocity: [0.4 * share, -0.3, 0.2].into(), wet: 1.0 - 0.5 * share, bed: None }
    };
    let near: Vec<_> = (0..13).map(around).collect();
    let start = momentum(&line);
    let (mut on_end, mut from_water, mut size) = (Vector::zeros(), Vector::zeros(), 0.0);
    for k in 1..=300 {
        let end = Vector::from([0.0, 0.02 * (f64::from(k) * 0.05).sin(), 1.0]);
        let forces = line.advance([end, Vector::zeros()], 1e-3, &near, &Vector::zeros());
        on_end += forces[0] * 1e-3;
        let impulses = line.water_impulses.as_ref().unwrap();
        from_water += impulses.iter().sum::<Vector<3>>();
        size += impulses.iter().map(Vector::norm).sum::<f64>();
    }
    let gap = (momentum(&line) - start + on_end - from_water).norm();
    assert!(size > 0.01 && gap < 1e-12 * size, "{gap} of {size} N s");
}
