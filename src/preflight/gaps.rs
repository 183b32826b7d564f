//! Gaps between solids that are narrower than the kernel's support radius.

use super::{Finding, PreflightContext, surface_samples::SurfaceSample};
use crate::{
    math::{
        Vector,
        format::{coordinates, three_digits, two_digits_down},
    },
    scene::world_bounds,
    solid::{Role, joint_groups::JointGroups},
};

/// Distance (dp) below which solids are in contact: the engine computes the contact.
const TOUCH: f64 = 0.1;

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

/// The narrowest gap between two solids.
#[derive(Clone, Copy, Debug)]
struct Gap<const D: usize> {
    width: f64,
    middle: Vector<D>,
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
        Gaps { touching, pairs }
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
