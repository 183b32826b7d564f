//! The water of a set-up with symmetry planes: rows beside a plane, and water on both sides.

use super::Named;
use crate::{
    error::{Error, Result},
    geometry::cells::PointCells,
    math::{
        Vector,
        format::{coordinates, three_digits},
    },
    system::Setup,
};

/// Largest distance of the rows next to a plane from their place half a dp before it, dp.
const ROW_TOLERANCE: f64 = 0.05;

/// Distance within which water has the velocity and the pressure of the image of a particle, dp: it surrounds the image also where
/// rows are packed beside solids.
const REACH: f64 = 1.5;

/// Difference of a velocity or pressure from the values around its image that is taken for round-off, over the greatest value.
const ROUND_OFF: f64 = 1e-6;

impl<const D: usize> Setup<D> {
    /// Leaves the water on the computed side only, whose rows must begin half a dp before the plane.
    pub(super) fn cut_water(&mut self, plane: &Named) -> Result<()> {
        let (dp, title) = (self.model.dp, plane.title());
        let depths: Vec<f64> = self.water.iter().map(|r| plane.depth(r)).collect();
        let mut near: Vec<f64> = depths.iter().copied().filter(|depth| (0.0..dp).contains(depth)).collect();
        near.sort_by(f64::total_cmp);
        if let Some(&row) = near.get(near.len() / 2)
            && (row / dp - 0.5).abs() > ROW_TOLERANCE
        {
            let shift = (row - 0.5 * dp) * if plane.plane.is_upper { 1.0 } else { -1.0 };
            let at = plane.plane.at + shift;
            let what = format!("the row of water next to {title} lies {:.3} dp before it, not half a dp", row / dp);
            let help = format!(
                "write  symmetry.{} = {}, or let the water begin a whole number of dp from the plane",
                plane.name(),
                (at * 1e9).round() / 1e9
            );
            return Err(Error::scene(what).help(help));
        }
        if depths.iter().all(|depth| *depth >= 0.0) {
            return Ok(());
        }
        let missing = |there: &Vector<D>, image: &Vector<D>| {
            let what = format!(
                "the water is not symmetric about {title}: there is water at {:?} m and none at {:?} m",
                there.as_slice(),
                image.as_slice()
            );
            Error::scene(what).help("give the water on one side of the plane only, or alike on both")
        };
        let kept: Vec<usize> = (0..depths.len()).filter(|&i| depths[i] >= 0.0).collect();
        let places: Vec<Vector<D>> = kept.iter().map(|&i| self.water[i]).collect();
        let cells = PointCells::new(&places, dp);
        let poses: Vec<_> = self.solids.iter().map(|solid| (&solid.shape, solid.initial_kinematics().pose)).collect();
        // A solid beside the plane displaces water that its image, which is not given, does not.
        let is_displaced = |x: &Vector<D>| poses.iter().any(|(shape, pose)| shape.signed_distance(&pose.local(x)) < dp);
        let greatest = [
            self.velocity.iter().map(|v| v.norm()).fold(0.0, f64::max),
            self.pressure.iter().map(|p| p.abs()).fold(0.0, f64::max),
        ];
        for i in (0..depths.len()).filter(|&i| depths[i] < 0.0) {
            let image = plane.image(&self.water[i]);
            let mut near = Vec::new();
            cells.visit_near(&image, REACH * dp, |k, x| near.push((k, (x - image).norm())));
            if near.iter().all(|(_, away)| *away >= dp) {
                if !is_displaced(&image) {
                    return Err(missing(&self.water[i], &image));
                }
                continue;
            }
            let near: Vec<usize> =
                near.into_iter().filter(|(_, away)| *away < REACH * dp).map(|(k, _)| kept[k]).collect();
            self.check_start(plane, i, &near, greatest)?;
        }
        let beyond: Vec<Vector<D>> = (0..depths.len()).filter(|&i| depths[i] < 0.0).map(|i| self.water[i]).collect();
        // Water may be given a little beyond the plane alone.
        let cells = PointCells::new(&beyond, dp);
        let deepest = depths.iter().fold(0.0, |deepest: f64, depth| deepest.max(-depth));
        for x in places.iter().filter(|x| plane.depth(x) <= deepest) {
            let image = plane.image(x);
            let mut is_near = false;
            cells.visit_near(&image, dp, |_, other| is_near = is_near || (other - image).norm() < dp);
            if !is_near && !is_displaced(&image) {
                return Err(missing(x, &image));
            }
        }
        self.water = places;
        self.surface_levels = kept.iter().map(|&i| self.surface_levels[i]).collect();
        if !self.pressure.is_empty() {
            self.pressure = kept.iter().map(|&i| self.pressure[i]).collect();
        }
        if !self.velocity.is_empty() {
            self.velocity = kept.iter().map(|&i| self.velocity[i]).collect();
        }
        Ok(())
    }

    /// Refuses a velocity or pressure at the start of particle `i` beyond the plane that differs from that of its image, which lies
    /// among the particles `near`. `fastest` (m/s) and `greatest` (Pa) are those of all water.
    fn check_start(&self, plane: &Named, i: usize, near: &[usize], [fastest, greatest]: [f64; 2]) -> Result<()> {
        let refuse = |word: &str, own: String| {
            let (title, place) = (plane.title(), coordinates(self.water[i].iter()));
            let what =
                format!("the {word} of the water at the start, {own} at {place}, is not symmetric about {title}");
            Err(Error::scene(what).help("make the formula symmetric, or compute both sides of the plane"))
        };
        let velocity = |k: usize, axis: usize| self.velocity.get(k).map_or(0.0, |v| v[axis]);
        let own = |axis: usize| if axis == plane.axis { -velocity(i, axis) } else { velocity(i, axis) };
        if (0..D).any(|axis| is_apart(own(axis), near.iter().map(|&k| velocity(k, axis)), fastest)) {
            return refuse("velocity", format!("{} m/s", coordinates(self.velocity[i].iter())));
        }
        let pressure = |k: usize| self.pressure.get(k).copied().unwrap_or_default();
        if is_apart(pressure(i), near.iter().map(|&k| pressure(k)), greatest) {
            return refuse("pressure", format!("{} Pa", three_digits(pressure(i))));
        }
        Ok(())
    }
}

/// Whether a value differs from those `near` its image by more than these differ from one another, as far as round-off of the
/// `greatest` value shows.
fn is_apart(own: f64, near: impl Iterator<Item = f64>, greatest: f64) -> bool {
    let ends = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
    let (low, high) = near.fold((f64::INFINITY, f64::NEG_INFINITY), ends);
    let room = high - low + ROUND_OFF * greatest;
    own < low - room || own > high + room
}
