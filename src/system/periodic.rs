//! Periodic sides: what leaves at one comes in at the other, and sees across them.
//!
//! Water near a side has an image one period away, a particle of the arrays like any other, after all that is real. An
//! image takes its rates from the particle that it mirrors, so that whoever moves the water moves both alike; only what
//! counts the water leaves images out. Solids have none: they reach beyond the sides as far as the images do.

use super::{Fluid, RemovedParticle, System};
use crate::{
    error::{Error, Result},
    interaction::StepLimits,
    math::{Bounds, Vector},
    model::Model,
    solid::{Role, SolidSpec},
};

/// How far images reach beyond a side, over the kernel's support: the skin beyond a side sees water as that inside does, also
/// while lists grow old.
const WIDTH: f64 = 2.5;

/// For each axis where a period begins and ends (m), if it has one.
pub(crate) type Periodic<const D: usize> = [Option<[f64; 2]>; D];

/// The images of the water.
pub(super) struct Images<const D: usize> {
    pub(super) periodic: Periodic<D>,
    width: f64,
    /// Which particle each of them mirrors; they follow the real ones in this order.
    pub(super) originals: Vec<u32>,
}

impl<const D: usize> Images<D> {
    /// None yet, for a kernel of support `reach` (m).
    pub(super) fn new(periodic: Periodic<D>, reach: f64) -> Self {
        Self { periodic, width: WIDTH * reach, originals: Vec::new() }
    }

    /// Whether any side is periodic.
    fn any(&self) -> bool {
        self.periodic.iter().any(Option::is_some)
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

    /// Makes the images of the particles at `r` (m): which they mirror, and how far away they are (m).
    fn make(&self, r: &[Vector<D>]) -> Vec<(u32, Vector<D>)> {
        let mut images = Vec::new();
        for (axis, side) in self.periodic.iter().enumerate() {
            let Some([from, to]) = *side else { continue };
            let mirror = |i: u32, away: Vector<D>, images: &mut Vec<_>| {
                let x = r[i as usize][axis];
                for (near, sign) in [(x < from + self.width, 1.0), (x >= to - self.width, -1.0)] {
                    if near {
                        let mut away = away;
                        away[axis] += sign * (to - from);
                        images.push((i, away));
                    }
                }
            };
            // Those of the axes before have images along this one too: the corners.
            let before = images.len();
            (0..r.len() as u32).for_each(|i| mirror(i, Vector::zeros(), &mut images));
            for k in 0..before {
                let (i, away) = images[k];
                mirror(i, away, &mut images);
            }
        }
        images
    }

    /// Whether `x` (m) lies between the sides.
    pub(super) fn is_inside(&self, x: &Vector<D>) -> bool {
        let inside = |(x, side): (&f64, &Option<[f64; 2]>)| side.is_none_or(|[from, to]| (from..to).contains(x));
        x.iter().zip(&self.periodic).all(inside)
    }
}

impl<const D: usize> System<D> {
    /// Wraps the water round the periodic sides, removes what left the domain or is displaced, sorts it along the columns and
    /// puts new images at its end. Returns the order, `order[new] = old` (for an image that of its original), and what was removed.
    pub(super) fn sort_water(&mut self) -> (Vec<u32>, Vec<RemovedParticle<D>>) {
        let real = self.particle_count();
        let Fluid { particles, images, displaced, .. } = &mut self.fluid;
        images.wrap(&mut particles.r[..real]);
        let mut order = self.neighbours.column_order(&particles.r[..real]);
        let displaced = displaced.take();
        let lost = self.remove_outside(&mut order);
        if let Some(displaced) = displaced {
            order.retain(|&i| !displaced[i as usize]);
        }
        let real = order.len();
        let Fluid { particles, images, .. } = &mut self.fluid;
        let mut copies = Vec::new();
        if images.any() {
            let sorted: Vec<Vector<D>> = order.iter().map(|&i| particles.r[i as usize]).collect();
            copies = images.make(&sorted);
            order.extend(copies.iter().map(|(of, _)| order[*of as usize]).collect::<Vec<_>>());
        }
        self.fluid.permute(&order);
        let Fluid { particles, images, .. } = &mut self.fluid;
        for (r, (_, away)) in particles.r[real..].iter_mut().zip(&copies) {
            *r += away;
        }
        images.originals = copies.into_iter().map(|(of, _)| of).collect();
        (order, lost)
    }

    /// Limits the next step by the acceleration of the water without its images.
    pub(super) fn limit_step_by_originals(&mut self) {
        if self.fluid.images.any() {
            // The outermost images lack half their neighbours: their acceleration says nothing of the water.
            let (real, rates) = (self.particle_count(), self.fluid_rates());
            let largest = (0..real).map(|i| rates.of(i).acceleration.norm_squared()).fold(0.0, f64::max);
            self.status.step_limits = StepLimits { acceleration: largest.sqrt(), ..self.status.step_limits };
        }
    }
}

/// Refuses periodic sides that cannot be.
///
/// # Errors
/// `Scene` if a period is too short or no whole number of dp, or a solid is free or ends at a side.
pub(crate) fn check<const D: usize>(periodic: &Periodic<D>, model: &Model, solids: &[SolidSpec<D>]) -> Result<()> {
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
            return Err(Error::scene(what).help(format!("write  dp = {}", length / rows)));
        }
        if let Some(solid) = solids.iter().find(|solid| matches!(solid.role, Role::Free(_))) {
            let what = format!("solid {:?} is free, and periodic sides allow only fixed and driven ones", solid.name);
            return Err(Error::scene(what).help("close the sides with walls, or make the solid fixed or driven"));
        }
        let near = |x: f64, side: f64| (x - side).abs() < width * (1.0 - 1e-9);
        let ends = |solid: &&SolidSpec<D>| {
            let Bounds { min, max } = solid.shape.bounds_at(&solid.pose);
            near(min[axis], from) || near(min[axis], to) || near(max[axis], from) || near(max[axis], to)
        };
        if let Some(solid) = solids.iter().find(ends) {
            let what = format!("solid {:?} ends at a periodic side along {name}: solids are not repeated", solid.name);
            let help = format!("let it reach {width} m or more beyond the side, or end as far before it");
            return Err(Error::scene(what).help(help));
        }
    }
    Ok(())
}
