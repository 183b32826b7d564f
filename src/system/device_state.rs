//! Data that a device reads from a system, and data that the system takes back.

use std::{collections::BTreeMap, ops::Range};

use super::{
    AxisSet, Fluid, Images, ParticleLimits, System,
    device_films::{self, BoundaryWater},
    driving,
    impulses::MomentumTransfer,
    squeezed_water,
    symmetry::reflected_tensor,
    thin_layers::{self, WaterAround},
};
use crate::{
    interaction::PairSums,
    math::{Bounds, Matrix, Vector},
    model::PairLoopKind,
    solid::{Load, Role, Solid},
};

/// A water particle near a place: its index, place (m), velocity (m/s) and density (kg/m³).
pub(crate) type NearParticle<const D: usize> = (u32, Vector<D>, Vector<D>, f64);

/// What the water on a device does to the solids in a force pass.
pub(crate) struct WaterLoads<const D: usize> {
    /// The load on each solid.
    pub(crate) loads: Vec<Load<D>>,
    /// Weight (–) of the water around each watched boundary particle that has any.
    pub(crate) weights: Vec<(u32, f64)>,
    /// Σ V₀ W of the ways (m) from this water to each of these particles; empty unless thin parts are beside hollows.
    pub(crate) offsets: Vec<Vector<D>>,
    /// What it does at each boundary particle that films read and that has water near it, in ascending order.
    pub(crate) at_films: Vec<(u32, BoundaryWater<D>)>,
}

/// What this system has that no device computes yet, if anything.
pub(crate) fn unsupported_on_device<const D: usize>(system: &System<D>) -> Option<&'static str> {
    let (model, region) = (&system.model, &system.fluid_domain);
    let [least, most] = region.limits.density;
    let cases = [
        (model.pair_loop == PairLoopKind::Reference, "in double precision throughout (model.sweep = \"reference\")"),
        (!region.open_boundaries.is_empty(), "open boundaries ([[inflow]], [[outflow]])"),
        (!(0.5..1.0).contains(&least) || !(1.0..=1.5).contains(&most), "density limits beyond 0.5 to 1.5"),
        (system.equation_of_state.coefficients().is_none(), "an exponent model.gamma above 7"),
        (D == 2 && thin_layers::may_be_wet_on_both_sides(system), "parts of solids thinner than dp in 2-D"),
    ];
    cases.into_iter().find(|(has, _)| *has).map(|(_, what)| what)
}

/// Whether gravity or what else drives the water changes with time.
pub(crate) fn gravity_changes<const D: usize>(system: &System<D>) -> bool {
    !system.gravity_law.is_empty() || !system.driving.is_none()
}

/// Whether a force holds a current.
pub(crate) fn holds_current<const D: usize>(system: &System<D>) -> bool {
    system.driving.driving.current.is_some()
}

/// Adapts the force that holds the current after a step `dt` (s), in which the velocities of the water add up to `sum` (m/s).
pub(crate) fn adapt_current<const D: usize>(system: &mut System<D>, sum: &Vector<D>, dt: f64) {
    let found = system.driving.driving.current.and_then(|current| system.discharge_by(current.axis, sum[current.axis]));
    driving::adapt_current(system, found.unwrap_or(0.0), dt);
}

/// Distance (m) to which images of the water reach beyond a periodic side.
pub(crate) fn image_width<const D: usize>(system: &System<D>) -> f64 {
    system.fluid.images.width
}

/// Indices of the originals of all images of the water, in the order of the images, and the axes along which the images are
/// reflected.
pub(crate) fn originals<const D: usize>(system: &System<D>) -> impl Iterator<Item = (usize, AxisSet)> {
    system.fluid.images.each_original()
}

/// The boundary particles of solid number `solid` on the computed side of symmetry planes, or of all its copies; and the axes along
/// which the others, which follow, are reflected, each with its original.
pub(crate) fn reflected_boundary<const D: usize>(
    system: &System<D>,
    solid: usize,
) -> (Range<usize>, Vec<(AxisSet, usize)>) {
    let own = &system.solids[solid];
    let mirrored = system.boundary.each_mirrored((solid, own));
    let mirrored: Vec<_> = mirrored.map(|(_, original, axes)| (axes, original)).collect();
    (own.boundary.start..own.boundary.end - mirrored.len(), mirrored)
}

/// The share (–) of the load on boundary particle `i` that counts: half on a symmetry plane that cuts its solid.
pub(crate) fn share_of_load<const D: usize>(system: &System<D>, i: usize) -> f64 {
    system.computed_share(&system.solids[system.owner(i)], &system.boundary.particles.r[i])
}

/// Whether a reflection along `axes` leaves solid number `solid` the same.
pub(crate) fn is_whole<const D: usize>(system: &System<D>, solid: usize, axes: AxisSet) -> bool {
    axes & !system.solids[solid].division.cut == 0
}

/// How many periods copy number `copy` of the boundary particles of solid number `solid` is away from the solid, along each axis.
pub(crate) fn periods_to_copy<const D: usize>(system: &System<D>, solid: usize, copy: usize) -> [i64; D] {
    let (boundary, images, own) = (&system.boundary, &system.fluid.images, &system.solids[solid]);
    if own.copied_axes == 0 {
        return [0; D];
    }
    let way = images.way_to_copy(&boundary.middle(solid, &own.kinematics.pose), own.copied_axes, copy);
    let periods = |k: usize| images.periodic[k].map_or(0.0, |[from, to]| (way[k] / (to - from)).round());
    std::array::from_fn(|k| periods(k) as i64)
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
    system.fluid.stress.as_deref().map(|stress| &stress[..system.own_count()])
}

/// Takes the stress (m²/s²) of each water particle from a device.
pub(crate) fn set_fluid_stress<const D: usize>(system: &mut System<D>, stress: impl Fn(usize) -> Matrix<D>) {
    let water = system.own_count();
    let Fluid { stress: all, images, .. } = &mut system.fluid;
    let which = (0..water).map(|i| (i, 0)).chain(images.each_original());
    all.iter_mut().flatten().zip(which).for_each(|(own, (i, axes))| *own = reflected_tensor(axes, &stress(i)));
    system.pair_loop.inputs_changed();
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

/// Outward normals of the faces before the boundary particles, in the frames of their solids, if water sticks to faces.
pub(crate) fn wall_normals<const D: usize>(system: &System<D>) -> Option<&[Vector<D>]> {
    system.boundary.normals.as_deref()
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

/// The boundary particles while a device has them: the host places none.
#[derive(Default)]
pub(super) struct BoundaryOnDevice<const D: usize> {
    /// The particles near water, in ascending order, and their sums in the last force pass, if the host has read these.
    pub(super) sums: Option<(Vec<u32>, Vec<PairSums<D>>)>,
}

/// The particles are on a device from now on: the host places no boundary particles.
pub(crate) fn leave_to_device<const D: usize>(system: &mut System<D>) {
    system.boundary.on_device = Some(BoundaryOnDevice::default());
}

/// Takes the boundary particles near water and their `sums` in the last force pass from a device. Without them those of the host hold.
pub(crate) fn set_boundary_sums<const D: usize>(system: &mut System<D>, sums: Option<(Vec<u32>, Vec<PairSums<D>>)>) {
    if let Some(own) = &mut system.boundary.on_device {
        own.sums = sums;
    }
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
    let count = system.own_count();
    let particles = &mut system.fluid.particles;
    for i in 0..count {
        (particles.r[i], particles.v[i], particles.rho[i]) = water(i);
    }
    for (i, rho) in system.boundary.particles.rho.iter_mut().enumerate() {
        *rho = boundary_density(i);
    }
    system.renew_images();
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

/// Sets the effects of the water on the solids in the force pass: loads, with those of films and corrected for thin parts, and wet
/// shares. Returns the loads of films.
pub(crate) fn set_loads<const D: usize>(system: &mut System<D>, of: WaterLoads<D>) -> Vec<Load<D>> {
    let WaterLoads { mut loads, weights, offsets, at_films } = of;
    let place = |i: u32| weights.binary_search_by_key(&i, |(watched, _)| *watched).ok();
    let around = |place: usize| {
        let weight = weights[place].1;
        WaterAround { weight, offset: offsets.get(place).map_or_else(Vector::zeros, |sum| -sum / weight) }
    };
    thin_layers::update_water(system, |_, i| place(i).map(around));
    let films = device_films::loads(system, &at_films);
    complete_loads(system, &films.loads, &mut loads);
    system.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
    squeezed_water::update(system, &films.excess);
    if let Some(wetness) = &mut system.boundary.wetness {
        *wetness = weights;
    }
    films.loads
}

/// Completes the `loads` on the solids: adds those of `films`, those of the water on thin parts, as [`set_loads`] knows it, and those
/// beyond symmetry planes.
pub(crate) fn complete_loads<const D: usize>(system: &System<D>, films: &[Load<D>], loads: &mut [Load<D>]) {
    loads.iter_mut().zip(films).for_each(|(load, film)| *load += *film);
    loads.iter_mut().zip(thin_layers::loads(system)).for_each(|(load, thin)| *load += thin);
    for (load, solid) in loads.iter_mut().zip(&system.solids).filter(|(_, solid)| solid.division.cut != 0) {
        *load = system.load_on_whole(solid, *load);
    }
}

/// The boundary particles in the middle of thin parts.
pub(crate) fn thin_particles<const D: usize>(system: &System<D>) -> Vec<u32> {
    thin_layers::particles(system).collect()
}

/// Whether thin parts are beside hollows, so that they need to know on which side water is.
pub(crate) fn has_hollows<const D: usize>(system: &System<D>) -> bool {
    thin_layers::has_hollows(system)
}

/// Places the boundary particles of solid number `solid` on the host.
pub(crate) fn place_solid<const D: usize>(system: &mut System<D>, solid: usize) {
    let System { boundary, solids, fluid, .. } = system;
    boundary.place(solid, &solids[solid], &fluid.images);
}

/// Takes water particles from a device, which with their images are all that are known until [`take_from_device`].
pub(crate) fn take_near<const D: usize>(system: &mut System<D>, near: Vec<NearParticle<D>>) {
    let particles = &mut system.fluid.particles;
    for &(i, r, v, rho) in &near {
        let i = i as usize;
        (particles.r[i], particles.v[i], particles.rho[i]) = (r, v, rho);
    }
    let (mut these, mut places): (Vec<_>, Vec<_>) = near.into_iter().map(|(i, r, ..)| (i, r)).unzip();
    system.renew_images_of(&mut these, &mut places);
    system.neighbours.set_known_positions(these, &places);
}

/// The boxes (m) in which the water of `ranges` is, and its originals beyond the other sides.
pub(crate) fn with_originals<const D: usize>(system: &System<D>, mut ranges: Vec<Bounds<D>>) -> Vec<Bounds<D>> {
    let Images { periodic, width, .. } = &system.fluid.images;
    for (axis, [from, to]) in periodic.iter().enumerate().filter_map(|(axis, side)| Some((axis, (*side)?))) {
        let period = to - from;
        let moved = |range: &Bounds<D>| {
            let home = ((range.min[axis] - from) / period).floor();
            let copies = [-1.0, 0.0, 1.0].map(|count| {
                let mut range = *range;
                for end in [&mut range.min, &mut range.max] {
                    end[axis] += (count - home) * period;
                }
                range
            });
            copies.into_iter().filter(move |range| range.max[axis] > from - width && range.min[axis] < to + width)
        };
        let whole = |mut range: Bounds<D>| {
            if range.max[axis] - range.min[axis] >= period {
                (range.min[axis], range.max[axis]) = (from, to);
            }
            range
        };
        ranges = ranges.into_iter().flat_map(|range| moved(&whole(range)).collect::<Vec<_>>()).collect();
    }
    let planes = system.symmetry_planes();
    for (axis, _) in planes.each() {
        let reflected =
            |range: &Bounds<D>| Bounds::around(&[range.min, range.max].map(|x| planes.mirrored(1 << axis, &x)));
        ranges = ranges.into_iter().flat_map(|range| [range, reflected(&range)]).collect();
    }
    ranges
}

/// The changes of velocity (m/s) of water particles in all `transfers`, each particle once and in order, without images.
pub(crate) fn velocity_changes<const D: usize>(
    system: &System<D>,
    transfers: &[MomentumTransfer<D>],
) -> Vec<(usize, Vector<D>)> {
    let (count, mut sums) = (system.own_count(), BTreeMap::<usize, Vector<D>>::new());
    let changes = transfers.iter().flat_map(|transfer| &transfer.changes);
    for (i, change) in changes.filter(|(i, _)| *i < count) {
        *sums.entry(*i).or_insert_with(Vector::zeros) += change;
    }
    sums.into_iter().collect()
}

/// Lets the next [`System::rebuild_neighbours`] make new lists.
pub(crate) fn ask_for_lists<const D: usize>(system: &mut System<D>) {
    system.boundary.poses_at_rebuild = None;
}
