use super::*;
use crate::{
    geometry::Shape,
    model::{HasPairLoop as _, Model},
    ranks::Ranks,
    solid::{Dim, LineEnd, LineType, MooringSpec, SolidSpec},
    system::{Setup, spread_impulses},
};

/// The whole kernel lies behind a plane at its far edge, half of it behind one through its centre, nothing beyond its radius.
#[test]
fn the_share_behind_a_plane_falls_from_one_to_zero() {
    for (t, share) in [(-1.0, 1.0), (0.0, 0.5), (1.0, 0.0), (2.0, 0.0), (-3.0, 1.0)] {
        assert!((share_behind(t) - share).abs() < 1e-15, "t = {t}: {}", share_behind(t));
    }
    assert!((share_behind(0.3) + share_behind(-0.3) - 1.0).abs() < 1e-15);
}

/// A line with drag and added mass gives the water what it loses: the horizontal momentum of both changes by the impulses on the ends of
/// the line alone, within 1e-10 of what is exchanged. Water across a periodic side takes part, and its images follow.
#[test]
fn a_line_and_the_water_around_it_exchange_momentum() {
    let (dp, size) = (0.05, 1.0);
    let model = Model::water(2, dp, size);
    let place = |i: usize| [(i % 20) as f64, (i / 20) as f64].map(|k| (k + 0.5) * dp);
    let water = (0..400).map(|i| place(i).into()).collect::<Vec<_>>();
    let shape = Shape::Box { size: Vector::from([0.1, 0.1]) };
    let bodies = [0.6, 0.9].map(|x| SolidSpec::free(format!("body-{x}"), shape.clone(), 500.0).at([x, 1.4]));
    let ends = [LineEnd::on(0, [0.6, 1.4]), LineEnd::on(1, [0.9, 1.4])];
    let kind = LineType { drag: [1.6, 0.2], added_mass: [1.0, 0.3], ..LineType::new(0.05, 3.0, 2e3) };
    let line = MooringSpec::new("loop", ends, 2.0, kind).acting_on_water();
    let setup = Setup::new(model.clone()).water(water, size).solids(bodies).mooring(line).periodic(0, 0.0, size);
    let start: Vec<_> = setup.solids.iter().map(SolidSpec::initial_kinematics).collect();
    let mut system = System::new(setup, Dim::<2>::pair_loop(&model), Ranks::default().with_all_water()).unwrap();
    system.rebuild_neighbours();
    let mut moorings = Moorings::new(&mut system, &start).unwrap();
    // The loop moves through the water and across its side.
    let state = &mut moorings.lines[0].line.state;
    state.v.iter_mut().zip(&state.x).for_each(|(v, x)| *v = [0.8 * (1.4 - x[1]), 0.3].into());
    let momentum = |system: &System<2>, moorings: &Moorings<2>| {
        let line = &moorings.lines[0].line;
        let node = |(i, v): (usize, &Vector<2>)| *v * (3.0 * 0.1 * if i == 0 || i == 20 { 0.5 } else { 1.0 });
        let of_line: Vector<2> = line.state.v.iter().enumerate().map(node).sum();
        (of_line + system.fluid().v.iter().sum::<Vector<2>>() * system.particle_mass())[0]
    };
    let (before, dt) = (momentum(&system, &moorings), 1e-3);
    let (mut on_ends, mut exchanged) = (0.0, 0.0);
    for step in 0..20 {
        moorings.advance(&system, &start, &[None, None], Interval { t: f64::from(step) * dt, dt });
        spread_impulses(&mut system, moorings.impulses_on_water()).unwrap();
        exchanged += moorings.impulses_on_water().iter().map(|(_, impulse)| impulse[0].abs()).sum::<f64>();
        on_ends += moorings.lines[0].line.state.end_forces.iter().map(|force| force[0]).sum::<f64>() * dt;
    }
    let gap = (momentum(&system, &moorings) + on_ends - before).abs();
    assert!(exchanged > 0.1 && gap < 1e-10 * exchanged, "{gap} of {exchanged} N s");
    let (real, water) = (system.fluid().len(), &system.fluid.particles);
    let period = |k: usize, i: usize| ((water.r[k] - water.r[i])[0].abs() - size).abs() < 1e-9;
    let is_image = |k: usize, i: usize| period(k, i) && (water.r[k] - water.r[i])[1] == 0.0;
    let follows = |k: usize| (0..real).any(|i| is_image(k, i) && water.v[k] == water.v[i]);
    assert!(water.v.len() > real && (real..water.v.len()).all(follows), "each image has the velocity of its original");
}
