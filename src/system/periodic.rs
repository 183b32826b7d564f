//! Periodic sides: water that leaves at one side enters at the other, and particles interact across the sides.
//!
//! Water near a side has an image one period away, a particle of the arrays like any other, after all that is real. An image
//! takes its rates from the particle that it mirrors, so that both move alike; only functions that count the water leave images
//! out. The images across symmetry planes are made here too ([`super::symmetry`]).
//!
//! Fixed solids have no images: they reach beyond the sides as far as the images of the water do. A free solid is not wrapped:
//! its kinematics continue beyond the sides. Its boundary particles stand in the arrays twice for each periodic axis, an even and
//! an odd number of periods from its place: one copy with its middle between the sides, and one beyond the nearer side. A driven
//! solid has such copies for each periodic axis along which it moves, if it starts between the sides and is short; a longer one
//! reaches beyond both sides all the time. Exactly one copy of a particle lies between the sides. It gives the load, and the
//! other copies take its density. A copy moves by two periods when the middle of the solid passes the middle between the sides;
//! at that time no water is near the copy.

use rayon::prelude::*;

use super::{
    Fluid, RemovedParticle, System, open_boundary,
    symmetry::{AxisSet, SymmetryPlanes, reflected, reflected_tensor},
};
use crate::{
    error::{Error, Result},
    geometry::{greatest_length, world_bounds},
    interaction::StepLimits,
    math::{Bounds, Pose, Vector},
    model::Model,
    particles::Particles,
    solid::{Constraints, Kinematics, PrescribedMotion, Role, SolidSpec},
};

/// Distance to which images reach beyond a side, over the kernel's support. The boundary particles beyond a side then see the
/// same water as those inside, also until the lists are rebuilt.
pub(super) const WIDTH: f64 = 2.5;

/// For each axis where a period begins and ends (m), if it has one.
pub(crate) type Periodic<const D: usize> = [Option<[f64; 2]>; D];

/// The images of the water.
pub(super) struct Images<const D: usize> {
    pub(super) periodic: Periodic<D>,
    pub(super) planes: SymmetryPlanes<D>,
    pub(super) width: f64,
    /// Which particle each of them mirrors; they follow the real ones in this order.
    pub(super) originals: Vec<u32>,
    /// Along which axes each of them is reflected; empty without a symmetry plane.
    pub(super) reflections: Vec<AxisSet>,
}

/// An image to be made.
struct NewImage<const D: usize> {
    /// Index of the particle that it mirrors.
    original: u32,
    /// Whole periods from the place of the original, reflected, to its own, m.
    away: Vector<D>,
    axes: AxisSet,
}

impl<const D: usize> Images<D> {
    /// Index of the original of each image, in the order of the images, and the axes along which the image is reflected.
    #[cfg(feature = "gpu")]
    pub(super) fn each_original(&self) -> impl Iterator<Item = (usize, AxisSet)> {
        let axes = self.reflections.iter().copied().chain(std::iter::repeat(0));
        self.originals.iter().map(|original| *original as usize).zip(axes)
    }

    /// None yet, for a kernel of support `reach` (m).
    pub(super) fn new(periodic: Periodic<D>, planes: SymmetryPlanes<D>, reach: f64) -> Self {
        Self { periodic, planes, width: WIDTH * reach, originals: Vec::new(), reflections: Vec::new() }
    }

    /// Whether any side is periodic or a symmetry plane.
    pub(super) fn any(&self) -> bool {
        self.periodic.iter().any(Option::is_some) || self.planes.any()
    }

    /// Brings particles that have left through a periodic side in at the other.
    fn wrap(&self, r: &mut [Vector<D>]) {
        for (axis, side) in self.periodic.iter().enumerate() {
            let Some([from, to]) = *side else { continue };
            for x in r.iter_mut().map(|r| &mut r[axis]).filter(|x| !(from..to).contains(x)) {
                let left = (*x - from).rem_euclid(to - from);
                // A way so small that it is lost in the sum ends on the side itself.
                *x = if from + left >= to { from } else { from + left };
            }
        }
    }

    /// Makes the images of the particles at `r` (m).
    fn make(&self, r: &[Vector<D>]) -> Vec<NewImage<D>> {
        let mut images = Vec::new();
        for axis in 0..D {
            let mirror = |original: u32, away: Vector<D>, axes: AxisSet, images: &mut Vec<_>| {
                let x = r[original as usize][axis];
                if let Some([from, to]) = self.periodic[axis] {
                    for (near, sign) in [(x < from + self.width, 1.0), (x >= to - self.width, -1.0)] {
                        if near {
                            let mut away = away;
                            away[axis] += sign * (to - from);
                            images.push(NewImage { original, away, axes });
                        }
                    }
                }
                if self.planes.0[axis].is_some_and(|plane| plane.depth(x) < self.width) {
                    images.push(NewImage { original, away, axes: axes | 1 << axis });
                }
            };
            // Those of the axes before have images along this one too: the corners.
            let before = images.len();
            if self.periodic[axis].is_some() || self.planes.0[axis].is_some() {
                (0..r.len() as u32).for_each(|i| mirror(i, Vector::zeros(), 0, &mut images));
            }
            for k in 0..before {
                let NewImage { original, away, axes } = images[k];
                mirror(original, away, axes, &mut images);
            }
        }
        images
    }

    /// The axes along which the boundary particles of a solid have copies.
    pub(super) fn copied_axes(&self, spec: &SolidSpec<D>) -> AxisSet {
        let is_copied = |axis: &usize| is_copied(&self.periodic, self.planes.any(), spec, (*axis, self.width));
        (0..D).filter(is_copied).fold(0, |axes, axis| axes | 1 << axis)
    }

    /// The displacement (m) of copy number `copy` from a solid with copies along `axes` whose middle is at `middle` (m).
    pub(super) fn way_to_copy(&self, middle: &Vector<D>, axes: AxisSet, copy: usize) -> Vector<D> {
        let mut way = Vector::zeros();
        let sides = self.periodic.iter().enumerate().filter_map(|(axis, side)| Some((axis, (*side)?)));
        for (bit, (axis, [from, to])) in sides.filter(|(axis, _)| axes >> axis & 1 == 1).enumerate() {
            let periods = (middle[axis] - from) / (to - from);
            let home = -periods.floor();
            let beside = if periods + home < 0.5 { home + 1.0 } else { home - 1.0 };
            let is_odd = |count: f64| count.rem_euclid(2.0) == 1.0;
            let count = if is_odd(home) == (copy >> bit & 1 == 1) { home } else { beside };
            way[axis] = count * (to - from);
        }
        way
    }

    /// Number of the copy whose middle is between the sides, of a solid with copies along `axes` whose middle is at `middle` (m).
    pub(super) fn home_copy(&self, middle: &Vector<D>, axes: AxisSet) -> usize {
        let between = |x: &Vector<D>| {
            let is_inside = |(axis, side): (usize, &Option<[f64; 2]>)| {
                axes >> axis & 1 == 0 || side.is_none_or(|[from, to]| (from..to).contains(&x[axis]))
            };
            self.periodic.iter().enumerate().all(is_inside)
        };
        let is_home = |copy: &usize| between(&(middle + self.way_to_copy(middle, axes, *copy)));
        (0..1 << axes.count_ones()).find(is_home).unwrap_or(0)
    }

    /// The place between the sides that is whole periods from `x` (m), or its image on the computed side of the symmetry planes.
    pub(super) fn wrapped(&self, x: &Vector<D>) -> Vector<D> {
        let mut r = [self.planes.folded(x)];
        self.wrap(&mut r);
        r[0]
    }

    /// Whether `x` (m) lies further than `distance` (m) beyond a periodic side or a symmetry plane.
    fn is_far_out(&self, x: &Vector<D>, distance: f64) -> bool {
        let beyond_side = |(x, side): (&f64, &Option<[f64; 2]>)| {
            side.is_some_and(|[from, to]| *x < from - distance || *x > to + distance)
        };
        x.iter().zip(&self.periodic).any(beyond_side)
            || self.planes.each().any(|(axis, plane)| plane.depth(x[axis]) < -distance)
    }

    /// Whether `x` (m) lies between the sides.
    pub(super) fn is_inside(&self, x: &Vector<D>) -> bool {
        let inside = |(x, side): (&f64, &Option<[f64; 2]>)| side.is_none_or(|[from, to]| (from..to).contains(x));
        x.iter().zip(&self.periodic).all(inside)
    }
}

/// How the arrays of particles change when the water is sorted.
pub(super) struct SortedWater {
    /// `order[new] = old`; for an image that of its original.
    pub(super) order: Vec<u32>,
    /// Along which axes the vectors of each particle are reflected; empty without a symmetry plane.
    pub(super) reflections: Vec<AxisSet>,
}

impl<const D: usize> Fluid<D> {
    /// Lets those of the first `real` particles that have crossed a symmetry plane change places with their images. Returns the axes
    /// along which each of them is reflected, or an empty list without a plane.
    fn fold_at_planes(&mut self, real: usize) -> Vec<AxisSet> {
        if !self.images.planes.any() {
            return Vec::new();
        }
        let folded: Vec<AxisSet> = self.particles.r[..real].iter().map(|r| self.images.planes.axes_beyond(r)).collect();
        folded.iter().enumerate().filter(|(_, axes)| **axes != 0).for_each(|(i, axes)| self.reflect(i, *axes));
        folded
    }

    /// Reflects the images after the first `real` particles, which stand in the places of their originals.
    fn reflect_images(&mut self, real: usize) {
        for image in 0..self.images.reflections.len() {
            self.reflect(real + image, self.images.reflections[image]);
        }
    }

    /// Reflects particle `i` at the planes normal to `axes`.
    fn reflect(&mut self, i: usize, axes: AxisSet) {
        self.particles.r[i] = self.images.planes.mirrored(axes, &self.particles.r[i]);
        self.particles.v[i] = reflected(axes, self.particles.v[i]);
        for tensors in self.stress.iter_mut().chain(&mut self.gradient_correction) {
            tensors[i] = reflected_tensor(axes, &tensors[i]);
        }
    }

    /// Gives the images across symmetry planes velocity and density of their originals, after these were changed by hand.
    pub(crate) fn update_reflected_images(&mut self) {
        let real = self.particles.len() - self.images.originals.len();
        for image in 0..self.images.reflections.len() {
            let original = self.images.originals[image] as usize;
            let Particles { v, rho, .. } = &mut self.particles;
            v[real + image] = reflected(self.images.reflections[image], v[original]);
            rho[real + image] = rho[original];
        }
    }
}

impl<const D: usize> System<D> {
    /// Wraps the water round the periodic sides and folds it at the symmetry planes. Removes particles that left the domain or
    /// are displaced, sorts the water along the columns, and puts new images at its end. Returns the change of the particle
    /// arrays, and the removed particles.
    pub(super) fn sort_water(&mut self) -> (SortedWater, Vec<RemovedParticle<D>>) {
        let real = self.own_count();
        let folded = self.fluid.fold_at_planes(real);
        let Fluid { particles, images, displaced, .. } = &mut self.fluid;
        images.wrap(&mut particles.r[..real]);
        let mut order = self.neighbours.column_order(&particles.r[..real]);
        let displaced = displaced.take();
        let lost = self.remove_outside(&mut order);
        if let Some(displaced) = displaced {
            order.retain(|&i| !displaced.get(i as usize).is_some_and(|displaced| *displaced));
        }
        let created = open_boundary::exchange_at_faces(self, &mut order);
        let real = order.len();
        let first_created = real - created.len();
        let Fluid { particles, images, .. } = &mut self.fluid;
        let mut copies = Vec::new();
        if images.any() {
            let mut sorted: Vec<Vector<D>> = order.iter().map(|&i| particles.r[i as usize]).collect();
            sorted[first_created..].iter_mut().zip(&created).for_each(|(r, new)| *r = new.r);
            copies = images.make(&sorted);
            order.extend(copies.iter().map(|image| order[image.original as usize]).collect::<Vec<_>>());
        }
        self.fluid.permute(&order);
        let Particles { r, v, .. } = &mut self.fluid.particles;
        // A new particle took the arrays of its source, and so did its images.
        let originals = (first_created..real).chain(copies.iter().map(|image| image.original as usize));
        for (i, original) in (first_created..).zip(originals) {
            if let Some(new) = original.checked_sub(first_created).and_then(|k| created.get(k)) {
                (r[i], v[i]) = (new.r, new.v);
            }
        }
        let images = &mut self.fluid.images;
        images.originals = copies.iter().map(|image| image.original).collect();
        let mut reflections = Vec::new();
        if images.planes.any() {
            images.reflections = copies.iter().map(|image| image.axes).collect();
            self.fluid.reflect_images(real);
            let of_image = |new: usize| new.checked_sub(real).map_or(0, |image| copies[image].axes);
            let of_original = |old: u32| folded.get(old as usize).copied().unwrap_or(0);
            reflections = order.iter().enumerate().map(|(new, &old)| of_original(old) ^ of_image(new)).collect();
        }
        for (r, image) in self.fluid.particles.r[real..].iter_mut().zip(&copies) {
            *r += image.away;
        }
        open_boundary::name_created(self, created.len());
        (SortedWater { order, reflections }, lost)
    }

    /// Whether water is so far beyond a periodic side or a symmetry plane that walls and images soon end before it. Lists that are
    /// rebuilt within a step leave the water there; in steady flow all of them may be.
    pub(super) fn is_water_far_out(&self) -> bool {
        let (images, far) = (&self.fluid.images, self.model.support_radius());
        images.any() && self.fluid.particles.r[..self.own_count()].par_iter().any(|r| images.is_far_out(r, far))
    }

    /// Makes the images of the water anew at its present places; the water keeps its order.
    #[cfg(feature = "gpu")]
    pub(super) fn renew_images(&mut self) {
        let real = self.own_count();
        let Fluid { particles, images, .. } = &mut self.fluid;
        if !images.any() {
            return;
        }
        let copies = images.make(&particles.r[..real]);
        images.originals = copies.iter().map(|image| image.original).collect();
        let order: Vec<u32> = (0..real as u32).chain(images.originals.iter().copied()).collect();
        if images.planes.any() {
            images.reflections = copies.iter().map(|image| image.axes).collect();
        }
        self.fluid.permute(&order);
        self.fluid.reflect_images(real);
        for (r, image) in self.fluid.particles.r[real..].iter_mut().zip(&copies) {
            *r += image.away;
        }
    }

    /// Makes the images of `these` water particles at `places` (m) alone, which follow in both lists: no other image is known. The
    /// tensors of the images stay behind until [`System::renew_images`].
    #[cfg(feature = "gpu")]
    pub(super) fn renew_images_of(&mut self, these: &mut Vec<u32>, places: &mut Vec<Vector<D>>) {
        let real = self.own_count();
        let Fluid { particles: Particles { r, v, rho, id }, images, .. } = &mut self.fluid;
        if !images.any() {
            return;
        }
        let copies = images.make(places);
        images.originals = copies.iter().map(|image| these[image.original as usize]).collect();
        r.truncate(real);
        v.truncate(real);
        rho.truncate(real);
        id.truncate(real);
        if images.planes.any() {
            images.reflections = copies.iter().map(|image| image.axes).collect();
        }
        for (image, &original) in copies.iter().zip(&images.originals) {
            let i = original as usize;
            let place = images.planes.mirrored(image.axes, &r[i]) + image.away;
            these.push(r.len() as u32);
            places.push(place);
            r.push(place);
            v.push(reflected(image.axes, v[i]));
            rho.push(rho[i]);
            id.push(id[i]);
        }
    }

    /// Limits the next step by the acceleration of the water without images and buffers.
    pub(super) fn limit_step_by_originals(&mut self) {
        if self.fluid.images.any() || !self.fluid.buffer.tags.is_empty() {
            // The outermost images lack half their neighbours: their acceleration says nothing of the water.
            let (real, rates) = (self.particle_count(), self.fluid_rates());
            let largest = (0..real).map(|i| rates.of(i).acceleration.norm_squared()).fold(0.0, f64::max);
            self.status.step_limits = StepLimits { acceleration: largest.sqrt(), ..self.status.step_limits };
        }
    }
}

/// Times at which the motion of a driven solid is looked at.
const TIMES_SEEN: u32 = 2000;

/// The motion of a driven solid that moves along axis number `axis`.
fn motion_along<const D: usize>(spec: &SolidSpec<D>, axis: usize) -> Option<&PrescribedMotion<D>> {
    match &spec.role {
        Role::Driven(motion) => Some(motion).filter(|motion| motion.moves_along(axis)),
        Role::Fixed | Role::Free(_) => None,
    }
}

/// The longest (m) that a driven solid, which starts with `bounds`, is along axis number `axis`.
fn longest<const D: usize>(spec: &SolidSpec<D>, motion: &PrescribedMotion<D>, bounds: &Bounds<D>, axis: usize) -> f64 {
    if motion.turns() { greatest_length(&spec.shape) } else { bounds.size()[axis] }
}

/// Whether the boundary particles of a solid have copies along axis number `axis`, across which water sees as far as `width` (m).
/// Free solids have copies, and driven solids that move along the axis, start between the sides and are short enough. Copies are
/// not combined with the images of symmetry planes.
fn is_copied<const D: usize>(
    periodic: &Periodic<D>,
    has_planes: bool,
    spec: &SolidSpec<D>,
    (axis, width): (usize, f64),
) -> bool {
    let Some([from, to]) = periodic[axis] else { return false };
    let Some(motion) = motion_along(spec, axis).filter(|_| !has_planes) else {
        return matches!(spec.role, Role::Free(_));
    };
    let bounds = world_bounds(&spec.shape, &spec.initial_kinematics().pose);
    let starts_inside = from <= bounds.min[axis] && bounds.max[axis] <= to;
    starts_inside && longest(spec, motion, &bounds, axis) <= to - from - 2.0 * width
}

/// Whether a solid with these `bounds` ends within `width` (m) of a side, so that water sees past its end.
fn ends_near<const D: usize>(bounds: &Bounds<D>, axis: usize, sides: [f64; 2], width: f64) -> bool {
    let near = |x: f64, side: f64| (x - side).abs() < width * (1.0 - 1e-9);
    sides.iter().any(|&side| near(bounds.min[axis], side) || near(bounds.max[axis], side))
}

/// The periodic axis at a side of which a driven solid without copies ends at `pose`.
fn side_reached<const D: usize>(
    periodic: &Periodic<D>,
    has_planes: bool,
    spec: &SolidSpec<D>,
    (pose, width): (&Pose<D>, f64),
) -> Option<usize> {
    let reaches = |axis: &usize| {
        let Some(sides) = periodic[*axis].filter(|_| motion_along(spec, *axis).is_some()) else { return false };
        // The smallest box of a mesh takes long: a box around it that ends before the sides decides alone.
        let loose = spec.shape.bounds_at(pose);
        if loose.min[*axis] > sides[0] + width && loose.max[*axis] < sides[1] - width {
            return false;
        }
        ends_near(&world_bounds(&spec.shape, pose), *axis, sides, width)
            && !is_copied(periodic, has_planes, spec, (*axis, width))
    };
    (0..D).find(reaches)
}

impl<const D: usize> System<D> {
    /// Name of the periodic axis at whose side driven solid number `i`, which has no copies, ends with the kinematics `now`.
    pub(crate) fn side_reached(&self, i: usize, now: &Kinematics<D>) -> Option<&'static str> {
        let Images { periodic, planes, width, .. } = &self.fluid.images;
        let axis = side_reached(periodic, planes.any(), &self.solids[i].spec, (&now.pose, *width))?;
        Some(["x", "y", "z"][axis])
    }
}

/// How a driven solid may go along a periodic axis, for messages.
fn driven_help(length: f64, width: f64) -> String {
    let longest = length - 2.0 * width;
    format!(
        "a driven solid that starts between the sides and is {longest:.4} m long at most passes through them; a longer one \
         reaches {width:.4} m or more beyond both sides during its whole motion, or ends as far before them"
    )
}

/// Refuses driven solids without copies that end at a periodic side at a time up to `until` (s).
///
/// # Errors
/// `Scene` with the solid, the time and the remedy.
pub(crate) fn check_motions<const D: usize>(
    periodic: &Periodic<D>,
    has_planes: bool,
    model: &Model,
    solids: &[SolidSpec<D>],
    until: f64,
) -> Result<()> {
    let width = WIDTH * model.support_radius();
    let any = periodic.iter().any(Option::is_some);
    for spec in solids.iter().filter(|_| any) {
        let Role::Driven(motion) = &spec.role else { continue };
        for t in (0..=TIMES_SEEN).map(|k| until * f64::from(k) / f64::from(TIMES_SEEN)) {
            let pose = motion.kinematics(&spec.pose, t).pose;
            let Some(axis) = side_reached(periodic, has_planes, spec, (&pose, width)) else { continue };
            let name = ["x", "y", "z"][axis];
            let what = format!("driven solid {:?} ends at a periodic side along {name} at t = {t:.4} s", spec.name);
            let [from, to] = periodic[axis].unwrap_or_default();
            let help = match has_planes {
                true => {
                    "leave  symmetry  out: beside symmetry planes no solid passes through periodic sides".to_string()
                }
                false => driven_help(to - from, width),
            };
            return Err(Error::scene(what).help(help));
        }
    }
    Ok(())
}

/// Refuses invalid periodic sides; `has_planes`: whether there are symmetry planes.
///
/// # Errors
/// `Scene` if a period is too short or no whole number of dp, a fixed or driven solid ends at a side, or a free solid
/// starts across a side, is too long or may touch another solid.
pub(crate) fn check<const D: usize>(
    periodic: &Periodic<D>,
    has_planes: bool,
    model: &Model,
    solids: &[SolidSpec<D>],
    constraints: &Constraints<D>,
) -> Result<()> {
    let (dp, width) = (model.dp, WIDTH * model.support_radius());
    for (axis, side) in periodic.iter().enumerate() {
        let Some([from, to]) = *side else { continue };
        let (name, length) = (["x", "y", "z"][axis], to - from);
        if !(length >= width && length.is_finite()) {
            let what = format!("the period along {name}, {length} m, is so short that particles would see themselves");
            return Err(Error::scene(what).help(format!("it is {width} m at least, or else dp must be smaller")));
        }
        let rows = (length / dp).round();
        if (length / dp - rows).abs() > 1e-6 * rows {
            let what = format!("the period along {name}, {length} m, is not a whole number of dp");
            // Nine digits, without the round-off of the quotient.
            let spacing = format!("{:.8e}", length / rows).parse().unwrap_or(length / rows);
            return Err(Error::scene(what).help(format!("write  dp = {spacing}")));
        }
        for solid in solids.iter().filter(|solid| matches!(solid.role, Role::Free(_))) {
            check_free(solid, (name, axis), [from, to], width)?;
        }
        let ends = |solid: &&SolidSpec<D>| {
            let bounds = world_bounds(&solid.shape, &solid.initial_kinematics().pose);
            ends_near(&bounds, axis, [from, to], width) && !is_copied(periodic, has_planes, solid, (axis, width))
        };
        if let Some(solid) = solids.iter().find(ends) {
            let what = format!("solid {:?} ends at a periodic side along {name}: solids are not repeated", solid.name);
            let help = match motion_along(solid, axis) {
                Some(_) if !has_planes => driven_help(length, width),
                _ => format!("let it reach {width} m or more beyond the side, or end as far before it"),
            };
            return Err(Error::scene(what).help(help));
        }
    }
    if periodic.iter().any(Option::is_some) {
        return check_contacts(solids, constraints);
    }
    Ok(())
}

/// Refuses a free solid that starts across the sides `from` and `to` (m). Refuses one so long that water could be beside two of
/// its copies; `width` (m) is the reach of water.
fn check_free<const D: usize>(
    solid: &SolidSpec<D>,
    (name, axis): (&str, usize),
    [from, to]: [f64; 2],
    width: f64,
) -> Result<()> {
    let bounds = world_bounds(&solid.shape, &solid.initial_kinematics().pose);
    let (min, max) = (bounds.min[axis], bounds.max[axis]);
    // The longest that it can become along the axis as it turns.
    let (long, longest) = (greatest_length(&solid.shape), to - from - 2.0 * width);
    if long > longest {
        let what = format!(
            "free solid {:?} is up to {long:.4} m long, and the period along {name} {} m",
            solid.name,
            to - from
        );
        let help =
            format!("it may have {longest:.4} m: the period less twice the {width:.4} m that water sees across a side");
        return Err(Error::scene(what).help(help));
    }
    if min < from || max > to {
        let what = format!(
            "free solid {:?} starts across a periodic side: it is from {name} = {min:.4} to {max:.4} m",
            solid.name
        );
        let by = if min < from { from - min } else { to - max };
        return Err(Error::scene(what)
            .help(format!("move it by {by:.4} m along {name}; during the run it may cross the sides")));
    }
    Ok(())
}

/// Refuses a free solid that may touch another, because contacts do not act across the sides.
fn check_contacts<const D: usize>(solids: &[SolidSpec<D>], constraints: &Constraints<D>) -> Result<()> {
    let free = |i: &usize| matches!(solids[*i].role, Role::Free(_));
    for i in (0..solids.len()).filter(free) {
        let touched = |j: &usize| i != *j && constraints.can_touch(i, *j);
        if let Some(j) = (0..solids.len()).find(touched) {
            let name = &solids[i].name;
            let what = format!(
                "free solid {name:?} may touch {:?}, and contacts do not act across periodic sides",
                solids[j].name
            );
            let help = format!("let it pass through all others:  [[contact]]  between = [{name:?}]  touch = false");
            return Err(Error::scene(what).help(help));
        }
    }
    Ok(())
}
