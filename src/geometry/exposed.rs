//! The part of the surface of a compound that no other part of it covers.
//!
//! A place of a facet is covered if the point just before it lies in another part.

use super::{Shape, submerged_volume::Facet};
use crate::math::{Pose, Vector};

/// Distance of that point from the facet, relative to the size of the shape.
pub(super) const OFFSET: f64 = 1e-6;

/// Size of the pieces of a facet that are looked at to find that it is covered, relative to the size of the shape: in 2-D, in 3-D.
const PIECE: [f64; 2] = [1.0 / 2048.0, 1.0 / 128.0];

/// Most halvings of a facet between whose corners another part begins.
const HALVINGS: usize = 6;

/// What covers the facets of one part of a compound.
pub(super) struct Cover<'a, const D: usize> {
    parts: &'a [(Pose<D>, Shape<D>)],
    /// The part with the facets.
    own: usize,
    /// Size of the compound, m.
    size: f64,
}

/// The facets of `shape` in its own frame, where `facets` returns those of a shape that is no compound. `add` adds what a cover leaves
/// of a facet.
pub(super) fn exposed_facets<const D: usize>(
    shape: &Shape<D>,
    facets: &impl Fn(&Shape<D>) -> Vec<Facet<D>>,
    add: &impl Fn(&Cover<D>, Facet<D>, &mut Vec<Facet<D>>),
) -> Vec<Facet<D>> {
    let Shape::Compound(parts) = shape else { return facets(shape) };
    let size = shape.bounds().size().max();
    let mut all = Vec::new();
    for (own, (pose, part)) in parts.iter().enumerate() {
        let cover = Cover { parts, own, size };
        for facet in exposed_facets(part, facets, add) {
            add(&cover, facet.map(|x| pose.point(&x)), &mut all);
        }
    }
    all
}

impl<const D: usize> Cover<'_, D> {
    /// Adds the whole facet, unless all of it is covered.
    pub(super) fn add_unless_covered(&self, facet: Facet<D>, into: &mut Vec<Facet<D>>) {
        if !self.covers(facet, &self.step_before(&facet)) {
            into.push(facet);
        }
    }

    /// Adds the parts of a facet that are not covered. It cuts them off along straight lines, and misses a cover that reaches neither a
    /// corner nor the middle of the facet or of an edge.
    pub(super) fn add_exposed_parts(&self, facet: Facet<D>, into: &mut Vec<Facet<D>>) {
        let step = self.step_before(&facet);
        self.add_exposed((facet, facet.map(|x| self.state(&x, &step))), &step, HALVINGS, into);
    }

    /// The step from a facet to the points before it, m.
    fn step_before(&self, facet: &Facet<D>) -> Vector<D> {
        let normal = area_vector(facet);
        normal * (OFFSET * self.size / normal.norm().max(f64::MIN_POSITIVE))
    }

    /// Distance (m) from the other parts of the point `step` before `x`; negative if it is covered.
    fn distance(&self, x: &Vector<D>, step: &Vector<D>) -> f64 {
        let others = self.parts.iter().enumerate().filter(|(i, _)| *i != self.own);
        let distances = others.map(|(_, (pose, shape))| shape.signed_distance(&pose.local(&(x + step))));
        distances.fold(f64::INFINITY, f64::min)
    }

    fn covers(&self, facet: Facet<D>, step: &Vector<D>) -> bool {
        let x = middle(&facet);
        let distance = self.distance(&x, step);
        let radius = facet.iter().map(|corner| (corner - x).norm()).fold(0.0, f64::max);
        let is_known = distance >= 0.0 || radius < -distance || radius < PIECE[D - 2] * self.size;
        if is_known { distance < 0.0 } else { halves(&facet).into_iter().all(|half| self.covers(half, step)) }
    }

    /// 1 where the facet is exposed, -1 where it is covered, 0 at the edge of the cover.
    fn state(&self, x: &Vector<D>, step: &Vector<D>) -> i32 {
        let distance = self.distance(x, step) / (0.5 * OFFSET * self.size);
        if distance.abs() < 1.0 { 0 } else { distance.signum() as i32 }
    }

    /// The same of a facet whose corners have these states.
    fn add_exposed(
        &self,
        (facet, corners): (Facet<D>, [i32; D]),
        step: &Vector<D>,
        halvings: usize,
        into: &mut Vec<Facet<D>>,
    ) {
        let state = |x: &Vector<D>| self.state(x, step);
        let within = state(&middle(&facet));
        let [exposed, covered] = [1, -1].map(|one| corners.iter().position(|state| *state == one));
        if let (Some(i), Some(j)) = (exposed, covered) {
            let (mut out, mut inside) = (facet[i], facet[j]);
            for _ in 0..50 {
                let half = (out + inside) * 0.5;
                if self.distance(&half, step) > 0.0 { out = half } else { inside = half }
            }
            // The corner at the edge of the cover ends the search, also where the distance of a part jumps there.
            for end in [i, j] {
                let mut part = (facet, corners);
                (part.0[end], part.1[end]) = (out, 0);
                self.add_exposed(part, step, halvings, into);
            }
            return;
        }
        let whole = if exposed.is_some() || covered.is_none() && within > 0 { 1 } else { -1 };
        // The edge of the cover may be round between two corners that lie on it.
        let sides =
            (0..D).flat_map(|i| (0..i).map(move |j| (i, j))).filter(|(i, j)| corners[*i] != 0 || corners[*j] != 0);
        let mut others = sides.map(|(i, j)| state(&((facet[i] + facet[j]) * 0.5))).chain([within]);
        if halvings > 0 && others.any(|state| state == -whole) {
            for half in halves(&facet) {
                self.add_exposed((half, half.map(|x| state(&x))), step, halvings - 1, into);
            }
        } else if whole > 0 && within > 0 {
            into.push(facet);
        }
    }
}

/// A facet halved across its longest edge.
fn halves<const D: usize>(facet: &Facet<D>) -> [Facet<D>; 2] {
    let length = |(i, j): &(usize, usize)| (facet[*i] - facet[*j]).norm_squared();
    let edges = (0..D).flat_map(|i| (0..i).map(move |j| (i, j)));
    let (i, j) = edges.max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or((1, 0));
    let half = (facet[i] + facet[j]) * 0.5;
    [i, j].map(|end| {
        let mut part = *facet;
        part[end] = half;
        part
    })
}

/// Area of a facet times its outward normal.
pub(super) fn area_vector<const D: usize>(facet: &Facet<D>) -> Vector<D> {
    let side = facet[1] - facet[0];
    if D == 2 {
        return Vector::from_fn(|i, _| if i == 0 { side[1] } else { -side[0] });
    }
    let other = facet[2] - facet[0];
    Vector::from_fn(|i, _| {
        let (j, k) = ((i + 1) % D, (i + 2) % D);
        0.5 * (side[j] * other[k] - side[k] * other[j])
    })
}

pub(super) fn middle<const D: usize>(facet: &Facet<D>) -> Vector<D> {
    facet.iter().sum::<Vector<D>>() / D as f64
}
