//! What a device reads of a system, and what a system takes back from it.

use super::{Escape, ParticleLimits, System};
use crate::{
    math::{Matrix, Vector},
    model::Slip,
    solid::{Load, Role, Solid},
};

/// What this system has that no device computes yet, if anything.
pub(crate) fn unsupported_on_device<const D: usize>(system: &System<D>) -> Option<&'static str> {
    let (model, region, driving) = (&system.model, &system.fluid_domain, &system.driving.driving);
    let [least, most] = region.limits.density;
    let absorbs = |solid: &Solid<D>| match &solid.spec.role {
        Role::Driven(motion) => motion.absorber().is_some(),
        _ => false,
    };
    let cases = [
        (system.fluid.images.periodic.iter().any(Option::is_some), "periodic sides"),
        (system.symmetry_planes().any(), "symmetry planes"),
        (!region.open_boundaries.is_empty(), "open boundaries ([[inflow]], [[outflow]])"),
        (driving.current.is_some() || driving.towed.is_some(), "currents and towed frames"),
        (!system.gravity_law.is_empty(), "gravity that changes with time"),
        (region.limits.escape == Escape::Remove, "removal of particles (guard.escape = \"remove\")"),
        (!(0.5..1.0).contains(&least) || !(1.0..=1.5).contains(&most), "density limits beyond 0.5 to 1.5"),
        (model.slip == Slip::None, "slip = \"none\""),
        (model.gamma != 7.0, "an exponent model.gamma other than 7"),
        (system.solids.iter().any(absorbs), "paddles that absorb waves"),
        (system.solids.iter().any(|solid| !solid.spec.ballast.is_empty()), "ballast"),
    ];
    cases.into_iter().find(|(has, _)| *has).map(|(_, what)| what)
}

/// Whether a solid is free.
pub(crate) fn has_free_solids<const D: usize>(system: &System<D>) -> bool {
    system.solids.iter().any(Solid::is_free)
}

/// Whether water beside solid number `solid` is not shifted.
pub(crate) fn suppresses_shifting<const D: usize>(system: &System<D>, solid: usize) -> bool {
    system.model.shifting.suppressed_beside(matches!(system.solids[solid].spec.role, Role::Fixed))
}

/// Stress of the water from the last pass, m²/s², if the viscosity has one.
pub(crate) fn fluid_stress<const D: usize>(system: &System<D>) -> Option<&[Matrix<D>]> {
    system.fluid.stress.as_deref()
}

/// Takes the stress (m²/s²) of each water particle from a device.
pub(crate) fn set_fluid_stress<const D: usize>(system: &mut System<D>, stress: impl Fn(usize) -> Matrix<D>) {
    for (i, own) in system.fluid.stress.iter_mut().flatten().enumerate() {
        *own = stress(i);
    }
}

/// The valid range of a particle.
pub(crate) fn particle_limits<const D: usize>(system: &System<D>) -> ParticleLimits {
    system.fluid_domain.limits
}

/// Depth (m) of each boundary particle below its face, and its weight behind a flat face under water, –; zeros where walls do
/// not relax.
pub(crate) fn wall_constants<const D: usize>(system: &System<D>) -> Vec<[f64; 2]> {
    let coverage = &system.boundary.coverage;
    match &system.boundary.depths {
        Some(depths) => depths.iter().map(|&depth| [depth, coverage.full_weight(depth)]).collect(),
        None => vec![[0.0, 1.0]; system.boundary.particles.len()],
    }
}

/// Counts the force passes that a device has made.
pub(crate) fn count_device_passes<const D: usize>(system: &mut System<D>, passes: u64) {
    system.status.passes += passes;
}

/// Positions (m) of the boundary particles of solid number `solid` in its frame; none of a fixed solid.
pub(crate) fn local_boundary<const D: usize>(system: &System<D>, solid: usize) -> &[Vector<D>] {
    &system.boundary.local_positions[solid]
}

/// Number of the solid of boundary particle `i`.
pub(crate) fn solid_of_boundary<const D: usize>(system: &System<D>, i: usize) -> usize {
    system.owner(i)
}

/// The particles are on a device from now on: the host places no boundary particles.
pub(crate) fn leave_to_device<const D: usize>(system: &mut System<D>) {
    system.boundary.on_device = true;
}

/// Acceleration (1/s²) that an arm of solid number `solid` gives a point of it: α + Ω².
pub(crate) fn arm_acceleration<const D: usize>(system: &System<D>, solid: usize) -> Matrix<D> {
    let solid = &system.solids[solid];
    let spin = solid.kinematics.spin.0;
    solid.angular_acceleration.0 + spin * spin
}

/// Takes the state of the water and the densities (kg/m³) of the boundary particles back from a device.
pub(crate) fn take_from_device<const D: usize>(
    system: &mut System<D>,
    water: impl Fn(usize) -> (Vector<D>, Vector<D>, f64),
    boundary_density: impl Fn(usize) -> f64,
) {
    let particles = &mut system.fluid.particles;
    for i in 0..particles.r.len() {
        (particles.r[i], particles.v[i], particles.rho[i]) = water(i);
    }
    for (i, rho) in system.boundary.particles.rho.iter_mut().enumerate() {
        *rho = boundary_density(i);
    }
    place_solids(system);
    system.neighbours.set_fluid_positions(&system.fluid.particles.r);
    system.boundary.poses_at_rebuild = Some(system.solids.iter().map(|solid| solid.kinematics.pose).collect());
    (system.rates.current, system.rates.corrections_current) = (false, false);
    system.check_water();
}

/// Places the boundary particles of all solids on the host.
pub(crate) fn place_solids<const D: usize>(system: &mut System<D>) {
    let System { boundary, solids, fluid, .. } = system;
    solids.iter().enumerate().for_each(|(i, solid)| boundary.place(i, solid, &fluid.images));
}

/// Sets the load of the water on each solid.
pub(crate) fn set_loads<const D: usize>(system: &mut System<D>, loads: Vec<Load<D>>) {
    system.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
}
