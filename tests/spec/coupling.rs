//! Water and solids: what one loses the other gains.

use pontoon::{
    geometry::Shape,
    math::{Bivector, Pose, Vector, expression::Formula},
    model::{Diffusion, Dimension, Model, PairLoopKind, TimeScheme, Viscosity, Walls},
    simulation::{Setup, Simulation},
    solid::{Dim, PrescribedMotion, Role, TimeFunction},
};

use crate::rig;

/// Both sweeps and what they may lose of what they add up in 500 to 1,000 steps: rounding of f64; and of single precision,
/// of which a step leaves up to 1e-8 of its impulses, in any direction (docs/explanation/performance.md).
const SWEEPS: [(PairLoopKind, f64); 2] = [(PairLoopKind::Reference, 1e-12), (PairLoopKind::Fast, 1e-8)];

/// Speed of sound in a drop, m/s: so fast that 1,000 steps end before the drop has flown apart.
const C0: f64 = 34.0;

/// A drop in free space with a body inside it, started spinning and stretching.
fn drop_with_body(scheme: TimeScheme, sweep: PairLoopKind) -> Simulation<2> {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.3);
    (model.scheme, model.gravity, model.pair_loop) = (scheme, vec![0.0, 0.0], sweep);
    (model.c0, model.walls) = (C0, Walls::Dynamic);
    if scheme != TimeScheme::Symplectic {
        // Without damping no Euler step comes before its time.
        (model.cfl, model.viscosity, model.diffusion) = (0.2, Viscosity::None, Diffusion::None);
    }
    // Under Verlet's one that is heavy enough: what joins a light one comes into the sum a step later.
    drop_under(model, if scheme == TimeScheme::Symplectic { 600.0 } else { 2000.0 })
}

/// That drop with another model and a body of another `density` (kg/m³).
fn drop_under(model: Model, density: f64) -> Simulation<2> {
    let dp = model.dp;
    let mut water = rig::lattice([-0.2, -0.2], [0.4, 0.4], dp);
    water.retain(|r| r[0].abs() > 0.06 || r[1].abs() > 0.04);
    let body = rig::float(Shape::Box { size: Vector::from([0.12, 0.08]) }, [0.0, 0.0], density);
    let mut sim = rig::simulation(model, water, -1.0, vec![body]);
    sim.set_water_velocity(|r| Vector::from([0.5 - 2.0 * r[0] + r[1], 0.3 + 2.0 * r[1] - r[0]]));
    sim
}

/// What the body has, and has yet to get.
fn body_momentum(sim: &Simulation<2>) -> Vector<2> {
    let solid = &sim.system().solids()[0];
    let Role::Free(body) = &solid.spec.role else { panic!("a free body") };
    solid.kinematics.velocity * body.mass + sim.pending_impulse(0)
}

/// Sum of the sizes of what is added up, the scale of rounding.
fn momentum_scale(sim: &Simulation<2>) -> f64 {
    sim.system().fluid().v.iter().map(|v| v.norm()).sum::<f64>() * sim.system().particle_mass()
}

#[test]
fn a_free_drop_with_a_body_inside_keeps_its_momentum() {
    for (sweep, rounding) in SWEEPS {
        let mut sim = drop_with_body(TimeScheme::Symplectic, sweep);
        let (start, scale) = (rig::water_momentum(&sim) + body_momentum(&sim), momentum_scale(&sim));
        for _ in 0..1000 {
            sim.step().unwrap();
        }
        let end = rig::water_momentum(&sim) + body_momentum(&sim);
        assert!(body_momentum(&sim).norm() > 1e-3 * scale, "the body was carried along");
        assert!((end - start).norm() < rounding * scale, "{:e}", (end - start).norm() / scale);
    }
}

#[test]
fn walls_that_settle_keep_momentum_too() {
    for (sweep, lost) in SWEEPS {
        let mut model = drop_with_body(TimeScheme::Symplectic, sweep).system().model().clone();
        model.walls = Walls::RelaxedAdami;
        let mut sim = drop_under(model, 600.0);
        let start = rig::water_momentum(&sim) + body_momentum(&sim);
        for _ in 0..200 {
            sim.step().expect("a sound run");
        }
        let change = (rig::water_momentum(&sim) + body_momentum(&sim) - start).norm();
        assert!(change < lost * momentum_scale(&sim), "{sweep:?}: {change} kg m/s");
    }
}

#[test]
fn a_free_drop_keeps_its_angular_momentum() {
    for (sweep, rounding) in SWEEPS {
        let dp = 0.02;
        let mut model = Model::water(2, dp, 0.3);
        (model.gravity, model.pair_loop, model.c0) = (vec![0.0, 0.0], sweep, C0);
        let mut sim = rig::simulation(model, rig::lattice([-0.2, -0.2], [0.4, 0.4], dp), -1.0, vec![]);
        sim.set_water_velocity(|r| Vector::from([2.0 * r[0] + 3.0 * r[1], -2.0 * r[1] - 5.0 * r[0]]));
        let spin = |sim: &Simulation<2>| -> (f64, f64) {
            let fluid = sim.system().fluid();
            let each = fluid.r.iter().zip(fluid.v).map(|(r, v)| Bivector::torque(r, v).axial()[0]);
            each.fold((0.0, 0.0), |(sum, size), l| (sum + l, size + l.abs()))
        };
        let (start, scale) = spin(&sim);
        for _ in 0..1000 {
            sim.step().unwrap();
        }
        // Forces along r_ab at the half step leave Σ r × v alone but for rounding, viscosity and diffusion too.
        assert!((spin(&sim).0 - start).abs() < rounding * scale, "{:e}", (spin(&sim).0 - start) / scale);
    }
}

#[test]
fn verlet_keeps_the_momentum_that_its_two_intervals_share() {
    for (sweep, rounding) in SWEEPS {
        // Derived in src/time/verlet.rs: ½(P⁺ + P) of the water and P⁺ of the bodies are constant between Euler
        // steps; the plain sum is off by ½(P⁺ − P).
        let mut sim = drop_with_body(TimeScheme::Verlet { euler_every: 1_000_000 }, sweep);
        let scale = momentum_scale(&sim);
        sim.step().unwrap();
        let mut before = rig::water_momentum(&sim);
        sim.step().unwrap();
        let shared = |now: Vector<2>, before: Vector<2>, sim: &Simulation<2>| (now + before) * 0.5 + body_momentum(sim);
        let start = shared(rig::water_momentum(&sim), before, &sim);
        let plain = before + body_momentum(&sim);
        let mut largest_change: f64 = 0.0;
        for _ in 0..500 {
            before = rig::water_momentum(&sim);
            sim.step().unwrap();
            let now = rig::water_momentum(&sim);
            largest_change = largest_change.max((now - before).norm());
            let off = shared(now, before, &sim) - start;
            assert!(off.norm() < rounding * scale, "{:e}", off.norm() / scale);
            assert!((now + body_momentum(&sim) - plain).norm() < 2.0 * largest_change + rounding * scale);
        }
    }
}

#[test]
fn an_euler_step_moves_the_shared_momentum_by_less_than_a_step_does() {
    let (every, steps) = (50, 500);
    let mut sim = drop_with_body(TimeScheme::Verlet { euler_every: every }, PairLoopKind::Fast);
    sim.step().unwrap();
    let mut before = rig::water_momentum(&sim);
    let shared = |now: Vector<2>, before: Vector<2>, sim: &Simulation<2>| (now + before) * 0.5 + body_momentum(sim);
    sim.step().unwrap();
    let start = shared(rig::water_momentum(&sim), before, &sim);
    let mut largest_change: f64 = 0.0;
    for _ in 0..steps {
        before = rig::water_momentum(&sim);
        sim.step().unwrap();
        largest_change = largest_change.max((rig::water_momentum(&sim) - before).norm());
    }
    let off = (shared(rig::water_momentum(&sim), before, &sim) - start).norm();
    // ½|P − P⁻ − Δt F| an Euler step, each of the two no more than the largest change seen.
    assert!(off < f64::from(steps / every) * largest_change, "{off:e} after changes of up to {largest_change:e}");
}

#[test]
fn a_piston_gives_the_water_the_work_that_it_records() {
    // Work by the recorded force against kinetic, potential and compression energy of water and walls: 2 %, the
    // project's bound; what is lost goes into the floor under the walls' density. Walls that settle change their density
    // otherwise than by being compressed, so that the balance is open by as much again.
    for (walls, open) in [(Walls::Dynamic, 0.02), (Walls::RelaxedAdami, 0.04)] {
        let (work, gained) = pushed(walls);
        assert!(work > 1.0, "the piston did {work} J/m");
        assert!((work / gained - 1.0).abs() < open, "{walls:?}: work {work} J/m, gained {gained} J/m");
    }
}

/// Water of this size (m) before a piston `thick` and `high` (m) on the bed of a tank, which goes as `law` (m) says.
fn before_a_piston(model: Model, [long, deep]: [f64; 2], law: &str, [thick, high]: [f64; 2]) -> Simulation<2> {
    let (dp, behind) = (model.dp, 0.4);
    let motion = PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::Formula(Formula::parse(law).unwrap()));
    let shape = Shape::Box { size: Vector::from([thick, high]) };
    let start = Pose::at(Vector::from([-0.5 * thick, 0.5 * high]));
    let piston = rig::solid("piston", shape, start, Role::Driven(motion));
    let mut tank = rig::tank([behind + long, high], dp);
    tank.pose = Pose::at(Vector::from([-behind, 0.0]));
    rig::simulation(model, rig::lattice([0.0, 0.0], [long, deep], dp), deep, vec![tank, piston])
}

/// The work (J/m) that a piston records, and the energy (J/m) that water and walls gain.
fn pushed(walls: Walls) -> (f64, f64) {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.3);
    (model.viscosity, model.diffusion, model.walls) = (Viscosity::None, Diffusion::None, walls);
    let mut sim = before_a_piston(model, [1.2, 0.3], "0.06*(1-cos(6*t))/2", [0.08, 0.6]);
    let start = energy(&sim);
    let mut work = 0.0;
    while sim.time() < 0.5 {
        sim.step_to(0.5).unwrap();
        work += power(&sim) * sim.dt();
    }
    (work, energy(&sim) - start)
}

#[test]
fn no_water_gets_under_a_piston_that_goes_to_and_fro_on_its_bed() {
    // Strokes of 10 dp press water into the corner, where bed and piston slide on one another. Half a dp inside the face are the first
    // boundary particles: water at their depth is on its way through. Without a hem the first is in after 0.5 s.
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.4);
    (model.h, model.viscosity) = (2.0 * dp, Viscosity::None);
    let mut sim = before_a_piston(model, [1.2, 0.4], "0.1*(1-cos(2*pi*t/1.6))", [0.1, 0.9]);
    while sim.time() < 4.8 {
        sim.step_to(4.8).unwrap();
        let face = sim.system().solids()[1].kinematics.pose.position[0] + 0.05;
        for r in sim.system().fluid().r {
            assert!(
                r[0] > face - 0.5 * dp && r[1] > -0.5 * dp,
                "water at {r:?} m, the face at {face}, {} s",
                sim.time()
            );
        }
    }
}

/// Power of the piston on the water, W/m, with the velocity in the middle of the step that the load belongs to.
fn power(sim: &Simulation<2>) -> f64 {
    let piston = &sim.system().solids()[1];
    let Role::Driven(motion) = &piston.spec.role else { panic!("a driven piston") };
    let middle = motion.kinematics(&piston.spec.pose, sim.time() - 0.5 * sim.dt());
    -piston.load.force.dot(&middle.velocity)
}

/// Kinetic, potential and compression energy of the water, and compression of the boundary particles, J/m.
fn energy(sim: &Simulation<2>) -> f64 {
    let system = sim.system();
    let fluid = system.fluid();
    let water = (0..fluid.len())
        .map(|i| 0.5 * fluid.v[i].norm_squared() + 9.81 * fluid.r[i][1] + system.compression_energy(fluid.rho[i]));
    let walls = system.boundary().rho.iter().map(|&rho| system.compression_energy(rho));
    (water.sum::<f64>() + walls.sum::<f64>()) * system.particle_mass()
}

/// How far (m) a body thrown over water is from the parabola after half a second, and how long that way is (m).
fn thrown<const D: usize>(scheme: TimeScheme) -> (f64, f64)
where
    Dim<D>: Dimension<D>,
{
    let dp = 0.05;
    let mut model = Model::water(D, dp, 0.2);
    model.scheme = scheme;
    let (mut size, mut at) = ([0.3; D], [0.15; D]);
    (size[D - 1], at[D - 1]) = (0.2, 1.0);
    // So light that in water it would answer with the inertia of that.
    let mut body = rig::float(Shape::Box { size: Vector::from_fn(|i, _| 0.1 + 0.05 * i as f64) }, at, 5.0);
    let Role::Free(free) = &mut body.role else { panic!("a free body") };
    (free.velocity[0], free.velocity[D - 1]) = (2.0, 3.0);
    free.spin = Bivector::from_axial(&[4.0, 1.0, -2.0][..Bivector::<D>::COMPONENTS]);
    let start = *free;
    let water = rig::lattice([0.0; D], size, dp);
    let setup = Setup::new(model)
        .water(water, 0.2)
        .solids([rig::tank([0.3; D], dp), body])
        .domain(Vector::repeat(-1.0), Vector::repeat(4.0));
    let mut sim = Simulation::new(setup).expect("a sound setup");
    let from = sim.system().solids()[1].kinematics.centre;
    while sim.time() < 0.5 {
        sim.step_to(0.5).expect("a sound run");
    }
    let mut way = start.velocity * 0.5;
    way[D - 1] -= 0.5 * 9.81 * 0.25;
    ((sim.system().solids()[1].kinematics.centre - from - way).norm(), way.norm())
}

#[test]
fn a_body_thrown_over_water_flies_as_in_a_vacuum() {
    for scheme in [TimeScheme::Symplectic, TimeScheme::Verlet { euler_every: 40 }] {
        for (off, way) in [thrown::<2>(scheme), thrown::<3>(scheme)] {
            // A thousand steps of round-off; a step of g Δt/2 more or less would be 1e-4.
            assert!(off < 1e-12 * way, "{scheme:?}: {off:e} m off in {way} m");
        }
    }
}
