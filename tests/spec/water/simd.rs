//! The SIMD pair loop against the reference on states of real runs: its rounding is far below the change in a step.

use pontoon::{
    geometry::Shape,
    interaction::{self, PairLoopInput, PairSums, RequestedSums},
    math::{Pose, Vector, expression::Formula, simd},
    model::{
        Diffusion, KernelKind, Model, PairLoopKind, PressureGradient, Shifting, Slip, TimeScheme, Viscosity, Walls,
    },
    neighbours::NeighbourLists,
    particles::Particles,
    simulation::{Dimension, Setup, Simulation},
    solid::{Dim, PrescribedMotion, Role, TimeFunction},
    sph::{
        Units,
        continuity::Continuity,
        density_diffusion::{Fourtakas, Molteni},
        equation_of_state::EquationOfState,
        kernel::Wendland,
        particle_shifting::Shift,
        pressure::Pressure,
        viscosity::{Artificial, Laminar, Riemann, Sps},
    },
};

use super::beside_reference::{run, sizes, under};
use crate::common::{self, Random};

/// Asserts that the SIMD pair loop agrees with the reference on one state.
fn assert_agrees<const D: usize>(name: &str, setup: &Setup<D>, state: &[u8])
where
    Dim<D>: Dimension<D>,
{
    let reference = under(setup, PairLoopKind::Reference, state);
    let expected = reference.system();
    let n = expected.fluid().len();
    let sizes: Vec<(f64, f64)> = (0..n).map(|i| sizes(&reference, i)).collect();
    let most = sizes.iter().fold((0.0f64, 0.0f64), |m, s| (m.0.max(s.0), m.1.max(s.1)));
    let all_forces: f64 = sizes.iter().map(|s| s.0).sum::<f64>() * expected.particle_mass();
    let fast = under(setup, PairLoopKind::Fast, state);
    let found = fast.system();
    for (i, size) in sizes.iter().enumerate() {
        let dv = (found.fluid_acceleration(i) - expected.fluid_acceleration(i)).norm();
        let drho = (found.fluid_density_rate(i) - expected.fluid_density_rate(i)).abs();
        // The bounds of docs/explanation/performance.md: relative to the terms of the particle, plus a fraction of the largest
        // for particles with a neighbour at the edge of the support.
        assert!(dv <= 2e-5 * size.0 + 2e-6 * most.0, "{name}: dv {i} off by {dv}");
        assert!(drho <= 2e-5 * size.1 + 2e-6 * most.1, "{name}: drho {i} off by {drho}");
    }
    // The forces on water, walls and bodies cancel; the remainder is rounding of the sums.
    let water: Vector<D> = (0..n).map(|i| found.fluid_acceleration(i) - found.gravity()).sum::<Vector<D>>();
    let solids: Vector<D> = found.solids().iter().map(|s| s.load.force).sum();
    let rest = (water * found.particle_mass() + solids).norm();
    assert!(rest < 1e-7 * all_forces, "{name}: momentum error of {rest} N in forces of {all_forces} N");
    for (a, b) in found.solids().iter().zip(expected.solids()) {
        let off = (a.load.force - b.load.force).norm();
        assert!(off < 1e-6 * all_forces, "{name}: load on {} off by {off} N", a.spec.name);
    }
    // The peak may come from a pair that rounding puts inside the support in one loop and outside in the other.
    let (a, b) = (found.step_limits(), expected.step_limits());
    assert!((a.acceleration / b.acceleration - 1.0).abs() < 1e-4, "{name}: {a:?} {b:?}");
    assert!((a.approach_rate - b.approach_rate).abs() <= 1e-4 * b.approach_rate + 1e-6, "{name}: {a:?} {b:?}");
}

fn dam<const D: usize>(model: Model, size: [f64; D], origin: f64) -> Setup<D> {
    let dp = model.dp;
    let at = Vector::repeat(origin);
    let column: [f64; D] = std::array::from_fn(|i| if i == 0 { 0.4 * size[0] } else { size[i] });
    let water: Vec<Vector<D>> = common::lattice([0.0; D], column, dp).into_iter().map(|r| r + at).collect();
    let mut tank = common::tank(std::array::from_fn(|i| if i == D - 1 { 1.6 * size[i] } else { size[i] }), dp);
    tank.pose.position += at;
    Setup::new(model).water(water, origin + column[D - 1]).solid(tank)
}

#[test]
fn simd_agrees_with_the_reference_in_a_dam_break_after_impact() {
    let mut model = Model::water(2, 0.0125, 0.3);
    model.scheme = TimeScheme::Verlet { euler_every: 50 };
    let setup = dam(model, [0.8, 0.3], 0.0);
    assert_agrees("2-D", &setup, &run(&setup, 0.35));
    let setup = dam(Model::water(3, 0.025, 0.3), [0.6, 0.15, 0.3], 0.0);
    assert_agrees("3-D", &setup, &run(&setup, 0.3));
}

#[test]
fn simd_agrees_with_the_reference_a_kilometre_from_the_origin() {
    let setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3], 1000.0);
    assert_agrees("far", &setup, &run(&setup, 0.1));
}

#[test]
fn simd_agrees_with_the_reference_for_a_floating_box_of_normal_and_of_low_density() {
    for density in [500.0, 20.0] {
        let mut setup = dam(Model::water(2, 0.02, 0.3), [1.0, 0.3], 0.0);
        setup.water = common::lattice([0.0, 0.0], [1.0, 0.3], 0.02);
        setup.water.retain(|r| !((r[0] - 0.5).abs() < 0.1 && r[1] > 0.26));
        setup.surface_levels = vec![0.3; setup.water.len()];
        setup.solids.push(common::float(Shape::Box { size: Vector::from([0.2, 0.1]) }, [0.5, 0.31], density));
        assert_agrees("float", &setup, &run(&setup, 0.15));
    }
}

#[test]
fn simd_agrees_with_the_reference_for_relaxed_adami_walls() {
    let mut model = Model::water(2, 0.0125, 0.3);
    model.walls = Walls::RelaxedAdami;
    let setup = dam(model, [0.8, 0.3], 0.0);
    assert_agrees("2-D", &setup, &run(&setup, 0.35));
    let mut model = Model::water(3, 0.025, 0.3);
    model.walls = Walls::RelaxedAdami;
    let setup = dam(model, [0.6, 0.15, 0.3], 0.0);
    assert_agrees("3-D", &setup, &run(&setup, 0.3));
}

#[test]
fn simd_agrees_with_the_reference_for_free_slip_and_no_slip_walls() {
    for slip in [Slip::None, Slip::Free] {
        let setup = dam(Model::water(2, 0.0125, 0.3).slip(slip), [0.8, 0.3], 0.0);
        assert_agrees(&format!("2-D {slip:?}"), &setup, &run(&setup, 0.35));
    }
    let setup = dam(Model::water(3, 0.025, 0.3).slip(Slip::None), [0.6, 0.15, 0.3], 0.0);
    assert_agrees("3-D", &setup, &run(&setup, 0.3));
}

#[test]
fn simd_agrees_with_the_reference_in_a_deep_column_at_rest() {
    let (dp, depth) = (0.01, 10.0);
    let mut setup = dam(Model::water(2, dp, depth), [0.12, depth], 0.0);
    setup.water = common::lattice([0.0, 0.0], [0.12, depth], dp);
    setup.surface_levels = vec![depth; setup.water.len()];
    assert_agrees("deep", &setup, &run(&setup, 1e-4));
}

#[test]
fn simd_agrees_with_the_reference_for_a_body_that_crosses_slabs_of_cells() {
    // A driven box crosses three slabs of four dp each and moves the water.
    let mut setup = dam(Model::water(2, 0.02, 0.3), [1.2, 0.3], 0.0);
    setup.water = common::lattice([0.0, 0.0], [1.2, 0.3], 0.02);
    setup.water.retain(|r| (r[0] - 0.3).abs() > 0.06 || (r[1] - 0.15).abs() > 0.06);
    setup.surface_levels = vec![0.3; setup.water.len()];
    let motion = PrescribedMotion::slide(
        Vector::from([1.0, 0.0]),
        TimeFunction::Formula(Formula::parse("4*t*t").expect("a formula")),
    );
    let shape = Shape::Box { size: Vector::from([0.12, 0.12]) };
    setup.solids.push(common::solid("box", shape, Pose::at(Vector::from([0.3, 0.15])), Role::Driven(motion)));
    assert_agrees("crossing", &setup, &run(&setup, 0.26));
}

#[test]
fn simd_exerts_no_force_on_a_lone_particle_or_in_a_drop_in_uniform_flight() {
    let mut model = Model::water(3, 0.02, 0.3);
    let alone = Setup::new(model.clone()).water([Vector::<3>::zeros()], 0.0);
    let sim = Simulation::new(alone).expect("a sound setup");
    assert_eq!(
        sim.system().fluid_acceleration(0),
        sim.system().gravity(),
        "a particle is not its own neighbour, and padding is not a neighbour"
    );
    // Without gravity a drop keeps its shape over a flight of ten columns; the neighbour lists are rebuilt during it.
    model.gravity = vec![0.0; 3];
    let water = common::lattice([0.0; 3], [0.1, 0.1, 0.1], 0.02);
    let setup = Setup::new(model).water(water, -1.0).domain([-1.0; 3], [1.0; 3]);
    let mut sim = Simulation::new(setup).expect("a sound setup");
    sim.set_water_velocity(|_| Vector::from([3.0, 2.0, -1.0]));
    let start = sim.system().fluid().r.to_vec();
    let ids = sim.system().fluid().id.to_vec();
    while sim.time() < 0.13 {
        sim.step().expect("a sound run");
    }
    let end = sim.system().fluid();
    for (id, r) in end.id.iter().zip(end.r) {
        let from = ids.iter().position(|i| i == id).expect("no particle is lost");
        let way = r - start[from] - Vector::from([3.0, 2.0, -1.0]) * sim.time();
        // At ρ₀ no force acts, and differences of equal velocities are exactly zero in single precision.
        assert!(way.norm() < 1e-12, "{id}: {way:?}");
    }
}

/// Every combination of laws that a scene can select: one step from a disturbed state agrees with the reference.
fn every_law<const D: usize>(size: [f64; D])
where
    Dim<D>: Dimension<D>,
{
    let mut model = Model::water(D, 0.05, 0.3);
    model.scheme = TimeScheme::Verlet { euler_every: 50 };
    let kernels = [KernelKind::Wendland, KernelKind::Cubic { tensile: true }, KernelKind::Cubic { tensile: false }];
    let viscosities = [
        Viscosity::None,
        Viscosity::Artificial(Artificial { alpha: 0.1 }),
        // Some pairs are faster than the threshold, others are not.
        Viscosity::Riemann(Riemann { threshold: Some(0.05), ..Riemann::default() }),
        Viscosity::Laminar(Laminar { nu0: 1e-3 }),
        Viscosity::Sps(Sps::default()),
    ];
    let diffusions =
        [Diffusion::None, Diffusion::Molteni(Molteni::default()), Diffusion::Fourtakas(Fourtakas::default())];
    for (kernel, viscosity) in kernels.into_iter().flat_map(|k| viscosities.map(|v| (k, v))) {
        for (diffusion, shifting) in diffusions
            .into_iter()
            .flat_map(|d| [Shifting::None, Shifting::AwayFromSolids(Shift::default())].map(|s| (d, s)))
        {
            (model.kernel, model.viscosity) = (kernel, viscosity);
            (model.diffusion, model.shifting) = (diffusion, shifting);
            model.gradient = PressureGradient::Plain;
            assert_step_agrees(&model, size);
            model.gradient = PressureGradient::Corrected;
            if model.conflict().is_none() {
                assert_step_agrees(&model, size);
            }
        }
    }
}

/// Asserts that one step from a disturbed state, of a column in a tank of that size, agrees with the reference.
fn assert_step_agrees<const D: usize>(model: &Model, size: [f64; D])
where
    Dim<D>: Dimension<D>,
{
    let setup = dam(model.clone(), size, 0.0);
    let mut sim = Simulation::new(setup.clone()).expect("a sound setup");
    let mut random = Random(9);
    let swirl = Vector::<D>::from_fn(|_, _| 4.0 + random.number());
    sim.set_water_velocity(|r| Vector::from_fn(|i, _| (swirl[i] * (r[(i + 1) % D] + 0.3)).sin()));
    for _ in 0..3 {
        sim.step().expect("a sound run");
    }
    let state = sim.save().expect("a state");
    let mut reference = under(&setup, PairLoopKind::Reference, &state);
    reference.step().expect("a sound run");
    let mut fast = under(&setup, PairLoopKind::Fast, &state);
    fast.step().expect("a sound run");
    let Model { kernel, gradient, viscosity, diffusion, shifting, .. } = model;
    let what = format!("{kernel:?} {gradient:?} {viscosity:?} {diffusion:?} {shifting:?} in {D}-D");
    // Single precision: 1e-6 of the largest change of a step was observed.
    let dt = reference.dt();
    assert!((fast.dt() / dt - 1.0).abs() < 1e-5, "{what}: {} {dt}", fast.dt());
    let most = reference.system().step_limits().acceleration * dt;
    for i in 0..reference.system().fluid().len() {
        let (a, b) = (fast.system().fluid(), reference.system().fluid());
        assert!((a.v[i] - b.v[i]).norm() < 1e-5 * most, "{what}: v of {i}");
        assert!((a.r[i] - b.r[i]).norm() < 1e-4 * most * dt + 1e-6 * dt, "{what}: r of {i}");
        assert!((a.rho[i] - b.rho[i]).abs() < 1e-3, "{what}: density of {i}");
    }
}

#[test]
fn simd_agrees_with_the_reference_where_gradients_are_corrected_near_the_surface() {
    // Sixteen rows: the lower half has no corrections, and the pair loops reach it by another path.
    for viscosity in [Viscosity::Riemann(Riemann::default()), Viscosity::Sps(Sps::default())] {
        let mut model = Model::water(2, 0.05, 0.8).gradient(PressureGradient::NearSurface).viscosity(viscosity);
        model.scheme = TimeScheme::Verlet { euler_every: 50 };
        assert_step_agrees(&model, [0.8, 0.8]);
    }
}

#[test]
fn simd_agrees_with_the_reference_for_every_law_in_two_dimensions() {
    every_law([0.8, 0.3]);
}

#[test]
fn simd_agrees_with_the_reference_for_every_law_in_three_dimensions() {
    every_law([0.5, 0.25, 0.3]);
}

/// All pair sums of a disordered cloud with the instruction set `level`.
fn with_instructions(
    level: simd::Level,
    water: &Particles<3>,
    boundary: &Particles<3>,
    model: &Model,
) -> Vec<PairSums<3>> {
    let mut near = NeighbourLists::new(model.support_radius(), model.dp, Some(level));
    near.build(&water.r, &boundary.r);
    let units = Units { length: NeighbourLists::<3>::length_unit(model.support_radius()), time: model.h / model.c0 };
    let (properties, state) = (model.fluid_properties::<3>(), EquationOfState::new(model.c0, model.gamma));
    let scaled = properties.in_units(&units);
    let wall = ((Pressure, Continuity), Artificial { alpha: 0.1 }.term(&scaled));
    let inner = (wall, Fourtakas::default().term(&scaled));
    let kernel = Wendland::new(scaled.h, 3);
    let mut pair_loop = interaction::compile(kernel, inner, wall, &scaled, units, Some(level));
    let mut on_boundary = vec![PairSums::zero(); near.boundary_near_fluid().len()];
    let (boundary_velocity, stress, gradient_correction, suppressed) = (&boundary.v[..], &[][..], &[][..], &[][..]);
    let input = PairLoopInput {
        neighbours: &near,
        fluid: water,
        boundary,
        boundary_velocity,
        stress,
        gradient_correction,
        shifting_suppressed: suppressed,
        properties: &properties,
        equation_of_state: &state,
    };
    pair_loop.rates(&input, RequestedSums::All, &mut on_boundary);
    (0..water.len()).map(|i| pair_loop.fluid_sums(&near, i)).chain(on_boundary).collect()
}

#[test]
fn every_instruction_set_computes_the_same_bits() {
    let model = Model::water(3, 0.05, 0.5);
    let mut random = Random(4);
    let (mut water, mut boundary) = (Particles::default(), Particles::default());
    for r in common::lattice([0.0; 3], [0.6, 0.5, 0.5], model.dp) {
        water.push(r + random.point::<3>() * 0.3 * model.dp, 1000.0 + random.number());
    }
    for v in &mut water.v {
        *v = random.point();
    }
    for r in common::lattice([0.0, 0.0, -0.2], [0.6, 0.5, 0.2], model.dp) {
        boundary.push(r, 1000.0);
    }
    // A processor has one or two sets; all of them round a multiplication and an addition once.
    let all = simd::instruction_sets().into_iter().map(|level| with_instructions(level, &water, &boundary, &model));
    let all: Vec<_> = all.collect();
    assert!(all.iter().all(|sums| *sums == all[0]));
}
