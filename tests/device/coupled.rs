//! What the host reads of the water on a device within a step: light bodies, paddles that absorb, mooring lines, parts thinner than dp;
//! and water that is removed.

use std::path::Path;

use pontoon::{
    math::Vector,
    model::{Model, PairLoopKind, TimeScheme, Walls},
    scene::Scene,
    simulation::{Dimension, Escape, Setup, Simulation},
    solid::{Dim, Role, SolidSpec},
};

use super::{Shape, assert_rates_agree, beside, beside_with, dam, dam_with, device, distances, run, under};

pub fn setup_of(text: &str) -> Setup<2> {
    Scene::parse(text, Path::new(""), &[]).unwrap().build::<2>().unwrap().setup
}

/// The bits of the water, by its ids, and of the solids.
fn bits<const D: usize>(sim: &Simulation<D>) -> Vec<u64> {
    let (fluid, solids) = (sim.system().fluid(), sim.system().solids());
    let mut water: Vec<_> = fluid.id.iter().zip(fluid.r).collect();
    water.sort_unstable_by_key(|(id, _)| **id);
    let places = water.into_iter().flat_map(|(_, r)| r.iter()).copied();
    places.chain(solids.iter().flat_map(|s| s.kinematics.centre.iter().copied())).map(f64::to_bits).collect()
}

/// Asserts that `steps` steps of `setup` on the device have the same bits again, and that the processor goes on from their middle as
/// the device does: water and solids within `bound` (dp).
pub fn assert_repeats_and_resumes<const D: usize>(name: &str, setup: &Setup<D>, steps: usize, bound: f64)
where
    Dim<D>: Dimension<D>,
{
    let on_device = || Simulation::new(setup.clone()).unwrap().on_device(&device()).unwrap();
    let go = |sim: &mut Simulation<D>| (0..steps / 2).for_each(|_| sim.step().unwrap());
    let [mut first, mut again] = [on_device(), on_device()];
    go(&mut first);
    let mut on_processor = Simulation::new(setup.clone()).unwrap();
    on_processor.restore(&first.save().unwrap()).unwrap();
    go(&mut first);
    go(&mut on_processor);
    go(&mut again);
    go(&mut again);
    assert_eq!(bits(&first), bits(&again), "{name}: other bits");
    let [r, _] = distances(&first, &on_processor);
    let solids = solids_apart(&first, &on_processor);
    println!("{name}, resumed on the processor: water {r:.1e} dp, solids {solids:.1e} dp");
    assert!(r < bound && solids < bound, "{name}: water {r} dp, solids {solids} dp off");
}

/// The largest distance of a solid from that of another simulation, dp.
pub fn solids_apart<const D: usize>(a: &Simulation<D>, b: &Simulation<D>) -> f64 {
    let pairs = a.system().solids().iter().zip(b.system().solids());
    let apart = pairs.map(|(a, b)| (a.kinematics.centre - b.kinematics.centre).norm());
    apart.fold(0.0, f64::max) / a.system().model().dp
}

/// A light box with its centre `at` (m); the surface is at 0.3 m.
fn light(model: Model, at: [f64; 2]) -> Setup<2> {
    let hull = Shape::Box { size: [0.12, 0.08].into() };
    dam_with(model, [0.8, 0.3], [SolidSpec::free("box", hull, 100.0).at(at)])
}

#[test]
fn light_bodies_agree_with_the_reference() {
    let base = || Model::water(2, 0.02, 0.3).for_free_bodies();
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    let cases = [
        ("relaxed walls", base()),
        ("dynamic walls", base().walls(Walls::Dynamic)),
        ("Verlet", base().scheme(verlet).cfl(0.2)),
    ];
    for (name, model) in cases {
        let setup = light(model, [0.15, 0.32]);
        let (mut most, mut apart) = (0.0f64, 0.0f64);
        let [on_device, reference] = beside_with(&setup, 0.02, 300, |on_device, reference| {
            let [here, there] = [on_device, reference].map(|sim| sim.pending_impulse(1));
            (most, apart) = (most.max(there.norm()), apart.max((here - there).norm()));
        });
        let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
        println!("{name}: water {r:.1e} dp, {v:.1e} c0, body {body:.1e} dp, impulses {apart:.1e} of {most:.1e} N s");
        assert!(most > 0.01 && apart < 1e-3 * most, "{name}: pending impulses {apart} of {most} N s apart");
        // The bound of free bodies.
        assert!(r < 1e-3 && body < 1e-3, "{name}: water {r} dp, body {body} dp off");
    }
    assert_repeats_and_resumes("light", &light(base(), [0.15, 0.32]), 300, 1e-3);
}

#[test]
fn a_light_body_in_space_agrees_with_the_reference() {
    let model = Model::water(3, 0.04, 0.3).for_free_bodies();
    let hull = Shape::Box { size: [0.16, 0.12, 0.08].into() };
    let setup = dam_with(model, [0.6, 0.24, 0.28], [SolidSpec::free("box", hull, 100.0).at([0.12, 0.12, 0.16])]);
    let [on_device, reference] = beside(&setup, 0.0, 40);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("3-D: water {r:.1e} dp, {v:.1e} c0, body {body:.1e} dp");
    assert!(reference.pending_impulse(1).norm() > 0.0, "no acoustic added mass");
    assert!(r < 1e-4 && body < 1e-4, "water {r} dp, body {body} dp off");
}

#[test]
fn a_light_body_that_leaves_the_water_gives_its_impulse_back() {
    // It hovers within the support of the water and leaves upwards: what then gets the rest of the pending impulse is further away.
    let mut setup = light(Model::water(2, 0.02, 0.3).for_free_bodies(), [0.16, 0.355]);
    let Role::Free(body) = &mut setup.solids[1].role else { panic!("a free body") };
    body.velocity = Vector::from([0.0, 3.0]);
    let state = run(&setup, 0.0);
    let mut reference = under(&setup, PairLoopKind::Reference, &state);
    let mut on_device = under(&setup, PairLoopKind::Fast, &state).on_device(&device()).expect("a device");
    let mut most: f64 = 0.0;
    while reference.time() < 0.04 {
        reference.step().unwrap();
        on_device.step().unwrap();
        most = most.max(on_device.pending_impulse(1).norm());
    }
    let left = [&on_device, &reference].map(|sim| sim.pending_impulse(1).norm());
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("water {r:.1e} dp, {v:.1e} c0, body {body:.1e} dp; pending {most:.1e}, at the end {left:?}");
    assert!(most > 0.0 && left.iter().all(|left| *left < 1e-9 * most), "pending {most}, at the end {left:?}");
    assert!(r < 1e-4 && v < 1e-7 && body < 1e-4, "water {r} dp, {v} c0, body {body} dp off");
}

/// A standing wave whose left end is a paddle.
const BASIN: &str = r#"
dimension = 2
dp        = 0.01
until     = 3.0
[[water]]
fill     = { box = { min = [0.0, 0.0], max = [0.6, 0.12] } }
velocity = ["-0.115*sin(5.236*x)*cosh(5.236*y)/cosh(0.628)", "0.115*cos(5.236*x)*sinh(5.236*y)/cosh(0.628)"]
[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.3] } }
at    = { x = -0.2 }
[[solid]]
name  = "end"
shape = { box = { size = [0.05, 0.3] } }
at    = { x = -0.025, bottom = 0.0 }
driven = { along = [1.0, 0.0], wave = { absorb = { period = 1.175 } } }
"#;

#[test]
fn a_paddle_that_absorbs_agrees_with_the_reference() {
    let setup = setup_of(BASIN);
    let [on_device, reference] = beside(&setup, 0.02, 300);
    let [r, v] = distances(&on_device, &reference);
    let [here, there] = [&on_device, &reference].map(|sim| sim.system().solids()[1].kinematics.centre[0]);
    println!("water {r:.1e} dp, {v:.1e} c0; paddle at {here} and {there} m");
    assert!((there + 0.025).abs() > 1e-3, "the paddle moves: {there}");
    // The level is known to a thousandth of dp, in steps.
    assert!((here - there).abs() < 2e-3 * 0.01 && r < 2e-3, "water {r} dp, paddle {here} and {there}");
    assert_repeats_and_resumes("absorption", &setup, 200, 2e-3);
}

/// A box on chains that act on the water.
const MOORED: &str = r#"
dimension = 2
dp = 0.02
until = 0.4
water = [{ fill = { box = { min = [0.0, 0.0], max = [1.6, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.6, 0.6] } }
[[solid]]
name = "box"
shape = { box = { size = [0.3, 0.2] } }
at = { x = 0.8, draft = "equilibrium" }
free = { density = 500.0, velocity = [0.2, 0.0] }
[[line_type]]
name = "chain"
diameter = 0.008
mass_per_length = 0.3
stiffness = 2e3
[[mooring]]
name = "west"
between = ["box"]
from = [0.65, 0.3]
to = [0.1, 0.0]
length = 0.75
line = "chain"
acts_on_water = true
[[mooring]]
name = "east"
between = ["box"]
from = [0.95, 0.3]
to = [1.5, 0.0]
length = 0.75
line = "chain"
since = 0.05
"#;

#[test]
fn mooring_lines_agree_with_the_reference() {
    // The second line begins during the steps.
    let setup = setup_of(MOORED);
    let [on_device, reference] = beside(&setup, 0.02, 250);
    assert!(reference.time() > 0.06, "the second line acts: {} s", reference.time());
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("water {r:.1e} dp, {v:.1e} c0, box {body:.1e} dp");
    assert!(r < 1e-3 && body < 1e-3, "water {r} dp, box {body} dp off");
    for line in 0..2 {
        let [here, there] = [&on_device, &reference].map(|sim| sim.mooring_reading(line).end_forces[0]);
        assert!(there.norm() > 0.5 && (here - there).norm() < 1e-3 * there.norm(), "line {line}: {here} and {there}");
    }
    assert_repeats_and_resumes("moorings", &setup, 200, 1e-3);
}

#[test]
fn thin_parts_have_the_buoyancy_of_the_reference() {
    // A fixed plate and a free one, half of dp thick.
    let model = Model::water(3, 0.04, 0.3).for_free_bodies();
    let plate = || Shape::Box { size: [0.16, 0.12, 0.02].into() };
    let fixed = || SolidSpec::fixed("shelf", plate()).at([0.14, 0.1, 0.1]);
    let free = SolidSpec::free("plate", plate(), 6000.0).at([0.14, 0.1, 0.24]);
    let setup = dam_with(model, [0.4, 0.2, 0.3], [fixed(), free]);
    assert_rates_agree("plates", &setup, &run(&setup, 0.05));
    let [on_device, reference] = beside(&setup, 0.02, 60);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("water {r:.1e} dp, {v:.1e} c0, plate {body:.1e} dp");
    assert!(r < 1e-3 && body < 1e-3, "water {r} dp, plate {body} dp off");
    for solid in 1..3 {
        let [here, there] = [&on_device, &reference].map(|sim| sim.system().solids()[solid].load.force);
        // The correction is ρ₀ g (dp − t) b l, 3.8 N.
        assert!((here - there).norm() < 0.02, "solid {solid}: {here} and {there} N");
    }
    // Fixed solids alone: the host reads loads where they are due.
    let setup = dam_with(Model::water(3, 0.04, 0.3), [0.4, 0.2, 0.3], [fixed()]);
    let [on_device, reference] = beside(&setup, 0.02, 30);
    let [here, there] = [&on_device, &reference].map(|sim| sim.system().solids()[1].load.force);
    assert!((here - there).norm() < 0.02, "{here} and {there} N");
}

/// Water that runs out of its domain at 0.5 m; with a body that floats in it, or without.
fn leaving(scheme: TimeScheme, floats: bool) -> Setup<2> {
    let cfl = if scheme == TimeScheme::Symplectic { 0.4 } else { 0.2 };
    let model = Model::water(2, 0.02, 0.3).scheme(scheme).cfl(cfl);
    let mut setup = match floats {
        true => dam_with(
            model.for_free_bodies(),
            [0.8, 0.3],
            [SolidSpec::free("box", Shape::Box { size: [0.2, 0.2].into() }, 500.0).at([0.12, 0.3])],
        ),
        false => dam(model, [0.8, 0.3]),
    };
    setup = setup.domain([-1.0, -1.0], [0.5, 2.0]);
    setup.limits = setup.limits.escape(Escape::Remove);
    setup
}

#[test]
fn water_that_leaves_the_domain_is_removed() {
    for (name, scheme, floats) in [
        ("symplectic", TimeScheme::Symplectic, false),
        ("Verlet", TimeScheme::Verlet { euler_every: 40 }, false),
        ("with a body", TimeScheme::Symplectic, true),
    ] {
        let setup = leaving(scheme, floats);
        let count = Simulation::new(setup.clone()).unwrap().system().fluid().len();
        let mut reference = under(&setup, PairLoopKind::Reference, &run(&setup, 0.0));
        let on_device = || Simulation::new(setup.clone()).unwrap().on_device(&device()).unwrap();
        let [mut first, mut again] = [on_device(), on_device()];
        let start = first.save().unwrap();
        for sim in [&mut reference, &mut first, &mut again] {
            while sim.time() < 0.25 {
                sim.step_to(0.25).unwrap();
            }
        }
        let removed = first.removed_particles();
        let mut ids: Vec<u32> = removed.iter().map(|(_, lost)| lost.id).collect();
        ids.extend(first.system().fluid().id);
        ids.sort_unstable();
        assert!(ids.iter().copied().eq(0..count as u32), "{name}: each particle is there or removed");
        assert!(removed.iter().all(|(t, lost)| *t > 0.0 && lost.r[0] > 0.5), "{name}: removed beyond the side");
        // The lists of both are made at other steps, and what waits for removal holds back what follows.
        let there = reference.removed_particles().len();
        println!("{name}: {} removed, {there} by the reference", removed.len());
        assert!(there > 10 && removed.len().abs_diff(there) <= 2, "{name}: {} and {there}", removed.len());
        assert_eq!(bits(&first), bits(&again), "{name}: other bits");
        let energy = first.system().kinetic_energy() - reference.system().kinetic_energy();
        let fastest = removed.iter().map(|(_, lost)| lost.v.norm()).fold(0.0, f64::max);
        let of_one = 0.5 * first.system().particle_mass() * fastest.powi(2);
        println!("{name}: kinetic energy {energy:.2} J/m apart, of one particle {of_one:.2} J/m");
        assert!(energy.abs() < 3.0 * of_one, "{name}: kinetic energy {energy} J/m off");
        // The processor goes on from there.
        let mut on_processor = Simulation::new(setup.clone()).unwrap();
        on_processor.restore(&first.save().unwrap()).unwrap();
        for sim in [&mut first, &mut on_processor] {
            (0..20).for_each(|_| sim.step().unwrap());
        }
        assert!(first.system().fluid().len().abs_diff(on_processor.system().fluid().len()) <= 2, "{name}");
        // And the device goes back to more water.
        first.restore(&start).unwrap();
        first.step().unwrap();
        assert_eq!(first.system().fluid().len(), count, "{name}: all water is back");
    }
}
