//! Gaps between solids, and between the faces of one solid, that are narrower than the kernel's support radius.

use super::{
    Finding, PreflightContext,
    hollows::is_kept_dry,
    surface_samples::{self, SurfaceSample},
};
use crate::{
    geometry::{Shape, world_bounds},
    math::{
        Vector,
        format::{coordinates, three_digits, two_digits_down},
    },
    solid::{Role, Solid, joint_groups::JointGroups},
};

/// Distance (dp) below which solids are in contact: the engine computes the contact.
const TOUCH: f64 = 0.1;

/// Largest number of places of a solid that are searched for gaps between its own faces.
const PLACES_SEEN: usize = 2000;

/// Least number of places that see a gap between the faces of one solid: fewer are a notch or a corner.
const LEAST_PLACES: usize = 4;

/// Largest cosine between the normals of the two faces of a gap: for solids apart, then for solids in contact, whose faces
/// diverge slowly beside a round place.
const FACING: [f64; 2] = [-0.8, -0.99];

/// The results of the search between solids.
pub(crate) struct Gaps {
    /// For each solid, whether it touches another solid, or its contact skin, without a joint between them.
    pub touching: Vec<bool>,
    /// The pairs of these solids.
    pub pairs: Vec<[usize; 2]>,
}

/// A narrow gap between two faces.
#[derive(Clone, Copy, Debug)]
struct Gap<const D: usize> {
    width: f64,
    middle: Vector<D>,
}

/// The distance (m) from `face` through the space outside of the solid to another face of it, if that is shorter than `most` (m).
/// `distance` is the signed distance of the solid.
fn way_across<const D: usize>(
    face: &SurfaceSample<D>,
    dp: f64,
    most: f64,
    distance: impl Fn(&Vector<D>) -> f64,
) -> Option<f64> {
    // Another face in front is nearer to the middle of the way than this one.
    if distance(&(face.x + face.n * (0.5 * most))) >= 0.5 * most * (1.0 - 1e-6) {
        return None;
    }
    // No face is nearer than the signed distance; the smallest step ends behind the face.
    let mut way = 0.05 * dp;
    while way < most {
        let d = distance(&(face.x + face.n * way));
        if d < 1e-6 * dp {
            return Some(way + d);
        }
        way += d.max(0.01 * dp);
    }
    None
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Finds the gaps between each two solids, from the faces of the one that moves, or of both if both or neither move.
    pub(super) fn gaps(&self, findings: &mut Vec<Finding>) -> Gaps {
        let n = self.solids().len();
        let (mut touching, mut pairs) = (vec![false; n], Vec::new());
        let specs: Vec<_> = self.solids().iter().map(|solid| &solid.spec).collect();
        let tied = JointGroups::of(&specs, &self.system.constraints().at_start()).jointed;
        let moves = |i: usize| !matches!(self.solids()[i].spec.role, Role::Fixed);
        for i in 0..n {
            for j in 0..i {
                let mut found = [None, None];
                let mut touch = false;
                let within = TOUCH * self.dp() + self.skin_distance(i, j);
                for (gap, (a, b)) in found.iter_mut().zip([(i, j), (j, i)]) {
                    if moves(a) || !moves(b) {
                        let (nearest, facing) = self.narrowest_gap(a, b);
                        (*gap, touch) = (facing, touch || nearest < within);
                    }
                }
                // Bodies that joints tie together do not carry one another by contact.
                touch &= tied[i] != tied[j];
                touching[i] |= touch;
                touching[j] |= touch;
                pairs.extend(touch.then_some([j, i]));
                let narrowest = found.into_iter().flatten().min_by(|a, b| a.width.total_cmp(&b.width));
                findings.extend(narrowest.map(|gap| self.gap_finding(gap, j, i)));
            }
        }
        findings.extend((0..n).filter_map(|i| self.own_gap_finding(i)));
        Gaps { touching, pairs }
    }

    /// Returns the finding of the narrowest gap between faces of solid `i`, as in a slot, that water does not fill as it is meant to.
    fn own_gap_finding(&self, i: usize) -> Option<Finding> {
        let (dp, reach) = (self.dp(), self.system.model().support_radius() * (1.0 - 1e-6));
        let Solid { spec, kinematics, .. } = &self.solids()[i];
        let (shape, pose) = (&spec.shape, &kinematics.pose);
        // The samples of a mesh are costly, and those of the other shapes leave out the faces of gaps below dp/2.
        let own = match shape {
            Shape::Polygon { .. } | Shape::Compound(_) => surface_samples::of_shape_beyond(shape, dp, TOUCH),
            _ => surface_samples::of_inner_faces(shape, dp),
        };
        let faces = if own.is_empty() { &self.surface_samples[i] } else { &own };
        let across = |face: &SurfaceSample<D>| {
            let width = way_across(face, dp, reach, |x| shape.signed_distance(x))?;
            let opposite = shape.outward_normal(&(face.x + face.n * width), 0.05 * dp);
            let middle = face.x + face.n * (0.5 * width);
            (face.n.dot(&opposite) <= FACING[0] && self.may_be_wet(i, &middle))
                .then(|| Gap { width, middle: pose.point(&middle) })
        };
        let gaps: Vec<Gap<D>> = surface_samples::thinned(faces, PLACES_SEEN).filter_map(across).collect();
        let gap = gaps.iter().min_by(|a, b| a.width.total_cmp(&b.width)).filter(|_| gaps.len() >= LEAST_PLACES)?;
        let what = format!(
            "faces of \"{}\" are {} m apart at {}, {} dp, and the kernel reaches {} dp",
            spec.name,
            three_digits(gap.width),
            coordinates(&gap.middle),
            three_digits(gap.width / dp),
            three_digits(self.support_radius_dp())
        );
        let why = if gap.width < dp * (1.0 - 1e-6) {
            "no water particle fits into the gap"
        } else {
            "the water between them is not resolved"
        };
        let mend = format!(
            "close the gap, make it {} m wider, or dp = {}",
            three_digits(reach - gap.width),
            two_digits_down(gap.width / self.support_radius_dp())
        );
        Some(Finding::warning("narrow_gap", format!("{what}: {why}"), mend))
    }

    /// Whether water is meant to be at `x` (m, own frame) beside solid `i`: below the level around it, and in no hollow that stays dry.
    fn may_be_wet(&self, i: usize, x: &Vector<D>) -> bool {
        let height = self.solids()[i].kinematics.pose.point(x)[D - 1];
        self.level_around(i).is_some_and(|level| height < level) && !is_kept_dry(self, i, x)
    }

    /// How far (m) the contact skins of two solids keep their faces apart.
    fn skin_distance(&self, a: usize, b: usize) -> f64 {
        self.solids()[a].spec.contact_skin + self.solids()[b].spec.contact_skin
    }

    /// The least distance (m) of the faces of solid `a` from solid `b`, and the narrowest gap between opposite faces, if it is
    /// narrower than the kernel's support radius.
    fn narrowest_gap(&self, a: usize, b: usize) -> (f64, Option<Gap<D>>) {
        // A gap as wide as the kernel's support radius, up to round-off, is wide enough.
        let (dp, reach) = (self.dp(), self.system.model().support_radius() * (1.0 - 1e-6));
        let [one, other] = [a, b].map(|i| &self.solids()[i]);
        let around = world_bounds(&other.spec.shape, &other.kinematics.pose).grown(reach);
        let near = |face: &SurfaceSample<D>| {
            let x = one.kinematics.pose.point(&face.x);
            let local = other.kinematics.pose.local(&x);
            let d = around.contains(&x).then(|| other.spec.shape.signed_distance(&local)).filter(|d| *d < reach)?;
            let n = one.kinematics.pose.rotation * face.n;
            let facing = n.dot(&(other.kinematics.pose.rotation * other.spec.shape.outward_normal(&local, 0.05 * dp)));
            Some((d, facing, Gap { width: d, middle: x + n * (0.5 * d) }))
        };
        let near: Vec<_> = self.surface_samples[a].iter().filter_map(near).collect();
        let nearest = near.iter().map(|(d, ..)| *d).fold(f64::INFINITY, f64::min);
        // Beside a contact, the faces diverge slowly; there, only a narrow gap of even width counts.
        let (least, facing) = if nearest < TOUCH * dp { (0.5 * dp, FACING[1]) } else { (0.0, FACING[0]) };
        let gaps = near.into_iter().filter(|(d, cosine, _)| *d >= least && *cosine <= facing).map(|x| x.2);
        (nearest, gaps.min_by(|a, b| a.width.total_cmp(&b.width)))
    }

    fn gap_finding(&self, gap: Gap<D>, a: usize, b: usize) -> Finding {
        let (dp, reach) = (self.dp(), self.system.model().support_radius());
        let name = |i: usize| &self.solids()[i].spec.name;
        let what = format!(
            "\"{}\" and \"{}\" are {} m apart at {}, {} dp, and the kernel reaches {} dp",
            name(a),
            name(b),
            three_digits(gap.width),
            coordinates(&gap.middle),
            three_digits(gap.width / dp),
            three_digits(self.support_radius_dp())
        );
        let apart = |more: &str| {
            let further = three_digits(reach - gap.width);
            format!(
                "{more} move them {further} m further apart, or dp = {}",
                two_digits_down(gap.width / self.support_radius_dp())
            )
        };
        if self.is_wet(&gap.middle) {
            let what = what + ": the water between them is not resolved";
            let touch =
                if self.skin_distance(a, b) > 0.0 { "let them touch without a skin," } else { "let them touch," };
            Finding::warning("narrow_gap", what, apart(touch))
        } else {
            Finding::note("narrow_gap", what + "; it is dry at the start", apart("if it floods,"))
        }
    }

    /// Whether there is water within the kernel's support of `x` (m), and `x` not above its level.
    pub(super) fn is_wet(&self, x: &Vector<D>) -> bool {
        let mut near = false;
        if self.g == 0.0 || x[D - 1] <= self.still_water.level {
            self.system.visit_fluid_near(x, &mut |_, _, _| near = true);
        }
        near
    }
}
